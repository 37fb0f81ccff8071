// Independent jobs on several threads, and the solves that studies share.
#include "compare/jobs/jobs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <stdexcept>
#include <thread>

#include "compare/studies/order_study.hpp"
#include "compare/studies/study.hpp"
#include "compare/studies/work_precision.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

TEST(Jobs, EveryJobRunsOnceWithAnyNumberOfThreads) {
    for (const int threads : {1, 2, 3, 8}) {
        std::vector<int> ran(50, 0);
        std::vector<Job> jobs;
        for (auto& one : ran) jobs.push_back({"", [&] { ++one; }});
        run_jobs(jobs, threads, {});
        EXPECT_EQ(std::ranges::count(ran, 1), 50) << threads;
    }
    run_jobs({}, 3, {});
}

TEST(Jobs, FirstFailureIsThrownAndNoFurtherJobStarts) {
    for (const int threads : {1, 3}) {
        std::atomic<int> began = 0;
        std::vector<Job> jobs;
        for (int k = 0; k < 100; ++k)
            jobs.push_back({"", [&, k] {
                                ++began;
                                if (k == 4)
                                    std::this_thread::sleep_for(std::chrono::milliseconds(50));
                                if (k == 4 || k == 5) throw std::runtime_error(std::to_string(k));
                                // time for the thread of job 5 to throw, on a busy machine too
                                if (k > 5)
                                    std::this_thread::sleep_for(std::chrono::milliseconds(5));
                            }});
        try {
            run_jobs(jobs, threads, {});
            ADD_FAILURE() << "nothing thrown";
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "4") << threads;
        }
        EXPECT_LT(began, 100) << threads;
    }
}

TEST(Jobs, ProgressIsMonotonicAndReportedByOneThreadAtATime) {
    std::vector<Job> jobs;
    for (int k = 0; k < 40; ++k) jobs.push_back({"job " + std::to_string(k), [] {}});
    std::atomic<int> inside = 0;
    std::vector<double> done;
    run_jobs(jobs, 4,
             part(
                 [&](std::string_view what, double share) {
                     EXPECT_EQ(++inside, 1);
                     EXPECT_TRUE(what.starts_with("job "));
                     done.push_back(share);
                     --inside;
                 },
                 0.5, 1));
    ASSERT_EQ(done.size(), 40u);
    EXPECT_TRUE(std::ranges::is_sorted(done));
    EXPECT_EQ(done.front(), 0.5);
    EXPECT_LT(done.back(), 1);
}

// What the studies of a report read.
void run_studies(Solves& solves, int threads) {
    StudyOptions options{.methods = {recursive::Method{}, *recursive::find_method("tangent")},
                         .steps = {20, 40, 80, 160, 320},
                         .threads = threads};
    (void)study(solves, options);
    (void)attribute_gap(solves, {40, 80, 160, 320}, threads, {});
    (void)trade(solves, {.methods = {"published", "tangent"}, .rounds = 0, .threads = threads});
    (void)order_study(solves, {.orders = {4, 8}, .tolerances = {1e-6}, .threads = threads});
}

TEST(SharedSolves, StudiesOfAReportSolveEachBranchMethodAndStepCountOnce) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    for (const int threads : {1, 3}) {
        Solves solves(model, 10, 4);
        run_studies(solves, threads);
        std::map<std::string, int> of_references, of_legs, of_methods;
        for (const auto& [name, run] : solves.runs) {
            const bool references = name.ends_with("by the references");
            ++(references                               ? of_references
               : name.find("by recursive") == name.npos ? of_legs
                                                        : of_methods)[name];
            EXPECT_FALSE((references ? run.references.truth : run.curve).curve.a.empty()) << name;
        }
        const std::size_t sides = 2;  // jounce, rebound
        EXPECT_EQ(of_references.size(), sides);
        EXPECT_EQ(of_legs.size(), 2 * sides);  // their prices at ten points
        // Published and tangent with 20 ... 320 steps for the study, and with 10, 640, 1280, 2560
        // for the price; of the eight combinations of the gap one is published, with 40 ... 320.
        EXPECT_EQ(of_methods.size(), sides * (2 * 9 + 7 * 4));
        EXPECT_GT(solves.requests, static_cast<int>(solves.runs.size()));
    }
}

TEST(SharedSolves, StudyOfSharedSolvesEqualsASeparateStudy) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    Solves solves(model, 10, 4);
    const StudyOptions options{.steps = {20, 40, 80, 160, 320, 640}};
    const Study shared = study(solves, options), own = study(model, options);
    ASSERT_EQ(shared.branches.size(), own.branches.size());
    for (std::size_t b = 0; b < own.branches.size(); ++b)
        for (std::size_t c = 0; c < own.channels.size(); ++c) {
            const auto &one = shared.branches[b].methods[0].equal_parameter[c],
                       &other = own.branches[b].methods[0].equal_parameter[c];
            EXPECT_NEAR(one.gap, other.gap, 1e-9 + 1e-6 * std::abs(other.gap))
                << own.channels[c].name;
            for (std::size_t l = 0; l < own.steps.size(); ++l)
                EXPECT_NEAR(one.step_error_end[l], other.step_error_end[l],
                            1e-9 + 1e-6 * std::abs(other.step_error_end[l]))
                    << own.channels[c].name;
        }
    const Trade cheap = trade(solves, {.rounds = 0}), alone = trade(model, {.rounds = 0});
    ASSERT_EQ(cheap.points.size(), alone.points.size());
    for (std::size_t k = 0; k < alone.points.size(); ++k) {
        EXPECT_EQ(cheap.points[k].work.price, alone.points[k].work.price)
            << describe(alone.points[k]);
        EXPECT_EQ(cheap.points[k].outcome, alone.points[k].outcome);
        if (alone.points[k].outcome != Outcome::converged) continue;
        EXPECT_NEAR(cheap.points[k].error.mm, alone.points[k].error.mm, 1e-9)
            << describe(alone.points[k]);
    }
}

}  // namespace
}  // namespace elastocheck::compare
