import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture
def scenes():
    return ROOT / "models/scenes"


@pytest.fixture
def command():
    """Runs the command line; its standard output, and its exit code."""
    def run(*arguments):
        done = subprocess.run([os.environ["ELASTOCHECK"], *map(str, arguments)], capture_output=True,
                              text=True, check=False)
        return done.stdout, done.returncode, done.stderr
    return run
