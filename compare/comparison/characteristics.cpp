#include "compare/comparison/characteristics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "compare/outputs/dual.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
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

template <class S>
S ratio(const S& value, const S& by, double limit) {
    using std::abs;
    if (std::isnan(value_of(value)) || std::isnan(value_of(by))) return nan;
    return std::abs(value_of(value)) <= limit * std::abs(value_of(by)) && value_of(by) != 0
               ? value / by
               : S(undefined);
}

// ---- Motions of a wheel, for S = Dual with their derivatives by a number of the model.

template <class S>
using Triple = Eigen::Matrix<S, 3, 1>;

Vector3d with(const Vector3d& value, const Vector3d&, double) { return value; }
Triple<Dual> with(const Vector3d& value, const Vector3d& rate, Dual) {
    return {Dual(value.x(), rate.x()), Dual(value.y(), rate.y()), Dual(value.z(), rate.z())};
}

template <class S>
struct MotionOf {
    Triple<S> dr = Triple<S>::Constant(S(0)), dpi = Triple<S>::Constant(S(0));
};
template <class S>
struct ResponseOf {
    using Motions = std::vector<MotionOf<S>>;
    std::vector<Motions> travel;
    Motions steering;
    std::vector<std::array<Motions, causes>> held, free;
    bool tied = false, nothing_resists = false;
};
template <class S>
struct Reading {
    using Response = ResponseOf<S>;
    using Motions = typename Response::Motions;
};
template <>
struct Reading<double> {
    using Response = WheelResponse;
    using Motions = compare::Motions;
};
template <class S>
using MotionsOf = typename Reading<S>::Motions;

// A point or direction of a body: where it is, and from the origin of its body.
template <class S>
struct Placed {
    BodyId body;
    Triple<S> at, lever;
};

template <class S>
struct Wheels {
    using Number = S;
    const Model& model;
    const Equilibrium& state;
    const typename Reading<S>::Response& response;
    // with S = Dual: of the model, and of the state
    const Model* rate = nullptr;
    const StateRate* by = nullptr;

    const Wheel& operator[](std::size_t w) const { return model.wheels[w]; }
    const Wheel& rate_of(std::size_t w) const { return changing().wheels[w]; }
    // Where nothing changes, its own parts stand in the place of rates and are not read.
    const Model& changing() const { return rate != nullptr ? *rate : model; }
    S number(double value, double derivative) const {
        return with(Vector3d(value, 0, 0), Vector3d(derivative, 0, 0), S())[0];
    }
    Placed<S> placed(BodyId body, const Vector3d& s_local, const Vector3d& ds_local) const {
        const Pose& on = pose(state.poses, body);
        const Vector3d s = on.p * s_local;
        Vector3d ds = Vector3d::Zero(), dr = Vector3d::Zero();
        if (rate != nullptr) {
            ds = on.p * ds_local;
            if (body != ground) {
                const Increment& moved = by->increments[static_cast<std::size_t>(body)];
                dr = moved.dr;
                ds += moved.dpi.cross(s);
            }
        }
        return {body, with(on.r + s, dr + ds, S()), with(s, ds, S())};
    }
    Placed<S> centre(std::size_t w) const {
        return placed(model.wheels[w].body, model.wheels[w].centre_local, rate_of(w).centre_local);
    }
    Placed<S> patch(std::size_t w) const {
        return placed(model.wheels[w].body, model.wheels[w].contact_local,
                      rate_of(w).contact_local);
    }
    Placed<S> point(const Point& p, const Point& d) const {
        return placed(p.body, p.s_local, d.s_local);
    }
    double side(std::size_t w) const { return model.wheels[w].side; }
    Triple<S> spin(std::size_t w) const {
        return placed(model.wheels[w].body, model.wheels[w].spin_axis_local,
                      rate_of(w).spin_axis_local)
            .lever;
    }

    // Rates along a motion of the channels toe and camber: atan2(e_x, side e_y), -asin(e_z).
    S toe(std::size_t w, const MotionsOf<S>& motions) const {
        const Triple<S> e = spin(w), de = turned_by(motions, model.wheels[w].body).cross(e);
        const S x = S(side(w)) * e.y(), dx = S(side(w)) * de.y();
        return (x * de.x() - e.x() * dx) / (x * x + e.x() * e.x());
    }
    S camber(std::size_t w, const MotionsOf<S>& motions) const {
        using std::sqrt;
        const Triple<S> e = spin(w), de = turned_by(motions, model.wheels[w].body).cross(e);
        return -(de.z() / sqrt(S(1) - e.z() * e.z()));
    }

