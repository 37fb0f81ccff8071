"""Scenes and their curves from Python: the numbers and messages of the command line."""
import io
import pickle
import subprocess
import sys
import threading
import time

import elastocheck
import numpy as np
import pandas
import pytest


@pytest.mark.parametrize("method", ["equilibrium", "energy", "series", "published"])
def test_csv_of_a_solution_is_the_output_of_the_command(scenes, command, method):
    file = scenes / "mcpherson.yaml"
    said, code, _ = command("solve", file, "--method", method, "--set", "springs.K1_coil.rate=28e3")
    assert code == 0
    solution = elastocheck.read(file, {"springs.K1_coil.rate": 28e3}).solve(method)
    assert solution.converged and solution.csv() == said


@pytest.mark.parametrize("scene", ["double_wishbone", "front_axle"])
def test_frame_of_a_solution_equals_the_csv_of_the_command_digit_for_digit(scenes, command, scene):
    file = scenes / f"{scene}.yaml"
    options = ["--method", "series", "--channels", "toe,*travel,*bump_steer" if scene == "double_wishbone"
               else "left.toe,right.camber,*travel"]
    said, _, _ = command("solve", file, *options)
    expected = pandas.read_csv(io.StringIO(said), float_precision="round_trip")
    frame = elastocheck.read(file).solve("series", options[3].split(",")).frame()
    assert list(frame.columns) == list(expected.columns)
    pandas.testing.assert_frame_equal(frame, expected, check_exact=True, check_dtype=False)


def test_all_outputs_by_pattern_are_those_of_the_command(scenes, command):
    said, _, _ = command("solve", scenes / "mcpherson.yaml", "--every", "100", "--channels", "*")
    assert elastocheck.read(scenes / "mcpherson.yaml").solve(channels="*", every=100).csv() == said


def test_messages_of_a_failed_solution_are_those_of_the_command(scenes, command):
    file = scenes / "two_spring_arch.yaml"
    settings = {"branches.down.to": -400}
    said, code, errors = command("solve", file, "--method", "series", "--set", "branches.down.to=-400")
    solution = elastocheck.read(file, settings).solve("series")
    assert code == 3 and not solution.converged
    assert solution.csv() == said
    assert "\n".join(solution.messages) + "\n" == errors
    assert solution["down"].outcome == "limit point" and len(solution["down"]) < 101


def test_error_of_a_method_without_a_bound_is_that_of_the_command(scenes, command):
    _, _, errors = command("solve", scenes / "mcpherson.yaml", "--method", "published")
    solution = elastocheck.read(scenes / "mcpherson.yaml").solve("published")
    lines = [line for branch in solution.values() for line in branch.errors_at_ends()]
    assert [f"published: {branch}: {line}" for branch, line in zip(solution, lines)] == errors.splitlines()


def test_states_of_a_pinned_bar_have_its_closed_form_angle():
    scene = elastocheck.new("pinned_bar")
    up = scene.solve(states=True)["up"]
    assert up.states.shape == (101, len(scene.bodies), 7) and scene.bodies == ["bar"]
    angle = np.arctan(up.parameter / (20 * 500))  # tan θ = F / (k L)
    np.testing.assert_allclose(up.states[:, 0, 3], np.cos(angle / 2), atol=1e-12)
    assert scene.solve()["up"].states.shape == (0, 1, 7)


def test_kc_has_every_figure_at_every_point(scenes, command):
    scene = elastocheck.read(scenes / "double_wishbone.yaml")
    kc = elastocheck.kc(scene, "series", every=40)
    said, _, _ = command("solve", scenes / "double_wishbone.yaml", "--method", "series", "--every", "40",
                         "--channels", ",".join(kc.units))
    assert kc.csv() == said
    assert kc.units["wheel_rate"] == "N/mm" and len(kc.units) > 20


