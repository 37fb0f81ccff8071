// The references against Simbody. Its bushings turn by Cardan angles: where a scene has these, both have one model, and
// nothing but round-off is between them; where it has rotation vectors, what that law makes of the poses.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/design/fit.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"
#include "tests/engines/simbody/engine.hpp"
#include "tests/support/command.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::engines {
namespace {

using compare::Leg;
using support::contains, support::shell, support::text_of;
using Angles = Formulation::Angles;

Scene with(Angles angles, Scene scene) {
    for (auto& elastic : scene.elastics)
        if (auto* bushing = std::get_if<Bushing>(&elastic.kind))
            bushing->formulation.angles = angles;
    return compare::trim(scene).scene;
}

// Every point of a joint or element that sits on a body of the model, and the wheel centres.
std::vector<Point> points_of(Scene scene, const Model& model) {
    std::vector<Point> points;
    const auto take = [&](const Point& p) {
        if (p.body == ground) return;
        const std::string& name = scene.bodies[static_cast<std::size_t>(p.body)].name;
        const auto body = std::ranges::find(model.bodies, name, &Body::name);
        if (body != model.bodies.end())
            points.push_back({static_cast<BodyId>(body - model.bodies.begin()), p.s_local});
    };
    const auto place = overloaded{take,
                                  [&](const Marker& m) {
                                      take({m.body, m.s_local});
                                  },
                                  [](const Direction&) {}};
    for (auto& joint : scene.joints) each_member(joint.kind, place);
    for (auto& elastic : scene.elastics) each_member(elastic.kind, place);
    for (const Wheel& wheel : scene.wheels) take({wheel.body, wheel.centre_local});
    return points;
}

// The largest distance of a point between two paths of one way [mm]; NaN where either is not whole.
double distance(const std::vector<Point>& points, const EquilibriumPath& here,
                const EquilibriumPath& there) {
    if (here.outcome != Outcome::converged || there.outcome != Outcome::converged ||
        here.points.size() != there.points.size())
        return NAN;
    const auto position = [](const Equilibrium& state, const Point& p) -> Eigen::Vector3d {
        const Pose& pose = state.poses[static_cast<std::size_t>(p.body)];
        return pose.r + pose.p * p.s_local;
    };
    double worst = 0;
    for (std::size_t k = 0; k < here.points.size(); ++k)
        for (const Point& p : points) {
            const double distance =
                1e3 * (position(here.points[k], p) - position(there.points[k], p)).norm();
            if (!(distance <= worst)) worst = distance;
        }
    return worst;
}

EquilibriumPath by_simbody(const compare::BranchSide& way) {
    std::vector<double> values;
    for (int k = 0; k <= way.branch.steps; ++k)
        values.push_back(way.branch.to * k / way.branch.steps);
    return simbody(way.model, way.branch, values);
}

// The largest distance between Simbody and the legs, branch by branch.
std::map<std::string, double> distances(const Scene& scene, int steps,
                                        const std::vector<Leg>& legs) {
    const Model model = compile(scene);
    const auto points = points_of(scene, model);
    EXPECT_GE(points.size(), model.bodies.size());
    std::map<std::string, double> worst;
    for (const Branch& branch : model.branches)
        for (const auto& way : compare::sides_of(model, branch, steps)) {
            const EquilibriumPath found = by_simbody(way);
            for (const Leg leg : legs) {
                const double from_leg =
                    distance(points, found, compare::solve_branch(way, {.leg = leg}));
                double& largest = worst[branch.name];
                if (!(from_leg <= largest)) largest = from_leg;
            }
        }
    return worst;
}

constexpr double same = 1e-8;  // [mm] of one model: four digits above the round-off of either side
constexpr double known =
    1e-4;  // [mm] what Cardan angles may make of a suspension that is written with rotation vectors

// All scenes of supported elements in few steps. That the references agree is tested elsewhere.
TEST(Simbody, StatesEqualTheReferencesWithCardanAngleBushings) {
    int scenes_compared = 0, branches_compared = 0;
    double largest = 0;
    for (const auto& name : support::scene_names()) try {
            const Scene scene = with(Angles::cardan, support::scene(name));
            for (const auto& [branch, distance] : distances(scene, 4, {Leg::equilibrium})) {
                EXPECT_TRUE(distance <= same)
                    << name << ", " << branch << ": " << distance << " mm";
                largest = std::max(largest, distance);
                ++branches_compared;
            }
            ++scenes_compared;
        } catch (const NotRepresented&) {
        }
    EXPECT_GE(branches_compared, 80);
    fmt::print("{} scenes, {} branches: at most {:.1e} mm\n", scenes_compared, branches_compared,
               largest);
}

class Suspension : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Simbody, Suspension, testing::Values("mcpherson", "double_wishbone"),
                         [](const auto& scene) { return scene.param; });

