"""Exceptions: what the command line reports with exit codes 2 and 3."""

import re

_PLACE = re.compile(r"(?P<file>[^\n]*?):(?:(?P<line>\d+):)? ")


class Error(Exception):
    """Any error of this package. `file` and `line` say where in the input, None where nowhere."""

    @property
    def file(self):
        place = _PLACE.match(str(self))
        return place["file"] if place and isinstance(self, (SceneError, SheetError)) else None

    @property
    def line(self):
        place = _PLACE.match(str(self))
        return int(place["line"]) if self.file is not None and place["line"] else None


class SceneError(Error, ValueError):
    """A scene, a study or a map is wrong: "FILE:LINE: field: what is wrong, what is allowed"."""


class NotTrimmed(SceneError):
    """A requested trim is not reached, or not confirmed by the second reference."""


class SheetError(Error, ValueError):
    """A table is wrong: measured curves, results of a candidate."""


class FileError(Error, OSError):
    """A file cannot be read or written, or would replace what is not of this program."""


class ArgumentError(Error, ValueError):
    """A name, a unit or a number in a call is wrong; the nearest known name is given."""


class SceneWarning(UserWarning):
    """An implausible value in a scene, as the command line prints it."""
