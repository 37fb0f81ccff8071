#include "compare/comparison/characteristics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "compare/comparison/characteristic_formulas.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using namespace characteristic;

// ---- Catalogue.

const Entry travel_figures[] = {
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
              return x.side(w) * x.moved_by(raised(x, w), x.patch(w)).y();
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
              return ratio(x.side(w) * v.z(), x.turned_by(by, x[w].body).x(), nowhere);
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
};

const Entry other_figures[] = {
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
            return axis ? atan2(-axis->n.x(), axis->n.z()) : undefined;
        }},
    Entry{Owner::steered_wheel, "kingpin_inclination_steered", Unit::deg,
          "angle to the vertical seen from the front of the same axis; positive where its top "
          "leans inwards",
          does_not_steer,
          [](const auto& x, std::size_t w) {
              const auto axis = steering_axis(x, w);
              using std::atan2;
              return axis ? atan2(-x.side(w) * axis->n.y(), axis->n.z()) : undefined;
          }},
    Entry{Owner::steered_wheel, "scrub_radius_steered", Unit::mm,
          "distance across the wheel from the contact patch to the intersection of the same axis "
          "with the road, positive inboard",
          does_not_steer,
          [](const auto& x, std::size_t w) {
              const auto axis = steering_axis(x, w);
              return axis ? -across(x, w).dot(on_the_road(x, w, *axis)) : undefined;
          }},
    Entry{Owner::steered_wheel, "mechanical_trail_steered", Unit::mm,
          "distance along the wheel from the contact patch to the intersection of the same axis "
          "with the road, positive in front",
          does_not_steer,
          [](const auto& x, std::size_t w) {
              const auto axis = steering_axis(x, w);
              return axis ? along(x, w).dot(on_the_road(x, w, *axis)) : undefined;
          }},
    Entry{Owner::front_wheel, "anti_dive", Unit::percent,
          "brake_share · wheelbase / cg_height · forward over vertical displacement of the contact "
          "patch: share of the load transfer under braking that the links carry; positive where "
          "they resist dive",
          no_vertical,
          [](const auto& x, std::size_t w) {
              return anti(x, x.braked(w), &Vehicle::brake_share, 1);
          }},
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
              return anti(x, x.braked(w), &Vehicle::brake_share, -1);
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
        "no finite roll centre",
        [](const auto& x, std::size_t) {
            return roll_centre(x, &std::decay_t<decltype(x)>::patch);
        }},
    Entry{Owner::wheel_of_axle, "roll_steer", Unit::deg_per_deg,
          "change of toe over the roll of the car body towards this wheel, wheels on the road; "
          "positive "
          "towards toe-in",
          does_not_roll,
          [](const auto& x, std::size_t w) {
              return x.response.tied ? undefined : x.toe(w, rolled_towards(x, w));
          }},
    Entry{Owner::wheel_of_axle, "roll_camber", Unit::deg_per_deg,
          "change of camber against the car body over its roll towards this wheel; positive where "
          "the top "
          "leans out",
          does_not_roll,
          [](const auto& x, std::size_t w) {
              return x.response.tied ? undefined : x.camber(w, rolled_towards(x, w));
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
            return shortening(x, x.point(spring.i), x.point(spring.j));
        }},
    Entry{
        Owner::damper, "motion_ratio", Unit::none,
        "shortening of the damper over travel of the wheel centres, all rising by the same amount",
        never,
        [](const auto& x, std::size_t k) {
            const auto& damper = x.model.dampers[k];
            return shortening(x, x.point(damper.i), x.point(damper.j));
        }},
};

// ---- Compliance under forces and moments in the plane of the road, wheel centres held at their
// height. Of an axle the tests of a rig, which loads both wheels; one wheel alone by a definition.

enum class Seen { toe, camber, along_the_force };
struct ForceFigure {
    const char* name;
    Unit unit;
    Seen seen;
    const char* stiffness = "";  // of Seen::along_the_force: force over displacement
};
struct Loading {
    const char* name;  // after "@"
    double other;      // on the other wheel, per unit on this one, ground axes
    const char* cause;
    const char* rig;  // what rigs call it
};
struct ForceTest {
    int cause;
    double sign;  // of the cause, ground axes; 0: towards the middle of the vehicle, or toe-in
    Loading alone;
    std::vector<Loading> on_a_rig;
    std::vector<ForceFigure> figures;
};

