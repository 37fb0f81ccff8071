"""The guide's blocks and the notebook run as they are written."""
import json
import pathlib
import re
import subprocess
import sys

import pytest

GUIDE = pathlib.Path(__file__).resolve().parents[2] / "reports/python"


def test_the_blocks_of_the_guide_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (GUIDE / "README.md").read_text(), re.S)
    assert len(blocks) > 5
    shared = {}
    for block in blocks:
        exec(compile(block, "README.md", "exec"), shared)
    said = capsys.readouterr().out
    assert "Pass: the candidate ‘closed form’" in said and re.search(r"mine.yaml \d+ mine.yaml:\d+:", said) and "mine.svg" in "".join(blocks)
    assert (tmp_path / "mine.svg").read_text().startswith("<svg")


def test_the_section_of_the_readme_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (GUIDE.parents[1] / "README.md").read_text(), re.S)
    assert len(blocks) == 1
    exec(compile(blocks[0], "README.md", "exec"), {})


def test_the_notebook_runs(tmp_path):
    pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", tmp_path,
                    "--ExecutePreprocessor.timeout=300", GUIDE / "suspension.ipynb"], check=True,
                   capture_output=True, env={**__import__("os").environ, "HOME": str(tmp_path)})
    cells = json.loads((tmp_path / "suspension.ipynb").read_text())["cells"]
    shown = [data for cell in cells for output in cell.get("outputs", []) for data in output.get("data", {})]
    assert "image/svg+xml" in shown and "text/html" in shown
