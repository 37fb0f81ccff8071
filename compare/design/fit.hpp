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
// A combination v_k of the numbers with S_k ≤ 1e-6 S_1, or within the error of J, is not determined
// by the data: it keeps its start value, and a number with a part in it has no interval.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "compare/design/figures.hpp"

namespace elastocheck::compare {

struct Measured {
    Eigen::VectorXd value;      // per figure, in its unit
    std::vector<int> column;    // per figure: 0, 1, ...
    Eigen::VectorXd start;      // per number, in its unit
    Eigen::VectorXd low, high;  // limits, infinite where there are none
    Eigen::VectorXd step;       // per number (step_of)
};

struct Fitted {
    Eigen::VectorXd p;
    // half of the 95 % interval; infinite: not determined
    Eigen::VectorXd interval;
    Eigen::VectorXd calculated;       // figures at p
    std::vector<double> noise;        // s_c per column
    std::vector<double> rms_before;   // of f - y per column, at the start
    std::vector<bool> at_limit;       // per number: its interval is not valid
    Eigen::VectorXd singular_values;  // S, in falling order
    // columns: the undetermined combinations, as changes of the numbers in steps
    Eigen::MatrixXd undetermined;
    int freedom = 0;  // of the column with the fewest; below 1 there are no intervals
    int iterations = 0;
    bool converged = false;
    std::string why_not = {};  // reason why there is no fit
};

// t with P(|T| ≤ t) = 0.95, of Student's distribution with this many degrees of freedom.
double student_95(int freedom);

Fitted fit(const Figures& figures, const Measured& measured);

}  // namespace elastocheck::compare
