// Invariance of all outputs of every leg: ground frame, body axes, order, mirror image, units,
// number of points, repetition.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "tests/legs/legs.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

// A leg, and for the recursion a method.
struct LegAndMethod {
    Leg leg;
    const char* method;
};
void PrintTo(const LegAndMethod& one, std::ostream* out) {
    *out << (*one.method != 0 ? one.method : name(one.leg));
}
constexpr LegAndMethod all_legs[] = {{Leg::recursive, "published"},
                                     {Leg::recursive, "midpoint"},
                                     {Leg::recursive, "series"},
                                     {Leg::equilibrium, ""},
                                     {Leg::energy, ""}};

// Every kind of driver, alone and with others: a rack held off centre under a load, a jack with a
// preload and a braking force, a free length.
Scene driven_scene() {
    Scene s = legs::with_jack(legs::with_rack(support::scene("chrono_mcpherson")));
    s.name = "driven";
    const int jack = static_cast<int>(s.joints.size()) - 1, rack = jack - 1;
    Vector6 preload;
    preload << 900, -400, 300, 4, 7, -3;
    const Load brake{"brake", DeadForce{s.wheels[0].contact, {-1, .3, 0}}};
    const Driver load = s.branches[0].drivers[0];
    s.branches = {
        legs::branch_of({load, {Motion{rack}, 0.015, 0}}, 2000),
        legs::branch_of({{Motion{jack}, 0, 1}, {Preload{2, preload}, 1, 0}, {brake, 900, 0}}, -0.08,
                        ParameterUnit::metre),
        legs::branch_of({{Motion{rack}, 0, 1}, {Motion{jack}, 0.02, 0.5}}, 0.02,
                        ParameterUnit::metre),
        legs::branch_of({{FreeLength{0}, 0.005, 1}}, 0.02, ParameterUnit::metre)};
    for (std::size_t k = 0; k < s.branches.size(); ++k) s.branches[k].name += std::to_string(k);
    return s;
}

class Invariance : public testing::TestWithParam<LegAndMethod> {
  protected:
    double bound() const { return GetParam().leg == Leg::energy ? 1e-7 : 1e-9; }

    static bool has_equal_steps() {
        const auto method = recursive::find_method(GetParam().method);
        return method && recursive::has_steps(*method);
    }

    // The small scenes to which the leg applies, a rich one and one with every driver.
    static std::vector<Scene> scenes() {
        std::vector<Scene> all;
        for (const auto& name : support::small_scene_names()) all.push_back(support::scene(name));
        // Equal steps hold the idle spin of the rich scene in another way after a change of order.
        if (!has_equal_steps()) {
            all.push_back(support::rich_scene());
            all.push_back(driven_scene());
        }
        if (GetParam().leg == Leg::energy)
            std::erase_if(all, [](const Scene& scene) { return !support::has_potential(scene); });
        return all;
    }

    static LegRun solve(const Model& model, const Branch& branch, int steps = 20) {
        recursive::Options how{.steps = steps};
        if (const auto method = recursive::find_method(GetParam().method)) how.method = *method;
        return run(model, branch, GetParam().leg, how);
    }

    // Compares every output of `other`, by name, at all points of all branches with `factor` times
    // that of `scene`.
    void expect_same(const Scene& scene, const Scene& other,
                     const std::function<double(const Channel&)>& factor, double wider = 1) {
        const Model a = compile(scene), b = compile(other);
        const auto names_a = channels(a), names_b = channels(b);
        for (std::size_t k = 0; k < a.branches.size(); ++k) {
            const LegRun run_a = solve(a, a.branches[k]), run_b = solve(b, b.branches[k]);
            ASSERT_EQ(run_a.outcome, Outcome::converged) << scene.name << ": " << run_a.detail;
            ASSERT_EQ(run_b.outcome, Outcome::converged) << scene.name << ": " << run_b.detail;
            double largest[5] = {1, 1, 1, 1, 1};  // displacements, angles, forces, moments
            for (std::size_t p = 0; p < run_a.curve.values.size(); ++p)
                for (std::size_t c = 0; c < names_a.size(); ++c) {
                    auto& size = largest[static_cast<int>(names_a[c].unit)];
                    size = std::max(
                        size, std::abs(run_a.curve.values[p][c] -
                                       (names_a[c].kinematic() ? run_a.curve.values[0][c] : 0)));
                }
            // A moment about a distant point is as accurate as force times distance.
            largest[3] = std::max(largest[3], largest[2]);
            for (std::size_t c = 0; c < names_a.size(); ++c) {
                const auto in_b = static_cast<std::size_t>(
                    std::ranges::find(names_b, names_a[c].name, &Channel::name) - names_b.begin());
                ASSERT_LT(in_b, names_b.size());
                const double times = factor(names_a[c]);
                double worst = 0;
                for (std::size_t p = 0; p < run_a.curve.values.size(); ++p)
                    worst = std::fmax(worst, std::abs(run_b.curve.values[p][in_b] / times -
                                                      run_a.curve.values[p][c]));
                EXPECT_LE(worst, wider * bound() * largest[static_cast<int>(names_a[c].unit)])
                    << scene.name << ", " << a.branches[k].name << ": " << names_a[c].name;
            }
        }
    }

