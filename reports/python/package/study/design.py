"""The values of the variables in each variant of a study."""
import warnings

import numpy as np

_BITS = 53


def _marginal(variable):
    from scipy import stats
    return {"normal": stats.norm,
            "uniform": lambda low, high: stats.uniform(low, high - low),
            "triangular": lambda low, mode, high: stats.triang((mode - low) / (high - low), low, high - low),
            "truncated_normal": lambda mean, sd, low, high: stats.truncnorm((low - mean) / sd, (high - mean) / sd, mean, sd),
            }[variable.kind](*variable.numbers)


class Design:
    """Variant k, from 0, is a function of the study and k alone."""

    def __init__(self, study):
        from scipy.stats import qmc
        self.study = study
        self.dimension = len(study.variables) * (2 if study.indices else 1)
        if study.kind == "latin_hypercube":
            self.cube = qmc.LatinHypercube(self.dimension, seed=study.seed).random(study.count)
        elif study.kind == "sobol":
            # Scrambled by Owen's method with random linear matrices, which the seed fixes.
            self.sobol = qmc.Sobol(self.dimension, scramble=True, bits=_BITS, seed=study.seed)
        self.marginals = [(j, _marginal(v)) for j, v in enumerate(study.variables) if v.continuous]
        self.factor = None if study.correlation is None else np.linalg.cholesky(study.correlation)

    def values(self, first, end):
        """Of the variants from `first` to before `end` [variants x variables], in the units of the scene file."""
        from scipy.special import ndtr, ndtri
        study, first, end = self.study, int(first), int(end)
        if study.kind == "list":
            return study.table[first:end]
        if study.kind == "grid":
            at = np.unravel_index(np.arange(first, end), [len(v.numbers) for v in study.variables])
            return np.column_stack([np.array(v.numbers)[i] for v, i in zip(study.variables, at)])
        x = u = self.points(first, end)
        if self.factor is not None:  # a normal copula
            x = np.clip(ndtr(ndtri(u) @ self.factor.T), 2.0 ** -(_BITS + 1), 1 - 2.0 ** -_BITS)
        for j, marginal in self.marginals:
            x[:, j] = marginal.ppf(x[:, j])
        for j, v in enumerate(study.variables):
            if not v.continuous:
                x[:, j] = np.array(v.numbers)[(u[:, j] * len(v.numbers)).astype(int)]
        return x

    def points(self, first, end):
        """Points of the unit cube, before the distributions."""
        block, d = self.study.block, len(self.study.variables)
        base = first // block
        both = self._bases(base, (end - 1) // block + 1)[np.arange(first, end) // block - base]
        place = np.arange(first, end) % block  # a, b, a with one from b
        u = np.where((place == 1)[:, None], both[:, -d:], both[:, :d])
        exchanged = np.flatnonzero(place > 1)
        u[exchanged, place[exchanged] - 2] = both[exchanged, d + place[exchanged] - 2]
        return np.clip(u, 2.0 ** -(_BITS + 1), 1 - 2.0 ** -_BITS)

    def _bases(self, first, end):
        if self.study.kind == "latin_hypercube":
            return self.cube[first:end]
        if self.study.kind == "monte_carlo":
            numbers = np.random.PCG64(self.study.seed).advance(first * self.dimension)
            return np.random.Generator(numbers).random((end - first, self.dimension))
        if first < self.sobol.num_generated:
            self.sobol.reset()
        with warnings.catch_warnings():  # that a number of points is not a power of 2
            warnings.simplefilter("ignore", UserWarning)
            while first > self.sobol.num_generated:  # fast_forward() of SciPy 1.10 has 32 bits only
                self.sobol.random(min(first - self.sobol.num_generated, 65536))
            return self.sobol.random(end - first)
