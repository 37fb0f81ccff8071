// Built-in suspension scenes of models/scenes/: expected behaviour of a car,
// and invariance transforms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

Scene trimmed(const std::string& name, const std::vector<Setting>& settings = {}) {
    const auto done = trim(
        read_scene(std::string(ELASTOCHECK_SCENES) + "/" + name + ".yaml", std::span(settings)));
    EXPECT_TRUE(!done.record || done.record->reached()) << name << ": " << done.record->detail;
    return done.scene;
}

// One leg along a branch, its outputs by name.
struct Walk {
    std::vector<Channel> channels;
    Curve curve;

    std::vector<double> operator[](std::string_view channel) const {
        const int c = find_channel(channels, channel);
        if (c < 0) throw std::logic_error("no channel " + std::string(channel));
        return curve.channel(static_cast<std::size_t>(c));
    }
};

Walk solve_branch(const Model& model, const std::string& branch, Leg leg = Leg::equilibrium,
                  int steps = 8) {
    const auto found = std::ranges::find(model.branches, branch, &Branch::name);
    if (found == model.branches.end()) throw std::logic_error("no branch " + branch);
    recursive::Options how{.steps = steps};
    how.method = recursive::find_method("series").value();
    LegRun done = run(model, *found, leg, how);
    EXPECT_EQ(done.outcome, Outcome::converged) << branch << ": " << done.detail;
    return {channels(model), std::move(done.curve)};
}

double distance(const std::vector<double>& a, const std::vector<double>& b, double sign = 1) {
    if (a.size() != b.size() || a.empty()) return std::numeric_limits<double>::infinity();
    double worst = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        if (!(std::abs(a[k] - sign * b[k]) <= worst)) worst = std::abs(a[k] - sign * b[k]);
    return worst;
}
std::vector<double> backwards(std::vector<double> x) {
    std::ranges::reverse(x);
    return x;
}

// ---- Every family, every leg.

class SuspensionScenes : public testing::TestWithParam<std::string> {};

TEST_P(SuspensionScenes, SeriesAgreesWithTheReferencesOnEveryBranch) {
    Options options;
    options.recursion.method = recursive::find_method("series").value();
    options.recursion.steps = 10;
    const auto all = compare(compile(trimmed(GetParam())), options);
    EXPECT_TRUE(all.conclusive());
    for (const auto& branch : all.branches) {
        for (const auto& why : branch.inconclusive.texts())
            ADD_FAILURE() << branch.branch << ": " << why;
        ASSERT_EQ(branch.deviation.equal_parameter.channels.size(), all.channels.size())
            << branch.branch;
        constexpr double series = 1e-9;
        for (std::size_t c = 0; c < all.channels.size(); ++c)
            if (all.channels[c].main && all.channels[c].kinematic()) {
                EXPECT_LE(branch.uncertainty.equal_parameter.channels[c].max, 1e-6)
                    << branch.branch << " " << all.channels[c].name;
                EXPECT_LE(branch.deviation.equal_parameter.channels[c].max, series)
                    << branch.branch << " " << all.channels[c].name;
            }
    }
}

// No idle modes, no redundant joints, and every branch starts at the trim conditions.
TEST_P(SuspensionScenes, TrimReachesTheDesignHeightWithoutIdleModesOrRedundantJoints) {
    const Scene scene = trimmed(GetParam());
    const Model model = compile(scene);
    const auto found = recursive::diagnose(model);
    EXPECT_TRUE(found.redundant_sets.empty());
    EXPECT_TRUE(found.idle.empty());
    const std::string vertical = "vertical";
    const Walk loaded = solve_branch(model, vertical, Leg::equilibrium, 2);
    for (const auto& wheel : scene.wheels) {
        const std::string which = wheel.name.empty() ? "" : wheel.name + ".";
        const auto travel = loaded[which + "wheel_centre_z"];
        const double design =
            1e3 * (scene.bodies[static_cast<std::size_t>(wheel.body)].design.r +
                   scene.bodies[static_cast<std::size_t>(wheel.body)].design.p * wheel.centre_local)
                      .z();
        EXPECT_NEAR(travel[1], design, 1e-6) << which;
    }
}

