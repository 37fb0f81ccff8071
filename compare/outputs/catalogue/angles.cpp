// Figures read from the state alone: positions, angles, the steering axis, and figures of two wheels;
// and the same figures by other definitions.
#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "compare/outputs/catalogue/subject.hpp"
#include "compare/outputs/catalogue/wishbones.hpp"
#include "compare/outputs/wheel_load.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

// ---- The steering axis in the road plane, the horizontal plane through the contact patch. With u from
// the lower to the upper end of the axis, c the patch, h and n horizontal unit vectors along the wheel
// and across it (outboard), p the intersection of the axis with the road plane:
//
//   caster               atan(-u_x / u_z)             n = (e_x, e_y, 0) / |(e_x, e_y, 0)|
//   kingpin inclination  atan(-side u_y / u_z)        h = side n × z
//   scrub radius         -n · (p - c)                 p = l + u (c_z - l_z) / u_z,  l the lower end
//   mechanical trail      h · (p - c)
//
// All four are undefined for an axis within 0.1 rad of the road plane.

constexpr double min_inclination = 0.1;  // [rad] of the axis to the road plane
bool is_flat(const Subject& x) {
    const Vector3d u = x.axis();
    return !(std::abs(u.z()) > std::sin(min_inclination) * u.norm());
}
template <auto formula>
double unless_flat(const Subject& x) {
    return is_flat(x) ? undefined : formula(x);
}

// ---- Two steered wheels.

// The wheelbase over the lateral distance between the points where the steering axes meet the road as
// drawn, or between the patches for a wheel without an axis.
double wheelbase_by_pivots(const Subject& x) {
    const auto y = [&](std::size_t w) {
        const Subject drawn = x.other_wheel(w).drawn();
        const double patch = drawn.patch().position.y();
        if (!drawn.wheel().steering_axis || is_flat(drawn)) return patch;
        return patch + drawn.axis_from(drawn.patch()).y();
    };
    const std::size_t left = left_wheel(x.model);
    return x.model.vehicle->wheelbase / (y(left) - y(1 - left));
}
// Steer angles, positive to the left: δ = -side · toe.
struct SteerAngles {
    double left, right;
};
std::optional<SteerAngles> steer_angles(const Subject& x) {
    constexpr double least = 2 * std::numbers::pi / 180;
    const std::size_t l = left_wheel(x.model);
    const double left = -x.other_wheel(l).toe(), right = x.other_wheel(1 - l).toe();
    if (!(left * right > 0 && std::min(std::abs(left), std::abs(right)) >= least))
        return std::nullopt;
    return SteerAngles{left, right};
}
// Ackermann's condition cot δ_outer - cot δ_inner = j / l, as a share: 1 where the perpendiculars to the
// two wheels meet on the line of the other axle, 0 for parallel wheels,
//
//   (cot δ_right - cot δ_left) l / j,   l the wheelbase, j the lateral distance of the pivots
//
// Undefined unless both wheels turn the same way by 2 deg or more: 0/0 straight ahead.
double ackermann(const Subject& x) {
    const auto at = steer_angles(x);
    return at ? (1 / std::tan(at->right) - 1 / std::tan(at->left)) * wheelbase_by_pivots(x)
              : undefined;
}
// Steer angles of the inner and the outer wheel of the turn, positive; and by Ackermann's condition
// cot δ_o = cot δ_i + j/l the outer one for this inner one, and the inner one for this outer one.
struct Steered {
    double inner = 0, outer = 0, outer_ideal = 0, inner_ideal = 0;
};
double evaluate_steered(const Subject& x, double (*formula)(const Steered&)) {
    const auto at = steer_angles(x);
    if (!at) return undefined;
    const bool to_the_left = at->left > 0;
    Steered s{std::abs(to_the_left ? at->left : at->right),
              std::abs(to_the_left ? at->right : at->left)};
    const double l_j = wheelbase_by_pivots(x);
    s.outer_ideal = std::atan(1 / (1 / std::tan(s.inner) + 1 / l_j));
    s.inner_ideal = std::atan(1 / (1 / std::tan(s.outer) - 1 / l_j));
    return formula(s);
}

