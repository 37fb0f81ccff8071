// The consistent tangent: what K of eq. (19) leaves out.
//
// With the residual of the full equations
//
//   G(q, λ) = f_elast(q) + Φ_q(q)ᵀ λ - f_ext(q, a)
//
// ∂G/∂q has, beside the material stiffness, the turning of the forces that are already there: the elastic
// geometric stiffness, the curvature of the constraints Σ λ_k ∂²Φ_k, and the load stiffness. Increments are
// (Δr, Δπ) in ground axes, in which ∂G/∂q is not symmetric away from equilibrium.
//
// Everything below is a variation of a force F at a lever,
// written as 3×12 matrices over (Δr_i, Δπ_i, Δr_j, Δπ_j):
//
//   δp = δr - s̃ δπ,   δu = -ũ δπ,   δ(x × F) = -F̃ δx + x̃ δF .
#pragma once

#include "recursive/constraints.hpp"
#include "recursive/elastic.hpp"
#include "recursive/loads.hpp"

namespace elastocheck::recursive {

namespace detail {

template <class Real>
using Variation = Eigen::Matrix<Real, 3, 12>;

// δp of a point with lever s on the first (slot 0) or second
// (slot 1) body, and δu of a direction fixed in it.
template <class Real>
Variation<Real> of_point(int slot, const Vector3<Real>& s) {
    Variation<Real> v = Variation<Real>::Zero();
    v.template middleCols<3>(6 * slot).setIdentity();
    v.template middleCols<3>(6 * slot + 3) = -tilde(s);
    return v;
}
template <class Real>
Variation<Real> of_direction(int slot, const Vector3<Real>& u) {
    Variation<Real> v = Variation<Real>::Zero();
    v.template middleCols<3>(6 * slot + 3) = -tilde(u);
    return v;
}
template <class Real>
Variation<Real> of_origin(int slot) {
    return of_point<Real>(slot, Vector3<Real>::Zero());
}
template <class Real>
Variation<Real> of_rotation(int slot) {
    Variation<Real> v = Variation<Real>::Zero();
    v.template middleCols<3>(6 * slot + 3).setIdentity();
    return v;
}
template <class Real>
Variation<Real> of_cross(const Vector3<Real>& x, const Variation<Real>& dx, const Vector3<Real>& F,
                         const Variation<Real>& dF) {
    return tilde(x) * dF - tilde(F) * dx;
}

// Adds the variation of the generalised force (F, M about the origin) on one body of the pair (i, j).
template <class Real, class Target>
void add(BodyId on, BodyId i, BodyId j, const Variation<Real>& dF, const Variation<Real>& dM,
         Target& target) {
    if (on == ground) return;
    const BodyId column[] = {i, j};
    for (int slot = 0; slot < 2; ++slot) {
        if (column[slot] == ground) continue;
        target.template block<3, 6>(6 * on, 6 * column[slot]) += dF.template middleCols<6>(6 * slot);
        target.template block<3, 6>(6 * on + 3, 6 * column[slot]) += dM.template middleCols<6>(6 * slot);
    }
}

// Spring: F = t n on j, -F on i, t = u'(ℓ - ℓ₀); δF = (u'' n nᵀ + t/ℓ (I - n nᵀ)) (δp_j - δp_i).
template <class Real, class Target>
void add_tangent(const AxialSpring& e, const Rest<Real>& rest, const State<Real>& q, Target& target) {
    const auto [s_i, s_j, D, length] = deformation<Real>(e, q);
    const Real stretch = length - rest.free_length, t = gradient<Real>(e.law, stretch),
               rate = hessian<Real>(e.law, [x = stretch] { return x; });
    const Vector3<Real> n = D / length, F = t * n;
    const Matrix3<Real> along = n * n.transpose();
    const Variation<Real> dF = (rate * along + t / length * (Matrix3<Real>::Identity() - along)) *
                               (of_point<Real>(1, s_j) - of_point<Real>(0, s_i));
    add<Real>(e.j.body, e.i.body, e.j.body, dF, of_cross<Real>(s_j, of_direction<Real>(1, s_j), F, dF),
              target);
    add<Real>(e.i.body, e.i.body, e.j.body, -dF, -of_cross<Real>(s_i, of_direction<Real>(0, s_i), F, dF),
              target);
}

// ∂(J(θ)⁻ᵀ m)/∂θ. With J⁻ᵀ = I + ½ θ̃ + c θ̃² and ∇c = h θ:
//   δ(J⁻ᵀ m) = ½ δθ × m + c (δθ × (θ × m) + θ × (δθ × m)) + h (θ·δθ) θ × (θ × m)
template <class Real>
Matrix3<Real> turning_moment(const Vector3<Real>& theta, const Vector3<Real>& m) {
    using std::sin;
    using std::sqrt;
    using std::tan;
    const Real t2 = theta.squaredNorm();
    Real c, h;
    if (t2 < Real(1e-3)) {
        c = Real(1) / 12 + t2 * (Real(1) / 720 + t2 * (Real(1) / 30240 + t2 * (Real(1) / 1209600)));
        h = Real(1) / 360 + t2 * (Real(1) / 7560 + t2 * (Real(1) / 201600 + t2 * (Real(1) / 5987520)));
    } else {
        const Real t = sqrt(t2), u = t / 2;
        c = (1 - u / tan(u)) / t2;
        h = ((u / (sin(u) * sin(u)) - 1 / tan(u)) / (2 * t) - 2 * c) / t2;
    }
    const Vector3<Real> turned = theta.cross(m);
    return -tilde(m) / 2 - c * (tilde(turned) + tilde(theta) * tilde(m)) +
           h * theta.cross(turned) * theta.transpose();
}

// Bushing: F = A_i F', M = A_i J(θ)⁻ᵀ M', (F', M') = ∂u/∂e + preload, δ(F', M') = ∂²u/∂e² δe;
//   on j: (F, s_j × F + M)      on i: -(F, ρ × F + M),   ρ = p_j - r_i
//   δd = A_iᵀ (δp_j - δr_i - δπ_i × ρ),   δθ = J(θ)⁻¹ A_iᵀ (δπ_j - δπ_i)
template <class Real, class Target>
void add_tangent(const Bushing& e, const Rest<Real>& rest, const State<Real>& q, Target& target) {
    const Spatial<Real> g = deformation<Real>(e, q);
    const auto& [s_i, s_j, D, A_i, strain] = g;
    const Vector3<Real> rho = s_i + D;
    const Vector3<Real> theta = strain.template tail<3>();
    const Matrix6<Real> K = hessian<Real>(e.law, [&] { return g.e; });
    const Vector6<Real> stress = gradient<Real>(e.law, strain) + rest.preload;
    const Matrix3<Real> J_inverse = inverse_left_jacobian<Real>(theta);
    const Vector3<Real> F = A_i * stress.template head<3>();
    const Vector3<Real> M = A_i * (J_inverse.transpose() * stress.template tail<3>());

    const Variation<Real> dp_j = of_point<Real>(1, s_j), dpi_i = of_rotation<Real>(0);
    const Variation<Real> drho = dp_j - of_origin<Real>(0);
    const Variation<Real> dd = A_i.transpose() * (drho + tilde(rho) * dpi_i);
    const Variation<Real> dtheta = J_inverse * A_i.transpose() * (of_rotation<Real>(1) - dpi_i);
    const Variation<Real> dstress_F =
        K.template topRows<3>().template leftCols<3>() * dd + K.template topRightCorner<3, 3>() * dtheta;
    const Variation<Real> dstress_M =
        K.template bottomLeftCorner<3, 3>() * dd + K.template bottomRightCorner<3, 3>() * dtheta;
    const Variation<Real> dF = A_i * dstress_F - tilde(F) * dpi_i;
    const Variation<Real> dM = A_i * (J_inverse.transpose() * dstress_M +
                                      turning_moment<Real>(theta, stress.template tail<3>()) * dtheta) -
                               tilde(M) * dpi_i;
    add<Real>(e.j.body, e.i.body, e.j.body, dF, of_cross<Real>(s_j, of_direction<Real>(1, s_j), F, dF) + dM,
              target);
    add<Real>(e.i.body, e.i.body, e.j.body, -dF, -(of_cross<Real>(rho, drho, F, dF) + dM), target);
}

// λ[n  s_i × n; -n  -s_j × n] and its relatives (constraints.hpp), with λ n = F turning as the constraint
// says.
template <class Real, class Target>
void add_curvature(const CoincidentPoints& c, Real, const State<Real>& q, const Real* lambda,
                   Target& target) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Vector3<Real> F(lambda[0], lambda[1], lambda[2]);
    const Variation<Real> zero = Variation<Real>::Zero();
    add<Real>(c.i.body, c.i.body, c.j.body, zero, of_cross<Real>(s_i, of_direction<Real>(0, s_i), F, zero),
              target);
    add<Real>(c.j.body, c.i.body, c.j.body, zero, -of_cross<Real>(s_j, of_direction<Real>(1, s_j), F, zero),
              target);
}

template <class Real, class Target>
void add_curvature(const PointInPlane& c, Real, const State<Real>& q, const Real* lambda, Target& target) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local);
    const Vector3<Real> F = *lambda * q[c.j.body].lever(c.normal_j.u_local);
    const Vector3<Real> rho = q[c.i.body].r + s_i - q[c.j.body].r;  // p_i from the origin of j
    const Variation<Real> dF = of_direction<Real>(1, F);
    const Variation<Real> drho = of_point<Real>(0, s_i) - of_origin<Real>(1);
    add<Real>(c.i.body, c.i.body, c.j.body, dF, of_cross<Real>(s_i, of_direction<Real>(0, s_i), F, dF),
              target);
    add<Real>(c.j.body, c.i.body, c.j.body, -dF, -of_cross<Real>(rho, drho, F, dF), target);
}

