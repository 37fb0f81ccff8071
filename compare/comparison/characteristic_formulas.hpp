// Formulas of the characteristics: motions of the wheels by a response, and what is read from them.
// For characteristics.cpp and for other definitions of the same figures
// (compare/definitions/rates.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/comparison/compliance.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
#include "elastocheck/channels.hpp"

namespace elastocheck::compare::characteristic {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Arms and centres farther than this are at infinity, and joints stiffer than this are rigid:
// beyond, the quotient is round-off of a part that does not rotate or deform.
inline constexpr double nowhere = 1e4;  // [m]
inline constexpr double rigid = 1e12;   // [N/m]

inline double ratio(double value, double by, double limit) {
    if (std::isnan(value) || std::isnan(by)) return nan;
    return std::abs(value) <= limit * std::abs(by) && by != 0 ? value / by : undefined;
}

// ---- Motions of a wheel.

// A point or direction of a body: where it is, and from the origin of its body.
struct Placed {
    BodyId body;
    Vector3d at, lever;
};

struct Wheels {
    const Model& model;
    const Equilibrium& state;
    const WheelResponse& response;

    const Wheel& operator[](std::size_t w) const { return model.wheels[w]; }
    Placed placed(BodyId body, const Vector3d& s_local) const {
        const Pose& on = pose(state.poses, body);
        const Vector3d s = on.p * s_local;
        return {body, on.r + s, s};
    }
    Placed centre(std::size_t w) const {
        return placed(model.wheels[w].body, model.wheels[w].centre_local);
    }
    Placed patch(std::size_t w) const { return point(model.wheels[w].contact); }
    // The patch as a point of the carrier, to which the brake holds the wheel.
    Placed braked(std::size_t w) const {
        const Wheel& wheel = model.wheels[w];
        if (!wheel.rolls()) return patch(w);
        const Vector3d at = patch(w).at;
        return {wheel.body, at, at - pose(state.poses, wheel.body).r};
    }
    Placed point(const Point& p) const { return placed(p.body, p.s_local); }
    double side(std::size_t w) const { return model.wheels[w].side; }
    Vector3d spin(std::size_t w) const {
        return placed(model.wheels[w].body, model.wheels[w].spin_axis_local).lever;
    }

    // Rates along a motion of the channels toe and camber: atan2(e_x, side e_y), -asin(e_z).
    double toe(std::size_t w, const Motions& motions) const {
        const Vector3d e = spin(w), de = turned_by(motions, model.wheels[w].body).cross(e);
        const double x = double(side(w)) * e.y(), dx = double(side(w)) * de.y();
        return (x * de.x() - e.x() * dx) / (x * x + e.x() * e.x());
    }
    double camber(std::size_t w, const Motions& motions) const {
        using std::sqrt;
        const Vector3d e = spin(w), de = turned_by(motions, model.wheels[w].body).cross(e);
        return -(de.z() / sqrt(1 - e.z() * e.z()));
    }

