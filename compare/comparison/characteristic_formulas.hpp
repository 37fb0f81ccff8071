// Formulas of the characteristics: motions of the wheels by a response, and what is read from them,
// with doubles and with their derivatives by a number of the model. For characteristics.cpp and for
// other definitions of the same figures (compare/definitions/rates.cpp).
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
#include "compare/outputs/dual.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
#include "elastocheck/channels.hpp"
#include "models/state_rate.hpp"

namespace elastocheck::compare::characteristic {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Arms and centres farther than this are at infinity, and joints stiffer than this are rigid:
// beyond, the quotient is round-off of a part that does not rotate or deform.
inline constexpr double nowhere = 1e4;  // [m]
inline constexpr double rigid = 1e12;   // [N/m]

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

inline Vector3d with(const Vector3d& value, const Vector3d&, double) { return value; }
inline Triple<Dual> with(const Vector3d& value, const Vector3d& rate, Dual) {
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
inline bool is_axle(const Model& model) {
    return model.wheels.size() == 2 && model.wheels[0].side * model.wheels[1].side < 0;
}

// ---- Centres and axes.

// The solution of A P = b, of coincident lines the nearest; none of parallel ones. Two lines that
// coincide only here have a solution without derivative.
inline std::optional<Vector2d> crossing(const Eigen::Matrix2d& A, const Vector2d& b, double track) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix2d> lines;
    lines.setThreshold(1e-9);
    lines.compute(A);
    const Vector2d P = lines.solve(b);
    if ((A * P - b).norm() > 1e-9 * track || !(P.norm() <= nowhere)) return std::nullopt;
    return P;
}
inline std::optional<Eigen::Matrix<Dual, 2, 1>> crossing(const Eigen::Matrix<Dual, 2, 2>& A,
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
//
// `point`: of each wheel, the patch; its motion and its place are those of the line.
template <class S>
S roll_centre(const Wheels<S>& wheels, Placed<S> (Wheels<S>::*point)(std::size_t) const) {
    using std::abs;
    using Plane = Eigen::Matrix<S, 2, 1>;
    const auto seen = [](const Triple<S>& v) { return Plane(v.y(), v.z()); };
    if (!is_axle(wheels.model)) {
        const Placed<S> of = (wheels.*point)(0);
        const Triple<S> d = wheels.moved_by(wheels.response.travel[0], of);
        return ratio<S>(of.at.y() * d.y(), d.z(), nowhere) + of.at.z() - wheels.patch(0).at.z();
    }
    if (wheels.response.tied) return undefined;
    const MotionsOf<S> roll = rolled(wheels);
    Eigen::Matrix<S, 2, 2> A;
    Plane c[2], b;
    S above = S(0);  // the road
    for (std::size_t w = 0; w < 2; ++w) {
        const Placed<S> of = (wheels.*point)(w);
        c[w] = seen(of.at);
        above += (of.at.z() - wheels.patch(w).at.z()) / S(2);
        A.row(static_cast<Eigen::Index>(w)) =
            seen(wheels.moved_by(roll, of)).normalized().transpose();
    }
    const Plane middle = (c[0] + c[1]) / S(2);
    for (int w = 0; w < 2; ++w) b[w] = A.row(w).dot(c[w] - middle);
    const auto P = crossing(A, b, S(abs(c[0].x() - c[1].x())));
    return P ? P->y() + above : S(undefined);
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

// One formula, evaluated with doubles and with duals; k: wheel, or spring in Model::elastics, or
// damper; SI.
struct Formula {
    std::function<double(const Wheels<double>& wheels, std::size_t k)> value;
    std::function<Dual(const Wheels<Dual>& wheels, std::size_t k)> with_rate;

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
