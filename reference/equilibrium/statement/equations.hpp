// Free-body equations of joints, elements and loads, for double and for Ceres Jets.
//
// Whatever connects two bodies acts on body i with a force and a moment, and on body j with the
// opposite of both, the force on the same line of action. One `Interaction` describes both:
//
//   on body i:   force  F      moment about r_i   M + (x - r_i) × F
//   on body j:   force -F      moment about r_j  -M - (x - r_j) × F
//
// with x any point of the line of action.
#pragma once

#include "elastocheck/model.hpp"
#include "models/kinds.hpp"
#include "reference/equilibrium/statement/laws.hpp"
#include "reference/equilibrium/statement/rotations.hpp"

namespace elastocheck::reference::equilibrium {

// Pose of a body: its origin, and the unit quaternion from body axes to ground axes.
template <class T>
struct Frame {
    Vec3<T> r;
    Eigen::Quaternion<T> p;
};

template <class T>
struct Interaction {
    Vec3<T> force = Vec3<T>::Constant(T(0.0));   // F on body i [N]
    Vec3<T> moment = Vec3<T>::Constant(T(0.0));  // M on body i [N·m]
    Vec3<T> at = Vec3<T>::Constant(T(0.0));      // x [m]
};

// Actions of an element on its two bodies: opposite, unless its formulation applies the force to
// each body at a different point.
template <class T>
struct InteractionPair {
    Interaction<T> i, j;
};
template <class T>
InteractionPair<T> opposed(const Interaction<T>& on_i) {
    return {on_i, {-on_i.force, -on_i.moment, on_i.at}};
}

// ---- Points and directions of a body

template <class T>
Vec3<T> position(const Frame<T>& body, const Eigen::Vector3d& s_local) {
    return body.r + turned(body.p, s_local);
}

template <class T>
Vec3<T> direction(const Frame<T>& body, const Eigen::Vector3d& u_local) {
    return turned(body.p, u_local);
}

// ---- Elastic elements: one geometry each, independent of the law

// ℓ - ℓ₀
template <class T>
T deformation(const AxialSpring& spring, const T& free_length, const Frame<T>& i,
              const Frame<T>& j) {
    using std::sqrt;
    const Vec3<T> along = position(j, spring.j.s_local) - position(i, spring.i.s_local);
    return sqrt(dot(along, along)) - free_length;
}

// A spring pulls its ends together with N = u'(ℓ - ℓ₀) + preload along e = (p_j - p_i) / ℓ.
template <class T>
InteractionPair<T> interaction(const AxialSpring& spring, const T& free_length, const T& preload,
                               int piece, const Frame<T>& i, const Frame<T>& j) {
    using std::sqrt;
    const Vec3<T> p_i = position(i, spring.i.s_local), p_j = position(j, spring.j.s_local);
    const Vec3<T> along = p_j - p_i;
    const T length = sqrt(dot(along, along));
    const T pull = (gradient(spring.law, T(length - free_length), piece) + preload) / length;
    Interaction<T> on_i;
    on_i.force = {pull * along[0], pull * along[1], pull * along[2]};
    on_i.at = p_i;
    return opposed(on_i);
}

// Relative pose of the markers of a bushing, and its deformation. Where neither law nor
// preload depend on the relative rotation (`rotational` is false), it may be arbitrarily large, and
// the angles, which have singularities, are not computed.
template <class T>
struct RelativePose {
    Vec3<T> p_i, p_j;          // the markers [m]
    Eigen::Quaternion<T> A_i;  // axes of marker i to ground axes
    Eigen::Quaternion<T> A_f;  // axes of the frame to ground axes
    Vec3<T> half_turn;  // t = tan(|θ|/4) θ/|θ|, axes of marker i; frame in the middle only
    Angles<T> angles;   // of B = A_iᵀ A_j; rotational only
    Vec6<T> e;          // (d [m], θ [rad])
};

template <class T>
RelativePose<T> relative_pose(const Bushing& bushing, bool rotational, const Frame<T>& i,
                              const Frame<T>& j) {
    RelativePose<T> m;
    m.p_i = position(i, bushing.i.s_local);
    m.p_j = position(j, bushing.j.s_local);
    m.A_i = product(i.p, bushing.i.A_local);
    const Eigen::Quaternion<T> B = product(conjugate(m.A_i), product(j.p, bushing.j.A_local));

    m.A_f = m.A_i;
    if (bushing.formulation.frame == Formulation::Frame::middle) {
        const HalfTurn<T> half = half_turn(B);
        m.A_f = product(m.A_i, half.p);
        m.half_turn = half.t;
    }
    m.angles.theta = Vec3<T>::Constant(T(0.0));
    if (rotational) m.angles = angles_of(bushing.formulation.angles, B);
    m.e << turned(conjugate(m.A_f), Vec3<T>(m.p_j - m.p_i)), m.angles.theta;
    return m;
}

// (f, g) = ∂u/∂e + preload are work-conjugate to e = (d, θ): δU = f · δd + g · δθ. Let the
// bodies move by δr and rotate by δπ (ground axes), D = p_j - p_i, F = A_f f, and let the frame
// rotate by δπ_f.
//
//   δd = A_fᵀ (δp_j - δp_i - δπ_f × D)   so   f · δd = F · (δp_j - δp_i) - δπ_f · (D × F)
//   δθ_k = a_k · A_iᵀ (δπ_j - δπ_i)      so   g · δθ = (A_i m) · (δπ_j - δπ_i),   m = Σ g_k a_k
//
// with the axes a_k of the angles (rotations.hpp). The generalised forces on the bodies are -∂U.
//
// Frame on i: δπ_f = δπ_i. On j: force -F at p_j and moment -A_i m. On i: force F at p_i with
// moment D × F, which equals F at p_j, and moment A_i m.
//
// Frame in the middle: A_f = A_i C, C² = B. With w = A_iᵀ (δπ_j - δπ_i) and δC = c̃ C the variation
// of C,
//   δB = w̃ B = c̃ C C + C c̃ C = (c + C c)~ B,   so   c = (I + C)⁻¹ w = ½ (I - t̃) w
// (Cayley: C = (I + t̃) (I - t̃)⁻¹). So δπ_f = δπ_i + A_i c. Of the moment D × F that is conjugate
// to δπ_f, j receives ½ (I + t̃) D × F with t in ground axes, and i the rest. Hence, besides F at
// p_j, i has the moment A_i m - ½ (D×F + t × (D×F)), and j the opposite.
//
// Not conjugate (frame on i): the moment is A_i g, although it is not conjugate to θ. Without
// offset moment, D × F acts on neither body: F acts on each at its own marker.
template <class T>
InteractionPair<T> interaction(const Bushing& bushing, const RelativePose<T>& markers,
                               const Vec6<T>& fg, bool rotational) {
    const Formulation& formulation = bushing.formulation;
    Interaction<T> on_i;
    on_i.force = turned(markers.A_f, Vec3<T>(fg.template head<3>()));
    on_i.at = markers.p_j;
    if (rotational) {
        const Vec3<T> g = fg.template tail<3>();
        Vec3<T> m = g;
        if (formulation.conjugate)
            m = markers.angles.a[0] * g[0] + markers.angles.a[1] * g[1] +
                markers.angles.a[2] * g[2];
        on_i.moment = turned(markers.A_i, m);
    }
    if (!formulation.offset_moment) {
        InteractionPair<T> on = opposed(on_i);
        on.i.at = markers.p_i;
        return on;
    }
    if (formulation.frame == Formulation::Frame::middle) {
        const Vec3<T> offset = cross(Vec3<T>(markers.p_j - markers.p_i), on_i.force);
        on_i.moment -= (offset + cross(turned(markers.A_i, markers.half_turn), offset)) * T(0.5);
    }
    return opposed(on_i);
}

// A spring that pulls a body back to its design pose, of stiffness 1 / L and L (unit F):
//
//   U = ½ |r - r_0|² / L + 4 L (1 - |cos ½θ|)
//
// whose moment is 2 L sin ½θ about the axis: 2 L times the vector part of the relative quaternion.
template <class T>
Interaction<T> drawn_back(const Frame<T>& body, const Eigen::Vector3d& r_0,
                          const Eigen::Quaterniond& p_0, double length) {
    const Eigen::Quaternion<T> turn = product(body.p, Eigen::Quaterniond(p_0.conjugate()));
    const double back = turn.w() < 0. ? 2 * length : -2 * length;
    Interaction<T> on;
    for (int k = 0; k < 3; ++k) on.force[k] = (body.r[k] - r_0[k]) * (-1 / length);
    on.moment = {turn.x() * back, turn.y() * back, turn.z() * back};
    on.at = body.r;
    return on;
}

// ---- Constraints

// Rows of a constraint, and the interaction of its reactions R [N, or N·m for directions]. A
// frictionless joint transmits only constraint forces: along the normal, along the bar, about the
// common perpendicular of the two directions. `value` is the quantity that a driver may move:
// offset, length or angle.
template <class T>
struct Holding {
    Vec3<T> Phi;  // the first rows(kind) count; [m] or [-]
    Interaction<T> reaction;
};

template <class T>
Holding<T> holding(const CoincidentPoints& c, const T&, const Frame<T>& i, const Frame<T>& j,
                   const T* R) {
    const Vec3<T> p_i = position(i, c.i.s_local);
    Holding<T> h;
    h.Phi = p_i - position(j, c.j.s_local);
    h.reaction.force = {R[0], R[1], R[2]};
    h.reaction.at = p_i;
    return h;
}

// The normal is fixed to body j, the constrained point to body i: the force acts at that point.
template <class T>
Holding<T> holding(const PointInPlane& c, const T& value, const Frame<T>& i, const Frame<T>& j,
                   const T* R) {
    const Vec3<T> p_i = position(i, c.i.s_local), n = direction(j, c.normal_j.u_local);
    Holding<T> h;
    h.Phi[0] = dot(n, Vec3<T>(p_i - position(j, c.j.s_local))) - value;
    h.reaction.force = {n[0] * R[0], n[1] * R[0], n[2] * R[0]};
    h.reaction.at = p_i;
    return h;
}

template <class T>
Holding<T> holding(const PerpendicularDirections& c, const T&, const Frame<T>& i, const Frame<T>& j,
                   const T* R) {
    const Vec3<T> u_i = direction(i, c.i.u_local), u_j = direction(j, c.j.u_local),
                  about = cross(u_i, u_j);
    Holding<T> h;
    h.Phi[0] = dot(u_i, u_j);
    h.reaction.moment = {about[0] * R[0], about[1] * R[0], about[2] * R[0]};
    h.reaction.at = i.r;
    return h;
}

// A bar whose compressive force R pushes its ends apart.
template <class T>
Holding<T> holding(const DistanceBetween& c, const T& value, const Frame<T>& i, const Frame<T>& j,
                   const T* R) {
    using std::sqrt;
    const Vec3<T> p_i = position(i, c.i.s_local), bar = p_i - position(j, c.j.s_local);
    const T length = sqrt(dot(bar, bar)), push = R[0] / length;
    Holding<T> h;
    h.Phi[0] = length - value;
    h.reaction.force = {bar[0] * push, bar[1] * push, bar[2] * push};
    h.reaction.at = p_i;
    return h;
}

// u_i is perpendicular to the direction v_j = cos α y_j - sin α x_j, which rotates with α. Then
// u_i = cos α x_j + sin α y_j, and u_i × v_j is the axis: R is the moment on i about x_j × y_j.
template <class T>
Holding<T> holding(const DirectionAtAngle& c, const T& value, const Frame<T>& i, const Frame<T>& j,
                   const T* R) {
    using std::cos;
    using std::sin;
    const Vec3<T> u_i = direction(i, c.i.u_local), x_j = direction(j, c.j.u_local),
                  y_j = direction(j, c.y_j.u_local);
    const T cosine = cos(value), sine = sin(value);
    Vec3<T> v_j;
    for (int k = 0; k < 3; ++k) v_j[k] = cosine * y_j[k] - sine * x_j[k];
    const Vec3<T> about = cross(u_i, v_j);
    Holding<T> h;
    h.Phi[0] = dot(u_i, v_j);
    h.reaction.moment = {about[0] * R[0], about[1] * R[0], about[2] * R[0]};
    h.reaction.at = i.r;
    return h;
}

// ---- Loads

// Action of a load of unit factor on its body: force, and moment about the body's origin.
template <class T>
Interaction<T> on_body(const DeadForce& load, const Frame<T>& body) {
    Interaction<T> on;
    on.force = load.f.cast<T>();
    on.at = position(body, load.at.s_local);
    return on;
}

template <class T>
Interaction<T> on_body(const DeadMoment& load, const Frame<T>& body) {
    Interaction<T> on;
    on.moment = load.m.cast<T>();
    on.at = body.r;
    return on;
}

// A follower load rotates with its body.
template <class T>
Interaction<T> on_body(const FollowerForce& load, const Frame<T>& body) {
    Interaction<T> on;
    on.force = direction(body, load.f_local);
    on.at = position(body, load.at.s_local);
    return on;
}

template <class T>
Interaction<T> on_body(const FollowerMoment& load, const Frame<T>& body) {
    Interaction<T> on;
    on.moment = direction(body, load.m_local);
    on.at = body.r;
    return on;
}

// A brake force acts on the carrier, at a point of the wheel.
template <class T>
Interaction<T> on_body(const BrakeForce& load, const Frame<T>& wheel) {
    Interaction<T> on;
    on.force = load.f.cast<T>();
    on.at = position(wheel, load.patch.s_local);
    return on;
}

// The body whose frame determines the action of a load: its own, or that of its point.
inline BodyId acts_with(const LoadKind& load) {
    const Point* point = member<Point>(load);
    return point != nullptr ? point->body : body_of(load);
}

// ---- Bodies of an element or constraint

struct Pair {
    BodyId i, j;
};

template <class Kind>
Pair bodies_of(const Kind& kind) {
    return std::visit([](const auto& k) { return Pair{k.i.body, k.j.body}; }, kind);
}

}  // namespace elastocheck::reference::equilibrium