    static Vector3d turned_by(const Motions& motions, BodyId body) {
        if (body == ground) return Vector3d::Constant(0);
        return motions[static_cast<std::size_t>(body)].dpi;
    }
    static Vector3d moved_by(const Motions& motions, const Placed& point) {
        if (point.body == ground) return Vector3d::Constant(0);
        const auto& body = motions[static_cast<std::size_t>(point.body)];
        return body.dr + body.dpi.cross(point.lever);
    }
};

// Weighted sum of several causes.
inline Motions sum(const std::vector<Motions>& all, const std::vector<double>& weights) {
    Motions total(all.front().size());
    for (std::size_t k = 0; k < all.size(); ++k)
        for (std::size_t b = 0; b < total.size(); ++b) {
            total[b].dr += weights[k] * all[k][b].dr;
            total[b].dpi += weights[k] * all[k][b].dpi;
        }
    return total;
}

// Heave: all wheels raised by 1 m; with tied wheels, their common motion scaled so that this wheel
// rises by 1 m. Roll: the wheels of an axle in opposition, the left up; not for tied wheels.
inline Motions raised(const Wheels& wheels, std::size_t w) {
    const auto& first = wheels.response.travel.front();
    const double whole =
        wheels.response.tied ? 1 / wheels.moved_by(first, wheels.centre(w)).z() : 1;
    return sum(wheels.response.travel, std::vector<double>(wheels.response.travel.size(), whole));
}
inline Motions rolled(const Wheels& wheels) {
    std::vector<double> weights;
    for (const auto& wheel : wheels.model.wheels) weights.push_back(wheel.side);
    return sum(wheels.response.travel, weights);
}

// One left and one right wheel.
inline bool is_axle(const Model& model) {
    return model.wheels.size() == 2 && model.wheels[0].side * model.wheels[1].side < 0;
}

// ---- Centres and axes.

// The solution of A P = b, of coincident lines the nearest; none of parallel ones.
inline std::optional<Vector2d> crossing(const Eigen::Matrix2d& A, const Vector2d& b, double track) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix2d> lines;
    lines.setThreshold(1e-9);
    lines.compute(A);
    const Vector2d P = lines.solve(b);
    if ((A * P - b).norm() > 1e-9 * track || !(P.norm() <= nowhere)) return std::nullopt;
    return P;
}
// Instant centre in front view: the patch of a wheel moves perpendicularly to the line through its
// instant centre. The roll centre lies on that line: for an axle in roll at the intersection of
// both lines; for one wheel at the middle of the vehicle, y = 0.
//
//   (P - c) · (dy, dz) = 0      h = P_z - c_z
//
// Two coincident lines (arms that guide the wheels vertically) meet halfway between the wheels.
//
// `point`: of each wheel, the patch; its motion and its place are those of the line.
inline double roll_centre(const Wheels& wheels, Placed (Wheels::*point)(std::size_t) const) {
    using std::abs;
    using Plane = Vector2d;
    const auto seen = [](const Vector3d& v) { return Plane(v.y(), v.z()); };
    if (!is_axle(wheels.model)) {
        const Placed of = (wheels.*point)(0);
        const Vector3d d = wheels.moved_by(wheels.response.travel[0], of);
        return ratio(of.at.y() * d.y(), d.z(), nowhere) + of.at.z() - wheels.patch(0).at.z();
    }
    if (wheels.response.tied) return undefined;
    const Motions roll = rolled(wheels);
    Eigen::Matrix2d A;
    Plane c[2], b;
    double above = 0;  // the road
    for (std::size_t w = 0; w < 2; ++w) {
        const Placed of = (wheels.*point)(w);
        c[w] = seen(of.at);
        above += (of.at.z() - wheels.patch(w).at.z()) / 2;
        A.row(static_cast<Eigen::Index>(w)) =
            seen(wheels.moved_by(roll, of)).normalized().transpose();
    }
    const Plane middle = (c[0] + c[1]) / 2;
    for (int w = 0; w < 2; ++w) b[w] = A.row(w).dot(c[w] - middle);
    const auto P = crossing(A, b, double(abs(c[0].x() - c[1].x())));
    return P ? P->y() + above : undefined;
}

// Instant centre of the carrier in side and front view, from the wheel centre, with velocity v and
// rate ω:
//   from the side   (x, z): (v_z, -v_x) / ω_y      from the front   (y, z): (-v_z, v_y) / ω_x

// Virtual steering axis: screw axis of the carrier when the rack moves at constant wheel-centre
// height. n upward, through  c + ω × v / ω².
struct Axis {
    Vector3d n, through;
};
inline std::optional<Axis> steering_axis(const Wheels& wheels, std::size_t w) {
    using std::abs;
    if (wheels.response.steering.empty()) return std::nullopt;
    const Vector3d omega = wheels.turned_by(wheels.response.steering, wheels[w].body),
                   v = wheels.moved_by(wheels.response.steering, wheels.centre(w));
    const double rate = omega.norm();
    if (!(v.norm() <= nowhere * rate) || !(abs(omega.z()) > 1e-6 * rate)) return std::nullopt;
    return Axis{omega.normalized() * double(omega.z() > 0 ? 1 : -1),
                wheels.centre(w).at + omega.cross(v) / omega.squaredNorm()};
}
// Vector from the patch to the intersection of the axis with the road.
inline Vector3d on_the_road(const Wheels& wheels, std::size_t w, const Axis& axis) {
    const Vector3d patch = wheels.patch(w).at;
    return axis.through + axis.n * ((patch.z() - axis.through.z()) / axis.n.z()) - patch;
}
// Unit vectors in the road plane that follow the steered wheel: across it outwards, and along it
// forwards.
inline Vector3d across(const Wheels& wheels, std::size_t w) {
    const Vector3d e = wheels.spin(w);
    return Vector3d(e.x(), e.y(), 0).normalized();
}
inline Vector3d along(const Wheels& wheels, std::size_t w) {
    return wheels.side(w) * across(wheels, w).cross(Vector3d(0, 0, 1));
}

// Body roll by 1 rad towards this wheel of an axle, the wheels on the road: this wheel rises by
// half the track, the other one goes down by as much.
inline Motions rolled_towards(const Wheels& wheels, std::size_t w) {
    using std::abs;
    Motions roll = rolled(wheels);
    const double half =
        double(abs(wheels.patch(0).at.y() - wheels.patch(1).at.y())) / 2 * wheels.side(w);
    for (auto& motion : roll) motion.dr *= half, motion.dpi *= half;
    return roll;
}

// ---- Stiffness and rates.

