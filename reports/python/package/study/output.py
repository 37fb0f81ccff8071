"""What a study reports: its result, of which the program makes text, JSON and page; all rows as CSV and HDF5."""
import contextlib
import json
import os
import warnings

import numpy as np

from elastocheck import Result, _core
from elastocheck.study.design import Design
from elastocheck.study.ledger import OUTCOMES
from elastocheck.study.statistics import figure_row, independent, sobol_rows, squared_correlation, witness_row

# How readers see the columns of tables; other columns are in the JSON only.
_DIGITS = {column: digits for digits, columns in {
    "words": ["figure", "variable", "unit", "distribution", "outcome", "reason", "limit", "design point"],
    "given": ["design", "mean", "sd", "least", "largest", "1 %", "5 %", "50 %", "95 %", "99 %", "min", "max"],
    "whole": ["values", "missing", "variant", "of variant", "witnesses", "one only"],
    "size": ["+-", "difference", "FORM", "sampled", "sampled from", "sampled to"],
    "three": ["first", "first from", "first to", "total", "total from", "total to", "beta"],
    "percent": ["outside", "outside from", "outside to"]}.items() for column in columns}
_DATA = ("correlations", "histograms", "sample")  # tables of charts
KINDS = {"statistics.json": ("statistics of a study", '{\n "schema": "elastocheck/study/'),
         "study.html": ("page of a study", '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
                        '<meta name="generator" content="elastocheck study">'),
         "csv": ("variants", "variant,outcome,"), "hdf5": ("variants", b"\x89HDF")}


def heading(quantity):
    return f"{quantity.name} [{quantity.unit}]" if quantity.unit else quantity.name


def _table(name, rows, caption):
    columns = [(key, key.split(" ")[-1] if key.endswith((" from", " to")) else key,
                "hidden" if name in _DATA else _DIGITS.get(key, "hidden")) for key in rows[0]]
    return name, caption, columns, [list(row.values()) for row in rows]


