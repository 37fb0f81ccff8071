// Error decomposition: step error, formulation gap, reference uncertainty, and attribution
// of the gap.
#include "compare/studies/study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "compare/comparison/legs.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/quadrature.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

StudyOptions options(std::vector<std::string_view> names = {"published"}) {
    StudyOptions o;
    o.methods.clear();
    for (const auto name : names) o.methods.push_back(*recursive::find_method(name));
    o.steps = {50, 100, 200, 400, 800};
    return o;
}

TEST(Study, StepErrorAndFormulationGapOfAPinnedBarEqualTheirClosedForm) {
    // Pinned bar: own limit k L θ = F cos θ, truth k L tan θ = F; both in closed form.
    const Study s = study(compile(support::scene("pinned_bar")), options());
    const double own = support::root([](double t) { return 1e4 * t - 5000 * std::cos(t); }, 0, 1.5),
                 truth = std::atan(0.5);
    const auto& z = s.branches[0].methods[0].equal_parameter[2];
    EXPECT_EQ(s.channels[2].name, "tip_z");
    EXPECT_EQ(z.end.behaviour, Behaviour::converging);
    EXPECT_NEAR(z.end.order, 1, 0.05);
    const double gap = 500 * (std::sin(own) - std::sin(truth));
    EXPECT_NEAR(z.gap, gap, z.end.band);
    EXPECT_NEAR(z.gap, gap, 1e-3 * std::abs(gap));
    EXPECT_NEAR(z.step_error_end[0] / z.step_error_end[1], 2, 0.1);
    // At equal travel a bar has no error.
    EXPECT_LE(std::abs(s.branches[0].methods[0].equal_abscissa[0].gap), 1e-6);
}

// Curves with the error (1 - a) h² + h³: the coefficient of h² is zero at the end, where the values
// fall with h³.
TEST(Study, OrderIsThatOfTheLargestErrorOnTheBranch) {
    const Model model = compile(support::scene("bushing_pair"));
    const auto all = motion(model);
    const std::vector<int> steps{10, 20, 40, 80, 160, 320};
    const auto made = [&](double h) {
        Curve curve;
        curve.unit = Unit::newton;
        for (int k = 0; k <= 60; ++k) {
            const double a = k / 60., error = 3 * (1 - a) * a * h * h + a * h * h * h;
            append(curve, a, std::vector<double>(all.size(), a + error));
        }
        return curve;
    };
    References known;
    known.truth.curve = known.other.curve = made(0);
    std::vector<Curve> levels;
    for (const int N : steps) levels.push_back(made(1. / N));
    MethodStudy study;
    study_levels(study, all, {0}, {steps, levels, known, 2});
    const ChannelStudy& found = study.equal_parameter.front();
    EXPECT_EQ(found.behaviour, Behaviour::converging);
    EXPECT_NEAR(found.end.order, 3, 0.05);
    EXPECT_NEAR(found.order.order, 2, 0.02);
    EXPECT_LE(found.order.order_error, 0.02);
    EXPECT_TRUE(found.as_formal);
    EXPECT_TRUE(found.zero_at_end);
    for (std::size_t l = 1; l < steps.size(); ++l)
        EXPECT_NEAR(found.step_error_max[l - 1] / found.step_error_max[l], 4, 0.15);
}

// Of every converging output the printed errors fall as the printed order says.
TEST(Study, ReportedErrorsFallAtTheReportedOrder) {
    int compared = 0;
    for (const char* name : {"bushing_pair", "chrono_mcpherson"}) {
        const Study s = study(compile(support::scene(name)), options({"published", "tangent"}));
        for (const auto& branch : s.branches)
            for (const auto& method : branch.methods)
                for (const auto* reading : {&method.equal_parameter, &method.equal_abscissa})
                    for (const auto& channel : *reading) {
                        if (channel.behaviour != Behaviour::converging) continue;
                        const auto& fit = channel.order;
                        ASSERT_GE(fit.count, 2) << name;
                        const auto last = static_cast<std::size_t>(fit.first + fit.count - 1);
                        const auto first = static_cast<std::size_t>(fit.first);
                        const double whole = std::log2(channel.step_error_max[first] /
                                                       channel.step_error_max[last]) /
                                             (fit.count - 1);
                        EXPECT_NEAR(fit.order, whole,
                                    0.02 + (fit.count > 2 ? 2 * fit.order_error : 0))
                            << name;
                        ++compared;
                    }
    }
    EXPECT_GT(compared, 30);
}