// The outer wheel rolls about the point where the perpendicular of its plane meets the line of the
// other axle: its patch runs on a circle of the diameter 2 l / sin δ_o.
double turning_circle(const Subject& x) {
    const auto at = steer_angles(x);
    if (!at) return undefined;
    const double outer = std::min(std::abs(at->left), std::abs(at->right));
    return 2 * x.model.vehicle->wheelbase / std::sin(outer);
}

// Lines from the patches to the instant centres of the planes of the wishbones, in the transverse plane
// of the drawn wheel centre; for one wheel, with the middle of the vehicle.
double roll_centre_by_planes(const Subject& subject) {
    struct PatchLine {
        double y, z, slope;  // of the patch; dz/dy
    };
    std::vector<PatchLine> lines;
    for (std::size_t w = 0; w < subject.model.wheels.size(); ++w) {
        const Subject wheel = subject.other_wheel(w);
        const auto planes = wishbone_planes(wheel);
        if (planes.size() != 2) return undefined;
        const double x = wheel.drawn().centre().position.x();
        const auto& [a, b] = std::pair(planes[0].normal, planes[1].normal);
        const double p = planes[0].offset - a.x() * x, q = planes[1].offset - b.x() * x,
                     determinant = a.y() * b.z() - a.z() * b.y();
        // instant centre (y, z) = (n_y, n_z) / determinant by Cramer's rule; at infinity, where only the
        // slope is defined, for parallel planes
        const double n_y = p * b.z() - q * a.z(), n_z = a.y() * q - b.y() * p;
        const Vector3d patch = wheel.patch().position;
        lines.push_back({patch.y(), patch.z(),
                         (n_z - determinant * patch.z()) / (n_y - determinant * patch.y())});
    }
    const PatchLine& left = lines.front();
    if (lines.size() == 1) return -left.y * left.slope;
    const PatchLine& right = lines.back();
    const double y = (left.y * left.slope - left.z - right.y * right.slope + right.z) /
                     (left.slope - right.slope);
    const double z = left.z + (y - left.y) * left.slope;
    return std::isfinite(z) ? z - (left.z + right.z) / 2 : undefined;
}

double wheel_travel(const Subject& x) {
    return x.centre().position.z() - x.drawn().centre().position.z();
}
double compression(const Subject& x, const Point& i, const Point& j) {
    const auto length = [&](const Subject& at) {
        return (at.placed(j).position - at.placed(i).position).norm();
    };
    return length(x.drawn()) - length(x);
}

// Roll of the body of an axle relative to its wheels, about x, and the moment that causes it.
double roll_angle(const Subject& x) {
    const Subject left = x.other_wheel(left_wheel(x.model)), right = x.other_wheel(1 - left.k);
    const Vector3d from_left = right.centre().position - left.centre().position;
    return std::atan(from_left.z() / -from_left.y());
}
double roll_moment(const Subject& x) {
    if (x.branch == nullptr) return nan;
    const Subject left = x.other_wheel(left_wheel(x.model)), right = x.other_wheel(1 - left.k);
    const auto load = [&](const Subject& wheel) {
        return wheel_load(x.model, *x.branch, *x.state, wheel.k);
    };
    const double difference = load(right) - load(left);
    return std::isfinite(difference)
               ? difference * (left.patch().position.y() - right.patch().position.y()) / 2
               : undefined;
}

// ---- Positions: one entry per axis.

void add_position(std::vector<Entry>& entries, Owner owner, const std::string& stem,
                  const std::string& noun, Point (*point)(const Wheel&),
                  std::array<Properties, 3> properties = {}) {
    for (int k = 0; k < 3; ++k) {
        const auto a = static_cast<std::size_t>(k);
        Entry entry{
            owner, stem + "_" + axes[a], Unit::mm, "position of " + noun + ", " + axis_words(k), "",
            {},    properties[a]};
        entry.axis = k;
        entry.point = point;
        entries.push_back(std::move(entry));
    }
}
Point centre_of(const Wheel& wheel) { return {wheel.body, wheel.centre_local}; }
Point patch_of(const Wheel& wheel) { return wheel.contact; }

