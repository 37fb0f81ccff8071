// result.json contains everything that was compared; missing values are explicit.
#include "reports/document/document.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/outputs/wheel_load.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "reports/document/curves.hpp"
#include "reports/json/json.hpp"
#include "reports/render/render.hpp"
#include "reports/tables/csv.hpp"
#include "tests/reports/documents.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

struct Made : SceneAnalyses {
    Made() {
        const Scene of = support::scene("chrono_mcpherson");
        scene = of;
        model = compile(of);
        hash = input_hash("input");
        compare::Options options;
        options.recursion.steps = 12;
        add_comparison(*this, compare::compare(model, options));
    }
    json document() const {
        json whole = reports::document("elastocheck compare x", provenance());
        whole["scenes"].push_back(scene_json(*this));
        return whole;
    }
};

TEST(Document, HasBuildInputAndSettings) {
    const json d = Made().document();
    const json& s = d["scenes"][0];
    EXPECT_EQ(d["schema"], result_schema);
    EXPECT_EQ(s["input_hash"], input_hash("input"));
    for (const char* key : {"elastocheck", "commit", "compiler", "flags", "cpu"})
        EXPECT_FALSE(d["provenance"][key].get<std::string>().empty()) << key;
    for (const char* key : {"Eigen", "Ceres", "NLopt", "yaml-cpp", "fmt"})
        EXPECT_FALSE(d["provenance"]["libraries"][key].get<std::string>().empty()) << key;
    EXPECT_EQ(s["verdict"]["conclusive"], true);
    EXPECT_GT(s["verdict"]["numbers_compared"], 1000);
}

TEST(Document, HasEveryPointOfEveryLegAndTheDeviationsAtEqualLoadAndTravel) {
    const Made made;
    const json d = json::parse(made.document().dump());
    const json& s = d["scenes"][0];
    ASSERT_EQ(s["branches"].size(), 2u);
    for (const auto& branch : s["branches"]) {
        EXPECT_EQ(branch["unit"], "N");
        EXPECT_EQ(branch["from"], 0);
        EXPECT_EQ(std::abs(branch["to"].get<double>()), 3000);
        EXPECT_EQ(branch["drivers"]["moved"], json::array({"vertical"}));
        EXPECT_EQ(branch["abscissa"], "travel");
        ASSERT_EQ(branch["legs"].size(), 3u);
        for (const auto& leg : branch["legs"]) {
            EXPECT_EQ(leg["outcome"], "converged");
            EXPECT_EQ(leg["curve"]["a"].size(), 13u);
            for (const auto& channel : s["channels"])
                EXPECT_EQ(leg["curve"]["values"][channel["name"].get<std::string>()].size(), 13u);
        }
        // All channels except those that are undefined somewhere on the branch: null.
        const auto compared = std::ranges::count_if(s["channels"], [&](const json& channel) {
            return std::ranges::none_of(branch["legs"], [&](const json& leg) {
                const auto& values = leg["curve"]["values"][channel["name"].get<std::string>()];
                return std::ranges::any_of(values, [](const json& v) {
                    return !v.is_number() || !std::isfinite(v.get<double>());
                });
            });
        });
        for (const char* pair : {"deviation", "cross_check", "reference_uncertainty"})
            for (const char* reading : {"at_equal_parameter", "at_equal_abscissa"})
                EXPECT_EQ(branch[pair][reading]["channels"].size(), compared) << pair << reading;
    }
    const auto& toe = s["branches"][0]["deviation"]["at_equal_parameter"]["channels"]["toe"];
    EXPECT_EQ(toe["max"], made.comparison.branches[0].deviation.equal_parameter.channels[3].max);
    EXPECT_EQ(toe["unit"], "deg");
}

TEST(Document, EveryChannelHasUnitDefinitionAndKind) {
    const json d = Made().document();
    std::set<std::string> rates;  // of the state and how it answers
    const json table = result_in(d["scenes"][0], "compare")["tables"]["rates"];
    for (const auto& row : table["rows"]) rates.insert(row[0].get<std::string>());
    EXPECT_GT(rates.size(), 20u);
    for (const auto& channel : d["scenes"][0]["channels"]) {
        EXPECT_FALSE(channel["definition"].get<std::string>().empty()) << channel;
        EXPECT_EQ(channel["kinematic"], (channel["unit"] == "mm" || channel["unit"] == "deg") &&
                                            !rates.contains(channel["name"].get<std::string>()))
            << channel;
        EXPECT_FALSE(channel.contains("unique")) << channel;
    }
}