TEST_P(Suspension, StatesOfSimbodyEqualBothReferencesWithCardanAngles) {
    const Scene scene = with(Angles::cardan, support::scene(GetParam()));
    double largest = 0;
    for (const auto& [branch, distance] : distances(scene, 8, {Leg::equilibrium, Leg::energy})) {
        EXPECT_TRUE(distance <= same) << branch << ": " << distance << " mm";
        largest = std::max(largest, distance);
    }
    fmt::print("{}, one law: at most {:.1e} mm\n", GetParam(), largest);
}

TEST_P(Suspension, StatesWithRotationVectorsDifferByTheKnownDifferenceOfTheLaws) {
    const Scene scene = with(Angles::rotation_vector, support::scene(GetParam()));
    double largest = 0;
    for (const auto& [branch, distance] : distances(scene, 8, {Leg::equilibrium, Leg::energy})) {
        EXPECT_TRUE(distance <= known) << branch << ": " << distance << " mm";
        largest = std::max(largest, distance);
    }
    EXPECT_GT(largest, 100 * same) << "the laws are no longer different";
    fmt::print("{}, as written: at most {:.1e} mm\n", GetParam(), largest);
}

TEST(Simbody, TieRodLongerByAMicrometreIsDetected) {
    const Model model = compile(support::scene("mcpherson"));
    auto way = compare::sides_of(model, model.branches[0], 2).front();
    const auto points = points_of(support::scene("mcpherson"), model);
    const EquilibriumPath reference = compare::solve_branch(way, {.leg = Leg::equilibrium});
    EXPECT_TRUE(distance(points, by_simbody(way), reference) <= known);
    for (auto& constraint : way.model.constraints)
        if (auto* rod = std::get_if<DistanceBetween>(&constraint.kind)) rod->length += 1e-6;
    EXPECT_GT(distance(points, by_simbody(way), reference), known);
}

TEST(Simbody, LoadOnAnUnresistedMotionDoesNotConverge) {
    Scene scene = support::scene("two_spring_arch");
    scene.elastics.clear();
    const Model model = compile(scene);
    const EquilibriumPath path = by_simbody(compare::sides_of(model, model.branches[0], 2).front());
    EXPECT_EQ(path.outcome, Outcome::iteration_limit);
    EXPECT_EQ(path.points.size(), 1u);  // without load it stands
    EXPECT_TRUE(contains(path.detail, "on the way to -")) << path.detail;
    EXPECT_TRUE(contains(path.detail, ": iteration limit")) << path.detail;
}

// The constraint of a driven angle is a sine, which is also met half a turn further, where long steps would converge.
TEST(Simbody, DrivenCrankTurnsByItsAngleInAnyNumberOfSteps) {
    const Scene scene = support::scene("slider_crank");
    const Model model = compile(scene);
    for (const int steps : {1, 2, 3, 4})
        for (const auto& [branch, distance] : distances(scene, steps, {Leg::equilibrium}))
            EXPECT_TRUE(distance <= same)
                << branch << " in " << steps << " steps: " << distance << " mm";
}

// What it refuses, by name.
std::string refused(const Scene& scene) {
    const Model model = compile(scene);
    try {
        by_simbody(compare::sides_of(model, model.branches[0], 1).front());
    } catch (const NotRepresented& error) {
        return error.what();
    }
    return "";
}
Bushing& bushing(Scene& scene) {
    for (auto& elastic : scene.elastics)
        if (auto* found = std::get_if<Bushing>(&elastic.kind)) return *found;
    throw std::logic_error("no bushing");
}

