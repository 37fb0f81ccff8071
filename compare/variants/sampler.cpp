#include "compare/variants/sampler.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <stdexcept>

#include "models/overloaded.hpp"

namespace elastocheck::compare::variants {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Inside the unit interval, of 53 bits.
double inside(std::uint64_t bits) { return (static_cast<double>(bits) + 0.5) * 0x1p-53; }

// Generator of variant k, or of the study: engine and seed_seq give the same numbers everywhere.
std::mt19937_64 generator(std::uint64_t seed, std::uint64_t k) {
    const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
    std::seed_seq words{low(seed), low(seed >> 32), low(k), low(k >> 32)};
    return std::mt19937_64(words);
}
constexpr std::uint64_t of_the_study = ~std::uint64_t{0};

const std::vector<double>& levels_of(const Variable& variable) {
    return std::visit(
        overloaded{[](const Levels& levels) -> const std::vector<double>& { return levels.values; },
                   [&](const auto&) -> const std::vector<double>& {
                       throw std::invalid_argument(variable.name + " has no levels");
                   }},
        variable.distribution);
}

}  // namespace

bool is_continuous(const Distribution& distribution) {
    return std::visit(
        overloaded{[](const Levels&) { return false; }, [](const Given&) { return false; },
                   [](const auto&) { return true; }},
        distribution);
}

std::uint64_t grid_size(const std::vector<Variable>& variables) {
    std::uint64_t size = 1;
    for (const Variable& variable : variables) {
        size *= levels_of(variable).size();
        if (size > most_variants)
            throw std::invalid_argument("a grid of more than 1000000000 combinations");
    }
    return size;
}

std::uint64_t block_size(const Study& study) {
    return study.design.indices ? study.variables.size() + 2 : 1;
}

Sampler::Sampler(const Study& study) : study_(study) {
    const std::size_t d = study.variables.size() * (study.design.indices ? 2 : 1);
    const std::uint64_t seed = study.design.seed;
    std::visit(overloaded{[](const Grid&) {}, [](const List&) {}, [](const MonteCarlo&) {},
                          [&](const LatinHypercube&) {
                              hypercube_ = openturns::latin_hypercube(study.design.count, d, seed);
                          },
                          [&](const Sobol&) {
                              const std::uint64_t points = study.design.count / block_size(study);
                              directions_ = openturns::sobol_directions(
                                  d, std::max(1, static_cast<int>(std::bit_width(points))));
                              auto random = generator(seed, of_the_study);
                              for (std::size_t j = 0; j < d; ++j) shift_.push_back(random() >> 11);
                          }},
               study.design.kind);
    std::vector<Distribution> distributions;
    for (std::size_t j = 0; j < study.variables.size(); ++j) {
        if (!is_continuous(study.variables[j].distribution)) continue;
        continuous_.push_back(static_cast<Index>(j));
        distributions.push_back(study.variables[j].distribution);
    }
    if (distributions.empty()) return;
    MatrixXd correlation;
    if (study.correlation.size() > 0) correlation = study.correlation(continuous_, continuous_);
    transformation_ = openturns::transformation(distributions, correlation);
}

// Of the unit cube; with indices, of twice the dimensions, and k counts blocks.
VectorXd Sampler::cube_point(std::uint64_t k) const {
    const auto d = static_cast<Index>(study_.variables.size()) * (study_.design.indices ? 2 : 1);
    VectorXd u(d);
    std::visit(
        overloaded{
            [&](const MonteCarlo&) {
                auto random = generator(study_.design.seed, k);
                for (double& x : u) x = inside(random() >> 11);
            },
            [&](const LatinHypercube&) {
                u = hypercube_.row(static_cast<Index>(k)).cwiseMax(0x1p-54).cwiseMin(1 - 0x1p-53);
            },
            [&](const Sobol&) {
                const std::uint64_t gray = k ^ (k >> 1);
                for (Index j = 0; j < d; ++j) {
                    const auto& of = directions_[static_cast<std::size_t>(j)];
                    std::uint64_t x = shift_[static_cast<std::size_t>(j)];
                    for (std::size_t b = 0; b < of.size(); ++b)
                        if ((gray >> b & 1) != 0) x ^= of[b];
                    u[j] = inside(x);
                }
            },
            [](const auto&) {}},
        study_.design.kind);
    return u;
}

MatrixXd Sampler::points(std::uint64_t first, std::uint64_t count) const {
    const auto d = static_cast<Index>(study_.variables.size());
    const std::uint64_t block = block_size(study_);
    MatrixXd u(static_cast<Index>(count), d);
    for (std::uint64_t k = first; k < first + count; ++k) {
        const VectorXd both = cube_point(k / block);
        auto row = u.row(static_cast<Index>(k - first));
        const auto place = static_cast<Index>(k % block);  // a, b, a with one from b
        row = place == 1 ? both.tail(d) : both.head(d);
        if (place > 1) row[place - 2] = both[d + place - 2];
    }
    return u;
}

MatrixXd Sampler::values(std::uint64_t first, std::uint64_t count) const {
    const auto n = static_cast<Index>(count), d = static_cast<Index>(study_.variables.size());
    const auto drawn = [&]() -> MatrixXd {
        const MatrixXd u = points(first, count);
        MatrixXd x(n, d);
        if (transformation_) {
            const std::scoped_lock one_at_a_time(drawing_);
            x(Eigen::all, continuous_) = transformation_(u(Eigen::all, continuous_));
        }
        for (Index j = 0; j < d; ++j) {
            const Variable& variable = study_.variables[static_cast<std::size_t>(j)];
            if (is_continuous(variable.distribution)) continue;
            const auto& levels = levels_of(variable);
            for (Index i = 0; i < n; ++i)
                x(i, j) =
                    levels[static_cast<std::size_t>(u(i, j) * static_cast<double>(levels.size()))];
        }
        return x;
    };
    return std::visit(overloaded{[&](const Grid&) {
                                     MatrixXd x(n, d);
                                     for (Index i = 0; i < n; ++i) {
                                         std::uint64_t rest = first + static_cast<std::uint64_t>(i);
                                         for (Index j = d; j-- > 0;) {
                                             const auto& levels = levels_of(
                                                 study_.variables[static_cast<std::size_t>(j)]);
                                             x(i, j) = levels[rest % levels.size()];
                                             rest /= levels.size();
                                         }
                                     }
                                     return x;
                                 },
                                 [&](const List& list) -> MatrixXd {
                                     return list.values.middleRows(static_cast<Index>(first), n);
                                 },
                                 [&](const auto&) { return drawn(); }},
                      study_.design.kind);
}

}  // namespace elastocheck::compare::variants
