// Φ(q, inputs) and its Jacobian Φ_q for the basic constraints: eqs. (1), (6)-(7), after Nikravesh (1988).
// c is the offset, length or angle of the constraint (inputs.hpp), which a branch may move.
//
// With p = r + s the position of a point, s = A s', and a small motion Δq = (Δr, Δπ):
//
//   Δp = Δr - s̃ Δπ,   Δu = -ũ Δπ for a direction u,   so   n·Δp = n·Δr + (s × n)·Δπ .
//
//   coincident points          Φ = p_i - p_j
//
//   point in plane             Φ = n_j·d - c,  d = p_i - p_j; n_j turns with body j: its lever reaches to p_i
//
//   perpendicular directions   Φ = u_i·u_j
//
//   distance between           Φ = (d·d - c²) / (2c), so that Φ is a length and |Φ_q,r| is 1 on the surface
//
//   direction at angle         Φ = u_i·w,  w = cos c y_j - sin c x_j: perpendicular to a direction of body j
//
// and with c: ∂Φ/∂c = -1 (plane), -(d·d + c²) / (2c²) (distance), -u_i·(sin c y_j + cos c x_j) (angle).
#pragma once

#include "recursive/inputs.hpp"

namespace elastocheck::recursive {

// One scalar constraint: its value, and its two blocks of Φ_q, [n  m] with the columns (Δr, Δπ), as the lines
// along which it acts: direction n at the levers s_i and s_j, and a couple u. A multiplier λ on it puts the
// generalised force -λ [n  m]ᵀ on the body (f_ext = K Δq + Φ_qᵀ λ).
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
    sink(Row<Real>{c.i.body, c.j.body, n.dot(d) - offset, true, n, s_i, s_j + d, Vector3<Real>::Zero()});
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
    sink(Row<Real>{c.i.body, c.j.body, (d.dot(d) - length * length) / (2 * length), true, d / length, s_i,
                   s_j, Vector3<Real>::Zero()});
}

// w of a direction at an angle, ground axes.
template <class Real>
Vector3<Real> across(const DirectionAtAngle& c, Real angle, const State<Real>& q) {
    using std::cos;
    using std::sin;
    return cos(angle) * q[c.y_j.body].lever(c.y_j.u_local) - sin(angle) * q[c.j.body].lever(c.j.u_local);
}

template <class Real, class Sink>
void rows(const DirectionAtAngle& c, Real angle, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> u_i = q[c.i.body].lever(c.i.u_local), w = across(c, angle, q);
    const Vector3<Real> zero = Vector3<Real>::Zero();
    sink(Row<Real>{c.i.body, c.j.body, u_i.dot(w), false, zero, zero, zero, u_i.cross(w)});
}

// ∂Φ/∂c, where there is a c.
template <class Real>
Real slope(const CoincidentPoints&, Real, const State<Real>&) {
    return 0;
}
template <class Real>
Real slope(const PointInPlane&, Real, const State<Real>&) {
    return -1;
}
template <class Real>
Real slope(const PerpendicularDirections&, Real, const State<Real>&) {
    return 0;
}
template <class Real>
Real slope(const DistanceBetween& c, Real length, const State<Real>& q) {
    const Vector3<Real> d =
        q[c.i.body].r + q[c.i.body].lever(c.i.s_local) - q[c.j.body].r - q[c.j.body].lever(c.j.s_local);
    return -(d.dot(d) + length * length) / (2 * length * length);
}
template <class Real>
Real slope(const DirectionAtAngle& c, Real angle, const State<Real>& q) {
    using std::cos;
    using std::sin;
    return -q[c.i.body]
                .lever(c.i.u_local)
                .dot(sin(angle) * q[c.y_j.body].lever(c.y_j.u_local) +
                     cos(angle) * q[c.j.body].lever(c.j.u_local));
}

}  // namespace detail

// Calls sink(const Row<Real>&) for every scalar row of a constraint, in order.
template <class Real, class Sink>
void rows(const ConstraintKind& kind, Real offset, const State<Real>& q, Sink&& sink) {
    std::visit([&](const auto& c) { detail::rows<Real>(c, offset, q, sink); }, kind);
}

// ∂Φ/∂c of a constraint, 0 where it has none.
template <class Real>
Real slope(const ConstraintKind& kind, Real offset, const State<Real>& q) {
    return std::visit([&](const auto& c) { return detail::slope<Real>(c, offset, q); }, kind);
}

// Calls sink(row number, const Row<Real>&) for all rows of the model, 0 ... m-1.
template <class Real, class Sink>
void for_each_row(const Model& model, const Inputs<Real>& inputs, const State<Real>& q, Sink&& sink) {
    int k = 0;
    for (std::size_t c = 0; c < model.constraints.size(); ++c)
        rows<Real>(model.constraints[c].kind, inputs.offset[c], q,
                   [&](const Row<Real>& row) { sink(k++, row); });
}

// Φ_q [m × 6nb] and Φ [m], for those who want them whole.
template <class Real>
Matrix<Real> constraint_jacobian(const Model& model, const Inputs<Real>& inputs, const State<Real>& q) {
    Matrix<Real> Phi_q = Matrix<Real>::Zero(constraint_rows(model), coordinates(model));
    for_each_row<Real>(model, inputs, q, [&](int k, const Row<Real>& row) {
        if (row.i != ground) Phi_q.row(k).template segment<6>(6 * row.i) += row.on_i().transpose();
        if (row.j != ground) Phi_q.row(k).template segment<6>(6 * row.j) += row.on_j().transpose();
    });
    return Phi_q;
}

template <class Real>
Vector<Real> constraint_values(const Model& model, const Inputs<Real>& inputs, const State<Real>& q) {
    Vector<Real> Phi(constraint_rows(model));
    for_each_row<Real>(model, inputs, q, [&](int k, const Row<Real>& row) { Phi[k] = row.Phi; });
    return Phi;
}

}  // namespace elastocheck::recursive
