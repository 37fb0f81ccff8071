"""A Python function judged as a leg."""
import elastocheck
import numpy as np
import pytest


def closed_form(scene, branch, loads):
    """A bar pinned at one end, held by a bushing at its tip: tan θ = F / (k L)."""
    k, length = scene.numbers["bushings.tip.rates.z"], scene.numbers["points.tip.x"]
    half = np.arctan(loads / (k * length)) / 2
    states = np.zeros((len(loads), len(scene.bodies), 7))
    states[:, 0, 3], states[:, 0, 5] = np.cos(half), -np.sin(half)  # about y, which points left
    return states


def test_candidate_by_the_closed_form_passes():
    report = elastocheck.judge(elastocheck.new("pinned_bar"), closed_form, "closed form", "1e-6mm,1e-6deg")
    assert report and report.document["verdict"]["grade"] == "pass"
    assert "closed form" in report.text


def test_candidate_is_called_for_each_side_from_zero_on():
    calls = []

    def recorded(scene, branch, parameters):
        calls.append((branch, parameters[0], parameters[-1]))
        return closed_form(scene, branch, parameters)

    elastocheck.judge(elastocheck.new("pinned_bar"), recorded)
    assert calls == [("up", 0, 5000), ("down", 0, -5000)]


def test_candidate_with_a_wrong_sign_fails_and_the_sign_is_named():
    wrong = elastocheck.judge(elastocheck.new("pinned_bar"),
                              lambda *of: closed_form(*of) * [1, 1, 1, 1, 1, -1, 1])
    assert not wrong and wrong.verdict == "limit broken" and wrong.document["verdict"]["grade"] == "fail"
    assert "sign" in wrong.text


def test_linearised_candidate_fails_and_its_error_is_stated():
    def small_angles(scene, branch, loads):
        states = closed_form(scene, branch, loads)
        half = loads / (20 * 500) / 2
        states[:, 0, 3], states[:, 0, 5] = np.cos(half), -np.sin(half)
        return states

    report = elastocheck.judge(elastocheck.new("pinned_bar"), small_angles)
    error = 500 * (np.sin(0.5) - np.sin(np.arctan(0.5)))
    assert report.document["verdict"]["grade"] == "fail"
    assert f"{error:.3g}"[:4] in report.text


def test_a_candidate_that_ends_early_or_is_not_a_number_does_not_pass():
    scene = elastocheck.new("pinned_bar")
    early = elastocheck.judge(scene, lambda *of: closed_form(*of)[:20])
    nothing = elastocheck.judge(scene, lambda *of: closed_form(*of)[:0])
    broken = elastocheck.judge(scene, lambda *of: closed_form(*of) * np.nan)
    assert not early and not nothing and not broken
    assert "20 of 101 states" in early.text


@pytest.mark.parametrize("returned, kind", [(None, ValueError), ("x", TypeError), (np.zeros((101, 7)), ValueError),
                                            (np.zeros((102, 1, 7)), ValueError), (np.zeros((101, 2, 7)), ValueError)])
def test_candidate_that_returns_no_array_of_states_is_refused(returned, kind):
    with pytest.raises(kind, match="candidate"):
        elastocheck.judge(elastocheck.new("pinned_bar"), lambda *of: returned)


def test_exception_of_the_candidate_reaches_the_caller():
    with pytest.raises(ZeroDivisionError):
        elastocheck.judge(elastocheck.new("pinned_bar"), lambda *of: 1 / 0)
