// Argument `x` of the formulas of the catalogue: a wheel, spring or damper in a state, with its positions and
// angles, and their rates along the motions of a response.
#pragma once

#include <cmath>
#include <vector>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
#include "compare/outputs/wheel_response.hpp"

namespace elastocheck::compare {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Point of a body: its position, and its vector `lever` from the origin of the body, ground axes [m].
struct PlacedPoint {
    BodyId body;
    Vector3d position, lever;
};

struct Subject {
    const Model& model;
    const Equilibrium* state = nullptr;       // null: the design position (as drawn)
    std::size_t k = 0;                        // position in Model::wheels, elastics or dampers
    const Branch* branch = nullptr;           // needed by wheel loads
    const WheelResponse* response = nullptr;  // needed by characteristics

    // The same part in the design position.
    Subject drawn() const { return {model, nullptr, k}; }
    // Another wheel in the same state.
    Subject other_wheel(std::size_t other) const { return {model, state, other, branch, response}; }

    // ---- Positions and directions in the state, ground axes.
    const Wheel& wheel() const { return model.wheels[k]; }
    double side() const { return wheel().side; }
    const Pose& pose(BodyId body) const {
        static const Pose at_rest;
        if (body == ground) return at_rest;
        const auto b = static_cast<std::size_t>(body);
        return state == nullptr ? model.bodies[b].design : state->poses[b];
    }
    PlacedPoint placed(BodyId body, const Vector3d& s_local) const {
        const Vector3d s = pose(body).p * s_local;
        return {body, pose(body).r + s, s};
    }
    PlacedPoint placed(const Point& p) const { return placed(p.body, p.s_local); }
    Vector3d direction(const Direction& u) const { return pose(u.body).p * u.u_local; }
    const Wrench& wrench(int joint) const {
        return state->reactions[static_cast<std::size_t>(joint)];
    }
    PlacedPoint centre() const { return placed(wheel().body, wheel().centre_local); }
    PlacedPoint patch() const { return placed(wheel().contact); }
    // From the design position.
    Vector3d centre_travel() const { return centre().position - drawn().centre().position; }
    Vector3d patch_travel() const { return patch().position - drawn().patch().position; }
    // The patch as a point of the carrier: while the wheel is braked it turns with the carrier.
    PlacedPoint braked_patch() const {
        if (!wheel().rolls()) return patch();
        const Vector3d p = patch().position;
        return {wheel().body, p, p - pose(wheel().body).r};
    }
    // Spin axis of the wheel, and the axis of the carrier that is lateral in the design position. Both point
    // outboard.
    Vector3d spin() const { return pose(wheel().body).p * wheel().spin_axis_local; }
    Vector3d lateral() const {
        return pose(wheel().body).p *
               (drawn().pose(wheel().body).p.conjugate() * (side() * Vector3d::UnitY()));
    }
    // Horizontal unit vectors across the wheel, outboard, and along it, forward.
    Vector3d across() const {
        const Vector3d e = spin();
        return Vector3d(e.x(), e.y(), 0).normalized();
    }
    Vector3d along() const { return side() * across().cross(Vector3d::UnitZ()); }
    // Lowest point of a circle in the wheel's plane with the radius that the wheel has as drawn.
    Vector3d lowest() const {
        const Vector3d e = spin();
        const double radius = drawn_arm(model, wheel()).norm();
        return centre().position + radius * (e * e.z() - Vector3d::UnitZ()).normalized();
    }

    // Vector of the steering axis from its lower to its upper end; horizontal vector from a point to the axis.
    Vector3d axis() const {
        const auto& [lower, upper] = *wheel().steering_axis;
        return placed(upper).position - placed(lower).position;
    }
    Vector3d axis_from(const PlacedPoint& point) const {
        const Vector3d p = point.position, u = axis(),
                       lower = placed(wheel().steering_axis->lower).position;
        return lower + u * ((p.z() - lower.z()) / u.z()) - p;
    }

    double toe() const {
        const Vector3d e = spin();
        return std::atan2(e.x(), side() * e.y());
    }
    double camber() const { return -std::asin(spin().z()); }
    double caster() const {
        const Vector3d u = axis();
        return std::atan(-u.x() / u.z());
    }
    double kingpin() const {
        const Vector3d u = axis();
        return std::atan(-side() * u.y() / u.z());
    }

    // ---- Rates along a motion: derivatives of toe and camber, rotation of the carrier, displacement of a point.
    double toe(const Motions& motions) const {
        const Vector3d e = spin(), de = turned(motions, wheel().body).cross(e);
        const double x = side() * e.y(), dx = side() * de.y();
        return (x * de.x() - e.x() * dx) / (x * x + e.x() * e.x());
    }
    double camber(const Motions& motions) const {
        const Vector3d e = spin(), de = turned(motions, wheel().body).cross(e);
        return -(de.z() / std::sqrt(1 - e.z() * e.z()));
    }
    Vector3d rotation(const Motions& motions) const { return turned(motions, wheel().body); }
    static Vector3d displacement(const Motions& motions, const PlacedPoint& point) {
        if (point.body == ground) return Vector3d::Zero();
        const auto& body = motions[static_cast<std::size_t>(point.body)];
        return body.dr + body.dpi.cross(point.lever);
    }
};

// Beyond these limits the denominator is round-off: an arm is infinite, a joint is rigid.
inline constexpr double max_distance = 1e4;    // [m]
inline constexpr double max_stiffness = 1e12;  // [N/m]

// value / divisor; `undefined` beyond the limit, NaN if either is.
inline double ratio(double value, double divisor, double limit) {
    if (std::isnan(value) || std::isnan(divisor)) return nan;
    return std::abs(value) <= limit * std::abs(divisor) && divisor != 0 ? value / divisor
                                                                        : undefined;
}

inline constexpr auto not_steered = "the steering is not driven or held on this branch";

// One left and one right wheel.
inline bool is_axle(const Model& model) {
    return model.wheels.size() == 2 && model.wheels[0].side * model.wheels[1].side < 0;
}
// Position of the left wheel of an axle in Model::wheels.
inline std::size_t left_wheel(const Model& model) { return model.wheels[0].side > 0 ? 0 : 1; }

// "ground axis x, positive forward"
std::string axis_words(int axis);

// ---- The parts of the catalogue, in its order.
void add_angles(std::vector<Entry>& all);  // angles.cpp
void add_rates(std::vector<Entry>& all);   // rates.cpp
void add_roll(std::vector<Entry>& all);    // roll.cpp, called by add_rates
// Entries by other definitions than the project's own:
void add_angle_definitions(std::vector<Entry>& all);  // angles.cpp
void add_rate_definitions(std::vector<Entry>& all);   // rates.cpp
void add_roll_definitions(std::vector<Entry>& all);   // roll.cpp, called by add_rate_definitions
// force_tests.cpp, called by both of rates.cpp. `alone`: only the tests of an axle with a load on one
// wheel; else all others.
void add_force_tests(std::vector<Entry>& all, bool alone);

}  // namespace elastocheck::compare
