// Figures that the equilibrium leg found, by the energy leg and by the series.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "compare/design/figures.hpp"

namespace elastocheck::compare {

// The legs may differ by this, as a share of a figure's movement over the ranges of the numbers.
inline constexpr double legs_agree = 1e-6;

struct Confirmation {
    Eigen::VectorXd energy, series;  // figures in their units; NaN where a leg does not apply
    // A leg other than the equilibrium leg applies, and each that applies agrees on every figure.
    bool confirmed = false;
    std::string why_not = {};
};

// `values` and `movement` per figure, in the units that `units` name in messages.
Confirmation confirm(const Scene& scene, const std::vector<Figure>& figures,
                     const std::vector<std::string>& units, const Eigen::VectorXd& values,
                     const Eigen::VectorXd& movement);

}  // namespace elastocheck::compare
