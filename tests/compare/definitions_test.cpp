// Other definitions of figures: values by hand, and a column by another definition is recognised.
#include "compare/definitions/definitions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/characteristics.hpp"
#include "compare/comparison/compare.hpp"
#include "compare/comparison/legs.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;
constexpr double degrees = 180 / std::numbers::pi;

// A wheel on ground axes, turned by hand: the carrier is joined to nothing.
struct ByHand {
    Model model;
    Equilibrium state;
    std::vector<Channel> defined;

    // Steering axis from (0.02, 0.55, -0.1) to (-0.03, 0.50, 0.1), camber drawn `camber`.
    explicit ByHand(double camber) {
        Wheel wheel;
        wheel.body = 0;
        wheel.spin_axis_local = {0, std::cos(camber), -std::sin(camber)};
        wheel.contact_local = {0, 0, -0.3};
        wheel.steering_axis = {{0, {0.02, -0.10, -0.1}}, {0, {-0.03, -0.15, 0.1}}};
        model.bodies.push_back({.name = "wheel", .design = {{0, 0.65, 0}, {1, 0, 0, 0}}});
        model.wheels.push_back(wheel);
        state = design_state(model);
        defined = definition_channels(model);
    }
    void turn(const Vector3d& axis, double angle, const Vector3d& shift = Vector3d::Zero()) {
        state.poses[0].p = Eigen::AngleAxisd(angle, axis.normalized()) * state.poses[0].p;
        state.poses[0].r += shift;
    }
    double operator()(const std::string& name) const {
        const auto all = name.find('@') == name.npos ? channels(model) : defined;
        const int c = find_channel(all, name);
        if (c < 0) return NAN;
        return evaluate(model, std::span(&all[static_cast<std::size_t>(c)], 1), state).front();
    }
};

// In the design position of a wheel without toe: the steering axis leans by (-0.05, -0.05) over 0.2.
TEST(Definitions, OfTheSteeringAxisAreThoseOfALineByHand) {
    const ByHand at(0.02);
    // at the road, 0.3 below the centre: 0.2 below the lower end
    EXPECT_NEAR(at("mechanical_trail@ground_axes"), 1e3 * (0.02 + 0.25 * 0.2), 1e-9);
    EXPECT_NEAR(at("scrub_radius@ground_axes"), 1e3 * (0.10 - 0.25 * 0.2), 1e-9);
    // at the centre: half way
    EXPECT_NEAR(at("mechanical_trail@centre"), 1e3 * -0.005, 1e-9);
    EXPECT_NEAR(at("scrub_radius@centre"), 1e3 * 0.125, 1e-9);
    EXPECT_NEAR(at("mechanical_trail@across_axis"),
                at("mechanical_trail") * std::cos(std::atan(0.25)), 1e-9);
    EXPECT_NEAR(at("caster@wheel_plane"), at("caster"), 1e-9) << "drawn straight ahead";
}

// Steered by 20 deg about the vertical: the wheel's plane turns with the axis, so that the angles
// seen across and along the wheel stay, while those seen along the ground axes change.
TEST(Definitions, SeenInTheWheelsPlaneDoNotChangeBySteeringAboutTheVertical) {
    ByHand at(0);
    const double caster = at("caster"), kingpin = at("kingpin_inclination");
    at.turn(Vector3d::UnitZ(), 20 / degrees);
    EXPECT_NEAR(at("caster@wheel_plane"), caster, 1e-9);
    EXPECT_NEAR(at("kingpin_inclination@wheel_plane"), kingpin, 1e-9);
    EXPECT_GT(std::abs(at("caster") - caster), 1);
    EXPECT_NEAR(at("toe@lateral"), at("toe"), 1e-9) << "no camber: the axis is the spin axis";
}