// Over the travel of a car toe and camber change by a few degrees; the wheel rate is 15 to 40 N/mm
// at the design height and higher at the stops.
TEST_P(SuspensionScenes, ToeCamberAndWheelRateAreInTheRangeOfCars) {
    const Scene scene = trimmed(GetParam());
    const Model model = compile(scene);
    const std::string along = GetParam() == "front_axle" ? "parallel" : "travel";
    const Walk moved = solve_branch(model, along, Leg::equilibrium, 32);
    for (const auto& wheel : scene.wheels) {
        const std::string which = wheel.name.empty() ? "" : wheel.name + ".";
        const auto z = moved[which + "wheel_centre_z"], force = moved[which + "jack.drive_force"];
        const auto rate = [&](std::size_t k) {
            return (force[k + 1] - force[k]) / (z[k + 1] - z[k]);
        };
        const std::size_t last = z.size() - 1, design = last / 2;
        EXPECT_GE(z[last] - z[design], 60);
        EXPECT_GE(z[design] - z[0], 60);
        const double middle = (rate(design - 1) + rate(design)) / 2;
        EXPECT_TRUE(middle >= 15 && middle <= 40) << which << middle << " N/mm";
        EXPECT_GT(rate(last - 1), 1.3 * middle) << which << "no stop at the end of jounce";
        for (const char* angle : {"toe", "camber"})
            for (const double x : moved[which + angle])
                EXPECT_LE(std::abs(x), std::string_view(angle) == "toe" ? 2 : 4) << which << angle;
    }
}

// A reference at three points of every branch.
class Told {
  public:
    explicit Told(Scene scene, Leg leg = Leg::equilibrium) {
        for (auto& branch : scene.branches) branch.steps = 2;
        model_ = compile(scene);
        list_ = channels(model_);
        for (const auto& branch : model_.branches) {
            runs_.push_back(run(model_, branch, leg));
            EXPECT_EQ(runs_.back().outcome, Outcome::converged)
                << branch.name << ": " << runs_.back().detail;
        }
    }
    const std::vector<Channel>& list() const { return list_; }
    const std::vector<LegRun>& runs() const { return runs_; }

    // By name on one branch at one point; c and the next two as a vector.
    std::size_t place(const std::string& name) const {
        return static_cast<std::size_t>(find_channel(list_, name));
    }
    Eigen::Vector3d vector(std::size_t branch, std::size_t point, std::size_t c) const {
        return Eigen::Vector3d(&runs_[branch].curve.values.at(point).at(c));
    }

  private:
    Model model_;
    std::vector<Channel> list_;
    std::vector<LegRun> runs_;
};

// [mm, deg] round-off at 15 N/mm; [N, N·m] the same for reactions of some 10 kN, with bushings of
// 1e7 N/m. The cotangents of the Ackermann fraction magnify an angle about a thousand times.
double bound(const Channel& channel) {
    return channel.unit == Unit::percent ? 1e-4 : channel.kinematic() ? 1e-8 : 1e-5;
}

// `limit` times the bound; the first end of a link that became a distance depends on the order of
// its joints.
void expect_same(const Told& drawn, const Told& told, double limit, const char* how) {
    ASSERT_EQ(told.list().size(), drawn.list().size());
    for (std::size_t c = 0; c < drawn.list().size(); ++c) {
        const Channel& channel = drawn.list()[c];
        const std::size_t other = told.place(channel.name);
        const bool is_link = channel.name.starts_with("drop_link");
        double worst = 0;
        for (std::size_t b = 0; b < drawn.runs().size(); ++b)
            for (std::size_t p = 0; p < drawn.runs()[b].curve.values.size(); ++p) {
                const double x = drawn.runs()[b].curve.values[p][c],
                             y = told.runs()[b].curve.values.at(p).at(other);
                if (channel.may_be_undefined() && x == undefined && y == undefined) continue;
                const double off = is_link ? std::abs(std::abs(x) - std::abs(y)) : std::abs(x - y);
                if (!(off <= worst)) worst = off;
            }
        EXPECT_LE(worst, limit * bound(channel)) << how << ": " << channel.name;
    }
}

