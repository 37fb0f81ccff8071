// Fit of numbers of a scene to measured figures, with 95 % intervals.
//
// The standard deviation s_c of the measurements of a column c (an output) is not known; it is
// estimated from the residuals and gives the weights,
//
//   r_k = (f_k(p) - y_k) / s_c(k),     s_c² = Σ_k (f_k - y_k)² / (N_c - n N_c / N)
//
// N values of which N_c belong to the column, n determined numbers; first s_c is the range of the
// column, then twice the estimate. With J of r by x = p / step = U S Vᵀ, the covariance of x is
// V S⁻² Vᵀ, and the intervals are ± t √C_ii, t of Student's distribution with the least number of
// degrees of freedom of a column, N_c - n N_c / N.
//
// A robust fit gives gross outliers little weight. It minimises Cauchy's loss of u = (f - y) / s_c,
//
//   ρ(u) = c²/2 log(1 + (u/c)²),   c = 2.385 (95 % efficient on normal errors),
//
// by least squares with the weights ψ(u) / u = 1 / (1 + (u/c)²), ψ = ρ', repeated until the numbers
// stay; s_c is 1.4826 median |f - y| of the column / √(1 - n/N), which half of the values may not
// spoil. Its covariance is that of an M-estimate (Huber, Robust Statistics, 1981, section 7.6):
// V S⁻² Vᵀ times
//
//   K² [Σ ψ² / (N - n)] / [mean ψ']²,   K = 1 + (n/N) var ψ' / [mean ψ']²
//
// A combination v_k of the numbers with S_k ≤ 1e-6 S_1 is not determined by the data: it stays near
// its start value (`pull` of least_squares.hpp), and a number with a part in it has no interval.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "compare/design/figures.hpp"

namespace elastocheck::compare {

// Measured values of the figures, and options of the fit.
struct Measured {
    Eigen::VectorXd value;    // value y of each figure, in its unit
    std::vector<int> column;  // column 0, 1, ... of each figure
    Eigen::VectorXd step;     // step of each number (step_of)
    bool robust = false;      // minimise Cauchy's loss
};

struct FittedColumn {
    double noise = 0;              // s_c
    double rms_before = 0;         // root mean square of f - y at the start
    int values = 0, outliers = 0;  // number of values, and of those with |f - y| > outlying s_c
};
inline constexpr double outlying = 4;

struct Fitted {
    Eigen::VectorXd p = {};
    // Half width of the 95 % interval of each number; infinite: not determined.
    Eigen::VectorXd interval = {};
    std::vector<FittedColumn> columns = {};
    std::vector<bool> at_limit = {};       // for each number; its interval is then not valid
    Eigen::VectorXd singular_values = {};  // S, in falling order
    // Undetermined combinations as columns: changes of the numbers in steps.
    Eigen::MatrixXd undetermined = {};
    int freedom = 0;  // least degrees of freedom of a column; below 1 there are no intervals
    bool converged = false;
    std::string why_not = {};  // point without a value or rate: "the start", "the result"
};

// t with P(|T| ≤ t) = 0.95, of Student's distribution with this many degrees of freedom.
double student_95(int freedom);

// Fits the numbers from range.start.
Fitted fit(const Figures& figures, const Measured& measured, const SearchRange& range);

// The figure whose measurement would best determine an undetermined combination: the one that moves
// most with it, as a share of its extent.
struct Proposal {
    Eigen::Index figure = -1;  // -1: none moves with the combination
    double movement = 0;  // change by the combination whose largest part is one step, in its unit
    double share = 0;     // |movement| / extent
};
Proposal proposal(const Eigen::MatrixXd& gradient, const Eigen::VectorXd& extent,
                  const Eigen::VectorXd& combination);

}  // namespace elastocheck::compare
