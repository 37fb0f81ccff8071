// Φ(q) and its Jacobian Φ_q for the four basic constraints: eqs. (1), (6)-(7), after Nikravesh (1988).
//
// With p = r + s the position of a point, s = A s', and a small motion Δq = (Δr, Δπ):
//
//   Δp = Δr - s̃ Δπ,   Δu = -ũ Δπ for a direction u,   so   n·Δp = n·Δr + (s × n)·Δπ .
//
//   coincident points          Φ = p_i - p_j
//   point in plane             Φ = n_j·d,  d = p_i - p_j        n_j turns with body j: its lever reaches to
//   p_i perpendicular directions   Φ = u_i·u_j distance between           Φ = (d·d - ℓ²) / (2ℓ) scaled so
//   that Φ is a length and |Φ_q,r| is 1 on the surface
#pragma once

#include "recursive/state.hpp"

namespace elastocheck::recursive {

// One scalar constraint: its value and its two blocks of Φ_q, [n  m] with the columns (Δr, Δπ). A multiplier
// λ on it puts the generalised force -λ [n  m]ᵀ on the body (f_ext = K Δq + Φ_qᵀ λ).
template <class Real>
struct Row {
    BodyId i = ground, j = ground;
    Real Phi = 0;        // [m] or [-]
    bool length = true;  // whether Phi is a length (else a cosine)
    Vector6<Real> on_i, on_j;
};

namespace detail {

template <class Real>
Vector6<Real> along(const Vector3<Real>& n, const Vector3<Real>& s) {
    Vector6<Real> row;
    row << n, s.cross(n);
    return row;
}

template <class Real, class Sink>
void rows(const CoincidentPoints& c, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Vector3<Real> d = q[c.i.body].r + s_i - q[c.j.body].r - s_j;
    for (int k = 0; k < 3; ++k) {
        const Vector3<Real> n = Vector3<Real>::Unit(k);
        sink(Row<Real>{c.i.body, c.j.body, d[k], true, along<Real>(n, s_i), along<Real>(-n, s_j)});
    }
}

template <class Real, class Sink>
void rows(const PointInPlane& c, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Vector3<Real> n = q[c.normal_j.body].lever(c.normal_j.u_local);
    const Vector3<Real> d = q[c.i.body].r + s_i - q[c.j.body].r - s_j;
    sink(Row<Real>{c.i.body, c.j.body, n.dot(d), true, along<Real>(n, s_i), along<Real>(-n, s_j + d)});
}

template <class Real, class Sink>
void rows(const PerpendicularDirections& c, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> u_i = q[c.i.body].lever(c.i.u_local), u_j = q[c.j.body].lever(c.j.u_local);
    Row<Real> row{c.i.body, c.j.body, u_i.dot(u_j), false, {}, {}};
    row.on_i << Vector3<Real>::Zero(), u_i.cross(u_j);
    row.on_j << Vector3<Real>::Zero(), u_j.cross(u_i);
    sink(row);
}

template <class Real, class Sink>
void rows(const DistanceBetween& c, const State<Real>& q, Sink&& sink) {
    const Vector3<Real> s_i = q[c.i.body].lever(c.i.s_local), s_j = q[c.j.body].lever(c.j.s_local);
    const Vector3<Real> d = q[c.i.body].r + s_i - q[c.j.body].r - s_j;
    const Real length = static_cast<Real>(c.length);
    const Vector3<Real> n = d / length;
    sink(Row<Real>{c.i.body, c.j.body, (d.dot(d) - length * length) / (2 * length), true, along<Real>(n, s_i),
                   along<Real>(-n, s_j)});
}

}  // namespace detail

// Calls sink(const Row<Real>&) for every scalar row of a constraint, in order.
template <class Real, class Sink>
void rows(const ConstraintKind& kind, const State<Real>& q, Sink&& sink) {
    std::visit([&](const auto& c) { detail::rows<Real>(c, q, sink); }, kind);
}

// Calls sink(row number, const Row<Real>&) for all rows of the model, 0 ... m-1.
template <class Real, class Sink>
void for_each_row(const Model& model, const State<Real>& q, Sink&& sink) {
    int k = 0;
    for (const auto& constraint : model.constraints)
        rows<Real>(constraint.kind, q, [&](const Row<Real>& row) { sink(k++, row); });
}

// Φ_q [m × 6nb] and Φ [m], for those who want them whole.
template <class Real>
Matrix<Real> constraint_jacobian(const Model& model, const State<Real>& q) {
    Matrix<Real> Phi_q = Matrix<Real>::Zero(constraint_rows(model), coordinates(model));
    for_each_row<Real>(model, q, [&](int k, const Row<Real>& row) {
        if (row.i != ground) Phi_q.row(k).template segment<6>(6 * row.i) += row.on_i.transpose();
        if (row.j != ground) Phi_q.row(k).template segment<6>(6 * row.j) += row.on_j.transpose();
    });
    return Phi_q;
}

template <class Real>
Vector<Real> constraint_values(const Model& model, const State<Real>& q) {
    Vector<Real> Phi(constraint_rows(model));
    for_each_row<Real>(model, q, [&](int k, const Row<Real>& row) { Phi[k] = row.Phi; });
    return Phi;
}

}  // namespace elastocheck::recursive
