#include "reports/document/measurement.hpp"

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/page/sections.hpp"
#include "tests/fuzz/targets.hpp"

namespace elastocheck::fuzz {
namespace {

struct Suspension {
    Model model;
    compare::Comparison comparison;
};

// Curves as legs would have them: something that rises, from one end of each branch to the other.
Suspension suspension() {
    Suspension made{compile(read_scene(ELASTOCHECK_SCENES "/trailing_arm.yaml")), {}};
    auto& all = made.comparison;
    all.channels = compare::channels(made.model);
    const auto drawn = evaluate(made.model, all.channels, compare::design_state(made.model));
    for (const auto& branch : made.model.branches) {
        compare::BranchComparison one;
        one.branch = branch.name;
        one.unit = compare::unit_of(branch.unit);
        for (const auto leg : compare::legs) {
            compare::LegRun run;
            run.leg = leg;
            run.curve.unit = one.unit;
            constexpr int points = 5;
            for (int k = 0; k <= points; ++k) {
                const double a = branch.from + (branch.to - branch.from) * k / points;
                auto values = drawn;
                for (double& value : values) value += 10.0 * k;
                append(run.curve, a, std::move(values));
            }
            one.runs.push_back(std::move(run));
        }
        all.branches.push_back(std::move(one));
    }
    return made;
}

}  // namespace

// The file's names of branches are those of --case, as a rig has them.
void measurement(std::string_view input) {
    static const Suspension suspension = fuzz::suspension();
    static const reports::LoadCases cases{"case", {{"Ride", "travel"}, {"Lat Force=", "lateral"}}};
    for (const auto& how : {reports::LoadCases{}, cases}) try {
            nlohmann::ordered_json scene = nlohmann::ordered_json::object();
            add_measurement(scene, input, "fuzz.csv", suspension.model, suspension.comparison, how);
            expect_plain("the document", scene.dump());
            if (reports::compared_with_measurement(scene) < 0)
                throw Fault("fewer than none compared");
            const auto written = nlohmann::ordered_json::parse(scene.dump());
            const std::string file = "result.json";
            (void)reports::measured_section({&written, "", &file});
        } catch (const reports::MeasurementError& error) {
            const std::string_view what = error.what();
            if (!what.starts_with("fuzz.csv:"))
                throw Fault("a refusal without a place: " + std::string(what));
        }
}

}  // namespace elastocheck::fuzz