TEST(Definitions, OfCamberByHand) {
    ByHand at(-0.05);  // top inwards
    EXPECT_NEAR(at("camber@kingpin"), at("camber"), 1e-12);
    at.turn(Vector3d::UnitX(), 0.03, {0.001, -0.004, 0.02});
    // about x all three follow the turn
    EXPECT_NEAR(at("camber"), degrees * (-0.05 - 0.03), 1e-9);
    EXPECT_NEAR(at("camber@lateral"), at("camber"), 1e-9);
    EXPECT_NEAR(at("camber@front_view"), at("camber"), 1e-9);
    EXPECT_NEAR(at("travel@patch"), 1e3 * (0.02 + 0.3 * (1 - std::cos(0.03))), 1e-9);
    EXPECT_NEAR(at("track_change@centre"), -4, 1e-9);
    // the lowest point of the wheel's circle: radius 0.3 in a plane inclined by 0.08
    EXPECT_NEAR(at("track_change@lowest"), 1e3 * (-0.004 + 0.3 * (std::sin(0.08) - std::sin(0.05))),
                1e-9);
    EXPECT_NEAR(at("travel@lowest"), 1e3 * (0.02 - 0.3 * (std::cos(0.08) - std::cos(0.05))), 1e-9);
    // steered, the front view sees e_z / e_y
    at.turn(Vector3d::UnitZ(), 0.5);
    EXPECT_NEAR(std::tan(at("camber@front_view") / degrees),
                std::tan(at("camber") / degrees) / std::cos(0.5), 1e-9);
}

// Arms that are parallel and horizontal in front view: their planes meet at infinity, at the height
// of no inclination, so that the roll centre lies on the road.
TEST(Definitions, RollCentreByPlanesOfHorizontalParallelArmsIsOnTheRoad) {
    const Scene scene = parse_scene(R"(
elastocheck: 1
name: parallel arms
units: {length: m, angle: deg, force: N}
points: {lf: [0.2, 0.3, 0.2], lr: [-0.2, 0.3, 0.2], lo: [0, 0.6, 0.2], uf: [0.2, 0.35, 0.4],
         ur: [-0.2, 0.35, 0.4], uo: [0, 0.58, 0.4], to: [-0.1, 0.6, 0.3], ti: [-0.1, 0.3, 0.3],
         c: [0, 0.7, 0.3], p: [0, 0.7, 0]}
bodies: {lower: {origin: lo}, upper: {origin: uo}, wheel: {origin: c}}
joints:
  lower: {type: revolute, bodies: [lower, ground], at: lf, axis: [lr, lf]}
  upper: {type: revolute, bodies: [upper, ground], at: uf, axis: [ur, uf]}
  lb: {type: spherical, bodies: [lower, wheel], at: lo}
  ub: {type: spherical, bodies: [upper, wheel], at: uo}
  rod: {type: distance, bodies: [wheel, ground], from: to, to: ti}
branches: {travel: {drive: travel, from: -0.05, to: 0.05, steps: 4}}
wheel: {body: wheel, centre: c, contact_patch: p, spin_axis: y, side: left}
)",
                                    "parallel");
    const Model model = compile(scene);
    const auto defined = definition_channels(model);
    const int c = find_channel(defined, "roll_centre_height@planes");
    ASSERT_GE(c, 0);
    EXPECT_NEAR(
        evaluate(model, std::span(&defined[static_cast<std::size_t>(c)], 1), design_state(model))
            .front(),
        0, 1e-9);
}

// ---- Judgement.

struct Judged {
    Model model;
    Comparison comparison;
    std::vector<Channel> defined;
    // of a branch by the equilibrium leg: parameter in its unit, outputs of the comparison, then of
    // `defined`
    std::string branch;
    std::vector<double> a;
    std::vector<std::vector<double>> values;

    explicit Judged(const std::string& name, const std::string& of_branch) : branch(of_branch) {
        model = compile(trim(support::scene(name)).scene);
        std::erase_if(model.branches, [&](const Branch& b) { return b.name != branch; });
        Options options;
        options.prove = false;
        comparison = compare(model, options);
        defined = definition_channels(model);
        auto all = comparison.channels;
        all.insert(all.end(), defined.begin(), defined.end());
        const Branch& of = model.branches.front();
        const PathCurve path =
            walk(model, all, of, sides_of(model, of, 12), {.leg = Leg::equilibrium});
        a = path.curve.a;
        for (std::size_t c = 0; c < all.size(); ++c) values.push_back(path.curve.channel(c));
    }
    CandidateJudgement judge(std::size_t channel, const std::vector<double>& column) const {
        Candidate candidate;
        candidate.points.a = a;
        candidate.points.branch.assign(a.size(), branch);
        candidate.points.columns.push_back({.channel = channel, .values = column});
        return judge_candidate(model, comparison, candidate, default_tolerance);
    }
};

