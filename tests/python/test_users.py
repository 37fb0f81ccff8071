"""Foreign programs drive the module: scipy, OpenTURNS, dask."""
import pathlib
import sys

import elastocheck
import numpy as np
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import users  # noqa: E402

DRAWN = np.array([elastocheck.new("double_wishbone").numbers[name] for name in users.NUMBERS])


def test_scipy_finds_the_tie_rod_height_without_bump_steer():
    optimize = pytest.importorskip("scipy.optimize")
    found = optimize.root_scalar(lambda z: users.bump_steer([z, DRAWN[1]]), x0=DRAWN[0], x1=DRAWN[0] + 1e-3,
                                 method="secant", xtol=1e-12)
    assert found.converged and abs(users.bump_steer([found.root, DRAWN[1]])) < 1e-9
    assert abs(found.root - DRAWN[0]) > 1e-6
    least = optimize.minimize(lambda z: users.bump_steer(z) ** 2 + 1e3 * np.sum((z - DRAWN) ** 2), DRAWN,
                              method="Nelder-Mead", options={"maxfev": 200, "initial_simplex": DRAWN + 1e-3 * np.array([[0, 0], [1, 0], [0, 1]])})
    assert abs(users.bump_steer(least.x)) < abs(users.bump_steer(DRAWN))


def test_openturns_differences_equal_the_derivatives_of_sensitivity():
    openturns = pytest.importorskip("openturns")
    function = openturns.PythonFunction(2, 1, lambda x: [users.bump_steer(x)])
    assert function(DRAWN)[0] == users.bump_steer(DRAWN)
    differences = np.array(function.gradient(DRAWN)).ravel()
    report = elastocheck.sensitivity(elastocheck.new("double_wishbone"), "bump_steer", users.NUMBERS,
                                     branch="travel", points=1)
    exact = report.frame("derivatives")
    exact = exact[exact["parameter"].abs() < 1e-9].drop_duplicates("number").set_index("number")
    rate = [column for column in exact.columns if column.startswith("derivative")][0]
    np.testing.assert_allclose(differences, exact.loc[users.NUMBERS, rate], rtol=1e-4)
    sample = openturns.ComposedDistribution([openturns.Normal(z, 0.5e-3) for z in DRAWN]).getSample(20)
    steer = function(sample)
    assert steer.getSize() == 20 and steer.computeStandardDeviation()[0] > 0


def test_dask_workers_have_the_results_of_the_calling_process():
    distributed = pytest.importorskip("distributed")
    strut = elastocheck.new("mcpherson")
    drawn = np.array([strut.numbers[name] for name in users.NUMBERS])
    heights = drawn + np.random.default_rng(1).normal(0, 0.5e-3, (1000, 2))
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True,
                                  dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        client.run(lambda folder: sys.path.insert(0, folder), str(pathlib.Path(__file__).parent))
        futures = client.map(users.toe_at_full_jounce, heights.tolist())
        answers = client.gather(futures)
        workers = {worker for key in client.who_has(futures).values() for worker in key}
        scene = elastocheck.new("pinned_bar", settings={"bushings.tip.rates.z": 21})
        sent = client.submit(lambda s: s.solve("series").csv(), scene).result()
    assert len(workers) == 2
    assert sent == scene.solve("series").csv()
    assert answers[::50] == [users.toe_at_full_jounce(h) for h in heights[::50]]
    assert len(answers) == 1000 and np.isfinite(answers).all() and len(set(answers)) == 1000
