// Consistent tangent ∂G/∂q: geometric stiffness, constraint curvature and load stiffness.
//
// With the residual of the full equations
//
//   G(q, λ) = f_elast(q) + Φ_q(q)ᵀ λ - f_ext(q, a)
//
// ∂G/∂q has, beside the material stiffness K of (19), the rotation of the present forces: the
// elastic geometric stiffness, the curvature of the constraints Σ λ_k ∂²Φ_k, and the load
// stiffness. Increments are (Δr, Δπ) in ground axes, in which ∂G/∂q is not symmetric away from
// equilibrium.
//
// Everything below is a variation of a force F at a lever, written as 3×12 matrices over (Δr_i,
// Δπ_i, Δr_j, Δπ_j):
//
//   δp = δr - s̃ δπ,   δu = -ũ δπ,   δ(x × F) = -F̃ δx + x̃ δF .
#pragma once

#include "recursive/formula/constraints.hpp"
#include "recursive/formula/elastic.hpp"
#include "recursive/formula/loads.hpp"

namespace elastocheck::recursive {

namespace detail {

template <class Real>
using Variation = Eigen::Matrix<Real, 3, 12>;

// δp of a point with lever s on the first (slot 0) or second (slot 1) body; below, δu of a fixed
// direction.
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

// Adds the variation of the generalised force (F, M about the origin) on one body of the pair (i,
// j).
template <class Real, class Target>
void add(BodyId on, BodyId i, BodyId j, const Variation<Real>& dF, const Variation<Real>& dM,
         Target& target) {
    if (on == ground) return;
    const BodyId column[] = {i, j};
    for (int slot = 0; slot < 2; ++slot) {
        if (column[slot] == ground) continue;
        target.template block<3, 6>(6 * on, 6 * column[slot]) +=
            dF.template middleCols<6>(6 * slot);
        target.template block<3, 6>(6 * on + 3, 6 * column[slot]) +=
            dM.template middleCols<6>(6 * slot);
    }
}

// Spring: F = t n on j, -F on i, t = u'(ℓ - ℓ₀); δF = (u'' n nᵀ + t/ℓ (I - n nᵀ)) (δp_j - δp_i).
template <class Real, class Target>
void add_tangent(const AxialSpring& e, const Rest<Real>& rest, const State<Real>& q,
                 Target& target) {
    const auto [s_i, s_j, D, length] = deformation<Real>(e, q);
    const Real stretch = length - rest.free_length,
               t = gradient<Real>(e.law, stretch, rest.piece[0]),
               rate = hessian<Real>(
                   e.law, [x = stretch] { return x; }, rest.piece[0]);
    const Vector3<Real> n = D / length, F = t * n;
    const Matrix3<Real> along = n * n.transpose();
    const Variation<Real> dF = (rate * along + t / length * (Matrix3<Real>::Identity() - along)) *
                               (of_point<Real>(1, s_j) - of_point<Real>(0, s_i));
    add<Real>(e.j.body, e.i.body, e.j.body, dF,
              of_cross<Real>(s_j, of_direction<Real>(1, s_j), F, dF), target);
    add<Real>(e.i.body, e.i.body, e.j.body, -dF,
              -of_cross<Real>(s_i, of_direction<Real>(0, s_i), F, dF), target);
}

// ∂e/∂(x, φ) [6 × 6], E of elastic.hpp.
template <class Real>
Matrix6<Real> strain_rate(const Bushing& e, const Spatial<Real>& g, const Matrix3<Real>& H) {
    Matrix6<Real> E = Matrix6<Real>::Zero();
    E.template topLeftCorner<3, 3>().setIdentity();
    E.template bottomRightCorner<3, 3>() = H;
    if (in_the_middle(e)) {
        const Middle<Real> frame = middle<Real>(g.B);
        E.template topLeftCorner<3, 3>() = frame.S.transpose();
        E.template topRightCorner<3, 3>() = tilde(g.d()) * jacobian<Real>(frame);
    }
    return E;
}

// Rotation of the forces F_x, M_φ of a constant stress σ: ∂(F_x, M_φ)/∂(x, φ) [6 × 6]. With the
// frame on i only the moment rotates, ∂(Hᵀ M')/∂φ. In the middle, with δS = S δη̃, δη = P δφ and
// Pᵀ = ½ S (I + t̃),
//
//   δ(S F') = -S F̃' δη
//   δ(Pᵀ k) = ½ S ( -κ̃ δη - k̃ δt + (I + t̃) δk ),   κ = k + t × k,   k = d × F',   δk = -F̃' δd
template <class Real>
Matrix6<Real> turning_stress(const Bushing& e, const Spatial<Real>& g, const Matrix3<Real>& H,
                             const Matrix6<Real>& E, const Vector6<Real>& stress) {
    const Vector3<Real> F = stress.template head<3>(), M = stress.template tail<3>(),
                        theta = g.theta();
    Matrix6<Real> N = Matrix6<Real>::Zero();
    if (e.formulation.conjugate)
        N.template bottomRightCorner<3, 3>() =
            turning_moment<Real>(e.formulation.angles, g.B, theta, H, M);
    if (!in_the_middle(e)) return N;
    const Middle<Real> frame = middle<Real>(g.B);
    const Matrix3<Real> P = jacobian<Real>(frame), I = Matrix3<Real>::Identity(),
                        t = tilde(frame.t);
    N.template topRightCorner<3, 3>() -= frame.S * tilde(F) * P;
    if (!e.formulation.offset_moment) return N;
    const Vector3<Real> k = g.d().cross(F), turned = k + frame.t.cross(k);
    const Matrix3<Real> dt = (I + t + frame.t * frame.t.transpose()) * P / 2;  // ∂t/∂φ
    N.template bottomRightCorner<3, 3>() += frame.S * (tilde(turned) * P + tilde(k) * dt) / 2;
    N.template bottomRows<3>() += frame.S * (I + t) * tilde(F) * E.template topRows<3>() / 2;
    return N;
}

// Bushing: F = A_i F_x, M = A_i M_φ, the two functions of x and B;
//   on j: (F, s_j × F + M)    on i: -(F, ρ × F + M),   ρ = p_j - r_i, or s_i without offset moment
//   δx = A_iᵀ (δp_j - δr_i - δπ_i × (s_i + D)),   δφ = A_iᵀ (δπ_j - δπ_i)
template <class Real, class Target>
void add_tangent(const Bushing& e, const Rest<Real>& rest, const State<Real>& q, Target& target) {
    const Spatial<Real> g = deformation<Real>(e, q);
    const auto& [s_i, s_j, D, A_i, B, measured] = g;
    const Vector3<Real> rho = s_i + D, theta = g.theta();
    const Vector6<Real> answered = strain<Real>(e, g);
    const Matrix6<Real> K = hessian<Real>(
        e.law, [&] { return answered; }, rest.piece);
    const Vector6<Real> stress = gradient<Real>(e.law, answered, rest.piece) + rest.preload;
    const Matrix3<Real> H = jacobian<Real>(e.formulation.angles, B, theta);
    const Matrix6<Real> E = strain_rate<Real>(e, g, H);
    const ElementForce<Real> force = force_of_stress<Real>(e, g, stress);

    // ∂(F_x, M_φ)/∂(x, φ): conjugate forces act through E; F_x alone where the offset's moment is
    // left out.
    Matrix6<Real> through = E;
    if (!e.formulation.conjugate) through.setIdentity();
    if (!e.formulation.offset_moment) through.template topRightCorner<3, 3>().setZero();
    const Matrix6<Real> T = through.transpose() * K * E + turning_stress<Real>(e, g, H, E, stress);

    const Variation<Real> dp_j = of_point<Real>(1, s_j), dpi_i = of_rotation<Real>(0);
    const Variation<Real> drho = dp_j - of_origin<Real>(0);
    Eigen::Matrix<Real, 6, 12> motion;  // (δx, δφ)
    motion << A_i.transpose() * (drho + tilde(rho) * dpi_i),
        A_i.transpose() * (of_rotation<Real>(1) - dpi_i);
    const Eigen::Matrix<Real, 6, 12> change = T * motion;
    const Variation<Real> dF = A_i * change.template topRows<3>() - tilde(force.F) * dpi_i;
    const Variation<Real> dM = A_i * change.template bottomRows<3>() - tilde(force.M) * dpi_i;
    add<Real>(e.j.body, e.i.body, e.j.body, dF,
              of_cross<Real>(s_j, of_direction<Real>(1, s_j), force.F, dF) + dM, target);
    const Variation<Real> dlever_i =
        e.formulation.offset_moment ? drho : of_direction<Real>(0, s_i);
    add<Real>(e.i.body, e.i.body, e.j.body, -dF,
              -(of_cross<Real>(force.lever_i, dlever_i, force.F, dF) + dM), target);
}

// Curvature of λ [n  s_i × n; -n  -s_j × n] and its variants (constraints.hpp): the force λ n = F
// rotates as the constraint prescribes.
template <class Real, class Target>
void add_curvature(const CoincidentPoints& c, Real, const State<Real>& q, const Real* lambda,
                   Target& target) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Vector3<Real> F(lambda[0], lambda[1], lambda[2]);
    const Variation<Real> zero = Variation<Real>::Zero();
    add<Real>(c.i.body, c.i.body, c.j.body, zero,
              of_cross<Real>(s_i, of_direction<Real>(0, s_i), F, zero), target);
    add<Real>(c.j.body, c.i.body, c.j.body, zero,
              -of_cross<Real>(s_j, of_direction<Real>(1, s_j), F, zero), target);
}

template <class Real, class Target>
void add_curvature(const PointInPlane& c, Real, const State<Real>& q, const Real* lambda,
                   Target& target) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local);
    const Vector3<Real> F = *lambda * q[c.j.body].lever(c.normal_j.u_local);
    const Vector3<Real> rho = q[c.i.body].r + s_i - q[c.j.body].r;  // p_i from the origin of j
    const Variation<Real> dF = of_direction<Real>(1, F);
    const Variation<Real> drho = of_point<Real>(0, s_i) - of_origin<Real>(1);
    add<Real>(c.i.body, c.i.body, c.j.body, dF,
              of_cross<Real>(s_i, of_direction<Real>(0, s_i), F, dF), target);
    add<Real>(c.j.body, c.i.body, c.j.body, -dF, -of_cross<Real>(rho, drho, F, dF), target);
}

