// Figures from the response of a state: rates over travel, roll and steering, stiffnesses, centres. Each
// is an exact rate by the tangent of the leg that found the state, never a difference of two points, and
// has the same value for a wheel and for its mirror image.
#include <algorithm>
#include <optional>
#include <utility>

#include "compare/outputs/catalogue/motions.hpp"
#include "compare/outputs/catalogue/wishbones.hpp"
#include "compare/outputs/fixed_bodies.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

constexpr double pneumatic_trail = 0.03;  // [m]

// Reasons why a figure may be undefined.
constexpr auto always_defined = "";
constexpr auto no_vertical = "the wheel does not rise";
constexpr auto does_not_steer = "the steering does not turn the wheel about an upright axis here";
constexpr auto unresisted = "the travel of the wheel is unresisted";
constexpr auto endless_in_front =
    "the carrier does not rotate as seen from the front: the arm is infinite";
constexpr auto endless_from_side =
    "the carrier does not rotate as seen from the side: the arm is infinite";
constexpr auto axis_elsewhere = "instantaneous, virtual or compliance-based steering axis";
constexpr auto milliken =
    "Milliken and Milliken, *Race Car Vehicle Dynamics*, ch. 17; needs `vehicle` in the scene";
constexpr auto instant_axis = "virtual steering axis of multi-link suspensions";

// ---- Centres and axes.

// Instant centre of the carrier in side and front view, relative to the wheel centre, with v the
// velocity of that centre and ω the angular velocity of the carrier:
//   from the side   (x, z): (v_z, -v_x) / ω_y      from the front   (y, z): (-v_z, v_y) / ω_x
double front_view_arm(const Subject& x) {
    const Motions heave = heave_motions(x);
    return ratio(x.side() * x.displacement(heave, x.centre()).z(), x.rotation(heave).x(),
                 max_distance);
}
double side_view_arm(const Subject& x) {
    const Motions heave = heave_motions(x);
    return ratio(x.displacement(heave, x.centre()).z(), x.rotation(heave).y(), max_distance);
}

// Virtual steering axis: screw axis of the carrier when the rack moves at constant wheel-centre height.
// n: its direction, upward; it passes through c + ω × v / ω², c the wheel centre and v its velocity.
struct Axis {
    Vector3d n, through;
};
std::optional<Axis> steering_axis(const Subject& x) {
    if (x.response->steering.empty()) return std::nullopt;
    const Vector3d omega = x.rotation(x.response->steering),
                   v = x.displacement(x.response->steering, x.centre());
    const double rate = omega.norm();
    if (!(v.norm() <= max_distance * rate) || !(std::abs(omega.z()) > 1e-6 * rate))
        return std::nullopt;
    return Axis{omega.normalized() * (omega.z() > 0 ? 1 : -1),
                x.centre().position + omega.cross(v) / omega.squaredNorm()};
}
double caster_steered(const Subject& x) {
    const auto axis = steering_axis(x);
    return axis ? std::atan2(-axis->n.x(), axis->n.z()) : undefined;
}
double kingpin_steered(const Subject& x) {
    const auto axis = steering_axis(x);
    return axis ? std::atan2(-x.side() * axis->n.y(), axis->n.z()) : undefined;
}
// Vector from the patch to the intersection of the axis with the road [m].
Vector3d patch_to_axis_on_road(const Subject& x, const Axis& axis) {
    const Vector3d patch = x.patch().position;
    return axis.through + axis.n * ((patch.z() - axis.through.z()) / axis.n.z()) - patch;
}
double scrub_steered(const Subject& x) {
    const auto axis = steering_axis(x);
    return axis ? -x.across().dot(patch_to_axis_on_road(x, *axis)) : undefined;
}
double trail_steered(const Subject& x) {
    const auto axis = steering_axis(x);
    return axis ? x.along().dot(patch_to_axis_on_road(x, *axis)) : undefined;
}
double steer_gradient(const Subject& x) {
    return x.response->steering.empty() ? undefined : x.toe(x.response->steering);
}
double overall_steering_ratio(const Subject& x) {
    if (x.response->steering.empty()) return undefined;
    double to_the_left =
        0;  // sum of the steer angles of the wheels per displacement of the rack [rad/m]
    for (std::size_t w = 0; w < x.model.wheels.size(); ++w)
        to_the_left -= x.other_wheel(w).side() * x.other_wheel(w).toe(x.response->steering);
    const auto n = static_cast<double>(x.model.wheels.size());
    return ratio(n / x.response->rack_per_hand_wheel, to_the_left, max_distance);
}

