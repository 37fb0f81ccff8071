#include "compare/definitions/definitions.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "compare/comparison/characteristic_formulas.hpp"
#include "compare/comparison/characteristics.hpp"
#include "compare/definitions/wishbones.hpp"
#include "compare/outputs/positions.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

// A wheel in a state, and in the design position.
struct WheelAt {
    const Wheel& wheel;
    const Model& model;
    const std::vector<Pose>& poses;
    double side = 1;

    Vector3d centre() const { return position(poses, wheel.body, wheel.centre_local); }
    Vector3d patch() const { return position(poses, wheel.contact); }
    Vector3d spin() const { return compare::pose(poses, wheel.body).p * wheel.spin_axis_local; }
    // The axis of the wheel's body that points outboard along ±y in the design position.
    Vector3d lateral() const {
        const Vector3d drawn = side * Vector3d::UnitY();
        const Pose& design = model.bodies[static_cast<std::size_t>(wheel.body)].design;
        return compare::pose(poses, wheel.body).p * (design.p.conjugate() * drawn);
    }
    bool steers() const { return wheel.steering_axis.has_value(); }
    Vector3d lower() const { return position(poses, wheel.steering_axis->lower); }
    Vector3d axis() const { return position(poses, wheel.steering_axis->upper) - lower(); }
    // The steering axis at the height of a point, from that point.
    Vector3d axis_from(const Vector3d& at) const {
        return lower() + axis() * ((at.z() - lower().z()) / axis().z()) - at;
    }
    // Horizontal unit vectors across the wheel, outboard, and along it, forward.
    Vector3d across() const { return Vector3d(spin().x(), spin().y(), 0).normalized(); }
    Vector3d along() const { return side * across().cross(Vector3d::UnitZ()); }
    // Where a circle of the drawn radius in the wheel's plane is lowest.
    Vector3d lowest() const {
        const Vector3d e = spin();
        const double radius = drawn_arm(model, wheel).norm();
        return centre() + radius * (e * e.z() - Vector3d::UnitZ()).normalized();
    }

    double toe() const { return std::atan2(spin().x(), side * spin().y()); }
    double camber() const { return -std::asin(spin().z()); }
    double caster() const { return std::atan(-axis().x() / axis().z()); }
    double kingpin() const { return std::atan(-side * axis().y() / axis().z()); }
};
WheelAt wheel_at(const Model& model, std::size_t w, const Equilibrium& state) {
    const Wheel& wheel = model.wheels[w];
    return {wheel, model, state.poses, static_cast<double>(wheel.side)};
}
WheelAt drawn(const WheelAt& at, const Equilibrium& design) {
    return {at.wheel, at.model, design.poses, at.side};
}

// Builds the function of a definition from a formula of the wheel now and as drawn.
template <auto formula>
double of_wheel(const Model& model, std::size_t w, const Equilibrium& state) {
    const Equilibrium design = design_state(model);
    const WheelAt now = wheel_at(model, w, state);
    return formula(now, drawn(now, design));
}
// The same of a formula that needs a steering axis.
template <auto formula>
double of_axis(const Model& model, std::size_t w, const Equilibrium& state) {
    return model.wheels[w].steering_axis ? of_wheel<formula>(model, w, state) : undefined;
}

double toe_of_axle(const Model& model, std::size_t, const Equilibrium& state) {
    if (model.wheels.size() != 2) return undefined;
    return wheel_at(model, 0, state).toe() + wheel_at(model, 1, state).toe();
}