def test_scene_lists_its_numbers_branches_and_outputs_with_units(scenes):
    scene = elastocheck.read(scenes / "double_wishbone.yaml")
    assert scene.numbers["points.tie_rod_inner.z"] == 0.001
    assert scene.units["points.tie_rod_inner.z"] == "m"
    travel = scene.branches["travel"]
    assert (travel.unit, travel.from_, travel.to, travel.steps) == ("mm", -80, 80, 80)
    assert scene.outputs["toe"].unit == "deg" and "toe-in" in scene.outputs["toe"].definition
    assert "travel" in repr(scene) and "bodies" in scene.inspect()


def test_branch_solved_alone_equals_that_solved_among_the_others(scenes):
    scene = elastocheck.read(scenes / "double_wishbone.yaml")
    some = scene.solve("series", branches=["steering", "travel"])
    every = scene.solve("series")
    assert list(some) == ["steering", "travel"]
    assert all(some[branch].csv() == every[branch].csv() for branch in some)


def test_vary_returns_a_changed_scene_and_keeps_the_original(scenes):
    scene = elastocheck.read(scenes / "mcpherson.yaml", {"springs.K1_coil.rate": 20e3})
    other = scene.vary({"springs.K1_coil.rate": 30e3, "points.arm_rear.z": 0.2})
    assert scene.numbers["springs.K1_coil.rate"] == 20e3
    assert other.numbers["springs.K1_coil.rate"] == 30e3
    again = elastocheck.read(scene.file, other.settings)
    assert again.solve("series").csv() == other.solve("series").csv()
    assert pickle.loads(pickle.dumps(other)).solve("series").csv() == other.solve("series").csv()


def test_error_of_an_invalid_scene_names_file_and_line(scenes, tmp_path, command):
    file = tmp_path / "mine.yaml"
    text = (scenes / "pinned_bar.yaml").read_text()
    file.write_text(text.replace("type: revolute", "type: hinge"))
    with pytest.raises(elastocheck.SceneError) as error:
        elastocheck.read(file)
    _, code, said = command("inspect", file)
    assert (code, said) == (2, f"elastocheck: {error.value}\n")
    assert (error.value.file, error.value.line) == (str(file), text[:text.index("type: revolute")].count("\n") + 1)
    for content in ["", "name: [", "\0"]:
        file.write_text(content)
        with pytest.raises(elastocheck.SceneError):
            elastocheck.read(file)
    with pytest.raises(elastocheck.SceneError, match="not_there.yaml"):
        elastocheck.read(tmp_path / "not_there.yaml")


@pytest.mark.parametrize("settings, kind", [
    ({"bushings.tip.rate": 1}, elastocheck.SceneError), ({"bushings.tip.rates.x": float("nan")}, elastocheck.SceneError),
    ({"bushings.tip.rates.x": -1}, elastocheck.SceneError), ({"bushings.tip.rates.x": [1]}, TypeError),
    ({"bushings.tip.rates.x": True}, TypeError), ({1: 1}, TypeError)])
def test_invalid_settings_are_refused(settings, kind):
    with pytest.raises(kind):
        elastocheck.new("pinned_bar", settings=settings)
    with pytest.raises(kind):
        elastocheck.new("pinned_bar").vary(settings)


@pytest.mark.parametrize("call, said", [
    (lambda s: s.solve("serie"), "series"), (lambda s: s.solve(channels="to"), "--channels"),
    (lambda s: s.solve(steps=-1), "steps"), (lambda s: s.solve(every=0), "every"),
    (lambda s: s.solve(every=1000), "--every"), (lambda s: s.solve(order=4), "--order"),
    (lambda s: s.solve("series", tolerance="1 furlong"), "furlong"), (lambda s: s.draw("below"), "below"),
    (lambda s: elastocheck.new("double_wishbones"), "double_wishbone"),
    (lambda s: s.solve(branches="upp"), "--branch.*up"),
    (lambda s: elastocheck.certify(s, "exact"), "exact"),
    (lambda s: elastocheck.compare(s, "equilibrium"), "equilibrium"),
    (lambda s: elastocheck.compare(s, within="1"), "1"), (lambda s: elastocheck.compare(s, threads=-1), "--jobs"),
    (lambda s: elastocheck.sensitivity(s, of="to"), "--of"), (lambda s: elastocheck.sensitivity(s, at="up:x"), "--at")])