// ---- The entries.

const Drawing compressed{DrawnAbscissa::springs, 1, "Travel of springs and dampers",
                         "shortening from the drawn length"};

const Entry of_wheel[] = {
    Entry(Owner::wheel, std::string(figure::toe), Unit::deg,
          "angle of the wheel plane to the x axis seen from above, positive toe-in (front of the "
          "wheel turned to the vehicle's middle), of this wheel alone",
          "", [](const Subject& x) { return x.toe(); },
          {.sources = "atan2(e_x, side·e_y). Toe angle of ISO 8855; steer angles count positive to "
                      "the left, for which a left wheel has −toe. Elsewhere also toe-out positive, "
                      "or the axle's total",
           .is_main = true,
           .at_rest = true,
           .live_rank =
               {.heave = 1, .roll = 3, .steering = 3, .lateral = 1, .longitudinal = 1, .moment = 1},
           .rig_headings = "toe, toe angle, wheel toe",
           .block = {"toe"},
           .plausible_range = {-10, 10, "is a tie rod missing, or a rate in another unit?"},
           .drawings = {{DrawnAbscissa::travel, 1, "Toe angle", "toe-in positive"},
                        {DrawnAbscissa::steering, 1, "Steer angle", "to the left positive",
                         Presentation::to_the_left},
                        {DrawnAbscissa::roll, 1, "Toe angle in roll", "toe-in positive"},
                        {DrawnAbscissa::load, 1, "Toe change", "toe-in positive",
                         Presentation::change}}}),
    Entry(Owner::wheel, std::string(figure::camber), Unit::deg,
          "angle of the wheel plane to the vertical, positive where the top leans outwards", "",
          [](const Subject& x) { return x.camber(); },
          {.sources = "-asin(e_z). ISO 8855, SAE J670",
           .is_main = true,
           .at_rest = true,
           .live_rank =
               {.heave = 2, .roll = 4, .steering = 4, .lateral = 2, .longitudinal = 2, .moment = 2},
           .rig_headings = "camber, camber angle, wheel camber",
           .block = {"camber"},
           .plausible_range = {-15, 15, "is a link missing, or a rate in another unit?"},
           .drawings = {{DrawnAbscissa::travel, 2, "Camber angle", "top outwards positive"},
                        {DrawnAbscissa::steering, 2, "Camber angle", "top outwards positive"},
                        {DrawnAbscissa::roll, 2, "Camber angle in roll",
                         "against the body, top outwards positive"},
                        {DrawnAbscissa::load, 2, "Camber change", "top outwards positive",
                         Presentation::change}}}),
    Entry(
        Owner::wheel, std::string(figure::travel), Unit::mm,
        "vertical displacement of the wheel centre from its design position, positive in jounce "
        "(up)",
        "", wheel_travel,
        {.sources = "wheel travel, bump",
         .rig_headings = "travel, wheel travel, bump travel, jounce, wheel vertical displacement, "
                         "wheel centre z displacement, wheel center z displacement"}),
};

