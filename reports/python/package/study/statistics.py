"""Statistics of the figures of a study, with 95 % intervals, and probabilities of rare failures, as rows of tables.

Intervals are those of independent draws; designs that fill the space more evenly scatter less.
"""
import math

import numpy as np
from scipy.stats import binom, binomtest

LEVEL = 0.95
PERCENTILES = (0.01, 0.05, 0.5, 0.95, 0.99)
_FEWEST_BLOCKS, _RESAMPLES = 10, 200  # for Sobol indices
_AGREE_OF_SPREAD, _AGREE_OF_SIZE = 1e-6, 1e-9  # of witnesses with the variants of a figure


def clopper_pearson(hits, count):
    """Interval of a share of which `hits` of `count` independent draws were seen."""
    return tuple(binomtest(hits, count).proportion_ci(LEVEL, "exact"))


def percentile_ranks(count, share):
    """Positions from 0 of the ordered values between which the percentile of the distribution lies with this
    confidence at least; -1 and `count` where there are too few draws for a lower or an upper bound."""
    # With B draws below the percentile, the value of rank r (from 1) is above it where B < r.
    low, high = binom.interval(LEVEL, count, share)
    return int(low) - 1, int(high)


def independent(study, values):
    """Values of independent variants: in a design for Sobol indices, of the variants a and b of each block."""
    return values[np.arange(len(values)) % study.block < 2] if study.indices else values


def squared_correlation(x, y):
    """Of the finite y with their x; 0 where either does not vary."""
    x, y = x[np.isfinite(y)], y[np.isfinite(y)]
    return np.corrcoef(x, y)[0, 1] ** 2 if len(y) > 1 and np.ptp(x) > 0 and np.ptp(y) > 0 else 0.0


def figure_row(study, figure, values, design):
    """The row of a figure: `values` in the order of the variants from 0, nan where there is none; `design`: of the scene."""
    drawn = independent(study, values)
    x = np.sort(drawn[np.isfinite(drawn)])
    n, outside = len(x), int(np.sum((x < figure.low) | (x > figure.high)))
    row = dict.fromkeys(["figure", "unit", "read as", "design", "mean", "+-", "sd", "least", "largest"], math.nan)
    row |= {"figure": figure.name, "unit": figure.unit, "read as": figure.words, "design": design}
    if n:
        sd = np.std(x, ddof=1) if n > 1 else math.nan
        row |= {"mean": np.mean(x), "+-": 1.959963984540054 * sd / math.sqrt(n), "sd": sd, "least": x[0], "largest": x[-1]}
    ends = np.concatenate([x, [math.nan]])  # a bound beyond the draws is none
    for share, value in zip(PERCENTILES, np.quantile(x, PERCENTILES, method="inverted_cdf") if n else [math.nan] * 5):
        low, high = percentile_ranks(n, share) if n else (-1, 0)
        row |= {f"{100 * share:g} %": value, f"{100 * share:g} % low": ends[low], f"{100 * share:g} % high": ends[high]}
    low, high = clopper_pearson(outside, n) if n and figure.limited else (math.nan, math.nan)
    return row | {"values": n, "missing": int(np.isnan(drawn).sum()), "undefined": int(np.isinf(drawn).sum()),
                  "min": figure.low, "max": figure.high, "outside": outside / n if n and figure.limited else math.nan,
                  "outside from": low, "outside to": high}


