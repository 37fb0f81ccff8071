// Joint reactions for given poses.
#include <limits>

#include "elastocheck/equilibrium.hpp"
#include "reference/equilibrium/linear_algebra/derivatives.hpp"
#include "reference/equilibrium/linear_algebra/linearisation.hpp"

namespace elastocheck::reference::equilibrium {

// The balances are linear in the reactions R: E = E_0 + E_R R, E_R the upper right block of J. The
// shortest correction of R makes |E| least.
std::vector<Wrench> reactions_at(const Model& model, const Branch& branch, double a,
                                 const std::vector<Pose>& poses) {
    const System system = make_system(model, branch, {&a, 1});
    Eigen::VectorXd x = unknowns_at(system, poses);
    Counts counts;
    const Derivatives slopes = derivatives(system, {a}, x, counts);
    const Eigen::Index n = 6 * system.bodies, m = system.constraint_rows;
    if (!slopes.E.allFinite() || !is_finite(slopes.J)) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        return {model.joints.size(),
                {Eigen::Vector3d::Constant(nan), Eigen::Vector3d::Constant(nan)}};
    }
    if (n > 0 && m > 0) x.tail(m) -= least_squares(slopes.J.topRightCorner(n, m), slopes.E.head(n));
    return state_of(system, {a}, x).reactions;
}

}  // namespace elastocheck::reference::equilibrium