// Positions and reactions are vectors and are rotated back.
void expect_same_turned(const Told& drawn, const Told& moved, const Eigen::Quaterniond& R,
                        const Eigen::Vector3d& t, double limit) {
    for (std::size_t c = 0; c + 2 < drawn.list().size(); ++c) {
        const Channel& channel = drawn.list()[c];
        if (!channel.name.ends_with("_x")) continue;
        double worst = 0;
        for (std::size_t b = 0; b < drawn.runs().size(); ++b)
            for (std::size_t p = 0; p < drawn.runs()[b].curve.values.size(); ++p) {
                const Eigen::Vector3d there =
                    moved.vector(b, p, c) - (channel.kinematic() ? 1e3 : 0) * t;
                const double off = (R.conjugate() * there - drawn.vector(b, p, c)).norm();
                if (!(off <= worst)) worst = off;
            }
        EXPECT_LE(worst, limit * bound(channel)) << "moved: " << channel.name;
    }
}

TEST_P(SuspensionScenes, ResultsDoNotDependOnGroundFrameOrderOrUnits) {
    const Scene scene = trimmed(GetParam());
    const Eigen::Quaterniond R(Eigen::AngleAxisd(2, Eigen::Vector3d(1, -2, 0.5).normalized()));
    const Eigen::Vector3d t(3, -2, 1);
    const Told drawn(scene);
    expect_same(drawn, Told(support::reversed(scene)), 1, "reversed");
    expect_same_turned(drawn, Told(support::moved(scene, R, t)), R, t, 1);
    const auto in_mm = trim(support::in_millimetres_and_kilonewtons(GetParam()));
    ASSERT_TRUE(in_mm.record && in_mm.record->reached());
    expect_same(drawn, Told(in_mm.scene), 1, "in mm and kN");

    // The energy leg, on the first two branches. Its reactions are as accurate as the imbalance of
    // its positions.
    const double known = 1e2;
    Scene some = scene;
    some.branches.resize(2);
    const Told energy(some, Leg::energy);
    expect_same(energy, Told(support::reversed(some), Leg::energy), known, "energy, reversed");
    expect_same_turned(energy, Told(support::moved(some, R, t), Leg::energy), R, t, known);
}

INSTANTIATE_TEST_SUITE_P(Sample, SuspensionScenes, testing::Values("double_wishbone", "front_axle"),
                         [](const auto& family) { return family.param; });
INSTANTIATE_TEST_SUITE_P(Nightly, SuspensionScenes,
                         testing::ValuesIn(support::trimmed_scene_names()),
                         [](const auto& family) { return family.param; });

// ---- Both sides of an axle.

struct Sides {
    const char* scene;
    // branches with equal, and with mirrored motion of both sides
    std::vector<const char*> equal, opposite;
};
void PrintTo(const Sides& sides, std::ostream* out) { *out << sides.scene; }

class SymmetricAxles : public testing::TestWithParam<Sides> {};