// Two directions u_i, u_j fixed in their bodies: the couple λ u_i × u_j on i, its opposite on j.
template <class Real, class Target>
void add_couple_curvature(BodyId i, BodyId j, const Vector3<Real>& u_i, const Vector3<Real>& u_j,
                          Real lambda, Target& target) {
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
    add_couple_curvature<Real>(c.i.body, c.j.body, q[c.i.body].lever(c.i.u_local),
                               across(c, angle, q), *lambda, target);
}

template <class Real, class Target>
void add_curvature(const DistanceBetween& c, Real length, const State<Real>& q, const Real* lambda,
                   Target& target) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Real factor = *lambda / length;
    const Vector3<Real> F = factor * (q[c.i.body].r + s_i - q[c.j.body].r - s_j);
    const Variation<Real> dF = factor * (of_point<Real>(0, s_i) - of_point<Real>(1, s_j));
    add<Real>(c.i.body, c.i.body, c.j.body, dF,
              of_cross<Real>(s_i, of_direction<Real>(0, s_i), F, dF), target);
    add<Real>(c.j.body, c.i.body, c.j.body, -dF,
              -of_cross<Real>(s_j, of_direction<Real>(1, s_j), F, dF), target);
}

// A dead force at a lever: -δ(s × f) = f̃ δs = -f̃ s̃ δπ. A dead moment has no load stiffness.
template <class Real, class Target>
void add_load_stiffness(const DeadForce& force, Real factor, const State<Real>& q, Target& target) {
    const BodyId b = force.at.body;
    const Vector3<Real> f = factor * force.f.cast<Real>();
    target.template block<3, 3>(6 * b + 3, 6 * b + 3) -=
        tilde(f) * tilde(q[b].lever(force.at.s_local));
}
template <class Real, class Target>
void add_load_stiffness(const DeadMoment&, Real, const State<Real>&, Target&) {}
// Follower loads rotate: -δf = f̃ δπ for the force, and the same for its moment s × f and for any
// moment.
template <class Real, class Target>
void add_load_stiffness(const FollowerForce& force, Real factor, const State<Real>& q,
                        Target& target) {
    const BodyId b = force.at.body;
    const Vector3<Real> f = factor * q[b].lever(force.f_local);
    target.template block<3, 3>(6 * b, 6 * b + 3) += tilde(f);
    target.template block<3, 3>(6 * b + 3, 6 * b + 3) +=
        tilde<Real>(q[b].lever(force.at.s_local).cross(f));
}
template <class Real, class Target>
void add_load_stiffness(const FollowerMoment& moment, Real factor, const State<Real>& q,
                        Target& target) {
    const BodyId b = moment.body;
    target.template block<3, 3>(6 * b + 3, 6 * b + 3) +=
        tilde<Real>(factor * q[b].lever(moment.m_local));
}

}  // namespace detail

