"""Reads the file of a study: reports/README.md, "Studies"."""
import fnmatch
import functools
import hashlib
import math
import os
from dataclasses import dataclass, field

import numpy as np
from scipy import stats

from elastocheck import _core, read
from elastocheck._errors import ArgumentError, FileError, SheetError
from elastocheck.study.design import Design

MOST = 1_000_000_000  # variants
# Kind of distribution: names of its numbers, its description by them, SciPy's distribution of them.
DISTRIBUTIONS = {
    "normal": (["mean", "sd"], "normal, {:g}, sd {:g}".format, stats.norm),
    "uniform": (["low", "high"], "uniform, {:g} to {:g}".format, lambda low, high: stats.uniform(low, high - low)),
    "triangular": (["low", "mode", "high"], "triangular, {0:g} to {2:g}, mode {1:g}".format,
                   lambda low, mode, high: stats.triang((mode - low) / (high - low), low, high - low)),
    "truncated_normal": (["mean", "sd", "low", "high"], "normal, {:g}, sd {:g}, between {:g} and {:g}".format,
                         lambda mean, sd, low, high: stats.truncnorm((low - mean) / sd, (high - mean) / sd, mean, sd)),
    "list": ([], lambda *values: f"list of {len(values)}, {min(values):g} to {max(values):g}", None),
    "": ([], lambda: "as listed", None)}
DRAWN = ["monte_carlo", "latin_hypercube", "sobol"]


@dataclass
class Variable:
    """A number of the scene, or a factor of several; `kind` "": given by a list of variants."""
    name: str
    unit: str = ""
    nominal: float = 1.0
    kind: str = ""
    numbers: tuple = ()  # mean, sd | low, high | low, mode, high | mean, sd, low, high | values
    scaled: dict = field(default_factory=dict)  # numbers of the scene and their nominal values

    @property
    def continuous(self):
        return self.kind not in ("", "list")

    @functools.cached_property
    def distribution(self):
        return DISTRIBUTIONS[self.kind][2](*self.numbers)

    @property
    def ends(self):
        """Ends of a bounded distribution, or its values; the mean of an unbounded one."""
        bounds = self.numbers[{"normal": 2, "truncated_normal": 2}.get(self.kind, 0):]
        return (min(bounds), max(bounds)) if bounds else self.numbers[:1]

    def __str__(self):
        return DISTRIBUTIONS[self.kind][1](*self.numbers)


@dataclass
class Figure:
    """An output at a station of a branch, or its extreme over the branch, and its limits."""
    name: str
    words: str
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf

    @property
    def limited(self):
        return self.low > -math.inf or self.high < math.inf


def _number(at, key, otherwise=None):
    given = at.get(key) if otherwise is not None else at.need(key)
    return given.number() if given else otherwise


def _positive(at):
    x = at.number()
    return x if x > 0 else at.fail(f"{x:g}; allowed: more than zero")


def _distribution(kind, at, nominal):
    if kind == "list":
        return tuple(value.number() for value in at.items("values")) or at.fail("no value in it")
    fields, given = DISTRIBUTIONS[kind][0], {"mean": nominal, "mode": nominal}
    at.only(fields + ["half_width"] * ("low" in fields))
    if half := at.get("half_width"):
        if at.get("low") or at.get("high"):
            half.fail("given together with low or high; allowed: one of the two forms")
        given |= {"low": nominal - _positive(half), "high": nominal + _positive(half)}
    numbers = {key: _positive(at.need(key)) if key == "sd" else _number(at, key, given.get(key)) for key in fields}
    low, high = numbers.get("low", -math.inf), numbers.get("high", math.inf)
    if not low < high:
        at.fail(f"low {low:g} is not below high {high:g}")
    if kind == "triangular" and not low <= numbers["mode"] <= high:
        at.fail(f"mode {numbers['mode']:g} is not between low {low:g} and high {high:g}")
    if "sd" in fields and not (low - 8 * numbers["sd"] < numbers["mean"] < high + 8 * numbers["sd"]):
        at.fail("the ends lie more than eight standard deviations beside the mean")
    return tuple(numbers.values())