    static Triple<S> turned_by(const MotionsOf<S>& motions, BodyId body) {
        if (body == ground) return Triple<S>::Constant(S(0));
        return motions[static_cast<std::size_t>(body)].dpi;
    }
    static Triple<S> moved_by(const MotionsOf<S>& motions, const Placed<S>& point) {
        if (point.body == ground) return Triple<S>::Constant(S(0));
        const auto& body = motions[static_cast<std::size_t>(point.body)];
        return body.dr + body.dpi.cross(point.lever);
    }
};

// Weighted sum of several causes.
template <class S>
MotionsOf<S> sum(const std::vector<MotionsOf<S>>& all, const std::vector<S>& weights) {
    MotionsOf<S> total(all.front().size());
    for (std::size_t k = 0; k < all.size(); ++k)
        for (std::size_t b = 0; b < total.size(); ++b) {
            total[b].dr += weights[k] * all[k][b].dr;
            total[b].dpi += weights[k] * all[k][b].dpi;
        }
    return total;
}

// Heave: all wheels raised by 1 m; with tied wheels, their common motion scaled so that this wheel
// rises by 1 m. Roll: the wheels of an axle in opposition, the left up; not for tied wheels.
template <class S>
MotionsOf<S> raised(const Wheels<S>& wheels, std::size_t w) {
    const auto& first = wheels.response.travel.front();
    const S whole =
        wheels.response.tied ? S(1) / wheels.moved_by(first, wheels.centre(w)).z() : S(1);
    return sum<S>(wheels.response.travel, std::vector<S>(wheels.response.travel.size(), whole));
}
template <class S>
MotionsOf<S> rolled(const Wheels<S>& wheels) {
    std::vector<S> weights;
    for (const auto& wheel : wheels.model.wheels) weights.push_back(S(wheel.side));
    return sum<S>(wheels.response.travel, weights);
}

// One left and one right wheel.
bool is_axle(const Model& model) {
    return model.wheels.size() == 2 && model.wheels[0].side * model.wheels[1].side < 0;
}

// ---- Centres and axes.

// The solution of A P = b, of coincident lines the nearest; none of parallel ones. Two lines that
// coincide only here have a solution without derivative.
std::optional<Vector2d> crossing(const Eigen::Matrix2d& A, const Vector2d& b, double track) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix2d> lines;
    lines.setThreshold(1e-9);
    lines.compute(A);
    const Vector2d P = lines.solve(b);
    if ((A * P - b).norm() > 1e-9 * track || !(P.norm() <= nowhere)) return std::nullopt;
    return P;
}
std::optional<Eigen::Matrix<Dual, 2, 1>> crossing(const Eigen::Matrix<Dual, 2, 2>& A,
                                                  const Eigen::Matrix<Dual, 2, 1>& b,
                                                  const Dual& track) {
    const auto value = [](const Dual& entry) { return entry.x; };
    const auto rate = [](const Dual& entry) { return entry.dx; };
    const Eigen::Matrix2d A_x = A.unaryExpr(value), A_dx = A.unaryExpr(rate);
    const Vector2d b_x = b.unaryExpr(value), b_dx = b.unaryExpr(rate);
    const auto P = crossing(A_x, b_x, track.x);
    if (!P) return std::nullopt;
    Eigen::FullPivLU<Eigen::Matrix2d> lines;
    lines.setThreshold(1e-9);
    lines.compute(A_x);
    Vector2d dP = Vector2d::Constant(nan);
    if (lines.isInvertible()) dP = lines.solve(b_dx - A_dx * *P);
    return Eigen::Matrix<Dual, 2, 1>(Dual(P->x(), dP.x()), Dual(P->y(), dP.y()));
}