TEST(Document, HasForcesOfElementsAtTheEndsOfTheBranches) {
    const Made made;
    const json whole = json::parse(made.document().dump());
    const auto told = compare::force_rows(made.model, made.comparison);
    EXPECT_EQ(result_in(whole["scenes"][0], "compare")["tables"]["forces"],
              json::parse(table_json(table_of(told)).dump()));
    const std::string rows = forces_csv({made});
    EXPECT_TRUE(
        rows.starts_with("scene,branch,end,end unit,element,output,unit,value,error,share [%]\n"))
        << rows;
    EXPECT_EQ(std::ranges::count(rows, '\n'), 1 + static_cast<long>(told.size()));
    EXPECT_NE(rows.find(",rebound,-3000,N,K1_coil,K1_coil.force,N,"), std::string::npos) << rows;
}

TEST(Csv, UndefinedValueIsAnEmptyCell) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(
        curves_row("b", compare::Leg::equilibrium, compare::Unit::newton, {2, 0, {1.5, nan, 3}}),
        "b,equilibrium,2,N,1.5,,3\n");
}

TEST(Document, NonFiniteNumberIsNull) {
    Made made;
    made.comparison.branches[0].runs[0].curve.values[3][0] =
        std::numeric_limits<double>::quiet_NaN();
    made.comparison.branches[0].deviation.equal_parameter.channels[0].max =
        std::numeric_limits<double>::infinity();
    const json d = json::parse(made.document().dump());
    const json& s = d["scenes"][0];
    EXPECT_TRUE(s["branches"][0]["legs"][0]["curve"]["values"]["wheel_centre_x"][3].is_null());
    EXPECT_TRUE(
        s["branches"][0]["deviation"]["at_equal_parameter"]["channels"]["wheel_centre_x"]["max"]
            .is_null());
}

TEST(Document, InputHashIsFnv1a) {
    EXPECT_EQ(input_hash(""), "cbf29ce484222325");
    EXPECT_EQ(input_hash("a"), "af63dc4c8601ec8c");
    EXPECT_EQ(input_hash("foobar"), "85944171f73967e8");
}

// A value of three bytes, `[],`, takes so much memory that a file of 30 MB would take 2 GB.
TEST(Json, DocumentWithTooManyValuesIsRejectedBeforeParsing) {
    std::string many = "[";
    while (many.size() < 30'000'000) many += "[],";
    many.back() = ']';
    try {
        (void)parse_json(many);
        ADD_FAILURE() << "parsed";
    } catch (const JsonError& error) {
        EXPECT_EQ(std::string(error.what()), "would take about 2.4 GB of memory; allowed: 2 GB");
    }
    std::string text = "[\"";  // brackets within a string are text
    text += many.substr(0, 20'000'000) + "\"]";
    EXPECT_EQ(parse_json(text).size(), 1u);
}

// ---- Wheel loads: what the road exerts.

const std::string trailing_arm = support::scene_text("reports/scenes/heavy_hub");

// A scene of models/scenes with masses.
std::string heavy(const std::string& name, const std::vector<std::string>& bodies) {
    std::string text = support::text_of(ELASTOCHECK_SCENES "/" + name + ".yaml");
    for (const auto& body : bodies) {
        const auto at = text.find("\n  " + body + ": {origin: ") + 4 + body.size();
        text.insert(text.find('}', at), ", mass: 25");
    }
    return text + "\ngravity: [0, 0, -9.81]\n";
}

