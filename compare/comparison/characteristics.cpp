#include "compare/comparison/characteristics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
#include "compare/outputs/rates.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Arms and centres farther than this are at infinity, and joints stiffer than this are rigid:
// beyond, the quotient is round-off of a part that does not rotate or deform.
constexpr double nowhere = 1e4;  // [m]
constexpr double rigid = 1e12;   // [N/m]

double ratio(double value, double by, double limit) {
    if (std::isnan(value) || std::isnan(by)) return nan;
    return std::abs(value) <= limit * std::abs(by) && by != 0 ? value / by : undefined;
}

// ---- Motions of a wheel.

struct Wheels {
    const Model& model;
    const Equilibrium& state;
    const WheelResponse& response;
    const Wheel& operator[](std::size_t w) const { return model.wheels[w]; }
    Point centre(std::size_t w) const {
        return {model.wheels[w].body, model.wheels[w].centre_local};
    }
    Point patch(std::size_t w) const {
        return {model.wheels[w].body, model.wheels[w].contact_local};
    }
    Vector3d at(const Point& point) const { return position(state.poses, point); }
    double side(std::size_t w) const { return model.wheels[w].side; }

    double toe(std::size_t w, const Motions& by) const { return rate_of(model, Toe{w}, state, by); }
    double camber(std::size_t w, const Motions& by) const {
        return rate_of(model, Camber{w}, state, by);
    }
    Vector3d spin(std::size_t w) const {
        return pose(state.poses, model.wheels[w].body).p * model.wheels[w].spin_axis_local;
    }
};

// Weighted sum of several causes.
Motions sum(std::span<const Motions> causes, std::span<const double> weights) {
    Motions total(causes.front().size());
    for (std::size_t k = 0; k < causes.size(); ++k)
        for (std::size_t b = 0; b < total.size(); ++b) {
            total[b].dr += weights[k] * causes[k][b].dr;
            total[b].dpi += weights[k] * causes[k][b].dpi;
        }
    return total;
}

// Heave: all wheels raised by 1 m; with tied wheels, their common motion scaled so that this wheel
// rises by 1 m. Roll: the wheels of an axle in opposition, the left up; not for tied wheels.
Motions raised(const Wheels& wheels, std::size_t w) {
    const auto& first = wheels.response.travel.front();
    const double whole =
        wheels.response.tied ? 1 / moved(wheels.state, first, wheels.centre(w)).z() : 1;
    return sum(wheels.response.travel, std::vector<double>(wheels.response.travel.size(), whole));
}
Motions rolled(const Wheels& wheels) {
    std::vector<double> weights;
    for (const auto& wheel : wheels.model.wheels) weights.push_back(wheel.side);
    return sum(wheels.response.travel, weights);
}

// One left and one right wheel.
bool is_axle(const Model& model) {
    return model.wheels.size() == 2 && model.wheels[0].side * model.wheels[1].side < 0;
}

// ---- Centres and axes.

// Instant centre in front view: the patch of a wheel moves perpendicularly to the line through its
// instant centre. The roll centre lies on that line: for an axle in roll at the intersection of
// both lines; for one wheel at the middle of the vehicle, y = 0.
//
//   (P - c) · (dy, dz) = 0      h = P_z - c_z
//
// Two coincident lines (arms that guide the wheels vertically) meet halfway between the wheels.
double roll_centre(const Wheels& wheels) {
    const auto seen = [](const Vector3d& v) { return Vector2d(v.y(), v.z()); };
    if (!is_axle(wheels.model)) {
        const Point patch = wheels.patch(0);
        const Vector3d d = moved(wheels.state, wheels.response.travel[0], patch);
        return ratio(wheels.at(patch).y() * d.y(), d.z(), nowhere);
    }
    if (wheels.response.tied) return undefined;
    const Motions roll = rolled(wheels);
    Eigen::Matrix2d A;
    Vector2d c[2], b;
    for (std::size_t w = 0; w < 2; ++w) {
        c[w] = seen(wheels.at(wheels.patch(w)));
        A.row(static_cast<Eigen::Index>(w)) =
            seen(moved(wheels.state, roll, wheels.patch(w))).normalized().transpose();
    }
    const Vector2d middle = (c[0] + c[1]) / 2;
    for (int w = 0; w < 2; ++w) b[w] = A.row(w).dot(c[w] - middle);
    Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix2d> lines;
    lines.setThreshold(1e-9);
    lines.compute(A);
    const Vector2d P = lines.solve(b);
    const double track = std::abs(c[0].x() - c[1].x());
    if ((A * P - b).norm() > 1e-9 * track || !(P.norm() <= nowhere)) return undefined;
    return P.y();
}

