// Interval proofs at corners: stops that close, at a point and along a branch.
#include "reference/certificate/state.hpp"
#include "tests/reference/certificate/sides.hpp"

namespace elastocheck::reference::certificate {
namespace {

// A slider on a spring k with a stop k_s at a distance c [N/mm, mm]: x = F / k up to k c, then
// (F + k_s c) / (k + k_s).
struct Slider {
    double k = 20, k_s = 400, c = 1;
    double at(double F) const { return F <= k * c ? F / k : (F + k_s * c) / (k + k_s); }
    Model model() const {
        return compile(support::scene_of(
            "reference/scenes/slider",
            {setting("springs.coil.rate", k), setting("springs.coil.bump_stop.clearance", c),
             setting("springs.coil.bump_stop.rate", k_s)}));
    }
};
struct OnSlider : Side {
    using Side::Side;
    // Closed form of the state of slider `other`.
    Equilibrium state(double F, const Slider& other) const {
        Equilibrium state = drawn(F);
        state.poses[0].r[2] += 1e-3 * other.at(F);
        return state;
    }
    Tube tube(const Slider& other, double step = 10, double last = 100) const {
        std::vector<Equilibrium> states;
        for (double F = 0; F <= last; F += step) states.push_back(state(F, other));
        return certify_branch(model, branch, states);
    }
};
OnSlider on_slider(const Slider& slider) { return OnSlider(slider.model()); }

TEST(CertifyBranch, TubeCrossesTheKnotOfAStopOfAnyStiffness) {
    for (const double k_s : {2., 400., 2e4, 2e6})
        for (const double c : {0., 0.3, 1., 4.99}) {
            const Slider slider{20, k_s, c};
            const Tube tube = on_slider(slider).tube(slider);
            EXPECT_EQ(tube.state, ProofState::proved) << k_s << " " << c << ": " << tube.detail;
            EXPECT_EQ(tube.to, 100) << k_s << " " << c;
            EXPECT_LE(tube.width.length, 1e-9) << k_s << " " << c;
        }
}

TEST(CertifyBranch, StatesOfAnotherStopAreNotProved) {
    const Slider slider;
    const OnSlider way = on_slider(slider);
    // Just before the corner the stop has no effect.
    EXPECT_EQ(way.tube(slider, 0.9999, 19.998).state, ProofState::proved);
    for (const Slider& other :
         {Slider{20, 400, 1 + 1e-5}, Slider{20, 400 * (1 + 1e-4), 1}, Slider{20, 0, 1}}) {
        EXPECT_EQ(way.tube(other, 0.9999, 19.998).state, ProofState::proved);
        const Tube wrong = way.tube(other);
        EXPECT_EQ(wrong.state, ProofState::open) << other.c << " " << other.k_s;
        EXPECT_NE(wrong.detail.find("beyond the tolerance"), std::string::npos) << wrong.detail;
    }
}

// With a slope of -k_n beyond the corner: no equilibrium continues beyond that load, the curve
// turns back.
TEST(CertifyBranch, TubeEndsAtAForceCurveKnotWhereTheBranchTurnsBack) {
    for (const double k_n : {25., 40., 1000.}) {
        const Slider slider;
        OnSlider way = on_slider(slider);
        int found = 0;
        for (auto& elastic : way.model.elastics)
            if (auto* spring = std::get_if<AxialSpring>(&elastic.kind))
                if (auto* curve = std::get_if<Curve>(&spring->law)) {
                    for (auto& piece : curve->pieces) piece[1] *= -k_n / slider.k_s;
                    ++found;
                }
        ASSERT_EQ(found, 1);
        EXPECT_EQ(way.tube(slider, 0.9999, 19.998).state, ProofState::proved);
        const Tube tube = way.tube({20, 0, 1});
        EXPECT_EQ(tube.state, ProofState::open) << k_n;
        EXPECT_NEAR(tube.to, 20, 1e-5) << k_n;
    }
    // Slightly less than the holding stiffness: soft, and the branch continues.
    OnSlider soft = on_slider({20, 400, 1});
    for (auto& elastic : soft.model.elastics)
        if (auto* curve = std::get_if<Curve>(&std::get<AxialSpring>(elastic.kind).law))
            for (auto& piece : curve->pieces) piece[1] *= -10. / 400;
    EXPECT_EQ(soft.tube({20, -10, 1}).state, ProofState::proved);
}

TEST(Certificate, PointOnACornerIsProvedAndAPerturbedOneIsExcluded) {
    for (const double k_s : {400., 2e4, 2e6}) {
        const Slider slider{20, k_s, 1};
        const OnSlider way = on_slider(slider);
        for (const double by : {0., 1e-12, -1e-12, 1e-9, -1e-9, 1e-3, -1e-3}) {
            const Certificate c = way.certify(way.state(20 + by, slider));
            EXPECT_EQ(c.state, ProofState::proved) << k_s << " " << by << ": " << c.detail;
            // 1e-9 N beyond the corner a stop of 2e9 N/m is compressed by 5e-19 m: doubles cannot
            // resolve the side.
            EXPECT_TRUE(c.stable || k_s > 1e6) << k_s << " " << by;
            EXPECT_GT(c.unique.length, c.error.length) << k_s << " " << by;
        }
        for (const double by : {1e-8, -1e-8, 1e-6, -1e-6}) {
            Equilibrium wrong = way.state(20, slider);
            wrong.poses[0].r[2] += by;
            const Certificate c = way.certify(wrong);
            EXPECT_EQ(c.state, ProofState::excluded) << k_s << " " << by << ": " << c.detail;
        }
    }
}

// An arm on one bushing that is soft at first in all directions, and at its corner in some.
Side cornered(const Formulation& formulation) {
    Side at = side_of("arm_on_a_bushing");
    auto& bushing = std::get<Bushing>(at.model.elastics[0].kind);
    bushing.formulation = formulation;
    const auto K = std::get<LinearStiffness>(bushing.law).K;
    PerAxis law;
    for (int k = 0; k < 6; ++k) {
        const double soft = K(k, k), corner = k < 3 ? 1e-4 : 0.02;
        const auto stiffer = [&](double by, double from) {
            return std::array<double, 4>{soft * from, soft * by, 0, 0};
        };
        law.axis[static_cast<std::size_t>(k)] = Curve{
            {-corner, corner}, {stiffer(40, -corner), stiffer(1, -corner), stiffer(30, corner)}};
    }
    bushing.law = law;
    return at;
}

TEST(CertificateEquations, ElementWithASeparateUnknownAtItsCornerHasTheSameSolutions) {
    using F = Formulation;
    for (const auto angles : {F::Angles::rotation_vector, F::Angles::cardan, F::Angles::projected})
        for (const auto frame : {F::Frame::on_i, F::Frame::middle})
            for (const bool conjugate : {true, false})
                for (const bool offset : {true, false}) {
                    if (frame == F::Frame::middle && !conjugate) continue;
                    const Side at = cornered({frame, angles, conjugate, offset});
                    const System plain = make_system(at.model, at.branch),
                                 apart = make_system(at.model, at.branch, Curves::separated);
                    ASSERT_EQ(apart.separated.size(), 6U);
                    Equilibrium state = at.drawn(70);
                    state.poses[0].r += Eigen::Vector3d(2e-3, 5e-5, -3e-4);
                    state.poses[0].p = Eigen::Quaterniond(Eigen::AngleAxisd(
                                           0.3, Eigen::Vector3d(1, -2, 0.02).normalized())) *
                                       state.poses[0].p;
                    const auto of = [&](const System& system) {
                        return evaluate(system, thin(state_at(system, state).z),
                                        Interval(state.load), Slopes::no)
                            .E;
                    };
                    const auto E = of(plain), E_apart = of(apart);
                    for (std::size_t row = 0; row < 6; ++row) {
                        // x and f are doubles: their rounding times the largest slope.
                        EXPECT_LT(mag(E[row] - E_apart[row]), 1e-7 * (1 + mag(E[row]))) << row;
                        EXPECT_GT(mag(E[row]), 1e-3) << row;
                    }
                    for (std::size_t row = 6; row < 18; ++row)
                        EXPECT_LT(mag(E_apart[row]), 1e-7) << row;
                }
}

TEST(CertifyBranch, TubeCrossesTheKnotsOfABushingOneAfterAnother) {
    const Side at = cornered({});
    std::vector<double> loads;
    for (int k = 0; k <= 60; ++k) loads.push_back(10. * k);
    const EquilibriumPath path = equilibrium::solve(at.model, at.branch, loads);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    const Tube tube = certify_branch(at.model, at.branch, path.points);
    EXPECT_EQ(tube.state, ProofState::proved) << tube.detail;
    EXPECT_GE(tube.knots, 3);
    for (const auto& point : path.points) {
        const Certificate c = at.certify(point);
        EXPECT_EQ(c.state, ProofState::proved) << point.load << c.detail;
        EXPECT_TRUE(c.stable) << point.load;
    }
}

// Slider and rider move by 50 mm, and relative to each other by half of the way to a knot.
TEST(CertifyBranch, KnotThatNoDeformationReachesDoesNotShortenThePiecesOfATube) {
    const Side at = side_of("rider_on_a_slider");
    const auto path = equilibrium::solve(at.model, at.branch, std::vector<double>{0, 10, 25});
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    const Tube tube = certify_branch(at.model, at.branch, path.points);
    EXPECT_EQ(tube.state, ProofState::proved) << tube.detail;
    EXPECT_LT(tube.pieces, 20);
    EXPECT_EQ(tube.knots, 0);
}

// Every piece would have to cross the corner, without end.
TEST(CertifyBranch, BranchAtRestOnAKnotIsProvedOrReportedAsOpen) {
    const Side at = side_of("corner_at_rest");
    const auto path =
        equilibrium::solve(at.model, at.branch, std::vector<double>{0, 100, 200, 300});
    ASSERT_EQ(path.outcome, Outcome::converged);
    const Tube tube = certify_branch(at.model, at.branch, path.points);
    EXPECT_TRUE(tube.state == ProofState::proved ||
                tube.detail.find("stays on a knot") != tube.detail.npos)
        << tube.detail;
}

struct Proved {
    int ways = 0, with_corners = 0;
};
Proved prove_every_way(const std::vector<std::string>& scenes) {
    Proved count;
    for (const auto& scene : scenes)
        for (const auto& walk : walked(scene, 4)) {
            const Tube tube = certify_branch(walk.model, walk.branch, walk.points);
            EXPECT_EQ(tube.state, ProofState::proved)
                << scene << " '" << walk.branch.name << "': " << tube.detail;
            EXPECT_LE(tube.width.length, 1e-9) << scene << " " << walk.branch.name;
            ++count.ways;
            count.with_corners += static_cast<int>(tube.knots > 0);
        }
    return count;
}

TEST(CertifyBranch, EverySideOfSomeBuiltInScenesIsProvedToBeOneCurve) {
    const Proved proved = prove_every_way({"mcpherson", "double_wishbone", "tyre_on_road"});
    EXPECT_GE(proved.ways, 10);
    EXPECT_GE(proved.with_corners, 3);
}

TEST(NightlyCertifyBranch, EverySideOfEveryBuiltInSceneIsProvedToBeOneCurve) {
    const Proved proved = prove_every_way(support::scene_names());
    EXPECT_GE(proved.ways, 177);
    EXPECT_GE(proved.with_corners, 41);
}

}  // namespace
}  // namespace elastocheck::reference::certificate