TEST(Study, PublishedRecursionOfASceneWithoutStoredLeversHasNoGap) {
    const Study s = study(compile(support::scene("pendulum")), options());
    for (const auto& branch : s.branches)
        for (const auto& channel : branch.methods[0].equal_parameter)
            EXPECT_LE(std::abs(channel.gap), channel.end.band + 1e-9);
}

TEST(Study, MethodsConvergeAtTheirOrderAndConsistentOnesHaveNoGap) {
    const Study s = study(compile(support::scene("bushing_pair")),
                          options({"published", "balanced", "tangent", "chord", "midpoint"}));
    const double orders[] = {1, 1, 2, 3, 3};
    for (std::size_t m = 0; m < 5; ++m) {
        const auto& nose = s.branches[0].methods[m].equal_parameter[2];
        if (nose.end.behaviour == Behaviour::converging) {
            EXPECT_NEAR(nose.end.order, orders[m], 0.15) << s.branches[0].methods[m].method;
        } else {
            EXPECT_EQ(nose.end.behaviour, Behaviour::round_off_floor)
                << s.branches[0].methods[m].method;
        }
        if (m > 0) {
            EXPECT_LE(std::abs(nose.gap), nose.end.band + 1e-9) << s.branches[0].methods[m].method;
        }
    }
    EXPECT_GT(std::abs(s.branches[0].methods[0].equal_parameter[2].gap), 0.05);
}

TEST(Study, ConstraintErrorOfEquation31FallsWithTheStepsWhileTheGapStays) {
    const Study s = study(compile(support::scene("chrono_mcpherson")), options());
    for (const auto& branch : s.branches) {
        const auto& m = branch.methods[0];
        EXPECT_NEAR(m.constraint_order.order, 1, 0.05);
        EXPECT_LT(m.constraint_error.back(), 1e-4);          // [m]: falls with the steps
        EXPECT_GT(std::abs(m.equal_parameter[2].gap), 1.0);  // [mm]: does not fall
        EXPECT_LE(m.equal_parameter[2].uncertainty, 1e-6);
        EXPECT_GT(m.equal_parameter[2].gap_exponent, 1.2);
    }
}

TEST(Study, GapPartsSumToTheGapWithoutRemainder) {
    for (const char* name : {"chrono_mcpherson", "bushing_pair", "pinned_bar", "two_spring_arch"}) {
        for (const auto& branch : attribute_gap(compile(support::scene(name)))) {
            ASSERT_TRUE(branch.not_attributed.empty()) << name << ": " << branch.not_attributed;
            for (const auto* reading : {&branch.equal_parameter, &branch.equal_abscissa})
                for (const auto& share : *reading) {
                    EXPECT_NEAR(share.whole, share.lever + share.axis + share.load + share.rest,
                                1e-10)
                        << name;
                    EXPECT_LE(std::abs(share.rest), share.band) << name;
                }
        }
    }
}

TEST(Study, LoadContributesToTheGapOnlyIfItHasALever) {
    // On the strut the load acts at the body's origin; on the bar it has a lever.
    for (const auto& share :
         attribute_gap(compile(support::scene("chrono_mcpherson")))[0].equal_parameter)
        EXPECT_LE(std::abs(share.load), 1e-9);
    EXPECT_GT(
        std::abs(attribute_gap(compile(support::scene("pinned_bar")))[0].equal_parameter[2].load),
        1.0);
}

TEST(Study, DivergingMethodIsReportedWithoutAnOrder) {
    Scene scene = support::scene("pendulum");
    for (auto& branch : scene.branches) branch.to *= 2;
    const Study s = study(compile(scene), options());
    for (const auto& branch : s.branches) {
        EXPECT_NE(branch.methods[0].not_studied.find("diverged"), std::string::npos)
            << branch.methods[0].not_studied;
        EXPECT_TRUE(branch.methods[0].equal_parameter.empty());
    }
    EXPECT_FALSE(s.conclusive());
}

TEST(Study, FailedReferencesMakeTheStudyInconclusive) {
    Scene scene = support::scene("two_spring_arch");
    scene.branches[0].to = -300;
    const Study s = study(compile(scene), options());
    EXPECT_FALSE(s.conclusive());
    ASSERT_FALSE(s.inconclusive.empty());
    EXPECT_FALSE(Study{}.conclusive());
    scene.branches[0].to = nan;
    EXPECT_FALSE(study(compile(scene), options()).conclusive());
}

