"""`elastocheck study`: bad input, known variances, interruption, shards, clusters, damaged ledgers, what it leaves."""
import json
import math
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import sqlite3
import subprocess
import sys
import time

import elastocheck
import numpy as np
import pandas
import pytest

pytest.importorskip("scipy")
pytest.importorskip("openturns")
from elastocheck import study as studies  # noqa: E402
from elastocheck.study.file import Study  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]

# z = z₀ + (F + P₁ + W) / (k₁ + k₂): linear in the preload and in the weight.
LINEAR = """elastocheck_study: 1
scene: parallel_springs.yaml
variables:
  springs.first.preload: {normal: {sd: 20}}
  static_loads.weight.force.z: {normal: {sd: 30}}
design: {kind: sobol, count: 4096, seed: 3}
figures:
  height: centre_z@up:1500
limits:
  height: {max: 420.8}
witness: 1024
"""
MCPHERSON = """elastocheck_study: 1
scene: mcpherson.yaml
variables:
  points.tie_rod_inner.z: {normal: {sd: 0.0005}}
  points.strut_top.x: {triangular: {half_width: 0.001}}
  springs.K1_coil.rate: {truncated_normal: {sd: 2000, low: 1000, high: 40000}}
  bushes: {scale: 'bushings.K3_arm_front.rates.*', uniform: {half_width: 0.2}}
design: {kind: sobol, count: 780, seed: 5}
figures:
  toe: toe@jounce:3000
  camber: camber@rebound:-3000
  wheel rate: wheel_rate@jounce:1500
witness: 390
"""
LIST = """elastocheck_study: 1
scene: parallel_springs.yaml
variables: {springs.first.rate: {}, springs.second.rate: {}}
design: {kind: list, file: list.csv}
figures: {height: centre_z@up:3000}
"""


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder with scenes, the working one."""
    for scene in ("parallel_springs", "mcpherson"):
        shutil.copy(ROOT / f"models/scenes/{scene}.yaml", tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(text, file="study.yaml"):
    pathlib.Path(file).write_text(text)


def run(text=None, folder="out", **options):
    if text:
        write(text)
    return studies.run("study.yaml", folder, **options)


def command(*arguments, **how):
    return subprocess.run([os.environ["ELASTOCHECK"], "study", "study.yaml", *map(str, arguments)], capture_output=True, text=True,
                          check=False, **how)


def rows(report, table):
    return report.frame(table).to_dict("records")


def figure(report):
    return rows(report, "figures")[0]


# ---- Bad input, each before the first variant, with file and line.

PAIR = "[springs.first.preload, static_loads.weight.force.z]"


@pytest.mark.parametrize("what, by, says", [
    ("first.preload", "frist.preload", "study.yaml:4: variables.springs.frist.preload: the scene has no such number, did you mean "
     "'springs.first.preload'?"),
    ("{sd: 20}", "{sd: -20}", "study.yaml:4: variables.springs.first.preload.normal.sd: -20"),
    ("{normal: {sd: 20}}", "{normal: {sd: 20}, uniform: {half_width: 1}}",
     "study.yaml:4: variables.springs.first.preload.uniform: a second distribution"),
    ("{normal: {sd: 20}}", "{}", "study.yaml:4: variables.springs.first.preload: no distribution"),
    ("{normal: {sd: 20}}", "{triangular: {low: 1, high: 2}}", "study.yaml:4: variables.springs.first.preload.triangular: mode 600 is not between"),
    ("{normal: {sd: 20}}", "{uniform: {low: 2, high: 1}}", "study.yaml:4: variables.springs.first.preload.uniform: low 2 is not below high 1"),
    ("{normal: {sd: 20}}", "{uniform: {half_width: 1, low: 1}}", "half_width: given together with low or high"),
    ("{normal: {sd: 20}}", "{truncated_normal: {sd: 1, low: 1, high: 2}}", "more than eight standard deviations"),
    ("springs.first.preload", "branches.up.steps", "branches are the same for all variants"),
    ("kind: sobol", "kind: sobl", "study.yaml:6: design.kind: 'sobl' is not a design, did you mean 'sobol'?"),
    ("kind: sobol", "kind: grid", "not of a grid or a list, which say how many variants there are"),
    ("kind: sobol, count: 4096, seed: 3", "kind: grid", "a grid needs a list of values for each variable"),
    (", seed: 3", "", "study.yaml:6: design.seed: missing"),
    ("centre_z@up:1500", "center_z@up:1500", "study.yaml:8: figures.height: the scene has no output 'center_z', did you mean 'centre_z'?"),
    ("centre_z@up:1500", "centre_z@upp:1500", "study.yaml:8: figures.height: the scene has no branch 'upp', did you mean 'up'?"),
    ("@up:1500", "@up:3001", "branch 'up' goes from 0 to 3000 N"),
    ("@up:1500", "@up:954.929658551372", "study.yaml:7: figures: the stations are not among"),
    ("centre_z@up:1500", "min centre_z@up:1500", "an extreme is that of the whole branch"),
    ("height: {max", "hight: {max", "study.yaml:10: limits.hight: the study has no such figure, did you mean 'height'?"),
    ("{max: 420.8}", "{max: 1, min: 2}", "study.yaml:10: limits.height: min is above max"),
    ("{max: 420.8}", "{}", "study.yaml:10: limits.height: no limit"),
    ("parallel_springs.yaml", "parallel.yaml", "study.yaml:2: scene: parallel.yaml: there is no such file"),
    ("witness: 1024", "witnes: 1024", "unknown field 'witnes', did you mean 'witness'?"),
    ("design:", f"groups: [{{variables: {PAIR}, correlation: [[1, 1], [1, 1]]}}]\ndesign:",
     "study.yaml:6: groups.correlation: is not positive definite"),
    ("design:", f"groups: [{{variables: {PAIR}, correlation: [[1, 0.5], [0, 1]]}}]\ndesign:", "groups.correlation: is not symmetric"),
    ("design:", "groups: [{variables: [springs.first.preload, nobody], correlation: []}]\ndesign:", "'nobody' is not a variable"),
    ("seed: 3}", f"seed: 3, indices: true}}\ngroups: [{{variables: {PAIR}, correlation: [[1, 0.5], [0.5, 1]]}}]",
     "Sobol indices need independent variables"),
    ("count: 4096, seed: 3", "count: 3, seed: 3, indices: true", "3 variants are less than one block of 4"),
    ("variables:\n", "variables:\n  both: {scale: 'springs.*.preload', normal: {sd: 0.1}}\n", "springs.first.preload is varied by 'both' too"),
    ("variables:\n", "variables:\n  springs.second.rate: {uniform: {half_width: 50}}\n",
     "study.yaml:4: variables.springs.second.rate: -5 can be drawn, and with it the scene is invalid: "),
    ("variables:\n", "variables:\n  springs.second.rate: {list: [30, -1]}\n", "study.yaml:4: variables.springs.second.rate: -1 can be drawn"),
    ("variables:\n", "variables:\n  none: {scale: 'bushings.*', normal: {sd: 0.1}}\n",
     "study.yaml:4: variables.none.scale: the scene has no number 'bushings.*'"),
    ("design:", "design: [\n", "study.yaml:"),
])
def test_invalid_study_is_refused_before_the_first_variant(here, what, by, says):
    assert what in LINEAR
    with pytest.raises(elastocheck.SceneError, match=re.escape(says)):
        run(LINEAR.replace(what, by))
    assert not os.path.exists("out")


def test_invalid_table_of_variants_is_refused_with_its_line(here):
    for table, says in [("springs.first.rate,springs.secnd.rate\n1,2\n",
                         "list.csv:1: the study has no variable 'springs.secnd.rate', did you mean 'springs.second.rate'?"),
                        ("springs.first.rate\n1\n", "list.csv:1: 1 columns, but the study has 2 variables"),
                        ("springs.second.rate,springs.first.rate\n45,30\n,30\n", "list.csv:3: springs.second.rate: no value"),
                        ("springs.second.rate,springs.first.rate\n45,x\n", "list.csv:2: springs.first.rate: 'x' is not a number"),
                        ("springs.second.rate,springs.second.rate\n45,30\n", "list.csv:1: the study has no variable")]:
        write(table, "list.csv")
        with pytest.raises(elastocheck.SheetError, match=re.escape(says)):
            run(LIST)
    write("springs.second.rate,springs.first.rate\n44.99999999999999,30\n20,30\n", "list.csv")
    frame = run(LIST).frame()
    assert list(frame.columns[3:]) == ["springs.first.rate [N/mm]", "springs.second.rate [N/mm]", "height [mm]"]
    assert frame["springs.second.rate [N/mm]"].tolist() == [44.99999999999999, 20]
    np.testing.assert_allclose(frame["height [mm]"], [400 + 3000 / 75, 400 + 3000 / 50], atol=1e-9)


def test_reaction_that_redundant_joints_share_is_refused_as_a_figure(tmp_path):
    shutil.copy(ROOT / "tests/reports/scenes/two_hinges.yaml", tmp_path)
    scene = elastocheck.read(tmp_path / "two_hinges.yaml")
    rates = {"springs.coil.rate": scene.numbers["springs.coil.rate"] + np.array([0, 1.0])}
    with pytest.raises(elastocheck.ArgumentError, match="front.force_y: redundant joints share it"):
        scene.variants(rates, "front.force_y@b:3000")
    values, outcomes = scene.variants(rates, "front+rear.force_y@b:3000")
    assert np.isfinite(values).all() and outcomes == ["solved"] * 2


# ---- Designs.

def drawn(kind, distributions, count=600, seed=7, indices=False, correlation=None):
    """A study without a scene, for its design."""
    class Drawn:
        variables = [studies.file.Variable(f"x{j}", kind=name, numbers=numbers) for j, (name, numbers) in enumerate(distributions)]
        block = len(variables) + 2 if indices else 1
    Drawn.kind, Drawn.count, Drawn.seed, Drawn.indices, Drawn.correlation = kind, count, seed, indices, correlation
    from elastocheck.study.design import Design
    return Drawn, Design(Drawn)


MIXED = [("normal", (1, 2)), ("triangular", (0, 0.2, 1)), ("truncated_normal", (0, 1, -1, 3)), ("list", (1, 5, 9))]
CORRELATED = np.array([[1, 0.6, 0, 0], [0.6, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


@pytest.mark.parametrize("kind, indices", [("monte_carlo", False), ("monte_carlo", True), ("sobol", False), ("sobol", True), ("latin_hypercube", False)])
def test_values_of_a_variant_depend_on_its_number_alone(kind, indices):
    how = {"indices": indices, "correlation": None if indices else CORRELATED}
    _, design = drawn(kind, MIXED, **how)
    whole = design.values(0, 600)
    for first, end in [(599, 600), (0, 1), (5, 9), (250, 311), (256, 512)]:
        assert np.array_equal(design.values(first, end), whole[first:end])
    if kind != "latin_hypercube":  # a longer study begins with the same variants
        assert np.array_equal(drawn(kind, MIXED, count=100_000, **how)[1].values(0, 600), whole)
    assert (drawn(kind, MIXED[:3], seed=8)[1].values(0, 50) != drawn(kind, MIXED[:3])[1].values(0, 50)).all()


def test_sobol_points_and_a_latin_hypercube_fill_every_stratum():
    points = drawn("sobol", [("uniform", (0, 1))] * 40, 256)[1].points(np.arange(256))
    for a in range(9):  # a net: every elementary interval of the first two dimensions has one point
        cells = {(int(x * 2**a), int(y * 2**(8 - a))) for x, y in points[:, :2]}
        assert len(cells) == 256
    cube = drawn("latin_hypercube", [("uniform", (0, 1))] * 3, 97)[1].points(np.arange(97))
    assert all(len(set((97 * column).astype(int))) == 97 for column in cube.T)
    assert all(len(set((256 * column).astype(int))) == 256 for column in points.T)


def test_draws_have_the_moments_and_the_correlation_of_their_distributions():
    correlation = np.eye(6)
    correlation[0, 1] = correlation[1, 0] = -0.7
    _, design = drawn("sobol", [("normal", (3, 2)), ("normal", (-1, 0.5)), ("uniform", (-1, 3)), ("triangular", (-2, 0, 2)),
                                ("truncated_normal", (0, 1, -1, 1)), ("list", (-1, 1))], 1 << 14, correlation=correlation)
    x = design.values(0, 1 << 14)
    truncated = math.sqrt(1 - 2 * math.exp(-0.5) / math.sqrt(2 * math.pi) / math.erf(1 / math.sqrt(2)))
    np.testing.assert_allclose(x.mean(axis=0), [3, -1, 1, 0, 0, 0], atol=1e-3)
    np.testing.assert_allclose(x.std(axis=0), [2, 0.5, 2 / math.sqrt(3), 2 / math.sqrt(6), truncated, 1], atol=2e-3)
    assert np.corrcoef(x.T)[0, 1] == pytest.approx(-0.7, abs=2e-3) and abs(np.corrcoef(x.T)[0, 2]) < 2e-3


def test_a_grid_has_every_combination_once(here):
    frame = run("elastocheck_study: 1\nscene: parallel_springs.yaml\nvariables: {springs.first.rate: {list: [28, 29, 30]}, "
                "springs.second.rate: {list: [44, 45]}}\ndesign: {kind: grid}\nfigures: {z: centre_z@up:3000}\n").frame()
    assert frame.iloc[:, 3:5].to_numpy().tolist() == [[28, 44], [28, 45], [29, 44], [29, 45], [30, 44], [30, 45]]


# ---- Statistics.

def test_indices_of_ishigamis_function_are_within_their_intervals():
    """sin x₁ + a sin² x₂ + b x₃⁴ sin x₁ on [-π, π]³, a = 7, b = 0.1, of which the indices are known."""
    from elastocheck.study.statistics import sobol_rows
    pi, a, b = math.pi, 7, 0.1
    v1, v2, v13 = 0.5 * (1 + b * pi**4 / 5)**2, a * a / 8, b * b * pi**8 * (1 / 18 - 1 / 50)
    v = v1 + v2 + v13
    for kind in ("monte_carlo", "sobol"):
        study, design = drawn(kind, [("uniform", (-pi, pi))] * 3, 5 * 4096, indices=True)
        x = design.values(0, study.count)
        y = np.sin(x[:, 0]) + a * np.sin(x[:, 1])**2 + b * x[:, 2]**4 * np.sin(x[:, 0])
        rows = sobol_rows(study, studies.file.Figure("y", ""), y)
        for row, first, total in zip(rows, [v1 / v, v2 / v, 0], [(v1 + v13) / v, v2 / v, v13 / v]):
            assert row["first from"] < first < row["first to"] and row["total from"] < total < row["total to"]
            assert row["total to"] - row["total from"] < 0.1 and row["blocks"] == 4096
        y[7] = math.nan  # a block with a failed variant is left out
        assert sobol_rows(study, studies.file.Figure("y", ""), y)[0]["left out"] == 1


def test_confidence_intervals_of_shares_and_percentiles_have_their_coverage():
    from elastocheck.study.statistics import clopper_pearson, percentile_ranks

    def at_most(k, n, p):
        return sum(math.comb(n, j) * p**j * (1 - p)**(n - j) for j in range(k + 1))

    for k, n in [(1, 10), (7, 10), (3, 1000)]:
        low, high = clopper_pearson(k, n)
        assert 1 - at_most(k - 1, n, low) == pytest.approx(0.025) and at_most(k, n, high) == pytest.approx(0.025)
    assert clopper_pearson(0, 10)[0] == 0 and clopper_pearson(10, 10)[1] == 1
    values = np.sort(np.random.default_rng(1).random((2000, 60)))
    for share in (0.05, 0.5, 0.95):
        low, high = percentile_ranks(60, share)
        covered = (values[:, max(low, 0)] <= share) * (values[:, min(high, 59)] >= share) if 0 <= low and high < 60 else np.ones(1)
        assert covered.mean() >= 0.935  # 0.95 less three standard deviations
    assert percentile_ranks(60, 0.01)[0] == -1 and percentile_ranks(60, 0.99)[1] == 60


def test_squared_correlation_omits_missing_values_and_is_zero_where_nothing_varies():
    from elastocheck.study.statistics import squared_correlation

    x, nan = np.array([0.0, 1, 2, 3]), math.nan
    for y, share in [([0, 1, 0, 1], 0.2), ([5, 3, 1, nan], 1), ([2, 2, 2, nan], 0), ([1, nan, nan, nan], 0)]:
        assert squared_correlation(x, np.array(y, float)) == pytest.approx(share, abs=1e-15)


# ---- A linear suspension of known variance.

def test_variance_of_a_linear_suspension_equals_its_closed_form(here):
    said = []
    report = run(LINEAR, say=said.append)
    row, sd = figure(report), math.hypot(20, 30) / 75
    assert report and report.rows == 4096 and re.match(r"4096 variants computed in ", said[0])
    assert "springs.first.preload        N        600  normal, 600, sd 20" in report.text
    assert row["design"] == pytest.approx(420, abs=1e-9) and row["mean"] == pytest.approx(420, abs=1e-3)
    assert row["sd"] == pytest.approx(sd, rel=1e-3)
    assert row["95 % low"] < 420 + 1.6448536 * sd < row["95 % high"] and row["95 %"] == pytest.approx(420 + 1.6448536 * sd, abs=0.01 * sd)
    above = 0.5 * math.erfc(0.8 / sd / math.sqrt(2))
    assert row["outside from"] < above < row["outside to"] and row["outside"] == pytest.approx(above, abs=0.004)
    assert rows(report, "witnesses")[0]["witnesses"] == 4 and rows(report, "witnesses")[0]["difference"] < 1e-9


def test_variance_by_correlated_numbers_equals_its_closed_form(here):
    """Var z = (s₁² + s₂² + 2 ρ s₁ s₂) / k²."""
    report = run(LINEAR.replace("design:", f"groups: [{{variables: {PAIR}, correlation: [[1, -0.8], [-0.8, 1]]}}]\ndesign:"))
    assert figure(report)["sd"] == pytest.approx(math.sqrt(20**2 + 30**2 - 2 * 0.8 * 20 * 30) / 75, rel=2e-3)


def test_sobol_indices_of_a_linear_suspension_equal_their_closed_form(here):
    report = run(LINEAR.replace("seed: 3", "seed: 3, indices: true"))
    for row, share in zip(rows(report, "sobol"), [400 / 1300, 900 / 1300]):
        for order in ("first", "total"):
            assert row[f"{order} from"] < share < row[f"{order} to"] and row[order] == pytest.approx(share, abs=0.02)
    frame = report.frame().iloc[:, 3:5].to_numpy().reshape(-1, 4, 2)
    for j in range(2):  # a, b, a with one variable from b
        assert np.array_equal(frame[:, 2 + j, j], frame[:, 1, j]) and np.array_equal(frame[:, 2 + j, 1 - j], frame[:, 0, 1 - j])


def test_rare_failure_probability_of_a_linear_suspension_equals_its_closed_form(here):
    """Normal numbers and a linear figure: the reliability index is exact."""
    sd = math.hypot(20, 30) / 75
    report = run(LINEAR.replace("max: 420.8", f"max: {420 + 4.5 * sd}, min: {420 - 3 * sd}"), count=256, rare=True)
    for row, beta in zip(rows(report, "rare"), [3, 4.5]):
        exact = 0.5 * math.erfc(beta / math.sqrt(2))
        assert row["beta"] == pytest.approx(beta, abs=1e-4) and row["FORM"] == pytest.approx(exact, rel=1e-3)
        assert row["sampled from"] < 1.02 * exact and row["sampled to"] > 0.98 * exact and row["sampled to"] < 1.3 * exact
    assert report.text.count("Rare failures") == 1
    assert rows(run(count=256, rare=True, threads=2, folder="again"), "rare") == rows(report, "rare")


# ---- Variants that fail are rows.

def test_a_variant_without_a_scene_is_a_row_with_its_reason(here):
    report = run("elastocheck_study: 1\nscene: parallel_springs.yaml\nvariables:\n  springs.first.rate: {normal: {mean: 10, sd: 15}}\n"
                 "design: {kind: sobol, count: 64, seed: 1}\nfigures: {height: centre_z@up:3000}\nwitness: 1\n")
    failed = report.outcomes["no scene"]
    assert 10 < failed < 22 and report.outcomes["solved"] == 64 - failed and figure(report)["missing"] == failed
    assert len(report.frame()) == 64 and "parallel_springs.yaml:" in rows(report, "failed")[0]["reason"]
    write("springs.first.rate\n-1\n", "list.csv")
    assert run(LIST.replace(", springs.second.rate: {}", ""), folder="none").exit_code == 3


def test_a_variant_that_drives_a_length_through_zero_is_a_row_with_its_reason(here):
    """The link is 102 mm long as drawn, and from 100 to 110 mm in the variants."""
    rod = """elastocheck: 1
