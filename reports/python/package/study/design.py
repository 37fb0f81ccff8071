"""The values of the variables in each variant of a study."""
import warnings

import numpy as np
from scipy.special import ndtr, ndtri
from scipy.stats import qmc

_LEAST, _MOST = 2.0**-54, 1 - 2.0**-53  # of the open unit interval


class Design:
    """Variant k, from 0, is a function of the study and k alone."""

    def __init__(self, study):
        self.study = study
        self.dimension = len(study.variables) * (2 if study.indices else 1)
        if study.kind == "latin_hypercube":
            self.cube = qmc.LatinHypercube(self.dimension, seed=study.seed).random(study.count)
        elif study.kind == "sobol":
            # Scrambled by Owen's method with random linear matrices, which the seed fixes.
            self.sobol = qmc.Sobol(self.dimension, scramble=True, bits=53, seed=study.seed)
        self.factor = None if study.correlation is None else np.linalg.cholesky(study.correlation)

    def values(self, first, end):
        """Values of the variants from `first` to before `end` [variants x variables], in the units of the scene file."""
        study, k = self.study, np.arange(first, end)
        if study.kind == "list":
            return study.table[first:end]
        if study.kind == "grid":
            places = np.unravel_index(k, [len(v.numbers) for v in study.variables])
            return np.column_stack([np.array(v.numbers)[i] for v, i in zip(study.variables, places)])
        u = x = self.points(k)
        if self.factor is not None:  # a normal copula
            x = np.clip(ndtr(ndtri(u) @ self.factor.T), _LEAST, _MOST)
        return np.column_stack([v.distribution.ppf(x[:, j]) if v.continuous
                                else np.array(v.numbers)[(u[:, j] * len(v.numbers)).astype(int)]
                                for j, v in enumerate(study.variables)])

    def points(self, k):
        """Points of the unit cube for the variants k [variants x variables]; in each block of a design for Sobol indices a, b,
        then a with one coordinate after the other from b."""
        block, place = np.divmod(k, self.study.block)
        both, d = self._bases(int(block[0]), int(block[-1]) + 1)[block - block[0]], len(self.study.variables)
        from_b = (place == 1)[:, None] | (place[:, None] == np.arange(d) + 2)
        return np.clip(np.take_along_axis(both, np.arange(d) + np.where(from_b, self.dimension - d, 0), axis=1), _LEAST, _MOST)

    def _bases(self, first, end):
        """Points a, and b beside it, of the blocks from `first` to before `end` [blocks x dimension]."""
        if self.study.kind == "latin_hypercube":
            return self.cube[first:end]
        if self.study.kind == "monte_carlo":
            numbers = np.random.PCG64(self.study.seed).advance(first * self.dimension)
            return np.random.Generator(numbers).random((end - first, self.dimension))
        if first < self.sobol.num_generated:
            self.sobol.reset()
        with warnings.catch_warnings():  # SciPy warns that the number of points is not a power of 2
            warnings.simplefilter("ignore", UserWarning)
            while first > self.sobol.num_generated:  # fast_forward() of SciPy 1.10 has 32 bits only
                self.sobol.random(min(first - self.sobol.num_generated, 65536))
            return self.sobol.random(end - first)