// Instant centre of the carrier in side and front view, from the wheel centre, with velocity v and
// rate ω:
//   from the side   (x, z): (v_z, -v_x) / ω_y      from the front   (y, z): (-v_z, v_y) / ω_x

// Virtual steering axis: screw axis of the carrier when the rack moves at constant wheel-centre
// height. n upward, through  c + ω × v / ω².
struct Axis {
    Vector3d n, through;
};
std::optional<Axis> steering_axis(const Wheels& wheels, std::size_t w) {
    if (wheels.response.steering.empty()) return std::nullopt;
    const Vector3d omega = turned(wheels.response.steering, wheels[w].body),
                   v = moved(wheels.state, wheels.response.steering, wheels.centre(w));
    if (!(v.norm() <= nowhere * omega.norm()) || !(std::abs(omega.z()) > 1e-6 * omega.norm()))
        return std::nullopt;
    return Axis{omega.normalized() * (omega.z() > 0 ? 1 : -1),
                wheels.at(wheels.centre(w)) + omega.cross(v) / omega.squaredNorm()};
}
// Vector from the patch to the intersection of the axis with the road.
Vector3d on_the_road(const Wheels& wheels, std::size_t w, const Axis& axis) {
    const Vector3d patch = wheels.at(wheels.patch(w));
    return axis.through + axis.n * (patch.z() - axis.through.z()) / axis.n.z() - patch;
}
// Unit vectors in the road plane that follow the steered wheel: across it outwards, and along it
// forwards.
Vector3d across(const Wheels& wheels, std::size_t w) {
    const Vector3d e = wheels.spin(w);
    return Vector3d(e.x(), e.y(), 0).normalized();
}
Vector3d along(const Wheels& wheels, std::size_t w) {
    return wheels.side(w) * across(wheels, w).cross(Vector3d::UnitZ());
}

// Body roll by 1 rad towards this wheel of an axle, the wheels on the road: this wheel rises by
// half the track, the other one goes down by as much.
Motions rolled_towards(const Wheels& wheels, std::size_t w) {
    Motions roll = rolled(wheels);
    const double half = std::abs(wheels.at(wheels.patch(0)).y() - wheels.at(wheels.patch(1)).y()) /
                        2 * wheels.side(w);
    for (auto& motion : roll) motion.dr *= half, motion.dpi *= half;
    return roll;
}

// ---- Stiffness and rates.

// 1 N up on the patch of every wheel; or on an axle in opposition, this wheel's up; model `free`.
enum class Pattern { alike, opposite };
double wheel_rate(const Wheels& wheels, std::size_t w, Pattern pattern) {
    if (wheels.response.free.empty()) return wheels.response.nothing_resists ? undefined : nan;
    std::vector<Motions> up;
    std::vector<double> weights;
    for (std::size_t k = 0; k < wheels.response.free.size(); ++k) {
        up.push_back(wheels.response.free[k][at_patch + 2]);
        weights.push_back(pattern == Pattern::alike || k == w ? 1 : -1);
    }
    return ratio(1, moved(wheels.state, sum(up, weights), wheels.centre(w)).z(), rigid);
}
double ride_rate(const Wheels& wheels, std::size_t w) {
    const double k_w = wheel_rate(wheels, w, Pattern::alike), k_t = wheels[w].tyre_rate;
    return std::isinf(k_w) ? undefined : k_w * k_t / (k_w + k_t);
}

// Sign towards the middle of the vehicle, for equal values of a wheel and its mirror image; at the
// patch, wheels held.
double inward(const Wheels& wheels, std::size_t w) { return -wheels.side(w); }

const Motions& held(const Wheels& wheels, std::size_t w, int cause) {
    return wheels.response.held[w][static_cast<std::size_t>(cause)];
}