name: actuator
units: {length: mm, angle: deg, force: N}
points: {end: [400, 0, 0], base: [400, 20, 100]}
bodies: {block: {origin: end}}
joints: {rod: {type: distance, bodies: [block, ground], from: end, to: base}}
bushings:
  k: {bodies: [ground, block], at: end, rates: [50, 50, 50], rotational_rates: [10, 10, 10]}
branches: {b: {drive: joints.rod, to: -101, steps: 10}}
probes: {end: {on: block, at: end}}
"""
    text = """elastocheck_study: 1
scene: rod.yaml
variables: {points.base.y: {uniform: {half_width: 25}}}
design: {kind: monte_carlo, count: 20, seed: 1}
figures: {z: end_z@b:-80.8}
"""
    write(rod, "rod.yaml")
    frame = run(text).frame()
    solved = frame["outcome"] == "solved"
    assert (solved == (np.hypot(frame["points.base.y [mm]"], 100) > 101)).all() and 2 < (~solved).sum() < 18
    assert frame["reason"][~solved].str.startswith("rod.yaml:9: branches.b.to: ").all()
    write(rod.replace("to: -101", "to: -150"), "rod.yaml")
    with pytest.raises(elastocheck.SceneError, match="rod.yaml:9: branches.b.to: '-150' would leave"):
        run(text, folder="other")


# ---- Threads, shards, clusters, interruption, extension: one content.

def test_content_of_a_study_is_the_same_on_any_threads_and_in_shards(here):
    one = run(MCPHERSON, folder="one", threads=1).content
    assert run(folder="two", threads=2).content == one and run(folder="two", show=True).content == one
    said = []
    for k in (1, 2):
        assert run(folder="parts", shard=f"{k}/3") is None
    assert run(folder="parts", merge=["parts"], say=said.append).exit_code == 3
    assert said[0] == "256 variants are missing: 256 of 512 to 767"
    run(folder="elsewhere", shard="3/3")
    assert run(folder="whole", merge=["parts", "elsewhere"]).content == one
    os.mkdir("empty")
    with pytest.raises(elastocheck.FileError, match="empty: no ledger of a shard, ledger-K-of-N.sqlite, in it"):
        run(folder="parts", merge=["empty"])


def test_content_of_a_study_is_the_same_on_the_workers_of_a_cluster(here):
    distributed = pytest.importorskip("distributed")
    one = run(LINEAR, folder="one", count=5000).content
    for workers in (1, 2, 4):
        with distributed.LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster:
            killed = []

            def kill(what, done, cluster=cluster, killed=killed):
                if not killed and workers == 2:
                    killed.append(next(iter(cluster.workers.values())).pid)
                    os.kill(killed[0], signal.SIGKILL)

            assert run(folder=f"of{workers}", count=5000, scheduler=cluster.scheduler_address, progress=kill).content == one
    with pytest.raises(elastocheck.ArgumentError, match="--scheduler"):
        run(folder="none", scheduler="nowhere://x")


def test_study_killed_at_any_moment_continues_to_the_same_content(here):
    whole = run(LINEAR, folder="whole", count=100_000 // 8).content
    moments, part, killed = random.Random(1), 0, 0
    for turn in range(21):  # twenty times by kill -9, once by Ctrl-C
        process = subprocess.Popen([os.environ["ELASTOCHECK"], "study", "study.yaml", "-o", "out", "--count", str(100_000 // 8), "--jobs",
                                    str(1 + turn % 2)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        before = os.path.exists("out/ledger.sqlite") and os.path.getsize("out/ledger.sqlite")
        for _ in range(12_000):  # two minutes, of a loaded machine
            if process.poll() is not None or os.path.exists("out/ledger.sqlite") and os.path.getsize("out/ledger.sqlite") > before + 8192:
                break
            time.sleep(0.01)
        time.sleep(moments.uniform(0, 0.1))
        process.send_signal(signal.SIGKILL if turn < 20 else signal.SIGINT)
        said = process.communicate()[1]
        killed += process.returncode != 0
        assert "Traceback" not in said and process.returncode in (0, -signal.SIGKILL, 130), said
        part += 0 < sqlite3.connect("out/ledger.sqlite").execute("SELECT count(*) FROM variants").fetchone()[0] < 100_000 // 8
    assert killed > 1 and part > 0, "never killed in the middle"
    assert run(count=100_000 // 8).content == whole


def test_full_disk_keeps_every_recorded_row_of_a_study(here):
    whole = run(LINEAR, folder="whole").content
    said = command("-o", "out", "--quiet", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000)))
    assert said.returncode == 2 and "out/ledger.sqlite: " in said.stderr
    told = []
    assert run(say=told.append).content == whole
    assert int(told[0].split()[0]) < 4096


def test_extended_study_computes_only_its_new_variants(here):
    said = []
    run(MCPHERSON, folder="grown", count=300)
    grown = run(folder="grown", count=700, say=said.append)
    again = run(folder="grown", count=700, say=said.append)
    assert [line for line in said if "computed" in line] == [said[0]] and said[0].startswith("400 variants computed")
    assert again.content == grown.content == run(folder="whole", count=700).content
    # Limits are no part of what was computed.
    limited = run(MCPHERSON + "limits: {toe: {max: 0}}\n", folder="grown", count=700)
    assert limited.content == grown.content and figure(limited)["outside"] == 0
    with pytest.raises(elastocheck.SceneError, match="a Latin hypercube cannot be extended"):
        run(MCPHERSON.replace("kind: sobol", "kind: latin_hypercube"), folder="hypercube", count=3000)


def test_ledgers_of_other_studies_scenes_and_versions_are_refused(here):
    run(LINEAR, folder="first", count=300)
    for what, by in [("sd: 20", "sd: 21"), ("seed: 3", "seed: 4"), ("@up:1500", "@up:3000")]:
        with pytest.raises(elastocheck.FileError, match="is of another study file"):
            run(LINEAR.replace(what, by), folder="first", count=300)
    write(LINEAR)
    scene = pathlib.Path("parallel_springs.yaml").read_text()
    write(scene.replace("rate: 45", "rate: 46"), "parallel_springs.yaml")
    with pytest.raises(elastocheck.FileError, match="first/ledger.sqlite: is of another scene"):
        run(folder="first", count=300)
    write(scene, "parallel_springs.yaml")
    with sqlite3.connect("first/ledger.sqlite") as base:
        base.execute("UPDATE meta SET value = '0.0.1 abc' WHERE key = 'version'")
    assert run(folder="first", count=300, show=True).rows == 300  # shown, and no rows are added to them
    with pytest.raises(elastocheck.FileError, match="is of another version of the program: 0.0.1 abc there, "):
        run(folder="first", count=400)
    os.rename("first/ledger.sqlite", "first/ledger-1-of-1.sqlite")
    with pytest.raises(elastocheck.FileError, match="first/ledger-1-of-1.sqlite: is of another version"):
        run(folder="second", count=300, merge=["first"])
    write("no ledger", "first/ledger-1-of-1.sqlite")
    with pytest.raises(elastocheck.FileError, match="ledger-1-of-1.sqlite: "):
        run(folder="second", count=300, merge=["first"])


def test_two_processes_do_not_write_one_ledger_and_no_link_is_followed(here):
    from elastocheck.study.ledger import locked
    run(LINEAR, count=10)
    with locked("out/ledger.sqlite"), pytest.raises(elastocheck.FileError, match="another process is computing this study here"):
        run(count=20)
    os.mkdir("linked")
    os.symlink("../out/ledger.sqlite", "linked/ledger.sqlite")
    for options in ({"show": True}, {"count": 20}):
        with pytest.raises(elastocheck.FileError, match="linked/ledger.sqlite: is a symbolic link"):
            run(folder="linked", **options)


MEMORY = """import sys
from elastocheck.study.file import Study
from elastocheck.study.ledger import Ledger
from elastocheck import study
import numpy as np
count = int(sys.argv[1])
ledger = Ledger("ledger.sqlite", Study("study.yaml", count))
heights = np.random.default_rng(1).normal(size=count)
for first in range(0, count, 4096):
    rows = [(k, "solved", "series", None, heights[k].item()) for k in range(first, min(first + 4096, count))]
    ledger.add(rows, [row for row in rows if row[0] % 1024 == 0])
