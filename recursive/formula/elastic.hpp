// Elastic elements: the stiffness matrix of eqs. (8)-(20), and the force of the full nonlinear law.
//
// The paper's displacement of the attachment points, eqs. (12)-(13), and its relative motion seen
// from body i,
//
//   Δe = ⎧ Δr_j' - Δr_i' ⎫ = B ⎧ Δq_i ⎫ ,   B = ⎡ -I   s̃_i   I   -s̃_j ⎤      Δr' = Δr - s̃ Δπ
//        ⎩ Δπ_j  - Δπ_i  ⎭     ⎩ Δq_j ⎭         ⎣  0   -I    0    I   ⎦
//
// make every element matrix K = Bᵀ diag(K_T, K_R) B, which is eq. (19) with two corrections: its
// sign, so that f_ext = K Δq + Φ_qᵀ λ with K ⪰ 0, and s̃_i instead of s̃_j at the front of the
// second block row, third and fourth block. Written out,
//
//   ⎡ K_ii  K_ij ⎤   ⎡  K_T         -K_T s̃_i              -K_T          K_T s̃_j            ⎤
//   ⎣ K_ji  K_jj ⎦ = ⎢  s̃_i K_T     -s̃_i K_T s̃_i + K_R    -s̃_i K_T      s̃_i K_T s̃_j - K_R  ⎥      (19)
//                    ⎢ -K_T          K_T s̃_i               K_T         -K_T s̃_j            ⎥
//                    ⎣ -s̃_j K_T      s̃_j K_T s̃_i - K_R     s̃_j K_T     -s̃_j K_T s̃_j + K_R  ⎦
//
// The levers s_i, s_j are the paper's, each to its own attachment point. Where the two points have
// drifted apart by D, K lacks the moment D × F of the law. This is part of the published method's
// formulation gap and is kept on purpose.
//
// Elements that the paper does not cover enter K in this same form, as an extension: a curve with
// its slope at the current deformation, a frame in the middle with its axes A_f in place of A_i.
// Other definitions of the angles, forces that are not conjugate, and an omitted moment of the
// offset do not change increments between unloaded markers: they enter the forces, and not K.
#pragma once

#include "recursive/formula/inputs.hpp"
#include "recursive/formula/law.hpp"
#include "recursive/formula/measure.hpp"

namespace elastocheck::recursive {

// diag(K_T, K_R) in ground axes (with coupling blocks for a full 6×6) and the two levers.
template <class Real>
struct ElementStiffness {
    BodyId i = ground, j = ground;
    Vector3<Real> s_i, s_j;
    Matrix6<Real> K;         // of (translation, rotation) of j relative to i [N/m  N; N  N·m]
    bool rotational = true;  // whether any entry outside K_T is non-zero
    bool coupled = true;     // whether any entry outside K_T and K_R is non-zero
};

// ---- Geometry: the deformations.

// Two points: D = p_j - p_i, ℓ = |D|; the law is a function of ℓ - ℓ₀.
template <class Real>
struct Axial {
    Vector3<Real> s_i, s_j, D;
    Real length;
};
template <class Real>
Axial<Real> deformation(const AxialSpring& e, const State<Real>& q) {
    Axial<Real> g{q[e.i.body].lever(e.i.s_local), q[e.j.body].lever(e.j.s_local), {}, 0};
    g.D = q[e.j.body].r + g.s_j - q[e.i.body].r - g.s_i;
    g.length = g.D.norm();
    return g;
}

// Two markers: e = (d, θ), D = p_j - p_i, B = A_iᵀ A_j.
template <class Real>
struct Spatial {
    Vector3<Real> s_i, s_j, D;
    Matrix3<Real> A_i, B;
    Vector6<Real> e;

