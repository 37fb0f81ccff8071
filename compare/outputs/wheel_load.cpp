#include "compare/outputs/wheel_load.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "compare/outputs/deformation.hpp"
#include "compare/outputs/fixed_bodies.hpp"
#include "compare/outputs/positions.hpp"
#include "compare/outputs/wheel_response.hpp"
#include "elastocheck/channels.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

// Distance [m] in the design position of a point from the nearer of a wheel's centre and patch on the
// same body, or on one fixed to it; infinite if neither is.
struct WheelDistance {
    const Model& model;
    FixedBodies fixed{model};

    double operator()(const Wheel& wheel, const Point& point) const {
        double least = std::numeric_limits<double>::infinity();
        for (const Point& own : {Point{wheel.body, wheel.centre_local}, wheel.contact})
            if (fixed.are_one(own.body, point.body))
                least = std::min(least, (drawn(model, own) - drawn(model, point)).norm());
        return least;
    }
};

}  // namespace

std::optional<std::size_t> wheel_near(const Model& model, const Point& point) {
    const WheelDistance distance{model};
    std::optional<std::size_t> found;
    for (std::size_t w = 0; w < model.wheels.size(); ++w)
        if (const double here = distance(model.wheels[w], point);
            std::isfinite(here) && (!found || here < distance(model.wheels[*found], point)))
            found = w;
    return found;
}

std::optional<std::size_t> wheel_at(const Model& model, const Point& point) {
    constexpr double same_point = 1e-6;  // [m]
    const auto wheel = wheel_near(model, point);
    return wheel && WheelDistance{model}(model.wheels[*wheel], point) < same_point ? wheel
                                                                                   : std::nullopt;
}

std::optional<std::size_t> wheel_on_jack(const Model& model, int joint) {
    const ModelJoint& j = model.joints[static_cast<std::size_t>(joint)];
    if (!j.active_only_where_driven || j.j != ground) return std::nullopt;
    return wheel_at(model, j.at);
}

std::optional<std::size_t> wheel_on_tyre(const Model& model, int elastic) {
    const Elastic& e = model.elastics[static_cast<std::size_t>(elastic)];
    if (e.written_as != WrittenAs::tyre) return std::nullopt;
    const Marker& on = std::get<Bushing>(e.kind).j;
    return wheel_at(model, {on.body, on.s_local});
}

double wheel_load(const Model& model, const Branch& branch, const Equilibrium& state,
                  std::size_t wheel) {
    double road = 0;
    const WheelDistance distance{model};
    const auto add = [&](const LoadKind& load, double factor) {
        if (is_moment(load)) return;
        const Point& point = *member<Point>(load);
        if (!std::isfinite(distance(model.wheels[wheel], point))) return;
        const double up = load_vector(load).z();
        const auto at = wheel_at(model, point);
        if (is_follower(load) || (!at && up != 0))
            road = undefined;
        else if (at == wheel)
            road += factor * up;
    };
    for (const auto& load : model.static_loads)
        if (!load.name.starts_with("gravity.")) add(load.kind, 1);
    std::set<int> joints, elements;
    for (const auto& driver : branch.drivers) {
        if (const Load* load = driven_load(driver.what))
            add(load->kind, driver.start + driver.rate * state.load);
        else if (const int joint = driven_joint(driver.what); joint >= 0)
            joints.insert(joint);
        else if (const int element = driven_element(driver.what); element >= 0)
            elements.insert(element);
    }
    for (const int k : joints)
        if (wheel_on_jack(model, k) == wheel) {
            const Channel effort{.name = "", .reads = Effort{k}};
            road += evaluate(model, {&effort, 1}, state).front() / in_unit(effort.unit);
        }
    // the tyre pulls the wheel, its body j, back by s
    for (const int k : elements)
        if (wheel_on_tyre(model, k) == wheel) {
            const auto e = static_cast<std::size_t>(k);
            const ElasticKind& tyre = model.elastics[e].kind;
            road -=
                force_with_preload(tyre, e, branch, state, deformation(tyre, e, branch, state)).z();
        }
    return road;
}

bool is_jack(const Model& model, std::size_t joint) {
    return wheel_on_jack(model, static_cast<int>(joint)) &&
           std::ranges::any_of(model.constraints, [&](const Constraint& c) {
               return c.joint == static_cast<int>(joint) &&
                      std::holds_alternative<PointInPlane>(c.kind);
           });
}

bool drives_an_angle(const Model& model, int joint) {
    const int driven = model.joints[static_cast<std::size_t>(joint)].driven;
    return driven >= 0 && is_angle(model.constraints[static_cast<std::size_t>(driven)].kind);
}

int steering_joint(const Model& model) {
    int steering = -1;
    for (const auto& branch : model.branches) {
        for (const auto& driver : branch.drivers)
            if (const int joint = driven_joint(driver.what);
                joint >= 0 && driver.rate != 0 &&
                !is_jack(model, static_cast<std::size_t>(joint)) &&
                (steering < 0 ||
                 (drives_an_angle(model, steering) && !drives_an_angle(model, joint))))
                steering = joint;
        if (steering >= 0) break;
    }
    return steering;
}

double rack_per_hand_wheel(const Model& model) {
    const int rack = steering_joint(model);
    if (rack < 0 || drives_an_angle(model, rack)) return 0;
    for (const auto& branch : model.branches)
        for (const auto& driver : branch.drivers)
            if (branch.unit == ParameterUnit::radian && driver.rate != 0 &&
                driven_joint(driver.what) == rack)
                return driver.rate;
    return 0;
}

}  // namespace elastocheck::compare
