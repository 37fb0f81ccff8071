// Compliance under horizontal forces and vertical moments, wheel centres held at their height. An axle
// is tested as on a rig, which loads both wheels; one wheel loaded alone is another definition.
#include <fmt/format.h>

#include <algorithm>

#include "compare/outputs/catalogue/subject.hpp"

namespace elastocheck::compare {
namespace {

// What a test measures.
enum class Seen { toe, camber, along_the_force };
struct ForceFigure {
    const char* name;
    Unit unit;
    Seen seen;
    const char* stiffness = "";  // of Seen::along_the_force: force over displacement
    bool key = false, explained = false;
    int live = 0;  // place on a live page, of its first loading
};
struct Loading {
    const char* name;  // after "@"
    double other;      // cause on the other wheel per unit on this one, ground axes
    const char* cause;
    const char* rig;  // what rigs call it
};
struct ForceTest {
    int cause;         // position among the causes of WheelResponse
    double sign;       // of the cause, ground axes; 0: towards the middle of the vehicle, or toe-in
    const char* what;  // "braking force at the contact patch"
    Loading alone;
    std::vector<Loading> on_a_rig;
    std::vector<ForceFigure> figures;
    int Usual::*moved;  // kind of a branch with this load
};

constexpr auto programs = "programs that load one wheel";

const std::vector<ForceTest>& force_tests() {
    static const std::vector<ForceTest> tests{
        {at_patch + 1,
         0,
         "lateral force at the contact patch",
         {"alone", 0,
          "a force at the contact patch towards the middle of the vehicle (as on the outer wheel "
          "in a turn)",
          programs},
         {{"parallel", 1,
           "a force at each contact patch, both to the same side, on this wheel towards the middle "
           "of the vehicle",
           "rigs: lateral force, parallel"},
          {"opposed", -1, "a force at each contact patch, both towards the middle of the vehicle",
           "rigs: lateral force, opposed"}},
         {{"lateral_force_steer", Unit::deg_per_kN, Seen::toe, "", true, true, 3},
          {"lateral_force_camber", Unit::deg_per_kN, Seen::camber, "", false, false, 5},
          {"lateral_stiffness", Unit::newton_per_mm, Seen::along_the_force,
           "lateral force at the contact patch over its lateral displacement", false, false, 7}},
         &Usual::lateral},
        {at_patch,
         -1,
         "braking force at the contact patch",
         {"alone", 0, "a force to the back at the contact patch", programs},
         {{"both", 1, "a force to the back at each contact patch", "rigs: both wheels braked"}},
         {{"braking_force_steer", Unit::deg_per_kN, Seen::toe, "", true, false, 3},
          {"braking_force_camber", Unit::deg_per_kN, Seen::camber, "", false, false, 4},
          {"longitudinal_stiffness", Unit::newton_per_mm, Seen::along_the_force,
           "longitudinal force at the contact patch over its longitudinal displacement", false,
           false, 6}},
         &Usual::longitudinal},
        {at_centre,
         1,
         "traction force at the wheel centre",
         {"alone", 0, "a force forward at the wheel centre", programs},
         {{"both", 1, "a force forward at each wheel centre", "rigs: both wheels driven"}},
         {{"traction_force_steer", Unit::deg_per_kN, Seen::toe, "", true, false, 5},
          {"longitudinal_stiffness_at_centre", Unit::newton_per_mm, Seen::along_the_force,
           "longitudinal force at the wheel centre over its longitudinal displacement"}},
         &Usual::longitudinal},
        {moment_on + 2,
         0,
         "aligning torque",
         {"alone", 0, "a moment about the vertical that turns the wheel towards toe-in", programs},
         {{"parallel", 1, "the same moment about z on each wheel, here towards toe-in",
           "rigs: aligning torque, parallel"},
          {"opposed", -1, "a moment about z on each wheel towards toe-in",
           "rigs: aligning torque, opposed"}},
         {{"aligning_torque_steer", Unit::deg_per_100Nm, Seen::toe, "", false, false, 3},
          {"aligning_torque_camber", Unit::deg_per_100Nm, Seen::camber, "", false, false, 5}},
         &Usual::moment}};
    return tests;
}

double value(const Subject& x, int cause, double sign, double other, Seen seen) {
    const auto by_force_on = [&](std::size_t w) {
        const auto& by = x.response->held[w][static_cast<std::size_t>(cause)];
        const Placed at = cause < moment_on   ? x.centre()
                          : cause == at_patch ? x.braked()
                                              : x.patch();
        return seen == Seen::toe      ? x.toe(by)
               : seen == Seen::camber ? x.camber(by)
                                      : x.moved_by(by, at)[cause % 3];
    };
    const double alone = by_force_on(x.k);
    double sum = alone;
    for (std::size_t w = 0; other != 0 && w < x.model.wheels.size(); ++w)
        if (w != x.k) sum += other * by_force_on(w);
    if (seen != Seen::along_the_force) return (sign != 0 ? sign : -x.side()) * sum;
    // Where the displacements by both forces cancel, the axle is rigid, and their sum is rounding.
    constexpr double max_cancellation = 1e5;
    return ratio(1, sum, std::min(max_stiffness, max_cancellation / std::abs(alone)));
}

std::string definition(bool axle, const ForceTest& test, const Loading& loading,
                       const ForceFigure& figure) {
    constexpr auto at_height = ", wheel centres held at their height";
    switch (figure.seen) {
        case Seen::toe:
            return fmt::format("change of toe over {}{}{}; positive towards toe-in", loading.cause,
                               axle && loading.other == 0 ? ", this wheel alone loaded" : "",
                               at_height);
        case Seen::camber:
            return fmt::format("change of camber {}; positive where the top leans out",
                               axle ? "in the same test"
                               : test.cause >= moment_on && test.cause < at_patch
                                   ? "over the same moment, likewise"
                                   : "over the same force, likewise");
        case Seen::along_the_force: break;
    }
    return std::string(figure.stiffness) + (axle ? " in the same test" : at_height);
}

// `place`: of the loading among those of its owner; -1 for one wheel of an axle loaded alone.
Entry entry(Owner owner, const ForceTest& test, const Loading& loading, const ForceFigure& figure,
            int place) {
    const bool axle = owner == Owner::wheel_of_axle, usual = place >= 0;
    Usual live;
    if (usual && figure.live != 0) live.*test.moved = figure.live + place;
    return {owner,
            axle ? fmt::format("{}@{}", figure.name, loading.name) : figure.name,
            figure.unit,
            definition(axle, test, loading, figure),
            figure.seen == Seen::along_the_force ? "rigid: nothing gives" : "",
            [cause = test.cause, sign = test.sign, other = loading.other,
             seen = figure.seen](const Subject& x) { return value(x, cause, sign, other, seen); },
            {.elsewhere = loading.rig,
             .key = usual && figure.key,
             .explained = usual && figure.explained && loading.other >= 0,
             .compliance = usual,
             .live = live,
             .cause = test.what}};
}

}  // namespace

void add_force_tests(std::vector<Entry>& all, bool alone) {
    for (const ForceTest& test : force_tests())
        for (const ForceFigure& figure : test.figures) {
            if (alone) {
                all.push_back(entry(Owner::wheel_of_axle, test, test.alone, figure, -1));
                continue;
            }
            all.push_back(entry(Owner::wheel_without_axle, test, test.alone, figure, 0));
            int place = 0;
            for (const Loading& loading : test.on_a_rig)
                all.push_back(entry(Owner::wheel_of_axle, test, loading, figure, ++place));
        }
}

}  // namespace elastocheck::compare