std::string without_wheel(const std::string& output) {
    const auto dot = output.find('.');
    return dot == output.npos ? output : output.substr(dot + 1);
}

// Each definition in turn stands in a column of its figure, as it is and with a sign, a unit or an
// offset, and is named among the explanations.
TEST(Definitions, InAColumnAreRecognisedWithSignUnitAndOffset) {
    std::set<std::string> recognised;
    for (const auto& [scene, branch] : {std::pair{"double_wishbone_rigid", "steering"},
                                        {"double_wishbone_rigid", "travel"},
                                        {"front_axle", "opposite"}}) {
        const Judged at(scene, branch);
        for (std::size_t c = 0; c < at.comparison.channels.size(); ++c)
            for (const Channel& other :
                 definitions_of(at.defined, at.comparison.channels[c].name)) {
                if (recognised.contains(without_wheel(other.name))) continue;
                const auto d = static_cast<std::size_t>(find_channel(at.defined, other.name));
                const auto& column = at.values[at.comparison.channels.size() + d];
                // a difference that the judgement sees, beyond an offset or a factor
                const CandidateJudgement plain = at.judge(c, column);
                if (plain.verdict == Grade::pass || plain.explanations.empty() ||
                    plain.explanations.front().kind != Explanation::Kind::definition)
                    continue;
                recognised.insert(without_wheel(other.name));
                struct Change {
                    double factor, offset;
                };
                for (const Change by : {Change{1, 0}, {-1, 0}, {60, 0}, {1, 7.5}}) {
                    std::vector<double> changed = column;
                    for (double& v : changed) v = by.factor * v + by.offset;
                    const auto judged = at.judge(c, changed);
                    EXPECT_EQ(judged.verdict, Grade::fail) << other.name;
                    ASSERT_FALSE(judged.explanations.empty()) << other.name << " " << by.factor;
                    const auto& e = judged.explanations.front();
                    EXPECT_TRUE(e.kind == Explanation::Kind::definition &&
                                std::ranges::any_of(e.definitions,
                                                    [&](const std::string& name) {
                                                        return name.starts_with(other.name);
                                                    }))
                        << other.name << " · " << by.factor << " + " << by.offset << ": "
                        << judged.hints.front();
                }
            }
    }
    for (const char* name :
         {"camber@kingpin", "camber@front_view", "caster@wheel_plane", "mechanical_trail@centre",
          "scrub_radius@ground_axes", "track_change@lowest", "roll_centre_height@planes"})
        EXPECT_TRUE(recognised.contains(name)) << name;
}

// Of 1000 smooth wrong columns at most 1 % are explained by a definition.
TEST(Definitions, DoNotExplainWrongColumns) {
    const Judged at("double_wishbone_rigid", "steering");
    std::mt19937 random(7);
    std::uniform_real_distribution<double> in(-1, 1);
    int explained = 0, tried = 0;
    while (tried < 1000)
        for (std::size_t c = 0; c < at.comparison.channels.size() && tried < 1000; ++c) {
            const auto others = definitions_of(at.defined, at.comparison.channels[c].name);
            if (others.empty()) continue;
            Beside b;
            b.reference = at.values[c];
            const auto [low, high] = std::ranges::minmax(b.reference);
            double k0 = 0, k[4];
            for (double& x : k) x = in(random);
            k0 = in(random);
            for (std::size_t p = 0; p < at.a.size(); ++p) {
                const double x = at.a[p] / std::abs(at.a.back());
                const double off =
                    (high - low) * (k[0] * x + k[1] * x * x + k[2] * std::sin(3 * x) + k[3] * 0.3);
                b.candidate.push_back(k0 > 0 ? b.reference[p] + off : off);
                b.begin.push_back(b.reference[at.a.size() / 2]);
                b.at.push_back(at.a[p]);
                b.branch.push_back(at.branch);
            }
            b.tolerance = 0.01;
            for (const Channel& other : others) {
                const auto d = static_cast<std::size_t>(find_channel(at.defined, other.name));
                b.definitions.push_back(at.values[at.comparison.channels.size() + d]);
                b.definition_names.push_back(other.name);
            }
            const auto found = explain(b);
            explained += found && found->kind == Explanation::Kind::definition;
            ++tried;
        }
    EXPECT_LE(explained, 10) << "of " << tried;
}

}  // namespace
}  // namespace elastocheck::compare
