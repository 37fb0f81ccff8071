"""The guide's blocks and the notebook run as they are written."""
import ast
import json
import pathlib
import re

GUIDE = pathlib.Path(__file__).resolve().parents[2] / "reports/python"


def test_code_blocks_of_the_guide_run_as_written(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (GUIDE / "README.md").read_text(), re.S)
    assert len(blocks) > 5
    shared = {}
    for block in blocks:
        exec(compile(block, "README.md", "exec"), shared)
    said = capsys.readouterr().out
    assert "Pass: the candidate ‘closed form’" in said and re.search(r"mine.yaml \d+ mine.yaml:\d+:", said) and "mine.svg" in "".join(blocks)
    assert (tmp_path / "mine.svg").read_text().startswith("<svg")


def test_python_section_of_the_readme_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (GUIDE.parents[1] / "README.md").read_text(), re.S)
    assert len(blocks) == 1
    exec(compile(blocks[0], "README.md", "exec"), {})


def test_cells_of_the_notebook_run_and_show_drawing_and_table(tmp_path, monkeypatch):
    """Cell after cell; what a cell shows is the value of its last expression."""
    monkeypatch.chdir(tmp_path)
    shared, shown = {}, []
    for cell in json.loads((GUIDE / "suspension.ipynb").read_text())["cells"]:
        if cell["cell_type"] == "code":
            *lines, last = ast.parse("".join(cell["source"])).body
            exec(compile(ast.Module(lines, []), "suspension.ipynb", "exec"), shared)
            if isinstance(last, ast.Expr):
                shown.append(eval(compile(ast.Expression(last.value), "suspension.ipynb", "eval"), shared))
            else:
                exec(compile(ast.Module([last], []), "suspension.ipynb", "exec"), shared)
    assert shown[0]._repr_svg_().startswith("<svg") and "<table" in shown[1]._repr_html_() and len(shown) > 4
