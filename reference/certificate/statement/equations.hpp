// Equilibrium equations of elements, joints and loads on each body, for all number
// types of numbers.hpp.
//
// Derived from the energies of mechanism.hpp by virtual work: a connection of two bodies
// does the work
//
//   δW = F_i · δr_i + M_i · δπ_i + F_j · δr_j + M_j · δπ_j
//
// when the bodies move by δr and rotate by δπ (ground axes); M is about each body's own origin.
#pragma once

#include "elastocheck/model.hpp"
#include "models/overloaded.hpp"
#include "reference/certificate/interval/laws.hpp"
#include "reference/certificate/interval/rotations.hpp"

namespace elastocheck::reference::certificate {

template <class T>
struct Frame {
    Vec<T> r;
    Quat<T> p;
};

// Wrench on one body: a force, and a moment about its origin.
template <class T>
struct BodyWrench {
    Vec<T> force, moment;
};
// Wrenches of an element or a reaction on its two bodies.
template <class T>
struct WrenchPair {
    BodyWrench<T> i, j;
};

template <class T>
Vec<T> lever(const Frame<T>& body, const Eigen::Vector3d& s_local) {
    return turned(body.p, constant<T>(s_local));
}
template <class T>
Vec<T> position(const Frame<T>& body, const Eigen::Vector3d& s_local) {
    return body.r + lever(body, s_local);
}

// Force F at x and moment M on i, and the opposite of both on j.
template <class T>
WrenchPair<T> opposed(const Vec<T>& F, const Vec<T>& M, const Vec<T>& x, const Frame<T>& i,
                      const Frame<T>& j) {
    return {{F, cross(x - i.r, F) + M}, {-F, -(cross(x - j.r, F) + M)}};
}

// ---- Elastic elements

// Deformation that enters the law: ℓ - ℓ₀.
template <class T>
T deformation(const AxialSpring& spring, const T& free_length, const Frame<T>& i,
              const Frame<T>& j) {
    using std::sqrt;
    return sqrt(squared(position(j, spring.j.s_local) - position(i, spring.i.s_local))) -
           free_length;
}

// Wrenches of a spring on its bodies. δℓ = n · (δp_j - δp_i), n from i to j: the tensile force
// f(ℓ - ℓ₀) acts along n on i and against it on j.
template <class T, class ForceOf>
WrenchPair<T> element_wrenches(const AxialSpring& spring, const T& free_length, const Frame<T>& i,
                               const Frame<T>& j, const ForceOf& f) {
    using std::sqrt;
    const Vec<T> p_i = position(i, spring.i.s_local), D = position(j, spring.j.s_local) - p_i;
    const T length = sqrt(squared(D));
    const Vec<T> F = D * (f(T(length - free_length)) / length);
    const Vec<T> none = constant<T>(Eigen::Vector3d::Zero());
    return opposed(F, none, p_i, i, j);
}

// Relative pose of the markers of a bushing, and its deformation. Where the law does
// not depend on the angles (`rotational` is false), they are not computed, and may be arbitrary.
template <class T>
struct RelativePose {
    Vec<T> p_j, D;     // marker j, and from marker i to it
    Quat<T> A_i, B;    // axes of marker i to ground axes; of j to i
    Quat<T> half;      // C, C² = B: frame in the middle only
    Quat<T> A_f;       // axes of the frame to ground axes
    Angles<T> angles;  // rotational only
    std::array<T, 6> e;
};
template <class T>
RelativePose<T> relative_pose(const Bushing& bushing, bool rotational, const Frame<T>& i,
                              const Frame<T>& j) {
    RelativePose<T> m;
    m.p_j = position(j, bushing.j.s_local);
    m.D = m.p_j - position(i, bushing.i.s_local);
    m.A_i = product(i.p, unit_quaternion<T>(bushing.i.A_local));
    m.A_f = m.A_i;
    const bool middle = bushing.formulation.frame == Formulation::Frame::middle;
    m.angles.theta = constant<T>(Eigen::Vector3d::Zero());
    if (rotational || middle)
        m.B = product(conjugate(m.A_i), product(j.p, unit_quaternion<T>(bushing.j.A_local)));
    if (middle) {
        m.half = half_of(short_way(m.B));
        m.A_f = product(m.A_i, m.half);
    }
    if (rotational) m.angles = angles_of(bushing.formulation.angles, m.B);
    const Vec<T> d = turned(conjugate(m.A_f), m.D);
    m.e = {d[0], d[1], d[2], m.angles.theta[0], m.angles.theta[1], m.angles.theta[2]};
    return m;
}

// e - e₀, e₀ the undeformed position, whose d_z its driver increases by `rise`.
template <class T>
std::array<T, 6> deformation(const Bushing& bushing, const T& rise, const RelativePose<T>& m) {
    std::array<T, 6> e = m.e;
    e[2] = e[2] - rise;
    for (std::size_t k = 0; k < 6; ++k)
        e[k] = e[k] - Base<T>(bushing.undeformed[static_cast<int>(k)]);
    return e;
}

// Wrenches of a bushing on its bodies from its element forces `f_g`, (f, g) = ∂u/∂e + preload with
// the energy u. With F = A_f f and the frame rotating by δπ_f,
//
//   f · δd = F · (δp_j - δp_i) - (D × F) · δπ_f        g · δθ = (A_i G g) · (δπ_j - δπ_i)
//
// The forces on the bodies are the opposite. Frame on i, δπ_f = δπ_i: on j, -F at p_j and -A_i G g;
// on i, F at p_i with D × F, which equals F at p_j, and A_i G g.
//
// Frame in the middle: with C² = B and δB = w̃ B, w = A_iᵀ (δπ_j - δπ_i), C rotates by c where
// c + C c = w, and (I + C)⁻¹ = ½ (I - t̃), t = tan(|θ|/4) θ/|θ| = v_C / w_C. So
// δπ_f = δπ_i + ½ A_i (I - t̃) w. Of the moment D × F that is conjugate to the rotation of the
// frame, j has ½ (D × F + t × (D × F)), t in ground axes, and i the rest.
//
// Not conjugate: A_i g, or A_f g, which are equal for a frame on i. Without the offset moment, F
// acts on i at p_i, and D × F on neither body.
template <class T>
WrenchPair<T> element_wrenches(const Bushing& bushing, const std::array<T, 6>& f_g,
                               const RelativePose<T>& m, bool rotational, const Frame<T>& i,
                               const Frame<T>& j) {
    const Formulation& formulation = bushing.formulation;
    const Vec<T> F = turned(m.A_f, Vec<T>{{f_g[0], f_g[1], f_g[2]}});
    Vec<T> M = constant<T>(Eigen::Vector3d::Zero());
    if (rotational) {
        Vec<T> g{{f_g[3], f_g[4], f_g[5]}};
        if (formulation.conjugate)
            g = m.angles.G[0] * f_g[3] + m.angles.G[1] * f_g[4] + m.angles.G[2] * f_g[5];
        M = turned(m.A_i, g);
    }
    if (!formulation.offset_moment) {
        WrenchPair<T> on = opposed(F, M, m.p_j, i, j);
        on.i.moment = on.i.moment - cross(m.D, F);
        return on;
    }
    if (formulation.frame == Formulation::Frame::middle) {
        const Vec<T> offset = cross(m.D, F);
        const Vec<T> t{{m.half.v[0] / m.half.w, m.half.v[1] / m.half.w, m.half.v[2] / m.half.w}};
        const T half = constant<T>(0.5);
        M = M - (offset + cross(turned(m.A_i, t), offset)) * half;
    }
    return opposed(F, M, m.p_j, i, j);
}

// ---- Constraints

// One constraint row: its value, and the action of a unit reaction [N or N·m], from the rates of Φ
// by virtual work.
template <class T>
struct Row {
    T Phi;
    WrenchPair<T> reaction;
};
template <class T, std::size_t n = 1>
using Rows = std::array<Row<T>, n>;

// δΦ = n · (δp_i - δp_j), p a point common to both: n at p on i, -n on j.
template <class T>
Row<T> point_row(const T& Phi, const Vec<T>& n, const Vec<T>& p, const Frame<T>& i,
                 const Frame<T>& j) {
    return {Phi, opposed(n, constant<T>(Eigen::Vector3d::Zero()), p, i, j)};
}
// δ(u_i · u_j) = (u_i × u_j) · (δπ_i - δπ_j)
template <class T>
Row<T> direction_row(const T& Phi, const Vec<T>& u_i, const Vec<T>& u_j) {
    const Vec<T> about = cross(u_i, u_j), none = constant<T>(Eigen::Vector3d::Zero());
    return {Phi, {{none, about}, {none, -about}}};
}

template <class T>
Rows<T, 3> rows_of(const CoincidentPoints& c, const T&, const Frame<T>& i, const Frame<T>& j) {
    const Vec<T> p = position(i, c.i.s_local), gap = p - position(j, c.j.s_local);
    Rows<T, 3> rows;
    for (std::size_t k = 0; k < 3; ++k)
        rows[k] =
            point_row(gap[k], constant<T>(Eigen::Vector3d::Unit(static_cast<int>(k))), p, i, j);
    return rows;
}
// The normal rotates with j: δ(n · (p_i - p_j)) = n · (δp_i - δp_j*), p_j* the point of j at the
// position of p_i.
template <class T>
Rows<T> rows_of(const PointInPlane& c, const T& value, const Frame<T>& i, const Frame<T>& j) {
    const Vec<T> p = position(i, c.i.s_local), n = lever(j, c.normal_j.u_local);
    return {point_row(T(dot(n, p - position(j, c.j.s_local)) - value), n, p, i, j)};
}
template <class T>
Rows<T> rows_of(const PerpendicularDirections& c, const T&, const Frame<T>& i, const Frame<T>& j) {
    const Vec<T> u_i = lever(i, c.i.u_local), u_j = lever(j, c.j.u_local);
    return {direction_row(dot(u_i, u_j), u_i, u_j)};
}
template <class T>
Rows<T> rows_of(const DistanceBetween& c, const T& value, const Frame<T>& i, const Frame<T>& j) {
    using std::sqrt;
    const Vec<T> p = position(i, c.i.s_local), bar = p - position(j, c.j.s_local);
    const T length = sqrt(squared(bar));
    const Vec<T> n{{bar[0] / length, bar[1] / length, bar[2] / length}};
    return {point_row(T(length - value), n, p, i, j)};
}
template <class T>
Rows<T> rows_of(const DirectionAtAngle& c, const T& value, const Frame<T>& i, const Frame<T>& j) {
    const Turned<T> angle = cos_sin_of(value);
    const Vec<T> u_i = lever(i, c.i.u_local),
                 across = lever(j, c.y_j.u_local) * angle.cos - lever(j, c.j.u_local) * angle.sin;
    return {direction_row(dot(u_i, across), u_i, across)};
}

// ---- Loads of unit factor

template <class T>
BodyWrench<T> load_wrench(const DeadForce& load, const Frame<T>& body) {
    const Vec<T> f = constant<T>(load.f);
    return {f, cross(lever(body, load.at.s_local), f)};
}
template <class T>
BodyWrench<T> load_wrench(const DeadMoment& load, const Frame<T>&) {
    return {constant<T>(Eigen::Vector3d::Zero()), constant<T>(load.m)};
}
template <class T>
BodyWrench<T> load_wrench(const FollowerForce& load, const Frame<T>& body) {
    const Vec<T> f = lever(body, load.f_local);
    return {f, cross(lever(body, load.at.s_local), f)};
}
template <class T>
BodyWrench<T> load_wrench(const FollowerMoment& load, const Frame<T>& body) {
    return {constant<T>(Eigen::Vector3d::Zero()), lever(body, load.m_local)};
}
// Moment (p - r) × f on the carrier, p a point of the wheel.
template <class T>
BodyWrench<T> load_wrench(const BrakeForce& load, const Frame<T>& carrier, const Frame<T>& wheel) {
    const Vec<T> f = constant<T>(load.f);
    return {f, cross(position(wheel, load.patch.s_local) - carrier.r, f)};
}

}  // namespace elastocheck::reference::certificate
