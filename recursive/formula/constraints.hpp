// Constraint functions Φ(q, inputs) and their Jacobian Φ_q for the basic constraints.
// Eqs. (1), (6)-(7), after Nikravesh (1988). c is the offset, length or angle of the constraint
// (inputs.hpp), which a branch may drive.
//
// With p = r + s the position of a point, s = A s', and a small motion Δq = (Δr, Δπ):
//
//   Δp = Δr - s̃ Δπ,   Δu = -ũ Δπ for a direction u,   so   n·Δp = n·Δr + (s × n)·Δπ .
//
//   coincident points          Φ = p_i - p_j
//
//   point in plane             Φ = n_j·d - c,  d = p_i - p_j; n_j rotates with body j: its lever
//                              reaches to p_i
//
//   perpendicular directions   Φ = u_i·u_j
//
//   distance between           Φ = (d·d - c²) / (2c): a length, with |Φ_q,r| = 1 on the surface
//
//   direction at angle         Φ = u_i·w,  w = cos c y_j - sin c x_j, which is perpendicular to the
//                              direction of body j at the angle c from its x_j towards its y_j
//
// Derivatives with respect to c, with w' = dw/dc = -(sin c y_j + cos c x_j):
//
//   ∂Φ/∂c      -1 (plane), -(d·d + c²) / (2c²) (distance), u_i·w' (angle)
//
//   ∂Φ_q/∂c    distance: its direction d/c has the derivative -d/c²
//              angle: its couple u_i × w has the derivative u_i × w'
#pragma once

#include "recursive/formula/inputs.hpp"

namespace elastocheck::recursive {

// One scalar constraint: its value and its two blocks of Φ_q, [n  m] with the columns (Δr, Δπ). The
// blocks are given by their lines of action: a direction n at the levers s_i and s_j, and a couple
// u. A multiplier λ puts the generalised force -λ [n  m]ᵀ on the body (f_ext = K Δq + Φ_qᵀ λ).
template <class Real>
struct Row {
    BodyId i = ground, j = ground;
    Real Phi = 0;        // [m] or [-]
    bool length = true;  // whether Phi is a length (else a cosine)
    Vector3<Real> n, s_i, s_j, u;

    Vector6<Real> on_i() const { return block(n, s_i.cross(n) + u); }    // [n  s_i × n + u]
    Vector6<Real> on_j() const { return block(-n, -s_j.cross(n) - u); }  // [-n  -(s_j × n + u)]

