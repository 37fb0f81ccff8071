"""The package is installed from the sources without a network, and works where nothing else of the tree is."""
import os
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def test_pip_installs_the_sources_without_a_network(tmp_path):
    pytest.importorskip("pip")
    told = subprocess.run([sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-index", "--no-deps",
                           "--target", tmp_path / "site", "--config-settings",
                           f"build={os.environ['ELASTOCHECK_BUILD']}", ROOT],
                          capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stdout + told.stderr
    program = ("import elastocheck, sys; print(elastocheck.__file__);"
               "sys.exit(not elastocheck.new('pinned_bar').solve().converged)")
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=tmp_path,
                         env={**clean, "PYTHONPATH": str(tmp_path / "site")})
    assert ran.stdout.startswith(str(tmp_path / "site"))
    assert (tmp_path / "site/elastocheck/__init__.pyi").exists()
    found = subprocess.run(["readelf", "-d", next((tmp_path / "site/elastocheck").glob("_core*.so"))],
                           capture_output=True, text=True, check=True).stdout
    assert str(ROOT) not in found and os.environ["ELASTOCHECK_BUILD"] not in found
