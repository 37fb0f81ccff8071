"""Elastokinematic analysis of suspensions: scenes solved by three methods that check each other.

Numbers, columns, units and messages are those of the command `elastocheck`.
"""

import atexit
import os
import shutil
import tempfile
import warnings
from collections.abc import Iterable, Mapping

from elastocheck import _core
from elastocheck._core import Scene, templates
from elastocheck._errors import (ArgumentError, Error, FileError, NotTrimmed, SceneError,
                                 SceneWarning, SheetError)

__version__ = _core.version
__all__ = [
    "read", "new", "templates", "Scene", "Solution", "Branch", "Output", "Drawing", "Result",
    "kc", "run", "compare", "judge", "certify", "sensitivity", "fit", "study",
    "Error", "SceneError", "NotTrimmed", "SheetError", "FileError", "ArgumentError", "SceneWarning",
]


def _listed(names):
    return [names] if isinstance(names, str) else list(names)


# ---- Scenes.

def read(file, settings=None, *, name=""):
    """The scene of a YAML file, with some numbers of it changed: {"springs.coil.rate": 28}.

    Settings are in the units of the file, as `--set` of the command. Warnings of the reader are
    SceneWarning. `name`: of the file in messages, instead of its path. Throws SceneError,
    NotTrimmed.
    """
    scene = _core.read(os.fspath(file), dict(settings or {}), name)
    for warning in scene.warnings:
        warnings.warn(warning, SceneWarning, stacklevel=2)
    return scene


def new(template, file=None, settings=None):
    """A built-in scene to start from; templates() lists the names.

    With `file` its text is written there, where there is no file yet; else to a temporary file that
    the end of the process removes.
    """
    text = _core.template_text(template)
    if file is None:
        folder = tempfile.mkdtemp(prefix="elastocheck-")
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        file = os.path.join(folder, template + ".yaml")
    with open(file, "x", encoding="utf-8") as out:
        out.write(text)
    return read(file, settings)


class Branch:
    """A path of equilibria of a scene: the unit and the range of its parameter."""

    def __init__(self, name, unit, first, last, steps):
        self.name, self.unit, self.steps = name, unit, steps
        self.from_, self.to = first, last

    def __repr__(self):
        return f"<branch {self.name}: {self.from_:g} to {self.to:g} {self.unit}>"


class Output:
    """An output of a scene: its name, its unit, and its definition with the sign convention."""

    def __init__(self, name, unit, definition):
        self.name, self.unit, self.definition = name, unit, definition

    def __repr__(self):
        return f"<output {self.name} [{self.unit}]: {self.definition}>"


class Drawing:
    """A drawing of a scene as SVG; a notebook shows it."""

    def __init__(self, svg):
        self.svg = svg

    def _repr_svg_(self):
        return self.svg

    def save(self, file):
        """Writes the SVG to a file."""
        with open(file, "w", encoding="utf-8") as out:
            out.write(self.svg)


class Solution(Mapping):
    """Curves of a scene by one leg or method, per branch: solution["travel"]["toe"].

    A branch has numpy arrays: `parameter`, an output by its name, `values` [points, outputs],
    `states` [points, bodies, 7] if they were requested; a value without a number is nan. A branch
    that ends early has the points up to there, `converged` is False, and `outcome` and `detail` say
    why.
    """

    def __init__(self, curves):
        self._curves = {branch.branch: branch for branch in curves}

    def __getitem__(self, branch):
        return self._curves[branch]

    def __iter__(self):
        return iter(self._curves)

    def __len__(self):
        return len(self._curves)

    @property
    def converged(self):
        """Whether every branch was followed to its end."""
        return all(curves.converged for curves in self._curves.values())

    @property
    def messages(self):
        """What the command prints on standard error: why branches end early."""
        lines = []
        for curves in self._curves.values():
            if not curves.converged:
                lines.append(f"{curves.method}: {curves.outcome}: {curves.detail}")
        return lines

    @property
    def units(self):
        """The unit of every output, by its name."""
        for curves in self._curves.values():
            return curves.units
        return {}

    @property
    def columns(self):
        """The columns of the CSV of `elastocheck solve`: "toe [deg]"."""
        return ["branch", "leg", "parameter", "unit"] + [f"{name} [{unit}]"
                                                         for name, unit in self.units.items()]

    def csv(self):
        """The text that `elastocheck solve` prints, digit for digit."""
        return "".join(curves.csv(k == 0) for k, curves in enumerate(self._curves.values()))

    def frame(self):
        """The same as a pandas.DataFrame."""
        import pandas

        names = self.columns
        parts = []
        for curves in self._curves.values():
            table = pandas.DataFrame(curves.values, columns=names[4:])
            table.insert(0, "unit", curves.unit)
            table.insert(0, "parameter", curves.parameter)
            table.insert(0, "leg", curves.leg)
            table.insert(0, "branch", curves.branch)
            parts.append(table)
        return pandas.concat(parts, ignore_index=True) if parts else pandas.DataFrame(columns=names)

    def _repr_html_(self):
        return self.frame()._repr_html_()

    def __repr__(self):
        lines = [f"{curves.branch}: {len(curves)} points by {curves.method}"
                 + ("" if curves.converged else f", {curves.outcome}: {curves.detail}")
                 for curves in self._curves.values()]
        return "\n".join(lines)


