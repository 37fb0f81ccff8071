// Derivatives of the stationarity of V + λᵀΦ by the numbers of the model.
//
// `rate` is a Model of the same shape with the derivatives of its numbers (models/state_rate.hpp).
//
// A part (element or constraint) with an energy f of the poses of its two ends, f = V_k or λᵀΦ_k,
// whose points and axes move in their bodies by the rigid motion y = (v, ω) about the body's origin,
// ground axes. The end of the part is then at
//
//   δr + exp(φ) v,   exp(φ) exp(ω)       of the body at x = (δr, φ),
//
// so that with g and H the gradient and Hessian of f by the pose of the end
//
//   ∂²f/∂x∂y y = H y + (0, v × g_r + ½ ω × g_φ)
//
// since exp(φ) v = v + φ × v + ..., log(exp(φ) exp(ω)) = φ + ω + ½ φ × ω + ....
#pragma once

#include "reference/energy/state_tangent.hpp"

namespace elastocheck::reference::energy {

using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Vector12 = Eigen::Matrix<double, 12, 1>;

// One element or constraint by its two ends, ground included, at the state.
struct PartCurvature {
    BodyId i = ground, j = ground;
    Matrix12 H = Matrix12::Zero();  // of V_k or λᵀΦ_k
    Vector12 g = Vector12::Zero();  // its gradient
    Eigen::Matrix<double, 3, 12> Phi_x = Eigen::Matrix<double, 3, 12>::Zero();  // of a constraint
};
struct Parts {
    std::vector<PartCurvature> elements, constraints;  // per Model::elastics, Model::constraints
};
Parts parts_of(const Model& model, const StateTangent& tangent);

// Change by one number at a constant x and λ, and what the reactions need of it.
struct NumberRate {
    Eigen::VectorXd b;             // of ∂V/∂x + Φ_qᵀ λ [6nb]
    Eigen::VectorXd rounding;      // of b: features that move together cancel [6nb]
    Eigen::VectorXd Phi_rate;      // of Φ [m]
    std::vector<Vector12> motion;  // per constraint: y of its two ends
    std::vector<Vector12> turned;  // per constraint: change of ∂(λᵀΦ_k)/∂x by its offset
};
// Throws std::invalid_argument for a rate of another model.
NumberRate number_rate(const Model& model, const Branch& branch, const Model& rate,
                       const StateTangent& tangent, const Parts& parts);

// Rates of Equilibrium::reactions where the state changes by dx and λ by dlambda.
std::vector<Wrench> wrench_rates(const Model& model, const Model& rate, const StateTangent& tangent,
                                 const Parts& parts, const NumberRate& number,
                                 const Eigen::VectorXd& dx, const Eigen::VectorXd& dlambda);

}  // namespace elastocheck::reference::energy