  private:
    static Vector6<Real> block(const Vector3<Real>& r, const Vector3<Real>& pi) {
        Vector6<Real> both;
        both << r, pi;
        return both;
    }
};

namespace detail {

template <class Real>
Row<Real> zero_row() {
    const Vector3<Real> zero = Vector3<Real>::Zero();
    return {ground, ground, 0, true, zero, zero, zero, zero};
}

template <class Real, class Sink>
void rows(const CoincidentPoints& c, Real, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Vector3<Real> d = q[c.i.body].r + s_i - q[c.j.body].r - s_j;
    for (int k = 0; k < 3; ++k)
        sink(Row<Real>{c.i.body, c.j.body, d[k], true, Vector3<Real>::Unit(k), s_i, s_j,
                       Vector3<Real>::Zero()});
}

template <class Real, class Sink>
void rows(const PointInPlane& c, Real offset, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Vector3<Real> n = q[c.normal_j.body].lever(c.normal_j.u_local);
    const Vector3<Real> d = q[c.i.body].r + s_i - q[c.j.body].r - s_j;
    sink(Row<Real>{c.i.body, c.j.body, n.dot(d) - offset, true, n, s_i, s_j + d,
                   Vector3<Real>::Zero()});
}

template <class Real, class Sink>
void rows(const PerpendicularDirections& c, Real, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> u_i = q[c.i.body].lever(c.i.u_local), u_j = q[c.j.body].lever(c.j.u_local);
    const Vector3<Real> zero = Vector3<Real>::Zero();
    sink(Row<Real>{c.i.body, c.j.body, u_i.dot(u_j), false, zero, zero, zero, u_i.cross(u_j)});
}

template <class Real, class Sink>
void rows(const DistanceBetween& c, Real length, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Vector3<Real> d = q[c.i.body].r + s_i - q[c.j.body].r - s_j;
    sink(Row<Real>{c.i.body, c.j.body, (d.dot(d) - length * length) / (2 * length), true,
                   d / length, s_i, s_j, Vector3<Real>::Zero()});
}

// The direction w of a DirectionAtAngle, ground axes.
template <class Real>
Vector3<Real> normal_at_angle(const DirectionAtAngle& c, Real angle, const State<Real>& q) {
    using std::cos;
    using std::sin;
    return cos(angle) * q[c.y_j.body].lever(c.y_j.u_local) -
           sin(angle) * q[c.j.body].lever(c.j.u_local);
}

template <class Real, class Sink>
void rows(const DirectionAtAngle& c, Real angle, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> u_i = q[c.i.body].lever(c.i.u_local), w = normal_at_angle(c, angle, q);
    const Vector3<Real> zero = Vector3<Real>::Zero();
    sink(Row<Real>{c.i.body, c.j.body, u_i.dot(w), false, zero, zero, zero, u_i.cross(w)});
}

// Derivative of a row with respect to c, entry by entry: zero for a constraint without c.
template <class Real>
Row<Real> rate(const CoincidentPoints&, Real, const State<Real>&) {
    return zero_row<Real>();
}
template <class Real>
Row<Real> rate(const PerpendicularDirections&, Real, const State<Real>&) {
    return zero_row<Real>();
}
template <class Real>
Row<Real> rate(const PointInPlane&, Real, const State<Real>&) {
    Row<Real> row = zero_row<Real>();
    row.Phi = -1;
    return row;
}
template <class Real>
Row<Real> rate(const DistanceBetween& c, Real length, const State<Real>& q) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Vector3<Real> d = q[c.i.body].r + s_i - q[c.j.body].r - s_j;
    const Real squared = length * length;
    return {c.i.body,
            c.j.body,
            -(d.dot(d) + squared) / (2 * squared),
            true,
            -d / squared,
            s_i,
            s_j,
            Vector3<Real>::Zero()};
}
template <class Real>
Row<Real> rate(const DirectionAtAngle& c, Real angle, const State<Real>& q) {
    using std::cos;
    using std::sin;
    const Vector3<Real> u_i = q[c.i.body].lever(c.i.u_local), zero = Vector3<Real>::Zero();
    const Vector3<Real> dw = -(sin(angle) * q[c.y_j.body].lever(c.y_j.u_local) +
                               cos(angle) * q[c.j.body].lever(c.j.u_local));
    return {c.i.body, c.j.body, u_i.dot(dw), false, zero, zero, zero, u_i.cross(dw)};
}

}  // namespace detail

// Calls sink(const Row<Real>&) for every scalar row of a constraint, in order.
template <class Real, class Sink>
void rows(const ConstraintKind& kind, Real offset, const State<Real>& q, Sink&& sink) {
    std::visit([&](const auto& c) { detail::rows<Real>(c, offset, q, sink); }, kind);
}

// ∂/∂c of the first row of a constraint: of Φ, and of the direction and couple in which λ acts.
// Zero for a constraint without c.
template <class Real>
Row<Real> rate(const ConstraintKind& kind, Real offset, const State<Real>& q) {
    return std::visit([&](const auto& c) { return detail::rate<Real>(c, offset, q); }, kind);
}
// ∂Φ/∂c alone.
template <class Real>
Real slope(const ConstraintKind& kind, Real offset, const State<Real>& q) {
    return rate<Real>(kind, offset, q).Phi;
}

// Calls sink(row number, const Row<Real>&) for all rows of the model, 0 ... m-1.
template <class Real, class Sink>
void for_each_row(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
                  Sink&& sink) {
    int k = 0;
    for (std::size_t c = 0; c < model.constraints.size(); ++c)
        rows<Real>(model.constraints[c].kind, inputs.offset[c], q,
                   [&](const Row<Real>& row) { sink(k++, row); });
}

// Φ_q [m × 6nb] as a dense matrix; constraint_values() below: Φ [m].
template <class Real>
Matrix<Real> constraint_jacobian(const Model& model, const Inputs<Real>& inputs,
                                 const State<Real>& q) {
    Matrix<Real> Phi_q = Matrix<Real>::Zero(constraint_rows(model), coordinates(model));
    for_each_row<Real>(model, inputs, q, [&](int k, const Row<Real>& row) {
        if (row.i != ground) Phi_q.row(k).template segment<6>(6 * row.i) += row.on_i().transpose();
        if (row.j != ground) Phi_q.row(k).template segment<6>(6 * row.j) += row.on_j().transpose();
    });
    return Phi_q;
}

template <class Real>
Vector<Real> constraint_values(const Model& model, const Inputs<Real>& inputs,
                               const State<Real>& q) {
    Vector<Real> Phi(constraint_rows(model));
    for_each_row<Real>(model, inputs, q, [&](int k, const Row<Real>& row) { Phi[k] = row.Phi; });
    return Phi;
}

}  // namespace elastocheck::recursive