def sobol_rows(study, figure, values):
    """First and total indices by the estimators of Jansen with bootstrap intervals, of every variable, from the blocks
    in which every variant has a finite value; none of too few."""
    whole = values[:len(values) // study.block * study.block].reshape(-1, study.block)
    blocks = whole[np.isfinite(whole).all(axis=1)]
    if not study.indices or len(blocks) < _FEWEST_BLOCKS or not np.ptp(blocks) > 0:
        return []
    # By NumPy: OpenTURNS needs three times the memory of a study of a million variants.
    a, b, *exchanged = (blocks - blocks.mean()).T
    terms = np.column_stack([(a**2 + b**2) / 2, (a + b) / 2, *((y - b)**2 / 2 for y in exchanged), *((y - a)**2 / 2 for y in exchanged)])
    draw = np.random.default_rng(study.seed)
    drawn = (np.bincount(draw.integers(len(a), size=len(a)), minlength=len(a)) for _ in range(_RESAMPLES))
    means = np.array([terms.sum(axis=0), *(weights @ terms for weights in drawn)]) / len(a)
    shares = means[:, 2:] / (means[:, :1] - means[:, 1:2]**2)  # 1 - first of all variables, then total of all
    shares[:, :len(exchanged)] = 1 - shares[:, :len(exchanged)]
    low, high = np.quantile(shares[1:], [(1 - LEVEL) / 2, (1 + LEVEL) / 2], axis=0)
    return [{"figure": figure.name, "variable": variable.name}
            | {name + end: x[j + place] for name, place in [("first", 0), ("total", len(exchanged))]
               for end, x in [("", shares[0]), (" from", low), (" to", high)]}
            | {"blocks": len(a), "left out": len(whole) - len(a)} for j, variable in enumerate(study.variables)]


def witness_row(study, row, values, witnesses):
    """The largest difference between the variants of a figure and their witnesses, and sentences on disagreements."""
    finite, reference = np.isfinite(values), np.isfinite(witnesses)
    difference = np.where(finite & reference, np.abs(values - witnesses), 0)
    at, one_only = int(difference.argmax()), int((finite ^ reference).sum())
    found = {"figure": row["figure"], "unit": row["unit"], "difference": difference[at], "of variant": at * study.witness,
             "witnesses": int((finite & reference).sum()), "one only": one_only}
    allowed = max(_AGREE_OF_SPREAD * (row["largest"] - row["least"]), _AGREE_OF_SIZE * max(1.0, abs(row["mean"])))
    wrong = [f"{row['figure']}: in {one_only} variants only one of series and equilibrium has a value"] if one_only else []
    if found["witnesses"] and not difference[at] <= allowed:
        wrong.append(f"{row['figure']}: series and equilibrium differ by {difference[at]:.2g} {row['unit']} in variant "
                     f"{found['of variant']}; allowed: {allowed:.2g}")
    return found, wrong


def rare_rows(study, threads=0, samples=4096):
    """For every limit the probability that its figure is beyond it: by FORM, and by importance sampling about its design
    point. Rates by differences of variants; the same of one seed on any number of threads; of continuous variables."""
    import openturns as ot
    kinds = {"normal": ot.Normal, "uniform": ot.Uniform, "triangular": ot.Triangular, "truncated_normal": ot.TruncatedNormal}
    joint = ot.ComposedDistribution([kinds[v.kind](*v.numbers) for v in study.variables])
    if study.correlation is not None:
        joint.setCopula(ot.NormalCopula(ot.CorrelationMatrix(study.correlation.tolist())))
    steps = 1e-3 * np.array(joint.getStandardDeviation())
    rows = []
    for j, figure in enumerate(study.figures):
        def values(x, j=j):
            return study.solver.solve(study.numbers(np.array(x)), "series", threads)[0][:, j:j + 1]

        def rates(x, f=values):
            return (f(np.array(x) + np.diag(steps)) - f(np.array(x) - np.diag(steps))) / (2 * steps[:, None])

        function = ot.PythonFunction(len(steps), 1, func=lambda x, f=values: f([x])[0], func_sample=values, gradient=rates)
        for limit, beyond, holds in [(figure.low, "below", ot.Less()), (figure.high, "above", ot.Greater())]:
            if not math.isfinite(limit):
                continue
            event = ot.ThresholdEvent(ot.CompositeRandomVector(function, ot.RandomVector(joint)), holds, limit)
            row = {"figure": figure.name, "limit": f"{beyond} {limit:g} {figure.unit}"}
            row |= dict.fromkeys(["FORM", "beta", "sampled", "sampled from", "sampled to"], math.nan)
            rows.append(row)
            try:
                form = ot.FORM(ot.AbdoRackwitz(), event, joint.getMean())
                form.run()
                found = form.getResult()
                ot.RandomGenerator.SetSeed(study.seed)
                sampling = ot.PostAnalyticalImportanceSampling(found)
                sampling.setBlockSize(256)
                sampling.setMaximumOuterSampling(samples // 256)
                sampling.setMaximumCoefficientOfVariation(0.01)
                sampling.run()
                drawn = sampling.getResult()
                p, half = drawn.getProbabilityEstimate(), drawn.getConfidenceLength(LEVEL) / 2
                row |= {"FORM": found.getEventProbability(), "beta": found.getGeneralisedReliabilityIndex(),
                        "sampled": p, "sampled from": max(p - half, 0.0), "sampled to": p + half,
                        "design point": ", ".join(f"{x:.6g}" for x in found.getPhysicalSpaceDesignPoint())}
            except (RuntimeError, TypeError) as error:
                row["design point"] = "none: " + str(error).splitlines()[0]
    return rows