const Entry of_patch[] = {
    Entry(Owner::wheel, "track_change", Unit::mm,
          "lateral displacement of this wheel's contact patch from its design position, positive "
          "outwards",
          "", [](const Subject& x) { return x.side() * x.patch_travel().y(); },
          {.sources = "half-track change",
           .live_rank = {.heave = 6, .roll = 6},
           .rig_headings = "track change, half track change",
           .drawings = {{DrawnAbscissa::travel, 3, "Contact patch, lateral",
                         "from its drawn position, outwards positive"},
                        {DrawnAbscissa::load, 3, "Contact patch, lateral change",
                         "outwards positive", Presentation::change}}}),
    Entry(Owner::wheel_of_vehicle, "wheelbase_change", Unit::mm,
          "longitudinal displacement of this wheel's contact patch from its design position, "
          "positive where the wheelbase grows (forward in front, rearward at the rear)",
          "",
          [](const Subject& x) {
              const int forward = x.model.vehicle->axle == Axle::front ? +1 : -1;
              return forward * x.patch_travel().x();
          },
          {.sources = "only with a `vehicle` in the scene, which has the axle",
           .rig_headings = "wheelbase change"}),
    Entry(Owner::wheel_with_steering_axis, std::string(figure::caster), Unit::deg,
          "angle of the steering axis to the vertical seen from the side, positive where its top "
          "leans backwards; undefined where it lies flatter than 0.1 rad",
          "", unless_flat<[](const Subject& x) { return x.caster(); }>,
          {.sources = "atan(-u_x/u_z). Castor angle of ISO 8855; Reimpell's τ",
           .may_be_undefined = true,
           .at_rest = true,
           .live_rank = {.heave = 7, .steering = 6},
           .rig_headings = "caster, castor, caster angle, castor angle",
           .block = {"caster"},
           .drawings = {{DrawnAbscissa::travel, 5, "Caster angle", "top backwards positive"},
                        {DrawnAbscissa::steering, 5, "Caster angle", "top backwards positive"}}}),
    Entry(
        Owner::wheel_with_steering_axis, "kingpin_inclination", Unit::deg,
        "angle of the steering axis to the vertical seen from behind, positive where its top "
        "leans inwards; undefined where it lies flatter than 0.1 rad",
        "", unless_flat<[](const Subject& x) { return x.kingpin(); }>,
        {.sources = "atan(-side u_y/u_z). Steering-axis inclination of ISO 8855, SAI; Reimpell's σ",
         .may_be_undefined = true,
         .at_rest = true,
         .rig_headings = "kingpin inclination, kpi",
         .block = {"kingpin_inclination"}}),
    Entry(Owner::wheel_with_steering_axis, "scrub_radius", Unit::mm,
          "distance across the wheel from the contact patch to the intersection of the steering "
          "axis with the road (the horizontal plane through the patch), positive inboard; "
          "undefined where the axis lies flatter than 0.1 rad",
          "", unless_flat<[](const Subject& x) { return -x.across().dot(x.axis_from(x.patch())); }>,
          {.sources = "-n·(p - c). Steering-axis offset at ground, kingpin offset; Reimpell's r_σ",
           .may_be_undefined = true,
           .at_rest = true,
           .drawings = {{DrawnAbscissa::if_given, 3, "Scrub radius",
                         "steering axis inboard of the patch positive"}}}),
    Entry(Owner::wheel_with_steering_axis, std::string(figure::mechanical_trail), Unit::mm,
          "distance along the wheel from the contact patch to the intersection of the steering "
          "axis with the road (the horizontal plane through the patch), positive in front; "
          "undefined where the axis lies flatter than 0.1 rad",
          "", unless_flat<[](const Subject& x) { return x.along().dot(x.axis_from(x.patch())); }>,
          {.sources = "h·(p - c). Castor offset at ground, caster trail",
           .may_be_undefined = true,
           .at_rest = true,
           .drawings = {{DrawnAbscissa::steering, 6, "Mechanical trail",
                         "steering axis ahead of the patch positive"}}}),
    Entry(Owner::axle, std::string(figure::track), Unit::mm,
          "lateral distance between the contact patches of the two wheels, positive where the left "
          "one is to the left",
          "",
          [](const Subject& x) {
              const std::size_t left = left_wheel(x.model);
              return x.other_wheel(left).patch().position.y() -
                     x.other_wheel(1 - left).patch().position.y();
          },
          {.sources = "in scenes with one left and one right wheel", .at_rest = true}),
    Entry(Owner::axle, std::string(figure::roll_angle), Unit::deg,
          "roll of the car body against the line through the wheel centres, positive to the right "
          "(the right wheel in jounce)",
          "", roll_angle, {.sources = "suspension roll angle of ISO 8855"}),
    Entry(Owner::front_axle, "ackermann", Unit::percent,
          "(cot of the right wheel's angle less cot of the left one's) times the wheelbase over "
          "the lateral distance between the pivots on the road: positive where the inner wheel "
          "turns more, 100 % where the perpendiculars to the two wheels meet on the line of the "
          "rear axle; undefined unless both are turned in the same direction by 2 deg or more",
          "", ackermann,
          {.sources =
               "for the two front wheels of a `vehicle`; angles -side·toe, to the left; pivots: "
               "the points p at the design position, or c for a wheel without axis. 100 % is "
               "Ackermann's condition cot δ_outer - cot δ_inner = j/l (Reimpell, Milliken). Other "
               "tools give a ratio of the angles, which is a different number",
           .may_be_undefined = true,
           .live_rank = {.steering = 1},
           .drawings = {{DrawnAbscissa::steering, 4, "Ackermann",
                         "100 %: no tyre slips at low speed; without the middle, where it is a "
                         "quotient of two small angles",
                         Presentation::off_centre}}}),
    Entry(
        Owner::front_axle, "turning_circle", Unit::mm,
        "diameter of the circle on which the patch of the wheel with the smaller steer angle runs "
        "about a point on the line of the other axle: twice the wheelbase over the sine of that "
        "angle; undefined unless both are turned in the same direction by 2 deg or more",
        "", turning_circle,
        {.sources = "turning circle (track circle); between kerbs half a tyre's width more on "
                    "each side",
         .may_be_undefined = true,
         .live_rank = {.steering = 5}}),
    Entry(Owner::spring, "compression", Unit::mm,
          "design length less length of spring '{}', positive in compression", "",
          [](const Subject& x) {
              const auto& spring = std::get<AxialSpring>(x.model.elastics[x.k].kind);
              return compression(x, spring.i, spring.j);
          },
          {.sources = "spring travel", .drawings = {compressed}}),
    Entry(Owner::damper, "compression", Unit::mm,
          "design length less length of damper '{}', positive in compression", "",
          [](const Subject& x) {
              const Damper& damper = x.model.dampers[x.k];
              return compression(x, damper.i, damper.j);
          },
          {.sources = "damper travel", .drawings = {compressed}}),
};

