// Pruning and condensation by compile() change no result: a scene as from a CAD model, solved as
// written and as condensed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "tests/support/scene_text.hpp"

namespace elastocheck {
namespace {

// Five rods as bodies with a ball at each end, one ball duplicated; the knuckle of two welded
// bodies with a redundant joint; a subframe of two bodies on bushings; a bracket welded to ground
// with the spring and an idle appendage; a spring within the subframe.
struct Side {
    const Model& model;
    EquilibriumPath path;

    const Pose& pose(std::size_t point, const std::string& body) const {
        const auto found = std::ranges::find(model.bodies, body, &Body::name);
        return path.points.at(point).poses.at(
            static_cast<std::size_t>(found - model.bodies.begin()));
    }
    double force(std::size_t point, const std::string& joint) const {
        const auto found = std::ranges::find(model.joints, joint, &ModelJoint::name);
        return path.points.at(point)
            .reactions.at(static_cast<std::size_t>(found - model.joints.begin()))
            .force.norm();
    }
};

TEST(Condensed, CompiledModelEqualsTheSceneAsWritten) {
    const Scene scene = support::scene_of("reference/scenes/as_built");
    const Model small = compile(scene), whole = compile(scene, Detail::everything);
    EXPECT_EQ(small.as_written, (Size{11, 17, 4, 60}));  // with the jack
    EXPECT_EQ(small.as_solved, (Size{2, 6, 3, 6}));
    ASSERT_EQ(small.bodies.at(0).name, "wheel");
    ASSERT_EQ(small.bodies.at(1).name, "subframe");
    double worst = 0, worst_force = 0;
    int compared = 0;
    for (std::size_t b = 0; b < small.branches.size(); ++b)
        for (std::size_t w = 0; w < branch_sides(small.branches[b]).size(); ++w) {
            const Branch way = branch_sides(small.branches[b])[w],
                         whole_way = branch_sides(whole.branches[b])[w];
            std::vector<double> loads;
            for (int k = 0; k <= 6; ++k) loads.push_back(way.to * k / 6);
            const Side s{small, reference::equilibrium::solve(on_branch(small, way), way, loads)};
            const Side l{whole, reference::equilibrium::solve(on_branch(whole, whole_way),
                                                              whole_way, loads)};
            ASSERT_EQ(s.path.outcome, Outcome::converged) << way.name << ": " << s.path.detail;
            ASSERT_EQ(l.path.outcome, Outcome::converged) << way.name << ": " << l.path.detail;
            for (std::size_t k = 0; k < loads.size(); ++k) {
                for (const char* body : {"wheel", "subframe"}) {
                    const Pose &a = s.pose(k, body), &c = l.pose(k, body);
                    const double apart = std::max((a.r - c.r).norm(), a.p.angularDistance(c.p));
                    EXPECT_TRUE(std::isfinite(apart) && apart <= 1e-12)
                        << way.name << " " << k << " " << body;
                    worst = std::max(worst, apart);
                }
                // A rod exerts at both ends the force of its distance constraint.
                for (const int rod : {1, 2, 3, 5})
                    for (const char* end : {"inner", "outer"}) {
                        const double apart = std::abs(s.force(k, fmt::format("rod_{}", rod)) -
                                                      l.force(k, fmt::format("{}_{}", end, rod)));
                        EXPECT_TRUE(std::isfinite(apart) && apart <= 1e-7)
                            << way.name << " " << k << " " << rod;
                        worst_force = std::max(worst_force, apart);
                        ++compared;
                    }
            }
        }
    EXPECT_EQ(compared, 4 * 7 * 8);
    RecordProperty("worst", fmt::format("{:.2g} m or rad, {:.2g} N", worst, worst_force));
}

}  // namespace
}  // namespace elastocheck