// ---- Stiffness and rates.

double wheel_rate(const Subject& x) { return vertical_rate(x, first_patch_force + 2, x.centre()); }
double ride_rate(const Subject& x) {
    const double k_w = wheel_rate(x), k_t = x.wheel().tyre_rate;
    return std::isinf(k_w) ? undefined : k_w * k_t / (k_w + k_t);
}

// Share of the load transfer that the links carry instead of the springs, axle share · tan φ · wheelbase /
// height of the centre of gravity (Milliken & Milliken, Race Car Vehicle Dynamics, 1995, ch. 17): by
// virtual work the links carry the vertical force tan φ = dx / dz per unit of longitudinal force at a
// point that all wheels, raised together, move by (dx, dz).
double anti(const Subject& x, const PlacedPoint& point, double share, double sign) {
    const Vector3d d = x.displacement(heave_motions(x.other_wheel(0)), point);
    const Vehicle& vehicle = *x.model.vehicle;
    return sign * share * ratio(d.x(), d.z(), max_distance) * vehicle.wheelbase / vehicle.cg_height;
}
// The same share with the instant centre of the side view as drawn by hand: the planes of the two wishbones
// meet the longitudinal plane through the wheel centre in two lines, and these in (x, z).
double anti_by_planes(const Subject& x, const Vector3d& patch, double share, double sign) {
    const auto planes = wishbone_planes(x);
    if (planes.size() != 2) return undefined;
    const double y = x.centre().position.y();
    Eigen::Matrix2d A;
    Vector2d b;
    for (int k = 0; k < 2; ++k) {
        const Vector3d& n = planes[static_cast<std::size_t>(k)].normal;
        A.row(k) << n.x(), n.z();
        b[k] = planes[static_cast<std::size_t>(k)].offset - n.y() * y;
    }
    // slope to the instant centre (x, z) = N / determinant by Cramer's rule, also if that is at infinity
    const double determinant = A.determinant(),
                 rise = A(0, 0) * b[1] - A(1, 0) * b[0] - determinant * patch.z(),
                 run = b[0] * A(1, 1) - b[1] * A(0, 1) - determinant * patch.x();
    const Vehicle& vehicle = *x.model.vehicle;
    return sign * share * ratio(rise, -run, max_distance) * vehicle.wheelbase / vehicle.cg_height;
}
double brake_share(const Subject& x) { return x.model.vehicle->brake_share; }
double drive_share(const Subject& x) { return x.model.vehicle->drive_share; }
// Point at which a driving force acts on the links: the patch where an axle housing carries the drive
// torque, the wheel centre where the car body carries it through a shaft.
PlacedPoint driving_force_point(const Subject& x) {
    const bool housing =
        is_axle(x.model) &&
        FixedBodies(x.model).are_one(x.other_wheel(0).wheel().body, x.other_wheel(1).wheel().body);
    return housing ? x.braked_patch() : x.centre();
}

// ---- Springs and dampers.

// Shortening of a spring or damper per travel of the wheel centres.
double shortening(const Subject& x, const PlacedPoint& i, const PlacedPoint& j) {
    const Motions motions = heave_motions(x.other_wheel(0));
    const Vector3d D = j.position - i.position,
                   dD = x.displacement(motions, j) - x.displacement(motions, i);
    return -(D.dot(dD) / D.norm());
}
double spring_ratio(const Subject& x) {
    const auto& spring = std::get<AxialSpring>(x.model.elastics[x.k].kind);
    return shortening(x, x.placed(spring.i), x.placed(spring.j));
}
double damper_ratio(const Subject& x) {
    const Damper& damper = x.model.dampers[x.k];
    return shortening(x, x.placed(damper.i), x.placed(damper.j));
}
// Mean over the patches of a function of their displacements per travel of the wheel centres.
double mean_of_patches(const Subject& x, double (*function)(const Vector3d& displacement)) {
    const Motions motions = heave_motions(x.other_wheel(0));
    double mean = 0;
    for (std::size_t w = 0; w < x.model.wheels.size(); ++w)
        mean += function(x.displacement(motions, x.other_wheel(w).patch())) /
                double(x.model.wheels.size());
    return mean;
}
double mean_rise(const Subject& x) {
    return mean_of_patches(x, [](const Vector3d& d) { return d.z(); });
}
double mean_path(const Subject& x) {
    return mean_of_patches(x, [](const Vector3d& d) { return std::sqrt(d.squaredNorm()); });
}