def _solve(self, method="equilibrium", channels=(), *, branches=(), steps=0, every=1, tolerance="",
           order=0, expansions=0, arc_length=False, states=False):
    """Solves every branch by one leg or method, as `elastocheck solve`; or these `branches`.

    `channels`: names or patterns with *; the default leaves out forces of elements and K&C figures.
    `states` keeps the poses of the bodies. Other options as those of the command, 0 or "" for its
    defaults. Throws ArgumentError.
    """
    return Solution(self._solve(method, _listed(channels), steps, every, tolerance, order,
                                expansions, arc_length, states, False, _listed(branches)))


def _draw(self, view="axonometric"):
    """The scene at its design position: view axonometric, front, side or top."""
    return Drawing(self._drawing(view))


def _branches(self):
    """The branches by name."""
    return {branch[0]: Branch(*branch) for branch in self._branches}


def _outputs(self):
    """The outputs by name, also those that a solution has only on request."""
    return {output[0]: Output(*output) for output in self._outputs}


def _again(file, settings):
    return _core.read(file, settings)


def _repr(self):
    return f"<scene {self.name!r} of {self.file}: {', '.join(self.branches)}>"


Scene.solve, Scene.draw = _solve, _draw
Scene.branches, Scene.outputs = property(_branches), property(_outputs)
Scene.__repr__ = _repr
Scene.__reduce__ = lambda self: (_again, (os.path.abspath(self.file), self.settings))


def kc(scene, method="equilibrium", *, branches=(), steps=0, every=1, tolerance=""):
    """All kinematics and compliance figures of a scene at every point of its branches.

    Exact rates by the tangent of the leg: wheel rate, bump steer, roll centre, compliance steer.
    Options as those of Scene.solve().
    """
    return Solution(scene._solve(method, [], steps, every, tolerance, 0, 0, False, False, True,
                                 _listed(branches)))


# ---- Analyses.

class Result:
    """What a command finds: `text` as on the terminal, `document` as with --json.

    `verdict` is "fine", "limit broken" or "could not judge", the exit codes 0, 1 and 3. A result
    that is not fine is false. `messages` are what the command writes to standard error.
    """

    def __init__(self, exit_code, printed, text, messages):
        import json

        self.exit_code, self.messages = exit_code, messages
        self.document = json.loads(printed) if printed.startswith("{") else {}
        self.text = text if self.document else printed

    @property
    def verdict(self):
        return {0: "fine", 1: "limit broken"}.get(self.exit_code, "could not judge")

    def __bool__(self):
        return self.exit_code == 0

    @property
    def tables(self):
        """The tables of the document by name: {"columns": [...], "rows": [...]}."""
        scenes = self.document.get("scenes", [])
        results = [result for scene in scenes for result in scene.get("results", [])]
        parts = [result["tables"] for result in results] + [self.document.get("tables", {}), self.document]
        return {name: table for part in parts for name, table in part.items()
                if isinstance(table, dict) and "columns" in table}

    def frame(self, table=None):
        """A table as a pandas.DataFrame, columns with their units; the first, or by its name.
        "curves" has every point of every leg, as curves.csv."""
        import pandas

        if table == "curves":
            return pandas.DataFrame(_points(self.document), columns=[
                "scene", "branch", "leg", "parameter", "parameter unit", "output", "unit", "value"])
        tables = self.tables
        name = table or next(iter(tables), None)
        if name not in tables:
            raise ArgumentError(f"table {table!r}; allowed: {', '.join(tables) or 'none here'}")
        columns = [column["name"] + (f" [{column['unit']}]" if column["unit"] else "")
                   for column in tables[name]["columns"]]
        return pandas.DataFrame(tables[name]["rows"], columns=columns)

    def __repr__(self):
        return self.text


def _points(document):
    for scene in document.get("scenes", []):
        for branch in scene.get("branches", []):
            for leg in branch.get("legs", []):
                for channel in scene["channels"]:
                    values = leg["curve"]["values"][channel["name"]]
                    for parameter, value in zip(leg["curve"]["a"], values):
                        yield (scene["name"], branch["name"], leg["leg"], parameter, branch["unit"],
                               channel["name"], channel["unit"], value)