TEST(Study, FewerThanFiveOrUnorderedStepCountsAreRejected) {
    const Model model = compile(support::scene("single_bushing"));
    for (const std::vector<int>& steps : {std::vector<int>{10, 20, 40, 80},
                                          {10, 20, 40, 80, 80},
                                          {0, 1, 2, 3, 4},
                                          {5, 4, 3, 2, 1}}) {
        StudyOptions o = options();
        o.steps = steps;
        EXPECT_THROW((void)study(model, o), std::invalid_argument);
    }
}

TEST(Study, LimitDoesNotDependOnTheStepRatio) {
    const Model model = compile(support::scene("bushing_pair"));
    StudyOptions other = options();
    other.steps = {37, 61, 100, 173, 300, 555};
    const auto a = study(model, options()).branches[0].methods[0].equal_parameter[2],
               b = study(model, other).branches[0].methods[0].equal_parameter[2];
    EXPECT_NEAR(a.end.limit, b.end.limit, a.end.band + b.end.band);
    EXPECT_NEAR(a.gap, b.gap, 1e-4 * std::abs(a.gap));
}

TEST(Study, GapPartsSumToTheGapForAnUnbalancedDesign) {
    // The preloaded strut settles before the branch: the remainder with all terms following is
    // within its band, and the whole is the gap of the study.
    const Model model = compile(support::scene("chrono_mcpherson_preload"));
    const Study s = study(model, options());
    const auto attribution = attribute_gap(model);
    ASSERT_EQ(attribution.size(), s.branches.size());
    for (std::size_t b = 0; b < s.branches.size(); ++b) {
        ASSERT_TRUE(attribution[b].not_attributed.empty()) << attribution[b].not_attributed;
        EXPECT_EQ(attribution[b].branch, s.branches[b].branch);
        EXPECT_EQ(s.branches[b].abscissa, "travel");
        for (const auto& [shares, studied, why] :
             {std::tuple{&attribution[b].equal_parameter, &s.branches[b].methods[0].equal_parameter,
                         ""},
              {&attribution[b].equal_abscissa, &s.branches[b].methods[0].equal_abscissa,
               attribution[b].no_abscissa.c_str()}}) {
            ASSERT_EQ(shares->size(), s.channels.size()) << why;
            ASSERT_EQ(studied->size(), s.channels.size()) << s.branches[b].methods[0].no_abscissa;
            for (std::size_t c = 0; c < shares->size(); ++c) {
                const GapShare& share = (*shares)[c];
                EXPECT_NEAR(share.whole, share.lever + share.axis + share.load + share.rest, 1e-10);
                EXPECT_LE(std::abs(share.rest), share.band) << s.channels[c].name;
            }
        }
        // bit 2: the load follows, as in the published method
        for (std::size_t c = 0; c < s.channels.size(); ++c) {
            const auto& published = s.branches[b].methods[0].equal_parameter[c];
            EXPECT_NEAR(attribution[b].equal_parameter[c].combinations[4], published.gap,
                        attribution[b].equal_parameter[c].band + published.end.band)
                << s.channels[c].name;
        }
    }
}

TEST(Study, BranchWithTwoSidesIsStudiedAsTwo) {
    Scene scene = support::scene("bushing_pair");
    scene.branches.resize(1);
    scene.branches[0].from = -scene.branches[0].to;
    scene.branches[0].name = "both";
    const Study s = study(compile(scene), options());
    ASSERT_EQ(s.branches.size(), 2u);
    EXPECT_TRUE(s.branches[0].branch.starts_with("both to -")) << s.branches[0].branch;
    for (const auto& side : s.branches) {
        EXPECT_EQ(side.belongs_to, "both");
        EXPECT_EQ(side.steps, (std::vector<int>{25, 50, 100, 200, 400}));
        EXPECT_EQ(side.methods[0].equal_parameter[2].end.behaviour, Behaviour::converging);
    }
    EXPECT_TRUE(s.conclusive());
}

TEST(Study, BranchWithoutMovementIsNotStudied) {
    Scene scene = support::scene("pinned_bar");
    for (auto& driver : scene.branches[0].drivers)
        std::get<DeadForce>(std::get<Load>(driver.what).kind).f.setZero();
    const Study s = study(compile(scene), options());
    EXPECT_FALSE(s.conclusive());
    ASSERT_FALSE(s.inconclusive.empty());
    EXPECT_NE(s.inconclusive[0].find("nothing drives branch"), std::string::npos)
        << s.inconclusive[0];
}

}  // namespace
}  // namespace elastocheck::compare
