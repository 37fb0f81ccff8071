#include "reports/document/measurement.hpp"

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/page/sections.hpp"
#include "tests/fuzz/targets.hpp"

namespace elastocheck::fuzz {
namespace {

using json = nlohmann::ordered_json;

// Curves as legs would have them: something that rises, from one end of each branch to the other.
json suspension() {
    const Model model = compile(read_scene(ELASTOCHECK_SCENES "/trailing_arm.yaml"));
    const auto channels = compare::channels(model);
    const auto drawn = evaluate(model, channels, compare::design_state(model));
    json scene;
    for (std::size_t c = 0; c < channels.size(); ++c)
        scene["channels"].push_back({{"name", channels[c].name},
                                     {"unit", symbol(channels[c].unit)},
                                     {"kinematic", channels[c].kinematic()},
                                     {"drawn", drawn[c]}});
    for (const auto& branch : model.branches) {
        const auto unit = compare::unit_of(branch.unit);
        json curve;
        for (int k = 0; k <= 5; ++k) {
            curve["a"].push_back(in_unit(unit) * (branch.from + (branch.to - branch.from) * k / 5));
            for (std::size_t c = 0; c < channels.size(); ++c)
                curve["values"][channels[c].name].push_back(drawn[c] + 10.0 * k);
        }
        scene["branches"].push_back({{"name", branch.name},
                                     {"from", curve["a"].front()},
                                     {"to", curve["a"].back()},
                                     {"unit", symbol(unit)},
                                     {"legs", json(3, {{"curve", curve}})}});
    }
    return scene;
}

}  // namespace

// The file's names of branches are those of a map, as a rig has them.
void measurement(std::string_view input) {
    static const json suspension = fuzz::suspension();
    static const reports::ColumnMap cases = [] {
        reports::ColumnMap map;
        map.columns = {{.theirs = "case", .output = "branch", .unit = {}}};
        map.branches = {{"Ride", "travel"}, {"Lat Force=", "lateral"}};
        return map;
    }();
    for (const auto& how : {reports::ColumnMap{}, cases}) try {
            json scene = suspension;
            add_measurement(scene, input, "fuzz.csv", how);
            expect_plain("the document", scene["measured"].dump());
            if (reports::compared_with_measurement(scene) < 0)
                throw Fault("fewer than none compared");
            const json written = {{"measured", json::parse(scene["measured"].dump())}};
            const std::string file = "result.json";
            (void)reports::measured_section({&written, "", &file});
        } catch (const reports::MeasurementError& error) {
            const std::string_view what = error.what();
            if (!what.starts_with("fuzz.csv:"))
                throw Fault("a refusal without a place: " + std::string(what));
        }
}

}  // namespace elastocheck::fuzz