// Two directions u_i, u_j fixed in their bodies: the couple λ u_i × u_j on i, its opposite on j.
template <class Real, class Target>
void add_couple_curvature(BodyId i, BodyId j, const Vector3<Real>& u_i, const Vector3<Real>& u_j, Real lambda,
                          Target& target) {
    const Variation<Real> zero = Variation<Real>::Zero();
    const Variation<Real> dM =
        lambda * of_cross<Real>(u_i, of_direction<Real>(0, u_i), u_j, of_direction<Real>(1, u_j));
    add<Real>(i, i, j, zero, dM, target);
    add<Real>(j, i, j, zero, -dM, target);
}
template <class Real, class Target>
void add_curvature(const PerpendicularDirections& c, Real, const State<Real>& q, const Real* lambda,
                   Target& target) {
    add_couple_curvature<Real>(c.i.body, c.j.body, q[c.i.body].lever(c.i.u_local),
                               q[c.j.body].lever(c.j.u_local), *lambda, target);
}
template <class Real, class Target>
void add_curvature(const DirectionAtAngle& c, Real angle, const State<Real>& q, const Real* lambda,
                   Target& target) {
    add_couple_curvature<Real>(c.i.body, c.j.body, q[c.i.body].lever(c.i.u_local), across(c, angle, q),
                               *lambda, target);
}

