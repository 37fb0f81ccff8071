// Equations of the certificate: exact stored numbers, redundant joints,
// knots, formulations, followers.
#include "reference/certificate/interval/laws.hpp"
#include "reference/certificate/stability.hpp"
#include "reference/certificate/state.hpp"
#include "tests/reference/certificate/sides.hpp"

namespace elastocheck::reference::certificate {
namespace {

const std::string coil =
    "springs: {coil: {bodies: [arm, ground], from: p, to: t, rate: 30, preload: 100}}";
std::string swing(const std::string& joints, const std::string& elements = coil) {
    return support::filled_text("reference/scenes/swing",
                                {{"JOINTS", joints}, {"ELEMENTS", elements}});
}
const std::string hinge = "a: {type: revolute, bodies: [arm, ground], at: o, axis: y}",
                  hinge_again = "b: {type: revolute, bodies: [arm, ground], at: q, axis: y}";

// a · b equals p + e exactly, with e from the fused product.
bool holds_product(const Interval& x, double a, double b) {
    const double p = a * b, e = std::fma(a, b, -p);
    return (x.lo < p || (x.lo == p && e >= 0)) && (x.hi > p || (x.hi == p && e <= 0));
}

TEST(CertificateEquations, DrivenPreloadIsEnclosedDespiteRounding) {
    Side way(swing(hinge, "bushings: {b: {bodies: [arm, ground], at: p, rates: [1, 1, 1]}}"));
    Vector6 direction;
    direction << 0.1, 0.7, -1. / 3, 3e-5, 1e7 / 3, 0.3;
    way.branch.drivers.push_back({Preload{0, direction}, 0.3, 1. / 7});
    const System system = make_system(way.model, way.branch);
    for (int k = 0; k < 6; ++k) {
        const Affine& path = system.elements[0].preload[static_cast<std::size_t>(k)];
        EXPECT_TRUE(holds_product(path.start, direction[k], 0.3)) << k;
        EXPECT_TRUE(holds_product(path.rate, direction[k], 1. / 7)) << k;
        const Interval at = path.at(Interval(0.3));
        EXPECT_LT(at.lo, at.hi) << k;
    }
}

TEST(CertificateEquations, RedundantJointsAreProvedWithTheirGapAndInconsistentOnesAreNot) {
    Side way(swing(hinge + ", " + hinge_again));
    const Equilibrium state = way.solved(500);
    const Certificate c = way.certify(state);
    EXPECT_EQ(c.state, ProofState::proved) << c.detail;
    EXPECT_NE(c.detail.find("are redundant"), std::string::npos) << c.detail;
    EXPECT_GT(c.gap, 0);
    EXPECT_LT(c.gap, 1e-12);
    EXPECT_TRUE(c.stable);
    // Offset along the axis by a part of a millimetre, where both joints constrain: the mean
    // position is no equilibrium.
    for (auto& constraint : way.model.constraints)
        if (auto* points = std::get_if<CoincidentPoints>(&constraint.kind))
            if (points->j.s_local[1] > 0.1 || points->i.s_local[1] > 0.05)
                points->j.s_local[1] += 1e-6;
    const Certificate apart = way.certify(state);
    EXPECT_EQ(apart.state, ProofState::excluded) << apart.detail;
}

// A rod on a ball joint, held by two springs at its other end, is free to spin about the line
// between. Its origin lies beside that line.
TEST(CertificateEquations, StateRotatedAlongAnIdleSpinIsProvedAndAStraightShiftIsExcluded) {
    const Side way = side_of("rod_on_a_ball");
    const Equilibrium state = way.solved(300);
    const Certificate c = way.certify(state);
    ASSERT_EQ(c.state, ProofState::proved) << c.detail;
    EXPECT_NE(c.detail.find("idle motion of 'rod' as in the state"), std::string::npos) << c.detail;
    const Pose& design = way.model.bodies[0].design;
    const Pose& rod = state.poses[0];
    const Vector3d to_p = rod.p * (design.p.conjugate() * (Vector3d(0.3, 0, 0) - design.r));
    const Vector3d axis = (rod.r + to_p).normalized();  // o is the ground's origin
    const auto turned = [&](double angle, bool origin_too, bool straight) {
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, axis));
        Equilibrium spun = state;
        spun.poses[0].p = turn * rod.p;
        if (origin_too)
            spun.poses[0].r = straight ? Vector3d(rod.r + angle * axis.cross(rod.r)) : turn * rod.r;
        return way.certify(spun);
    };
    for (const double angle : {1e-6, 1e-3, 0.3, -2.}) {
        // Each is another equilibrium with its own spin.
        const Certificate spun = turned(angle, true, false);
        EXPECT_EQ(spun.state, ProofState::proved) << angle << ": " << spun.detail;
        EXPECT_LT(spun.held, 1e-9) << angle;
    }
    for (const double angle : {1e-3, -1e-3, 1e-2})
        for (const bool origin_too : {true, false}) {
            const Certificate off = turned(angle, origin_too, true);
            EXPECT_EQ(off.state, ProofState::excluded) << angle << origin_too << ": " << off.detail;
            // A straight displacement of 1e-3 rad is 4e-5 mm off the circle; far off the circle the
            // idle motion is not identified.
            const bool near = std::abs(angle) < 2e-3 && origin_too;
            EXPECT_NE(
                off.detail.find(near ? "with the idle motion of 'rod' at its position in the state"
                                     : "found"),
                std::string::npos)
                << angle << origin_too << off.detail;
        }
}