// ---- Compliance under a lateral force by other definitions.

// Sign towards the middle of the vehicle, for equal values of a wheel and its mirror image.
double inward(const Subject& x) { return -x.side(); }

// The wheels stand on tyres, vertical rates at the patches. With z the rise of the patches without
// tyres and C that by forces f on them:
//
//   f = -k (z + C f)      (1 + k C) f = -k z      by Cramer's rule for one or two wheels
double steer_on_tyres(const Subject& x) {
    const Motions* under_force = motions_at_fixed_load(x, first_patch_force + 1);
    const auto& free = x.response->free;
    const std::size_t n = free.size();
    if (under_force == nullptr || n > 2) return value_without_free_response(x);
    const auto rise = [&](const Motions& motions, std::size_t w) {
        return x.displacement(motions, x.other_wheel(w).patch()).z();
    };
    const auto k = [&](std::size_t w) { return x.other_wheel(w).wheel().tyre_rate; };
    const auto entry = [&](std::size_t i, std::size_t j) {
        return double(i == j ? 1 : 0) + k(i) * rise(free[j][first_patch_force + 2], i);
    };
    std::vector<std::pair<double, const Motions*>> weighted{{1, under_force}};
    const double determinant =
        n == 1 ? entry(0, 0) : entry(0, 0) * entry(1, 1) - entry(0, 1) * entry(1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        double f = -k(i) * rise(*under_force, i);
        if (n == 2)
            f = f * entry(1 - i, 1 - i) + k(1 - i) * rise(*under_force, 1 - i) * entry(i, 1 - i);
        weighted.emplace_back(f / determinant, &free[i][first_patch_force + 2]);
    }
    return inward(x) * x.toe(weighted_sum(weighted));
}
// The lateral force acts at the height of the road, `pneumatic_trail` behind the patch.
double steer_with_trail(const Subject& x) {
    return inward(x) *
           x.toe(weighted_sum({{1, &motions_at_fixed_height(x, first_patch_force + 1)},
                               {-pneumatic_trail, &motions_at_fixed_height(x, first_moment + 2)}}));
}

// ---- The entries.

const Drawing steering_ratio{DrawnAbscissa::steering, 3, "Steering ratio", "to the left positive",
                             Presentation::to_the_left},
    installed{DrawnAbscissa::springs, 2, "Motion ratio", "shortening over wheel travel"};

const Entry over_travel[] = {
    Entry(Owner::wheel, "bump_steer", Unit::deg_per_m,
          "change of toe over travel of the wheel centre, all wheels rising by the same amount; "
          "positive towards toe-in in jounce",
          always_defined, [](const Subject& x) { return x.toe(heave_motions(x)); },
          {.sources = "ride steer, toe gradient",
           .is_key_figure = true,
           .explained = true,
           .live_rank = {.heave = 8}}),
    Entry(Owner::wheel, "bump_camber", Unit::deg_per_100mm,
          "change of camber over travel of the wheel centre, all wheels rising by the same amount; "
          "positive where the top leans out in jounce",
          always_defined, [](const Subject& x) { return x.camber(heave_motions(x)); },
          {.sources = "ride camber, camber gain", .is_key_figure = true, .explained = true}),
    Entry(
        Owner::wheel, "track_gradient", Unit::mm_per_100mm,
        "lateral displacement of the contact patch over travel, all wheels rising by the same "
        "amount; positive outwards in jounce",
        always_defined,
        [](const Subject& x) { return x.side() * x.displacement(heave_motions(x), x.patch()).y(); },
        {.sources = "half-track change, lateral scrub"}),
    Entry(Owner::wheel, "recession_gradient", Unit::mm_per_100mm,
          "longitudinal displacement of the wheel centre over travel, all wheels rising by the "
          "same amount; positive to the back in jounce",
          always_defined,
          [](const Subject& x) { return -x.displacement(heave_motions(x), x.centre()).x(); },
          {.sources = "wheel recession"}),
    Entry(Owner::wheel, "front_view_swing_arm", Unit::mm,
          "lateral distance from the wheel centre to the instant centre of the carrier seen from "
          "the front, all wheels rising by the same amount; positive inboard",
          endless_in_front, front_view_arm,
          {.sources = "fvsa, virtual swing axle; d camber = −travel / arm",
           .swing_arm = true,
           .drawings = {{DrawnAbscissa::travel, 10, "Swing arm seen from the front",
                         "inboard positive"}}}),
    Entry(Owner::wheel, "side_view_swing_arm", Unit::mm,
          "longitudinal distance from the wheel centre to the instant centre of the carrier seen "
          "from the side, all wheels rising by the same amount; positive ahead of the wheel",
          endless_from_side, side_view_arm,
          {.sources = "svsa",
           .swing_arm = true,
           .drawings = {{DrawnAbscissa::travel, 11, "Swing arm seen from the side",
                         "ahead of the wheel positive"}}}),
    Entry(Owner::wheel, std::string(figure::wheel_rate), Unit::newton_per_mm,
          "vertical force at the contact patch over vertical displacement of the wheel centre, all "
          "wheels with the same load",
          no_rate, wheel_rate,
          {.sources = "SAE J670: suspension rate at the wheel",
           .is_key_figure = true,
           .explained = true,
           .live_rank = {.heave = 4},
           .block = {"wheel_rate"},
           .plausible_range = {-INFINITY, 2000, "is a rate in another unit?"},
           .drawings = {{DrawnAbscissa::travel, 7, "Wheel rate",
                         "both wheels loaded alike, without the tyre"}}}),
};