// Lines from the patches to the instant centres of the planes of the wishbones, in the transverse
// plane of the drawn wheel centre; for one wheel, with the middle of the vehicle.
double roll_centre_by_planes(const Model& model, std::size_t, const Equilibrium& state) {
    struct PatchLine {
        double y, z, slope;  // of the patch; dz/dy
    };
    std::vector<PatchLine> lines;
    const Equilibrium design = design_state(model);
    for (std::size_t w = 0; w < model.wheels.size(); ++w) {
        const auto planes = wishbone_planes(model, model.wheels[w].body, state.poses);
        if (planes.size() != 2) return undefined;
        const WheelAt at = wheel_at(model, w, state);
        const double x = drawn(at, design).centre().x();
        const auto& [a, b] = std::pair(planes[0].normal, planes[1].normal);
        const double p = planes[0].offset - a.x() * x, q = planes[1].offset - b.x() * x,
                     determinant = a.y() * b.z() - a.z() * b.y();
        // the instant centre (y, z) = (n_y, n_z) / determinant; at infinity for parallel planes
        const double n_y = p * b.z() - q * a.z(), n_z = a.y() * q - b.y() * p;
        const Vector3d patch = at.patch();
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

// Steer angles of an axle, towards the side to which it turns, and l/j of class Ackermann.
struct Steered {
    double inner = 0, outer = 0;
    double wheelbase_by_pivots = 0;
    // of the outer wheel for the inner one, cot δ_o = cot δ_i + j/l, and the reverse
    double outer_ideal() const {
        return std::atan(1 / (1 / std::tan(inner) + 1 / wheelbase_by_pivots));
    }
    double inner_ideal() const {
        return std::atan(1 / (1 / std::tan(outer) - 1 / wheelbase_by_pivots));
    }
};
// Where the default figure is undefined, straight ahead, these are too.
std::optional<Steered> steered(const Model& model, const Equilibrium& state) {
    const auto all = channels(model);
    const int found = find_channel(all, "ackermann");
    if (found < 0) return std::nullopt;
    const auto& channel = all[static_cast<std::size_t>(found)];
    if (!std::isfinite(evaluate(model, std::span(&channel, 1), state).front())) return std::nullopt;
    const auto& axle = std::get<Ackermann>(channel.reads);
    const double left = -wheel_at(model, axle.left, state).toe(),
                 right = wheel_at(model, axle.right, state).toe();
    const bool to_the_left = left > 0;
    return Steered{std::abs(to_the_left ? left : right), std::abs(to_the_left ? right : left),
                   axle.wheelbase_by_pivots};
}
double ackermann_error(const Model& model, std::size_t, const Equilibrium& state) {
    const auto at = steered(model, state);
    return at ? at->outer - at->outer_ideal() : undefined;
}
double ackermann_of_outer(const Model& model, std::size_t, const Equilibrium& state) {
    const auto at = steered(model, state);
    return at ? (at->inner - at->outer) / (at->inner - at->outer_ideal()) : undefined;
}
double ackermann_of_inner(const Model& model, std::size_t, const Equilibrium& state) {
    const auto at = steered(model, state);
    return at ? (at->inner - at->outer) / (at->inner_ideal() - at->outer) : undefined;
}

constexpr auto kingpin_name = "a manufacturer's table (tests/outside/README.md)";
using W = const WheelAt&;

// A formula takes the wheel now and as drawn.
constexpr struct {
    const char* figure;
    const char* name;
    Unit unit;
    const char* formula;
    const char* used_by;
    // SI; `undefined` where the scene has no such part. `wheel`: position in Model::wheels.
    double (*value)(const Model& model, std::size_t wheel, const Equilibrium& state);
    bool of_axle = false;  // of both wheels together, not of each
} list[] = {
    {"toe", "lateral", Unit::deg,
     "angle of an axis that is lateral in the design position, plus the drawn toe", kingpin_name,
     of_wheel<[](W now, W drawn) {
         return drawn.toe() + std::atan2(now.lateral().x(), now.side * now.lateral().y());
     }>},
    {"toe", "steer", Unit::deg,
     "steer angle: of the wheel plane to the x axis about z, of either wheel positive to the left",
     "ISO 8855 7.1.1: steer angle", of_wheel<[](W now, W) { return -now.side * now.toe(); }>},
    {"toe", "axle", Unit::deg, "sum of the toe of both wheels", "ISO 8855 7.1.7: total toe angle",
     toe_of_axle, true},
    {"camber", "lateral", Unit::deg,
     "inclination of an axis that is lateral in the design position, plus the drawn camber",
     "programs whose wheel carrier is drawn without camber",
     of_wheel<[](W now, W drawn) { return drawn.camber() - std::asin(now.lateral().z()); }>},
    {"camber", "front_view", Unit::deg,
     "inclination of the spin axis in the transverse plane, -atan(e_z / |e_y|)",
     "front view; Altair MotionView; a closed form by Rill and Castro",
     of_wheel<[](W now, W) { return -std::atan2(now.spin().z(), std::abs(now.spin().y())); }>},
    {"camber", "kingpin", Unit::deg, "drawn camber less the change of the kingpin inclination",
     kingpin_name,
     of_axis<[](W now, W drawn) { return drawn.camber() - (now.kingpin() - drawn.kingpin()); }>},
    {"camber", "inclination", Unit::deg,
     "camber about x, of either wheel positive where the top leans to the right",
     "ISO 8855: inclination angle", of_wheel<[](W now, W) { return -now.side * now.camber(); }>},
    {"caster", "wheel_plane", Unit::deg,
     "angle of the steering axis to the vertical seen across the wheel, which steers",
     "alignment benches",
     of_axis<[](W now, W) { return std::atan(-now.axis().dot(now.along()) / now.axis().z()); }>},
    {"kingpin_inclination", "wheel_plane", Unit::deg,
     "angle of the steering axis to the vertical seen along the wheel, which steers",
     "alignment benches",
     of_axis<[](W now, W) { return std::atan(-now.axis().dot(now.across()) / now.axis().z()); }>},
    {"mechanical_trail", "across_axis", Unit::mm,
     "trail on the road times the cosine of the caster: perpendicular to the steering axis",
     "mechanical trail of a kinematics program (tests/outside/README.md)", of_axis<[](W now, W) {
         return now.axis_from(now.patch()).dot(now.along()) * std::cos(now.caster());
     }>},
    {"mechanical_trail", "centre", Unit::mm,
     "distance along the wheel from the wheel centre to the steering axis at its height",
     "ISO 8855: castor offset at wheel centre; hub trail",
     of_axis<[](W now, W) { return now.axis_from(now.centre()).dot(now.along()); }>},
    {"mechanical_trail", "ground_axes", Unit::mm,
     "distance along x from the contact patch to the steering axis on the road",
     "SAE J670e: caster offset, in side elevation",
     of_axis<[](W now, W) { return now.axis_from(now.patch()).x(); }>},
    {"scrub_radius", "centre", Unit::mm,
     "distance across the wheel from the wheel centre to the steering axis at its height",
     "ISO 8855: steering-axis offset at wheel centre",
     of_axis<[](W now, W) { return -now.axis_from(now.centre()).dot(now.across()); }>},
    {"scrub_radius", "ground_axes", Unit::mm,
     "distance along y from the contact patch to the steering axis on the road, positive inboard",
     "SAE J670e: kingpin offset at the ground, in front elevation",
     of_axis<[](W now, W) { return -now.side * now.axis_from(now.patch()).y(); }>},
    {"scrub_radius", "distance", Unit::mm,
     "distance on the road from the contact patch to the steering axis, in any direction",
     "ISO 8855: scrub radius", of_axis<[](W now, W) {
         const Vector3d p = now.axis_from(now.patch());
         return std::hypot(p.x(), p.y());
     }>},
    {"travel", "patch", Unit::mm, "vertical displacement of the contact patch",
     "deflection at the tyre",
     of_wheel<[](W now, W drawn) { return now.patch().z() - drawn.patch().z(); }>},
    {"travel", "lowest", Unit::mm,
     "vertical displacement of the lowest point of a circle of the drawn radius in the wheel's "
     "plane",
     "deflection at the tyre",
     of_wheel<[](W now, W drawn) { return now.lowest().z() - drawn.lowest().z(); }>},
    {"track_change", "centre", Unit::mm, "lateral displacement of the wheel centre, outwards",
     "half track at the wheel centre",
     of_wheel<[](W now, W drawn) { return now.side * (now.centre().y() - drawn.centre().y()); }>},
    {"track_change", "lowest", Unit::mm,
     "lateral displacement, outwards, of the lowest point of a circle of the drawn radius in the "
     "wheel's plane",
     "half track at the contact of a rolling wheel",
     of_wheel<[](W now, W drawn) { return now.side * (now.lowest().y() - drawn.lowest().y()); }>},
    {"wheelbase_change", "centre", Unit::mm,
     "longitudinal displacement of the wheel centre, forward", "wheelbase at the wheel centres",
     of_wheel<[](W now, W drawn) { return now.centre().x() - drawn.centre().x(); }>},
    {"ackermann", "error", Unit::deg,
     "steer angle of the outer wheel less that for which the perpendiculars of both wheels meet on "
     "the line of the other axle; positive where the outer wheel steers too much",
     "ISO 8855: Ackermann error", ackermann_error, true},
    {"ackermann", "outer", Unit::percent,
     "difference of the steer angles over that with this outer angle for the inner one",
     "per cent Ackermann, of the outer wheel", ackermann_of_outer, true},
    {"ackermann", "inner", Unit::percent,
     "difference of the steer angles over that with this inner angle for the outer one",
     "per cent Ackermann, of the inner wheel", ackermann_of_inner, true},
    {"roll_centre_height", "planes", Unit::mm,
     "intersection of the lines from the patches to the instant centres, where the planes of both "
     "wishbones meet in the transverse plane of the drawn wheel centre; above the patches",
     "drawings in front view; tables of manufacturers", roll_centre_by_planes, true},
};

}  // namespace

std::vector<Definition> definitions() {
    std::vector<Definition> all;
    for (const auto& of : list)
        all.push_back({of.figure, of.name, of.unit, of.formula, of.used_by});
    for (const auto& entry : characteristic::catalogue().entries)
        if (const auto at = entry.name.find('@'); at != entry.name.npos)
            all.push_back({entry.name.substr(0, at), entry.name.substr(at + 1), entry.unit,
                           entry.definition.c_str(), entry.used_by});
    return all;
}

std::vector<DefinitionSet> definition_sets() {
    return {
        {"iso8855",
         "ISO 8855:2011, where it has more figures than the outputs without @, which are its own",
         {"toe@steer", "toe@axle", "camber@inclination", "mechanical_trail@centre",
          "scrub_radius@centre", "scrub_radius@distance", "ackermann@error"}},
        {"sae",
         "SAE J670e:1976: offsets in side and front elevation, arms to the centre of tire "
         "contact, the roll center by forces",
         {"mechanical_trail@ground_axes", "scrub_radius@ground_axes", "front_view_swing_arm@patch",
          "roll_centre_height@forces"}},
        {"planes",
         "drawings in front view: the roll centre by the planes of the wishbones",
         {"roll_centre_height@planes"}}};
}

std::vector<Channel> definition_channels(const Model& model) {
    std::vector<Channel> channels;
    const Equilibrium design = design_state(model);
    const auto own = compare::channels(model);
    for (const auto& definition : list) {
        bool has_own = definition.figure == std::string_view("roll_centre_height");
        for (const Channel& channel : own)
            has_own = has_own || figure_of(channel.name) == definition.figure;
        if (!has_own) continue;
        for (std::size_t w = 0; w < model.wheels.size(); ++w) {
            if (definition.of_axle && w > 0) break;
            const double value = definition.value(model, w, design);
            // straight ahead, where a scene begins, Ackermann's figures are undefined
            const bool later = definition.figure == std::string_view("ackermann");
            if ((value == undefined && !later) || std::isnan(value)) continue;
            const std::string& wheel = model.wheels[w].name;
            channels.push_back({.name = fmt::format("{}{}{}@{}", definition.of_axle ? "" : wheel,
                                                    definition.of_axle || wheel.empty() ? "" : ".",
                                                    definition.figure, definition.name),
                                .unit = definition.unit,
                                .main = false,
                                .reads = Defined{definition.value, w},
                                .definition = definition.formula,
                                .undefined = later ? "the wheels are nearly straight ahead" : ""});
        }
    }
    std::ranges::move(characteristics_otherwise(model), std::back_inserter(channels));
    return channels;
}

std::string figure_of(std::string_view output) {
    const auto end = std::min(output.find('@'), output.size());
    const auto dot = output.rfind('.', end);
    return std::string(
        output.substr(dot == output.npos ? 0 : dot + 1, end - (dot == output.npos ? 0 : dot + 1)));
}

std::vector<Channel> definitions_of(std::span<const Channel> defined, const std::string& figure) {
    std::vector<Channel> list_of_figure;
    std::string own = figure;  // without the test of an axle
    for (const char* test : {"@parallel", "@opposed", "@both"})
        if (own.ends_with(test)) own.resize(own.rfind('@'));
    for (const Channel& channel : defined) {
        const std::string base = channel.name.substr(0, channel.name.find('@'));
        // a figure of the axle, "toe@axle", may stand for that of either wheel
        if (channel.name != figure && (base == own || own.ends_with("." + base)))
            list_of_figure.push_back(channel);
    }
    return list_of_figure;
}

}  // namespace elastocheck::compare
