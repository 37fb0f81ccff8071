// Stops that close: what is proved on the corner of a law, and of a branch that goes over it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "compare/legs.hpp"
#include "compare/trim.hpp"
#include "models/branch.hpp"
#include "models/compile.hpp"
#include "models/reader/scene_file.hpp"
#include "reference/certificate/certificate.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reference::certificate {
namespace {

// A slider on a spring k, and a stop k_s that is c away [N/mm, mm]: x = F / k up to k c, then (F + k_s c) / (k + k_s).
struct Slider {
    double k = 20, k_s = 400, c = 1;
    double at(double F) const { return F <= k * c ? F / k : (F + k_s * c) / (k + k_s); }
    std::string scene() const {
        return fmt::format(
            "elastocheck: 1\nname: slider\nunits: {{length: mm, angle: rad, force: N}}\n"
            "points: {{seat: [0, 0, 0], top: [0, 0, 300]}}\nbodies: {{slider: {{origin: seat}}}}\n"
            "joints: {{guide: {{type: translational, bodies: [slider, ground], at: seat, axis: z}}}}\n"
            "springs: {{coil: {{bodies: [slider, ground], from: seat, to: top, rate: {}, bump_stop: "
            "{{clearance: {}, rate: {}}}}}}}\n"
            "loads: {{lift: {{on: slider, at: seat, force: [0, 0, 1]}}}}\n"
            "branches: {{lift: {{load: lift, to: 100, steps: 10}}}}\n"
            "probes: {{seat: {{on: slider, at: seat}}}}\n",
            k, c, k_s);
    }
};
struct On {
    Model model;
    Branch branch;
    // By the closed form, as if the slider were of `other`.
    Equilibrium state(double F, const Slider& other) const {
        Equilibrium state;
        state.load = F;
        state.poses = {model.bodies[0].design};
        state.poses[0].r[2] += 1e-3 * other.at(F);
        state.reactions.resize(model.joints.size());
        return state;
    }
    Tube tube(const Slider& other, double step = 10, double last = 100) const {
        std::vector<Equilibrium> states;
        for (double F = 0; F <= last; F += step) states.push_back(state(F, other));
        return certify_branch(model, branch, states);
    }
};
On on(const Slider& slider) {
    const Model model = compile(parse_scene(slider.scene(), "test.yaml"));
    const Branch way = ways(model.branches.front()).front();
    return {on_branch(model, way), way};
}

TEST(CertifyBranch, GoesThroughAStopThatClosesHoweverStiffItIs) {
    for (const double k_s : {2., 400., 2e4, 2e6})
        for (const double c : {0., 0.3, 1., 4.99}) {
            const Slider slider{20, k_s, c};
            const Tube tube = on(slider).tube(slider);
            EXPECT_EQ(tube.answer, Answer::proved) << k_s << " " << c << ": " << tube.detail;
            EXPECT_EQ(tube.to, 100) << k_s << " " << c;
            EXPECT_LE(tube.width.length, 1e-9) << k_s << " " << c;
        }
}

TEST(CertifyBranch, ItsCurveIsThatOfTheStopThatIsThere) {
    const Slider slider;
    const On way = on(slider);
    // Just before the corner nobody knows of the stop.
    EXPECT_EQ(way.tube(slider, 0.9999, 19.998).answer, Answer::proved);
    for (const Slider& other :
         {Slider{20, 400, 1 + 1e-5}, Slider{20, 400 * (1 + 1e-4), 1}, Slider{20, 0, 1}}) {
        EXPECT_EQ(way.tube(other, 0.9999, 19.998).answer, Answer::proved);
        const Tube wrong = way.tube(other);
        EXPECT_EQ(wrong.answer, Answer::open) << other.c << " " << other.k_s;
        EXPECT_NE(wrong.detail.find("more than the tolerance"), std::string::npos) << wrong.detail;
    }
}

// Its law with a slope of -k_n behind the corner instead: beyond the load there no equilibrium goes on, the curve turns back.
TEST(CertifyBranch, ACornerWhereTheCurveTurnsBackIsNotGoneThrough) {
    for (const double k_n : {25., 40., 1000.}) {
        const Slider slider;
        On way = on(slider);
        int found = 0;
        for (auto& elastic : way.model.elastics)
            if (auto* spring = std::get_if<AxialSpring>(&elastic.kind))
                if (auto* curve = std::get_if<Curve>(&spring->law)) {
                    for (auto& piece : curve->pieces) piece[1] *= -k_n / slider.k_s;
                    ++found;
                }
        ASSERT_EQ(found, 1);
        EXPECT_EQ(way.tube(slider, 0.9999, 19.998).answer, Answer::proved);
        const Tube tube = way.tube({20, 0, 1});
        EXPECT_EQ(tube.answer, Answer::open) << k_n;
        EXPECT_NEAR(tube.to, 20, 1e-5) << k_n;
    }
    // A little less than what holds it: soft, and it goes on.
    On soft = on({20, 400, 1});
    for (auto& elastic : soft.model.elastics)
        if (auto* curve = std::get_if<Curve>(&std::get<AxialSpring>(elastic.kind).law))
            for (auto& piece : curve->pieces) piece[1] *= -10. / 400;
    EXPECT_EQ(soft.tube({20, -10, 1}).answer, Answer::proved);
}

TEST(Certificate, APointOnTheCornerIsProvedAndOneBesideItIsNot) {
    for (const double k_s : {400., 2e4, 2e6}) {
        const Slider slider{20, k_s, 1};
        const On way = on(slider);
        for (const double by : {0., 1e-12, -1e-12, 1e-9, -1e-9, 1e-3, -1e-3}) {
            const Certificate c = certify(way.model, way.branch, way.state(20 + by, slider));
            EXPECT_EQ(c.answer, Answer::proved) << k_s << " " << by << ": " << c.detail;
            // 1e-9 N beyond the corner a stop of 2e9 N/m is 5e-19 m in: no double tells which side that is.
            EXPECT_TRUE(c.stable || k_s > 1e6) << k_s << " " << by;
            EXPECT_GT(c.unique.length, c.error.length) << k_s << " " << by;
        }
        for (const double by : {1e-8, -1e-8, 1e-6, -1e-6}) {
            Equilibrium wrong = way.state(20, slider);
            wrong.poses[0].r[2] += by;
            const Certificate c = certify(way.model, way.branch, wrong);
            EXPECT_EQ(c.answer, Answer::excluded) << k_s << " " << by << ": " << c.detail;
        }
    }
}

TEST(CertifyBranch, EveryWayOfEveryBuiltInSceneIsOneCurve) {
    int ways = 0, with_corners = 0;
    for (const auto& scene : support::scene_names()) {
        const Model model = compile(compare::trim(support::scene(scene)).scene);
        for (const auto& branch : model.branches)
            for (const auto& way : compare::ways_of(model, branch, 4)) {
                compare::Gait gait;
                gait.leg = compare::Leg::equilibrium;
                const EquilibriumPath path = compare::walk(way, gait);
                ASSERT_EQ(path.outcome, Outcome::converged) << scene << " " << way.name << path.detail;
                const Tube tube = certify_branch(way.model, way.branch, path.points);
                EXPECT_EQ(tube.answer, Answer::proved) << scene << " '" << way.name << "': " << tube.detail;
                EXPECT_LE(tube.width.length, 1e-9) << scene << " " << way.name;
                ++ways;
                with_corners += static_cast<int>(tube.corners > 0);
            }
    }
    EXPECT_GE(ways, 177);
    EXPECT_GE(with_corners, 44);
}

}  // namespace
}  // namespace elastocheck::reference::certificate
