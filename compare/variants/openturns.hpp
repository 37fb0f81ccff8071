// What is taken from OpenTURNS: distributions, designs, intervals of confidence, Sobol indices.
//
// openturns.cpp, where alone its headers are included, is built where OpenTURNS is found; else
// without_openturns.cpp, where available() is false and every other function throws
// std::invalid_argument.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "compare/variants/study.hpp"

namespace elastocheck::compare::variants::openturns {

bool available();

// From points of the unit cube [points × variables], coordinates between 0 and 1 exclusively, to values
// of the variables (inverse Nataf transformation of their normal quantiles). Not thread-safe.
using Transformation = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& u)>;

// Of continuous variables with a normal copula; `correlation` [distributions × distributions], or
// empty. Throws std::invalid_argument for Levels and Given.
Transformation transformation(const std::vector<Distribution>& distributions,
                              const Eigen::MatrixXd& correlation);

// Direction numbers of the Sobol sequence per dimension, as integers of 53 bits: point k is the
// exclusive or of those at the ones of the Gray code of k.
std::vector<std::vector<std::uint64_t>> sobol_directions(std::size_t dimension, int bits);

// [count × dimension] in the unit cube, stratified in every dimension, at random within the strata.
Eigen::MatrixXd latin_hypercube(std::uint64_t count, std::size_t dimension, std::uint64_t seed);

// Clopper-Pearson interval of a share of which `hits` of `all` independent draws were seen.
std::pair<double, double> clopper_pearson(std::uint64_t hits, std::uint64_t all, double level);

// Positions from 0, in the order of size, of the values between which the percentile of the
// distribution of `all` independent draws lies with this confidence at least; -1 and `all` where
// there are too few draws for a lower or an upper bound.
std::pair<std::int64_t, std::int64_t> percentile_ranks(std::uint64_t all, double share,
                                                       double level);

struct SobolIndices {  // per variable: value, lower and upper bound
    Eigen::MatrixX3d first, total;
};
// By the estimators of Jansen and bootstrap. `outputs` [blocks × (variables + 2)]: rows as in
// Design::indices.
SobolIndices sobol_indices(const Eigen::MatrixXd& outputs, double level, std::uint64_t seed);

}  // namespace elastocheck::compare::variants::openturns
