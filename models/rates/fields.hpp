// Visits all data of a scene or a model in one fixed order, to write it to and read it from plain
// lists, and to replace its numbers. Compiled with numbers of both types.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "elastocheck/model.hpp"
#include "models/kinds.hpp"
#include "models/rates/bridge.hpp"

namespace elastocheck::rates {

// ---- Members of what is no kind (models/kinds.hpp lists the members of those).

template <class X, class T>
concept Is = std::is_same_v<std::remove_const_t<X>, T>;

void fields(Is<Pose> auto& x, auto&& f) { f(x.r, x.p); }
void fields(Is<Body> auto& x, auto&& f) { f(x.name, x.design); }
void fields(Is<Point> auto& x, auto&& f) { f(x.body, x.s_local); }
void fields(Is<Direction> auto& x, auto&& f) { f(x.body, x.u_local); }
void fields(Is<Marker> auto& x, auto&& f) { f(x.body, x.s_local, x.A_local); }
void fields(Is<Formulation> auto& x, auto&& f) {
    f(x.frame, x.angles, x.conjugate, x.offset_moment);
}
void fields(Is<LinearRate> auto& x, auto&& f) { f(x.k); }
void fields(Is<Curve> auto& x, auto&& f) { f(x.knots, x.pieces, x.known_outside); }
void fields(Is<LinearStiffness> auto& x, auto&& f) { f(x.K); }
void fields(Is<PerAxis> auto& x, auto&& f) { f(x.axis); }
void fields(Is<Joint> auto& x, auto&& f) { f(x.name, x.kind, x.active_only_where_driven); }
void fields(Is<Elastic> auto& x, auto&& f) {
    f(x.name, x.kind, x.active_only_where_driven, x.written_as, x.markers_swapped);
}
void fields(Is<Load> auto& x, auto&& f) { f(x.name, x.kind); }
void fields(Is<Driver> auto& x, auto&& f) { f(x.what, x.start, x.rate); }
void fields(Is<Branch> auto& x, auto&& f) { f(x.name, x.from, x.to, x.steps, x.unit, x.drivers); }
void fields(Is<SteeringAxis> auto& x, auto&& f) { f(x.lower, x.upper); }
void fields(Is<Wheel> auto& x, auto&& f) {
    f(x.name, x.body, x.centre_local, x.contact_local, x.spin_axis_local, x.side, x.tyre_rate,
      x.steering_axis);
}
void fields(Is<Probe> auto& x, auto&& f) { f(x.name, x.at); }
void fields(Is<Damper> auto& x, auto&& f) { f(x.name, x.i, x.j); }
void fields(Is<Vehicle> auto& x, auto&& f) {
    f(x.wheelbase, x.cg_height, x.axle, x.brake_share, x.drive_share);
}
void fields(Is<Hardpoint> auto& x, auto&& f) { f(x.name, x.position); }
void fields(Is<Number> auto& x, auto&& f) { f(x.path, x.unit); }  // its value is no Real
void fields(Is<WheelTravel> auto& x, auto&& f) { f(x.wheel); }
void fields(Is<WheelToe> auto& x, auto&& f) { f(x.wheel); }
void fields(Is<WheelCamber> auto& x, auto&& f) { f(x.wheel); }
void fields(Is<ProbeCoordinate> auto& x, auto&& f) { f(x.probe, x.axis); }
void fields(Is<Trim::Adjustment> auto& x, auto&& f) { f(x.name, x.what, x.per_unit, x.unit); }
void fields(Is<Trim::Condition> auto& x, auto&& f) { f(x.name, x.what, x.value); }
void fields(Is<Trim> auto& x, auto&& f) { f(x.adjust, x.until, x.line); }
void fields(Is<Omission> auto& x, auto&& f) { f(x.what, x.why); }
void fields(Is<Scene> auto& x, auto&& f) {
    f(x.name, x.source, x.numbers, x.hardpoints, x.bodies, x.joints, x.elastics, x.static_loads,
      x.branches, x.wheels, x.probes, x.dampers, x.vehicle, x.trim, x.omitted);
}
void fields(Is<Constraint> auto& x, auto&& f) { f(x.joint, x.kind); }
void fields(Is<ModelJoint> auto& x, auto&& f) {
    f(x.name, x.i, x.j, x.at, x.driven, x.active_only_where_driven);
}
void fields(Is<Size> auto& x, auto&& f) { f(x.bodies, x.joints, x.elastics, x.rows); }
void fields(Is<Model> auto& x, auto&& f) {
    f(x.name, x.bodies, x.joints, x.constraints, x.elastics, x.static_loads, x.branches, x.wheels,
      x.probes, x.dampers, x.vehicle, x.omitted, x.as_written, x.as_solved);
}

// ---- Members of the kinds, and the names that some of these have.

template <class X, class F>
auto fields(X& x, F&& f) -> decltype(Kind<std::remove_const_t<X>>::members(x, f)) {
    Kind<std::remove_const_t<X>>::members(x, f);
}
template <class T>
void fields(Length<T>& x, auto&& f) {
    f(x.value);
}
template <class T>
void fields(PlaneAngle<T>& x, auto&& f) {
    f(x.value);
}
template <class T>
void fields(ForceAndMoment<T>& x, auto&& f) {
    f(x.value);
}
template <class T>
void fields(Deformation<T>& x, auto&& f) {
    f(x.value);
}
template <class T>
void fields(LoadVector<T>& x, auto&& f) {
    f(x.value);
}
template <class T>
void fields(RotationAxis<T>& x, auto&& f) {
    f(x.direction);
}
template <class T>
void fields(JointIndex<T>& x, auto&& f) {
    f(x.value);
}
template <class T>
void fields(ElasticIndex<T>& x, auto&& f) {
    f(x.value);
}

// ---- Traversal.

template <class T, template <class...> class Template>
inline constexpr bool is_a = false;
template <template <class...> class Template, class... A>
inline constexpr bool is_a<Template<A...>, Template> = true;
template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t n>
inline constexpr bool is_array<std::array<T, n>> = true;

// Makes the alternative `index` of the variant.
template <class V, std::size_t k = 0>
void hold(V& variant, std::size_t index) {
    if (k == index)
        variant.template emplace<k>();
    else if constexpr (k + 1 < std::variant_size_v<V>)
        hold<V, k + 1>(variant, index);
}

// Calls visit.text(std::string&), visit.whole(T&) or visit.number(Real&) for every datum of x. A
// visitor that `writes` sets sizes and alternatives of what it visits.
template <class Visitor, class X>
void each_datum(Visitor& visit, X& x) {
    using T = std::remove_const_t<X>;
    const auto all = [&](auto&&... members) { (each_datum(visit, members), ...); };
    if constexpr (std::is_same_v<T, Real>) {
        visit.number(x);
    } else if constexpr (std::is_same_v<T, std::string>) {
        visit.text(x);
    } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
        visit.whole(x);
    } else if constexpr (std::is_same_v<T, Quaternion>) {
        each_datum(visit, x.coeffs());
    } else if constexpr (std::is_base_of_v<Eigen::PlainObjectBase<T>, T>) {
        for (Eigen::Index k = 0; k < x.size(); ++k) visit.number(x.data()[k]);
    } else if constexpr (is_array<T>) {
        for (auto& entry : x) each_datum(visit, entry);
    } else if constexpr (is_a<T, std::vector>) {
        std::size_t size = x.size();
        visit.whole(size);
        if constexpr (Visitor::writes) x.resize(size);
        for (auto& entry : x) each_datum(visit, entry);
    } else if constexpr (is_a<T, std::optional>) {
        bool exists = x.has_value();
        visit.whole(exists);
        if constexpr (Visitor::writes) x = exists ? T(std::in_place) : T();
        if (exists) each_datum(visit, *x);
    } else if constexpr (is_a<T, std::variant>) {
        std::size_t index = x.index();
        visit.whole(index);
        if constexpr (Visitor::writes) hold(x, index);
        std::visit([&](auto& kind) { each_datum(visit, kind); }, x);
    } else {
        fields(x, all);
    }
}