const Entry of_response[] = {
    Entry(Owner::wheel_on_tyre, "ride_rate", Unit::newton_per_mm,
          "wheel rate and vertical rate of the tyre in series: 1 / (1/k_wheel + 1/k_tyre)", no_rate,
          ride_rate,
          {.is_key_figure = true,
           .drawings = {{DrawnAbscissa::travel, 8, "Ride rate", "wheel rate and tyre in series"}}}),
    Entry(Owner::wheel_on_rack, "steer_gradient", Unit::deg_per_mm,
          "change of toe over the displacement of the steering joint, wheel centres held at their "
          "height; positive towards toe-in",
          not_steered, steer_gradient,
          {.is_key_figure = true,
           .live_rank = {.steering = 2},
           .cause = "steering",
           .drawings = {steering_ratio}}),
    Entry(Owner::wheel_on_column, "steer_gradient", Unit::deg_per_deg,
          "change of toe over the angle of the steering joint, wheel centres held at their height; "
          "positive towards toe-in",
          not_steered, steer_gradient,
          {.is_key_figure = true,
           .live_rank = {.steering = 2},
           .cause = "steering",
           .drawings = {steering_ratio}}),
    Entry(Owner::hand_wheel, "steering_ratio", Unit::none,
          "change of the angle of the hand wheel over the mean change of the steer angles of the "
          "wheels, wheel centres held at their height; positive where a positive angle steers to "
          "the left",
          not_steered, overall_steering_ratio,
          {.sources = "ISO 8855, SAE J670: overall steering ratio",
           .is_key_figure = true,
           .cause = "steering",
           .drawings = {{DrawnAbscissa::steering, 7, "Overall steering ratio",
                         "hand wheel over the mean of the wheels"}}}),
    Entry(
        Owner::steered_wheel, "caster_steered", Unit::deg,
        "angle to the vertical seen from the side of the axis about which the carrier turns when "
        "the steering moves, wheel centres held at their height; positive where its top leans back",
        does_not_steer, caster_steered, {.sources = axis_elsewhere, .cause = "steering"}),
    Entry(Owner::steered_wheel, "kingpin_inclination_steered", Unit::deg,
          "angle to the vertical seen from the front of the same axis; positive where its top "
          "leans inwards",
          does_not_steer, kingpin_steered, {.sources = axis_elsewhere, .cause = "steering"}),
    Entry(Owner::steered_wheel, "scrub_radius_steered", Unit::mm,
          "distance across the wheel from the contact patch to the intersection of the same axis "
          "with the road, positive inboard",
          does_not_steer, scrub_steered, {.sources = axis_elsewhere, .cause = "steering"}),
    Entry(Owner::steered_wheel, "mechanical_trail_steered", Unit::mm,
          "distance along the wheel from the contact patch to the intersection of the same axis "
          "with the road, positive in front",
          does_not_steer, trail_steered, {.sources = axis_elsewhere, .cause = "steering"}),
    Entry(Owner::front_wheel, std::string(figure::anti_dive), Unit::percent,
          "brake_share · wheelbase / cg_height · forward over vertical displacement of the contact "
          "patch: share of the load transfer under braking that the links carry; positive where "
          "they resist dive",
          no_vertical,
          [](const Subject& x) { return anti(x, x.braked_patch(), brake_share(x), 1); },
          {.sources = milliken,
           .is_key_figure = true,
           .explained = true,
           .live_rank = {.heave = 5},
           .drawings = {{DrawnAbscissa::travel, 12, "Anti-dive",
                         "positive where the links resist"}}}),
    Entry(Owner::front_wheel, std::string(figure::anti_lift), Unit::percent,
          "drive_share · wheelbase / cg_height · forward over vertical displacement of the wheel "
          "centre (of a rigid axle the patch); positive where the links resist lift of the front "
          "when the axle drives",
          no_vertical,
          [](const Subject& x) { return anti(x, driving_force_point(x), drive_share(x), 1); },
          {.sources = milliken,
           .drawings = {{DrawnAbscissa::travel, 13, "Anti-lift",
                         "positive where the links resist"}}}),
    Entry(Owner::rear_wheel, std::string(figure::anti_lift), Unit::percent,
          "brake_share · wheelbase / cg_height · rearward over vertical displacement of the "
          "contact patch: share of the load transfer under braking that the links carry; positive "
          "where they resist lift of the rear",
          no_vertical,
          [](const Subject& x) { return anti(x, x.braked_patch(), brake_share(x), -1); },
          {.sources = milliken,
           .drawings = {{DrawnAbscissa::travel, 13, "Anti-lift",
                         "positive where the links resist"}}}),
    Entry(Owner::rear_wheel, "anti_squat", Unit::percent,
          "drive_share · wheelbase / cg_height · rearward over vertical displacement of the wheel "
          "centre (of a rigid axle the patch); positive where the links resist squat when the axle "
          "drives",
          no_vertical,
          [](const Subject& x) { return anti(x, driving_force_point(x), drive_share(x), -1); },
          {.sources = milliken,
           .is_key_figure = true,
           .live_rank = {.heave = 5},
           .drawings = {{DrawnAbscissa::travel, 12, "Anti-squat",
                         "positive where the links resist"}}}),
};

