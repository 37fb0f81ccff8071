// Continuation of branches: points are passed on when found, in the order of the branch, all or
// every `every`-th; results without stored points.
#include "compare/comparison/legs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

// Equal to the last bit.
bool same(const Equilibrium& a, const Equilibrium& b) {
    const auto pose = [](const Pose& x, const Pose& y) {
        return x.r == y.r && x.p.coeffs() == y.p.coeffs();
    };
    const auto wrench = [](const Wrench& x, const Wrench& y) {
        return x.force == y.force && x.moment == y.moment;
    };
    return a.load == b.load && a.constraint_error == b.constraint_error &&
           std::ranges::equal(a.poses, b.poses, pose) &&
           std::ranges::equal(a.reactions, b.reactions, wrench);
}

void expect_same(const std::vector<Equilibrium>& a, const std::vector<Equilibrium>& b,
                 const std::string& where) {
    ASSERT_EQ(a.size(), b.size()) << where;
    for (std::size_t k = 0; k < a.size(); ++k)
        EXPECT_TRUE(same(a[k], b[k])) << where << ", point " << k;
}

std::vector<SolverSettings> every_gait() {
    std::vector<SolverSettings> all{
        {.leg = Leg::equilibrium}, {.leg = Leg::energy}, {.leg = Leg::series}};
    for (const char* method : {"published", "tangent", "adaptive"})
        all.push_back({.recursion = {.method = recursive::find_method(method).value()}});
    return all;
}

std::string name_of(const SolverSettings& solver) {
    return solver.leg == Leg::recursive ? std::string(solver.recursion.method.name)
                                        : name(solver.leg);
}

void expect_visited_as_kept(const std::vector<std::string>& scenes) {
    for (const auto& scene : scenes) {
        const Model model = compile(support::scene(scene));
        for (const auto& branch : model.branches)
            for (const auto& side : sides_of(model, branch, 6))
                for (const auto& method : recursive::methods) {
                    const std::string where =
                        scene + ", " + side.name + " by " + std::string(method.name);
                    // More points than the series evaluates at once.
                    const recursive::Options options{
                        .method = method,
                        .steps = recursive::has_steps(method) ? 12 : 150,
                        .record = 0};
                    const auto kept = recursive::solve(side.model, side.branch, options);
                    std::vector<Equilibrium> visited;
                    const auto path = recursive::solve(
                        side.model, side.branch, options,
                        [&](const Equilibrium& state) { visited.push_back(state); });
                    EXPECT_TRUE(path.points.empty()) << where;
                    EXPECT_EQ(path.outcome, kept.outcome) << where;
                    EXPECT_EQ(path.detail, kept.detail) << where;
                    EXPECT_EQ(path.counts.factorisations, kept.counts.factorisations) << where;
                    expect_same(visited, kept.points, where);
                }
    }
}

TEST(PointVisitor, SeesThePointsThatTheRecursionStores) {
    expect_visited_as_kept(support::small_scene_names());
}

TEST(NightlyPointVisitor, SeesThePointsThatTheRecursionStoresOnEveryScene) {
    expect_visited_as_kept(support::scene_names());
}

TEST(PointVisitor, SeesThePointsThatTheReferencesStore) {
    for (const auto& scene : support::small_scene_names()) {
        const Model model = compile(support::scene(scene));
        for (const auto& branch : model.branches)
            for (const auto& side : sides_of(model, branch, 3)) {
                const auto a = requested_parameters({side}, 1);
                std::vector<Equilibrium> by_equilibrium, by_energy;
                const auto equilibrium = reference::equilibrium::solve(
                    side.model, side.branch, a, {},
                    [&](const auto& state) { by_equilibrium.push_back(state); });
                const auto energy = reference::energy::solve(
                    side.model, side.branch, a, {},
                    [&](const auto& state) { by_energy.push_back(state); });
                EXPECT_TRUE(equilibrium.points.empty() && energy.points.empty());
                const auto kept = reference::equilibrium::solve(side.model, side.branch, a);
                EXPECT_EQ(equilibrium.outcome, kept.outcome);
                expect_same(by_equilibrium, kept.points, scene + ", " + side.name);
                const auto kept_too = reference::energy::solve(side.model, side.branch, a);
                EXPECT_EQ(energy.outcome, kept_too.outcome);
                expect_same(by_energy, kept_too.points, scene + ", " + side.name);
            }
    }
}

struct Streamed {
    EquilibriumPath path;
    std::vector<Row> rows;
};
Streamed streamed(const Model& model, const std::vector<BranchSide>& sides,
                  const SolverSettings& solver) {
    const auto all = channels(model);
    Streamed result;
    result.path = solve_branch(
        sides, solver,
        [&](const Equilibrium& state) { return row_of(model, all, sides.front(), solver, state); },
        [&](Row row) { result.rows.push_back(std::move(row)); });
    return result;
}