// ---- Lists of data.

struct Write {
    static constexpr bool writes = false;
    elastocheck_dual::Archive& to;
    void text(const std::string& x) { to.texts.push_back(x); }
    void whole(auto x) { to.wholes.push_back(static_cast<std::int64_t>(x)); }
    void number(const double& x) { to.values.push_back(x); }
    void number(const auto& dual) { to.values.push_back(dual.x), to.rates.push_back(dual.dx); }
};
template <class T>
elastocheck_dual::Archive archive_of(const T& x) {
    elastocheck_dual::Archive result;
    Write write{result};
    each_datum(write, x);
    return result;
}

template <class F>
struct Numbers {
    static constexpr bool writes = false;
    F f;
    void text(const std::string&) {}
    void whole(auto) {}
    void number(Real& x) { f(x); }
};
// Calls f(Real&) for every number of x.
template <class T, class F>
void each_number(T& x, F f) {
    Numbers<F> numbers{f};
    each_datum(numbers, x);
}

// x with these numbers in place of its own. Throws std::invalid_argument unless there are as many.
template <class T>
T with_numbers(T x, const std::vector<double>& numbers) {
    std::size_t next = 0;
    each_number(x, [&](Real& number) {
        if (next < numbers.size()) number = numbers[next];
        ++next;
    });
    if (next != numbers.size()) throw std::invalid_argument("models of different shapes");
    return x;
}
template <class T>
T without_numbers(T x) {  // all zero
    each_number(x, [](Real& number) { number = 0; });
    return x;
}

}  // namespace elastocheck::rates
