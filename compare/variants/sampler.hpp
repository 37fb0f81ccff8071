// The values of the variables in each variant of a study.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <mutex>
#include <vector>

#include "compare/variants/openturns.hpp"
#include "compare/variants/study.hpp"

namespace elastocheck::compare::variants {

// All combinations of the levels; std::invalid_argument for more than most_variants.
std::uint64_t grid_size(const std::vector<Variable>& variables);

// How many variants a block of the design has: 1 or, for Sobol indices, variables + 2.
std::uint64_t block_size(const Study& study);

// Not levels, and not given by the design.
bool is_continuous(const Distribution& distribution);

class Sampler {
  public:
    // Throws std::invalid_argument without OpenTURNS where the design draws.
    explicit Sampler(const Study& study);

    // Values of the variants `first` to `first + count - 1` [count × variables], in the units of the
    // scene file. Those of a variant do not depend on which others are drawn. Thread-safe.
    Eigen::MatrixXd values(std::uint64_t first, std::uint64_t count) const;

    // Points of the unit cube, before the distributions.
    Eigen::MatrixXd points(std::uint64_t first, std::uint64_t count) const;

  private:
    Eigen::VectorXd cube_point(std::uint64_t k) const;

    const Study& study_;
    Eigen::MatrixXd hypercube_;                           // of a Latin hypercube
    std::vector<std::vector<std::uint64_t>> directions_;  // of a Sobol sequence
    std::vector<std::uint64_t> shift_;                    // per dimension
    std::vector<Eigen::Index> continuous_;                // positions of variables
    openturns::Transformation transformation_;            // of these
    mutable std::mutex drawing_;
};

}  // namespace elastocheck::compare::variants
