// Element forces in the states of the legs balance loads and joints on every body, and are reported
// at the ends of the branches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/comparison/compare.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/outputs/positions.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/trim.hpp"
#include "models/overloaded.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

// ---- Balance by virtual work: for every body and each of its six virtual displacements, the work
// of loads and joints equals Σ force · δ(deformation) of the elements: forces and deformations as
// reported, in mm and deg, δ by differences.

Pose shifted(const Pose& pose, int k, double h) {
    const Vector3d v = h * Vector3d::Unit(k % 3);
    if (k < 3) return {pose.r + v, pose.p};
    return {pose.r, Eigen::Quaterniond(Eigen::AngleAxisd(h, Vector3d::Unit(k % 3))) * pose.p};
}

Vector6 wrench_about_origin(const Equilibrium& state, BodyId body, const Vector3d& at,
                            const Vector3d& f, const Vector3d& m) {
    Vector6 w;
    w << f, m + (at - pose(state.poses, body).r).cross(f);
    return w;
}

void add(std::vector<Vector6>& on, const Equilibrium& state, const LoadKind& load, double factor) {
    const auto force = [&](const Point& at, const Vector3d& f) {
        on[static_cast<std::size_t>(at.body)] += wrench_about_origin(
            state, at.body, position(state.poses, at), factor * f, Vector3d::Zero());
    };
    const auto moment = [&](BodyId body, const Vector3d& m) {
        on[static_cast<std::size_t>(body)].tail<3>() += factor * m;
    };
    const auto turn = [&](BodyId body, const Vector3d& v) -> Vector3d {
        return pose(state.poses, body).p * v;
    };
    std::visit(overloaded{[&](const DeadForce& l) { force(l.at, l.f); },
                          [&](const DeadMoment& l) { moment(l.body, l.m); },
                          [&](const FollowerForce& l) { force(l.at, turn(l.at.body, l.f_local)); },
                          [&](const FollowerMoment& l) { moment(l.body, turn(l.body, l.m_local)); },
                          [&](const BrakeForce& l) {
                              on[static_cast<std::size_t>(l.body)] +=
                                  wrench_about_origin(state, l.body, position(state.poses, l.patch),
                                                      factor * l.f, Vector3d::Zero());
                          }},
               load);
}

// Wrenches of loads and joints on each body, about its origin.
std::vector<Vector6> acting(const Model& model, const Branch& branch, const Equilibrium& state) {
    std::vector<Vector6> on(model.bodies.size(), Vector6::Zero());
    for (const auto& load : model.static_loads) add(on, state, load.kind, 1);
    for (const auto& driver : branch.drivers)
        if (const auto* load = std::get_if<Load>(&driver.what))
            add(on, state, load->kind, driver.start + driver.rate * state.load);
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
        const ModelJoint& joint = model.joints[k];
        const Wrench& w = state.reactions[k];
        const Vector3d at = position(state.poses, joint.at);
        if (joint.i != ground)
            on[static_cast<std::size_t>(joint.i)] +=
                wrench_about_origin(state, joint.i, at, w.force, w.moment);
        if (joint.j != ground)
            on[static_cast<std::size_t>(joint.j)] -=
                wrench_about_origin(state, joint.j, at, w.force, w.moment);
    }
    return on;
}

// Largest imbalance, over the largest acting force, at least 1 N: forces, and moments by 1 m.
double out_of_balance(const Model& model, const Branch& branch, const Equilibrium& state) {
    const auto all = element_channels(model);
    const auto values = evaluate(model, branch, all, state);
    const auto on = acting(model, branch, state);
    double left = 0, size = 1;
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
        for (int k = 0; k < 6; ++k) {
            constexpr double h = 1e-5;
            Equilibrium more = state, less = state;
            more.poses[b] = shifted(state.poses[b], k, h);
            less.poses[b] = shifted(state.poses[b], k, -h);
            const auto there = evaluate(model, branch, all, more),
                       here = evaluate(model, branch, all, less);
            double sum = on[b][k];
            size = std::max(size, std::abs(sum));
            for (std::size_t c = 0; c < all.size(); ++c) {
                const auto* of = std::get_if<ElementComponent>(&all[c].reads);
                if (of == nullptr || of->component < 6 || std::isnan(values[c])) continue;
                std::size_t d = c;  // the deformation along the same axis
                while (std::get<ElementComponent>(all[d].reads).component != of->component - 6) --d;
                const double taken_up =
                    values[c] * (there[d] - here[d]) / in_unit(all[d].unit) / (2 * h);
                sum -= taken_up;
                size = std::max(size, std::abs(taken_up));
            }
            left = std::max(left, std::abs(sum));
        }
    return left / size;
}

// Excludes forces without an energy, which are not work-conjugate to the reported deformations.
std::vector<std::string> scenes_of_energies() {
    auto names = support::scene_names();
    std::erase_if(names, [](const std::string& name) {
        return std::ranges::any_of(support::scene(name).elastics, [](const Elastic& elastic) {
            const auto* bushing = std::get_if<Bushing>(&elastic.kind);
            return bushing != nullptr && !has_energy(bushing->formulation);
        });
    });
    return names;
}

class Balance : public testing::TestWithParam<std::string> {};