def run(command, *words, threads=0, progress=None, **options):
    """Runs a command of `elastocheck` in this process: run("certify", scene, points=4).

    `words` are scenes or its other words, `options` those of the command without dashes: True for
    one without a value, a list for several values; None leaves it out. `threads`: 0 for one per
    core. `progress(what, done)` is called from any thread, one at a time; what it raises ends the
    command. One command runs at a time. Throws as read() does, and ArgumentError.
    """
    if command == "study":  # is this package
        raise ArgumentError("study: elastocheck.study.run")
    line = [command]
    for word in words:
        line.append(word.file if isinstance(word, Scene) else os.fspath(word))
        if isinstance(word, Scene):
            for path, value in word.settings.items():
                line += ["--set", f"{path}={value}"]
    if threads:
        options["jobs"] = threads
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            line.append(option)
        elif value is not None and value is not False:
            several = isinstance(value, Iterable) and not isinstance(value, str)
            line += [f"{option}={item}" for item in (value if several else [value])]
    found = Result(*_core.run(line + ["--json"], progress))
    if found.exit_code == 2:
        raise ArgumentError(found.messages.removeprefix("elastocheck: ").strip())
    return found


def compare(scene, method=None, within=None, **options):
    """All three legs on one scene: deviations, agreement of the references, proofs of points.

    With `method` or `within` ("0.01mm,0.001deg,1%") it judges the method.
    """
    return run("compare", scene, method=method, within=within, **options)


def certify(scene, method=None, tolerance=None, **options):
    """Proves by interval arithmetic that computed points are equilibria; frame(): per solver."""
    return run("certify", scene, method=method, tolerance=tolerance, **options)


def sensitivity(scene, of=None, to=None, **options):
    """Derivatives of outputs by numbers of the scene, by two or three legs; names or patterns."""
    return run("sensitivity", scene, of=of, to=to, **options)


def fit(scene, measured, vary, **options):
    """Fits numbers of the scene to measured curves, with 95 % intervals; frame(): the numbers.

    `measured`: a CSV file or a pandas.DataFrame with such columns; `vary`: numbers or patterns,
    limits as "NAME=LOW:HIGH".
    """
    if not hasattr(measured, "to_csv"):
        return run("fit", scene, measured=measured, vary=vary, **options)
    with tempfile.TemporaryDirectory(prefix="elastocheck-") as folder:
        file = os.path.join(folder, "measured.csv")
        measured.to_csv(file, index=False)
        return run("fit", scene, measured=file, vary=vary, **options)


def judge(scene, solver, name="candidate", tolerance=None, *, steps=0, threads=0, progress=None):
    """Judges a solver of your own by the references, as if it were a leg.

    solver(scene, branch, parameters) returns states [points, bodies, 7], a state per parameter (in
    the unit of the branch), bodies in the order of scene.bodies: x, y, z of the body's origin in mm
    and its quaternion w, x, y, z. Fewer states: it ended early. `branch` is a name; a branch with
    two sides is two calls, each from the parameter 0 on.
    """
    return Result(*_core.judge(scene, solver, name, tolerance, steps, threads, progress))


# ---- Many variants.

def _variants(self, numbers, figures, method="series", *, threads=0):
    """Figures of many variants of the scene: values [variants, figures] and an outcome for each.

    `numbers`: a column of values for each number that varies, {"springs.coil.rate": [27, 28, 29]}
    or a pandas.DataFrame, in the units of the file. `figures`: "toe@jounce:3000",
    "min toe@jounce", "bump_steer"; or such by names of your own. A figure without a value is nan.
    An outcome is "solved", or says why not. `method`: "series" (what it declines is solved by the
    equilibrium leg) or a reference leg; `threads`: 0 for one per core. elastocheck.study keeps the
    rows of long computations. Throws ArgumentError.
    """
    import numpy

    words = figures.items() if isinstance(figures, Mapping) else zip(*2 * [_listed(figures)])
    columns = [numpy.asarray(numbers[name], dtype=float) for name in numbers]
    values, outcomes, _, reasons = _core.Variants(self, list(numbers), list(words)).solve(
        numpy.column_stack(columns), method, threads)
    return values, [outcome + (": " + reason if reason and outcome != "solved" else "")
                    for outcome, reason in zip(outcomes, reasons)]


Scene.variants = _variants


def __getattr__(name):
    if name == "study":  # loaded when it is asked for
        import importlib
        return importlib.import_module("elastocheck.study")
    raise AttributeError(f"module 'elastocheck' has no attribute {name!r}")
