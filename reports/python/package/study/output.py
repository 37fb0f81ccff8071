"""What a study reports: text, JSON, a page, all rows as CSV and HDF5."""
import contextlib
import json
import math
import os

import numpy as np

from elastocheck import _core
from elastocheck.study.design import Design
from elastocheck.study.statistics import independent

# How readers see the columns of tables; other columns are in the JSON only.
_FORMATS = dict.fromkeys(["figure", "variable", "unit", "distribution", "outcome", "reason", "limit", "design point"], "")
_FORMATS |= dict.fromkeys(["design", "mean", "sd", "least", "largest", "1 %", "5 %", "50 %", "95 %", "99 %", "min", "max"], "{:g}")
_FORMATS |= dict.fromkeys(["values", "missing", "variant", "of variant", "witnesses", "one only"], "{:.0f}")
_FORMATS |= dict.fromkeys(["+-", "difference", "FORM", "sampled", "sampled from", "sampled to"], "{:.1e}")
_FORMATS |= dict.fromkeys(["first", "first from", "first to", "total", "total from", "total to", "beta"], "{:.3g}")
_FORMATS |= dict.fromkeys(["outside", "outside from", "outside to"], "{:.1%}")
_MOST_ROWS = 15  # of a table that is open on the page


def _cell(value, form):
    if isinstance(value, str):
        return value
    return form.format(value).replace("%", " %") if math.isfinite(value) else "-"


def _shown(rows):
    """The columns of a table for readers: (heading, whether it has words, cells)."""
    for key, form in ((key, _FORMATS[key]) for key in rows[0] if key in _FORMATS):
        cells = [_cell(row[key], form) for row in rows]
        if any(cell not in ("", "-") for cell in cells):
            yield key.split(" ")[-1] if key.endswith((" from", " to")) else key, not form, cells


def _text(rows):
    columns = []
    for head, words, cells in _shown(rows):
        width = max(map(len, [head, *cells]))
        columns.append([x.ljust(width) if words else x.rjust(width) for x in [head, *cells]])
    return "".join("  " + "  ".join(line).rstrip() + "\n" for line in zip(*columns))


def captions(report):
    return {"variables": "", "figures": "", "sobol": "Shares of the variance (Sobol indices)\n", "rare": "Rare failures\n",
            "witnesses": f"Every {report.study.witness} variants by the equilibrium leg too\n", "failed": "The first failed variants\n"}


def text(report):
    tables = "\n".join(caption + _text(report.tables[key]) for key, caption in captions(report).items() if report.tables[key])
    return f"{report.answer}\n\n{tables}\nContent {report.content}\n"


def document(report):
    study = report.study
    return {"schema": "elastocheck/study/2", "reproduce": report.reproduce,
            "provenance": {"version": _core.build, "compiler": _core.compiler}, "study": study.file, "scene": study.scene_file,
            "identity": study.identity, "count": study.count, "rows": report.rows, "outcomes": report.outcomes,
            "disagreements": report.disagreements, **report.tables, "content": report.content}


def to_json(value):
    """A number that is not finite is null."""
    def clean(x):
        if isinstance(x, dict):
            return {key: clean(item) for key, item in x.items()}
        if isinstance(x, (list, tuple)):
            return [clean(item) for item in x]
        x = x.item() if isinstance(x, np.generic) else x
        return None if isinstance(x, float) and not math.isfinite(x) else x
    return json.dumps(clean(value), indent=1, ensure_ascii=False) + "\n"


# ---- The page: of each figure its histogram, the shares of its variance, its values over the variables that matter.

def heading(of):
    return f"{of.name} [{of.unit}]" if of.unit else of.name


def _spread(study, most=400):
    """Independent variants, evenly spread, not at equal distances: of a Sobol sequence those leave gaps that it has not."""
    bases = study.count // study.block
    at = np.arange(min(most, bases))
    k = np.minimum((at + at * 0.6180339887498949 % 1) / len(at) * bases, bases - 1).astype(int) * study.block
    design = Design(study)
    return k, np.concatenate([design.values(i, i + 1) for i in k])


def _with_gaps(parts):
    return [row for part in parts for row in [*part, []]][:-1]


def _histogram(figure, values):
    bins = int(np.clip(math.sqrt(len(values)), 10, 40)) if np.ptp(values) > 0 else 1
    counts, edges = np.histogram(values, bins)
    bars = [[(a + b) / 2, n, a, b, 0, n] for a, b, n in zip(edges, edges[1:], counts)]
    limits = [[[x, 0], [x, counts.max()]] for x in (figure.low, figure.high) if math.isfinite(x)]
    return {"title": "Distribution", "description": f"Histogram of {len(values)} values of {figure.name}.",
            "x": heading(figure), "y": "variants", "y_low": 0,
            "series": [{"style": "bars", "colour": 2, "rows": bars}]
            + ([{"title": "limit", "style": "dashed", "colour": 1, "rows": _with_gaps(limits)}] if limits else [])}


def _bars(figure, shares, what, kind):
    """Of [(variable, value, low, high)]."""
    bars = [[x / 2, -k, min(x, 0), max(x, 0), -k - 0.3, -k + 0.3] for k, (_, x, _, _) in enumerate(shares, 1)]
    whiskers = [[[low, -k], [high, -k]] for k, (_, _, low, high) in enumerate(shares, 1) if math.isfinite(low)]
    return {"title": what, "description": f"{kind} of {figure.name}: " + "; ".join(f"{v.name} {x:.2g}" for v, x, _, _ in shares) + ".",
            "x": kind, "y_ticks": [[-k, v.name] for k, (v, *_) in enumerate(shares, 1)],
            "y_low": -len(shares) - 0.6, "y_high": -0.4, "height": 0.45 + 0.08 * len(shares),
            "series": [{"style": "bars", "colour": 2, "rows": bars}]
            + ([{"title": "interval of 95 %", "style": "line", "rows": _with_gaps(whiskers)}] if whiskers else [])}