TEST(Simbody, UnsupportedElementIsRejectedByName) {
    const Scene scene = support::scene("single_bushing");
    const std::string name = "bushing '" + scene.elastics[0].name + "': Simbody's has no ";
    Scene other = scene;
    bushing(other).formulation.frame = Formulation::Frame::middle;
    EXPECT_EQ(refused(other), name + "frame but that of its first body");
    other = scene;
    bushing(other).formulation.angles = Angles::projected;
    EXPECT_EQ(refused(other), name + "projected angles");
    other = scene;
    bushing(other).formulation.offset_moment = false;
    EXPECT_EQ(refused(other), name + "forces but those of its energy");
    other = scene;
    bushing(other).preload[0] = 1;
    EXPECT_EQ(refused(other), name + "preload");
    other = scene;
    bushing(other).undeformed[0] = 1e-3;
    EXPECT_EQ(refused(other), name + "preload");
    other = scene;
    Matrix6 K = Matrix6::Identity();
    K(0, 1) = K(1, 0) = 0.5;
    bushing(other).law = LinearStiffness{K};
    EXPECT_EQ(refused(other), name + "rate between two axes");
    other = scene;
    PerAxis law;
    law.axis.fill(LinearRate{1});
    law.axis[2] = Curve{{0}, {{0, 1, 0, 0}, {0, 2, 0, 0}}};
    bushing(other).law = law;
    EXPECT_EQ(refused(other), name + "curves");

    EXPECT_EQ(refused(support::scene("follower")),
              "load 'push': Simbody's keep their direction in ground axes");

    Scene ends = support::scene("two_spring_arch");
    auto& spring = std::get<AxialSpring>(ends.elastics[0].kind);
    spring.law = Curve{{0}, {{0, 1, 0, 0}, {0, 1, 0, 0}}, false};
    EXPECT_EQ(refused(ends), "spring '" + ends.elastics[0].name +
                                 "': its curve has ends, and a load step may lead beyond them");
}

TEST(Simbody, BushingByPerAxisRatesMovesAsByItsStiffnessMatrix) {
    Scene scene = support::scene("single_bushing");
    const auto rates = std::get<LinearStiffness>(bushing(scene).law).K.diagonal().eval();
    const auto at_end = [](const Scene& told) {
        const Model model = compile(told);
        return by_simbody(compare::sides_of(model, model.branches[0], 1).front())
            .points.back()
            .poses[0]
            .r;
    };
    const Eigen::Vector3d as_matrix = at_end(scene);
    PerAxis law;
    for (int k = 0; k < 6; ++k) law.axis[static_cast<std::size_t>(k)] = LinearRate{rates[k]};
    bushing(scene).law = law;
    EXPECT_EQ(at_end(scene), as_matrix);
}

// ---- The program

const std::string candidate = SIMBODY_CANDIDATE;
const std::string scenes = ELASTOCHECK_SCENES;

TEST(SimbodyCandidate, WritesEveryBodyAtEveryStepOfTheBranches) {
    const support::Folder folder;
    const std::string file = (folder.path / "states.jsonl").string();
    const auto said = shell(candidate + " " + scenes + "/chrono_mcpherson_travel.yaml 4 " + file +
                            " travel braking");
    ASSERT_EQ(said.code, 0) << said.err;
    const Model model = compile(compare::trim(support::scene("chrono_mcpherson_travel")).scene);
    std::istringstream lines(text_of(file));
    std::map<std::string, std::vector<double>> loads;
    for (std::string line; std::getline(lines, line);) {
        const auto state = nlohmann::json::parse(line);
        loads[state.at("branch")].push_back(state.at("load"));
        EXPECT_EQ(state.at("bodies").size(), model.bodies.size());
        for (const Body& body : model.bodies) {
            const auto& told = state.at("bodies").at(body.name);
            EXPECT_EQ(told.at("position").size(), 3u);
            const auto p = told.at("orientation").get<std::vector<double>>();
            ASSERT_EQ(p.size(), 4u);
            EXPECT_NEAR(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3], 1, 1e-12);
        }
    }
    ASSERT_EQ(loads.size(), 2u);
    for (const auto& [name, told] : loads) {
        const auto branch = std::ranges::find(model.branches, name, &Branch::name);
        const auto asked = compare::requested_parameters(compare::sides_of(model, *branch, 4), 1);
        EXPECT_EQ(told, asked) << name;
    }
}

