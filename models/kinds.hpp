// The name and the members of every kind of joint, constraint, element, load and driven quantity.
//
// Each kind is listed once, here. Code that only moves, mirrors, renumbers, scales or counts the members of a
// kind calls each_member() and needs no change for a new kind. The equations of a kind belong to the legs.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "elastocheck/model.hpp"
#include "models/overloaded.hpp"

namespace elastocheck {

// ---- Members whose C++ type does not say what they are: a reference with its meaning. T is the type
// of the member, const or not.

template <class T>
struct Length {
    T& value;  // [m]
};
template <class T>
struct PlaneAngle {
    T& value;  // [rad]
};
template <class T>
struct ForceAndMoment {
    T& value;  // (force, moment) in marker axes [N, N·m]
};
template <class T>
struct Deformation {
    T& value;  // (d, θ) in marker axes [m, rad]
};
template <class T>
struct LoadVector {
    T& value;        // [N] or [N·m]
    BodyId axes;     // its components are along the axes of this body, or of ground
    bool is_moment;  // then it is an axial vector
};
// A rotation axis, an axial vector: a mirror image has it reversed. Visitors without an overload for it
// receive it as a Direction.
template <class T>
struct RotationAxis {
    T& direction;
};
template <class T>
struct JointIndex {
    T& value;  // position in joints
};
template <class T>
struct ElasticIndex {
    T& value;  // position in elastics
};
template <class T>
RotationAxis(T&) -> RotationAxis<T>;  // clang 14 does not deduce the guides of aggregates
template <class T>
Length(T&) -> Length<T>;
template <class T>
PlaneAngle(T&) -> PlaneAngle<T>;
template <class T>
ForceAndMoment(T&) -> ForceAndMoment<T>;
template <class T>
Deformation(T&) -> Deformation<T>;
template <class T>
LoadVector(T&, BodyId, bool) -> LoadVector<T>;
template <class T>
JointIndex(T&) -> JointIndex<T>;
template <class T>
ElasticIndex(T&) -> ElasticIndex<T>;

// ---- The kinds. `members` passes all members of a kind at once, i before j.

// Symbol of a joint in a drawing; empty for a joint without a position.
struct JointSymbol {
    const char* name = "";
    bool has_axis = false;  // drawn along the first direction of the joint
    bool at_both_ends = false;
};

// The free coordinate of a joint that a driver may hold or move: the angle about axis_j, or the
// displacement along it.
enum class JointDrive { none, angle, displacement };
struct NotDriven {
    static constexpr JointDrive drive = JointDrive::none;
};

template <class T>
struct Kind;

template <>
struct Kind<Spherical> : NotDriven {
    static constexpr const char* name = "spherical";
    static constexpr JointSymbol symbol{"spherical"};
    static void members(auto& s, auto&& f) { f(s.i, s.j); }
};
template <>
struct Kind<Revolute> {
    static constexpr const char* name = "revolute";
    static constexpr JointSymbol symbol{"revolute", true};
    static constexpr JointDrive drive = JointDrive::angle;
    static void members(auto& s, auto&& f) {
        f(s.i, s.j, RotationAxis{s.axis_i}, RotationAxis{s.axis_j});
    }
};
template <>
struct Kind<Universal> : NotDriven {
    static constexpr const char* name = "universal";
    static constexpr JointSymbol symbol{"universal"};
    static void members(auto& s, auto&& f) { f(s.i, s.j, s.axis_i, s.axis_j); }
};
template <>
struct Kind<Cylindrical> {
    static constexpr const char* name = "cylindrical";
    static constexpr JointSymbol symbol{"sliding", true};
    static constexpr JointDrive drive = JointDrive::angle;
    static void members(auto& s, auto&& f) {
        f(s.i, s.j, RotationAxis{s.axis_i}, RotationAxis{s.axis_j});
    }
};
template <>
struct Kind<Translational> {
    static constexpr const char* name = "translational";
    static constexpr JointSymbol symbol{"sliding", true};
    static constexpr JointDrive drive = JointDrive::displacement;
    static void members(auto& s, auto&& f) { f(s.i, s.j, s.axis_i, s.axis_j); }
};
template <>
struct Kind<Planar> : NotDriven {
    static constexpr const char* name = "planar";
    static constexpr JointSymbol symbol{"plane"};
    static void members(auto& s, auto&& f) { f(s.i, s.j, s.normal_i, s.normal_j); }
};
template <>
struct Kind<Fixed> : NotDriven {  // x and y as a frame: its mirror image has y reversed
    static constexpr const char* name = "fixed";
    static constexpr JointSymbol symbol{"fixed"};
    static void members(auto& s, auto&& f) {
        f(s.i, s.j, s.x_i, RotationAxis{s.y_i}, s.x_j, RotationAxis{s.y_j});
    }
};
template <>
struct Kind<Distance> : NotDriven {
    static constexpr const char* name = "distance";
    static constexpr JointSymbol symbol{"spherical", false, true};
    static void members(auto& s, auto&& f) { f(s.i, s.j, Length{s.length}); }
};
template <>
struct Kind<InPlane> : NotDriven {
    static constexpr const char* name = "in_plane";
    static constexpr JointSymbol symbol{"plane"};
    static void members(auto& s, auto&& f) { f(s.i, s.j, s.normal_j, Length{s.offset}); }
};
template <>
struct Kind<InLine> : NotDriven {
    static constexpr const char* name = "in_line";
    static constexpr JointSymbol symbol{"sliding", true};
    static void members(auto& s, auto&& f) { f(s.i, s.j, s.axis_j); }
};
template <>
struct Kind<Perpendicular> : NotDriven {
    static constexpr const char* name = "perpendicular";
    static constexpr JointSymbol symbol{};
    static void members(auto& s, auto&& f) { f(s.i, s.j); }
};
template <>
struct Kind<Parallel> : NotDriven {
    static constexpr const char* name = "parallel";
    static constexpr JointSymbol symbol{};
    static void members(auto& s, auto&& f) { f(s.i, s.j); }
};
template <>
struct Kind<Angle> : NotDriven {
    static constexpr const char* name = "angle";
    static constexpr JointSymbol symbol{};
    static void members(auto& s, auto&& f) { f(s.i, s.j, s.y_j, PlaneAngle{s.angle}); }
};

template <>
struct Kind<CoincidentPoints> {
    static constexpr const char* name = "coincident points";
    static void members(auto& c, auto&& f) { f(c.i, c.j); }
};
template <>
struct Kind<PointInPlane> {
    static constexpr const char* name = "point in plane";
    static void members(auto& c, auto&& f) { f(c.i, c.j, c.normal_j, Length{c.offset}); }
};
template <>
struct Kind<PerpendicularDirections> {
    static constexpr const char* name = "perpendicular directions";
    static void members(auto& c, auto&& f) { f(c.i, c.j); }
};
template <>
struct Kind<DistanceBetween> {
    static constexpr const char* name = "distance between points";
    static void members(auto& c, auto&& f) { f(c.i, c.j, Length{c.length}); }
};
template <>
struct Kind<DirectionAtAngle> {
    static constexpr const char* name = "direction at an angle";
    static void members(auto& c, auto&& f) { f(c.i, c.j, c.y_j, PlaneAngle{c.angle}); }
};

template <>
struct Kind<AxialSpring> {
    static constexpr const char* name = "spring";
    static void members(auto& e, auto&& f) { f(e.i, e.j, e.law, Length{e.free_length}); }
};
template <>
struct Kind<Bushing> {
    static constexpr const char* name = "bushing";
    static void members(auto& e, auto&& f) {
        f(e.i, e.j, e.law, ForceAndMoment{e.preload}, Deformation{e.undeformed}, e.formulation);
    }
};

template <>
struct Kind<DeadForce> {
    static constexpr bool has_potential = true;
    static void members(auto& l, auto&& f) { f(l.at, LoadVector{l.f, ground, false}); }
};
template <>
struct Kind<DeadMoment> {
    static constexpr bool has_potential = true;
    static void members(auto& l, auto&& f) { f(l.body, LoadVector{l.m, ground, true}); }
};
template <>
struct Kind<FollowerForce> {
    static constexpr bool has_potential = false;
    static void members(auto& l, auto&& f) { f(l.at, LoadVector{l.f_local, l.at.body, false}); }
};
template <>
struct Kind<FollowerMoment> {
    static constexpr bool has_potential = false;
    static void members(auto& l, auto&& f) { f(l.body, LoadVector{l.m_local, l.body, true}); }
};

template <>
struct Kind<BrakeForce> {
    static constexpr bool has_potential = false;
    static void members(auto& l, auto&& f) { f(l.patch, l.body, LoadVector{l.f, ground, false}); }
};

template <>
struct Kind<Load> {
    static void members(auto& d, auto&& f) { f(d); }
};
template <>
struct Kind<Motion> {
    static void members(auto& d, auto&& f) { f(JointIndex{d.joint}); }
};
template <>
struct Kind<FreeLength> {
    static void members(auto& d, auto&& f) { f(ElasticIndex{d.elastic}); }
};
template <>
struct Kind<Preload> {
    static void members(auto& d, auto&& f) {
        f(ElasticIndex{d.elastic}, ForceAndMoment{d.direction});
    }
};

// ---- Traversal.

namespace detail {

template <class F, class M>
void pass(F& f, M&& member) {
    if constexpr (std::is_invocable_v<F&, M>) f(std::forward<M>(member));
}
template <class F, class T>
void pass(F& f, RotationAxis<T>&& axis) {
    if constexpr (std::is_invocable_v<F&, RotationAxis<T>>)
        f(axis);
    else
        pass(f, axis.direction);
}

template <class T>
struct is_variant : std::false_type {};
template <class... K>
struct is_variant<std::variant<K...>> : std::true_type {};

}  // namespace detail

// Calls f for every member of a kind, or of the alternative that a variant of kinds holds, that f
// takes: Point&, Direction&, Marker&, BodyId&, ScalarLaw&, SpatialLaw&, Formulation&, Load&, or one
// of the types above. const kind: const members. Members that f does not take are skipped, so a
// generic lambda would receive all of them.
template <class K, class F>
void each_member(K& kind, F&& f) {
    using T = std::remove_const_t<K>;
    if constexpr (detail::is_variant<T>::value)
        std::visit([&](auto& held) { each_member(held, f); }, kind);
    else
        Kind<T>::members(kind, [&](auto&&... members) {
            (detail::pass(f, std::forward<decltype(members)>(members)), ...);
        });
}

// Calls f(BodyId&) for the body of every member.
template <class K, class F>
void each_body(K& kind, F&& f) {
    using Id = std::conditional_t<std::is_const_v<K>, const BodyId, BodyId>;
    const auto body_of_member = [&]<class M>(M & member) requires requires { member.body; }
    { f(member.body); };
    each_member(kind, overloaded{body_of_member, [&](Id& body) { f(body); }});
}

// Calls f(Point&) or f(Marker&) for every point and marker: both have `body` and `s_local`.
template <class K, class F>
void each_point(K& kind, F&& f) {
    each_member(
        kind, [&]<class M>(M & member) requires requires { member.s_local; } { f(member); });
}

template <class K>
std::vector<Point> points_of(const K& kind) {
    std::vector<Point> points;
    each_member(kind, [&](const Point& point) { points.push_back(point); });
    return points;
}

// The first member of type M, e.g. member<Formulation>(elastic.kind); nullptr if it has none.
template <class M, class K>
auto member(K& kind) {
    using Member = std::conditional_t<std::is_const_v<K>, const M, M>;
    Member* first = nullptr;
    each_member(kind, [&](Member& m) {
        if (first == nullptr) first = &m;
    });
    return first;
}

// The number that a driver changes: the length or offset of a joint or constraint [m] or its angle
// [rad], the free length of an element [m]; nullptr if it has none.
template <class K>
auto driven_number(K& kind) {
    using Value = std::conditional_t<std::is_const_v<K>, const double, double>;
    Value* found = nullptr;
    each_member(kind, overloaded{[&](Length<Value> l) { found = &l.value; },
                                 [&](PlaneAngle<Value> a) { found = &a.value; }});
    return found;
}
// The preload of an element, or the direction of a driven one; nullptr if it has none.
template <class K>
auto preload(K& kind) {
    using Value = std::conditional_t<std::is_const_v<K>, const Vector6, Vector6>;
    Value* found = nullptr;
    each_member(kind, [&](ForceAndMoment<Value> w) { found = &w.value; });
    return found;
}
// Whether the driven number is an angle.
template <class K>
bool is_angle(const K& kind) {
    bool angle = false;
    each_member(kind, [&](PlaneAngle<const double>) { angle = true; });
    return angle;
}

struct Ends {
    BodyId i, j;
};
// The two bodies of a joint, constraint or element.
template <class K>
Ends ends(const K& kind) {
    return std::visit([](const auto& s) { return Ends{s.i.body, s.j.body}; }, kind);
}
// The body that a load acts on.
inline BodyId body_of(const LoadKind& load) {
    BodyId found = ground;
    each_body(load, [&](BodyId body) { found = body; });
    return found;
}
// The force or moment of a load.
template <class L>
auto& load_vector(L& load) {
    using Value = std::conditional_t<std::is_const_v<L>, const Vector3, Vector3>;
    Value* found = nullptr;
    each_member(load, [&](LoadVector<Value> v) { found = &v.value; });
    return *found;
}
inline bool is_moment(const LoadKind& load) {
    bool moment = false;
    each_member(load, [&](LoadVector<const Vector3> v) { moment = v.is_moment; });
    return moment;
}
// Whether the load rotates with its body.
inline bool is_follower(const LoadKind& load) {
    bool follows = false;
    each_member(load, [&](LoadVector<const Vector3> v) { follows = v.axes != ground; });
    return follows;
}
inline bool has_potential(const LoadKind& load) {
    return std::visit([]<class L>(const L&) { return Kind<L>::has_potential; }, load);
}

// Whether the rows of a constraint are cosines of directions [-] with moments as reactions, in
// contrast to lengths with forces.
inline bool is_direction(const ConstraintKind& kind) { return member<Point>(kind) == nullptr; }

// The rate of a linear law, the curve of another; nullptr where the law is not of this kind.
inline const double* rate_of(const ScalarLaw& law) {
    const auto* linear = std::get_if<LinearRate>(&law);
    return linear != nullptr ? &linear->k : nullptr;
}
inline const Curve* curve_of(const ScalarLaw& law) { return std::get_if<Curve>(&law); }
// The matrix of a linear law of six deformations, the laws per axis of another.
inline const Matrix6* matrix_of(const SpatialLaw& law) {
    const auto* linear = std::get_if<LinearStiffness>(&law);
    return linear != nullptr ? &linear->K : nullptr;
}
inline const PerAxis* axes_of(const SpatialLaw& law) { return std::get_if<PerAxis>(&law); }

// The law of deformation `axis` alone: of a spring axis 0, of a bushing with a law per axis any;
// nullptr for other axes and for a full matrix.
inline const ScalarLaw* scalar_law(const ElasticKind& element, std::size_t axis) {
    const ScalarLaw* found = nullptr;
    each_member(element, overloaded{[&](const ScalarLaw& law) {
                                        if (axis == 0) found = &law;
                                    },
                                    [&](const SpatialLaw& law) {
                                        if (const PerAxis* axes = axes_of(law))
                                            found = &axes->axis.at(axis);
                                    }});
    return found;
}
inline const Curve* curve_of(const ElasticKind& element, std::size_t axis) {
    const ScalarLaw* law = scalar_law(element, axis);
    return law != nullptr ? curve_of(*law) : nullptr;
}
// Calls f(axis, curve) for every curve of the element.
template <class F>
void each_curve(const ElasticKind& element, F&& f) {
    for (std::size_t axis = 0; axis < 6; ++axis)
        if (const Curve* curve = curve_of(element, axis)) f(axis, *curve);
}

// The part that a driver drives; -1 or nullptr for other kinds of drivers.
inline const Load* driven_load(const Driven& driven) { return member<Load>(driven); }
inline Load* driven_load(Driven& driven) { return member<Load>(driven); }
inline int driven_joint(const Driven& driven) {
    int found = -1;
    each_member(driven, [&](JointIndex<const int> joint) { found = joint.value; });
    return found;
}
inline int driven_element(const Driven& driven) {
    int found = -1;
    each_member(driven, [&](ElasticIndex<const int> elastic) { found = elastic.value; });
    return found;
}

// Name of a body of a scene or model; "ground" for the ground.
template <class S>
std::string body_name(const S& scene, BodyId body) {
    return body == ground ? "ground" : scene.bodies[static_cast<std::size_t>(body)].name;
}

// Calls f(LoadKind&) for every load of a scene or model: the static ones, then those of branches.
template <class S, class F>
void each_load(S& scene, F&& f) {
    for (auto& load : scene.static_loads) f(load.kind);
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers)
            if (auto* load = driven_load(driver.what)) f(load->kind);
}

}  // namespace elastocheck