bool same(const Row& row, const Model& model, const Equilibrium& state) {
    std::vector<double> values = evaluate(model, state);
    const auto outputs = channels(model);
    for (std::size_t c = 0; c < outputs.size(); ++c)  // a state alone does not have it
        if (outputs[c].kind() == ChannelKind::element) values[c] = row.values[c];
    return row.load == state.load && row.constraint_error == state.constraint_error &&
           std::ranges::equal(row.values, values, [](double a, double b) {
               return a == b || (std::isnan(a) && std::isnan(b));
           });
}

// The sides one by one: the first from its far end back to a = 0, then the second.
std::vector<Equilibrium> joined_by_hand(const std::vector<BranchSide>& sides,
                                        const SolverSettings& solver) {
    std::vector<Equilibrium> points;
    if (sides.size() == 2) {
        const auto first = solve_branch(sides[0], solver).points;
        for (std::size_t k = first.size(); k-- > 1;) points.push_back(first[k]);
    }
    for (const auto& point : solve_branch(sides.back(), solver).points) points.push_back(point);
    return points;
}

// How many branches have two sides.
int expect_rows_in_the_order_of_the_branch(const std::vector<std::string>& scenes) {
    int two_sided = 0;
    for (const auto& scene : scenes) {
        const Model model = compile(support::scene(scene));
        for (const auto& branch : model.branches) {
            const auto sides = sides_of(model, branch, 5);
            two_sided += sides.size() == 2 ? 1 : 0;
            for (const auto& solver : every_gait()) {
                // The references are slow, and one side needs no joining.
                if ((solver.leg == Leg::energy || solver.leg == Leg::equilibrium) &&
                    sides.size() == 1)
                    continue;
                const std::string where = scene + ", " + branch.name + " by " + name_of(solver);
                const auto points = joined_by_hand(sides, solver);
                const auto found = streamed(model, sides, solver);
                EXPECT_TRUE(found.path.points.empty()) << where;
                EXPECT_EQ(found.rows.size(), points.size()) << where;
                if (found.rows.size() != points.size()) continue;
                for (std::size_t k = 0; k < points.size(); ++k)
                    EXPECT_TRUE(same(found.rows[k], model, points[k])) << where << ", row " << k;
                expect_same(solve_branch(sides, solver).points, points, where);
                if (found.path.outcome != Outcome::converged) continue;
                const auto a = requested_parameters(sides, 1);
                EXPECT_EQ(a.size(), points.size()) << where;
                for (std::size_t k = 0; k < std::min(a.size(), points.size()); ++k)
                    EXPECT_EQ(points[k].load, a[k]) << where;
            }
        }
    }
    return two_sided;
}

TEST(ResultRows, AreWrittenInTheOrderOfTheBranch) {
    EXPECT_GE(expect_rows_in_the_order_of_the_branch({"mcpherson", "chrono_mcpherson_travel"}), 1);
}

TEST(NightlyResultRows, AreWrittenInTheOrderOfTheBranchOnEveryScene) {
    EXPECT_GT(expect_rows_in_the_order_of_the_branch(support::scene_names()), 20);
}

// Indices of the requested points among all: by sides, from a = 0 outwards.
std::vector<std::size_t> picked(const std::vector<BranchSide>& sides, int every) {
    std::vector<std::size_t> at;
    const int before = sides.size() == 2 ? sides[0].branch.steps : 0;
    for (std::size_t w = 0; w < sides.size(); ++w) {
        const int steps = sides[w].branch.steps, sign = w + 1 < sides.size() ? -1 : 1;
        for (int k = 0; k < steps; k += every)
            at.push_back(static_cast<std::size_t>(before + sign * k));
        at.push_back(static_cast<std::size_t>(before + sign * steps));
    }
    std::ranges::sort(at);
    at.erase(std::unique(at.begin(), at.end()), at.end());
    return at;
}

TEST(EveryNthRow, RecursionWritesTheFirstTheLastAndEveryNthRowUnchanged) {
    for (const auto* scene : {"bushing_pair", "double_wishbone", "pinned_bar"}) {
        const Model model = compile(support::scene(scene));
        for (const auto& branch : model.branches) {
            const auto sides = sides_of(model, branch, 20);
            for (const char* method : {"published", "tangent", "adaptive", "series"}) {
                SolverSettings solver{
                    .recursion = {.method = recursive::find_method(method).value()}};
                const auto all = streamed(model, sides, solver);
                if (all.path.outcome != Outcome::converged) continue;
                for (const int every : {1, 2, 3, 7, 9, 10, 11, 19, 20}) {
                    solver.every = every;
                    const auto some = streamed(model, sides, solver);
                    const auto at = picked(sides, every);
                    ASSERT_EQ(some.rows.size(), at.size())
                        << scene << " " << branch.name << " " << every;
                    for (std::size_t k = 0; k < at.size(); ++k) {
                        EXPECT_EQ(some.rows[k].load, all.rows[at[k]].load) << every << " " << k;
                        EXPECT_EQ(some.rows[k].values, all.rows[at[k]].values) << every << " " << k;
                    }
                    EXPECT_EQ(some.path.counts.factorisations, all.path.counts.factorisations)
                        << "every step is still taken";
                }
            }
        }
    }
}

