// Invariance of all outputs of every leg: ground frame, body axes, order, mirror image.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

// A leg, and for the recursion a method.
struct Stride {
    Leg leg;
    const char* method;
};
void PrintTo(const Stride& way, std::ostream* out) {
    *out << (*way.method != 0 ? way.method : name(way.leg));
}
constexpr Stride strides[] = {{Leg::recursive, "published"},
                              {Leg::recursive, "midpoint"},
                              {Leg::recursive, "series"},
                              {Leg::equilibrium, ""},
                              {Leg::energy, ""}};

class EveryLeg : public testing::TestWithParam<Stride> {
  protected:
    double bound() const { return GetParam().leg == Leg::energy ? 1e-7 : 1e-9; }

    // The small scenes to which the leg applies.
    static std::vector<std::string> scenes() {
        std::vector<std::string> names = support::small_scene_names();
        if (GetParam().leg == Leg::energy)
            std::erase_if(names, [](const auto& name) {
                return !support::has_potential(support::scene(name));
            });
        return names;
    }

    static LegRun solve(const Model& model, const Branch& branch) {
        recursive::Options how{.steps = 20};
        if (const auto method = recursive::find_method(GetParam().method)) how.method = *method;
        return run(model, branch, GetParam().leg, how);
    }

    // Compares every output of `other`, by name, at all points of all branches with `sign` times
    // that of `scene`.
    void expect_same(const Scene& scene, const Scene& other,
                     const std::function<double(const std::string&)>& sign) {
        const Model a = compile(scene), b = compile(other);
        const auto names_a = channels(a), names_b = channels(b);
        for (std::size_t k = 0; k < a.branches.size(); ++k) {
            const LegRun run_a = solve(a, a.branches[k]), run_b = solve(b, b.branches[k]);
            ASSERT_EQ(run_a.outcome, Outcome::converged) << run_a.detail;
            ASSERT_EQ(run_b.outcome, Outcome::converged) << run_b.detail;
            double largest[5] = {};  // per unit: displacements, angles, forces, moments
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
                const auto in_b =
                    std::ranges::find(names_b, names_a[c].name, &Channel::name) - names_b.begin();
                double worst = 0;
                for (std::size_t p = 0; p < run_a.curve.values.size(); ++p)
                    worst = std::max(
                        worst, std::abs(run_b.curve.values[p][static_cast<std::size_t>(in_b)] -
                                        sign(names_a[c].name) * run_a.curve.values[p][c]));
                EXPECT_LE(worst,
                          bound() * std::max(largest[static_cast<int>(names_a[c].unit)], 1.0))
                    << scene.name << ", " << a.branches[k].name << ": " << names_a[c].name;
            }
        }
    }
};

const Eigen::Quaterniond R(Eigen::AngleAxisd(2, Eigen::Vector3d(1, -2, 0.5).normalized()));

TEST_P(EveryLeg, DoesNotSeeTheOrderOfBodiesAndJoints) {
    for (const auto& name : scenes())
        expect_same(support::scene(name), support::reversed(support::scene(name)),
                    [](const std::string&) { return 1; });
}

TEST_P(EveryLeg, DoesNotSeeTheAxesInWhichABodyIsDescribed) {
    for (const auto& name : scenes())
        expect_same(support::scene(name),
                    support::with_body_axes(support::scene(name), {R, R.conjugate()}),
                    [](const std::string&) { return 1; });
}

TEST_P(EveryLeg, MirrorsTheOtherSideOfTheVehicle) {
    for (const auto& name : scenes())
        expect_same(support::scene(name), support::mirrored(support::scene(name)),
                    [](const std::string& channel) {
                        const bool moment = channel.find(".moment") != channel.npos;
                        const bool y = channel.ends_with("_y"),
                                   axis = y || channel.ends_with("_x") || channel.ends_with("_z");
                        return !axis ? 1.0 : y != moment ? -1.0 : 1.0;
                    });
}

TEST_P(EveryLeg, DoesNotSeeTheGroundFrame) {
    // Outputs rotate with the frame: displacements and reactions are rotated back and compared as
    // vectors.
    const Eigen::Vector3d t(3, -2, 1);
    for (const auto& name : scenes()) {
        const Model a = compile(support::scene(name)),
                    b = compile(support::moved(support::scene(name), R, t));
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
                        return Eigen::Vector3d(&r.curve.values[point][c]);
                    };
                    const Eigen::Vector3d in_a = vector(run_a, p);
                    const Eigen::Vector3d in_b =
                        R.conjugate() *
                        Eigen::Vector3d(vector(run_b, p) - (position ? 1e3 : 0) * t);
                    size = std::max(
                        size,
                        (in_a - (position ? vector(run_a, 0) : Eigen::Vector3d::Zero())).norm());
                    for (std::size_t j = 0; j < list.size(); ++j)
                        if (list[j].joints() == list[c].joints() && !position)
                            size = std::max(size, std::abs(run_a.curve.values[p][j]));
                    worst = std::max(worst, (in_a - in_b).norm());
                }
                EXPECT_LE(worst, bound() * size)
                    << name << ", " << a.branches[k].name << ": " << list[c].name;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Invariance, EveryLeg, testing::ValuesIn(strides),
                         [](const auto& way) { return testing::PrintToString(way.param); });

}  // namespace
}  // namespace elastocheck::compare