// The displacement of the loaded point along the load is a compliance.
double stiffness(const Wheels& wheels, std::size_t w, int cause) {
    const Point at = cause < moment_on ? wheels.centre(w) : wheels.patch(w);
    return ratio(1, moved(wheels.state, held(wheels, w, cause), at)[cause % 3], rigid);
}

// Longitudinal displacement of a point per wheel travel, all wheels raised together: tangent of the
// angle at which the links, not the springs, carry a longitudinal force.
double forward_per_travel(const Wheels& wheels, const Point& at) {
    const Vector3d d = moved(wheels.state, raised(wheels, 0), at);
    return ratio(d.x(), d.z(), nowhere);
}
// Point at which a driving force acts on the links: the patch where an axle housing carries the
// drive torque, the wheel centre where the car body carries it through a shaft.
Point driven_at(const Wheels& wheels, std::size_t w) {
    const bool housing = is_axle(wheels.model) && wheels[0].body == wheels[1].body;
    return housing ? wheels.patch(w) : wheels.centre(w);
}
// Milliken & Milliken, Race Car Vehicle Dynamics, 1995, ch. 17: axle share · tan
// φ · wheelbase / height of the centre of gravity.
double anti(const Wheels& wheels, const Point& at, double share, double sign) {
    const Vehicle& vehicle = *wheels.model.vehicle;
    return sign * share * forward_per_travel(wheels, at) * vehicle.wheelbase / vehicle.cg_height;
}

double steer_gradient(const Wheels& wheels, std::size_t w) {
    return wheels.response.steering.empty() ? undefined : wheels.toe(w, wheels.response.steering);
}

double shortening(const Wheels& wheels, const Point& i, const Point& j) {
    return rate_of(wheels.model, Compression{i, j}, wheels.state, raised(wheels, 0));
}

// ---- Catalogue: owner, name, unit, definition with its sign, meaning of undefined, formula.

// Owner of a characteristic; those after the wheels only where a scene has what they need.
enum class Of {
    every_wheel,
    wheel_on_tyre,
    steered_wheel,    // some branch drives a joint other than a jack, ...
    wheel_on_rack,    // ... a translation
    wheel_on_column,  // ... a rotation
    front_wheel,      // of a scene with a `vehicle`
    rear_wheel,
    wheel_of_axle,  // one of a left and a right one
    wheels,         // all wheels together
    spring,
    damper,
};

struct Entry {
    Of of;
    const char* name;
    Unit unit;
    const char* definition;
    const char* undefined;
    double (*formula)(const Wheels& wheels,
                      std::size_t k);  // k: wheel, or spring in Model::elastics, or damper; SI
    bool swing_arm = false;
};

constexpr const char* never = "";
constexpr const char* no_vertical = "the wheel does not rise";
constexpr const char* does_not_steer =
    "the steering does not turn the wheel about an upright axis here";
constexpr const char* gives_nothing = "rigid: nothing gives";
constexpr const char* not_steered = "the steering is not driven or held on this branch";
constexpr const char* does_not_roll = "its wheels move only together: the axle does not roll";
constexpr const char* no_rate =
    "the travel of the wheel is unresisted or blocked, or an element is at a kink of its law";