TEST(EveryNthRow, ReferencesSolveOnlyTheRowsThatAreWritten) {
    for (const auto* scene : {"chrono_mcpherson", "bushing_pair"}) {
        const Model model = compile(support::scene(scene));
        const auto all_channels = channels(model);
        for (const auto& branch : model.branches) {
            const auto sides = sides_of(model, branch, 20);
            for (const Leg leg : {Leg::equilibrium, Leg::energy}) {
                const auto all = streamed(model, sides, {.leg = leg}),
                           some = streamed(model, sides, {.leg = leg, .every = 6});
                ASSERT_EQ(all.path.outcome, Outcome::converged) << all.path.detail;
                const auto at = picked(sides, 6);
                ASSERT_EQ(some.rows.size(), at.size());
                for (std::size_t k = 0; k < at.size(); ++k) {
                    EXPECT_EQ(some.rows[k].load, all.rows[at[k]].load);
                    for (std::size_t c = 0; c < all_channels.size(); ++c) {
                        if (!all_channels[c].main) continue;
                        EXPECT_NEAR(some.rows[k].values[c], all.rows[at[k]].values[c], 1e-7)
                            << name(leg) << " " << all_channels[c].name;
                    }
                }
                EXPECT_LT(some.path.counts.evaluations, all.path.counts.evaluations) << name(leg);
            }
        }
    }
}

TEST(ResultRows, RowsBeforeAFailureOnEitherSideAreKept) {
    Scene scene = support::scene("two_spring_arch");
    scene.branches.resize(1);
    scene.branches[0].from = -300;  // the limit is at -211.5 N
    scene.branches[0].to = 300;
    scene.branches[0].steps = 60;
    for (const bool fails_first : {true, false}) {
        const Model model = compile(scene);
        for (const Leg leg : {Leg::series, Leg::equilibrium}) {
            const auto sides = sides_of(model, model.branches[0]);
            const auto found = streamed(model, sides, {.leg = leg});
            EXPECT_NE(found.path.outcome, Outcome::converged);
            ASSERT_EQ(found.rows.size(), 52u) << name(leg);  // -210 to 300 N
            const double sign = fails_first ? 1 : -1;
            for (std::size_t k = 0; k < found.rows.size(); ++k)
                EXPECT_NEAR(found.rows[k].load,
                            fails_first ? -210 + 10.0 * static_cast<double>(k)
                                        : 300 - 10.0 * static_cast<double>(k),
                            1e-9)
                    << name(leg) << sign;
        }
        std::swap(scene.branches[0].from, scene.branches[0].to);
    }
}

TEST(ResultRows, StartIsWrittenOnceWhicheverSideIsSolved) {
    const Model model = compile(support::scene("bushing_pair"));
    Branch branch = model.branches[0];
    branch.from = -branch.to;
    branch.steps = 8;
    const auto good = sides_of(model, branch);
    const auto starts = [&](const std::vector<BranchSide>& sides) {
        const auto rows = streamed(model, sides, {.leg = Leg::equilibrium}).rows;
        return std::pair(rows.size(), std::ranges::count(rows, 0.0, &Row::load));
    };
    EXPECT_EQ(starts(good), std::pair(std::size_t{9}, std::ptrdiff_t{1}));
    for (const std::size_t bad : {0u, 1u}) {  // no point on it is found
        auto sides = good;
        for (auto& body : sides[bad].model.bodies) body.design.r.setConstant(std::nan(""));
        EXPECT_EQ(starts(sides), std::pair(std::size_t{5}, std::ptrdiff_t{1})) << bad;
    }
}

TEST(Landmarks, AreTheStatesAtTheEndsTheStartAndTheMiddleOfABranch) {
    for (const auto* scene :
         {"bushing_pair", "double_wishbone", "chrono_mcpherson", "pinned_bar"}) {
        const Model model = compile(support::scene(scene));
        for (const auto& branch : model.branches) {
            for (const int steps : {7, 8}) {
                const auto points =
                    solve_branch(sides_of(model, branch, steps), {.leg = Leg::equilibrium}).points;
                if (points.size() != static_cast<std::size_t>(steps) + 1) continue;
                const LegRun run = compare::run(model, branch, Leg::equilibrium, {.steps = steps});
                const auto& [front, start, middle, back] = run.landmarks;
                ASSERT_TRUE(front && start && middle && back);
                EXPECT_TRUE(same(*front, points.front())) << scene << " " << branch.name;
                EXPECT_TRUE(same(*start, points[run.curve.start])) << scene << " " << branch.name;
                EXPECT_TRUE(same(*middle, points[points.size() / 2]))
                    << scene << " " << branch.name;
                EXPECT_TRUE(same(*back, points.back())) << scene << " " << branch.name;
                // Summaries over all points equal those of the single points.
                const Model standing = sides_of(model, branch, steps).front().model;
                const Scale whole = scale_of(standing, branch, points);
                EXPECT_EQ(run.scale.force, whole.force);
                EXPECT_EQ(run.scale.length, whole.length);
                EXPECT_EQ(run.scale.round_off, whole.round_off);
            }
        }
    }
}

}  // namespace
}  // namespace elastocheck::compare
