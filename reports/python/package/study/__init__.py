"""Studies of many variants of a scene: `elastocheck study`, reports/README.md, "Studies of many variants".

run("study.yaml", "folder") computes what the ledger in the folder does not have yet.
"""
import concurrent.futures
import contextlib
import functools
import glob
import itertools
import os
import re
import time

import numpy as np

from elastocheck._errors import ArgumentError, FileError
from elastocheck.study.file import Study, scene_hash
from elastocheck.study.ledger import OUTCOMES, Ledger, locked

BATCH = 256  # variants that are solved and recorded together; the unit that shards divide


def _solved(solver, ks, numbers, witnesses):
    """Rows of the ledger of these variants, and of the witnesses among them (positions)."""
    tables = []
    for at, leg in [(range(len(ks)), "series"), (witnesses, "equilibrium")]:
        values, outcomes, legs, reasons = solver.solve(numbers[at], leg, 1)
        # Where SQLite stores a number otherwise: none for nan, and zero has no sign.
        stored = np.where(np.isnan(values), None, values + 0.0).tolist()
        tables.append([(ks[i], outcome, by, reason or None, *row) for i, outcome, by, reason, row in zip(at, outcomes, legs, reasons, stored)])
    return tables


@functools.lru_cache(maxsize=1)
def _prepared(file, name, identity, paths, words):
    """The solver of a study in a worker of a cluster; it stays there for the next batch."""
    from elastocheck import _core, read
    scene = read(file, name=name)
    if (scene_hash(file, scene), _core.build) != identity:
        raise FileError(f"{file}: the scene, or the version of the program, is another one on this worker")
    return _core.Variants(scene, list(paths), list(words))


def _by_worker(prepared, *batch):
    return _solved(_prepared(*prepared), *batch)


@contextlib.contextmanager
def _solvers(study, threads, scheduler):
    """What submits a batch, and how many are to be submitted at once: to threads here, or to the workers of a dask
    cluster, where the batch of one that is killed is computed by another."""
    if not scheduler:
        threads = threads or len(os.sched_getaffinity(0))
        with concurrent.futures.ThreadPoolExecutor(threads) as pool:
            yield functools.partial(pool.submit, _solved, study.solver), 2 * threads
        return
    import distributed
    try:
        client = distributed.Client(scheduler, timeout=10)
    except (OSError, ValueError) as error:
        raise ArgumentError(f"--scheduler {scheduler}: {error}") from error
    identity = study.identity["scene"], study.identity["version"]
    prepared = os.path.abspath(study.scene_file), study.scene_name, identity, tuple(study.paths), tuple(study.words)
    with client:
        pool = client.get_executor(pure=False, retries=10)
        yield functools.partial(pool.submit, _by_worker, prepared), 4 * max(sum(client.nthreads().values()), 1)


def _missing(ledger, count, shard):
    """Numbers of variants without a row, per batch of a shard."""
    has = ledger.present(count)
    batches = (first + np.flatnonzero(~has[first:first + BATCH]) for first in range((shard[0] - 1) * BATCH, count, shard[1] * BATCH))
    return [ks for ks in batches if len(ks)]


def _compute(study, ledger, batches, submit, most, progress):
    """Solves and records batch after batch; each is one transaction, and its rows do not depend on the others."""
    from elastocheck.study.design import Design
    design, running, done, begin, total = Design(study), set(), 0, time.monotonic(), sum(map(len, batches))
    waiting = iter(batches)
    while done < total:
        for ks in itertools.islice(waiting, most - len(running)):
            values = design.values(ks[0], ks[-1] + 1)[ks - ks[0]]
            witnesses = np.flatnonzero(ks % study.witness == 0) if study.witness else []
            running.add(submit(ks.tolist(), study.numbers(values), witnesses))
        finished, running = concurrent.futures.wait(running, return_when="FIRST_COMPLETED")
        for future in finished:
            ledger.add(*future.result())
            done += len(future.result()[0])
        if progress:
            progress(f"{done} of {total} variants, {done / (time.monotonic() - begin):.0f} per second", done / total)