const Entry of_springs[] = {
    Entry(
        Owner::spring, "motion_ratio", Unit::none,
        "shortening of the spring over travel of the wheel centres, all rising by the same amount",
        always_defined, spring_ratio,
        {.sources = "installation ratio; its inverse has the same name elsewhere",
         .drawings = {installed}}),
    Entry(
        Owner::damper, "motion_ratio", Unit::none,
        "shortening of the damper over travel of the wheel centres, all rising by the same amount",
        always_defined, damper_ratio,
        {.sources = "installation ratio; its inverse has the same name elsewhere",
         .drawings = {installed}}),
};

const Entry rate_definitions[] = {
    Entry(Owner::wheel, "bump_steer@patch", Unit::deg_per_m,
          "change of toe over the vertical displacement of the contact patch, all wheels rising "
          "alike",
          always_defined,
          [](const Subject& x) {
              const auto heave = heave_motions(x);
              return ratio(x.toe(heave), x.displacement(heave, x.patch()).z(), max_distance);
          },
          {.sources = "deflection counted at the tyre"}),
    Entry(Owner::wheel_of_axle, "bump_steer@alone", Unit::deg_per_m,
          "change of toe over travel of this wheel centre, the other one held at its height",
          does_not_roll,
          [](const Subject& x) {
              return x.response->tied ? undefined : x.toe(x.response->travel[x.k]);
          },
          {.sources = "single wheel travel"}),
    Entry(Owner::wheel, "front_view_swing_arm@patch", Unit::mm,
          "lateral distance from the contact patch to the instant centre of the carrier seen from "
          "the front; positive inboard",
          endless_in_front,
          [](const Subject& x) {
              return front_view_arm(x) +
                     x.side() * (x.patch().position.y() - x.centre().position.y());
          },
          {.sources = "SAE J670e: swing arm radius, from the centre of tire contact",
           .definition_set = "sae",
           .swing_arm = true}),
    Entry(Owner::wheel, "front_view_swing_arm@camber", Unit::mm,
          "travel of the wheel centre over change of camber, its sign turned; positive where "
          "jounce leans the top in",
          "camber does not change: the arm is infinite",
          [](const Subject& x) { return ratio(-1, x.camber(heave_motions(x)), max_distance); },
          {.sources = "rigs, which measure camber over travel", .swing_arm = true}),
    Entry(Owner::wheel, "side_view_swing_arm@patch", Unit::mm,
          "longitudinal distance from the contact patch to the instant centre of the carrier seen "
          "from the side; positive ahead of the wheel",
          endless_from_side,
          [](const Subject& x) {
              return side_view_arm(x) + x.centre().position.x() - x.patch().position.x();
          },
          {.sources = "drawings in side view", .swing_arm = true}),
    Entry(Owner::wheel, "wheel_rate@patch", Unit::newton_per_mm,
          "vertical force over vertical displacement, both of the contact patch, all wheels with "
          "the same load",
          no_rate,
          [](const Subject& x) { return vertical_rate(x, first_patch_force + 2, x.patch()); },
          {.sources = "rigs, which measure the pad under the tyre less the tyre's deflection",
           .needs_free_response = true}),
    Entry(Owner::wheel, "wheel_rate@centre", Unit::newton_per_mm,
          "vertical force over vertical displacement, both of the wheel centre, all wheels with "
          "the same load",
          no_rate,
          [](const Subject& x) { return vertical_rate(x, first_centre_force + 2, x.centre()); },
          {.sources = "programs that load the spindle", .needs_free_response = true}),
    Entry(Owner::wheel_of_axle, "wheel_rate@alone", Unit::newton_per_mm,
          "vertical force at the contact patch over vertical displacement of the wheel centre, the "
          "other wheel with its load unchanged",
          no_rate,
          [](const Subject& x) { return vertical_rate(x, first_patch_force + 2, x.centre(), 0); },
          {.sources = "single wheel bump", .needs_free_response = true}),
    Entry(Owner::axle, "wheel_rate@axle", Unit::newton_per_mm,
          "sum of the wheel rates of both wheels", no_rate,
          [](const Subject& x) {
              return wheel_rate(x.other_wheel(0)) + wheel_rate(x.other_wheel(1));
          },
          {.sources = "axle rate; ride models of half a car", .needs_free_response = true}),
};