// An entry of its own function since it needs the branch, whose drivers move the rack.
Entry hand_wheel_entry() {
    Entry entry(Owner::hand_wheel, "hand_wheel_angle", Unit::deg,
                "angle of the hand wheel, in proportion to the displacement of the rack, with the "
                "sign of the parameter of the branch that turns it",
                not_steered,
                [](const Subject& x) {
                    if (x.branch == nullptr) return nan;
                    const int rack = steering_joint(x.model);
                    const double rate = rack_per_hand_wheel(x.model);
                    for (const auto& driver : x.branch->drivers)
                        if (driven_joint(driver.what) == rack)
                            return driver.start / rate + driver.rate / rate * x.state->load;
                    const auto joint = static_cast<std::size_t>(rack);
                    return x.model.joints[joint].active_only_where_driven ? undefined : 0;
                },
                {.sources = "ISO 8855: steering-wheel angle",
                 .rig_headings = "steering wheel angle, hand wheel angle, handwheel angle"});
    entry.kind = ChannelKind::element;
    return entry;
}

// Likewise: it sums loads and drivers of the branch.
Entry wheel_load_entry() {
    Entry entry(
        Owner::wheel, std::string(figure::wheel_load), Unit::newton,
        "vertical force of the road on the wheel, positive up: of its tyre, its jacks, and forces "
        "at its contact patch or centre, static ones included (weights are loads of their bodies); "
        "undefined where another force on the wheel's body may be the road's or not",
        "",
        [](const Subject& x) {
            return x.branch == nullptr ? nan : wheel_load(x.model, *x.branch, *x.state, x.k);
        },
        {.sources = "wheel vertical force",
         .at_rest = true,
         .rig_headings = "wheel load, vertical load, tyre load, tire load, wheel vertical force",
         .drawings = {{DrawnAbscissa::travel, 6, "Wheel load",
                       "the force of the road; negative: the wheel would lift off"}}});
    entry.kind = ChannelKind::element;
    return entry;
}

