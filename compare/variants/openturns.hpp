// What is taken from OpenTURNS: distributions, designs, intervals of confidence, Sobol indices.
//
// An optional component, the module elastocheck-openturns.so (openturns_module.cpp, where alone the
// headers of OpenTURNS are included). It is loaded on first use: the library takes a tenth of a second
// to load, ten times as long as the rest of the command. Without the module available() is false, and
// every other function throws std::invalid_argument.
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

// Probability that a function of independent standard normal variables is above or below a threshold.
struct Rare {
    // of the point of failure nearest to the origin: its distance, negative where the origin fails,
    // and the probability beyond the tangent plane there (FORM)
    double beta = 0, by_form = 0;
    Eigen::VectorXd point = {};
    bool is_found = false;  // on the threshold, and steepest towards the origin
    // by importance sampling about that point, and its interval
    double probability = 0, low = 0, high = 0;
    std::uint64_t evaluations = 0;
};
struct Threshold {
    bool above = true;  // else below
    double at = 0;
};
// Values of the function at the rows of a matrix; what it throws is thrown again.
using Values = std::function<Eigen::VectorXd(const Eigen::MatrixXd& u)>;
// The gradient is by central differences. At most `most` evaluations of the importance sampling, in
// blocks of `block`; fewer where the coefficient of variation is 0.02 before.
Rare rare(const Values& values, std::size_t dimension, const Threshold& threshold, double level,
          std::uint64_t seed, std::uint64_t most, std::uint64_t block);

// What the module provides, by its only symbol.
struct Functions {
    decltype(&openturns::transformation) transformation;
    decltype(&openturns::sobol_directions) sobol_directions;
    decltype(&openturns::latin_hypercube) latin_hypercube;
    decltype(&openturns::clopper_pearson) clopper_pearson;
    decltype(&openturns::percentile_ranks) percentile_ranks;
    decltype(&openturns::sobol_indices) sobol_indices;
    decltype(&openturns::rare) rare;
};
inline constexpr const char* module_file = "elastocheck-openturns.so";
inline constexpr const char* module_symbol = "elastocheck_openturns_functions";

}  // namespace elastocheck::compare::variants::openturns
