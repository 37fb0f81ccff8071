// Characteristics by other definitions: rates, stiffnesses and centres as other tools have them.
#include <vector>

#include "compare/comparison/characteristic_formulas.hpp"

namespace elastocheck::compare::characteristic {
namespace {

constexpr double pneumatic_trail = 0.03;  // [m]

// A unit cause on this wheel, and `other` times as much on the other wheel of its axle.
Motions of_axle(const std::vector<std::array<Motions, causes>>& by, std::size_t w, int cause,
                double other) {
    std::vector<Motions> all;
    std::vector<double> weights;
    for (std::size_t k = 0; k < by.size(); ++k) {
        all.push_back(by[k][static_cast<std::size_t>(cause)]);
        weights.push_back(double(k == w ? 1 : other));
    }
    return sum(all, weights);
}
// A lateral force at the height of the road, `pneumatic_trail` behind the patch.
Motions behind(const Wheels& x, std::size_t w) {
    return sum({held(x, w, at_patch + 1), held(x, w, moment_on + 2)}, {1, -pneumatic_trail});
}

// The wheel loads stay: jacks and tyres give no more force. Empty where the wheel moves freely.
const Motions* unheld(const Wheels& x, std::size_t w, int cause) {
    return x.response.free.empty() ? nullptr : &x.response.free[w][static_cast<std::size_t>(cause)];
}

// The wheels stand on tyres, vertical rates at the patches. With z the rise of the patches without
// tyres and C that by forces f on them:
//
//   f = -k (z + C f)      (1 + k C) f = -k z
std::optional<Motions> on_tyres(const Wheels& x, std::size_t w, int cause) {
    const Motions* by = unheld(x, w, cause);
    if (by == nullptr) return std::nullopt;
    const std::size_t n = x.response.free.size();
    const auto rise = [&](const Motions& motions, std::size_t k) {
        return x.moved_by(motions, x.patch(k)).z();
    };
    std::vector<Motions> all{*by};
    std::vector<double> weights{1};
    std::vector<double> k(n), z(n);
    for (std::size_t i = 0; i < n; ++i) {
        k[i] = x[i].tyre_rate;
        z[i] = rise(*by, i);
        all.push_back(x.response.free[i][at_patch + 2]);
    }
    const auto entry = [&](std::size_t i, std::size_t j) {
        return double(i == j ? 1 : 0) + k[i] * rise(all[1 + j], i);
    };
    if (n == 1) {
        weights.push_back(-k[0] * z[0] / entry(0, 0));
    } else if (n == 2) {
        const double determinant = entry(0, 0) * entry(1, 1) - entry(0, 1) * entry(1, 0);
        weights.push_back((-k[0] * z[0] * entry(1, 1) + k[1] * z[1] * entry(0, 1)) / determinant);
        weights.push_back((-k[1] * z[1] * entry(0, 0) + k[0] * z[0] * entry(1, 0)) / determinant);
    } else {
        return std::nullopt;
    }
    return sum(all, weights);
}

double nothing(const Wheels& x) { return x.response.nothing_resists ? undefined : nan; }

// Vertical force on all wheels alike over the rise of a point.
double vertical_rate(const Wheels& x, std::size_t w, int force, const Placed& at) {
    if (x.response.free.empty()) return nothing(x);
    return ratio(1, x.moved_by(of_axle(x.response.free, w, force, 1), at).z(), rigid);
}

// Milliken's figure for all of the braking or driving force at this axle.
double anti_of_whole(const Wheels& x, const Placed& at, double sign) {
    const Vehicle& vehicle = *x.model.vehicle;
    return sign * forward_per_travel(x, at) * vehicle.wheelbase / vehicle.cg_height;
}

double mean_rise_of_patches(const Wheels& x) {
    const Motions motions = raised(x, 0);
    double rise = 0;
    for (std::size_t w = 0; w < x.model.wheels.size(); ++w)
        rise += x.moved_by(motions, x.patch(w)).z() / double(x.model.wheels.size());
    return rise;
}
// Length of the path of the patches per travel of the wheel centres, their mean.
double mean_path_of_patches(const Wheels& x) {
    using std::sqrt;
    const Motions motions = raised(x, 0);
    double path = 0;
    for (std::size_t w = 0; w < x.model.wheels.size(); ++w)
        path += sqrt(x.moved_by(motions, x.patch(w)).squaredNorm()) / double(x.model.wheels.size());
    return path;
}
double spring_ratio(const Wheels& x, std::size_t k) {
    const auto& spring = std::get<AxialSpring>(x.model.elastics[k].kind);
    return shortening(x, x.point(spring.i), x.point(spring.j));
}
double damper_ratio(const Wheels& x, std::size_t k) {
    const auto& damper = x.model.dampers[k];
    return shortening(x, x.point(damper.i), x.point(damper.j));
}

// Lateral forces on all patches in one direction, with vertical ones that keep the wheel centres at
// their height (of an axle: from rolling); the roll centre is where the resultant acts. With C the
// rise of the centres, of an axle that of the left less that of the right one:
//
//   f_z = -f_y C_y / C_z      h = -(t/2) f_z / f_y      t/2 = y of the patch of one wheel
double roll_centre_by_forces(const Wheels& x) {
    if (x.response.free.empty()) return nothing(x);
    if (!is_axle(x.model)) {
        const auto& free = x.response.free[0];
        const Placed centre = x.centre(0);
        return ratio(x.patch(0).at.y() * x.moved_by(free[at_patch + 1], centre).z(),
                     x.moved_by(free[at_patch + 2], centre).z(), nowhere);
    }
    if (x.response.tied) return undefined;
    const std::size_t left = x.model.wheels[0].side > 0 ? 0 : 1, right = 1 - left;
    const Motions sideways = of_axle(x.response.free, left, at_patch + 1, 1),
                  couple = of_axle(x.response.free, left, at_patch + 2, -1);
    const auto roll = [&](const Motions& motions) -> double {
        return x.moved_by(motions, x.centre(left)).z() - x.moved_by(motions, x.centre(right)).z();
    };
    return ratio((x.patch(left).at.y() - x.patch(right).at.y()) / 2 * roll(sideways), roll(couple),
                 nowhere);
}

double tilt(const Wheels& x, std::size_t w, bool from_the_side) {
    using std::atan2;
    const auto axis = steering_axis(x, w);
    if (!axis) return undefined;
    return from_the_side ? double(atan2(-axis->n.x(), axis->n.z()))
                         : double(atan2(-x.side(w) * axis->n.y(), axis->n.z()));
}

constexpr auto rigs = "suspension test rigs";
constexpr auto instant_axis = "virtual steering axis of multi-link suspensions";

const Entry list[] = {
    {Owner::every_wheel, "bump_steer@patch", Unit::deg_per_m,
     "change of toe over the vertical displacement of the contact patch, all wheels rising alike",
     never,
     [](const auto& x, std::size_t w) {
         const auto by = raised(x, w);
         return ratio(x.toe(w, by), x.moved_by(by, x.patch(w)).z(), nowhere);
     },
     false, false, "deflection counted at the tyre"},
    {Owner::wheel_of_axle, "bump_steer@alone", Unit::deg_per_m,
     "change of toe over travel of this wheel centre, the other one held at its height",
     does_not_roll,
     [](const auto& x, std::size_t w) {
         return x.response.tied ? undefined : x.toe(w, x.response.travel[w]);
     },
     false, false, "single wheel travel"},
    {Owner::every_wheel, "front_view_swing_arm@patch", Unit::mm,
     "lateral distance from the contact patch to the instant centre of the carrier seen from the "
     "front; positive inboard",
     "the carrier does not rotate as seen from the front: the arm is infinite",
     [](const auto& x, std::size_t w) {
         const auto by = raised(x, w);
         return ratio(x.side(w) * x.moved_by(by, x.centre(w)).z(), x.turned_by(by, x[w].body).x(),
                      nowhere) +
                x.side(w) * (x.patch(w).at.y() - x.centre(w).at.y());
     },
     true, false, "SAE J670e: swing arm radius, from the centre of tire contact"},
    {Owner::every_wheel, "front_view_swing_arm@camber", Unit::mm,
     "travel of the wheel centre over change of camber, its sign turned; positive where jounce "
     "leans the top in",
     "camber does not change: the arm is infinite",
     [](const auto& x, std::size_t w) { return ratio(-1, x.camber(w, raised(x, w)), nowhere); },
     true, false, "rigs, which measure camber over travel"},
    {Owner::every_wheel, "side_view_swing_arm@patch", Unit::mm,
     "longitudinal distance from the contact patch to the instant centre of the carrier seen from "
     "the side; positive ahead of the wheel",
     "the carrier does not rotate as seen from the side: the arm is infinite",
     [](const auto& x, std::size_t w) {
         const auto by = raised(x, w);
         return ratio(x.moved_by(by, x.centre(w)).z(), x.turned_by(by, x[w].body).y(), nowhere) +
                x.centre(w).at.x() - x.patch(w).at.x();
     },
     true, false, "drawings in side view"},
    {Owner::every_wheel, "wheel_rate@patch", Unit::newton_per_mm,
     "vertical force over vertical displacement, both of the contact patch, all wheels with the "
     "same load",
     no_rate,
     [](const auto& x, std::size_t w) { return vertical_rate(x, w, at_patch + 2, x.patch(w)); },
     false, true, "rigs, which measure the pad under the tyre less the tyre's deflection"},
    {Owner::every_wheel, "wheel_rate@centre", Unit::newton_per_mm,
     "vertical force over vertical displacement, both of the wheel centre, all wheels with the "
     "same "
     "load",
     no_rate,
     [](const auto& x, std::size_t w) { return vertical_rate(x, w, at_centre + 2, x.centre(w)); },
     false, true, "programs that load the spindle"},
    {Owner::wheel_of_axle, "wheel_rate@alone", Unit::newton_per_mm,
     "vertical force at the contact patch over vertical displacement of the wheel centre, the "
     "other "
     "wheel with its load unchanged",
     no_rate,
     [](const auto& x, std::size_t w) {
         if (x.response.free.empty()) return nothing(x);
         return ratio(1, x.moved_by(x.response.free[w][at_patch + 2], x.centre(w)).z(), rigid);
     },
     false, true, "single wheel bump"},
    {Owner::axle, "wheel_rate@axle", Unit::newton_per_mm, "sum of the wheel rates of both wheels",
     no_rate,
     [](const auto& x, std::size_t) {
         return wheel_rate(x, 0, Pattern::alike) + wheel_rate(x, 1, Pattern::alike);
     },
     false, true, "axle rate; ride models of half a car"},
    {Owner::spring, "motion_ratio@inverse", Unit::none,
     "travel of the wheel centres over shortening of the spring",
     "the spring does not move with the wheel",
     [](const auto& x, std::size_t k) { return ratio(1, spring_ratio(x, k), nowhere); }, false,
     false, "wheel travel over spring travel; a manufacturer's table (tests/outside/README.md)"},
    {Owner::spring, "motion_ratio@patch", Unit::none,
     "shortening of the spring over the vertical displacement of the contact patches, their mean",
     never,
     [](const auto& x, std::size_t k) {
         return ratio(spring_ratio(x, k), mean_rise_of_patches(x), nowhere);
     },
     false, false, "deflection counted at the tyre"},
    {Owner::spring, "motion_ratio@patch_inverse", Unit::none,
     "vertical displacement of the contact patches, their mean, over shortening of the spring",
     "the spring does not move with the wheel",
     [](const auto& x, std::size_t k) {
         return ratio(mean_rise_of_patches(x), spring_ratio(x, k), nowhere);
     },
     false, false, "deflection at the tyre over spring travel"},
    {Owner::spring, "motion_ratio@patch_path", Unit::none,
     "path of the contact patches in space, their mean, over shortening of the spring",
     "the spring does not move with the wheel",
     [](const auto& x, std::size_t k) {
         return ratio(mean_path_of_patches(x), spring_ratio(x, k), nowhere);
     },
     false, false, "OptimumK: wheel displacement over spring displacement"},
    {Owner::damper, "motion_ratio@inverse", Unit::none,
     "travel of the wheel centres over shortening of the damper",
     "the damper does not move with the wheel",
     [](const auto& x, std::size_t k) { return ratio(1, damper_ratio(x, k), nowhere); }, false,
     false, "wheel travel over damper travel"},
    {Owner::damper, "motion_ratio@patch", Unit::none,
     "shortening of the damper over the vertical displacement of the contact patches, their mean",
     never,
     [](const auto& x, std::size_t k) {
         return ratio(damper_ratio(x, k), mean_rise_of_patches(x), nowhere);
     },
     false, false, "deflection counted at the tyre"},
    {Owner::damper, "motion_ratio@patch_inverse", Unit::none,
     "vertical displacement of the contact patches, their mean, over shortening of the damper",
     "the damper does not move with the wheel",
     [](const auto& x, std::size_t k) {
         return ratio(mean_rise_of_patches(x), damper_ratio(x, k), nowhere);
     },
     false, false, "deflection at the tyre over damper travel"},
    {Owner::damper, "motion_ratio@patch_path", Unit::none,
     "path of the contact patches in space, their mean, over shortening of the damper",
     "the damper does not move with the wheel",
     [](const auto& x, std::size_t k) {
         return ratio(mean_path_of_patches(x), damper_ratio(x, k), nowhere);
     },
     false, false, "OptimumK: wheel displacement over damper displacement"},
    {Owner::front_wheel, "anti_dive@inboard", Unit::percent,
     "brake_share · wheelbase / cg_height · forward over vertical displacement of the wheel "
     "centre: "
     "inboard brakes, whose torque the car body carries",
     no_vertical,
     [](const auto& x, std::size_t w) { return anti(x, x.centre(w), &Vehicle::brake_share, 1); },
     false, false, "inboard brakes"},
    {Owner::front_wheel, "anti_dive@whole", Unit::percent,
     "wheelbase / cg_height · forward over vertical displacement of the contact patch: per cent of "
     "the load transfer if this axle braked alone",
     no_vertical, [](const auto& x, std::size_t w) { return anti_of_whole(x, x.braked(w), 1); },
     false, false, "programs without a brake distribution"},
    {Owner::front_wheel, "anti_lift@outboard", Unit::percent,
     "drive_share · wheelbase / cg_height · forward over vertical displacement of the contact "
     "patch: "
     "the carrier carries the drive torque",
     no_vertical,
     [](const auto& x, std::size_t w) { return anti(x, x.braked(w), &Vehicle::drive_share, 1); },
     false, false, "wheel hub motors; live axles"},
    {Owner::rear_wheel, "anti_lift@inboard", Unit::percent,
     "brake_share · wheelbase / cg_height · rearward over vertical displacement of the wheel "
     "centre: inboard brakes, whose torque the car body carries",
     no_vertical,
     [](const auto& x, std::size_t w) { return anti(x, x.centre(w), &Vehicle::brake_share, -1); },
     false, false, "inboard brakes"},
    {Owner::rear_wheel, "anti_lift@whole", Unit::percent,
     "wheelbase / cg_height · rearward over vertical displacement of the contact patch: per cent "
     "of "
     "the load transfer if this axle braked alone",
     no_vertical, [](const auto& x, std::size_t w) { return anti_of_whole(x, x.braked(w), -1); },
     false, false, "programs without a brake distribution"},
    {Owner::rear_wheel, "anti_squat@outboard", Unit::percent,
     "drive_share · wheelbase / cg_height · rearward over vertical displacement of the contact "
     "patch: the carrier carries the drive torque",
     no_vertical,
     [](const auto& x, std::size_t w) { return anti(x, x.braked(w), &Vehicle::drive_share, -1); },
     false, false, "wheel hub motors; live axles"},
    {Owner::rear_wheel, "anti_squat@whole", Unit::percent,
     "wheelbase / cg_height · rearward over vertical displacement of the wheel centre (of a rigid "
     "axle the patch): per cent of the load transfer if this axle drove alone",
     no_vertical,
     [](const auto& x, std::size_t w) { return anti_of_whole(x, driven_at(x, w), -1); }, false,
     false, "rear wheel drive: the same figure"},
    {Owner::every_wheel, "lateral_force_steer@centre", Unit::deg_per_kN,
     "change of toe over a force at the wheel centre of this wheel alone towards the middle of the "
     "vehicle, wheel centres held at their height",
     never,
     [](const auto& x, std::size_t w) {
         return inward(x, w) * x.toe(w, held(x, w, at_centre + 1));
     },
     false, false, "programs that load the spindle"},
    {Owner::every_wheel, "lateral_force_steer@trail", Unit::deg_per_kN,
     "change of toe over a force towards the middle of the vehicle that acts on the road 30 mm "
     "behind the contact patch of this wheel alone, wheel centres held at their height",
     never, [](const auto& x, std::size_t w) { return inward(x, w) * x.toe(w, behind(x, w)); },
     false, false, "rigs with a pneumatic trail of 30 mm"},
    {Owner::every_wheel, "lateral_force_steer@constant_load", Unit::deg_per_kN,
     "change of toe over a force at the contact patch of this wheel alone towards the middle of "
     "the vehicle, the wheel loads unchanged and the wheels free to rise",
     "the travel of the wheel is unresisted",
     [](const auto& x, std::size_t w) {
         const auto* by = unheld(x, w, at_patch + 1);
         return by == nullptr ? nothing(x) : inward(x, w) * x.toe(w, *by);
     },
     false, true, "programs whose wheels are free"},
    {Owner::wheel_on_tyre, "lateral_force_steer@on_tyres", Unit::deg_per_kN,
     "change of toe over a force at the contact patch of this wheel alone towards the middle of "
     "the vehicle, the wheels on their tyres",
     "the travel of the wheel is unresisted",
     [](const auto& x, std::size_t w) {
         const auto by = on_tyres(x, w, at_patch + 1);
         return by ? inward(x, w) * x.toe(w, *by) : nothing(x);
     },
     false, true, "rigs that load the tyre"},
    {Owner::every_wheel, "braking_force_steer@inboard", Unit::deg_per_kN,
     "change of toe over a force to the back at the wheel centre of this wheel alone, wheel "
     "centres held at their height: the car body carries the brake torque",
     never, [](const auto& x, std::size_t w) { return -x.toe(w, held(x, w, at_centre)); }, false,
     false, "inboard brakes; wheel free to roll"},
    {Owner::every_wheel, "traction_force_steer@patch", Unit::deg_per_kN,
     "change of toe over a force forward at the contact patch of this wheel alone, wheel centres "
     "held at their height: the carrier carries the drive torque",
     never, [](const auto& x, std::size_t w) { return x.toe(w, held(x, w, at_patch)); }, false,
     false, "wheel hub motors; rigs with the wheel locked"},
    {Owner::steered_wheel, "caster@instant_axis", Unit::deg,
     "angle to the vertical seen from the side of the axis about which the carrier turns when the "
     "steering moves, wheel centres held at their height",
     does_not_steer, [](const auto& x, std::size_t w) { return tilt(x, w, true); }, false, false,
     instant_axis},
    {Owner::steered_wheel, "kingpin_inclination@instant_axis", Unit::deg,
     "angle to the vertical seen from the front of the axis about which the carrier turns when the "
     "steering moves, wheel centres held at their height",
     does_not_steer, [](const auto& x, std::size_t w) { return tilt(x, w, false); }, false, false,
     instant_axis},
    {Owner::steered_wheel, "scrub_radius@instant_axis", Unit::mm,
     "distance across the wheel from the contact patch to the point on the road of the axis about "
     "which the carrier turns when the steering moves, positive inboard",
     does_not_steer,
     [](const auto& x, std::size_t w) {
         const auto axis = steering_axis(x, w);
         return axis ? -across(x, w).dot(on_the_road(x, w, *axis)) : undefined;
     },
     false, false, instant_axis},
    {Owner::steered_wheel, "mechanical_trail@instant_axis", Unit::mm,
     "distance along the wheel from the contact patch to the point on the road of the axis about "
     "which the carrier turns when the steering moves, positive in front",
     does_not_steer,
     [](const auto& x, std::size_t w) {
         const auto axis = steering_axis(x, w);
         return axis ? along(x, w).dot(on_the_road(x, w, *axis)) : undefined;
     },
     false, false, instant_axis},
    {Owner::wheels, "roll_centre_height@centre", Unit::mm,
     "height above the contact patches of the intersection of the lines that are perpendicular, "
     "seen from the front, to the motion of the wheel centres and pass through them",
     "no finite roll centre",
     [](const auto& x, std::size_t) { return roll_centre(x, &std::decay_t<decltype(x)>::centre); },
     false, false, "tracks that are measured at the wheel centres"},
    {Owner::wheels, "roll_centre_height@forces", Unit::mm,
     "height above the contact patches of the point at which a lateral force on the body leaves "
     "the "
     "wheel centres at their height (of an axle: the body without roll), the same lateral force on "
     "each patch, elements included",
     "no finite roll centre", [](const auto& x, std::size_t) { return roll_centre_by_forces(x); },
     false, true, "SAE J670e: roll center; force-based roll centre"},
    {Owner::wheel_of_axle, "roll_camber@road", Unit::deg_per_deg,
     "change of camber against the road over the roll of the car body towards this wheel; positive "
     "where the top leans out",
     does_not_roll,
     [](const auto& x,
        std::size_t
            w) { return x.response.tied ? undefined : x.camber(w, rolled_towards(x, w)) + 1; },
     false, false, "inclination to the ground"},
};

}  // namespace

std::span<const Entry> by_other_definitions() { return list; }

}  // namespace elastocheck::compare::characteristic
