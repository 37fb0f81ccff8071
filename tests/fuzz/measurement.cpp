#include "reports/given/measurement.hpp"

#include "compare/candidate/candidate.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "reports/page/sections.hpp"
#include "reports/render/render.hpp"
#include "tests/fuzz/targets.hpp"

namespace elastocheck::fuzz {
namespace {

// Curves as legs would have them: something that rises, from one end of each branch to the other.
reports::SceneAnalyses suspension() {
    reports::SceneAnalyses of{.model =
                                  compile(read_scene(ELASTOCHECK_SCENES "/trailing_arm.yaml"))};
    of.comparison = compare::outline(of.model);
    const auto drawn = evaluate(of.model, of.comparison.channels, compare::design_state(of.model));
    for (std::size_t b = 0; b < of.model.branches.size(); ++b) {
        const Branch& branch = of.model.branches[b];
        compare::Curve curve{.unit = compare::unit_of(branch.unit), .a = {}, .values = {}};
        for (int k = 0; k <= 5; ++k) {
            curve.a.push_back(in_unit(curve.unit) *
                              (branch.from + (branch.to - branch.from) * k / 5));
            curve.values.push_back(drawn);
            for (double& value : curve.values.back()) value += 10.0 * k;
        }
        for (std::size_t leg = 0; leg < compare::legs.size(); ++leg)
            of.comparison.branches[b].runs.emplace_back().curve = curve;
    }
    return of;
}

}  // namespace

// The file's names of branches are those of a map, as a rig has them.
void measurement(std::string_view input) {
    static const reports::SceneAnalyses suspension = fuzz::suspension();
    static const reports::ColumnMap cases = [] {
        reports::ColumnMap map;
        map.columns = {{.theirs = "case", .output = "branch", .unit = {}}};
        map.branches = {{"Ride", "travel"}, {"Lat Force=", "lateral"}};
        return map;
    }();
    for (const auto& how : {reports::ColumnMap{}, cases}) try {
            reports::SceneAnalyses scene = suspension;
            scene.measured = reports::compare_measurement(
                scene.model, scene.comparison, {},
                reports::read_measurement(input, "fuzz.csv", scene.model, how));
            expect_plain("the document",
                         reports::json_of(result_of(*scene.measured, scene.comparison)).dump());
            if (scene.measured->found.compared < 0) throw Fault("fewer than none compared");
            (void)reports::measured_section(scene);
        } catch (const reports::SheetError& error) {
            const std::string_view what = error.what();
            if (!what.starts_with("fuzz.csv:"))
                throw Fault("a refusal without a place: " + std::string(what));
        }
}

}  // namespace elastocheck::fuzz