const std::array table{
    Entry{Of::every_wheel, "bump_steer", Unit::deg_per_m,
          "change of toe over travel of the wheel centre, all wheels rising by the same amount; "
          "positive towards toe-in in jounce",
          never, [](const Wheels& x, std::size_t w) { return x.toe(w, raised(x, w)); }},
    Entry{Of::every_wheel, "bump_camber", Unit::deg_per_100mm,
          "change of camber over travel of the wheel centre, all wheels rising by the same amount; "
          "positive where the top leans out in jounce",
          never, [](const Wheels& x, std::size_t w) { return x.camber(w, raised(x, w)); }},
    Entry{Of::every_wheel, "track_gradient", Unit::mm_per_100mm,
          "lateral displacement of the contact patch over travel, all wheels rising by the same "
          "amount; positive outwards in jounce",
          never,
          [](const Wheels& x, std::size_t w) {
              return x.side(w) * moved(x.state, raised(x, w), x.patch(w)).y();
          }},
    Entry{Of::every_wheel, "recession_gradient", Unit::mm_per_100mm,
          "longitudinal displacement of the wheel centre over travel, all wheels rising by the "
          "same amount; positive to the back in jounce",
          never,
          [](const Wheels& x, std::size_t w) {
              return -moved(x.state, raised(x, w), x.centre(w)).x();
          }},
    Entry{Of::every_wheel, "front_view_swing_arm", Unit::mm,
          "lateral distance from the wheel centre to the instant centre of the carrier seen from "
          "the front, all wheels rising by the same amount; positive inboard",
          "the carrier does not rotate as seen from the front: the arm is infinite",
          [](const Wheels& x, std::size_t w) {
              const Motions by = raised(x, w);
              const Vector3d v = moved(x.state, by, x.centre(w));
              return ratio(x.side(w) * v.z(), turned(by, x[w].body).x(), nowhere);
          },
          true},
    Entry{Of::every_wheel, "side_view_swing_arm", Unit::mm,
          "longitudinal distance from the wheel centre to the instant centre of the carrier seen "
          "from the side, all wheels rising by the same amount; positive ahead of the wheel",
          "the carrier does not rotate as seen from the side: the arm is infinite",
          [](const Wheels& x, std::size_t w) {
              const Motions by = raised(x, w);
              const Vector3d v = moved(x.state, by, x.centre(w));
              return ratio(v.z(), turned(by, x[w].body).y(), nowhere);
          },
          true},
    Entry{Of::every_wheel, "wheel_rate", Unit::newton_per_mm,
          "vertical force at the contact patch over vertical displacement of the wheel centre, all "
          "wheels with the same load",
          no_rate, [](const Wheels& x, std::size_t w) { return wheel_rate(x, w, Pattern::alike); }},
    Entry{Of::every_wheel, "lateral_force_steer", Unit::deg_per_kN,
          "change of toe over a force at the contact patch towards the middle of the vehicle (as "
          "on the "
          "outer wheel in a "
          "turn), wheel centres held at their height; positive towards toe-in",
          never,
          [](const Wheels& x, std::size_t w) {
              return inward(x, w) * x.toe(w, held(x, w, at_patch + 1));
          }},
    Entry{Of::every_wheel, "lateral_force_camber", Unit::deg_per_kN,
          "change of camber over the same force, likewise; positive where the top leans out", never,
          [](const Wheels& x, std::size_t w) {
              return inward(x, w) * x.camber(w, held(x, w, at_patch + 1));
          }},
    Entry{Of::every_wheel, "lateral_stiffness", Unit::newton_per_mm,
          "lateral force at the contact patch over its lateral displacement, wheel centres held at "
          "their "
          "height",
          gives_nothing,
          [](const Wheels& x, std::size_t w) { return stiffness(x, w, at_patch + 1); }},
    Entry{Of::every_wheel, "braking_force_steer", Unit::deg_per_kN,
          "change of toe over a force to the back at the contact patch, wheel centres held at "
          "their height; "
          "positive towards "
          "toe-in",
          never, [](const Wheels& x, std::size_t w) { return -x.toe(w, held(x, w, at_patch)); }},
    Entry{Of::every_wheel, "braking_force_camber", Unit::deg_per_kN,
          "change of camber over the same force, likewise; positive where the top leans out", never,
          [](const Wheels& x, std::size_t w) { return -x.camber(w, held(x, w, at_patch)); }},
    Entry{Of::every_wheel, "longitudinal_stiffness", Unit::newton_per_mm,
          "longitudinal force at the contact patch over its longitudinal displacement, wheel "
          "centres held at "
          "their height",
          gives_nothing, [](const Wheels& x, std::size_t w) { return stiffness(x, w, at_patch); }},
    Entry{Of::every_wheel, "traction_force_steer", Unit::deg_per_kN,
          "change of toe over a force forward at the wheel centre, wheel centres held at their "
          "height; "
          "positive towards toe-in",
          never, [](const Wheels& x, std::size_t w) { return x.toe(w, held(x, w, at_centre)); }},
    Entry{Of::every_wheel, "longitudinal_stiffness_at_centre", Unit::newton_per_mm,
          "longitudinal force at the wheel centre over its longitudinal displacement, wheel "
          "centres held at "
          "their height",
          gives_nothing, [](const Wheels& x, std::size_t w) { return stiffness(x, w, at_centre); }},
    Entry{Of::every_wheel, "aligning_torque_steer", Unit::deg_per_100Nm,
          "change of toe over a moment about the vertical that turns the wheel towards toe-in, "
          "wheel centres "
          "held at their "
          "height; positive towards toe-in",
          never,
          [](const Wheels& x, std::size_t w) {
              return -x.side(w) * x.toe(w, held(x, w, moment_on + 2));
          }},
    Entry{Of::every_wheel, "aligning_torque_camber", Unit::deg_per_100Nm,
          "change of camber over the same moment, likewise; positive where the top leans out",
          never,
          [](const Wheels& x, std::size_t w) {
              return -x.side(w) * x.camber(w, held(x, w, moment_on + 2));
          }},
    Entry{Of::wheel_on_tyre, "ride_rate", Unit::newton_per_mm,
          "wheel rate and vertical rate of the tyre in series: 1 / (1/k_wheel + 1/k_tyre)", no_rate,
          ride_rate},
    Entry{Of::wheel_on_rack, "steer_gradient", Unit::deg_per_mm,
          "change of toe over the displacement of the steering joint, wheel centres held at their "
          "height; "
          "positive towards "
          "toe-in",
          not_steered, steer_gradient},
    Entry{Of::wheel_on_column, "steer_gradient", Unit::deg_per_deg,
          "change of toe over the angle of the steering joint, wheel centres held at their height; "
          "positive "
          "towards toe-in",
          not_steered, steer_gradient},
    Entry{
        Of::steered_wheel, "caster_steered", Unit::deg,
        "angle to the vertical seen from the side of the axis about which the carrier turns when "
        "the steering moves, wheel centres held at their height; positive where its top leans back",
        does_not_steer,
        [](const Wheels& x, std::size_t w) {
            const auto axis = steering_axis(x, w);
            return axis ? std::atan2(-axis->n.x(), axis->n.z()) : undefined;
        }},
    Entry{Of::steered_wheel, "kingpin_inclination_steered", Unit::deg,
          "angle to the vertical seen from the front of the same axis; positive where its top "
          "leans inwards",
          does_not_steer,
          [](const Wheels& x, std::size_t w) {
              const auto axis = steering_axis(x, w);
              return axis ? std::atan2(-x.side(w) * axis->n.y(), axis->n.z()) : undefined;
          }},
    Entry{Of::steered_wheel, "scrub_radius_steered", Unit::mm,
          "distance across the wheel from the contact patch to the intersection of the same axis "
          "with the road, positive inboard",
          does_not_steer,
          [](const Wheels& x, std::size_t w) {
              const auto axis = steering_axis(x, w);
              return axis ? -across(x, w).dot(on_the_road(x, w, *axis)) : undefined;
          }},
    Entry{Of::steered_wheel, "mechanical_trail_steered", Unit::mm,
          "distance along the wheel from the contact patch to the intersection of the same axis "
          "with the road, positive in front",
          does_not_steer,
          [](const Wheels& x, std::size_t w) {
              const auto axis = steering_axis(x, w);
              return axis ? along(x, w).dot(on_the_road(x, w, *axis)) : undefined;
          }},
    Entry{Of::front_wheel, "anti_dive", Unit::percent,
          "brake_share · wheelbase / cg_height · forward over vertical displacement of the contact "
          "patch: share of the load transfer under braking that the links carry; positive where "
          "they resist dive",
          no_vertical,
          [](const Wheels& x, std::size_t w) {
              return anti(x, x.patch(w), x.model.vehicle->brake_share, 1);
          }},
    Entry{Of::front_wheel, "anti_lift", Unit::percent,
          "drive_share · wheelbase / cg_height · forward over vertical displacement of the wheel "
          "centre (of a rigid axle the patch); positive where the links resist lift of the front "
          "when the axle drives",
          no_vertical,
          [](const Wheels& x, std::size_t w) {
              return anti(x, driven_at(x, w), x.model.vehicle->drive_share, 1);
          }},
    Entry{Of::rear_wheel, "anti_lift", Unit::percent,
          "brake_share · wheelbase / cg_height · rearward over vertical displacement of the "
          "contact patch: share of the load transfer under braking that the links carry; positive "
          "where they resist lift of the rear",
          no_vertical,
          [](const Wheels& x, std::size_t w) {
              return anti(x, x.patch(w), x.model.vehicle->brake_share, -1);
          }},
    Entry{Of::rear_wheel, "anti_squat", Unit::percent,
          "drive_share · wheelbase / cg_height · rearward over vertical displacement of the wheel "
          "centre (of a rigid axle the patch); positive where the links resist squat when the axle "
          "drives",
          no_vertical,
          [](const Wheels& x, std::size_t w) {
              return anti(x, driven_at(x, w), x.model.vehicle->drive_share, -1);
          }},
    Entry{
        Of::wheels, "roll_centre_height", Unit::mm,
        "height above the contact patches of the intersection of the lines that are perpendicular, "
        "seen from the front, to the motion of the patches: of both wheels for an axle that rolls, "
        "with the middle plane of the vehicle for one wheel; positive above the road",
        "no finite roll centre", [](const Wheels& x, std::size_t) { return roll_centre(x); }},
    Entry{Of::wheel_of_axle, "roll_steer", Unit::deg_per_deg,
          "change of toe over the roll of the car body towards this wheel, wheels on the road; "
          "positive "
          "towards toe-in",
          does_not_roll,
          [](const Wheels& x, std::size_t w) {
              return x.response.tied ? undefined : x.toe(w, rolled_towards(x, w));
          }},
    Entry{Of::wheel_of_axle, "roll_camber", Unit::deg_per_deg,
          "change of camber against the car body over its roll towards this wheel; positive where "
          "the top "
          "leans out",
          does_not_roll,
          [](const Wheels& x, std::size_t w) {
              return x.response.tied ? undefined : x.camber(w, rolled_towards(x, w));
          }},
    Entry{Of::wheel_of_axle, "wheel_rate_in_roll", Unit::newton_per_mm,
          "vertical force at the contact patch over vertical displacement of the wheel centre, "
          "with the opposite force on the other wheel",
          no_rate,
          [](const Wheels& x, std::size_t w) { return wheel_rate(x, w, Pattern::opposite); }},
    Entry{
        Of::spring, "motion_ratio", Unit::none,
        "shortening of the spring over travel of the wheel centres, all rising by the same amount",
        never,
        [](const Wheels& x, std::size_t k) {
            const auto& spring = std::get<AxialSpring>(x.model.elastics[k].kind);
            return shortening(x, spring.i, spring.j);
        }},
    Entry{
        Of::damper, "motion_ratio", Unit::none,
        "shortening of the damper over travel of the wheel centres, all rising by the same amount",
        never,
        [](const Wheels& x, std::size_t k) {
            const auto& damper = x.model.dampers[k];
            return shortening(x, damper.i, damper.j);
        }},
};