    Vector3<Real> d() const { return e.template head<3>(); }
    Vector3<Real> theta() const { return e.template tail<3>(); }
};
inline bool in_the_middle(const Bushing& e) {
    return e.formulation.frame == Formulation::Frame::middle;
}

template <class Real>
Spatial<Real> deformation(const Bushing& e, const State<Real>& q) {
    Spatial<Real> g{q[e.i.body].lever(e.i.s_local),
                    q[e.j.body].lever(e.j.s_local),
                    {},
                    q[e.i.body].A * e.i.A_local.cast<Real>().toRotationMatrix(),
                    {},
                    {}};
    g.D = q[e.j.body].r + g.s_j - q[e.i.body].r - g.s_i;
    const Matrix3<Real> A_j = q[e.j.body].A * e.j.A_local.cast<Real>().toRotationMatrix();
    g.B = g.A_i.transpose() * A_j;
    g.e << g.A_i.transpose() * g.D, angles_of<Real>(e.formulation.angles, g.B);
    if (in_the_middle(e)) g.e.template head<3>() = middle<Real>(g.B).S.transpose() * g.d();
    return g;
}
// A_f, the axes in which d is measured.
template <class Real>
Matrix3<Real> axes(const Bushing& e, const State<Real>& q) {
    if (!in_the_middle(e)) return q[e.i.body].A * e.i.A_local.cast<Real>().toRotationMatrix();
    const Spatial<Real> g = deformation<Real>(e, q);
    return g.A_i * middle<Real>(g.B).S;
}
// e - e₀, the argument of the law.
template <class Real>
Vector6<Real> strain(const Rest<Real>& rest, const Spatial<Real>& g) {
    return g.e - rest.undeformed;
}

// ---- K of eq. (19): the Hessian of the law, turned to ground axes, at the two levers.

template <class Real>
ElementStiffness<Real> element_stiffness(const AxialSpring& e, const Rest<Real>& rest,
                                         const State<Real>& q) {
    ElementStiffness<Real> k{e.i.body,
                             e.j.body,
                             q[e.i.body].lever(e.i.s_local),
                             q[e.j.body].lever(e.j.s_local),
                             Matrix6<Real>::Zero(),
                             false,
                             false};
    const Vector3<Real> D = q[e.j.body].r + k.s_j - q[e.i.body].r - k.s_i, n = D.normalized();
    const Real rate = hessian<Real>(
        e.law, [&] { return D.norm() - rest.free_length; }, rest.piece[0]);
    // (8), (10): one axis, along the spring
    k.K.template topLeftCorner<3, 3>() = rate * n * n.transpose();
    return k;
}

template <class Real>
ElementStiffness<Real> element_stiffness(const Bushing& e, const Rest<Real>& rest,
                                         const State<Real>& q) {
    ElementStiffness<Real> k{
        e.i.body, e.j.body,         q[e.i.body].lever(e.i.s_local), q[e.j.body].lever(e.j.s_local),
        {},       rotational(e.law)};
    const Matrix3<Real> A = axes<Real>(e, q);
    const Matrix6<Real> K_local = hessian<Real>(
        e.law, [&] { return strain<Real>(rest, deformation<Real>(e, q)); }, rest.piece);
    const auto turn = [&](int a, int b) {  // K_T = A_f K_T' A_fᵀ, K_R = A_f K_R' A_fᵀ (10)-(11)
        const Matrix3<Real> AK = A * K_local.template block<3, 3>(3 * a, 3 * b);
        k.K.template block<3, 3>(3 * a, 3 * b).noalias() = AK.lazyProduct(A.transpose());
    };
    turn(0, 0);
    turn(1, 1);
    k.coupled = !K_local.template topRightCorner<3, 3>().isZero(0);
    if (k.coupled)
        turn(0, 1);
    else
        k.K.template topRightCorner<3, 3>().setZero();
    k.K.template bottomLeftCorner<3, 3>() = k.K.template topRightCorner<3, 3>().transpose();
    return k;
}

// Adds Bᵀ K B to the stiffness matrix, eqs. (18)-(20); `target` is [6nb × 6nb] or has it as its top
// left corner.
template <class Real, class Target>
void add_stiffness(const ElementStiffness<Real>& e, Target& target) {
    // With T(s) = [I -s̃; 0 I] both halves of B are ∓T: K_ab = ± T(s_a)ᵀ K T(s_b). With
    // F_s = C - K_T s̃, the force caused by a rotation at the lever s, each block is
    // ± [K_T  F_b; F_aᵀ  s̃_a F_b + K_R - Cᵀ s̃_b].
    const Matrix3<Real> K_T = e.K.template topLeftCorner<3, 3>(),
                        C = e.K.template topRightCorner<3, 3>();
    const auto force = [&](const Vector3<Real>& s) {
        // K_T s̃, symmetric times skew: its rows are those of K_T crossed with s
        Matrix3<Real> F;
        for (int k = 0; k < 3; ++k) F.row(k) = s.cross(K_T.col(k)).transpose();
        if (e.coupled) F += C;
        return F;
    };
    const Matrix3<Real> F_i = force(e.s_i), F_j = force(e.s_j);
    const auto block = [&](const Vector3<Real>& s_a, const Matrix3<Real>& F_a,
                           const Vector3<Real>& s_b, const Matrix3<Real>& F_b) {
        Matrix6<Real> K;
        Matrix3<Real> moment;
        for (int k = 0; k < 3; ++k) moment.col(k) = s_a.cross(F_b.col(k));
        if (e.rotational) moment += e.K.template bottomRightCorner<3, 3>();
        if (e.coupled) moment -= C.transpose() * tilde(s_b);
        K << K_T, F_b, F_a.transpose(), moment;
        return K;
    };
    const auto add = [&](BodyId a, BodyId b, const Matrix6<Real>& K) {
        target.template block<6, 6>(6 * a, 6 * b) += K;
    };
    if (e.i != ground) add(e.i, e.i, block(e.s_i, F_i, e.s_i, F_i));
    if (e.j != ground) add(e.j, e.j, block(e.s_j, F_j, e.s_j, F_j));
    if (e.i == ground || e.j == ground) return;
    const Matrix6<Real> K_ij = block(e.s_i, F_i, e.s_j, F_j);
    add(e.i, e.j, -K_ij);
    add(e.j, e.i, -K_ij.transpose());
}

template <class Real>
ElementStiffness<Real> element_stiffness(const ElasticKind& kind, const Rest<Real>& rest,
                                         const State<Real>& q) {
    return std::visit([&](const auto& e) { return element_stiffness<Real>(e, rest, q); }, kind);
}

// K(q) [6nb × 6nb], symmetric, positive semidefinite if the laws are: f_elast = K Δq, eq. (20).
template <class Real, class Target>
void add_stiffness(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
                   Target& target) {
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        add_stiffness(element_stiffness<Real>(model.elastics[k].kind, inputs.rest[k], q), target);
}
template <class Real>
Matrix<Real> stiffness(const Model& model, const Inputs<Real>& inputs, const State<Real>& q) {
    Matrix<Real> K = Matrix<Real>::Zero(coordinates(model), coordinates(model));
    add_stiffness<Real>(model, inputs, q, K);
    return K;
}

// ---- The law: f_elast(q), ∂U/∂q where U exists; K Δq linearises it at an unloaded position.
//
// Spring:  f = u'(ℓ - ℓ₀) n along its axis n.
// Bushing: with the stress σ = (F', M') = ∂u/∂e + preload at e - e₀, and e a function of x and B
// (measure.hpp), the force F = A_i F_x and the moment M = A_i M_φ that do work on (δx, δφ) are
//
//   E = ∂e/∂(x, φ),   (F_x, M_φ) = Eᵀ σ         conjugate: the forces of U. With the frame on i
//                                                E = ⎡ I  0 ⎤,  so that F = A_i F', M = A_i Hᵀ M'
//                                                    ⎣ 0  H ⎦
//   (F_x, M_φ) = σ                               not conjugate
//
//   on j: ( F, s_j × F + M )   on i: ( -F, -(s_i + D) × F - M ),  D = p_j - p_i
//
// With the frame in the middle, d = Sᵀ x and δd = Sᵀ δx + d̃ P δφ add F' to the moment:
//
//   E = ⎡ Sᵀ  d̃ P ⎤      F_x = S F'      M_φ = Hᵀ M' - Pᵀ (d × F')
//       ⎣ 0    H  ⎦
//
// The added moment is the part of D × F that acts on j. Where the moment of the offset is left out,
// this part is left out too, and the force on i acts at p_i:  M_φ = Hᵀ M',
// on i: ( -F, -s_i × F - M ).

// The force (F, M) [N, N·m] of an element on its body j at p_j, ground axes, and the levers of its
// line of action: for a bushing from both origins to p_j (from i to p_i if the moment of the offset
// is left out), for a spring to its two ends.
template <class Real>
struct ElementForce {
    Vector3<Real> F, M;
    Vector3<Real> lever_i, lever_j;
};

template <class Real>
ElementForce<Real> element_force(const AxialSpring& e, const Rest<Real>& rest,
                                 const State<Real>& q) {
    const Axial<Real> g = deformation<Real>(e, q);
    return {gradient<Real>(e.law, g.length - rest.free_length, rest.piece[0]) / g.length * g.D,
            Vector3<Real>::Zero(), g.s_i, g.s_j};
}

// (F, M) of the stress σ.
template <class Real>
ElementForce<Real> force_of_stress(const Bushing& e, const Spatial<Real>& g,
                                   const Vector6<Real>& stress) {
    const Vector3<Real> theta = g.theta();
    Vector3<Real> F = stress.template head<3>(), M = stress.template tail<3>();
    if (e.formulation.conjugate)
        M = angle_jacobian<Real>(e.formulation.angles, g.B, theta).transpose() * M;
    if (in_the_middle(e)) {
        const Middle<Real> frame = middle<Real>(g.B);
        if (e.formulation.offset_moment)
            M -= middle_jacobian<Real>(frame).transpose() * g.d().cross(F);
        F = frame.S * F;
    }
    Vector3<Real> lever_i = g.s_i;
    if (e.formulation.offset_moment) lever_i += g.D;
    return {g.A_i * F, g.A_i * M, lever_i, g.s_j};
}
template <class Real>
ElementForce<Real> element_force(const Bushing& e, const Rest<Real>& rest, const State<Real>& q) {
    const Spatial<Real> g = deformation<Real>(e, q);
    return force_of_stress<Real>(
        e, g, gradient<Real>(e.law, strain<Real>(rest, g), rest.piece) + rest.preload);
}
template <class Real>
ElementForce<Real> element_force(const ElasticKind& kind, const Rest<Real>& rest,
                                 const State<Real>& q) {
    return std::visit([&](const auto& e) { return element_force<Real>(e, rest, q); }, kind);
}

// ∂(F, M)/∂ℓ₀, and the change of (F, M) by a change of the preload.
template <class Real>
ElementForce<Real> force_of_free_length(const AxialSpring& e, const Rest<Real>& rest,
                                        const State<Real>& q) {
    const Axial<Real> g = deformation<Real>(e, q);
    const Real rate = hessian<Real>(
        e.law, [&] { return g.length - rest.free_length; }, rest.piece[0]);
    return {-rate / g.length * g.D, Vector3<Real>::Zero(), g.s_i, g.s_j};
}
template <class Real>
ElementForce<Real> force_of_free_length(const Bushing& e, const Rest<Real>& rest,
                                        const State<Real>& q) {
    const Spatial<Real> g = deformation<Real>(e, q);
    const Matrix6<Real> H = hessian<Real>(
        e.law, [&] { return strain<Real>(rest, g); }, rest.piece);
    return force_of_stress<Real>(e, g, -H.col(2));
}
template <class Real>
ElementForce<Real> force_of_preload(const Bushing& e, const Vector6<Real>& change,
                                    const State<Real>& q) {
    return force_of_stress<Real>(e, deformation<Real>(e, q), change);
}

// The argument of the law: (ℓ - ℓ₀, 0, ...) of a spring, e - e₀ of a bushing.
template <class Real>
Vector6<Real> deflections(const AxialSpring& e, const Rest<Real>& rest, const State<Real>& q) {
    Vector6<Real> x = Vector6<Real>::Zero();
    x[0] = deformation<Real>(e, q).length - rest.free_length;
    return x;
}
template <class Real>
Vector6<Real> deflections(const Bushing& e, const Rest<Real>& rest, const State<Real>& q) {
    return strain<Real>(rest, deformation<Real>(e, q));
}
template <class Real>
Vector6<Real> deflections(const ElasticKind& kind, const Rest<Real>& rest, const State<Real>& q) {
    return std::visit([&](const auto& e) { return deflections<Real>(e, rest, q); }, kind);
}

// Own axes of an element: those of its law. A spring has one, along it.
template <class Real>
Matrix3<Real> own_axes(const AxialSpring& e, const State<Real>& q) {
    const Axial<Real> g = deformation<Real>(e, q);
    Matrix3<Real> A = Matrix3<Real>::Zero();
    A.col(0) = g.D / g.length;
    return A;
}
template <class Real>
Matrix3<Real> own_axes(const Bushing& e, const State<Real>& q) {
    return axes<Real>(e, q);
}

// The two bodies of an element.
inline std::pair<BodyId, BodyId> bodies_of(const ElasticKind& kind) {
    return std::visit([](const auto& e) { return std::pair{e.i.body, e.j.body}; }, kind);
}

// Adds (F, s × F + M) on body j and its opposite on body i to f [6nb].
template <class Real>
void add_element_force(BodyId i, BodyId j, const ElementForce<Real>& e, Vector<Real>& f) {
    if (j != ground) {
        f.template segment<3>(6 * j) += e.F;
        f.template segment<3>(6 * j + 3) += e.lever_j.cross(e.F) + e.M;
    }
    if (i != ground) {
        f.template segment<3>(6 * i) -= e.F;
        f.template segment<3>(6 * i + 3) -= e.lever_i.cross(e.F) + e.M;
    }
}

// f_elast(q) [6nb], moments about the bodies' origins, ground axes.
template <class Real>
void elastic_force(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
                   Vector<Real>& f) {
    f.setZero(coordinates(model));
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const ElasticKind& kind = model.elastics[k].kind;
        const auto [i, j] = bodies_of(kind);
        add_element_force<Real>(i, j, element_force<Real>(kind, inputs.rest[k], q), f);
    }
}
template <class Real>
Vector<Real> elastic_force(const Model& model, const Inputs<Real>& inputs, const State<Real>& q) {
    Vector<Real> f;
    elastic_force<Real>(model, inputs, q, f);
    return f;
}

// Instantiated in linear_algebra/in_double.cpp.
extern template Spatial<double> deformation<double>(const Bushing&, const State<double>&);
extern template Matrix3<double> axes<double>(const Bushing&, const State<double>&);
extern template ElementStiffness<double> element_stiffness<double>(const ElasticKind&,
                                                                   const Rest<double>&,
                                                                   const State<double>&);
extern template ElementForce<double> element_force<double>(const ElasticKind&, const Rest<double>&,
                                                           const State<double>&);
extern template void elastic_force<double>(const Model&, const Inputs<double>&,
                                           const State<double>&, Vector<double>&);

}  // namespace elastocheck::recursive
