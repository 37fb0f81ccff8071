"""Analyses from Python: the text and the document of the command line."""
import json
import re
import threading

import elastocheck
import numpy as np
import pandas
import pytest


def same(a, b):
    """As JSON: a number that is not finite is null."""
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(same(a[k], b[k]) for k in a)
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return a == b or (b is None and a != a)


def without_times(text):
    return re.sub(r"(converged(?: +\d+){4}) +[\d.]+", r"\1", text)


def test_compare_has_the_text_and_curves_of_the_command(scenes, command, tmp_path):
    file = scenes / "mcpherson.yaml"
    said, code, _ = command("compare", file, "--method", "published", "--within", "0.01mm,0.001deg")
    told = []
    report = elastocheck.compare(elastocheck.read(file), "published", "0.01mm,0.001deg",
                                 progress=lambda what, done: told.append((what, done)))
    assert (without_times(report.text), report.exit_code) == (without_times(said), code)
    assert told and all(0 <= done <= 1 for _, done in told)
    assert report.document["scenes"][0]["results"][0]["verdict"]["grade"] == "fail"
    command("compare", file, "-o", tmp_path / "out", "--method", "published", "--within", "0.01mm,0.001deg")
    curves = pandas.read_csv(tmp_path / "out/curves.csv", float_precision="round_trip")
    curves["unit"] = curves["unit"].str.removeprefix("'")  # "-": no formula of a spreadsheet
    pandas.testing.assert_frame_equal(report.frame("curves"), curves, check_exact=True, check_dtype=False)


@pytest.mark.parametrize("method", ["series", "equilibrium"])
def test_certify_has_the_text_of_the_command(scenes, command, method):
    file = scenes / "pinned_bar.yaml"
    said, code, _ = command("certify", file, "--method", method, "--points", "4")
    report = elastocheck.certify(elastocheck.read(file), method, points=4)
    assert (report.text, report.exit_code, bool(report)) == (said, code, True)
    assert report.document["scenes"][0]["results"][0]["verdict"]["compared"] > 0
    assert len(report.frame()) == 2


def test_sensitivity_has_the_text_and_document_of_the_command(scenes, command):
    file = scenes / "double_wishbone.yaml"
    options = ["--of", "toe,camber", "--to", "points.tie_rod*", "--branch", "travel", "--points", "2"]
    said, code, _ = command("sensitivity", file, *options)
    report = elastocheck.sensitivity(elastocheck.read(file), ["toe", "camber"], "points.tie_rod*",
                                     branch="travel", points=2)
    assert (report.text, report.exit_code) == (said, code)
    said, _, _ = command("sensitivity", file, *options, "--json")
    document = json.loads(said)
    assert all(same(value, document[key]) for key, value in report.document.items() if key != "reproduce")
    derivatives = document["scenes"][0]["results"][0]["tables"]["derivatives"]
    assert len(report.frame("derivatives")) == len(derivatives["rows"])


def test_fit_of_a_frame_or_a_file_has_the_text_of_the_command(scenes, command, tmp_path):
    file = scenes / "mcpherson.yaml"
    rig = elastocheck.read(file, {"springs.K1_coil.rate": 24e3}).solve()
    measured = pandas.DataFrame({"branch": "jounce", "load_N": rig["jounce"].parameter[::60],
                                 "wheel_centre_z_mm": rig["jounce"]["wheel_centre_z"][::60]})
    measured.to_csv(tmp_path / "rig.csv", index=False)
    said, code, _ = command("fit", file, "--measured", tmp_path / "rig.csv", "--vary", "springs.K1_coil.rate")
    for given in [measured, tmp_path / "rig.csv"]:
        report = elastocheck.fit(elastocheck.read(file), given, "springs.K1_coil.rate")
        assert (report.text, report.exit_code) == (said, code)
    rate = report.frame("numbers").set_index("number")
    assert float(rate[["to"]].iloc[0, 0]) == pytest.approx(24e3, rel=1e-6)
    with pytest.raises(elastocheck.SheetError, match="rig.csv") as error:
        (tmp_path / "rig.csv").write_text("load_N,toe_deg\n1,x\n")
        elastocheck.fit(elastocheck.read(file), tmp_path / "rig.csv", "springs.K1_coil.rate")
    assert error.value.line == 2
    with pytest.raises(elastocheck.ArgumentError, match="--vary"):
        elastocheck.fit(elastocheck.read(file), measured, "springs.coil.rate")


def test_exception_in_the_progress_callback_ends_the_computation():
    class Enough(Exception):
        pass

    def stop(what, done):
        raise Enough

    scene = elastocheck.new("pinned_bar")
    for run in (elastocheck.compare, elastocheck.certify):
        for threads in (1, 2):
            with pytest.raises(Enough):
                run(scene, threads=threads, progress=stop)


def test_a_thread_may_compare_while_another_reports_progress():
    scene = elastocheck.new("pinned_bar")
    texts = []

    def work():
        texts.append(elastocheck.compare(scene, threads=2, progress=lambda what, done: None).text)

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(map(without_times, texts))) == 1 and len(texts) == 3


def test_unknown_table_is_refused_with_the_names_of_the_tables():
    with pytest.raises(elastocheck.ArgumentError, match="sides"):
        elastocheck.certify(elastocheck.new("pinned_bar"), points=1).frame("rows")


def test_any_command_runs_with_its_options(command, tmp_path):
    scene = elastocheck.new("pinned_bar").vary({"bushings.tip.rates.z": 21})
    found = elastocheck.run("trade", scene, tolerance="1mm,1deg", output=tmp_path / "out")
    assert found and set(found.tables) == {"trade", "accuracies"}
    assert found.text.splitlines()[0] == scene.name
    assert json.loads((tmp_path / "out/result.json").read_text())["scenes"] == found.document["scenes"]
    with pytest.raises(elastocheck.ArgumentError, match="tolerance"):
        elastocheck.run("trade", scene, tolerances="1mm")


def test_values_without_a_number_are_nan():
    kc = elastocheck.kc(elastocheck.new("double_wishbone"), "series", every=50)
    assert all(np.isfinite(kc["travel"]["wheel_rate"]))
    assert not any(np.isinf(one.values).any() for one in kc.values())