const std::vector<ForceTest>& force_tests() {
    static const std::vector<ForceTest> tests{
        {at_patch + 1,
         0,
         {"alone", 0,
          "a force at the contact patch towards the middle of the vehicle (as on the outer wheel "
          "in "
          "a turn)",
          "programs that load one wheel"},
         {{"parallel", 1,
           "a force at each contact patch, both to the same side, on this wheel towards the middle "
           "of the vehicle",
           "rigs: lateral force, parallel"},
          {"opposed", -1, "a force at each contact patch, both towards the middle of the vehicle",
           "rigs: lateral force, opposed"}},
         {{"lateral_force_steer", Unit::deg_per_kN, Seen::toe},
          {"lateral_force_camber", Unit::deg_per_kN, Seen::camber},
          {"lateral_stiffness", Unit::newton_per_mm, Seen::along_the_force,
           "lateral force at the contact patch over its lateral displacement"}}},
        {at_patch,
         -1,
         {"alone", 0, "a force to the back at the contact patch", "programs that load one wheel"},
         {{"both", 1, "a force to the back at each contact patch", "rigs: both wheels braked"}},
         {{"braking_force_steer", Unit::deg_per_kN, Seen::toe},
          {"braking_force_camber", Unit::deg_per_kN, Seen::camber},
          {"longitudinal_stiffness", Unit::newton_per_mm, Seen::along_the_force,
           "longitudinal force at the contact patch over its longitudinal displacement"}}},
        {at_centre,
         1,
         {"alone", 0, "a force forward at the wheel centre", "programs that load one wheel"},
         {{"both", 1, "a force forward at each wheel centre", "rigs: both wheels driven"}},
         {{"traction_force_steer", Unit::deg_per_kN, Seen::toe},
          {"longitudinal_stiffness_at_centre", Unit::newton_per_mm, Seen::along_the_force,
           "longitudinal force at the wheel centre over its longitudinal displacement"}}},
        {moment_on + 2,
         0,
         {"alone", 0, "a moment about the vertical that turns the wheel towards toe-in",
          "programs that load one wheel"},
         {{"parallel", 1, "the same moment about z on each wheel, here towards toe-in",
           "rigs: aligning torque, parallel"},
          {"opposed", -1, "a moment about z on each wheel towards toe-in",
           "rigs: aligning torque, opposed"}},
         {{"aligning_torque_steer", Unit::deg_per_100Nm, Seen::toe},
          {"aligning_torque_camber", Unit::deg_per_100Nm, Seen::camber}}}};
    return tests;
}

Entry entry_of(Owner owner, const ForceTest& test, const Loading& loading,
               const ForceFigure& figure) {
    const bool axle = owner != Owner::wheel_without_axle;
    const std::string at_height = ", wheel centres held at their height";
    Entry entry{owner,
                axle ? fmt::format("{}@{}", figure.name, loading.name) : figure.name,
                figure.unit,
                "",
                never,
                [cause = test.cause, sign = test.sign, other = loading.other, seen = figure.seen](
                    const auto& x, std::size_t w) {
                    const auto at = cause < moment_on   ? x.centre(w)
                                    : cause == at_patch ? x.braked(w)
                                                        : x.patch(w);
                    const auto by_force_on = [&](std::size_t k) {
                        const auto& by = held(x, k, cause);
                        return seen == Seen::toe      ? x.toe(w, by)
                               : seen == Seen::camber ? x.camber(w, by)
                                                      : x.moved_by(by, at)[cause % 3];
                    };
                    const double alone = by_force_on(w);
                    double sum = alone;
                    for (std::size_t k = 0; other != 0 && k < x.model.wheels.size(); ++k)
                        if (k != w) sum += other * by_force_on(k);
                    // Forces that an axle carries within itself leave their rounding.
                    constexpr double cancelled = 1e5;
                    return seen == Seen::along_the_force
                               ? ratio(1, sum, std::min(rigid, cancelled / std::abs(alone)))
                               : (sign != 0 ? sign : -x.side(w)) * sum;
                }};
    switch (figure.seen) {
        case Seen::toe:
            entry.definition = fmt::format(
                "change of toe over {}{}{}; positive towards toe-in", loading.cause,
                axle && loading.other == 0 ? ", this wheel alone loaded" : "", at_height);
            break;
        case Seen::camber:
            entry.definition = fmt::format("change of camber {}; positive where the top leans out",
                                           axle ? "in the same test"
                                           : test.cause >= moment_on && test.cause < at_patch
                                               ? "over the same moment, likewise"
                                               : "over the same force, likewise");
            break;
        case Seen::along_the_force:
            entry.definition = figure.stiffness + (axle ? " in the same test" : at_height);
            entry.undefined = gives_nothing;
    }
    entry.used_by = loading.rig;
    return entry;
}