class Report:
    """What a study reports: `text` as on the terminal, `document` as in statistics.json, frame() with all rows.

    `exit_code` 0: every variant has a row; 3: some have none, none is solved, or witnesses disagree: then it is false.
    """

    def __init__(self, study, ledger, reproduce="", rare=(), open_variants=0):
        from elastocheck.study import output
        from elastocheck.study.statistics import figure_row, sobol_rows, witness_row
        self.study, self.ledger, self.reproduce, count = study, ledger, reproduce, study.count
        per_outcome = {name: (rows, other) for name, rows, other in ledger.rows(
            "SELECT outcome, count(*), sum(method != 'series') FROM variants WHERE k < ? GROUP BY outcome", count)}
        self.outcomes = {name: per_outcome.get(name, (0, 0))[0] for name in OUTCOMES}
        self.rows, others = sum(self.outcomes.values()), sum(other for _, other in per_outcome.values())
        parts = [f"{rows} {name}" for name, rows in self.outcomes.items() if rows]
        parts += [f"{others} of all by the equilibrium leg, where series declines"] if others else []
        self.answer = f"{self.rows} of {count} variants: {', '.join(parts)}"
        self.tables = {"variables": [{"variable": v.name, "unit": v.unit, "design": v.nominal, "distribution": str(v),
                                      "scales": len(v.scaled)} for v in study.variables],
                       "figures": [], "sobol": [], "witnesses": [], "rare": list(rare)}
        self.disagreements = []
        nominal = study.numbers(np.array([[v.nominal for v in study.variables]]))
        for j, (figure, design) in enumerate(zip(study.figures, study.solver.solve(nominal, "series", 1)[0][0])):
            values = ledger.values(j, count)
            row = figure_row(study, figure, values, design)
            self.tables["figures"].append(row)
            self.tables["sobol"] += sobol_rows(study, figure, values)
            if study.witness:
                found, wrong = witness_row(study, row, *(of[::study.witness] for of in (values, ledger.values(j, count, "witnesses"))))
                self.tables["witnesses"].append(found)
                self.disagreements += wrong
        self.tables["failed"] = [{"variant": row[0], "outcome": row[1], "reason": row[3]} for row in ledger.rows(
            "SELECT * FROM variants WHERE outcome != 'solved' AND k < ? ORDER BY k LIMIT 10", count)]
        self.content = ledger.content_hash(count)
        self.exit_code = 0 if self.outcomes["solved"] and not open_variants and not self.disagreements else 3
        self.text, self.document = output.text(self), output.document(self)

    @property
    def verdict(self):
        return "fine" if self else "could not judge"

    def __bool__(self):
        return self.exit_code == 0

    def __repr__(self):
        return self.text

    def frame(self):
        """A pandas.DataFrame with a row for each variant: its number, outcome, reason, variables, figures."""
        from elastocheck.study.output import frames
        return next(frames(self, at_once=self.study.count))


def _shard(words):
    match = re.fullmatch(r"(\d{1,6})/(\d{1,6})", words) if words else re.fullmatch("(1)/(1)", "1/1")
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise ArgumentError(f"--shard '{words}': allowed: K/N, such as 2/8, K from 1 to N")
    return int(match[1]), int(match[2])


def run(file, folder, count=None, *, threads=0, scheduler=None, shard=None, merge=(), show=False, rare=False,
        csv=None, hdf5=None, reproduce="", progress=None, say=lambda words: None):
    """Many variants of a scene by a study file; the same call goes on where it was interrupted.

    Rows are kept in ledger.sqlite in the folder. `count` replaces that of the file; `scheduler`: address of a dask
    cluster; `shard` "K/N": a part, in a ledger of its own, and None is returned; `merge`: folders with ledgers of
    shards, whose rows are added, and nothing is computed; `show`: nothing is computed or written; `rare`: FORM and
    importance sampling for every limit. `progress(what, done)`; `say` is told what the command prints to standard
    error. Returns a Report. Throws SceneError, SheetError, FileError, ArgumentError.
    """
    from elastocheck.study import output, statistics
    part, folder = _shard(shard), os.fspath(folder)
    if show and (merge or shard):
        raise ArgumentError("--show computes nothing: not with --merge or --shard")
    if merge and shard:
        raise ArgumentError("--merge is for the whole study: not with --shard")
    study = Study(file, count)
    if rare and not all(v.continuous for v in study.variables):
        raise ArgumentError("--rare needs continuous distributions")
    name = os.path.join(folder, "ledger-{}-of-{}.sqlite".format(*part) if shard else "ledger.sqlite")
    if not show:
        os.makedirs(folder, exist_ok=True)
        for kind in ("statistics.json", "study.html") if not shard else ():
            output._core.check_may_write(os.path.join(folder, kind), *output.KINDS[kind])
    with locked(name) if not show else contextlib.nullcontext():
        ledger = Ledger(name, study, write=not show, same_version=not show)
        for table, k in ledger.damaged:
            say(f"{name}: row {k} of {table}: its content is not that of its checksum; it is computed again")
        for shards in merge:
            files = sorted(glob.glob(os.path.join(glob.escape(shards), "ledger-*.sqlite")))
            if not files:
                raise FileError(f"{shards}: no ledger of a shard, ledger-K-of-N.sqlite, in it")
            for other in files:
                ledger.merge(Ledger(other, study, write=False))
        left = _missing(ledger, study.count, part)
        if left and not show and not merge:
            begin, computed = time.monotonic(), sum(map(len, left))
            with _solvers(study, threads, scheduler) as (submit, most):
                _compute(study, ledger, left, submit, most, progress)
            seconds = time.monotonic() - begin
            say(f"{computed} variants computed in {seconds:.1f} s, {computed / seconds:.0f} per second")
            left = _missing(ledger, study.count, part)
        if left:
            ranges = [f"{len(ks)} of {ks[0] - ks[0] % BATCH} to {min(ks[0] - ks[0] % BATCH + BATCH, study.count) - 1}" for ks in left[:10]]
            say(f"{sum(map(len, left))} variants are missing: {', '.join(ranges + ['...'] * (len(left) > 10))}")
        if shard:
            say(f"Shard {shard}: {int(ledger.present(study.count).sum())} variants in {name}")
            return None
        report = Report(study, ledger, reproduce, statistics.rare_rows(study, threads) if rare else (), len(left))
        for kind, to in [("csv", csv), ("hdf5", hdf5)]:
            if to:
                output.write_rows(report, os.fspath(to), kind)
                say(f"Written: {to}")
        if not show:
            output.write(report, folder)
            say("Written: " + ", ".join(os.path.join(folder, kind) for kind in ("statistics.json", "study.html")))
        for sentence in report.disagreements:
            say(sentence)
        return report
