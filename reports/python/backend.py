"""Builds a wheel of the Python package with CMake (PEP 517); the standard library is all it needs.

`pip install . --config-settings build=DIR` takes another build tree than build/release.
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def _version():
    return re.search(r"project\(elastocheck VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def _metadata():
    return (f"Metadata-Version: 2.1\nName: elastocheck\nVersion: {_version()}\n"
            "Summary: Cross-check harness for elastokinematic suspension analysis\n"
            "License: MIT\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"
            "Provides-Extra: frames\nRequires-Dist: pandas; extra == 'frames'\n")


def _tag():
    abi = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{abi}-{abi}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def _installed(build, prefix):
    """The package's folder, built and installed below a prefix."""
    if not (build / "build.ninja").exists():
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-D", "CMAKE_BUILD_TYPE=Release",
                        "-D", "CMAKE_REQUIRE_FIND_PACKAGE_pybind11=ON",
                        "-D", f"Python_EXECUTABLE={sys.executable}"], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "elastocheck_python"], check=True)
    subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", prefix, "--strip"],
                   check=True, stdout=subprocess.DEVNULL)
    package = prefix / "lib/python3/dist-packages/elastocheck"
    if not list(package.glob("_core*.so")):
        raise SystemExit(f"{build} has no Python module: pybind11-dev is not installed")
    return package


def get_requires_for_build_wheel(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    name = f"elastocheck-{_version()}.dist-info"
    folder = pathlib.Path(metadata_directory) / name
    folder.mkdir()
    (folder / "METADATA").write_text(_metadata())
    return name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    build = pathlib.Path((config_settings or {}).get("build", ROOT / "build/release")).resolve()
    info = f"elastocheck-{_version()}.dist-info"
    with tempfile.TemporaryDirectory() as prefix:
        package = _installed(build, pathlib.Path(prefix))
        files = {f"elastocheck/{file.relative_to(package)}": file.read_bytes()
                 for file in sorted(package.rglob("*")) if file.is_file()}
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: elastocheck\nRoot-Is-Purelib: false\n"
                              f"Tag: {_tag()}\n").encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"elastocheck-{_version()}-{_tag()}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as out:
        for name, content in files.items():
            out.writestr(name, content)
    return wheel