// Over a knot: the values and the slopes of every piece, whichever side comes last.
TEST(CertificateEquations, IntervalAcrossAKnotHasTheSlopesOfBothSides) {
    for (const auto& [soft, stiff] : {std::pair{1.0, 5.0}, {5.0, 1.0}}) {
        const elastocheck::Curve curve{{0, 1},
                                       {{0, soft, 0, 0}, {0, stiff, 0, 0}, {stiff, 3, 0, 0}}};
        for (const double end : {0.5, 2.0}) {
            std::array<Interval, 4> f;
            expand(curve, Interval{-0.5, end}, 4, f.data());
            EXPECT_TRUE(contains(f[0], -0.5 * soft) && contains(f[0], 0.5 * stiff)) << soft;
            EXPECT_TRUE(contains(f[1], soft) && contains(f[1], stiff)) << soft << ", to " << end;
            EXPECT_EQ(contains(f[1], 3) || end < 1, true) << soft;
            EXPECT_FALSE(is_bounded(f[2]) || is_bounded(f[3])) << "no second derivative at a knot";
        }
    }
}

// A stop that the load just closes: at its knot, where the slopes jump, and on both sides.
TEST(CertificateEquations, StateOnTheKnotOfAStopAndABranchAcrossItAreProved) {
    const auto stopped = [](double rate) {
        return Side(swing(
            hinge,
            fmt::format("springs: {{coil: {{bodies: [arm, ground], from: p, to: t, rate: 30}}}}\n"
                        "stops: {{s: {{bodies: [arm, ground], from: p, to: t, bump: {{clearance: "
                        "10, rate: {}}}}}}}",
                        rate)));
    };
    const Side way = stopped(500);
    // Load at which the spring is 10 mm shorter, by bisection.
    double low = 0, high = 1000;
    const auto gap = [&](const Equilibrium& state) {
        const Pose& pose = state.poses[0];
        const auto& spring = std::get<AxialSpring>(way.model.elastics[0].kind);
        const bool from_arm = spring.i.body == 0;
        const Vector3d moving = pose.r + pose.p * (from_arm ? spring.i : spring.j).s_local;
        return (moving - (from_arm ? spring.j : spring.i).s_local).norm() - 0.39;
    };
    for (int k = 0; k < 60; ++k)
        (gap(way.solved((low + high) / 2)) > 0 ? low : high) = (low + high) / 2;
    bool said = false;
    for (const double by : {0., 1e-13, -1e-13, 1e-10, -1e-10, 1e-3, -1e-3}) {
        const Certificate c = way.certify(way.solved(low * (1 + by)));
        EXPECT_EQ(c.state, ProofState::proved) << by << c.detail;
        EXPECT_TRUE(c.stable) << by;
        said = said || c.detail.find("on a knot") != std::string::npos;
    }
    EXPECT_TRUE(said);
    const auto tube_of = [](const Side& of) {
        std::vector<Equilibrium> states;
        for (int k = 0; k <= 10; ++k) states.push_back(of.solved(100. * k));
        return certify_branch(of.model, of.branch, states);
    };
    const Tube tube = tube_of(way);
    EXPECT_EQ(tube.state, ProofState::proved) << tube.detail;
    EXPECT_GE(tube.knots, 1);
}