template <class Real, class Target>
void add_curvature(const DistanceBetween& c, Real length, const State<Real>& q, const Real* lambda,
                   Target& target) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Real factor = *lambda / length;
    const Vector3<Real> F = factor * (q[c.i.body].r + s_i - q[c.j.body].r - s_j);
    const Variation<Real> dF = factor * (of_point<Real>(0, s_i) - of_point<Real>(1, s_j));
    add<Real>(c.i.body, c.i.body, c.j.body, dF, of_cross<Real>(s_i, of_direction<Real>(0, s_i), F, dF),
              target);
    add<Real>(c.j.body, c.i.body, c.j.body, -dF, -of_cross<Real>(s_j, of_direction<Real>(1, s_j), F, dF),
              target);
}

// A dead force at a lever: -δ(s × f) = f̃ δs = -f̃ s̃ δπ. A dead moment has none.
template <class Real, class Target>
void add_load_stiffness(const DeadForce& force, Real factor, const State<Real>& q, Target& target) {
    const BodyId b = force.at.body;
    const Vector3<Real> f = factor * force.f.cast<Real>();
    target.template block<3, 3>(6 * b + 3, 6 * b + 3) -= tilde(f) * tilde(q[b].lever(force.at.s_local));
}
template <class Real, class Target>
void add_load_stiffness(const DeadMoment&, Real, const State<Real>&, Target&) {}

}  // namespace detail

// Adds ∂G/∂q [6nb × 6nb] to the top left of `target`.
template <class Real, class Target>
void add_consistent_tangent(const Model& model, const Branch& branch, const Inputs<Real>& inputs,
                            const State<Real>& q, const Vector<Real>& lambda, Target& target) {
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        std::visit([&](const auto& e) { detail::add_tangent<Real>(e, inputs.rest[k], q, target); },
                   model.elastics[k].kind);
    for (std::size_t k = 0; k < model.constraints.size(); ++k)
        std::visit(
            [&](const auto& c) {
                detail::add_curvature<Real>(c, inputs.offset[k], q, lambda.data() + inputs.row[k], target);
            },
            model.constraints[k].kind);
    for_each_load<Real>(model, branch, inputs, [&](const LoadKind& load, Real factor) {
        std::visit([&](const auto& kind) { detail::add_load_stiffness<Real>(kind, factor, q, target); },
                   load);
    });
}

}  // namespace elastocheck::recursive