Entry roll_moment_entry() {
    Entry entry(
        Owner::axle, "roll_moment", Unit::newton_metre,
        "half the difference of the wheel loads times the distance of the patches, positive "
        "where it rolls the car body to the right",
        "", roll_moment,
        {.sources = "load transfer times the track; over the roll angle: roll stiffness",
         .drawings = {{DrawnAbscissa::roll, 3, "Roll moment", "to the right positive"}}});
    entry.kind = ChannelKind::element;
    return entry;
}

// ---- By other definitions.

constexpr auto manufacturer = "a manufacturer's table (tests/outside/README.md)";
constexpr auto nearly_straight = "the wheels are nearly straight ahead";

const Entry angle_definitions[] = {
    Entry(Owner::wheel, "toe@lateral", Unit::deg,
          "angle of an axis that is lateral in the design position, plus the drawn toe", "",
          [](const Subject& x) {
              return x.drawn().toe() + std::atan2(x.lateral().x(), x.side() * x.lateral().y());
          },
          {.sources = manufacturer}),
    Entry(Owner::wheel, "toe@steer", Unit::deg,
          "steer angle: of the wheel plane to the x axis about z, of either wheel positive to the "
          "left",
          "", [](const Subject& x) { return -x.side() * x.toe(); },
          {.sources = "ISO 8855 7.1.1: steer angle",
           .definition_set = "iso8855",
           .block = {"steer", Block::Component::yaw, false,
                     "angle of the wheel plane to the x axis about z, right-handed about the z "
                     "axis of this file"}}),
    Entry(Owner::two_wheels, "toe@axle", Unit::deg, "sum of the toe of both wheels", "",
          [](const Subject& x) { return x.other_wheel(0).toe() + x.other_wheel(1).toe(); },
          {.sources = "ISO 8855 7.1.7: total toe angle", .definition_set = "iso8855"}),
    Entry(Owner::wheel, "camber@lateral", Unit::deg,
          "inclination of an axis that is lateral in the design position, plus the drawn camber",
          "", [](const Subject& x) { return x.drawn().camber() - std::asin(x.lateral().z()); },
          {.sources = "programs whose wheel carrier is drawn without camber"}),
    Entry(Owner::wheel, "camber@front_view", Unit::deg,
          "inclination of the spin axis in the transverse plane, -atan(e_z / |e_y|)", "",
          [](const Subject& x) { return -std::atan2(x.spin().z(), std::abs(x.spin().y())); },
          {.sources = "front view; Altair MotionView; a closed form by Rill and Castro"}),
    Entry(Owner::wheel_with_steering_axis, "camber@kingpin", Unit::deg,
          "drawn camber less the change of the kingpin inclination", "",
          [](const Subject& x) { return x.drawn().camber() - (x.kingpin() - x.drawn().kingpin()); },
          {.sources = manufacturer}),
    Entry(Owner::wheel, "camber@inclination", Unit::deg,
          "camber about x, of either wheel positive where the top leans to the right", "",
          [](const Subject& x) { return -x.side() * x.camber(); },
          {.sources = "ISO 8855: inclination angle",
           .definition_set = "iso8855",
           .block = {"inclination", Block::Component::none, false,
                     "camber about the x axis, right-handed, of either wheel positive where the "
                     "top leans to the right"}}),
    Entry(Owner::wheel_with_steering_axis, "caster@wheel_plane", Unit::deg,
          "angle of the steering axis to the vertical seen across the wheel, which steers", "",
          [](const Subject& x) { return std::atan(-x.axis().dot(x.along()) / x.axis().z()); },
          {.sources = "alignment benches"}),
    Entry(Owner::wheel_with_steering_axis, "kingpin_inclination@wheel_plane", Unit::deg,
          "angle of the steering axis to the vertical seen along the wheel, which steers", "",
          [](const Subject& x) { return std::atan(-x.axis().dot(x.across()) / x.axis().z()); },
          {.sources = "alignment benches"}),
    Entry(Owner::wheel_with_steering_axis, "mechanical_trail@across_axis", Unit::mm,
          "trail on the road times the cosine of the caster: perpendicular to the steering axis",
          "",
          [](const Subject& x) {
              return x.axis_from(x.patch()).dot(x.along()) * std::cos(x.caster());
          },
          {.sources = "mechanical trail of a kinematics program (tests/outside/README.md)"}),
    Entry(Owner::wheel_with_steering_axis, "mechanical_trail@centre", Unit::mm,
          "distance along the wheel from the wheel centre to the steering axis at its height", "",
          [](const Subject& x) { return x.axis_from(x.centre()).dot(x.along()); },
          {.sources = "ISO 8855: castor offset at wheel centre; hub trail",
           .definition_set = "iso8855"}),
    Entry(Owner::wheel_with_steering_axis, "mechanical_trail@ground_axes", Unit::mm,
          "distance along x from the contact patch to the steering axis on the road", "",
          [](const Subject& x) { return x.axis_from(x.patch()).x(); },
          {.sources = "SAE J670e: caster offset, in side elevation", .definition_set = "sae"}),
    Entry(
        Owner::wheel_with_steering_axis, "scrub_radius@centre", Unit::mm,
        "distance across the wheel from the wheel centre to the steering axis at its height", "",
        [](const Subject& x) { return -x.axis_from(x.centre()).dot(x.across()); },
        {.sources = "ISO 8855: steering-axis offset at wheel centre", .definition_set = "iso8855"}),
    Entry(Owner::wheel_with_steering_axis, "scrub_radius@ground_axes", Unit::mm,
          "distance along y from the contact patch to the steering axis on the road, positive "
          "inboard",
          "", [](const Subject& x) { return -x.side() * x.axis_from(x.patch()).y(); },
          {.sources = "SAE J670e: kingpin offset at the ground, in front elevation",
           .definition_set = "sae"}),
    Entry(Owner::wheel_with_steering_axis, "scrub_radius@distance", Unit::mm,
          "distance on the road from the contact patch to the steering axis, in any direction", "",
          [](const Subject& x) {
              const Vector3d p = x.axis_from(x.patch());
              return std::hypot(p.x(), p.y());
          },
          {.sources = "ISO 8855: scrub radius", .definition_set = "iso8855"}),
    Entry(Owner::wheel, "travel@patch", Unit::mm, "vertical displacement of the contact patch", "",
          [](const Subject& x) { return x.patch_travel().z(); },
          {.sources = "deflection at the tyre"}),
    Entry(Owner::wheel, "travel@lowest", Unit::mm,
          "vertical displacement of the lowest point of a circle of the drawn radius in the "
          "wheel's plane",
          "", [](const Subject& x) { return x.lowest().z() - x.drawn().lowest().z(); },
          {.sources = "deflection at the tyre"}),
    Entry(
        Owner::wheel, "track_change@centre", Unit::mm,
        "lateral displacement of the wheel centre, outwards", "",
        [](const Subject& x) { return x.side() * x.centre_travel().y(); },
        {.sources = "half track at the wheel centre",
         .block = {"lateral", Block::Component::lateral, true,
                   "displacement of the wheel centre along the y axis of this file from the design "
                   "position"}}),
    Entry(Owner::wheel, "track_change@lowest", Unit::mm,
          "lateral displacement, outwards, of the lowest point of a circle of the drawn radius in "
          "the wheel's plane",
          "", [](const Subject& x) { return x.side() * (x.lowest().y() - x.drawn().lowest().y()); },
          {.sources = "half track at the contact of a rolling wheel"}),
    Entry(
        Owner::wheel_of_vehicle, "wheelbase_change@centre", Unit::mm,
        "longitudinal displacement of the wheel centre, forward", "",
        [](const Subject& x) { return x.centre_travel().x(); },
        {.sources = "wheelbase at the wheel centres",
         .block = {"longitudinal", Block::Component::none, false,
                   "displacement of the wheel centre along x from the design position, forward"}}),
    Entry(Owner::front_axle, "ackermann@error", Unit::deg,
          "steer angle of the outer wheel less that for which the perpendiculars of both wheels "
          "meet on the line of the other axle; positive where the outer wheel steers too much",
          nearly_straight,
          [](const Subject& x) {
              return evaluate_steered(x, [](const Steered& s) { return s.outer - s.outer_ideal; });
          },
          {.sources = "ISO 8855: Ackermann error", .definition_set = "iso8855"}),
    Entry(Owner::front_axle, "ackermann@outer", Unit::percent,
          "difference of the steer angles over that with this outer angle for the inner one",
          nearly_straight,
          [](const Subject& x) {
              return evaluate_steered(x, [](const Steered& s) {
                  return (s.inner - s.outer) / (s.inner - s.outer_ideal);
              });
          },
          {.sources = "per cent Ackermann, of the outer wheel"}),
    Entry(Owner::front_axle, "ackermann@inner", Unit::percent,
          "difference of the steer angles over that with this inner angle for the outer one",
          nearly_straight,
          [](const Subject& x) {
              return evaluate_steered(x, [](const Steered& s) {
                  return (s.inner - s.outer) / (s.inner_ideal - s.outer);
              });
          },
          {.sources = "per cent Ackermann, of the inner wheel"}),
    Entry(
        Owner::wheels, "roll_centre_height@planes", Unit::mm,
        "intersection of the lines from the patches to the instant centres, where the planes of "
        "both wishbones meet in the transverse plane of the drawn wheel centre; above the patches",
        "", roll_centre_by_planes,
        {.sources = "drawings in front view; tables of manufacturers", .definition_set = "planes"}),
};

}  // namespace

