// Compliance under horizontal forces and vertical moments, wheel centres held at their height. An axle
// is tested as on a rig, which loads both wheels; one wheel loaded alone is another definition.
#include <fmt/format.h>

#include <algorithm>

#include "compare/outputs/catalogue/subject.hpp"

namespace elastocheck::compare {
namespace {

// Quantity that a test measures per unit of the load: change of toe, change of camber, or displacement of
// the loaded point along the force.
enum class MeasuredChange { toe, camber, displacement };
struct ForceFigure {
    const char* name;
    Unit unit;
    MeasuredChange measured;
    const char* stiffness = "";  // definition of a figure of MeasuredChange::displacement
    bool key = false, explained = false;
    // LiveRank of one wheel without axle; + 1, + 2 for the loadings of an axle; 0: none
    int live_rank = 0;
};
struct Loading {
    const char* name;         // suffix of the name of the figure, after "@"
    double other;             // load on the other wheel per unit load on this one, ground axes
    const char* description;  // the load in words
    const char* sources;      // name of the loading at test rigs or in programs
};
struct ForceTest {
    int wrench;  // index in WheelResponse::jacked
    // sign of the load along its ground axis; 0: -side, a force to the middle of the vehicle, a moment to toe-in
    double sign;
    const char* load;  // "braking force at the contact patch"
    Loading alone;
    std::vector<Loading> on_a_rig;
    std::vector<ForceFigure> figures;
    int LiveRank::*branch_kind;  // kind of a branch with this load
};

constexpr auto programs = "programs that load one wheel";

const std::vector<ForceTest>& force_tests() {
    static const std::vector<ForceTest> tests{
        {first_patch_force + 1,
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
         {{"lateral_force_steer", Unit::deg_per_kN, MeasuredChange::toe, "", true, true, 3},
          {"lateral_force_camber", Unit::deg_per_kN, MeasuredChange::camber, "", false, false, 5},
          {"lateral_stiffness", Unit::newton_per_mm, MeasuredChange::displacement,
           "lateral force at the contact patch over its lateral displacement", false, false, 7}},
         &LiveRank::lateral},
        {first_patch_force,
         -1,
         "braking force at the contact patch",
         {"alone", 0, "a force to the back at the contact patch", programs},
         {{"both", 1, "a force to the back at each contact patch", "rigs: both wheels braked"}},
         {{"braking_force_steer", Unit::deg_per_kN, MeasuredChange::toe, "", true, false, 3},
          {"braking_force_camber", Unit::deg_per_kN, MeasuredChange::camber, "", false, false, 4},
          {"longitudinal_stiffness", Unit::newton_per_mm, MeasuredChange::displacement,
           "longitudinal force at the contact patch over its longitudinal displacement", false,
           false, 6}},
         &LiveRank::longitudinal},
        {first_centre_force,
         1,
         "traction force at the wheel centre",
         {"alone", 0, "a force forward at the wheel centre", programs},
         {{"both", 1, "a force forward at each wheel centre", "rigs: both wheels driven"}},
         {{"traction_force_steer", Unit::deg_per_kN, MeasuredChange::toe, "", true, false, 5},
          {"longitudinal_stiffness_at_centre", Unit::newton_per_mm, MeasuredChange::displacement,
           "longitudinal force at the wheel centre over its longitudinal displacement"}},
         &LiveRank::longitudinal},
        {first_moment + 2,
         0,
         "aligning torque",
         {"alone", 0, "a moment about the vertical that turns the wheel towards toe-in", programs},
         {{"parallel", 1, "the same moment about z on each wheel, here towards toe-in",
           "rigs: aligning torque, parallel"},
          {"opposed", -1, "a moment about z on each wheel towards toe-in",
           "rigs: aligning torque, opposed"}},
         {{"aligning_torque_steer", Unit::deg_per_100Nm, MeasuredChange::toe, "", false, false, 3},
          {"aligning_torque_camber", Unit::deg_per_100Nm, MeasuredChange::camber, "", false, false,
           5}},
         &LiveRank::moment}};
    return tests;
}

double value(const Subject& x, int wrench, double sign, double other, MeasuredChange measured) {
    const auto change_under_load_on = [&](std::size_t w) {
        const auto& motions = x.response->jacked[w][static_cast<std::size_t>(wrench)];
        const PlacedPoint loaded_point = wrench < first_moment         ? x.centre()
                                         : wrench == first_patch_force ? x.braked_patch()
                                                                       : x.patch();
        return measured == MeasuredChange::toe ? x.toe(motions)
               : measured == MeasuredChange::camber
                   ? x.camber(motions)
                   : x.displacement(motions, loaded_point)[wrench % 3];
    };
    const double alone = change_under_load_on(x.k);
    double sum = alone;
    for (std::size_t w = 0; other != 0 && w < x.model.wheels.size(); ++w)
        if (w != x.k) sum += other * change_under_load_on(w);
    if (measured != MeasuredChange::displacement) return (sign != 0 ? sign : -x.side()) * sum;
    // Where the displacements by both forces cancel, the axle is rigid, and their sum is rounding.
    constexpr double max_cancellation = 1e5;
    return ratio(1, sum, std::min(max_stiffness, max_cancellation / std::abs(alone)));
}

std::string definition(bool axle, const ForceTest& test, const Loading& loading,
                       const ForceFigure& figure) {
    constexpr auto at_height = ", wheel centres held at their height";
    switch (figure.measured) {
        case MeasuredChange::toe:
            return fmt::format(
                "change of toe over {}{}{}; positive towards toe-in", loading.description,
                axle && loading.other == 0 ? ", this wheel alone loaded" : "", at_height);
        case MeasuredChange::camber:
            return fmt::format("change of camber {}; positive where the top leans out",
                               axle ? "in the same test"
                               : test.wrench >= first_moment && test.wrench < first_patch_force
                                   ? "over the same moment, likewise"
                                   : "over the same force, likewise");
        case MeasuredChange::displacement: break;
    }
    return std::string(figure.stiffness) + (axle ? " in the same test" : at_height);
}

// `position`: 0 for a wheel without axle; 1, 2, ... for the loadings of an axle; -1 for one
// wheel of an axle loaded alone.
Entry entry(Owner owner, const ForceTest& test, const Loading& loading, const ForceFigure& figure,
            int position) {
    const bool axle = owner == Owner::wheel_of_axle, is_default = position >= 0;
    LiveRank live_rank;
    if (is_default && figure.live_rank != 0)
        live_rank.*test.branch_kind = figure.live_rank + position;
    return {
        owner,
        axle ? fmt::format("{}@{}", figure.name, loading.name) : figure.name,
        figure.unit,
        definition(axle, test, loading, figure),
        figure.measured == MeasuredChange::displacement ? "rigid: nothing gives" : "",
        [wrench = test.wrench, sign = test.sign, other = loading.other, measured = figure.measured](
            const Subject& x) { return value(x, wrench, sign, other, measured); },
        {.sources = loading.sources,
         .is_key_figure = is_default && figure.key,
         .explained = is_default && figure.explained && loading.other >= 0,
         .compliance = is_default,
         .live_rank = live_rank,
         .cause = test.load}};
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
            int position = 0;
            for (const Loading& loading : test.on_a_rig)
                all.push_back(entry(Owner::wheel_of_axle, test, loading, figure, ++position));
        }
}

}  // namespace elastocheck::compare