bool turns(const Model& model, int joint) {
    const int driven = model.joints[static_cast<std::size_t>(joint)].driven;
    return driven >= 0 && is_angle(model.constraints[static_cast<std::size_t>(driven)].kind);
}

// Number of owners of a kind.
std::size_t count(const Model& model, Of of) {
    const auto if_so = [&](bool so) { return so ? model.wheels.size() : 0; };
    switch (of) {
        case Of::every_wheel: return model.wheels.size();
        case Of::wheel_on_tyre: return model.wheels.size();
        case Of::steered_wheel: return if_so(steering_joint(model) >= 0);
        case Of::wheel_on_rack:
            return if_so(steering_joint(model) >= 0 && !turns(model, steering_joint(model)));
        case Of::wheel_on_column:
            return if_so(steering_joint(model) >= 0 && turns(model, steering_joint(model)));
        case Of::front_wheel: return if_so(model.vehicle && model.vehicle->axle == Axle::front);
        case Of::rear_wheel: return if_so(model.vehicle && model.vehicle->axle == Axle::rear);
        case Of::wheel_of_axle: return if_so(is_axle(model));
        case Of::wheels: return 1;
        case Of::spring: return model.elastics.size();
        case Of::damper: return model.dampers.size();
    }
    return 0;
}

// Name of the k-th owner; empty where this one has no such characteristic.
std::optional<std::string> owner(const Model& model, Of of, std::size_t k) {
    switch (of) {
        case Of::wheel_on_tyre:
            if (!(model.wheels[k].tyre_rate > 0)) return std::nullopt;
            [[fallthrough]];
        case Of::every_wheel:
        case Of::steered_wheel:
        case Of::wheel_on_rack:
        case Of::wheel_on_column:
        case Of::front_wheel:
        case Of::rear_wheel:
        case Of::wheel_of_axle: return model.wheels[k].name;
        case Of::wheels: return "";
        case Of::spring:
            if (member<ScalarLaw>(model.elastics[k].kind) == nullptr ||
                model.elastics[k].written_as == WrittenAs::stop)
                return std::nullopt;
            return model.elastics[k].name;
        case Of::damper: return model.dampers[k].name;
    }
    return std::nullopt;
}

}  // namespace