// Motion ratios of a spring or damper by other definitions. `inverse`: who uses the inverse.
std::vector<Entry> motion_ratios(Owner owner, const std::string& word,
                                 double (*motion_ratio)(const Subject&), const char* inverse) {
    const std::string definition = "shortening of the " + word,
                      still = "the " + word + " does not move with the wheel",
                      rise = "the vertical displacement of the contact patches, their mean";
    return {
        Entry(owner, "motion_ratio@inverse", Unit::none,
              "travel of the wheel centres over " + definition, still,
              [=](const Subject& x) { return ratio(1, motion_ratio(x), max_distance); },
              {.sources = inverse}),
        Entry(owner, "motion_ratio@patch", Unit::none, definition + " over " + rise, always_defined,
              [=](const Subject& x) { return ratio(motion_ratio(x), mean_rise(x), max_distance); },
              {.sources = "deflection counted at the tyre"}),
        Entry(owner, "motion_ratio@patch_inverse", Unit::none,
              rise.substr(4) + ", over " + definition, still,
              [=](const Subject& x) { return ratio(mean_rise(x), motion_ratio(x), max_distance); },
              {.sources = owner == Owner::spring ? "deflection at the tyre over spring travel"
                                                 : "deflection at the tyre over damper travel"}),
        Entry(owner, "motion_ratio@patch_path", Unit::none,
              "path of the contact patches in space, their mean, over " + definition, still,
              [=](const Subject& x) { return ratio(mean_path(x), motion_ratio(x), max_distance); },
              {.sources = owner == Owner::spring
                              ? "OptimumK: wheel displacement over spring displacement"
                              : "OptimumK: wheel displacement over damper displacement"})};
}