study.run("study.yaml", ".", count, show=True, csv="rows.csv")
print(next(line for line in open("/proc/self/status") if line.startswith("VmHWM")).split()[1])
"""


def test_a_row_of_a_ledger_needs_less_than_a_hundred_bytes_of_memory(here):
    write(LINEAR.replace("seed: 3", "seed: 3, indices: true"))
    kilobytes = []
    for count in (4096, 400_000):
        pathlib.Path("ledger.sqlite").unlink(missing_ok=True)
        done = subprocess.run([sys.executable, "-c", MEMORY, str(count)], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        kilobytes.append(int(done.stdout))
    assert kilobytes[1] - kilobytes[0] < 40_000 and kilobytes[1] < 200_000, kilobytes


# ---- A damaged ledger.

def test_negative_zeros_in_a_ledger_are_accepted(here):
    """Camber as drawn is -0: SQLite keeps 0."""
    assert math.copysign(1, elastocheck.read("mcpherson.yaml").variants({"springs.K1_coil.rate": [3e4]}, "camber")[0][0, 0]) == -1
    report, said = run(MCPHERSON.replace("toe: toe@jounce:3000", "toe: camber"), count=20), []
    assert run(count=20, say=said.append).content == report.content and not any("computed" in line for line in said)
    assert run(count=20, show=True).frame()["toe [deg]"].tolist() == [0] * 20


@pytest.mark.parametrize("change, row", [
    ("variants SET f1 = f1 + 1e-12 WHERE k = 17", 17), ("variants SET reason = 'x' WHERE k = 17", 17),
    ("variants SET outcome = 'no scene' WHERE k = 17", 17), ("variants SET method = 'equilibrium' WHERE k = 17", 17),
    ("variants SET k = 99 WHERE k = 17", 99), ("witnesses SET f1 = 1 WHERE k = 0", 0), ("variants SET f1 = 'abc' WHERE k = 17", 17),
    ("variants SET checksum = 1 WHERE k = 17", 17)])
def test_damaged_row_of_a_ledger_is_reported_and_computed_again(here, change, row):
    good = run(LINEAR, count=40).content
    with sqlite3.connect("out/ledger.sqlite") as base:
        base.execute("UPDATE " + change)
    said = []
    with pytest.raises(elastocheck.FileError, match=f"row {row} of {change.split()[0]}: its content is not that of its checksum"):
        run(count=40, show=True)
    assert run(count=40, say=said.append).content == good
    assert f"row {row} of " in said[0] and "; it is computed again" in said[0] and said[1].startswith("1 variants computed")


def test_flipped_bit_in_a_ledger_is_detected_or_changes_no_result(here):
    good = run(LINEAR, count=1000).content
    whole = pathlib.Path("out/ledger.sqlite").read_bytes()
    bits, found = random.Random(2), 0
    for _ in range(40):
        damaged = bytearray(whole)
        bit = bits.randrange(8 * len(whole))
        damaged[bit // 8] ^= 1 << bit % 8
        pathlib.Path("out/ledger.sqlite").write_bytes(damaged)
        said = []
        try:
            assert run(count=1000, say=said.append).content == good, bit
            found += any("computed" in line for line in said)
        except elastocheck.FileError as error:
            assert "out/ledger.sqlite: " in str(error)
            found += 1
    assert found > 20


# ---- What it leaves.

def test_page_of_a_study_shows_every_figure(here):
    run(LINEAR.replace("seed: 3", "seed: 3, indices: true"))
    page = pathlib.Path("out/study.html").read_text()
    for part in ['<h2 id="figure-1-title">height</h2>', "Shares of the variance", "Over static_loads.weight.force.z",
                 "total Sobol index of height: static_loads.weight.force.z 0.", "default-src 'none'"]:
        assert part in page, part
    assert page.count("<svg") == 4 and not re.search("[^a-z]nan[^a-z]", page)  # histogram, shares, two variables
    write("springs.first.rate\n-1\n30\n", "list.csv")
    run(LIST.replace(", springs.second.rate: {}", ""), folder="other")
    other = pathlib.Path("other/study.html").read_text()
    assert "1 solved, 1 no scene" in other and "Squared correlation" in other
    os.mkdir("mine")
    write("<!DOCTYPE html><html>mine", "mine/study.html")
    with pytest.raises(elastocheck.FileError, match="mine/study.html: "):
        run(folder="mine")
    assert os.listdir("mine") == ["study.html"]


def test_csv_and_hdf5_of_a_study_have_all_rows(here):
    report = run(MCPHERSON, count=300, csv="rows.csv", hdf5="rows.h5")
    frame = report.frame()
    pandas.testing.assert_frame_equal(pandas.read_csv("rows.csv", float_precision="round_trip", keep_default_na=False), frame, check_exact=True)
    h5py = pytest.importorskip("h5py")
    with h5py.File("rows.h5") as file:
        assert np.array_equal(file["toe [deg]"], frame["toe [deg]"]) and file["outcome"][0] == b"solved" and len(file) == frame.shape[1]
    write("mine", "mine.csv")
    with pytest.raises(elastocheck.FileError, match="mine.csv: "):
        run(count=300, csv="mine.csv")
    solver = Study("study.yaml").solver  # the figures of a row are those of its numbers
    numbers = Study("study.yaml").numbers(frame.iloc[:5, 3:7].to_numpy())
    assert np.array_equal(solver.solve(numbers, "series", 1)[0], frame.iloc[:5, 7:].to_numpy())


def test_study_command_has_exit_codes_and_json_and_names_missing_packages(here, tmp_path):
    write(LINEAR)
    said = command("-o", "out", "--count", "300", "--jobs", "1", "--json")
    document = json.loads(said.stdout)
    assert said.returncode == 0 and document == json.loads(pathlib.Path("out/statistics.json").read_text())
    assert document["reproduce"] == "elastocheck study study.yaml -o out --count 300 --json" and document["rows"] == 300
    for options, says in [(["-o", "x", "--shard", "3/2"], "elastocheck: --shard '3/2': allowed: K/N"),
                          (["-o", "x", "--show"], "elastocheck: x/ledger.sqlite: no such ledger; nothing has been computed"),
                          (["-o", "x", "--show", "--merge", "out"], "elastocheck: --show computes nothing")]:
        said = command(*options)
        assert said.returncode == 2 and says in said.stderr and not os.path.exists("x")
    # What is not complete is not judged: it is printed, with 3.
    write(LINEAR.replace("witness: 1024", "witness: 100"), "study.yaml")
    assert command("-o", "part", "--shard", "1/2", "--count", "600").returncode == 0
    said = command("-o", "part", "--merge", "part", "--count", "600")
    assert said.returncode == 3 and "inconclusive: 256 variants are missing\n344 of 600 variants: 344 solved.\n" in said.stdout
    # Where neither the program's folder nor Python has the package.
    shutil.copy(os.environ["ELASTOCHECK"], tmp_path / "elastocheck")
    alone = subprocess.run([tmp_path / "elastocheck", "study", "study.yaml", "-o", "y"], capture_output=True, text=True, check=False,
                           env={name: value for name, value in os.environ.items() if name != "PYTHONPATH"})
    assert alone.returncode == 2 and "`./dev study` builds and installs what it needs" in alone.stderr


def test_study_as_an_array_of_jobs_has_the_same_content(here):
    one = run(MCPHERSON, folder="one").content
    path = {"PATH": f"{pathlib.Path(os.environ['ELASTOCHECK']).parent}:{os.environ['PATH']}"}
    for k in (1, 2, 3):
        subprocess.run(["sh", ROOT / "models/studies/study.sbatch", "study.yaml", "parts", "3"], check=True, capture_output=True,
                       env={**os.environ, **path, "SLURM_ARRAY_TASK_ID": str(k)})
    assert run(folder="parts", merge=["parts"]).content == one


@pytest.mark.skipif(not all(map(shutil.which, ["slurmctld", "slurmd", "munged", "sbatch"])), reason="slurm-wlm or munge is not installed")
def test_slurm_array_with_a_cancelled_job_is_continued(here):
    one = run(MCPHERSON, folder="one", count=3000).content
    write(MCPHERSON.replace("count: 780", "count: 3000"))
    sbatch = ROOT / "models/studies/study.sbatch"
    write(f"""cd {here}