class Study:
    """A study as data. Everything is checked before the first variant.

    `count` replaces that of the file. Throws SceneError and SheetError "file:line: field: ...", FileError.
    """

    def __init__(self, file, count=None):
        self.file = os.fspath(file)
        try:
            with open(self.file, "rb") as text:
                whole = _core.Field(text.read(), self.file)
        except OSError as error:
            raise FileError(f"{self.file}: {error.strerror}") from error
        whole.only(["elastocheck_study", "scene", "variables", "groups", "design", "figures", "limits", "witness"])
        whole.need("elastocheck_study").whole(1, 1)
        at, variables, figures = whole.need("scene"), whole.need("variables"), whole.need("figures")
        self.scene_name = at.text("the file of a scene")
        self.scene_file = os.path.join(os.path.dirname(self.file), self.scene_name)
        if not os.path.isfile(self.scene_file):
            at.fail(f"{self.scene_file}: there is no such file")
        # In reasons of failed variants the scene has the name that it has here, wherever they are computed.
        self.scene, self.varied_by = read(self.scene_file, name=self.scene_name), {}
        self.variables = [self._variable(name, at) for name, at in variables.entries()]
        if not 1 <= len(self.variables) <= 500:
            variables.fail(f"{len(self.variables)} variables; allowed: 1 to 500, NUMBER: {{normal: {{sd: 0.5}}}}")
        self.names = [v.name for v in self.variables]
        groups, witness = whole.get("groups"), whole.get("witness")
        self.correlation = self._correlation(groups) if groups else None
        self._read_figures(figures, whole.get("limits"))
        self._read_design(whole, whole.need("design"), count)
        self.witness = witness.whole(0, MOST) if witness else 0
        # What solves the variants, here and on other machines.
        self.paths = [path for v in self.variables for path in (v.scaled or [v.name])]
        self.words = [(figure.name, figure.words) for figure in self.figures]
        try:
            self.solver = _core.Variants(self.scene, self.paths, self.words)
        except ArgumentError as error:
            figures.fail(str(error))
        # The scene has to be valid with each variable at its ends; a variant that is not valid is a row with a reason.
        self.nominal = np.array([[v.nominal for v in self.variables]])
        for j, end in ((j, end) for j, v in enumerate(self.variables) for end in v.ends):
            values = self.nominal.copy()
            values[0, j] = end
            if wrong := self.solver.invalid(self.numbers(values)[0]):
                variables.need(self.names[j]).fail(f"{end:g} can be drawn, and with it the scene is invalid: {wrong}")

    def numbers(self, values):
        """The numbers of the scene [n x paths] by values of the variables [n x variables]."""
        return np.column_stack([values[:, j] * nominal for j, v in enumerate(self.variables)
                                for nominal in (v.scaled.values() if v.scaled else [1.0])])

    def _claim(self, at, path, variable):
        if path.startswith("branches."):
            at.fail(path + ": branches are the same for all variants; allowed: other numbers")
        both = path.split("@")[0]
        for other, by in self.varied_by.items():  # the same number, or that of both sides and of one of them
            if other == path or (other.split("@")[0] == both and both in (other, path)):
                at.fail(f"{path} is varied by '{by}' too")
        self.varied_by[path] = variable

    def _variable(self, name, at):
        known, variable, scale = self.scene.numbers, Variable(name), at.get("scale")
        at.only([*filter(None, DISTRIBUTIONS), "scale"])
        for entry in (scale.items("patterns") if scale.is_list else [scale]) if scale else ():
            pattern = entry.text("a number of the scene or a pattern with *")
            for path in fnmatch.filter(known, pattern) or entry.fail(
                    f"the scene has no number '{pattern}'" + _core.did_you_mean(pattern, list(known), "numbers")):
                self._claim(entry, path, name)
                variable.scaled[path] = known[path]
        if not scale:
            variable.nominal, variable.unit = self.scene.number(name) or at.fail(
                "the scene has no such number" + _core.did_you_mean(name, list(known), "numbers")
                + "; a factor of numbers needs `scale: NUMBERS`")
            self._claim(at, name, name)
        given = [(kind, at.get(kind)) for kind in DISTRIBUTIONS if kind and at.get(kind)]
        if len(given) > 1:
            given[1][1].fail("a second distribution; allowed: one")
        for variable.kind, found in given:
            variable.numbers = _distribution(variable.kind, found, variable.nominal)
        return variable

    def _correlation(self, section):
        correlation, grouped = np.eye(len(self.variables)), []
        for group in section.items("groups"):
            group.only(["variables", "correlation"])
            names, rows = group.need("variables").items("variables"), group.need("correlation")
            for name in names:
                grouped.append(self.names.index(name.one_of("a variable", self.names)))
                if not self.variables[grouped[-1]].continuous:
                    name.fail("has no continuous distribution, so that it cannot be correlated")
                if grouped[-1] in grouped[:-1]:
                    name.fail("is in a group already")
            if len(names) < 2:
                group.need("variables").fail("a group needs two variables")
            cells = [[cell.number() for cell in row.items("correlations")] for row in rows.items("rows")]
            if [len(row) for row in cells] != [len(names)] * len(names):
                rows.fail(f"expected {len(names)} rows of {len(names)} correlations, one for each variable")
            R = np.array(cells)
            if (np.abs(R) > 1).any() or (np.diag(R) != 1).any() or (R != R.T).any():
                rows.fail("is not symmetric, or has other numbers than -1 to 1, and 1 on the diagonal")
            if not np.linalg.eigvalsh(R)[0] > 1e-12:
                rows.fail("is not positive definite: these correlations contradict each other, "
                          "or a variable is a function of others")
            correlation[np.ix_(grouped[-len(names):], grouped[-len(names):])] = R
        return correlation

    def _read_design(self, whole, at, count):
        at.only(["kind", "count", "seed", "indices", "file"])
        kind, variables = at.need("kind"), whole.need("variables")
        self.kind = kind.one_of("a design", ["grid", "list", *DRAWN])
        sized = "not of a grid or a list, which say how many variants there are"
        for key, kinds, why in [("file", ["list"], "only of a list"), ("count", DRAWN, sized), ("seed", DRAWN, sized),
                                ("indices", ["monte_carlo", "sobol"], "only of a sobol or monte_carlo design")]:
            if at.get(key) and self.kind not in kinds:
                at.get(key).fail(why)
        # `block`: variants in a block of the design: a, b, then a with one variable after the other from b.
        self.seed, self.indices, self.table, self.block = 0, False, None, 1
        if self.kind not in DRAWN:
            if self.correlation is not None:
                whole.need("groups").fail("not of a grid or a list, which draw nothing")
            if self.kind == "list":
                self.table = self._read_table(at.need("file"))
            for variable in self.variables if self.kind == "grid" else ():
                if variable.kind != "list":
                    kind.fail(f"a grid needs a list of values for each variable, and '{variable.name}' has none")
            size = math.prod(len(v.numbers) for v in self.variables) if self.table is None else len(self.table)
            if size > MOST:
                kind.fail(f"a grid of more than {MOST} combinations")
            if count and count > size:
                kind.fail(f"{count} variants are requested, and there are {size}")
            self.count = count or size
            return
        for variable in self.variables:
            if not variable.kind:
                variables.need(variable.name).fail("no distribution; allowed: normal, uniform, triangular, truncated_normal, list")
        size, self.seed = at.need("count"), at.need("seed").whole(0, MOST)
        self.count = count or size.whole(1, MOST)
        if self.kind == "latin_hypercube" and self.count != size.whole(1, MOST):
            size.fail("a Latin hypercube cannot be extended: all its variants depend on their number; "
                      "allowed: a sobol or monte_carlo design")
        self.indices = bool(at.get("indices")) and at.get("indices").one_of("yes or no", ["true", "false"]) == "true"
        if self.indices and self.correlation is not None:
            at.need("indices").fail("Sobol indices need independent variables, and there are groups")
        self.block = len(self.variables) + 2 if self.indices else 1
        if self.count < self.block:
            size.fail(f"{self.count} variants are less than one block of {self.block} for Sobol indices")

    def _read_table(self, at):
        """Values by a CSV file, columns by the names of the variables [variants x variables]."""
        import pandas
        file = os.path.join(os.path.dirname(self.file), at.text("a CSV file"))
        try:
            table = pandas.read_csv(file, skipinitialspace=True, skip_blank_lines=False, dtype=str, keep_default_na=False)
        except (OSError, ValueError) as error:
            at.fail(f"{file}: {error}")
        for name in set(table.columns) - set(self.names):
            raise SheetError(f"{file}:1: the study has no variable '{name}'" + _core.did_you_mean(name, self.names, "variables"))
        if len(table.columns) != len(self.names):
            raise SheetError(f"{file}:1: {len(table.columns)} columns, but the study has {len(self.names)} variables")
        values = np.empty((len(table), len(self.names)))
        for (row, column), cell in np.ndenumerate(table[self.names].to_numpy()):
            try:
                values[row, column] = cell if math.isfinite(float(cell)) else "not finite"
            except ValueError:
                raise SheetError(f"{file}:{row + 2}: {self.names[column]}: " + (f"'{cell}' is not a number" if cell else "no value")) from None
        return values

    def _read_figures(self, section, limits):
        self.figures = [Figure(name, at.text("an output, such as toe@jounce:3000")) for name, at in section.entries()]
        if not 1 <= len(self.figures) <= 1000:
            section.fail(f"{len(self.figures)} figures; allowed: 1 to 1000, NAME: toe@jounce:3000")
        by_name = {figure.name: figure for figure in self.figures}
        for figure in self.figures:
            try:
                figure.unit = _core.unit_of_figure(self.scene, figure.words)
            except ArgumentError as error:
                section.need(figure.name).fail(str(error))
        for name, at in limits.entries() if limits else ():
            figure = by_name.get(name) or at.fail(
                "the study has no such figure" + _core.did_you_mean(name, list(by_name), "figures"))
            at.only(["min", "max"])
            figure.low, figure.high = _number(at, "min", -math.inf), _number(at, "max", math.inf)
            if not figure.limited:
                at.fail("no limit; allowed: {min: ..., max: ...}")
            if figure.low > figure.high:
                at.fail("min is above max")

    @functools.cached_property
    def identity(self):
        """Hashes of all that a row depends on; that is neither the limits nor, but for a Latin hypercube, the number of
        variants."""
        parts = [[(v.name, v.kind, v.numbers, list(v.scaled)) for v in self.variables],
                 self.correlation is not None and self.correlation.tolist(), self.kind, self.seed, self.indices,
                 self.witness, self.words, self.kind == "latin_hypercube" and self.count,
                 self.table is not None and self.table.tolist()]
        # The first values too: another version of a library may draw others. Of the scene, tables of curves in other files too.
        first = Design(self).values(0, min(self.count, self.block))
        with open(self.scene_file, "rb") as text:
            contents = {"scene": text.read() + _core.hash_of_curves(self.scene).encode(), "study": repr(parts).encode() + first.tobytes()}
        return {key: hashlib.sha256(content).hexdigest()[:16] for key, content in contents.items()} | {"version": _core.build}