std::vector<Channel> characteristics(const Model& model) {
    std::vector<Channel> list;
    if (model.wheels.empty()) return list;
    for (std::size_t e = 0; e < table.size(); ++e)
        for (std::size_t k = 0; k < count(model, table[e].of); ++k)
            if (const auto name = owner(model, table[e].of, k))
                list.push_back({.name = *name + (name->empty() ? "" : ".") + table[e].name,
                                .unit = table[e].unit,
                                .main = false,
                                .reads = Characteristic{e, k},
                                .definition = table[e].definition,
                                .undefined = table[e].undefined});
    return list;
}

double value_of(const Model& model, const Characteristic& what, const Equilibrium& state,
                const WheelResponse& response) {
    const Entry& entry = table[what.entry];
    return response.why_not.empty() ? entry.formula({model, state, response}, what.of) : nan;
}

bool is_swing_arm(const Characteristic& what) { return table[what.entry].swing_arm; }

Eigen::MatrixXd compliance(const Model& model, WheelPoint point, const Equilibrium& state,
                           const WheelResponse& response) {
    const auto n = static_cast<Eigen::Index>(response.free.size());
    const Wheels wheels{model, state, response};
    const int force = point == WheelPoint::centre ? at_centre : at_patch;
    Eigen::MatrixXd C(6 * n, 6 * n);
    for (Eigen::Index j = 0; j < n; ++j)
        for (int k = 0; k < 6; ++k) {
            const auto& by = response.free[static_cast<std::size_t>(j)]
                                          [static_cast<std::size_t>(k < 3 ? force + k : k)];
            for (Eigen::Index i = 0; i < n; ++i) {
                const auto w = static_cast<std::size_t>(i);
                const Point at = point == WheelPoint::centre ? wheels.centre(w) : wheels.patch(w);
                C.block<6, 1>(6 * i, 6 * j + k) << moved(state, by, at), turned(by, wheels[w].body);
            }
        }
    return C;
}