class Report(Result):
    """What a study found: `text` as on the terminal, `document` as in statistics.json, frame() with a row for each variant.

    `exit_code` 0: every variant has a row; 3: some have none, none is solved, or witnesses disagree: then it is false.
    """

    def __init__(self, study, ledger, reproduce="", rare=(), missing=0):
        self.study, self.ledger, self.content, count = study, ledger, ledger.content_hash(study.count), study.count
        groups = ledger.rows("SELECT outcome, count(*), sum(method != 'series') FROM variants WHERE k < ? GROUP BY outcome", count)
        self.outcomes = {name: sum(rows for outcome, rows, _ in groups if outcome == name) for name in OUTCOMES}
        self.rows, others = sum(self.outcomes.values()), sum(other for _, _, other in groups)
        parts = [f"{rows} {name}" for name, rows in self.outcomes.items() if rows]
        parts += [f"{others} of all by the equilibrium leg, where series declines"] if others else []
        with warnings.catch_warnings():  # of a single value, of shares of 0 and 1
            warnings.simplefilter("ignore", RuntimeWarning)
            rows, reasons, charts = self._rows(rare)
        reasons += [f"{missing} variants are missing"] if missing else []
        reasons += [] if self.outcomes["solved"] else ["no variant is solved"]
        captions = {"variables": "Variables", "figures": "Figures", "sobol": "Shares of the variance (Sobol indices)",
                    "rare": "Rare failures", "witnesses": f"Every {study.witness} variants by the equilibrium leg too",
                    "failed": "The first failed variants"} | dict.fromkeys(_DATA, "")
        self.found = _core.Findings(
            f"{self.rows} of {count} variants: {', '.join(parts)}.", reasons, sum(row["witnesses"] for row in rows["witnesses"]),
            [_table(name, rows[name], caption) for name, caption in captions.items() if rows[name]], charts, f"Content {self.content}")
        document = {"schema": "elastocheck/study/3", "reproduce": reproduce,
                    "provenance": {"version": _core.build, "compiler": _core.compiler}, "study": study.file, "scene": study.scene_file,
                    "identity": study.identity, "count": count, "rows": self.rows, "outcomes": self.outcomes,
                    "content": self.content} | json.loads(self.found.document)
        self.printed = json.dumps(document, indent=1, ensure_ascii=False) + "\n"
        super().__init__(3 if reasons else 0, self.printed, self.found.text, "")

    def _rows(self, rare):
        """Rows of every table, reasons against the verdict, charts."""
        study, ledger, count, design = self.study, self.ledger, self.study.count, Design(self.study)
        rows = {name: [] for name in ("figures", "sobol", "witnesses", "correlations", "histograms")} | {"rare": list(rare)}
        rows["variables"] = [{"variable": v.name, "unit": v.unit, "design": v.nominal, "distribution": str(v),
                              "scales": len(v.scaled)} for v in study.variables]
        rows["failed"] = [dict(zip(["variant", "outcome", "reason"], row)) for row in ledger.rows(
            "SELECT k, outcome, reason FROM variants WHERE outcome != 'solved' AND k < ? ORDER BY k LIMIT 10", count)]
        # Some independent variants.
        bases = count // study.block
        k = np.sort(np.random.default_rng(study.seed).choice(bases, min(400, bases), replace=False)) * study.block
        draws = np.reshape([design.values(i, i + 1)[0] for i in k], (len(k), len(study.names)))
        varied = dict(zip(study.names, draws.T))
        sample, reasons, charts = dict(zip(map(heading, study.variables), varied.values())), [], []
        nominal = study.solver.solve(study.numbers(study.nominal), "series", 1)[0][0]
        for j, figure in enumerate(study.figures):
            def chart(kind, title, table, x, y, axis="", marks=(), only=figure.name):
                charts.append((kind, title, table, x, y, only, axis, marks))

            values = ledger.values(j, count)
            drawn = independent(study, values)
            drawn, sample[heading(figure)] = drawn[np.isfinite(drawn)], values[k]
            rows["figures"].append(figure_row(study, figure, values, nominal[j]))
            if study.witness:
                found, wrong = witness_row(study, rows["figures"][-1], values[::study.witness],
                                           ledger.values(j, count, "witnesses")[::study.witness])
                rows["witnesses"].append(found)
                reasons += wrong
            if not len(drawn):
                continue
            bins = int(np.clip(np.sqrt(len(drawn)), 10, 40)) if np.ptp(drawn) > 0 else 1
            counts, edges = np.histogram(drawn, bins)
            rows["histograms"] += [{"figure": figure.name, "from": low, "to": high, "variants": n}
                                   for low, high, n in zip(edges, edges[1:], counts)]
            chart("bars", "Distribution", "histograms", "from", ["to", "variants"], heading(figure), [figure.low, figure.high])
            if shares := sobol_rows(study, figure, values):
                rows["sobol"] += shares
                rank = {row["variable"]: row["total"] for row in shares}
                chart("ranked", "Shares of the variance", "sobol", "variable", ["total", "total from", "total to"], "total Sobol index")
            else:
                rank = {name: squared_correlation(x, values[k]) for name, x in varied.items()}
                rows["correlations"] += [{"figure": figure.name, "variable": name, "squared": x} for name, x in rank.items()]
                chart("ranked", "Squared correlation", "correlations", "variable", ["squared"], "squared correlation")
            for name in sorted(study.names, key=rank.get, reverse=True)[:3]:
                chart("points", "Over " + name, "sample", list(sample)[study.names.index(name)], [heading(figure)])
        rows["sample"] = [dict(zip(sample, map(float, row))) for row in zip(*sample.values())]
        return rows, reasons, charts

    def frame(self, table="variants"):
        """A pandas.DataFrame with a row for each variant: its number, outcome, reason, variables, figures; or a table by
        its name."""
        return next(frames(self, at_once=self.study.count)) if table == "variants" else super().frame(table)

    def write(self, folder):
        """statistics.json and study.html."""
        study = self.study
        made = [("elastocheck", _core.build), ("compiler", _core.compiler),
                ("scene", f"{study.scene_file}, hash {study.identity['scene']}"),
                ("study", f"{study.file}, hash {study.identity['study']}"), ("content", self.content)]
        page = self.found.page("Study " + os.path.splitext(os.path.basename(study.file))[0],
                               {f.name: f"{f.words}, in {f.unit}." for f in study.figures}, self.document["reproduce"], made)
        for name, content in [("statistics.json", self.printed), ("study.html", page)]:
            with replaced(os.path.join(folder, name)) as part, open(part, "w", encoding="utf-8") as out:
                out.write(content)


def frames(report, at_once):
    """pandas.DataFrames with a row for each variant, `at_once` variants in each."""
    import pandas
    study, design = report.study, Design(report.study)
    figures = "".join(", f{} AS '{}'".format(j + 1, heading(f).replace("'", "''")) for j, f in enumerate(study.figures))
    for first in range(0, study.count, at_once):
        end = min(first + at_once, study.count)
        table = pandas.read_sql_query(f"SELECT k AS variant, outcome, ifnull(reason, '') AS reason{figures} FROM variants "
                                      "WHERE k >= ? AND k < ? ORDER BY k", report.ledger.base, params=(first, end))
        drawn = pandas.DataFrame(design.values(first, end)[table["variant"] - first], columns=map(heading, study.variables))
        yield pandas.concat([table.iloc[:, :3], drawn, table.iloc[:, 3:].astype(float)], axis=1)


@contextlib.contextmanager
def replaced(file):
    """A file to write beside this one, which it replaces when it is complete."""
    try:
        yield file + ".part"
        os.replace(file + ".part", file)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.remove(file + ".part")


def write_csv(report, file):
    with replaced(file) as part, open(part, "w", newline="") as out:
        for j, table in enumerate(frames(report, at_once=16384)):
            table.to_csv(out, index=False, header=not j)


def write_hdf5(report, file):
    """A data set for each column; a "/" in its name is a "|"."""
    import h5py
    with replaced(file) as part, h5py.File(part, "w") as out:
        for table in frames(report, at_once=16384):
            for name, column in table.rename(columns=lambda name: name.replace("/", "|")).items():
                kind = h5py.string_dtype() if column.dtype == object else column.dtype
                data = out[name] if name in out else out.create_dataset(name, (0,), kind, maxshape=(None,))
                data.resize(len(data) + len(column), axis=0)
                data[len(data) - len(column):] = column.to_numpy()
