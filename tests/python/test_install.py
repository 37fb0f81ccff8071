"""The package is installed from the sources without a network, and works where nothing else of the tree is."""
import os
import pathlib
import shutil
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


STUDY = """elastocheck_study: 1
scene: mine.yaml
variables: {bushings.tip.rates.z: {normal: {sd: 1}}}
design: {kind: monte_carlo, count: 20, seed: 1}
figures: {tip: "tip_z@up:5000"}
"""


@pytest.mark.skipif(not shutil.which("dpkg-shlibdeps"), reason="dpkg-dev is not installed")
def test_debian_package_works_in_another_folder(tmp_path):
    """Unpacked elsewhere, the module runs, and declares what it is linked with."""
    subprocess.run(["cpack", "--config", f"{os.environ['ELASTOCHECK_BUILD']}/CPackConfig.cmake", "-B", tmp_path / "packages",
                    "-D", "CPACK_COMPONENTS_ALL=python"], check=True, capture_output=True)
    package = next((tmp_path / "packages").glob("python3-elastocheck_*.deb"))
    subprocess.run(["dpkg-deb", "-x", package, tmp_path / "root"], check=True)
    depends = subprocess.run(["dpkg-deb", "-f", package, "Depends"], capture_output=True, text=True, check=True).stdout
    assert f"python3 (>= 3.{sys.version_info.minor})" in depends and "python3-numpy" in depends and "libfmt9" in depends
    (tmp_path / "study.yaml").write_text(STUDY)
    program = ("import elastocheck; elastocheck.new('pinned_bar', 'mine.yaml');"
               "print(len(elastocheck.study.run('study.yaml', 'out').frame()), elastocheck.__file__)")
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False, cwd=tmp_path,
                         env={**os.environ, "PYTHONPATH": str(tmp_path / "root/usr/lib/python3/dist-packages")})
    assert ran.stdout.startswith(f"20 {tmp_path / 'root'}"), ran.stderr