def test_invalid_arguments_are_refused_with_the_allowed_values(call, said):
    with pytest.raises(elastocheck.ArgumentError, match=said):
        call(elastocheck.new("pinned_bar"))


def test_unknown_output_of_a_curve_is_a_key_error():
    with pytest.raises(KeyError, match="tip_z"):
        elastocheck.new("pinned_bar").solve()["up"]["tip_zz"]


def test_new_does_not_overwrite_a_file(tmp_path):
    elastocheck.new("pinned_bar", tmp_path / "mine.yaml")
    with pytest.raises(FileExistsError):
        elastocheck.new("pinned_bar", tmp_path / "mine.yaml")
    assert "pinned_bar" in elastocheck.templates()


def test_implausible_values_warn_as_the_command_does(tmp_path, command):
    file = tmp_path / "mine.yaml"
    elastocheck.new("pinned_bar", file)
    with pytest.warns(elastocheck.SceneWarning, match="hardpoints extend") as warned:
        elastocheck.read(file, {"points.tip.x": 5e6})
    _, _, said = command("inspect", file, "--set", "points.tip.x=5e6")
    assert said == f"{warned[0].message} (warning)\n"


@pytest.mark.parametrize("scene", elastocheck.templates())
def test_every_scene_is_drawn(scene):
    import xml.etree.ElementTree as tree
    drawing = elastocheck.new(scene).draw()
    assert tree.fromstring(drawing._repr_svg_()).tag.endswith("svg")


def test_other_threads_run_while_a_scene_is_solved_and_get_the_same():
    scene = elastocheck.new("mcpherson")
    alone = scene.solve().csv()
    inside, both, results = [0], [], []
    start = threading.Barrier(2)

    def work():
        start.wait()
        for _ in range(3):
            inside[0] += 1
            results.append(scene.solve().csv())
            inside[0] -= 1

    # With the lock of the interpreter held by a solve, this thread would not count on.
    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        both.append(inside[0])
        time.sleep(1e-4)
    assert both.count(2) > 10
    assert results == [alone] * 6


def test_stubs_declare_the_functions_and_arguments_of_the_module():
    import ast
    import inspect
    import pathlib
    folder = pathlib.Path(elastocheck.__file__).parent
    assert (folder / "py.typed").exists()
    for stub, module in [("__init__.pyi", elastocheck), ("_core.pyi", elastocheck._core)]:
        names = {}
        for node in ast.parse((folder / stub).read_text()).body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                names[node.name] = node
        for name, node in names.items():
            there = getattr(module, name)
            if isinstance(node, ast.ClassDef):
                for member in node.body:
                    if isinstance(member, ast.FunctionDef):
                        assert hasattr(there, member.name), f"{stub}: {name}.{member.name}"
            elif module is elastocheck:
                every = node.args.args + ([node.args.vararg] if node.args.vararg else []) + node.args.kwonlyargs
                arguments = [a.arg for a in every]
                signature = [n for n, p in inspect.signature(there).parameters.items()]
                if node.args.kwarg:
                    arguments.append(node.args.kwarg.arg)
                assert arguments == signature, f"{stub}: {name}"
    for name in elastocheck.__all__:
        assert hasattr(elastocheck, name)


def test_import_prints_nothing_and_changes_no_signal_handler():
    said = subprocess.run([sys.executable, "-c", "import signal, elastocheck;"
                           "print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"],
                          capture_output=True, text=True, check=True)
    assert (said.stdout, said.stderr) == ("True\n", "")