first=$(sbatch --parsable --array=1-3 {sbatch} study.yaml parts 3)
for k in $(seq 600); do [ -s parts/ledger-1-of-3.sqlite ] && break; sleep 0.05; done
scancel ${{first}}_1
sbatch --wait --dependency=afterany:$first --wrap true >/dev/null
sbatch --parsable --wait --array=1-3 {sbatch} study.yaml parts 3
""", "submit.sh")
    path = f"{pathlib.Path(os.environ['ELASTOCHECK']).parent}:{os.environ['PATH']}"
    said = subprocess.run(["sh", ROOT / "tests/reports/one_node_slurm.sh", here / "slurm", "sh", here / "submit.sh"], capture_output=True,
                          text=True, check=False, env={**os.environ, "PATH": path})
    if said.returncode == 77:
        pytest.skip("Slurm does not start here: " + said.stderr)
    assert run(folder="parts", merge=["parts"]).content == one, said.stderr


# ---- Variants without a study.

def test_figures_of_variants_equal_those_of_their_scenes_read_alone(scenes):
    scene = elastocheck.read(scenes / "mcpherson.yaml", {"springs.K1_coil.rate": 28e3})
    height = scene.numbers["points.tie_rod_inner.z"] + np.array([-1e-3, 0, 2e-3])
    numbers = pandas.DataFrame({"points.tie_rod_inner.z": height})
    values, outcomes = scene.variants(numbers, {"toe at jounce": "toe@jounce:3000", "least": "min camber@rebound"})
    reference = scene.variants(numbers, ["toe@jounce:3000", "min camber@rebound"], "equilibrium", threads=1)[0]
    assert outcomes == ["solved"] * 3
    np.testing.assert_allclose(values, reference, rtol=1e-9, atol=1e-12)
    for z, toe in zip(height, values[:, 0]):
        assert scene.vary({"points.tie_rod_inner.z": z}).solve("series", "toe", branches="jounce")["jounce"]["toe"][-1] == pytest.approx(toe, rel=1e-9)
    values, outcomes = scene.variants({"springs.K1_coil.rate": [-1.0, 30e3]}, "toe@jounce:3000")
    assert np.isnan(values[0]).all() and outcomes[0].startswith("no scene: ") and outcomes[1] == "solved"
    for wrong in [({"springs.coil.rate": [1.0]}, "toe@jounce:3000"), ({"points.tie_rod_inner.z": [0.0]}, "to@jounce:3000")]:
        with pytest.raises(elastocheck.Error):
            scene.variants(*wrong)
    with pytest.raises(elastocheck.ArgumentError, match="allowed: series, equilibrium, energy"):
        scene.variants(numbers, "toe@jounce:3000", "published")


def test_figures_of_variants_with_a_trim_are_those_of_a_trim_from_nothing(scenes):
    """By series a variant's trim starts from the scene's; by the equilibrium leg from nothing, and it is confirmed."""
    scene = elastocheck.read(scenes / "double_wishbone.yaml")
    number = "points.tie_rod_inner.z"
    numbers = {number: scene.numbers[number] + np.array([-2, 0, 3.0])}
    figures = ["toe@travel:80", "camber@travel:-80", "wheel_rate"]
    values, outcomes = scene.variants(numbers, figures, threads=1)
    assert outcomes == ["solved"] * 3 and np.ptp(values[:, 0]) > 0.01
    np.testing.assert_allclose(values, scene.variants(numbers, figures, "equilibrium")[0], rtol=1e-9, atol=1e-9)
    again = scene.variants({number: numbers[number][2:]}, figures, threads=1)[0]
    assert np.array_equal(again, values[2:])  # the variants before do not matter