const Entry further_rate_definitions[] = {
    Entry(Owner::front_wheel, "anti_dive@inboard", Unit::percent,
          "brake_share · wheelbase / cg_height · forward over vertical displacement of the wheel "
          "centre: inboard brakes, whose torque the car body carries",
          no_vertical, [](const Subject& x) { return anti(x, x.centre(), brake_share(x), 1); },
          {.sources = "inboard brakes"}),
    Entry(Owner::front_wheel, "anti_dive@whole", Unit::percent,
          "wheelbase / cg_height · forward over vertical displacement of the contact patch: per "
          "cent of the load transfer if this axle braked alone",
          no_vertical, [](const Subject& x) { return anti(x, x.braked_patch(), 1, 1); },
          {.sources = "programs without a brake distribution"}),
    Entry(Owner::front_wheel, "anti_dive@planes", Unit::percent,
          "brake_share · wheelbase / cg_height · slope of the line from the contact patch to the "
          "instant centre of the side view, where the planes of both wishbones meet the "
          "longitudinal plane through the wheel centre",
          no_vertical,
          [](const Subject& x) { return anti_by_planes(x, x.patch().position, brake_share(x), 1); },
          {.sources = "drawings in side view", .definition_set = "planes"}),
    Entry(
        Owner::rear_wheel, "anti_squat@planes", Unit::percent,
        "drive_share · wheelbase / cg_height · slope of the line from the wheel centre to the "
        "instant centre of the side view, where the planes of both wishbones meet the "
        "longitudinal plane through the wheel centre",
        no_vertical,
        [](const Subject& x) { return anti_by_planes(x, x.centre().position, drive_share(x), -1); },
        {.sources = "drawings in side view", .definition_set = "planes"}),
    Entry(Owner::front_wheel, "anti_lift@outboard", Unit::percent,
          "drive_share · wheelbase / cg_height · forward over vertical displacement of the contact "
          "patch: the carrier carries the drive torque",
          no_vertical,
          [](const Subject& x) { return anti(x, x.braked_patch(), drive_share(x), 1); },
          {.sources = "wheel hub motors; live axles"}),
    Entry(Owner::rear_wheel, "anti_lift@inboard", Unit::percent,
          "brake_share · wheelbase / cg_height · rearward over vertical displacement of the wheel "
          "centre: inboard brakes, whose torque the car body carries",
          no_vertical, [](const Subject& x) { return anti(x, x.centre(), brake_share(x), -1); },
          {.sources = "inboard brakes"}),
    Entry(Owner::rear_wheel, "anti_lift@whole", Unit::percent,
          "wheelbase / cg_height · rearward over vertical displacement of the contact patch: per "
          "cent of the load transfer if this axle braked alone",
          no_vertical, [](const Subject& x) { return anti(x, x.braked_patch(), 1, -1); },
          {.sources = "programs without a brake distribution"}),
    Entry(Owner::rear_wheel, "anti_squat@outboard", Unit::percent,
          "drive_share · wheelbase / cg_height · rearward over vertical displacement of the "
          "contact patch: the carrier carries the drive torque",
          no_vertical,
          [](const Subject& x) { return anti(x, x.braked_patch(), drive_share(x), -1); },
          {.sources = "wheel hub motors; live axles"}),
    Entry(Owner::rear_wheel, "anti_squat@whole", Unit::percent,
          "wheelbase / cg_height · rearward over vertical displacement of the wheel centre (of a "
          "rigid axle the patch): per cent of the load transfer if this axle drove alone",
          no_vertical, [](const Subject& x) { return anti(x, driving_force_point(x), 1, -1); },
          {.sources = "rear wheel drive: the same figure"}),
    Entry(Owner::wheel, "lateral_force_steer@centre", Unit::deg_per_kN,
          "change of toe over a force at the wheel centre of this wheel alone towards the middle "
          "of the vehicle, wheel centres held at their height",
          always_defined,
          [](const Subject& x) {
              return inward(x) * x.toe(motions_at_fixed_height(x, first_centre_force + 1));
          },
          {.sources = "programs that load the spindle"}),
    Entry(Owner::wheel, "lateral_force_steer@trail", Unit::deg_per_kN,
          "change of toe over a force towards the middle of the vehicle that acts on the road 30 "
          "mm behind the contact patch of this wheel alone, wheel centres held at their height",
          always_defined, steer_with_trail, {.sources = "rigs with a pneumatic trail of 30 mm"}),
    Entry(Owner::wheel, "lateral_force_steer@constant_load", Unit::deg_per_kN,
          "change of toe over a force at the contact patch of this wheel alone towards the middle "
          "of the vehicle, the wheel loads unchanged and the wheels free to rise",
          unresisted,
          [](const Subject& x) {
              const auto* motions = motions_at_fixed_load(x, first_patch_force + 1);
              return motions == nullptr ? value_without_free_response(x)
                                        : inward(x) * x.toe(*motions);
          },
          {.sources = "programs whose wheels are free", .needs_free_response = true}),
    Entry(Owner::wheel_on_tyre, "lateral_force_steer@on_tyres", Unit::deg_per_kN,
          "change of toe over a force at the contact patch of this wheel alone towards the middle "
          "of the vehicle, the wheels on their tyres",
          unresisted, steer_on_tyres,
          {.sources = "rigs that load the tyre", .needs_free_response = true}),
    Entry(Owner::wheel, "braking_force_steer@inboard", Unit::deg_per_kN,
          "change of toe over a force to the back at the wheel centre of this wheel alone, wheel "
          "centres held at their height: the car body carries the brake torque",
          always_defined,
          [](const Subject& x) { return -x.toe(motions_at_fixed_height(x, first_centre_force)); },
          {.sources = "inboard brakes; wheel free to roll"}),
    Entry(Owner::wheel, "traction_force_steer@patch", Unit::deg_per_kN,
          "change of toe over a force forward at the contact patch of this wheel alone, wheel "
          "centres held at their height: the carrier carries the drive torque",
          always_defined,
          [](const Subject& x) { return x.toe(motions_at_fixed_height(x, first_patch_force)); },
          {.sources = "wheel hub motors; rigs with the wheel locked"}),
    Entry(Owner::steered_wheel, "caster@instant_axis", Unit::deg,
          "angle to the vertical seen from the side of the axis about which the carrier turns when "
          "the steering moves, wheel centres held at their height",
          does_not_steer, caster_steered, {.sources = instant_axis}),
    Entry(Owner::steered_wheel, "kingpin_inclination@instant_axis", Unit::deg,
          "angle to the vertical seen from the front of the axis about which the carrier turns "
          "when the steering moves, wheel centres held at their height",
          does_not_steer, kingpin_steered, {.sources = instant_axis}),
    Entry(Owner::steered_wheel, "scrub_radius@instant_axis", Unit::mm,
          "distance across the wheel from the contact patch to the point on the road of the axis "
          "about which the carrier turns when the steering moves, positive inboard",
          does_not_steer, scrub_steered, {.sources = instant_axis}),
    Entry(Owner::steered_wheel, "mechanical_trail@instant_axis", Unit::mm,
          "distance along the wheel from the contact patch to the point on the road of the axis "
          "about which the carrier turns when the steering moves, positive in front",
          does_not_steer, trail_steered, {.sources = instant_axis}),
};

}  // namespace