double reciprocity(const Model& model, const Eigen::MatrixXd& C) {
    if (C.size() == 0) return nan;
    Eigen::VectorXd size = Eigen::VectorXd::Ones(C.rows());
    for (std::size_t w = 0; w < model.wheels.size(); ++w) {
        const double radius = (model.wheels[w].centre_local - model.wheels[w].contact_local).norm();
        if (radius > 0) size.segment<3>(static_cast<Eigen::Index>(6 * w + 3)).setConstant(radius);
    }
    const Eigen::MatrixXd even = size.asDiagonal() * C * size.asDiagonal();
    return (even - even.transpose()).cwiseAbs().maxCoeff() / even.cwiseAbs().maxCoeff();
}

double in_table_units(const Eigen::MatrixXd& C, Eigen::Index row, Eigen::Index column) {
    return C(row, column) * in_unit(row % 6 < 3 ? Unit::mm : Unit::deg) *
           (column % 6 < 3 ? 1e3 : 100);
}

std::string compliance_row_name(const Model& model, const std::string& point, Eigen::Index row) {
    const std::string& wheel = model.wheels[static_cast<std::size_t>(row / 6)].name;
    return fmt::format("{}, {}{} {}", point, wheel.empty() ? "" : wheel + " ",
                       row % 6 < 3 ? "displacement" : "rotation", "xyz"[row % 3]);
}

}  // namespace elastocheck::compare