// Instant centre in front view: the patch of a wheel moves perpendicularly to the line through its
// instant centre. The roll centre lies on that line: for an axle in roll at the intersection of
// both lines; for one wheel at the middle of the vehicle, y = 0.
//
//   (P - c) · (dy, dz) = 0      h = P_z - c_z
//
// Two coincident lines (arms that guide the wheels vertically) meet halfway between the wheels.
template <class S>
S roll_centre(const Wheels<S>& wheels) {
    using std::abs;
    using Plane = Eigen::Matrix<S, 2, 1>;
    const auto seen = [](const Triple<S>& v) { return Plane(v.y(), v.z()); };
    if (!is_axle(wheels.model)) {
        const Placed<S> patch = wheels.patch(0);
        const Triple<S> d = wheels.moved_by(wheels.response.travel[0], patch);
        return ratio<S>(patch.at.y() * d.y(), d.z(), nowhere);
    }
    if (wheels.response.tied) return undefined;
    const MotionsOf<S> roll = rolled(wheels);
    Eigen::Matrix<S, 2, 2> A;
    Plane c[2], b;
    for (std::size_t w = 0; w < 2; ++w) {
        c[w] = seen(wheels.patch(w).at);
        A.row(static_cast<Eigen::Index>(w)) =
            seen(wheels.moved_by(roll, wheels.patch(w))).normalized().transpose();
    }
    const Plane middle = (c[0] + c[1]) / S(2);
    for (int w = 0; w < 2; ++w) b[w] = A.row(w).dot(c[w] - middle);
    const auto P = crossing(A, b, S(abs(c[0].x() - c[1].x())));
    return P ? P->y() : S(undefined);
}

// Instant centre of the carrier in side and front view, from the wheel centre, with velocity v and
// rate ω:
//   from the side   (x, z): (v_z, -v_x) / ω_y      from the front   (y, z): (-v_z, v_y) / ω_x

// Virtual steering axis: screw axis of the carrier when the rack moves at constant wheel-centre
// height. n upward, through  c + ω × v / ω².
template <class S>
struct Axis {
    Triple<S> n, through;
};
template <class S>
std::optional<Axis<S>> steering_axis(const Wheels<S>& wheels, std::size_t w) {
    using std::abs;
    if (wheels.response.steering.empty()) return std::nullopt;
    const Triple<S> omega = wheels.turned_by(wheels.response.steering, wheels[w].body),
                    v = wheels.moved_by(wheels.response.steering, wheels.centre(w));
    const S rate = omega.norm();
    if (!(v.norm() <= S(nowhere) * rate) || !(abs(omega.z()) > S(1e-6) * rate)) return std::nullopt;
    return Axis<S>{omega.normalized() * S(omega.z() > S(0) ? 1 : -1),
                   wheels.centre(w).at + omega.cross(v) / omega.squaredNorm()};
}
// Vector from the patch to the intersection of the axis with the road.
template <class S>
Triple<S> on_the_road(const Wheels<S>& wheels, std::size_t w, const Axis<S>& axis) {
    const Triple<S> patch = wheels.patch(w).at;
    return axis.through + axis.n * ((patch.z() - axis.through.z()) / axis.n.z()) - patch;
}
// Unit vectors in the road plane that follow the steered wheel: across it outwards, and along it
// forwards.
template <class S>
Triple<S> across(const Wheels<S>& wheels, std::size_t w) {
    const Triple<S> e = wheels.spin(w);
    return Triple<S>(e.x(), e.y(), S(0)).normalized();
}
template <class S>
Triple<S> along(const Wheels<S>& wheels, std::size_t w) {
    return S(wheels.side(w)) * across(wheels, w).cross(Triple<S>(S(0), S(0), S(1)));
}

// Body roll by 1 rad towards this wheel of an axle, the wheels on the road: this wheel rises by
// half the track, the other one goes down by as much.
template <class S>
MotionsOf<S> rolled_towards(const Wheels<S>& wheels, std::size_t w) {
    using std::abs;
    MotionsOf<S> roll = rolled(wheels);
    const S half =
        S(abs(wheels.patch(0).at.y() - wheels.patch(1).at.y())) / S(2) * S(wheels.side(w));
    for (auto& motion : roll) motion.dr *= half, motion.dpi *= half;
    return roll;
}

// ---- Stiffness and rates.

// 1 N up on the patch of every wheel; or on an axle in opposition, this wheel's up; model `free`.
enum class Pattern { alike, opposite };
template <class S>
S wheel_rate(const Wheels<S>& wheels, std::size_t w, Pattern pattern) {
    if (wheels.response.free.empty()) return wheels.response.nothing_resists ? undefined : nan;
    std::vector<MotionsOf<S>> up;
    std::vector<S> weights;
    for (std::size_t k = 0; k < wheels.response.free.size(); ++k) {
        up.push_back(wheels.response.free[k][at_patch + 2]);
        weights.push_back(S(pattern == Pattern::alike || k == w ? 1 : -1));
    }
    return ratio<S>(S(1), wheels.moved_by(sum<S>(up, weights), wheels.centre(w)).z(), rigid);
}
template <class S>
S ride_rate(const Wheels<S>& wheels, std::size_t w) {
    const S k_w = wheel_rate(wheels, w, Pattern::alike),
            k_t = wheels.number(wheels[w].tyre_rate, wheels.rate_of(w).tyre_rate);
    return std::isinf(value_of(k_w)) ? S(undefined) : k_w * k_t / (k_w + k_t);
}