Vector3d front_instant_centre(const Subject& x) {
    const Motions heave = heave_motions(x);
    const double arm = front_view_arm(x);
    if (!std::isfinite(arm)) return Vector3d::Constant(undefined);
    const double up = x.displacement(heave, x.centre()).y() / x.rotation(heave).x();
    return x.centre().position + Vector3d(0, -x.side() * arm, up);
}
Vector3d side_instant_centre(const Subject& x) {
    const Motions heave = heave_motions(x);
    const double arm = side_view_arm(x);
    if (!std::isfinite(arm)) return Vector3d::Constant(undefined);
    const double up = -x.displacement(heave, x.centre()).x() / x.rotation(heave).y();
    return x.centre().position + Vector3d(arm, 0, up);
}

void add_rates(std::vector<Entry>& all) {
    std::ranges::copy(over_travel, std::back_inserter(all));
    add_force_tests(all, false);
    std::ranges::copy(of_response, std::back_inserter(all));
    add_roll(all);
    std::ranges::copy(of_springs, std::back_inserter(all));
}

void add_rate_definitions(std::vector<Entry>& entries) {
    std::ranges::copy(rate_definitions, std::back_inserter(entries));
    std::ranges::move(
        motion_ratios(
            Owner::spring, "spring", spring_ratio,
            "wheel travel over spring travel; a manufacturer's table (tests/outside/README.md)"),
        std::back_inserter(entries));
    std::ranges::move(
        motion_ratios(Owner::damper, "damper", damper_ratio, "wheel travel over damper travel"),
        std::back_inserter(entries));
    std::ranges::copy(further_rate_definitions, std::back_inserter(entries));
    add_roll_definitions(entries);
    add_force_tests(entries, true);
}

}  // namespace elastocheck::compare
