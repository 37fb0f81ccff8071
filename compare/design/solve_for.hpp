// Numbers of a scene with which figures stay within bands, with the smallest change.
//
//   x = (p - p_0) / (high - low)      r_j: f_j less the nearest bound of its band, / g_j; 0 within
//
//   minimise |r(x)|² + μ² |x|²   over  low ≤ p ≤ high,   μ / |∂r/∂x| = 1e-2, 1e-4, 1e-6
//
// (least_squares.hpp), each from the minimum before. A wanted value is a band without width. If the
// bands can be met, r is of the order μ² at the end and |x| smallest; if not, p is nearest to them in
// this scaling, and r is perpendicular to all changes of the figures that the
// numbers within their limits can make: the figures with large components conflict.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compare/design/figures.hpp"

namespace elastocheck::compare {

struct Bands {
    Eigen::VectorXd low, high;  // band of each figure, in its unit; infinite: no bound
    Eigen::VectorXd scale;      // g_j, in its unit
};

// Figures and their gradient at the start of all searches.
struct SearchStart {
    Eigen::VectorXd value;  // values of the figures; NaN where there is none
    Eigen::MatrixXd
        gradient;  // rates [figures × numbers], NaN where there is none; empty without values
    // Change of each figure over the ranges of the numbers, to first order; whether it is only rounding.
    Eigen::VectorXd movement = {};
    std::vector<bool> still = {};

    bool complete() const { return value.allFinite() && gradient.allFinite(); }
};
SearchStart start_of(const Figures& figures, const SearchRange& range);

struct Solution {
    Eigen::VectorXd p;
    bool converged = false;  // p has the smallest change, or is nearest to the bands
    Eigen::VectorXd off;     // r
    // For each number -1 or 1 if it is at its lower or upper limit and the bands would come nearer beyond; else 0.
    std::vector<int> at_limit = {};

    double excess() const { return off.size() > 0 ? off.cwiseAbs().maxCoeff() : 0; }
    // Share |r_j| / Σ |r| of each figure in the distance from the bands.
    Eigen::VectorXd conflict() const { return off.cwiseAbs() / off.cwiseAbs().sum(); }
};
inline constexpr double met_within = 1e-7;  // |r_j| with which a wanted value is met

// Solves from p, where the figures must have values.
Solution solve_for(const Figures& figures, const Bands& bands, const SearchRange& range,
                   const Eigen::VectorXd& p);

}  // namespace elastocheck::compare