def _plots(report, j, k, x):
    study, figure = report.study, report.study.figures[j]
    values = report.ledger.values(j, study.count)
    drawn, ok = independent(study, values), np.isfinite(values[k])
    if not np.isfinite(drawn).any():
        return []
    y = values[k][ok]
    shares = [(v, row["total"], row["total from"], row["total to"]) for v, row in
              zip(study.variables, (row for row in report.tables["sobol"] if row["figure"] == figure.name))]
    what, kind = ("Shares of the variance", "total Sobol index") if shares else ("Squared correlation", "squared correlation with the variable")
    if not shares:
        with np.errstate(all="ignore"):
            correlations = [np.corrcoef(column[ok], y)[0, 1] ** 2 if len(y) > 1 else 0 for column in x.T]
        shares = [(v, r, math.nan, math.nan) for v, r in zip(study.variables, np.nan_to_num(correlations))]
    shares.sort(key=lambda share: -share[1])
    scatters = [{"title": "Over " + v.name, "description": f"{figure.name} of up to {len(k)} variants over {v.name}.",
                 "x": heading(v), "y": heading(figure),
                 "series": [{"style": "points", "colour": 2, "rows": _with_gaps([p] for p in zip(x[ok, study.variables.index(v)], y))}]}
                for v, *_ in shares[:3]]
    return [_histogram(figure, drawn[np.isfinite(drawn)]), _bars(figure, shares[:8], what, kind), *scatters]


def _table(caption, columns):
    """For the template: page/templates/html/table.mustache."""
    columns = list(columns)
    rows = [{"cells": [{"text": cell, "words": words, "note": False, "head": not k} for k, (cell, (_, words, _)) in enumerate(zip(row, columns))]}
            for row in zip(*(cells for _, _, cells in columns))]
    return {"caption": caption, "columns": [{"name": head, "words": words, "note": False} for head, words, _ in columns],
            "rows": rows, "folded": len(rows) > _MOST_ROWS}


def page(report):
    study = report.study
    k, x = _spread(study)
    figures = [{"id": f"figure-{j + 1}", "name": f.name, "words": f"{f.words}, in {f.unit}.", "plots": _plots(report, j, k, x),
                "caption": f"Distribution of all values; shares of the variance by each variable; values of up to {len(k)} "
                "variants over the variables that matter most."} for j, f in enumerate(study.figures)]
    tables = [_table(captions(report)[key].strip() or key.capitalize(), _shown(rows)) for key, rows in report.tables.items() if rows]
    made = [("elastocheck", _core.build), ("compiler", _core.compiler),
            ("scene", f"{study.scene_file}, hash {study.identity['scene']}"),
            ("study", f"{study.file}, hash {study.identity['study']}"), ("content", report.content)]
    return _core.study_page(to_json({
        "title": "Study " + os.path.splitext(os.path.basename(study.file))[0], "answer": report.answer + ".",
        "notes": report.disagreements, "figures": figures, "tables": tables, "reproduce": report.reproduce,
        "provenance": _table("Made by", [(head, True, cells) for head, cells in zip(["what", "which"], zip(*made))])}))


KINDS = {"statistics.json": ("statistics of a study", '{"schema":"elastocheck/study/'),
         "study.html": ("page of a study", '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
                        '<meta name="generator" content="elastocheck study">'),
         "csv": ("variants", "variant,outcome,"), "hdf5": ("variants", b"\x89HDF")}


def write(report, folder):
    """statistics.json and study.html."""
    for name, content in [("statistics.json", to_json(report.document)), ("study.html", page(report))]:
        _core.write_whole(os.path.join(folder, name), content, *KINDS[name])


# ---- All rows.

def frames(report, at_once):
    """pandas.DataFrames with a row for each variant: its number, outcome, reason, variables, figures."""
    import pandas
    study, design = report.study, Design(report.study)
    for first in range(0, study.count, at_once):
        end = min(first + at_once, study.count)
        rows = list(report.ledger.each("variants", first, end))
        k = np.array([row[0] for row in rows], int)
        head = pandas.DataFrame({"variant": k, "outcome": [row[1] for row in rows], "reason": [row[3] or "" for row in rows]})
        drawn = pandas.DataFrame(design.values(first, end)[k - first], columns=map(heading, study.variables))
        figures = pandas.DataFrame([row[4:-1] for row in rows], columns=map(heading, study.figures), dtype=float)
        yield pandas.concat([head, drawn, figures], axis=1)


def _write_hdf5(tables, file):
    """A data set for each column; a "/" in its name is a "|"."""
    import h5py
    with h5py.File(file, "w") as out:
        for table in tables:
            for name, column in table.items():
                values, name = column.to_numpy(), name.replace("/", "|")
                kind = h5py.string_dtype() if values.dtype == object else values.dtype
                data = out[name] if name in out else out.create_dataset(name, (0,), kind, maxshape=(None,))
                data.resize(len(data) + len(values), axis=0)
                data[len(data) - len(values):] = values


def write_rows(report, file, kind):
    """As "csv" or "hdf5"; the file is replaced when it is complete."""
    _core.check_may_write(file, *KINDS[kind])
    try:
        tables = frames(report, at_once=16384)
        if kind == "hdf5":
            _write_hdf5(tables, file + ".part")
        else:
            with open(file + ".part", "w", newline="") as out:
                for j, table in enumerate(tables):
                    table.to_csv(out, index=False, header=not j)
        os.replace(file + ".part", file)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.remove(file + ".part")
