// Property-based test on random scenes: a result is correct, or the outcome is a failure.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "tests/recursive/random_scenes.hpp"

namespace elastocheck::recursive {
namespace {

// Distance between two states, in units of the tolerances for origins and orientations. Bodies
// moved by an idle mode are skipped, since their position along it is arbitrary.
double apart(const Diagnosis& diagnosis, const Equilibrium& a, const Equilibrium& b, double length,
             double angle) {
    double worst = 0;
    for (std::size_t body = 0; body < a.poses.size(); ++body) {
        double moves = 0;
        for (const auto& mode : diagnosis.idle)
            moves += mode.dq.segment<6>(6 * static_cast<Eigen::Index>(body)).norm();
        if (moves > 1e-6) continue;
        worst = std::max({worst, (a.poses[body].r - b.poses[body].r).norm() / length,
                          a.poses[body].p.angularDistance(b.poses[body].p) / angle});
    }
    return worst;
}

TEST(RandomScenes, AreRightOrSaidToBeUnsolved) {
    constexpr int scenes = 200;  // adaptive and series fail on 68 and 149
    int judged = 0;
    std::map<std::string, int> declined;
    std::set<int> unsolved;  // by either method
    std::string which;
    for (int number = 0; number < scenes; ++number) {
        const Model model = compile(random_scene(number));
        const Branch& branch = model.branches[0];
        const Analysis analysis = analyse(model);
        std::map<std::string_view, EquilibriumPath> paths;
        for (const auto& method : methods) {
            const auto& path = paths[method.name] =
                solve(model, branch, {.method = method}, analysis);
            EXPECT_EQ(path.outcome == Outcome::converged, path.detail.empty())
                << number << " " << method.name;
            EXPECT_TRUE(path.outcome != Outcome::converged || path.points.size() == 21u)
                << number << " " << method.name;
            for (const auto& point : path.points)
                for (const auto& pose : point.poses)
                    ASSERT_TRUE(pose.r.allFinite() && pose.p.coeffs().allFinite())
                        << number << " " << method.name;
        }
        std::vector<double> loads;
        for (const auto& k : {0, 5, 10, 15, 20}) loads.push_back(branch.to * k / 20);
        const auto equilibrium = reference::equilibrium::solve(model, branch, loads);
        const auto energy = equilibrium.outcome == Outcome::converged
                                ? reference::energy::solve(model, branch, loads)
                                : EquilibriumPath{Outcome::branch_lost, {}, {}, {}};
        double references = 0;
        for (std::size_t k = 0; k < std::min(energy.points.size(), equilibrium.points.size()); ++k)
            references = std::max(references, apart(analysis.diagnosis, energy.points[k],
                                                    equilibrium.points[k], 1e-7, 1e-7));
        if (energy.outcome != Outcome::converged || !(references <= 1)) continue;
        ++judged;
        for (const auto& [name, length, angle] :
             {std::tuple{"adaptive", Adaptive{}.length_tolerance, Adaptive{}.angle_tolerance},
              std::tuple{"series", 1e-7, 1e-7}}) {
            const auto& path = paths[name];
            if (path.outcome != Outcome::converged) {
                ++declined[name];
                unsolved.insert(number);
                which += fmt::format("\n{} {}: {}", number, name, path.detail);
                continue;
            }
            for (std::size_t k = 0; k < loads.size(); ++k)
                EXPECT_LE(apart(analysis.diagnosis, path.points[5 * k], equilibrium.points[k],
                                length, angle),
                          1)
                    << number << " " << name << " at " << loads[k];
        }
    }
    // The equilibrium leg has a second settling method that reaches states without a path from the
    // drawing (149), and steps short enough to settle with very little stiffness, which the
    // recursion rejects (68).
    EXPECT_LE(static_cast<int>(unsolved.size()), judged / 50) << which;
    RecordProperty("judged", judged);
    RecordProperty("adaptive declined", declined["adaptive"]);
    RecordProperty("series declined", declined["series"]);
    EXPECT_GE(judged, scenes * 6 / 10);
}

// Regression: `balanced` followed 97 of 1000 branches past the point where both references end.
TEST(RandomScenes, NoMethodGoesOnWhereBothReferencesEnd) {
    const char* asked = std::getenv("RANDOM_SCENES");
    const int scenes = asked != nullptr ? std::atoi(asked) : 120;
    std::map<std::string, int> went_on, ended;
    for (int number = 0; number < scenes; ++number) {
        const Model model = compile(random_scene(number));
        const Branch& branch = model.branches[0];
        const std::vector<double> loads{0, branch.to};
        const auto equilibrium = reference::equilibrium::solve(model, branch, loads);
        if (equilibrium.outcome == Outcome::converged) continue;
        const auto energy = reference::energy::solve(model, branch, loads);
        if (energy.outcome == Outcome::converged) continue;
        ++ended[fmt::format("{} / {}", name(equilibrium.outcome), name(energy.outcome))];
        const Analysis analysis = analyse(model);
        for (const Method& method : methods) {
            const auto path = solve(model, branch, {.method = method}, analysis);
            if (path.outcome != Outcome::converged) continue;
            ++went_on[std::string(method.name)];
            ADD_FAILURE() << number << ": " << method.name << " converges, " << equilibrium.detail
                          << "; " << energy.detail;
        }
    }
    for (const auto& [how, count] : ended) RecordProperty(how, count);
    if (asked != nullptr) {
        for (const auto& [how, count] : ended) fmt::print("{:4} ended: {}\n", count, how);
        for (const auto& [method, count] : went_on) fmt::print("{:4} gone on: {}\n", count, method);
    }
}

}  // namespace
}  // namespace elastocheck::recursive
