// Numbers of a scene for which figures have wanted values, with the smallest change.
//
//   x = (p - p_0) / (high - low)      r_j = (f_j(p) - t_j) / g_j,   g_j = |∂f_j/∂x| at the start
//
//   minimise |r(x)|² + μ² |x|²   over  low ≤ p ≤ high,   μ / |∂r/∂x| = 1e-2, 1e-4, 1e-6
//
// (least_squares.hpp), each from the minimum before. If the wishes can be met, r is of the order μ² at the end and x
// that of smallest |x|; if not, the p is nearest to the wishes in this scaling, and r is
// perpendicular to all changes of the figures that the numbers within their limits can make: the
// wishes in which r has large components conflict.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "compare/design/figures.hpp"

namespace elastocheck::compare {

struct Wishes {
    Eigen::VectorXd target;     // per figure, in its unit
    Eigen::VectorXd start;      // per number, in its unit
    Eigen::VectorXd low, high;  // likewise, low < high
};

struct Solution {
    Eigen::VectorXd p = {};
    Eigen::VectorXd before = {}, after = {};  // figures at the start and at p
    FigureGradient gradient = {};             // at the start
    // per figure: no number moves it at the start; then nothing was solved
    std::vector<bool> still = {};
    // g_j: change of the figure over the ranges of the numbers, to first order
    Eigen::VectorXd movement = {};
    // every figure is at its target within `met_within` of its movement
    bool met = false;
    bool converged = false;  // to the nearest numbers
    // share of each wish in the conflict, |r_j| / |r|; zero if the wishes are met
    Eigen::VectorXd conflict = {};
    // per number: at a limit beyond which the wishes would come nearer: -1 the lower, 1 the upper
    std::vector<int> at_limit = {};
};
inline constexpr double met_within = 1e-7;

// Reasons why none of the numbers moves a figure, one for each number: "springs.coil.rate: no output
// moves with it".
std::vector<std::string> why_still(const SceneAt& scene_at, const Figure& figure,
                                   const std::vector<Number>& numbers, const Eigen::VectorXd& p);

// The figures have values and rates at the start (NaN in `before` or `gradient` if not, and nothing
// else is set).
Solution solve_for(const Figures& figures, const Wishes& wishes);

}  // namespace elastocheck::compare
