// Linear tolerance analysis: scatter of figures from that of the numbers of a scene.
//
// With the gradient g of a figure and the covariance Σ_ij = ρ_ij σ_i σ_j of the numbers:
//
//   standard deviation  σ_f = √(gᵀ Σ g)         worst case  w_f = Σ |g_i| w_i
//   share of number i   g_i (Σ g)_i / σ_f²      (they add up to one; negative where a correlation
//                                               makes the number reduce the scatter)
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "compare/design/figures.hpp"

namespace elastocheck::compare {

// In the unit of the number.
struct Normal {
    double sd = 0;
};
struct Uniform {
    double half_width = 0;
};
struct Tolerated {
    std::string path;
    std::variant<Normal, Uniform> spread;
};

double standard_deviation(const Tolerated& number);
// Largest deviation of the worst case: the half width, or three standard deviations.
double largest_deviation(const Tolerated& number);

struct Scatter {  // of a figure, in its unit
    double sd = 0, worst_case = 0;
    Eigen::VectorXd share;  // per number; zero where sd is
};

// Whether a matrix is symmetric with ones on its diagonal and has no negative eigenvalue.
bool is_correlation(const Eigen::MatrixXd& matrix);

// `correlation` [numbers × numbers], is_correlation(); empty: independent numbers.
std::vector<Scatter> scatter(const Eigen::MatrixXd& gradient, const std::vector<Tolerated>& numbers,
                             const Eigen::MatrixXd& correlation = {});

}  // namespace elastocheck::compare
