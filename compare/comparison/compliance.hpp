// Response of a state to small changes at its wheels, by one leg: input of the kinematics and
// compliance characteristics.
//
// Compliance is computed with jacks and tyres removed, since both would add their own stiffness.
// Two models replace that of the branch, in the same state:
//
//   free     jacks and tyres removed; the forces that they exert act as dead forces at their points
//   jacked   the free model with one jack under every wheel centre, at the height of that centre
//
// Where the wheels of an axle move only together (heave only, or roll only), the height of one
// wheel centre fixes all of them, and the jacked model has one jack.
//
// A jack and a dead force at its point are both vertical and have the same geometric stiffness when
// the wheel turns. The tangent therefore equals that of the branch except for the removed supports.
// A leg that refines its solutions computes the responses of the jacked model as those of the free
// one under the forces of the jacks, from one factorisation; the jacked model is solved only where
// these forces are not determined. The recursion does so on request (Analyses::one_factorisation):
// such responses differ from its own by 1e-10.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/outputs/wheel_response.hpp"
#include "models/response.hpp"
#include "recursive/linear_response.hpp"

namespace elastocheck::reference::equilibrium {
struct Orders;  // linear_response.hpp
}

namespace elastocheck::compare {

// Data of one response model of a branch side, made on first use. It does not depend on the state, except
// for the elimination orders, those of the last state, which affect rounding only.
struct ResponseCache {
    std::optional<recursive::ResponseAnalysis> recursion;
    std::optional<recursive::ResponseAnalysis> before;  // of a similar model, for its orders
    std::shared_ptr<const reference::equilibrium::Orders> equilibrium;
};
// All that is kept of a branch side, for a leg.
struct Analyses {
    ResponseCache free, jacked;
    ResponseCache tied;                              // of the jacked model with one jack
    std::optional<std::vector<int>> dependent_rows;  // recursive/diagnosis/self_stress.hpp
    std::optional<WheelResponse> response;           // at the state of the last row_of()
    bool one_factorisation = false;  // also for the recursion, as described at the top
};
// Empty, with the elimination orders of a similar model to begin with.
Analyses with_orders_of(const Analyses& other);

// Computes the response with the tangent of the leg at `state`; for the recursion, with the matrix
// that its method factorises. `steering`: position in Model::joints, or -1. `analyses` belong to
// the branch side and are reused over its states: the two models differ between states only in
// loads and jack heights, which an analysis does not use. Without `with_free` WheelResponse::free
// is not computed and stays empty.
WheelResponse wheel_response(const BranchSide& side, const SolverSettings& solver, int steering,
                             const Equilibrium& state, Analyses& analyses, bool with_free = true);
inline WheelResponse wheel_response(const BranchSide& side, const SolverSettings& solver,
                                    int steering, const Equilibrium& state) {
    Analyses analyses;
    return wheel_response(side, solver, steering, state, analyses);
}

// Linear response of a model at a state to unit disturbances, by one leg.
Response linear_response(const SolverSettings& solver, const Model& model, const Branch& branch,
                         const Equilibrium& state, std::span<const Disturbance> disturbances,
                         ResponseCache& cache);

// ---- Compliance matrices.

// Compliance matrix of the wheels, ground axes [6 × 6 per wheel]: rows are the displacement of the
// point [m] and the rotation [rad], columns the force at the point [N] and the moment [N·m], wheel
// by wheel; jacks and tyres removed. Empty where a wheel moves without resistance.
enum class WheelPoint { centre, patch };
Eigen::MatrixXd compliance(const Model& model, WheelPoint point, const Equilibrium& state,
                           const WheelResponse& response);

// Reciprocity error |C - Cᵀ| / |C|, both the largest entry, lengths divided by the tyre radius (1 m
// where patch and centre coincide). Zero where all forces have a potential and the state is in
// equilibrium, up to the moments that the state carries.
double reciprocity(const Model& model, const Eigen::MatrixXd& C);

// An entry in display units: mm or deg per kN or per 100 N·m. And the name of a row: "contact
// patch, left displacement x".
double in_table_units(const Eigen::MatrixXd& C, Eigen::Index row, Eigen::Index column);
std::string compliance_row_name(const Model& model, const std::string& point, Eigen::Index row);

}  // namespace elastocheck::compare