Catalogue whole_catalogue() {
    Catalogue all;
    std::vector<Entry> alone;
    std::ranges::copy(travel_figures, std::back_inserter(all.entries));
    for (const ForceTest& test : force_tests())
        for (const ForceFigure& figure : test.figures) {
            all.entries.push_back(entry_of(Owner::wheel_without_axle, test, test.alone, figure));
            for (const Loading& loading : test.on_a_rig)
                all.entries.push_back(entry_of(Owner::wheel_of_axle, test, loading, figure));
            alone.push_back(entry_of(Owner::wheel_of_axle, test, test.alone, figure));
        }
    std::ranges::copy(other_figures, std::back_inserter(all.entries));
    all.own = all.entries.size();
    std::ranges::copy(by_other_definitions(), std::back_inserter(all.entries));
    std::ranges::copy(alone, std::back_inserter(all.entries));
    return all;
}

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
        case Owner::wheel_without_axle: return if_so(!is_axle(model));
        case Owner::wheels: return 1;
        case Owner::axle: return is_axle(model) ? 1 : 0;
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
        case Owner::wheel_of_axle:
        case Owner::wheel_without_axle: return model.wheels[k].name;
        case Owner::wheels:
        case Owner::axle: return "";
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

namespace {

const Entry& entry(std::size_t e) { return catalogue().entries[e]; }

std::vector<Channel> outputs(const Model& model, std::size_t from, std::size_t to) {
    std::vector<Channel> list;
    if (model.wheels.empty()) return list;
    for (std::size_t e = from; e < to; ++e)
        for (std::size_t k = 0; k < count(model, entry(e).of); ++k)
            if (const auto name = owner(model, entry(e).of, k))
                list.push_back({.name = *name + (name->empty() ? "" : ".") + entry(e).name,
                                .unit = entry(e).unit,
                                .main = false,
                                .reads = Characteristic{e, k},
                                .definition = entry(e).definition,
                                .undefined = entry(e).undefined});
    return list;
}

}  // namespace

const Catalogue& characteristic::catalogue() {
    static const Catalogue all = whole_catalogue();
    return all;
}

std::vector<Channel> characteristics(const Model& model) {
    return outputs(model, 0, catalogue().own);
}

std::vector<Channel> characteristics_otherwise(const Model& model) {
    auto list = outputs(model, catalogue().own, catalogue().entries.size());
    for (auto& channel : characteristics(model))
        if (channel.name.find('@') != channel.name.npos) list.push_back(std::move(channel));
    return list;
}

double value_of(const Model& model, const Characteristic& what, const Equilibrium& state,
                const WheelResponse& response) {
    if (response.blocked) return undefined;
    return response.why_not.empty() ? entry(what.entry).formula({model, state, response}, what.of)
                                    : nan;
}

bool needs_free(const Characteristic& what) {
    const Entry& of = entry(what.entry);
    return of.of == Owner::wheel_on_tyre || of.unit == Unit::newton_per_mm || of.reads_free;
}

bool is_swing_arm(const Characteristic& what) { return entry(what.entry).swing_arm; }

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
                const bool centre = point == WheelPoint::centre;
                C.block<6, 1>(6 * i, 6 * j + k)
                    << wheels.moved_by(by, centre ? wheels.centre(w) : wheels.patch(w)),
                    turned(by, wheels[w].body);
                // as the longitudinal force, that of a braked wheel
                if (!centre) C(6 * i, 6 * j + k) = wheels.moved_by(by, wheels.braked(w)).x();
            }
        }
    return C;
}

double reciprocity(const Model& model, const Eigen::MatrixXd& C) {
    if (C.size() == 0) return nan;
    Eigen::VectorXd size = Eigen::VectorXd::Ones(C.rows());
    for (std::size_t w = 0; w < model.wheels.size(); ++w) {
        const double radius = drawn_arm(model, model.wheels[w]).norm();
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
