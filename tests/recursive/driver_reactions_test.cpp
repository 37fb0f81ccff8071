// Joint reactions on driven branches, against the equilibrium leg: every kind of driver with every
// method that converges to the true equilibrium. A driven length or angle changes the lines along
// which the multipliers act; an error in that term need not appear in the positions.
#include <gtest/gtest.h>

#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/recursive.hpp"
#include "models/branch.hpp"
#include "tests/support/scene_text.hpp"

namespace elastocheck::recursive {
namespace {

struct Kind {
    const char* name;
    const char* branch;
    const char* hinge = "revolute";
    const char* rack = "fixed, bodies: [rack, ground], at: inner";
    const char* joint = "";
    const char* tyre = "";
};
constexpr Kind kinds[] = {
    {"force", "load: force, to: 1500"},
    {"moment", "load: moment, to: 300000"},
    {"force that follows", "load: thrust, to: 1500"},
    {"length of a distance", "drive: joints.rod, to: 15"},
    {.name = "offset of a plane",
     .branch = "drive: joints.plane, to: -25",
     .joint = "  plane: {type: in_plane, bodies: [knuckle, ground], at: centre, "
              "normal: [0.1, 0.2, 1]}"},
    {"angle of a revolute", "drive: joints.hinge, to: 6"},
    {"angle of a cylindrical", "drive: joints.hinge, to: 6", "cylindrical"},
    {"travel of a rack", "drive: joints.rack, to: 20", "revolute",
     "translational, bodies: [rack, ground], at: inner, axis: y"},
    {"free length of a spring", "drive: springs.coil.free_length, to: 20"},
    {"preload of a spring", "drive: springs.coil.preload, to: 800"},
    {"preload of a bushing", "drive: bushings.mount.preload.y, to: 800"},
    {"moment in a bushing", "drive: bushings.mount.preload_moment.z, to: 80000"},
    {"moment in a torsion spring", "drive: torsion_springs.bar.preload_moment, to: 100000"},
    {"travel of the wheel", "drive: travel, to: 40"},
    {"travel of the contact patch", "drive: patch_travel, to: 40"},
    {"length and held travel, angle and load",
     "drive: joints.rod, to: 15, hold: {travel: 30, springs.coil.free_length: 8}"},
    {.name = "road under a tyre",
     .branch = "drive: tyres.t.road, to: 30",
     .tyre = "tyres: {t: {rate: 200, preload: 8000}}"},
};

Model driven(const Kind& kind) {
    return compile(
        support::filled_scene("recursive/scenes/every_driver", {{"HINGE", kind.hinge},
                                                                {"RACK", kind.rack},
                                                                {"JOINT", kind.joint},
                                                                {"TYRE", kind.tyre},
                                                                {"BRANCH", kind.branch}}));
}

// Largest difference of joint forces, and of moments over 0.3 m, and the largest such value [N].
struct Difference {
    double most = 0, of = 0;
};
Difference difference(const std::vector<Equilibrium>& found,
                      const std::vector<Equilibrium>& truth) {
    constexpr double lever = 0.3;
    Difference all;
    for (std::size_t k = 0; k < truth.size(); ++k)
        for (std::size_t j = 0; j < truth[k].reactions.size(); ++j) {
            const Wrench &one = found[k].reactions[j], &other = truth[k].reactions[j];
            all.most = std::max({all.most, (one.force - other.force).norm(),
                                 (one.moment - other.moment).norm() / lever});
            all.of = std::max({all.of, other.force.norm(), other.moment.norm() / lever});
        }
    return all;
}

// Tolerance of a method's reactions with `steps` steps, as a fraction of the largest reaction.
struct Rung {
    const char* name;
    int steps;
    double share;
};
constexpr Rung rungs[] = {{"tangent", 400, 2e-5},
                          {"chord", 400, 1e-7},
                          {"midpoint", 400, 1e-6},
                          {"adaptive", 4, 1e-6},
                          {"series", 4, 1e-10}};

TEST(Driver, ReactionsUnderEveryDriverEqualThoseOfTheEquilibriumLeg) {
    for (const Kind& kind : kinds) {
        const Model whole = driven(kind);
        const Branch& branch = whole.branches[0];
        const Model model = on_branch(whole, branch);
        std::vector<double> points;
        for (int k = 0; k <= 4; ++k) points.push_back(branch.to * k / 4);
        const auto truth = reference::equilibrium::solve(model, branch, points);
        ASSERT_EQ(truth.outcome, Outcome::converged) << kind.name << ": " << truth.detail;
        for (const Rung& rung : rungs) {
            Method method = find_method(rung.name).value();
            if (auto* adaptive = std::get_if<Adaptive>(&method.kind)) *adaptive = {1e-9, 1e-9};
            const auto path =
                solve(model, branch, {.method = method, .steps = rung.steps, .record = 4});
            ASSERT_EQ(path.outcome, Outcome::converged)
                << kind.name << ", " << rung.name << ": " << path.detail;
            const Difference off = difference(path.points, truth.points);
            EXPECT_GE(off.of, 1000) << kind.name;
            EXPECT_LE(off.most, rung.share * off.of) << kind.name << ", " << rung.name;
        }
    }
}

}  // namespace
}  // namespace elastocheck::recursive