// Parts of ∂G/∂q [6nb × 6nb], added to the top left of `target`: elements, joint reactions, loads.
template <class Real, class Target>
void add_elastic_tangent(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
                         Target& target) {
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        std::visit([&](const auto& e) { detail::add_tangent<Real>(e, inputs.rest[k], q, target); },
                   model.elastics[k].kind);
}
template <class Real, class Target>
void add_curvature(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
                   const Vector<Real>& lambda, Target& target) {
    for (std::size_t k = 0; k < model.constraints.size(); ++k)
        std::visit(
            [&](const auto& c) {
                detail::add_curvature<Real>(c, inputs.offset[k], q, lambda.data() + inputs.row[k],
                                            target);
            },
            model.constraints[k].kind);
}
template <class Real, class Target>
void add_load_stiffness(const Model& model, const Branch& branch, const Inputs<Real>& inputs,
                        const State<Real>& q, Target& target) {
    for_each_load<Real>(model, branch, inputs, [&](const LoadKind& load, Real factor) {
        std::visit(
            [&](const auto& kind) { detail::add_load_stiffness<Real>(kind, factor, q, target); },
            load);
    });
}

// All of ∂G/∂q.
template <class Real, class Target>
void add_consistent_tangent(const Model& model, const Branch& branch, const Inputs<Real>& inputs,
                            const State<Real>& q, const Vector<Real>& lambda, Target& target) {
    add_elastic_tangent<Real>(model, inputs, q, target);
    add_curvature<Real>(model, inputs, q, lambda, target);
    add_load_stiffness<Real>(model, branch, inputs, q, target);
}

}  // namespace elastocheck::recursive
