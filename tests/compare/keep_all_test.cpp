// Pruning and condensation by compile() change no output.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"
#include "models/branch.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

// Relative to an output's size along the branch, or to a minimum size for small outputs.
double allowed(Unit unit, double size) {
    // [mm], [deg], [N], [N·m]
    const double least = unit == Unit::mm || unit == Unit::deg ? 1 : 1e3;
    return 1e-9 * std::max(size, least);
}

// Whether the wrenches that the channel reads are active on the branch, and determined.
std::vector<bool> determined(const Model& model, const std::vector<Channel>& list,
                             const Branch& branch) {
    const Model standing = on_branch(model, branch);
    const auto known = recursive::diagnose(standing).determined;
    std::vector<bool> stands(model.joints.size(), false), result;
    for (const auto& constraint : standing.constraints)
        stands[static_cast<std::size_t>(constraint.joint)] = true;
    for (const auto& channel : list)
        result.push_back(std::ranges::all_of(channel.joints(), [&](int k) {
            const auto joint = static_cast<std::size_t>(k);
            return stands[joint] && known[joint];
        }));
    return result;
}

// Joint whose wrench the channel reads.
std::string joint_of(const Model& model, const Channel& channel) {
    return model.joints[static_cast<std::size_t>(channel.joints().front())].name;
}

// Message of compile() about a joint that was left out or condensed.
std::string said_of(const Model& model, const std::string& joint) {
    for (const auto& [what, why] : model.omitted)
        if (what == "joint '" + joint + "'" ||
            why.find("joint '" + joint + "'") != std::string::npos)
            return what + ": " + why;
    return "";
}

struct Tally {
    int kinematic = 0, forces = 0;      // numbers compared
    std::set<std::string> only_in_one;  // joints with a wrench in only one of the two models
};

void expect_same(const std::string& name, const Model& required, const Model& whole,
                 std::size_t branch, Tally& tally) {
    const auto some = channels(required), all = channels(whole);
    for (const auto& [list, other, of] :
         {std::tuple{&all, &some, &whole}, std::tuple{&some, &all, &required}})
        for (const auto& channel : *list) {
            if (find_channel(*other, channel.name) >= 0) continue;
            ASSERT_FALSE(channel.kinematic()) << name << ": " << channel.name;
            const std::string joint = joint_of(*of, channel);
            EXPECT_NE(said_of(required, joint), "")
                << name << ": nothing is said of joint " << joint;
            tally.only_in_one.insert(joint);
        }
    const Branch &less_branch = required.branches[branch], &more_branch = whole.branches[branch];
    const LegRun less = run(required, less_branch, Leg::equilibrium),
                 more = run(whole, more_branch, Leg::equilibrium);
    ASSERT_EQ(less.outcome, more.outcome)
        << name << " " << less_branch.name << ": " << less.detail << more.detail;
    ASSERT_EQ(less.curve.a.size(), more.curve.a.size());
    const auto known_less = determined(required, some, less_branch),
               known_more = determined(whole, all, more_branch);
    for (std::size_t c = 0; c < some.size(); ++c) {
        const int found = find_channel(all, some[c].name);
        if (found < 0) continue;
        const auto other = static_cast<std::size_t>(found);
        // Load sharing of redundant joints is not compared; a joint that replaces another one
        // carries the whole load.
        if (!known_less[c] || !known_more[other]) continue;
        double size = 0, apart = 0;
        for (std::size_t k = 0; k < less.curve.a.size(); ++k) {
            const double value = less.curve.values[k][c];
            if (some[c].may_be_undefined() && value == undefined &&
                more.curve.values[k][other] == undefined)
                continue;
            size = std::max(size, std::abs(value));
            apart = worse(apart, std::abs(value - more.curve.values[k][other]));
            ++(some[c].kinematic() ? tally.kinematic : tally.forces);
        }
        EXPECT_TRUE(apart <= allowed(some[c].unit, size))
            << name << ", " << less_branch.name << ", " << some[c].name << ": " << apart << " of "
            << size;
    }
}

TEST(OmittedParts, ChangeNoOutputOfAnyBuiltInScene) {
    Tally tally;
    std::set<std::string> smaller;  // scenes in which something is left out or condensed
    for (const auto& name : support::scene_names()) {
        Scene scene = trim(support::scene(name)).scene;
        for (auto& branch : scene.branches) branch.steps = 4;
        const Model required = compile(scene), whole = compile(scene, Detail::everything);
        if (required.bodies.size() < whole.bodies.size() &&
            required.joints.size() < whole.joints.size())
            smaller.insert(name);
        ASSERT_EQ(required.branches.size(), whole.branches.size());
        for (std::size_t b = 0; b < required.branches.size(); ++b)
            if (!required.branches[b].drivers.empty()) expect_same(name, required, whole, b, tally);
    }
    EXPECT_GT(tally.kinematic, 1000);
    EXPECT_GT(tally.forces, 1000);
    // Welded to ground, welded together, redundant; links with a ball at each end.
    EXPECT_EQ(smaller, (std::set<std::string>{"front_axle", "multi_link"}));
    for (const char* joint :
         {"subframe", "hub", "trailing_ball", "link_to_arm_left", "drop_link_left"})
        EXPECT_TRUE(tally.only_in_one.contains(joint)) << joint;
}

}  // namespace
}  // namespace elastocheck::compare