// Sign towards the middle of the vehicle, for equal values of a wheel and its mirror image; at the
// patch, wheels held.
template <class S>
S inward(const Wheels<S>& wheels, std::size_t w) {
    return S(-wheels.side(w));
}

template <class S>
const MotionsOf<S>& held(const Wheels<S>& wheels, std::size_t w, int cause) {
    return wheels.response.held[w][static_cast<std::size_t>(cause)];
}

// The displacement of the loaded point along the load is a compliance.
template <class S>
S stiffness(const Wheels<S>& wheels, std::size_t w, int cause) {
    const Placed<S> at = cause < moment_on ? wheels.centre(w) : wheels.patch(w);
    return ratio<S>(S(1), wheels.moved_by(held(wheels, w, cause), at)[cause % 3], rigid);
}

// Longitudinal displacement of a point per wheel travel, all wheels raised together: tangent of the
// angle at which the links, not the springs, carry a longitudinal force.
template <class S>
S forward_per_travel(const Wheels<S>& wheels, const Placed<S>& at) {
    const Triple<S> d = wheels.moved_by(raised(wheels, 0), at);
    return ratio<S>(d.x(), d.z(), nowhere);
}
// Point at which a driving force acts on the links: the patch where an axle housing carries the
// drive torque, the wheel centre where the car body carries it through a shaft.
template <class S>
Placed<S> driven_at(const Wheels<S>& wheels, std::size_t w) {
    const bool housing = is_axle(wheels.model) && wheels[0].body == wheels[1].body;
    return housing ? wheels.patch(w) : wheels.centre(w);
}
// Milliken & Milliken, Race Car Vehicle Dynamics, 1995, ch. 17: axle share · tan
// φ · wheelbase / height of the centre of gravity.
template <class S>
S anti(const Wheels<S>& wheels, const Placed<S>& at, double Vehicle::*share, double sign) {
    const Vehicle &vehicle = *wheels.model.vehicle, &d = *wheels.changing().vehicle;
    const auto number = [&](double Vehicle::*which) {
        return wheels.number(vehicle.*which, d.*which);
    };
    return S(sign) * number(share) * forward_per_travel(wheels, at) * number(&Vehicle::wheelbase) /
           number(&Vehicle::cg_height);
}

template <class S>
S steer_gradient(const Wheels<S>& wheels, std::size_t w) {
    return wheels.response.steering.empty() ? S(undefined)
                                            : wheels.toe(w, wheels.response.steering);
}

template <class S>
S shortening(const Wheels<S>& wheels, const Placed<S>& i, const Placed<S>& j) {
    const MotionsOf<S> motions = raised(wheels, 0);
    const Triple<S> D = j.at - i.at, dD = wheels.moved_by(motions, j) - wheels.moved_by(motions, i);
    return -(D.dot(dD) / D.norm());
}

// ---- Catalogue: owner, name, unit, definition with its sign, meaning of undefined, formula.

// Owner of a characteristic; those after the wheels only where a scene has what they need.
enum class Owner {
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

// One formula, evaluated with doubles and with duals; k: wheel, or spring in Model::elastics, or
// damper; SI.
struct Formula {
    double (*value)(const Wheels<double>& wheels, std::size_t k);
    Dual (*with_rate)(const Wheels<Dual>& wheels, std::size_t k);

