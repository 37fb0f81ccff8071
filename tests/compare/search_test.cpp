// Searches of compare/design/ that go from one point to the next: figures from the states of a
// neighbour, the best point so far.
#include "tests/compare/design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>

#include "compare/design/optimise.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::VectorXd;

// Starts from the states and the trim of a scene that differs by a tenth of the range, and by the whole range.
TEST(Figures, FiguresSolvedFromANeighbourEqualThoseFromTheDesignPosition) {
    for (const auto& [name, path, from, to] :
         {std::tuple{"mcpherson", "points.tie_rod_inner.z", -0.015, 0.005},
          {"double_wishbone", "points.tie_rod_inner.z", 0.001, 0.011}}) {
        const Varied varied = varied_of(name, {path});
        const Model model = compile(trim(varied.scene(list_of({from}))).scene);
        const std::string& branch = model.branches.front().name;
        const double end = model.branches.front().to;
        const std::vector<Figure> figures{
            {.name = "toe", .branch = branch, .station = end},
            {.name = "toe", .branch = branch, .station = 0},
            {.name = "bump_steer", .branch = branch, .station = end / 2},
            {"camber", branch, 20, "travel", true}};
        const Figures near = solved_figures(varied, figures, 2);
        (void)near.value(list_of({from}));
        for (const double share : {0.1, 1.}) {
            const VectorXd p = list_of({from + share * (to - from)});
            const VectorXd there = near.value(p),
                           anew = figure_values(varied.scene(p), figures).value;
            EXPECT_LE((there - anew).cwiseAbs().maxCoeff(), 1e-7) << name << " " << share;
        }
    }
}

TEST(Figures, StatesAreReusedOnlyByModelsThatDifferLittle) {
    const auto model_at = [](const char* path, double value) {
        const Setting set = setting(path, value);
        return compile(read_scene(ELASTOCHECK_SCENES "/mcpherson.yaml", std::span(&set, 1)));
    };
    const Model here = model_at("points.tie_rod_inner.z", -0.015),
                near = model_at("points.tie_rod_inner.z", -0.0145),
                far = model_at("points.strut_top.z", 0.3),
                other = model_at("springs.K1_coil.rate", 0);
    const std::vector<Figure> figures{{.name = "toe", .branch = "jounce", .station = 3000},
                                      {.name = "toe", .branch = "rebound", .station = -3000}};
    const auto states = states_of(here, figures, Leg::equilibrium);
    const std::array<const Model*, 4> models{&near, nullptr, &far, &other};
    const auto moved = neighbouring_states(states, models, 2);
    EXPECT_EQ(moved[0].size(), states.size());
    for (const std::size_t k : {1, 2, 3}) EXPECT_TRUE(moved[k].empty()) << k;
    const VectorXd from_near = read_figures(near, moved[0], figures, Leg::equilibrium).value,
                   anew = evaluate(near, figures, Leg::equilibrium).value;
    EXPECT_LE((from_near - anew).cwiseAbs().maxCoeff(), 1e-9);
}

// Wherever the first search is interrupted, its caller has the point nearest to the bands, or the best within them.
TEST(Optimise, InterruptedFirstSearchLeavesTheBestPointSoFar) {
    const SearchRange range{list_of({0.6, 0.8}), list_of({-5, -5}), list_of({5, 5})};
    double last = 1;
    for (int calls = 10; calls <= 60; calls += 5) {
        int left = calls;
        VectorXd best = range.start;
        const Figures interrupted = closed(
            [&](const VectorXd& p) {
                if (--left < 0) throw std::domain_error("as planned");
                return list_of({p.norm()});
            },
            2);
        const auto search = [&] {
            (void)optimise(interrupted, {.low = list_of({2}), .high = list_of({3}), .goal = {0}},
                           range, {range.start}, {}, [&](const VectorXd& p, bool met) {
                               EXPECT_EQ(met, p.norm() >= 2 - 1e-8);
                               best = p;
                           });
        };
        EXPECT_THROW(search(), std::domain_error) << calls;
        EXPECT_GE(best.norm(), std::min(last, 2 - 1e-8)) << calls;
        last = best.norm();
    }
    EXPECT_NEAR(last, 2, 1e-3);
}

// Recorded from searches in which every evaluation was solved from the design position.
TEST(Optimise, ResultEqualsThatOfASearchThatSolvesEveryPointFromTheDesignPosition) {
    const Varied varied =
        varied_of("double_wishbone", {"points.tie_rod_inner.z", "points.upper_front.z"},
                  list_of({-0.02, 0.18}), list_of({0.02, 0.3}));
    std::vector<Figure> figures;
    for (int k = -2; k <= 2; ++k) figures.push_back({"toe", "travel", 30. * k, "travel", true});
    const Optimum found = optimise(solved_figures(varied, figures, 2),
                                   {.low = VectorXd::Constant(5, -0.1),
                                    .high = VectorXd::Constant(5, 0.15),
                                    .goal = std::vector<int>(5, 0)},
                                   varied, {varied.start});
    EXPECT_TRUE(found.met && found.converged);
    EXPECT_NEAR(found.p[0], 0.0014304808573889452, 1e-8);
    EXPECT_NEAR(found.p[1], 0.24213592307892978, 1e-8);
    ASSERT_EQ(found.active.size(), 1u);
    EXPECT_NEAR(found.active[0].price, 0.3337263273941116, 1e-6);
}

}  // namespace
}  // namespace elastocheck::compare
