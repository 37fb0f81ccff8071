// Linear tolerance analysis: scatter of figures from that of the numbers of a scene.
//
// With the gradient g of a figure and the covariance Σ_ij = ρ_ij σ_i σ_j of the numbers:
//
//   standard deviation  σ_f = √(gᵀ Σ g)         worst case  w_f = Σ |g_i| w_i
//   share of number i   g_i (Σ g)_i / σ_f²      (they add up to one; negative where a correlation
//                                               makes the number reduce the scatter)
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace elastocheck::compare {

// A number with its standard deviation and its largest deviation, of the worst case, in its unit.
struct Tolerated {
    std::string path;
    double sd = 0, largest = 0;
};
inline Tolerated normal(std::string path, double sd) { return {std::move(path), sd, 3 * sd}; }
inline Tolerated uniform(std::string path, double half_width) {
    return {std::move(path), half_width / std::sqrt(3.0), half_width};
}

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
