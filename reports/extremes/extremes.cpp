#include "reports/extremes/extremes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "elastocheck/read_scene.hpp"
#include "extremes_embedded.hpp"  // generated: name and text of every scene of models/extremes

namespace elastocheck::reports {
namespace {

using By = compare::Variant::Construction;

struct Value {
    const char* label;
    std::vector<Setting> settings;
    By known = By::nothing;  // known by construction of the scene
};
struct Extreme {
    const char* scene;
    std::vector<Value> values;
};

// Values in the units of the file: mm.
const std::vector<Extreme>& table() {
    static const std::vector<Extreme> all{
        {"two_hinges",
         {{"axes at 1e-1 rad", {setting("points.skew.x", 100)}, By::nothing_moves},
          {"axes at 1e-3 rad", {setting("points.skew.x", 1)}, By::nothing_moves},
          {"axes at 1e-6 rad", {setting("points.skew.x", 1e-3)}, By::nothing_moves},
          {"axes at 1e-9 rad", {setting("points.skew.x", 1e-6)}, By::nothing_moves},
          {"axes in one line", {setting("points.skew.x", 0)}}}},
        {"tie_rod_through_axis",
         {{"lever 100 mm", {setting("points.arm.x", 100)}, By::nothing_moves},
          {"lever 1 mm", {setting("points.arm.x", 1)}, By::nothing_moves},
          {"lever 1e-3 mm", {setting("points.arm.x", 1e-3)}, By::nothing_moves},
          {"lever 1e-6 mm", {setting("points.arm.x", 1e-6)}, By::nothing_moves},
          {"through the axis", {setting("points.arm.x", 0)}}}},
        {"links_in_a_plane",
         {{"50 mm out of it", {setting("points.a_in.z", 50), setting("points.b_in.z", 2 * 50)}},
          {"1 mm out of it", {setting("points.a_in.z", 1), setting("points.b_in.z", 2 * 1)}},
          {"1e-3 mm out of it",
           {setting("points.a_in.z", 1e-3), setting("points.b_in.z", 2 * 1e-3)}},
          {"1e-6 mm out of it",
           {setting("points.a_in.z", 1e-6), setting("points.b_in.z", 2 * 1e-6)}},
          {"in the plane", {setting("points.a_in.z", 0), setting("points.b_in.z", 0)}}}},
        {"collinear_arm",
         {{"lever 300 mm", {setting("points.ball.y", 300)}},
          {"lever 1 mm", {setting("points.ball.y", 1)}},
          {"lever 1e-6 mm", {setting("points.ball.y", 1e-6)}},
          {"in one line", {setting("points.ball.y", 0)}}}},
        {"redundant_link",
         {{"consistent", {}},
          {"1e-9 mm apart", {setting("joints.link.length", 500.000000001)}},
          {"1e-5 mm apart", {setting("joints.link.length", 500.00001)}, By::no_equilibrium},
          {"1e-3 mm apart", {setting("joints.link.length", 500.001)}, By::no_equilibrium},
          {"1 mm apart", {setting("joints.link.length", 501)}, By::no_equilibrium}}},
        {"stop_that_touches",
         {{"1 mm away", {}},
          {"1e-9 mm away", {setting("springs.coil.bump_stop.clearance", 1e-9)}},
          {"just touches", {setting("springs.coil.bump_stop.clearance", 0)}},
          {"pressed by 1e-9 mm", {setting("springs.coil.bump_stop.clearance", -1e-9)}}}},
        {"flat_and_steep",
         {{"as it is", {}},
          {"flat rises by 1e-3 N",
           {setting("springs.coil.curve.table.7.2", 500.001),
            setting("springs.coil.curve.table.3.2", -500.001)}},
          {"flat",
           {setting("springs.coil.curve.table.7.2", 500),
            setting("springs.coil.curve.table.3.2", -500)}},
          {"steep within 1e-3 mm",
           {setting("springs.coil.curve.table.9.1", 30.001),
            setting("springs.coil.curve.table.1.1", -30.001)}},
          {"steep within 1e-6 mm",
           {setting("springs.coil.curve.table.9.1", 30.000001),
            setting("springs.coil.curve.table.1.1", -30.000001)}}}},
        {"column",
         {{"10 mm out of line", {}},
          {"1e-3 mm out of line", {setting("points.top.x", 1e-3)}},
          {"1e-6 mm out of line", {setting("points.top.x", 1e-6)}},
          {"1e-9 mm out of line", {setting("points.top.x", 1e-9)}},
          {"straight", {setting("points.top.x", 0)}}}},
        {"over_centre",
         {{"short of the limit point", {setting("branches.pull.to", 60)}},
          {"just short of it", {setting("branches.pull.to", 63.34)}},
          {"past it", {setting("branches.pull.to", 70)}},
          {"far past it", {setting("branches.pull.to", 400)}}}},
    };
    return all;
}

}  // namespace

std::vector<compare::Trial> extremes() {
    std::vector<compare::Trial> trials;
    for (const auto& extreme : table()) {
        const auto* file =
            std::ranges::find(embedded_extremes, extreme.scene, &Embedded_extremes::name);
        if (file == std::end(embedded_extremes)) throw std::logic_error("no scene of this name");
        for (const auto& value : extreme.values)
            trials.push_back({extreme.scene,
                              std::string(compare::extreme),
                              {.label = value.label,
                               .scene = parse_scene(file->text, extreme.scene, value.settings),
                               .known = value.known}});
    }
    return trials;
}

}  // namespace elastocheck::reports