    template <class Generic>
    Formula(const Generic& formula) : value(formula), with_rate(formula) {}  // NOLINT: of a lambda
};

// A number as those of the formula.
template <class S>
S in(const Wheels<S>&, double value) {
    return S(value);
}

struct Entry {
    Owner of;
    const char* name;
    Unit unit;
    const char* definition;
    const char* undefined;
    Formula formula;
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
    Entry{Owner::every_wheel, "bump_steer", Unit::deg_per_m,
          "change of toe over travel of the wheel centre, all wheels rising by the same amount; "
          "positive towards toe-in in jounce",
          never, [](const auto& x, std::size_t w) { return x.toe(w, raised(x, w)); }},
    Entry{Owner::every_wheel, "bump_camber", Unit::deg_per_100mm,
          "change of camber over travel of the wheel centre, all wheels rising by the same amount; "
          "positive where the top leans out in jounce",
          never, [](const auto& x, std::size_t w) { return x.camber(w, raised(x, w)); }},
    Entry{Owner::every_wheel, "track_gradient", Unit::mm_per_100mm,
          "lateral displacement of the contact patch over travel, all wheels rising by the same "
          "amount; positive outwards in jounce",
          never,
          [](const auto& x, std::size_t w) {
              return in(x, x.side(w)) * x.moved_by(raised(x, w), x.patch(w)).y();
          }},
    Entry{Owner::every_wheel, "recession_gradient", Unit::mm_per_100mm,
          "longitudinal displacement of the wheel centre over travel, all wheels rising by the "
          "same amount; positive to the back in jounce",
          never,
          [](const auto& x, std::size_t w) { return -x.moved_by(raised(x, w), x.centre(w)).x(); }},
    Entry{Owner::every_wheel, "front_view_swing_arm", Unit::mm,
          "lateral distance from the wheel centre to the instant centre of the carrier seen from "
          "the front, all wheels rising by the same amount; positive inboard",
          "the carrier does not rotate as seen from the front: the arm is infinite",
          [](const auto& x, std::size_t w) {
              const auto by = raised(x, w);
              const auto v = x.moved_by(by, x.centre(w));
              return ratio(in(x, x.side(w)) * v.z(), x.turned_by(by, x[w].body).x(), nowhere);
          },
          true},
    Entry{Owner::every_wheel, "side_view_swing_arm", Unit::mm,
          "longitudinal distance from the wheel centre to the instant centre of the carrier seen "
          "from the side, all wheels rising by the same amount; positive ahead of the wheel",
          "the carrier does not rotate as seen from the side: the arm is infinite",
          [](const auto& x, std::size_t w) {
              const auto by = raised(x, w);
              const auto v = x.moved_by(by, x.centre(w));
              return ratio(v.z(), x.turned_by(by, x[w].body).y(), nowhere);
          },
          true},
    Entry{Owner::every_wheel, "wheel_rate", Unit::newton_per_mm,
          "vertical force at the contact patch over vertical displacement of the wheel centre, all "
          "wheels with the same load",
          no_rate, [](const auto& x, std::size_t w) { return wheel_rate(x, w, Pattern::alike); }},
    Entry{Owner::every_wheel, "lateral_force_steer", Unit::deg_per_kN,
          "change of toe over a force at the contact patch towards the middle of the vehicle (as "
          "on the "
          "outer wheel in a "
          "turn), wheel centres held at their height; positive towards toe-in",
          never,
          [](const auto& x, std::size_t w) {
              return inward(x, w) * x.toe(w, held(x, w, at_patch + 1));
          }},
    Entry{Owner::every_wheel, "lateral_force_camber", Unit::deg_per_kN,
          "change of camber over the same force, likewise; positive where the top leans out", never,
          [](const auto& x, std::size_t w) {
              return inward(x, w) * x.camber(w, held(x, w, at_patch + 1));
          }},
    Entry{Owner::every_wheel, "lateral_stiffness", Unit::newton_per_mm,
          "lateral force at the contact patch over its lateral displacement, wheel centres held at "
          "their "
          "height",
          gives_nothing,
          [](const auto& x, std::size_t w) { return stiffness(x, w, at_patch + 1); }},
    Entry{Owner::every_wheel, "braking_force_steer", Unit::deg_per_kN,
          "change of toe over a force to the back at the contact patch, wheel centres held at "
          "their height; "
          "positive towards "
          "toe-in",
          never, [](const auto& x, std::size_t w) { return -x.toe(w, held(x, w, at_patch)); }},
    Entry{Owner::every_wheel, "braking_force_camber", Unit::deg_per_kN,
          "change of camber over the same force, likewise; positive where the top leans out", never,
          [](const auto& x, std::size_t w) { return -x.camber(w, held(x, w, at_patch)); }},
    Entry{Owner::every_wheel, "longitudinal_stiffness", Unit::newton_per_mm,
          "longitudinal force at the contact patch over its longitudinal displacement, wheel "
          "centres held at "
          "their height",
          gives_nothing, [](const auto& x, std::size_t w) { return stiffness(x, w, at_patch); }},
    Entry{Owner::every_wheel, "traction_force_steer", Unit::deg_per_kN,
          "change of toe over a force forward at the wheel centre, wheel centres held at their "
          "height; "
          "positive towards toe-in",
          never, [](const auto& x, std::size_t w) { return x.toe(w, held(x, w, at_centre)); }},
    Entry{Owner::every_wheel, "longitudinal_stiffness_at_centre", Unit::newton_per_mm,
          "longitudinal force at the wheel centre over its longitudinal displacement, wheel "
          "centres held at "
          "their height",
          gives_nothing, [](const auto& x, std::size_t w) { return stiffness(x, w, at_centre); }},
    Entry{Owner::every_wheel, "aligning_torque_steer", Unit::deg_per_100Nm,
          "change of toe over a moment about the vertical that turns the wheel towards toe-in, "
          "wheel centres "
          "held at their "
          "height; positive towards toe-in",
          never,
          [](const auto& x, std::size_t w) {
              return in(x, -x.side(w)) * x.toe(w, held(x, w, moment_on + 2));
          }},
    Entry{Owner::every_wheel, "aligning_torque_camber", Unit::deg_per_100Nm,
          "change of camber over the same moment, likewise; positive where the top leans out",
          never,
          [](const auto& x, std::size_t w) {
              return in(x, -x.side(w)) * x.camber(w, held(x, w, moment_on + 2));
          }},
    Entry{Owner::wheel_on_tyre, "ride_rate", Unit::newton_per_mm,
          "wheel rate and vertical rate of the tyre in series: 1 / (1/k_wheel + 1/k_tyre)", no_rate,
          [](const auto& x, std::size_t w) { return ride_rate(x, w); }},
    Entry{Owner::wheel_on_rack, "steer_gradient", Unit::deg_per_mm,
          "change of toe over the displacement of the steering joint, wheel centres held at their "
          "height; "
          "positive towards "
          "toe-in",
          not_steered, [](const auto& x, std::size_t w) { return steer_gradient(x, w); }},
    Entry{Owner::wheel_on_column, "steer_gradient", Unit::deg_per_deg,
          "change of toe over the angle of the steering joint, wheel centres held at their height; "
          "positive "
          "towards toe-in",
          not_steered, [](const auto& x, std::size_t w) { return steer_gradient(x, w); }},
    Entry{
        Owner::steered_wheel, "caster_steered", Unit::deg,
        "angle to the vertical seen from the side of the axis about which the carrier turns when "
        "the steering moves, wheel centres held at their height; positive where its top leans back",
        does_not_steer,
        [](const auto& x, std::size_t w) {
            const auto axis = steering_axis(x, w);
            using std::atan2;
            return axis ? atan2(-axis->n.x(), axis->n.z()) : in(x, undefined);
        }},
    Entry{Owner::steered_wheel, "kingpin_inclination_steered", Unit::deg,
          "angle to the vertical seen from the front of the same axis; positive where its top "
          "leans inwards",
          does_not_steer,
          [](const auto& x, std::size_t w) {
              const auto axis = steering_axis(x, w);
              using std::atan2;
              return axis ? atan2(in(x, -x.side(w)) * axis->n.y(), axis->n.z()) : in(x, undefined);
          }},
    Entry{Owner::steered_wheel, "scrub_radius_steered", Unit::mm,
          "distance across the wheel from the contact patch to the intersection of the same axis "
          "with the road, positive inboard",
          does_not_steer,
          [](const auto& x, std::size_t w) {
              const auto axis = steering_axis(x, w);
              return axis ? -across(x, w).dot(on_the_road(x, w, *axis)) : in(x, undefined);
          }},
    Entry{Owner::steered_wheel, "mechanical_trail_steered", Unit::mm,
          "distance along the wheel from the contact patch to the intersection of the same axis "
          "with the road, positive in front",
          does_not_steer,
          [](const auto& x, std::size_t w) {
              const auto axis = steering_axis(x, w);
              return axis ? along(x, w).dot(on_the_road(x, w, *axis)) : in(x, undefined);
          }},
    Entry{
        Owner::front_wheel, "anti_dive", Unit::percent,
        "brake_share · wheelbase / cg_height · forward over vertical displacement of the contact "
        "patch: share of the load transfer under braking that the links carry; positive where "
        "they resist dive",
        no_vertical,
        [](const auto& x, std::size_t w) { return anti(x, x.patch(w), &Vehicle::brake_share, 1); }},
    Entry{Owner::front_wheel, "anti_lift", Unit::percent,
          "drive_share · wheelbase / cg_height · forward over vertical displacement of the wheel "
          "centre (of a rigid axle the patch); positive where the links resist lift of the front "
          "when the axle drives",
          no_vertical,
          [](const auto& x, std::size_t w) {
              return anti(x, driven_at(x, w), &Vehicle::drive_share, 1);
          }},
    Entry{Owner::rear_wheel, "anti_lift", Unit::percent,
          "brake_share · wheelbase / cg_height · rearward over vertical displacement of the "
          "contact patch: share of the load transfer under braking that the links carry; positive "
          "where they resist lift of the rear",
          no_vertical,
          [](const auto& x, std::size_t w) {
              return anti(x, x.patch(w), &Vehicle::brake_share, -1);
          }},
    Entry{Owner::rear_wheel, "anti_squat", Unit::percent,
          "drive_share · wheelbase / cg_height · rearward over vertical displacement of the wheel "
          "centre (of a rigid axle the patch); positive where the links resist squat when the axle "
          "drives",
          no_vertical,
          [](const auto& x, std::size_t w) {
              return anti(x, driven_at(x, w), &Vehicle::drive_share, -1);
          }},
    Entry{
        Owner::wheels, "roll_centre_height", Unit::mm,
        "height above the contact patches of the intersection of the lines that are perpendicular, "
        "seen from the front, to the motion of the patches: of both wheels for an axle that rolls, "
        "with the middle plane of the vehicle for one wheel; positive above the road",
        "no finite roll centre", [](const auto& x, std::size_t) { return roll_centre(x); }},
    Entry{Owner::wheel_of_axle, "roll_steer", Unit::deg_per_deg,
          "change of toe over the roll of the car body towards this wheel, wheels on the road; "
          "positive "
          "towards toe-in",
          does_not_roll,
          [](const auto& x, std::size_t w) {
              return x.response.tied ? in(x, undefined) : x.toe(w, rolled_towards(x, w));
          }},
    Entry{Owner::wheel_of_axle, "roll_camber", Unit::deg_per_deg,
          "change of camber against the car body over its roll towards this wheel; positive where "
          "the top "
          "leans out",
          does_not_roll,
          [](const auto& x, std::size_t w) {
              return x.response.tied ? in(x, undefined) : x.camber(w, rolled_towards(x, w));
          }},
    Entry{Owner::wheel_of_axle, "wheel_rate_in_roll", Unit::newton_per_mm,
          "vertical force at the contact patch over vertical displacement of the wheel centre, "
          "with the opposite force on the other wheel",
          no_rate,
          [](const auto& x, std::size_t w) { return wheel_rate(x, w, Pattern::opposite); }},
    Entry{
        Owner::spring, "motion_ratio", Unit::none,
        "shortening of the spring over travel of the wheel centres, all rising by the same amount",
        never,
        [](const auto& x, std::size_t k) {
            const auto& spring = std::get<AxialSpring>(x.model.elastics[k].kind);
            const auto& d = std::get<AxialSpring>(x.changing().elastics[k].kind);
            return shortening(x, x.point(spring.i, d.i), x.point(spring.j, d.j));
        }},
    Entry{
        Owner::damper, "motion_ratio", Unit::none,
        "shortening of the damper over travel of the wheel centres, all rising by the same amount",
        never,
        [](const auto& x, std::size_t k) {
            const auto &damper = x.model.dampers[k], &d = x.changing().dampers[k];
            return shortening(x, x.point(damper.i, d.i), x.point(damper.j, d.j));
        }},
};

bool turns(const Model& model, int joint) {
    const int driven = model.joints[static_cast<std::size_t>(joint)].driven;
    return driven >= 0 && is_angle(model.constraints[static_cast<std::size_t>(driven)].kind);
}

// Number of owners of a kind.
std::size_t count(const Model& model, Owner of) {
    const auto if_so = [&](bool so) { return so ? model.wheels.size() : 0; };
    switch (of) {
        case Owner::every_wheel: return model.wheels.size();
        case Owner::wheel_on_tyre: return model.wheels.size();
        case Owner::steered_wheel: return if_so(steering_joint(model) >= 0);
        case Owner::wheel_on_rack:
            return if_so(steering_joint(model) >= 0 && !turns(model, steering_joint(model)));
        case Owner::wheel_on_column:
            return if_so(steering_joint(model) >= 0 && turns(model, steering_joint(model)));
        case Owner::front_wheel: return if_so(model.vehicle && model.vehicle->axle == Axle::front);
        case Owner::rear_wheel: return if_so(model.vehicle && model.vehicle->axle == Axle::rear);
        case Owner::wheel_of_axle: return if_so(is_axle(model));
        case Owner::wheels: return 1;
        case Owner::spring: return model.elastics.size();
        case Owner::damper: return model.dampers.size();
    }
    return 0;
}

// Name of the k-th owner; empty where this one has no such characteristic.
std::optional<std::string> owner(const Model& model, Owner of, std::size_t k) {
    switch (of) {
        case Owner::wheel_on_tyre:
            if (!(model.wheels[k].tyre_rate > 0)) return std::nullopt;
            [[fallthrough]];
        case Owner::every_wheel:
        case Owner::steered_wheel:
        case Owner::wheel_on_rack:
        case Owner::wheel_on_column:
        case Owner::front_wheel:
        case Owner::rear_wheel:
        case Owner::wheel_of_axle: return model.wheels[k].name;
        case Owner::wheels: return "";
        case Owner::spring:
            if (member<ScalarLaw>(model.elastics[k].kind) == nullptr ||
                model.elastics[k].written_as == WrittenAs::stop)
                return std::nullopt;
            return model.elastics[k].name;
        case Owner::damper: return model.dampers[k].name;
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
    return response.why_not.empty() ? entry.formula.value({model, state, response}, what.of) : nan;
}

namespace {

std::vector<MotionOf<Dual>> with_rate(const Motions& at, const Motions& rate) {
    std::vector<MotionOf<Dual>> both(at.size());
    for (std::size_t b = 0; b < at.size() && b < rate.size(); ++b)
        both[b] = {with(at[b].dr, rate[b].dr, Dual()), with(at[b].dpi, rate[b].dpi, Dual())};
    return both;
}
std::vector<std::array<std::vector<MotionOf<Dual>>, causes>> with_rate(
    const std::vector<std::array<Motions, causes>>& at,
    const std::vector<std::array<Motions, causes>>& rate) {
    std::vector<std::array<std::vector<MotionOf<Dual>>, causes>> both(rate.size());
    for (std::size_t w = 0; w < rate.size(); ++w)
        for (std::size_t k = 0; k < causes; ++k) both[w][k] = with_rate(at[w][k], rate[w][k]);
    return both;
}

}  // namespace

std::vector<double> rates_of(const Model& model, std::span<const Characteristic> which,
                             const Equilibrium& state, const Model& rate,
                             const StateRate& state_rate, const WheelResponse& at,
                             const WheelResponseRate& by) {
    std::vector<double> rates(which.size(), nan);
    if (!by.why_not.empty()) return rates;
    ResponseOf<Dual> response;
    response.tied = at.tied, response.nothing_resists = at.nothing_resists;
    for (std::size_t w = 0; w < at.travel.size(); ++w)
        response.travel.push_back(with_rate(at.travel[w], by.travel[w]));
    response.steering = with_rate(at.steering, by.steering);
    response.held = with_rate(at.held, by.held);
    response.free = with_rate(at.free, by.free);
    const Wheels<Dual> wheels{model, state, response, &rate, &state_rate};
    for (std::size_t k = 0; k < which.size(); ++k) {
        const Dual value = table[which[k].entry].formula.with_rate(wheels, which[k].of);
        if (std::isfinite(value.x)) rates[k] = value.dx;
    }
    return rates;
}

bool needs_free(const Characteristic& what) {
    const Owner of = table[what.entry].of;
    return of == Owner::wheel_on_tyre || table[what.entry].unit == Unit::newton_per_mm;
}

bool is_swing_arm(const Characteristic& what) { return table[what.entry].swing_arm; }

Eigen::MatrixXd compliance(const Model& model, WheelPoint point, const Equilibrium& state,
                           const WheelResponse& response) {
    const auto n = static_cast<Eigen::Index>(response.free.size());
    const Wheels<double> wheels{model, state, response};
    const int force = point == WheelPoint::centre ? at_centre : at_patch;
    Eigen::MatrixXd C(6 * n, 6 * n);
    for (Eigen::Index j = 0; j < n; ++j)
        for (int k = 0; k < 6; ++k) {
            const auto& by = response.free[static_cast<std::size_t>(j)]
                                          [static_cast<std::size_t>(k < 3 ? force + k : k)];
            for (Eigen::Index i = 0; i < n; ++i) {
                const auto w = static_cast<std::size_t>(i);
                const auto at = point == WheelPoint::centre ? wheels.centre(w) : wheels.patch(w);
                C.block<6, 1>(6 * i, 6 * j + k) << wheels.moved_by(by, at),
                    turned(by, wheels[w].body);
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