// 1 N up on the patch of every wheel; or on an axle in opposition, this wheel's up; model `free`.
enum class Pattern { alike, opposite };
inline double wheel_rate(const Wheels& wheels, std::size_t w, Pattern pattern) {
    if (wheels.response.free.empty()) return wheels.response.nothing_resists ? undefined : nan;
    std::vector<Motions> up;
    std::vector<double> weights;
    for (std::size_t k = 0; k < wheels.response.free.size(); ++k) {
        up.push_back(wheels.response.free[k][at_patch + 2]);
        weights.push_back(double(pattern == Pattern::alike || k == w ? 1 : -1));
    }
    return ratio(1, wheels.moved_by(sum(up, weights), wheels.centre(w)).z(), rigid);
}
inline double ride_rate(const Wheels& wheels, std::size_t w) {
    const double k_w = wheel_rate(wheels, w, Pattern::alike), k_t = wheels[w].tyre_rate;
    return std::isinf(k_w) ? undefined : k_w * k_t / (k_w + k_t);
}

// Sign towards the middle of the vehicle, for equal values of a wheel and its mirror image; at the
// patch, wheels held.
inline double inward(const Wheels& wheels, std::size_t w) { return -wheels.side(w); }

inline const Motions& held(const Wheels& wheels, std::size_t w, int cause) {
    return wheels.response.held[w][static_cast<std::size_t>(cause)];
}

// Longitudinal displacement of a point per wheel travel, all wheels raised together: tangent of the
// angle at which the links, not the springs, carry a longitudinal force.
inline double forward_per_travel(const Wheels& wheels, const Placed& at) {
    const Vector3d d = wheels.moved_by(raised(wheels, 0), at);
    return ratio(d.x(), d.z(), nowhere);
}
// Point at which a driving force acts on the links: the patch where an axle housing carries the
// drive torque, the wheel centre where the car body carries it through a shaft.
inline Placed driven_at(const Wheels& wheels, std::size_t w) {
    const bool housing = is_axle(wheels.model) && wheels[0].body == wheels[1].body;
    return housing ? wheels.braked(w) : wheels.centre(w);
}
// Milliken & Milliken, Race Car Vehicle Dynamics, 1995, ch. 17: axle share · tan
// φ · wheelbase / height of the centre of gravity.
inline double anti(const Wheels& wheels, const Placed& at, double Vehicle::*share, double sign) {
    const Vehicle& vehicle = *wheels.model.vehicle;
    return sign * vehicle.*share * forward_per_travel(wheels, at) * vehicle.wheelbase /
           vehicle.cg_height;
}

inline double steer_gradient(const Wheels& wheels, std::size_t w) {
    return wheels.response.steering.empty() ? undefined : wheels.toe(w, wheels.response.steering);
}

inline double shortening(const Wheels& wheels, const Placed& i, const Placed& j) {
    const Motions motions = raised(wheels, 0);
    const Vector3d D = j.at - i.at, dD = wheels.moved_by(motions, j) - wheels.moved_by(motions, i);
    return -(D.dot(dD) / D.norm());
}

// ---- Entries of a catalogue: owner, name, unit, definition with its sign, meaning of undefined,
// formula.

// Owner of a characteristic; those after the wheels only where a scene has what they need.
enum class Owner {
    every_wheel,
    wheel_on_tyre,
    steered_wheel,    // some branch drives a joint other than a jack, ...
    wheel_on_rack,    // ... a translation
    wheel_on_column,  // ... a rotation
    front_wheel,      // of a scene with a `vehicle`
    rear_wheel,
    wheel_of_axle,       // one of a left and a right one
    wheel_without_axle,  // of another scene
    wheels,              // all wheels together
    axle,                // both wheels of an axle together
    spring,
    damper,
};

// A formula; k: wheel, or spring in Model::elastics, or damper; SI.
using Formula = std::function<double(const Wheels& wheels, std::size_t k)>;

struct Entry {
    Owner of;
    std::string name;
    Unit unit;
    std::string definition;
    const char* undefined;
    Formula formula;
    bool swing_arm = false;
    bool reads_free = false;   // WheelResponse::free, beside every rate in N/mm and on tyres
    const char* used_by = "";  // of another definition: where it is found; names for it elsewhere
};

// The figures of characteristics() by other definitions, "wheel_rate@patch".
std::span<const Entry> by_other_definitions();

// Those of characteristics(), of which the tests of an axle have an "@" too, then the others.
struct Catalogue {
    std::vector<Entry> entries{};
    std::size_t own = 0;
};
const Catalogue& catalogue();

inline constexpr const char* never = "";
inline constexpr const char* no_vertical = "the wheel does not rise";
inline constexpr const char* does_not_steer =
    "the steering does not turn the wheel about an upright axis here";
inline constexpr const char* gives_nothing = "rigid: nothing gives";
inline constexpr const char* not_steered = "the steering is not driven or held on this branch";
inline constexpr const char* does_not_roll =
    "its wheels move only together: the axle does not roll";
inline constexpr const char* no_rate =
    "the travel of the wheel is unresisted or blocked, or an element is at a kink of its law";

}  // namespace elastocheck::compare::characteristic
