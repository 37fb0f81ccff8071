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

from elastocheck import _core
from elastocheck._errors import ArgumentError, FileError
from elastocheck.study import output, statistics
from elastocheck.study.design import Design
from elastocheck.study.file import Study
from elastocheck.study.ledger import Ledger, locked, naming
from elastocheck.study.output import Report

BATCH = 256  # variants that are solved and recorded together; the unit that shards divide


def _solved(solver, ks, numbers, witnesses):
    """Rows of the ledger for the variants with the numbers `ks`, and for their `witnesses` (positions in `ks`)."""
    tables = []
    for at, leg in [(range(len(ks)), "series"), (witnesses, "equilibrium")]:
        values, outcomes, legs, reasons = solver().solve(numbers[at], leg, 1)
        # As SQLite stores it: NULL for nan, and zero without a sign.
        stored = np.where(np.isnan(values), None, values + 0.0).tolist()
        tables.append([(ks[i], outcome, by, reason or None, *row) for i, outcome, by, reason, row in zip(at, outcomes, legs, reasons, stored)])
    return tables


@functools.lru_cache(maxsize=1)
def _solver_on_worker(file, count, identity):
    """The solver of a study in a worker of a cluster; it stays there for the next batch."""
    study = Study(file, count)
    if study.identity != dict(identity):
        raise FileError(f"{file}: the study, its scene or the version of the program is another one on this worker")
    return study.solver


@contextlib.contextmanager
def _solvers(study, threads, scheduler):
    """A function that submits a batch, and the number of batches to submit at once: to threads of this process, or to the
    workers of a dask cluster, where the batch of a worker that is killed is computed by another."""
    if not scheduler:
        threads = threads or len(os.sched_getaffinity(0))
        with concurrent.futures.ThreadPoolExecutor(threads) as pool:
            try:
                yield functools.partial(pool.submit, _solved, lambda: study.solver), 2 * threads
            finally:
                pool.shutdown(wait=False, cancel_futures=True)
        return
    import distributed
    try:
        client = distributed.Client(scheduler, timeout=10)
    except (OSError, ValueError) as error:
        raise ArgumentError(f"--scheduler {scheduler}: {error}") from error
    solver = functools.partial(_solver_on_worker, os.path.abspath(study.file), study.count, tuple(study.identity.items()))
    with client:
        pool = client.get_executor(pure=False, retries=10)
        yield functools.partial(pool.submit, _solved, solver), 4 * max(sum(client.nthreads().values()), 1)


def _missing(ledger, count, shard):
    """Numbers of variants without a row, per batch of a shard."""
    has = ledger.present(count)
    batches = (first + np.flatnonzero(~has[first:first + BATCH]) for first in range((shard[0] - 1) * BATCH, count, shard[1] * BATCH))
    return [ks for ks in batches if len(ks)]


def _drawn(design, batches):
    """Each batch with the values of its variables; neighbours are drawn at once, which is faster."""
    for _, neighbours in itertools.groupby(batches, lambda ks: ks[0] // (16 * BATCH)):
        neighbours = list(neighbours)
        first = neighbours[0][0]
        values = design.values(first, neighbours[-1][-1] + 1)
        yield from ((ks, values[ks - first]) for ks in neighbours)


def _compute(study, ledger, batches, solvers, progress, say):
    """Solves and records batch after batch; each is one transaction, and its rows do not depend on the others."""
    running, done, begin, total = set(), 0, time.monotonic(), sum(map(len, batches))
    waiting = _drawn(Design(study), batches)
    with solvers as (submit, most):
        while done < total:
            for ks, values in itertools.islice(waiting, most - len(running)):
                witnesses = np.flatnonzero(ks % study.witness == 0) if study.witness else []
                running.add(submit(ks.tolist(), study.numbers(values), witnesses))
            finished, running = concurrent.futures.wait(running, return_when="FIRST_COMPLETED")
            for future in finished:
                ledger.add(*future.result())
                done += len(future.result()[0])
            speed = f"{done / (time.monotonic() - begin):.0f} per second"
            if progress:
                progress(f"{done} of {total} variants, {speed}", done / total)
    say(f"{total} variants computed in {time.monotonic() - begin:.1f} s, {speed}")


def _shard(words):
    match = re.fullmatch(r"(\d{1,6})/(\d{1,6})", words or "1/1")
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise ArgumentError(f"--shard '{words}': allowed: K/N, such as 2/8, K from 1 to N")
    return int(match[1]), int(match[2])


def run(file, folder, count=None, *, threads=0, scheduler=None, shard=None, merge=(), show=False, rare=False,
        csv=None, hdf5=None, reproduce="", progress=None, say=lambda words: None):
    """Many variants of a scene by a study file; the same call goes on where it was interrupted.

    Rows are kept in ledger.sqlite in the folder. `count` replaces that of the file; `scheduler`: address of a dask
    cluster; `shard` "K/N": a part, in a ledger of its own, and None is returned; `merge`: folders with ledgers of
    shards, whose rows are added, and nothing is computed; `show`: nothing is computed or written; `rare`: FORM and
    importance sampling for every limit. `progress(what, done)`; `say` receives the lines that the command prints to
    standard error. Returns a Report. Throws SceneError, SheetError, FileError, ArgumentError.
    """
    part, folder = _shard(shard), os.fspath(folder)
    if show and (merge or shard):
        raise ArgumentError("--show computes nothing: not with --merge or --shard")
    if merge and shard:
        raise ArgumentError("--merge is for the whole study: not with --shard")
    study = Study(file, count)
    if rare and not all(v.continuous for v in study.variables):
        raise ArgumentError("--rare needs continuous distributions")
    name = os.path.join(folder, "ledger-{}-of-{}.sqlite".format(*part) if shard else "ledger.sqlite")
    exports = {} if shard else {kind: os.fspath(to) for kind, to in [("csv", csv), ("hdf5", hdf5)] if to}
    reports = {} if shard or show else {kind: os.path.join(folder, kind) for kind in ("statistics.json", "study.html")}
    for kind, to in (exports | reports).items():
        _core.check_may_write(to, *output.KINDS[kind])
        os.makedirs(os.path.dirname(to) or ".", exist_ok=True)
    if not show:
        os.makedirs(folder, exist_ok=True)
    with naming(name), contextlib.nullcontext() if show else locked(name):
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
            _compute(study, ledger, left, _solvers(study, threads, scheduler), progress, say)
            left = _missing(ledger, study.count, part)
        if left:
            ranges = [f"{len(ks)} of {ks[0] - ks[0] % BATCH} to {min(ks[0] - ks[0] % BATCH + BATCH, study.count) - 1}" for ks in left[:10]]
            say(f"{sum(map(len, left))} variants are missing: {', '.join(ranges + ['...'] * (len(left) > 10))}")
        if shard:
            say(f"Shard {shard}: {int(ledger.present(study.count).sum())} variants in {name}")
            return None
        report = Report(study, ledger, reproduce, statistics.rare_rows(study, threads) if rare else (), sum(map(len, left)))
        for kind, to in exports.items():
            {"csv": output.write_csv, "hdf5": output.write_hdf5}[kind](report, to)
            say(f"Written: {to}")
        if reports:
            report.write(folder)
            say("Written: " + ", ".join(reports.values()))
        return report