// Forces on all bodies together but those of the road: weights, and the car body's by joints and
// elements, these by the work of lifting the whole suspension.
double lift_without_road(const Model& model, const Branch& branch, const Equilibrium& state) {
    const auto all = compare::element_channels(model);
    const auto is_jack = [&](const ModelJoint& joint) {
        return joint.active_only_where_driven && joint.name.ends_with("jack");
    };
    double sum = 0;
    for (const auto& load : model.static_loads)
        if (load.name.starts_with("gravity.")) sum += std::get<DeadForce>(load.kind).f.z();
    for (std::size_t k = 0; k < model.joints.size(); ++k)
        if (const ModelJoint& joint = model.joints[k]; !is_jack(joint))
            sum += (joint.j == ground   ? 1
                    : joint.i == ground ? -1
                                        : 0) *
                   state.reactions[k].force.z();
    constexpr double h = 1e-5;
    Equilibrium up = state, down = state;
    for (std::size_t b = 0; b < state.poses.size(); ++b)
        up.poses[b].r.z() += h, down.poses[b].r.z() -= h;
    const auto values = compare::evaluate(model, branch, all, state),
               above = compare::evaluate(model, branch, all, up),
               below = compare::evaluate(model, branch, all, down);
    for (std::size_t c = 0; c < all.size(); ++c) {
        const auto* of = std::get_if<compare::ElementComponent>(&all[c].reads);
        if (of == nullptr || of->component < 6 ||
            model.elastics[static_cast<std::size_t>(of->element)].written_as == WrittenAs::tyre)
            continue;
        std::size_t d = c;  // the deformation along the same axis
        while (std::get<compare::ElementComponent>(all[d].reads).component != of->component - 6)
            --d;
        sum -= values[c] * (above[d] - below[d]) / compare::in_unit(all[d].unit) / (2 * h);
    }
    return sum;
}

void expect_road_to_carry_the_scene(const std::string& text, double at_rest) {
    const Scene scene = compare::trim(parse_scene(text, "scene.yaml")).scene;
    const Model model = compile(scene);
    const auto channels = compare::channels(model);
    for (const auto& branch : model.branches)
        for (const auto& side : compare::sides_of(model, branch, 4)) {
            const std::vector<double> ends{0, side.branch.to / 2, side.branch.to};
            const auto path = reference::equilibrium::solve(side.model, side.branch, ends);
            ASSERT_EQ(path.points.size(), 3u) << side.name << ": " << path.detail;
            for (const auto& state : path.points) {
                const auto values = compare::evaluate(model, branch, channels, state);
                double road = 0;
                for (std::size_t c = 0; c < channels.size(); ++c) {
                    if (!channels[c].name.ends_with("wheel_load")) continue;
                    road += values[c];
                    if (branch.name == model.branches.front().name && state.load == 0) {
                        EXPECT_NEAR(values[c], at_rest, 1e-6) << channels[c].name;
                    }
                }
                EXPECT_NEAR(road + lift_without_road(model, branch, state), 0, 1e-4)
                    << scene.name << ", " << side.name << " at " << state.load;
            }
        }
}

TEST(WheelLoads, RoadForcesBalanceTheWeights) {
    expect_road_to_carry_the_scene(trailing_arm, 4000);
    expect_road_to_carry_the_scene(
        heavy("front_axle", {"wheel_left", "lower_arm_left", "drop_link_left", "rack"}), 3800);
    expect_road_to_carry_the_scene(heavy("solid_axle", {"axle", "lower_left"}), 4000);
    expect_road_to_carry_the_scene(support::text_of(ELASTOCHECK_SCENES "/tyre_on_road.yaml"),
                                   3892.4);
}

TEST(WheelLoads, WheelLoadIsUndefinedUnderASecondVerticalOrAFollowerForce) {
    const Model model = compile(parse_scene(trailing_arm, "scene.yaml"));
    const Wheel& wheel = model.wheels[0];
    const Point centre{wheel.body, wheel.centre_local},
        beside{wheel.body, wheel.centre_local + Eigen::Vector3d(0.1, 0, 0)};
    const auto unknown_under = [&](const LoadKind& other) {
        Model with = model;
        with.static_loads.push_back({"other", other});
        return compare::wheel_load(with, with.branches[0], compare::design_state(with), 0) ==
               compare::undefined;
    };
    EXPECT_TRUE(unknown_under(DeadForce{beside, Eigen::Vector3d::UnitZ()}));
    EXPECT_TRUE(unknown_under(FollowerForce{centre, Eigen::Vector3d::UnitX()}));
    EXPECT_FALSE(unknown_under(DeadForce{beside, Eigen::Vector3d::UnitY()}));
}

}  // namespace
}  // namespace elastocheck::reports