TEST_P(SymmetricAxles, SymmetricLoadsGiveSymmetricMotionAndOppositeLoadsAntisymmetricMotion) {
    const Model model = compile(trimmed(GetParam().scene));
    for (const Leg leg : {Leg::recursive, Leg::equilibrium, Leg::energy}) {
        const double bound = leg == Leg::energy ? 1e-6 : 1e-8;  // [mm, deg]
        const auto expect = [&](const char* branch, bool opposite) {
            const Walk both = solve_branch(model, branch, leg, 4);
            for (const char* what :
                 {"toe", "camber", "wheel_centre_x", "wheel_centre_y", "wheel_centre_z"}) {
                const auto left = both[std::string("left.") + what],
                           right = both[std::string("right.") + what];
                const double sign = std::string_view(what).ends_with("_y") ? -1 : 1;
                EXPECT_LE(distance(left, opposite ? backwards(right) : right, sign), bound)
                    << name(leg) << " " << branch << " " << what;
            }
        };
        for (const char* branch : GetParam().equal) expect(branch, false);
        for (const char* branch : GetParam().opposite) expect(branch, true);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SymmetricAxles,
                         testing::Values(Sides{"front_axle",
                                               {"parallel", "vertical", "braking", "traction"},
                                               {"opposite", "roll", "steering", "lateral",
                                                "aligning"}},
                                         Sides{"twist_beam",
                                               {"travel", "vertical", "braking", "traction"},
                                               {"opposite", "roll", "lateral", "aligning"}},
                                         Sides{"solid_axle_leaf",
                                               {"travel", "vertical", "braking", "traction"},
                                               {"opposite", "roll", "lateral", "aligning"}}),
                         [](const auto& sides) { return std::string(sides.param.scene); });

// ---- Pure kinematics.

// and with rubber
class RigidSuspensions : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(RigidSuspensions, PrescribedMotionDoesNotDependOnForcesOrRates) {
    const auto [rigid, rubber] = GetParam();
    const Walk once = solve_branch(compile(trimmed(rigid)), "travel");
    for (const char* rate : {"60e3", "120e3", "500e3"}) {
        const Model model = compile(trimmed(rigid, {{"springs.coil.rate", rate}}));
        for (const char* branch : {"travel", "cornering", "braking", "traction"}) {
            const Walk again = solve_branch(model, branch);
            for (const auto& channel : once.channels)
                if (channel.kinematic()) {
                    EXPECT_LE(distance(once[channel.name], again[channel.name]), 1e-9)
                        << rate << " " << branch << " " << channel.name;
                }
        }
    }
}

// Rubber of s times the rate deforms by 1/s: pure kinematics is the limit.
TEST_P(RigidSuspensions, MotionIsTheLimitOfStiffeningBushings) {
    const auto [rigid, rubber] = GetParam();
    const Walk limit = solve_branch(compile(trimmed(rigid)), "travel");
    std::map<double, double> off;  // [mm, deg]
    for (const double s : {1.0, 10.0, 100.0, 1000.0}) {
        Scene scene = support::scene(rubber);
        for (auto& elastic : scene.elastics)
            if (auto* bushing = std::get_if<Bushing>(&elastic.kind))
                std::get<LinearStiffness>(bushing->law).K.topLeftCorner<3, 3>() *= s;
        const Walk with = solve_branch(compile(trim(scene).scene), "travel");
        for (const char* what : {"toe", "camber", "wheel_centre_x", "wheel_centre_y"})
            off[s] = std::max(off[s], distance(with[what], limit[what]));
    }
    EXPECT_LE(off[1], 3);
    EXPECT_GE(off[1], 0.01);
    EXPECT_NEAR(std::log10(off[10] / off[100]), 1, 0.05) << off[10] << " " << off[100];
    EXPECT_NEAR(std::log10(off[100] / off[1000]), 1, 0.01) << off[100] << " " << off[1000];
}

INSTANTIATE_TEST_SUITE_P(Scenes, RigidSuspensions,
                         testing::Values(std::pair{"mcpherson_rigid", "mcpherson_strut"},
                                         std::pair{"double_wishbone_rigid", "double_wishbone"}),
                         [](const auto& pair) { return std::string(pair.param.second); });

}  // namespace
}  // namespace elastocheck::compare