TEST_P(Balance, ForcesOfElementsLoadsAndJointsSumToZeroOnEveryBody) {
    const Scene scene = trim(support::scene(GetParam())).scene;
    const Model model = compile(scene);
    for (const auto& branch : model.branches)
        for (const BranchSide& side : sides_of(model, branch, 4)) {
            const std::vector<double> ends{0, side.branch.to / 2, side.branch.to};
            const auto equilibrium = reference::equilibrium::solve(side.model, side.branch, ends);
            ASSERT_FALSE(equilibrium.points.empty()) << side.name << ": " << equilibrium.detail;
            for (const auto& state : equilibrium.points)
                EXPECT_LE(out_of_balance(model, branch, state), 1e-7)
                    << side.name << " at " << state.load;
            const auto energy = reference::energy::solve(side.model, side.branch, ends);
            for (const auto& state : energy.points)
                EXPECT_LE(out_of_balance(model, branch, state), 1e-6)
                    << side.name << " at " << state.load;
        }
}

INSTANTIATE_TEST_SUITE_P(Elements, Balance,
                         testing::Values("chrono_mcpherson_travel", "mcpherson_strut",
                                         "solid_axle_leaf", "tyre_on_road", "two_spring_arch"),
                         [](const auto& scene) { return scene.param; });
INSTANTIATE_TEST_SUITE_P(Nightly, Balance, testing::ValuesIn(scenes_of_energies()),
                         [](const auto& scene) { return scene.param; });

// ---- Values at the ends of the branches.

TEST(ForceRows, ForcesAtBothEndsOfABranchHaveTheirClosedFormAndTheErrorOfTheRecursion) {
    const Model model = compile(support::scene("tyre_on_road"));
    Options options;
    options.recursion.steps = 20;
    const Comparison comparison = compare(model, options);
    const auto list = force_rows(model, comparison);
    const auto of = [&](const std::string& branch, double a, const std::string& output) {
        for (const auto& v : list)
            if (v.branch == branch && std::abs(v.end - a) < 1e-9 && v.output == output) return v;
        ADD_FAILURE() << branch << " " << a << " " << output;
        return ForceRow{};
    };
    // The closed form in the head of the scene: z = h k_t / (k_w + k_t).
    for (const double h : {-15.0, 60.0}) {
        const double z = h * 200 / 230;
        EXPECT_NEAR(of("road", h, "suspension.force").value, 3500 + 30 * z, 1e-6);
        EXPECT_NEAR(of("road", h, "tyre.force").value, 3892.4 + 200 * (h - z), 1e-6);
        EXPECT_NEAR(of("road", h, "tyre.deflection").value, (3892.4 + 200 * (h - z)) / 200, 1e-8);
        EXPECT_EQ(of("road", h, "tyre.force").element, "tyre");
        EXPECT_LE(std::abs(of("road", h, "suspension.force").error), 1e-6);  // linear here
    }
    EXPECT_TRUE(std::ranges::none_of(list, [](const auto& v) {
        return v.branch == "wheel" && v.element == "tyre";
    })) << "it does not stand there";
    EXPECT_EQ(of("standing", 2000, "suspension.force").end_unit, "N");
}

TEST(ForceRows, ErrorOfTheRecursionIsGivenInTheUnitAndInPercent) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    Options options;
    options.recursion.steps = 20;
    const Comparison comparison = compare(model, options);
    const auto list = force_rows(model, comparison);
    const auto all = element_channels(model);
    ASSERT_EQ(list.size(), 2 * all.size());  // two one-sided branches
    double largest = 0;
    for (const auto& v : list) {
        const auto b = static_cast<std::size_t>(v.branch == "rebound");
        const auto c = static_cast<std::size_t>(find_channel(all, v.output));
        const auto state = [&](Leg leg) { return *comparison.branches[b].run(leg).landmarks.back; };
        const auto read = [&](Leg leg) {
            return evaluate(model, model.branches[b], {&all[c], 1}, state(leg)).front();
        };
        EXPECT_EQ(v.value, read(Leg::equilibrium)) << v.output;
        EXPECT_EQ(v.error, read(Leg::recursive) - read(Leg::equilibrium)) << v.output;
        if (std::abs(v.value) > 1e-6) {
            EXPECT_EQ(v.share, 100 * (v.error / std::abs(v.value)));
        } else {
            EXPECT_TRUE(std::isnan(v.share));
        }
        if (v.output == "K1_coil.force") largest = std::max(largest, std::abs(v.share));
    }
    EXPECT_TRUE(largest > 0.1 && largest < 20) << largest;
}

// From z = h to -h the springs are shortest in the middle, where the arch is flat, and free at both
// ends: F = k (ℓ₀ - b).
TEST(LargestForces, MaximumInsideTheBranchIsFound) {
    const Model model = compile(support::scene("arch_driven"));
    Branch branch = model.branches.front();
    branch.from = 0;
    branch.to = -0.16;
    branch.steps = 80;
    const auto found = run(model, branch, Leg::equilibrium);
    ASSERT_EQ(found.outcome, Outcome::converged);
    const double shortened = std::hypot(300, 80) - 300;
    ASSERT_EQ(found.largest.size(), 2u);
    for (const auto& one : found.largest) {
        EXPECT_EQ(one.output, one.element + ".force");
        EXPECT_NEAR(one.value, 100 * shortened, 1e-6);
        EXPECT_NEAR(one.deformation, shortened, 1e-8);
        EXPECT_EQ(one.a, -80);
    }
    // states to draw: evenly spaced, with both ends
    ASSERT_EQ(found.stations.size(), 17u);
    for (std::size_t k = 0; k < 17; ++k)
        EXPECT_NEAR(found.stations[k].load, -0.16 + 0.01 * static_cast<double>(k), 1e-12);
    EXPECT_TRUE(run(model, branch, Leg::energy).largest.empty());
}

}  // namespace
}  // namespace elastocheck::compare
