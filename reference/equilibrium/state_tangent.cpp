#include "reference/equilibrium/state_tangent.hpp"

#include <Eigen/SparseCholesky>
#include <stdexcept>

#include "reference/equilibrium/continuation/continuation.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::VectorXd;

// Relative part of a right-hand side outside the range of ∂E/∂x that counts as round-off.
constexpr double residual_round_off = 1e-9;

// Largest |dx| / |E_rate|: beyond it the stiffness is round-off. Both are dimensionless, since the
// equations are solved with forces over F and lengths over L (system.hpp).
constexpr double max_flexibility = 1e10;

// Freezes the branch's drivers at a.
void freeze(Affine& path, double a) { path = {path.at(a), 0}; }
System frozen(System system, double a) {
    for (Affine& value : system.values) freeze(value, a);
    for (LoadPath& load : system.loads) freeze(load.factor, a);
    for (ElementPath& element : system.elements) {
        freeze(element.free_length, a);
        for (Affine& preload : element.preload) freeze(preload, a);
    }
    return system;
}

// Sets the reactions of x to those that leave the least |E|. E is linear in the reactions, so that
// one least-squares step is exact.
void balance(const System& system, const Loading& loading, VectorXd& x, Derivatives& at_x,
             Orders& orders) {
    Counts counts;
    const Eigen::Index n = 6 * system.bodies, m = system.constraint_rows;
    if (n == 0 || m == 0 || !is_finite(at_x.J) || !at_x.E.allFinite()) return;
    const VectorXd R =
        -least_squares(at_x.J.topRightCorner(n, m), at_x.E.head(n), &orders.of_reactions);
    x.tail(m) += R;
    add_reactions(system, loading, x, R, at_x, counts);
}

// dx + V c, V the idle modes: c minimises the norm of the motion alone, the first n rows. (The
// bordered system minimises motion and reactions together, which have no common unit.)
// `zero_tolerance` keeps VᵀV regular for modes that consist of reactions alone.
VectorXd with_shortest_motion(const System& system, const Linearisation& at, const VectorXd& dx) {
    constexpr double zero_tolerance = 1e-14;
    if (at.modes.count() == 0) return dx;
    const Eigen::Index n = 6 * system.bodies;
    const Sparse V = at.modes.right.topRows(n), V_T = V.transpose();
    Sparse identity(V.cols(), V.cols());
    identity.setIdentity();
    const Eigen::SimplicialLDLT<Sparse> gram(Sparse(V_T * V + zero_tolerance * identity));
    return dx - at.modes.right * gram.solve(VectorXd(V_T * dx.head(n)));
}

// Whether E_rate has a part outside the range of ∂E/∂x, beyond round-off.
bool has_no_solution(const Rate& rate, const VectorXd& E_rate, double rounding = 0) {
    return rate.mu.norm() > residual_round_off * E_rate.norm() + rounding;
}

}  // namespace

StateTangent tangent_at(const Model& model, const Branch& branch, const Equilibrium& state,
                        Orders& orders) {
    const double a = state.load;
    const System moving = make_system(model, branch, {&a, 1});
    if (state.poses.size() != model.bodies.size())
        throw std::invalid_argument("the state belongs to another model");
    StateTangent t{.system = frozen(moving, a), .loading = {.a = a, .a_rate = 1}};
    t.system.pattern = orders.pattern;
    Counts unused;
    t.x = unknowns_at(t.system, state.poses);
    Derivatives at_x = derivatives(t.system, t.loading, t.x, unused);
    orders.pattern = t.system.pattern;
    balance(t.system, t.loading, t.x, at_x, orders);
    if (!t.x.allFinite() || !is_finite(at_x.J)) {
        t.outcome = Outcome::not_finite;
        t.what = "the equations give a number that is not finite";
        return t;
    }
    t.at = linearise(std::move(at_x.J), nullptr, unused, &orders.of_J);
    const VectorXd E_a = rate_of(moving, t.loading, t.x);
    if (t.system.equations() > 0 &&
        (t.at.bordered.sign() == 0 || has_no_solution(solve_bordered_refined(t.at, E_a), E_a))) {
        t.outcome = Outcome::singular;
        t.what = "the system is singular, the branch turns back or bifurcates here";
    }
    return t;
}

Solved solve_at_state(const StateTangent& t, const VectorXd& E_rate, double rounding) {
    const Rate rate = solve_bordered_refined(t.at, E_rate);
    if (!rate.dx.allFinite()) return {Outcome::not_finite, "a response that is not finite", {}};
    if (rate.dx.norm() > max_flexibility * E_rate.norm())
        return {Outcome::singular, "a motion with almost no stiffness", {}};
    if (has_no_solution(rate, E_rate, rounding)) {
        const Failure why = unsolvable_load(t.system, t.at.modes.left * rate.mu);
        return {why.outcome, why.what, {}};
    }
    return {Outcome::converged, "", with_shortest_motion(t.system, t.at, rate.dx)};
}

}  // namespace elastocheck::reference::equilibrium