std::string axis_words(int axis) {
    constexpr std::array towards{"forward", "to the left", "up"};
    const auto a = static_cast<std::size_t>(axis);
    return std::string("ground axis ") + axes[a] + ", positive " + towards[a];
}

void add_angles(std::vector<Entry>& entries) {
    const auto moves = [](const char* rig, const Drawing& drawn) {
        return Properties{.is_main = true, .rig_headings = rig, .drawings = {drawn}};
    };
    Properties x = moves("wheel centre x, wheel center x",
                         {DrawnAbscissa::travel, 4, "Wheel centre, longitudinal",
                          "since the start of the branch, forward positive", Presentation::change});
    x.drawings.push_back({DrawnAbscissa::load, 4, "Wheel centre, longitudinal change",
                          "forward positive", Presentation::change});
    add_position(entries, Owner::wheel, "wheel_centre", "the wheel centre", centre_of,
                 {x,
                  moves("wheel centre y, wheel center y",
                        {DrawnAbscissa::if_given, 1, "Lateral movement of the wheel centre",
                         "outwards positive", Presentation::outward_change}),
                  moves("wheel centre z, wheel center z",
                        {DrawnAbscissa::if_given, 2, "Vertical movement of the wheel centre",
                         "up positive", Presentation::change})});
    std::ranges::copy(of_wheel, std::back_inserter(entries));
    add_position(entries, Owner::rolling_wheel, "contact_patch",
                 "the contact patch, the lowest point of the rolling wheel", patch_of);
    add_position(entries, Owner::wheel_with_fixed_patch, "contact_patch",
                 "the point of the carrier that is the contact patch at the design position",
                 patch_of);
    std::ranges::copy(of_patch, std::back_inserter(entries));
    entries.push_back(hand_wheel_entry());
    entries.push_back(wheel_load_entry());
    entries.push_back(roll_moment_entry());
}

void add_angle_definitions(std::vector<Entry>& all) {
    for (const Entry& entry : angle_definitions) {
        all.push_back(entry);
        all.back().properties.may_be_undefined = true;
    }
}

}  // namespace elastocheck::compare