    // Outputs rotate with the frame: displacements and reactions are rotated back and
    // compared as vectors.
    void expect_moved(const Scene& scene, const Eigen::Quaterniond& R, const Vector3d& t,
                      double bound) {
        const Model a = compile(scene), b = compile(support::moved(scene, R, t));
        for (std::size_t k = 0; k < a.branches.size(); ++k) {
            const LegRun run_a = solve(a, a.branches[k]), run_b = solve(b, b.branches[k]);
            ASSERT_EQ(run_b.outcome, Outcome::converged) << run_b.detail;
            const auto list = channels(a);
            for (std::size_t c = 0; c + 2 < list.size(); ++c) {
                if (!list[c].name.ends_with("_x")) continue;
                const bool position = list[c].unit == Unit::mm;
                double size = 1, worst = 0;
                for (std::size_t p = 0; p < run_a.curve.values.size(); ++p) {
                    const auto vector = [&](const LegRun& r, std::size_t point) {
                        return Vector3d(&r.curve.values[point][c]);
                    };
                    const Vector3d in_a = vector(run_a, p);
                    const Vector3d in_b =
                        R.conjugate() * Vector3d(vector(run_b, p) - (position ? 1e3 : 0) * t);
                    size = std::max(
                        size, (in_a - (position ? vector(run_a, 0) : Vector3d::Zero())).norm());
                    for (std::size_t j = 0; j < list.size(); ++j)
                        if (list[j].joints() == list[c].joints() && !position)
                            size = std::max(size, std::abs(run_a.curve.values[p][j]));
                    worst = std::fmax(worst, (in_a - in_b).norm());
                }
                EXPECT_LE(worst, bound * size)
                    << scene.name << ", " << a.branches[k].name << ": " << list[c].name;
            }
        }
    }
};

const Eigen::Quaterniond R(Eigen::AngleAxisd(2, Vector3d(1, -2, 0.5).normalized()));
double unchanged(const Channel&) { return 1; }

TEST_P(Invariance, OrderOfBodiesAndJointsDoesNotChangeTheStates) {
    for (const Scene& scene : scenes()) expect_same(scene, support::reversed(scene), unchanged);
}

TEST_P(Invariance, AxesOfTheBodyFramesDoNotChangeTheStates) {
    for (const Scene& scene : scenes())
        expect_same(scene, support::with_body_axes(scene, {R, R.conjugate()}), unchanged);
}

TEST_P(Invariance, MirroredSceneGivesTheMirroredStates) {
    for (const Scene& scene : scenes())
        expect_same(scene, support::mirrored(scene), [](const Channel& channel) {
            const bool moment = channel.name.find(".moment") != channel.name.npos;
            const bool y = channel.name.ends_with("_y"),
                       axis = y || channel.name.ends_with("_x") || channel.name.ends_with("_z");
            return !axis ? 1.0 : y != moment ? -1.0 : 1.0;
        });
}

TEST_P(Invariance, GroundFrameDoesNotChangeTheStates) {
    for (const Scene& scene : scenes()) expect_moved(scene, R, {3, -2, 1}, bound());
}

// A double resolves 2e-12 m at 10 km and 9e-10 m at 7000 km. The recursion, which moves the origin to the
// model, is the same to some dozens of these.
TEST_P(Invariance, DistanceFromTheOriginChangesTheStatesByRoundingOnly) {
    for (const char* name : {"four_bar", "chrono_mcpherson_preload"})
        for (const double far : {1e4, 7e6}) {
            if (far > 1e6 && GetParam().leg != Leg::recursive) continue;
            expect_moved(support::scene(name), Eigen::Quaterniond::Identity(), {far, -far, 0},
                         (GetParam().leg == Leg::recursive ? 1e-11 : 1e-9) * far);
        }
}

// The tolerance of the series is a length in metres, and its truncation error with it.
TEST_P(Invariance, UnitsOfLengthAndForceDoNotChangeTheStates) {
    const double wider = GetParam().leg == Leg::recursive ? 10 : 1;
    for (const Scene& scene : scenes())
        for (const auto& [length, force] : {std::pair{1e3, 1e-3}, {1 / 39.37, 1.}}) {
            const auto factor = [length = length, force = force](const Channel& channel) {
                return channel.unit == Unit::mm             ? length
                       : channel.unit == Unit::newton       ? force
                       : channel.unit == Unit::newton_metre ? force * length
                                                            : 1;
            };
            expect_same(scene, support::scaled(scene, length, force), factor, wider);
        }
}

// An exact leg reaches the same end in any number of steps, and every leg the same bits again.
TEST_P(Invariance, NumberOfPointsAndRepetitionDoNotChangeTheEndState) {
    for (const Scene& scene : {support::rich_scene(), driven_scene()}) {
        const Model model = compile(scene);
        const auto list = channels(model);
        for (const Branch& branch : model.branches) {
            const LegRun fine = solve(model, branch), again = solve(model, branch);
            ASSERT_EQ(fine.outcome, Outcome::converged) << fine.detail;
            EXPECT_EQ(fine.curve.values, again.curve.values) << branch.name;
            EXPECT_EQ(fine.counts.factorisations, again.counts.factorisations);
            EXPECT_EQ(fine.counts.evaluations, again.counts.evaluations);
            if (has_equal_steps()) continue;
            for (const int steps : {1, 2, 7}) {
                Branch other = branch;
                other.steps = steps;
                const LegRun coarse = solve(model, other, steps);
                ASSERT_EQ(coarse.outcome, Outcome::converged) << coarse.detail;
                for (std::size_t c = 0; c < list.size(); ++c)
                    if (list[c].kinematic()) {
                        EXPECT_NEAR(coarse.curve.values.back()[c], fine.curve.values.back()[c],
                                    1e-7)
                            << branch.name << " " << list[c].name;
                    }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Legs, Invariance, testing::ValuesIn(all_legs),
                         [](const auto& one) { return testing::PrintToString(one.param); });

}  // namespace
}  // namespace elastocheck::compare