// A cambered wheel that rolls, on a skewed hinge: on a tyre over its lift-off, on a jack, and braked.
TEST(CertificateEquations, RollingWheelIsProvedAndExcludedWhenMovedByAMicrometre) {
    int lifted = 0, corners = 0;
    for (const auto& [branch, to] : {std::pair{"{drive: tyres.t.road, to: -400, steps: 20}", -0.4},
                                     {"{drive: tyres.t.road, to: 100, steps: 20}", 0.1},
                                     {"{drive: patch_travel, to: 80, steps: 20}", 0.08},
                                     {"{load: brake, to: 3000, steps: 20}", 3000.}}) {
        const Side side(
            support::filled_text("reference/scenes/cambered_wheel", {{"BRANCH", branch}}));
        std::vector<Equilibrium> states;
        for (int k = 0; k <= 4; ++k) {
            Equilibrium state = states.emplace_back(side.solved(to * k / 4));
            const Certificate c = side.certify(state);
            EXPECT_EQ(c.state, ProofState::proved) << branch << k << c.detail;
            EXPECT_TRUE(c.stable) << branch << k;
            for (const int axis : {0, 2}) {
                Equilibrium moved = state;
                moved.poses[0].r[axis] += 1e-6;
                EXPECT_EQ(side.certify(moved).state, ProofState::excluded) << branch << k << axis;
            }
            lifted +=
                k > 0 && (state.poses[0].r - states[states.size() - 2].poses[0].r).norm() < 1e-12;
        }
        const Tube tube = certify_branch(side.model, side.branch, states);
        EXPECT_EQ(tube.state, ProofState::proved) << branch << tube.detail;
        corners += tube.knots;
    }
    EXPECT_EQ(corners, 1);  // where the wheel leaves the road
    EXPECT_GT(lifted, 0);   // without a load the wheel stays where it is
}

// For every formulation, at small and large rotations, the equilibrium leg's points are proved.
TEST(CertificateEquations, EveryFormulationEqualsThatOfTheEquilibriumLeg) {
    using F = Formulation;
    int proved = 0;
    for (const auto angles : {F::Angles::rotation_vector, F::Angles::cardan, F::Angles::projected})
        for (const auto frame : {F::Frame::on_i, F::Frame::middle})
            for (const bool conjugate : {true, false})
                for (const bool offset : {true, false}) {
                    if (frame == F::Frame::middle && !conjugate) continue;
                    Side way(swing(
                        "",
                        "bushings: {b: {bodies: [arm, ground], at: o, rates: [1000, 2000, 3000], "
                        "rotational_rates: [7e5, 5e5, 4e5]}}"));
                    auto& bushing = std::get<Bushing>(way.model.elastics[0].kind);
                    bushing.formulation = {frame, angles, conjugate, offset};
                    bushing.i.A_local = Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized();
                    bushing.j.A_local = Eigen::Quaterniond(0.9, 0.3, 0.1, -0.2).normalized();
                    bushing.undeformed << 1e-3, -2e-3, 0, 0.1, 0.2, -0.1;
                    for (const double a : {0., 300., 1000.}) {
                        const Certificate c = way.certify(way.solved(a));
                        EXPECT_EQ(c.state, ProofState::proved) << a << c.detail;
                        proved += c.state == ProofState::proved;
                    }
                }
    EXPECT_EQ(proved, 3 * 18);
}

TEST(CertificateEquations, StateBeyondTheEndOfATableIsNotProved) {
    Side way(swing(hinge));
    auto& spring = std::get<AxialSpring>(way.model.elastics[0].kind);
    const Equilibrium state = way.solved(500);
    ASSERT_EQ(way.certify(state).state, ProofState::proved);
    spring.law = Curve{
        {-1e-6, 1e-6}, {{0., 30e3, 0., 0.}, {-0.03, 30e3, 0., 0.}, {0.03, 30e3, 0., 0.}}, false};
    const Certificate c = way.certify(state);
    EXPECT_EQ(c.state, ProofState::open);
    EXPECT_NE(c.detail.find("ends here"), std::string::npos) << c.detail;
}

TEST(CertificateEquations, VerifiedCholeskyAcceptsOnlyPositiveDefiniteMatrices) {
    Eigen::Matrix2d M, R = Eigen::Matrix2d::Zero();
    M << 1e12, 1, 1, 1e-6;
    EXPECT_TRUE(is_positive_definite(M.sparseView(), R.sparseView()));
    R(1, 1) = 0.9e-6;
    EXPECT_TRUE(is_positive_definite(M.sparseView(), R.sparseView()));
    R(1, 1) = 1.1e-6;
    EXPECT_FALSE(is_positive_definite(M.sparseView(), R.sparseView()));
    M << 1, 1, 1, 1;
    R.setZero();
    EXPECT_FALSE(is_positive_definite(M.sparseView(), R.sparseView()));
    M(1, 1) = std::nan("");
    EXPECT_FALSE(is_positive_definite(M.sparseView(), R.sparseView()));
}

}  // namespace
}  // namespace elastocheck::reference::certificate
