// The system with a border, so that it is regular where the mechanism alone is not:
//
//   E(z; a) + U μ = 0        redundant rows: U in the rows Φ, and μ is the gap by which they stay open
//                            idle motions:   U in the balances, and μ is what holds them
//   gᵀ (z - z_g)  = 0        how joints that say the same share the load, where an idle motion stands: as at z_g
//   tᵀ (y - y_t)  = 0        only where a is an unknown too
//
// Unknowns y = (z, μ, a).
#pragma once

#include <optional>
#include <string>

#include "reference/certificate/system.hpp"

namespace elastocheck::reference::certificate {

struct Border {
    Eigen::MatrixXd U, g;  // [n × k]: redundant rows first, then idle motions
    int redundant = 0;
    int count() const { return static_cast<int>(U.cols()); }
};

// What is singular at z: redundant rows from the rank of Φ alone, then idle motions. Found in floating point; what is
// proved holds whatever the border is, and says so. `nothing`: of the equilibrated matrix, what its QR finds this close to
// nothing is nothing; away from equilibrium an idle motion has some stiffness, and asks for more than rounding.
constexpr double rounding_is_nothing = 1e-11, little_is_nothing = 1e-5;
Border border_at(const System& system, const Eigen::VectorXd& z, double a,
                 double nothing = rounding_is_nothing);

// Which bodies an idle motion of the border moves, which joints its redundant rows belong to: "'strut'".
std::string idle_bodies(const System& system, const Border& border);
std::string redundant_joints(const System& system, const Border& border);

struct Problem {
    const System& system;
    Border border;
    Eigen::VectorXd z_g;  // [n]
    bool a_is_unknown = false;
    Eigen::VectorXd t, y_t;  // [n + k + 1]
    int n() const { return system.n(); }
    int size() const { return n() + border.count() + (a_is_unknown ? 1 : 0); }
};

// The equations and, by rows [size × size], their slopes. Where a is no unknown it is what is given.
template <class S>
Values<S> evaluate(const Problem& problem, const std::vector<S>& y, const S& a, Slopes slopes);
template <class S>
Values<S> evaluate_without_slopes(const Problem& problem, const std::vector<S>& y, const S& a);

Eigen::MatrixXd square(const std::vector<double>& J, Eigen::Index n);
Eigen::MatrixXd middle(const std::vector<Interval>& J, Eigen::Index n);
std::vector<double> doubles(const Eigen::VectorXd& x);
std::vector<Interval> box(const Eigen::VectorXd& middle, const Eigen::VectorXd& radius);
std::vector<Interval> thin(const Eigen::VectorXd& x);

// A floating-point inverse of the slopes, and Newton's method with it: what the proof starts from.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& J);
struct Approximate {
    Eigen::VectorXd y;
    Eigen::MatrixXd Y;
    bool settled = false;
};
Approximate newton(const Problem& problem, const Eigen::VectorXd& y, double a);

}  // namespace elastocheck::reference::certificate