// Curves of another engine on a scene with a hardpoint 2 mm from its place and a coil of another
// rate. The known difference of the bushings' laws is a thousandth of the change to be found.
TEST(SimbodyCandidate, FitToItsCurvesFindsTheChangedNumbers) {
    const std::string file = scenes + "/mcpherson.yaml";
    const std::vector<std::string> paths{"points.tie_rod_inner.z", "springs.K1_coil.rate"};
    const auto settings = [&](const Eigen::VectorXd& p) {
        return std::vector<Setting>{setting(paths[0], p[0]), setting(paths[1], p[1])};
    };
    std::vector<Number> numbers;
    for (const auto& path : paths)
        for (const Number& number : support::scene("mcpherson").numbers)
            if (number.path == path) numbers.push_back(number);
    ASSERT_EQ(numbers.size(), 2u);
    const Eigen::Vector2d start(numbers[0].value, numbers[1].value);
    const Eigen::VectorXd truth = start + Eigen::Vector2d(2e-3, 1000);

    const support::Folder folder;
    const std::string changed =
        folder.write("changed.yaml", rewrite_scene(text_of(file), file, settings(truth)));
    const std::string states = (folder.path / "states.jsonl").string();
    const auto said = shell(candidate + " " + changed + " 6 " + states);
    ASSERT_EQ(said.code, 0) << said.err;
    const Model model = compile(read_scene(changed));
    const auto channels = compare::channels(model);
    const std::vector<std::string> outputs{"toe", "camber", "wheel_centre_y", "wheel_centre_z"};
    std::vector<compare::Figure> figures;
    compare::Measured measured{
        .value = {},
        .column = {},
        .step = Eigen::Vector2d(compare::step_of(numbers[0]), compare::step_of(numbers[1]))};
    std::vector<double> values;
    std::istringstream lines(text_of(states));
    for (std::string line; std::getline(lines, line);) {
        const auto told = nlohmann::json::parse(line);
        Equilibrium state;
        state.load = told.at("load");
        for (const Body& body : model.bodies) {
            const auto& pose = told.at("bodies").at(body.name);
            const auto r = pose.at("position").get<std::vector<double>>(),
                       p = pose.at("orientation").get<std::vector<double>>();
            state.poses.push_back({{r[0], r[1], r[2]}, Eigen::Quaterniond(p[0], p[1], p[2], p[3])});
        }
        for (std::size_t c = 0; c < outputs.size(); ++c) {
            const auto& channel =
                channels[static_cast<std::size_t>(compare::find_channel(channels, outputs[c]))];
            figures.push_back(
                {.name = outputs[c], .branch = told.at("branch"), .station = state.load});
            measured.column.push_back(static_cast<int>(c));
            values.push_back(compare::evaluate(model, std::span(&channel, 1), state).front());
        }
    }
    measured.value =
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    const double any = std::numeric_limits<double>::infinity();
    const compare::Varied varied{
        {start, Eigen::VectorXd::Constant(2, -any), Eigen::VectorXd::Constant(2, any)},
        numbers,
        [&](const Eigen::VectorXd& p) { return read_scene(file, settings(p)); }};
    const auto found = compare::fit(compare::solved_figures(varied, figures), measured, varied);
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR(found.p[0], truth[0], 1e-6);
    EXPECT_NEAR(found.p[1], truth[1], 1e-3 * 1000);
    for (const auto& column : found.columns) EXPECT_LE(column.noise, known);
    fmt::print("a fit to the candidate's curves: {:.1e} mm, {:.1e} % of the rate from the truth\n",
               1e3 * std::abs(found.p[0] - truth[0]), 100 * std::abs(found.p[1] / truth[1] - 1));
}

TEST(SimbodyCandidate, BadInputIsReportedAndWritesNothing) {
    const support::Folder folder;
    const std::string file = (folder.path / "states.jsonl").string(),
                      mcpherson = scenes + "/mcpherson.yaml";
    const auto fails = [&](const std::string& arguments, int code, const std::string& why) {
        const auto said = shell(candidate + " " + arguments);
        EXPECT_EQ(said.code, code) << arguments << ": " << said.err;
        EXPECT_TRUE(contains(said.err, why)) << said.err;
        EXPECT_FALSE(std::filesystem::exists(file)) << arguments;
    };
    fails(mcpherson + " 4", 2, "usage: simbody_candidate SCENE STEPS OUTPUT [BRANCH...]");
    for (const std::string steps : {"0", "-3", "4x", "x"})
        fails(mcpherson + " " + steps + " " + file, 2,
              "STEPS: expected a positive integer, found '" + steps + "'");
    fails(mcpherson + " 4 " + file + " bounce", 2, "no branch 'bounce'");
    fails((folder.path / "none.yaml").string() + " 4 " + file, 2, "none.yaml");
    fails(mcpherson + " 1 " + (folder.path / "none" / "states.jsonl").string() + " jounce", 2,
          "cannot write");
    fails(scenes + "/follower.yaml 4 " + file, 2, "load 'push'");
}

}  // namespace
}  // namespace elastocheck::engines
