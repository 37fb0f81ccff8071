// Consistent tangent ∂G/∂q: geometric stiffness, constraint curvature and load stiffness.
//
// With the residual of the full equations
//
//   G(q, λ) = f_elast(q) + Φ_q(q)ᵀ λ - f_ext(q, a)
//
// ∂G/∂q has, beside the material stiffness K of (19), the rotation of the present forces:
// the elastic geometric stiffness, the curvature of the constraints Σ λ_k ∂²Φ_k, and the
// load stiffness. Increments are (Δr, Δπ) in ground axes, in which ∂G/∂q is not symmetric
// away from equilibrium.
//
// Everything below is the variation of a force F at a lever s on one body, with its opposite on
// another: the force changes, δF, and its lever turns or moves,
//
//   δp = δr - s̃ δπ,   δu = -ũ δπ,   δ(s × F) = s̃ δF - F̃ δs .
#pragma once

#include "recursive/formula/constraints.hpp"
#include "recursive/formula/elastic.hpp"
#include "recursive/formula/loads.hpp"

namespace elastocheck::recursive {

namespace detail {

// The rows or columns of a body's Δr or Δπ.
struct Half {
    BodyId body;
    int offset;
};
inline Half r_of(BodyId b) { return {b, 0}; }
inline Half pi_of(BodyId b) { return {b, 3}; }

// Adds a part [3 × 3] of ∂G/∂q; the ground has none.
template <class Real, class Target>
void add(Half of, Half by, const Matrix3<Real>& part, Target& target) {
    if (of.body != ground && by.body != ground)
        target.template block<3, 3>(6 * of.body + of.offset, 6 * by.body + by.offset) += part;
}

// ũ ṽ = v uᵀ - (u·v) I, of the matrices of two cross products
template <class Real>
Matrix3<Real> tilde_tilde(const Vector3<Real>& u, const Vector3<Real>& v) {
    Matrix3<Real> product = v * u.transpose();
    product.diagonal().array() -= u.dot(v);
    return product;
}

// A force F on body b at a lever that turns with it: -F̃ δs = F̃ s̃ δπ.
template <class Real, class Target>
void add_turning_lever(BodyId b, const Vector3<Real>& s, const Vector3<Real>& F, Target& target) {
    if (b != ground) add<Real>(pi_of(b), pi_of(b), tilde_tilde(F, s), target);
}
// A force -F on body b at a point with lever s on body a: F̃ (δr_a - s̃ δπ_a - δr_b).
template <class Real, class Target>
void add_moving_lever(BodyId b, BodyId a, const Vector3<Real>& s, const Vector3<Real>& F,
                      Target& target) {
    const Matrix3<Real> turn = tilde(F);
    add<Real>(pi_of(b), r_of(a), turn, target);
    add<Real>(pi_of(b), pi_of(a), -tilde_tilde(F, s), target);
    add<Real>(pi_of(b), r_of(b), -turn, target);
}
// The levers of an element's force, which is constant. `at_p_j`: on both bodies it acts at p_j.
template <class Real, class Target>
void add_levers(BodyId i, BodyId j, const ElementForce<Real>& force, bool at_p_j, Target& target) {
    add_turning_lever<Real>(j, force.lever_j, force.F, target);
    if (at_p_j)
        add_moving_lever<Real>(i, j, force.lever_j, force.F, target);
    else
        add_turning_lever<Real>(i, force.lever_i, -force.F, target);
}

// A force on j at p_j, its opposite on i at p_i, with δF = K (δp_j - δp_i), K symmetric.
template <class Real, class Target>
void add_between_points(BodyId i, BodyId j, const ElementForce<Real>& force, const Matrix3<Real>& K,
                        Target& target) {
    ElementStiffness<Real> e{i,     j,    force.lever_i, force.lever_j, Matrix6<Real>::Zero(),
                             false, false};
    e.K.template topLeftCorner<3, 3>() = K;
    add_stiffness(e, target);
    add_levers<Real>(i, j, force, false, target);
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
    const Vector3<Real> n = D / length;
    const Matrix3<Real> along = n * n.transpose();
    add_between_points<Real>(e.i.body, e.j.body, {t * n, Vector3<Real>::Zero(), s_i, s_j},
                             rate * along + t / length * (Matrix3<Real>::Identity() - along),
                             target);
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
        E.template topRightCorner<3, 3>() = tilde(g.d()) * middle_jacobian<Real>(frame);
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
            moment_derivative<Real>(e.formulation.angles, g.B, theta, H, M);
    if (!in_the_middle(e)) return N;
    const Middle<Real> frame = middle<Real>(g.B);
    const Matrix3<Real> P = middle_jacobian<Real>(frame), I = Matrix3<Real>::Identity(),
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
// With T = ∂(F_x, M_φ)/∂(x, φ) in ground axes and ρ = s_i + D,
//
//   δ(F, M) = T ⎡ I  -s̃_j ⎤ δq_j - ( T ⎡ I  -ρ̃ ⎤ + ⎡ 0  F̃ ⎤ ) δq_i
//               ⎣ 0    I  ⎦         (   ⎣ 0   I ⎦   ⎣ 0  M̃ ⎦ )
template <class Real, class Target>
void add_tangent(const Bushing& e, const Rest<Real>& rest, const State<Real>& q, Target& target) {
    const Spatial<Real> g = deformation<Real>(e, q);
    const Vector3<Real> rho = g.s_i + g.D;
    const Vector6<Real> deflection = strain<Real>(rest, g);
    const Matrix6<Real> K = hessian<Real>(
        e.law, [&] { return deflection; }, rest.piece);
    const Vector6<Real> stress = gradient<Real>(e.law, deflection, rest.piece) + rest.preload;
    const Matrix3<Real> H = angle_jacobian<Real>(e.formulation.angles, g.B, g.theta());
    const Matrix6<Real> E = strain_rate<Real>(e, g, H);

    // (F_x, M_φ) = Eᵀ σ: conjugate forces act through E; F_x alone where the offset's moment
    // is left out.
    Matrix6<Real> through = E;
    if (!e.formulation.conjugate) through.setIdentity();
    if (!e.formulation.offset_moment) through.template topRightCorner<3, 3>().setZero();
    const Vector6<Real> local = through.transpose() * stress;
    const ElementForce<Real> force{g.A_i * local.template head<3>(),
                                   g.A_i * local.template tail<3>(), g.s_i, g.s_j};
    Matrix6<Real> T = through.transpose() * K * E + turning_stress<Real>(e, g, H, E, stress);
    for (int a = 0; a < 6; a += 3)
        for (int b = 0; b < 6; b += 3) {
            const Matrix3<Real> turned = g.A_i * T.template block<3, 3>(a, b);
            T.template block<3, 3>(a, b).noalias() = turned.lazyProduct(g.A_i.transpose());
        }

    const auto by_motion = [&](const Vector3<Real>& lever) {
        Matrix6<Real> change = T;
        for (int k = 0; k < 6; ++k)
            change.row(k).template tail<3>() +=
                lever.cross(T.row(k).template head<3>().transpose()).transpose();
        return change;
    };
    const Matrix6<Real> by_j = by_motion(g.s_j);
    Matrix6<Real> by_i = -by_motion(rho);
    by_i.template topRightCorner<3, 3>() -= tilde(force.F);
    by_i.template bottomRightCorner<3, 3>() -= tilde(force.M);
    const auto add_on = [&](BodyId on, const Vector3<Real>& lever, Real sign) {
        const auto column = [&](BodyId by, Matrix6<Real> change) {
            if (on == ground || by == ground) return;
            for (int k = 0; k < 6; ++k)
                change.col(k).template tail<3>() += lever.cross(change.col(k).template head<3>());
            target.template block<6, 6>(6 * on, 6 * by) += sign * change;
        };
        column(e.i.body, by_i);
        column(e.j.body, by_j);
    };
    add_on(e.j.body, g.s_j, 1);
    add_on(e.i.body, e.formulation.offset_moment ? rho : g.s_i, -1);
    add_levers<Real>(e.i.body, e.j.body, force, e.formulation.offset_moment, target);
}

// Curvature of λ [n  s_i × n; -n  -s_j × n] and its variants (constraints.hpp): the force λ n = F
// rotates as the constraint prescribes.
template <class Real, class Target>
void add_curvature(const CoincidentPoints& c, Real, const State<Real>& q, const Real* lambda,
                   Target& target) {
    const Vector3<Real> F(lambda[0], lambda[1], lambda[2]);
    add_turning_lever<Real>(c.i.body, q[c.i.body].lever(c.i.s_local), F, target);
    add_turning_lever<Real>(c.j.body, q[c.j.body].lever(c.j.s_local), -F, target);
}

// F turns with j, δF = -F̃ δπ_j, and acts on both bodies at p_i.
template <class Real, class Target>
void add_curvature(const PointInPlane& c, Real, const State<Real>& q, const Real* lambda,
                   Target& target) {
    const BodyId i = c.i.body, j = c.j.body;
    const Vector3<Real> s_i = q[i].lever(c.i.s_local);
    const Vector3<Real> F = *lambda * q[j].lever(c.normal_j.u_local);
    const Vector3<Real> rho = q[i].r + s_i - q[j].r;  // p_i from the origin of j
    const Matrix3<Real> turn = tilde(F);
    add<Real>(r_of(i), pi_of(j), -turn, target);
    add<Real>(pi_of(i), pi_of(j), -tilde_tilde(s_i, F), target);
    add<Real>(r_of(j), pi_of(j), turn, target);
    add<Real>(pi_of(j), pi_of(j), tilde_tilde(rho, F), target);
    add_turning_lever<Real>(i, s_i, F, target);
    add_moving_lever<Real>(j, i, s_i, F, target);
}

// Two directions u_i, u_j fixed in their bodies: the couple M = λ u_i × u_j on i, its opposite on
// j, with δM = λ (ũ_j ũ_i δπ_i - ũ_i ũ_j δπ_j).
template <class Real, class Target>
void add_couple_curvature(BodyId i, BodyId j, const Vector3<Real>& u_i, const Vector3<Real>& u_j,
                          Real lambda, Target& target) {
    const Matrix3<Real> by_i = lambda * tilde_tilde(u_j, u_i), by_j = -by_i.transpose();
    add<Real>(pi_of(i), pi_of(i), by_i, target);
    add<Real>(pi_of(i), pi_of(j), by_j, target);
    add<Real>(pi_of(j), pi_of(i), -by_i, target);
    add<Real>(pi_of(j), pi_of(j), -by_j, target);
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
                               normal_at_angle(c, angle, q), *lambda, target);
}

// F = λ/c (p_i - p_j) on i.
template <class Real, class Target>
void add_curvature(const DistanceBetween& c, Real length, const State<Real>& q, const Real* lambda,
                   Target& target) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Real factor = *lambda / length;
    const Vector3<Real> F = factor * (q[c.i.body].r + s_i - q[c.j.body].r - s_j);
    add_between_points<Real>(c.j.body, c.i.body, {F, Vector3<Real>::Zero(), s_j, s_i},
                             factor * Matrix3<Real>::Identity(), target);
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
// Follower loads rotate: -δf = f̃ δπ for the force, and the same for its moment s × f and
// for any moment.
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
// The lever reaches from the carrier's origin r to the patch p on another body:
// -δ((p - r) × f) = f̃ (δp - δr) = f̃ (δr_p - s̃ δπ_p - δr).
template <class Real, class Target>
void add_load_stiffness(const BrakeForce& brake, Real factor, const State<Real>& q,
                        Target& target) {
    const Matrix3<Real> f = tilde<Real>(factor * brake.f.cast<Real>());
    const BodyId b = brake.body, p = brake.patch.body;
    target.template block<3, 3>(6 * b + 3, 6 * b) -= f;
    target.template block<3, 3>(6 * b + 3, 6 * p) += f;
    target.template block<3, 3>(6 * b + 3, 6 * p + 3) -= f * tilde(q[p].lever(brake.patch.s_local));
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
