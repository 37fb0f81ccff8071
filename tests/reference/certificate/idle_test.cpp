// Certificates of soft, idle and nearly redundant models: only structurally idle motions and
// redundant rows are held, never soft motions, however stiff their neighbours are.
#include "reference/certificate/statement/system.hpp"
#include "tests/reference/certificate/sides.hpp"

namespace elastocheck::reference::certificate {
namespace {

// A body on one bushing in a turned frame, pulled along the frame's z.
const Vector3d along = Vector3d(1, 2, 3).normalized();
Side hung(double stiff, double soft, double load) {
    return Side(compile(support::scene_of(
        "reference/scenes/soft_along_z",
        {setting("bushings.k.rates.x", stiff), setting("bushings.k.rates.y", stiff),
         setting("bushings.k.rates.z", soft), setting("branches.pull.to", load)})));
}
Certificate at(const Side& way, double load, double distance) {
    Equilibrium state;
    state.load = load;
    state.poses = {{distance * along, Eigen::Quaterniond::Identity()}};
    return way.certify(state);
}

TEST(CertificateIdleModes, SoftMotionBesideStiffNeighboursIsNotIdle) {
    for (const double soft : {1e-4, 1e-3, 1., 1e3})
        for (const double stiff : {1e5, 1e9}) {
            const Side way = hung(stiff, soft, 1e-2 * soft);
            EXPECT_EQ(at(way, 0, 0).detail.find("idle"), std::string::npos);
            for (const double share : {1., 0.5}) {
                const double load = share * 1e-2 * soft;
                const auto where = fmt::format("{} {} {}", stiff, soft, share);
                // off by 10 mm along the soft axis
                EXPECT_EQ(at(way, load, share * 1e-2 + 1e-2).state, ProofState::excluded) << where;
                EXPECT_EQ(at(way, load, 0).state, ProofState::excluded) << where;
                const Certificate right = at(way, load, share * 1e-2);
                EXPECT_NE(right.state, ProofState::excluded) << where << ": " << right.detail;
                EXPECT_EQ(right.held, 0) << where;
                if (stiff <= 1e7 * soft) {
                    EXPECT_EQ(right.state, ProofState::proved) << where << ": " << right.detail;
                }
            }
        }
}

// Without rate and load every position along the motion is an equilibrium.
TEST(CertificateIdleModes, UnloadedMotionWithoutStiffnessIsIdle) {
    const Side way = hung(1e9, 0, 1e-6);
    for (const double distance : {0., 0.3}) {
        const Certificate c = at(way, 0, distance);
        EXPECT_EQ(c.state, ProofState::proved) << c.detail;
        EXPECT_NE(c.detail.find("idle motion of 'b'"), std::string::npos) << c.detail;
    }
    // A load of 1e-6 N acts on the idle motion.
    const Certificate pushed = at(way, 1e-6, 0);
    EXPECT_EQ(pushed.state, ProofState::excluded) << pushed.detail;
    EXPECT_NE(pushed.detail.find("is loaded by"), std::string::npos) << pushed.detail;
}

// A pendulum on a point: its spin about the vertical is idle, its swing is resisted by
// the load alone.
TEST(CertificateIdleModes, MotionWithGeometricStiffnessAloneIsNotIdle) {
    const Side way = side_of("hung_on_a_point");
    for (const double tilt : {0., 1e-8, 1e-6}) {
        Equilibrium state;
        state.load = 1;
        state.poses = {{Vector3d(0, 0, -1e-9),
                        Eigen::Quaterniond(Eigen::AngleAxisd(tilt, Vector3d::UnitX()))}};
        const Certificate c = way.certify(state);
        EXPECT_EQ(c.state, tilt > 1e-7 ? ProofState::excluded : ProofState::proved)
            << tilt << ": " << c.detail;
        EXPECT_GE(c.error.angle, 0.99 * tilt);  // the distance from the vertical
    }
}

// Upright column on a ball joint with a torsion spring. Its load is 1e-9 m off its axis, which
// determines the direction of buckling.
TEST(CertificateIdleModes, BucklingDirectionGivenByAnOffsetIsNotIdle) {
    const Side way = side_of("column_off_axis");
    const Equilibrium state = way.solved(6000);
    const Certificate right = way.certify(state);
    ASSERT_EQ(right.state, ProofState::proved) << right.detail;
    for (const double turn : {1e-4, 1e-6}) {
        Equilibrium turned = state;
        const Eigen::Quaterniond by(Eigen::AngleAxisd(turn, Vector3d::UnitZ()));
        turned.poses[0] = {by * state.poses[0].r, by * state.poses[0].p * by.conjugate()};
        for (auto& reaction : turned.reactions)
            reaction = {by * reaction.force, by * reaction.moment};
        EXPECT_NE(way.certify(turned).state, ProofState::proved) << turn;
    }
}

// The frame of the mount is fixed to the strut: its spin is idle with equal rates across the axis,
// and not with unequal ones.
TEST(CertificateIdleModes, SpinIsIdleUnderAnIsotropicLawAndNotUnderANearlyIsotropicOne) {
    for (const double more : {0., 1e-9, 1e-3}) {
        Model model = compile(support::scene("mcpherson"));
        for (auto& elastic : model.elastics)
            if (auto* bushing = std::get_if<Bushing>(&elastic.kind))
                if (auto* law = std::get_if<LinearStiffness>(&bushing->law);
                    law && law->K(3, 3) == 0)
                    law->K(0, 0) *= 1 + more;
        // The state of the isotropic law is also that of the other, except for the load
        // on its spin.
        const Equilibrium state = Side(compile(support::scene("mcpherson"))).solved(1000);
        const Certificate c = Side(model).certify(state, {1e-3, 1e-3, 1e3, 1e3});
        EXPECT_EQ(c.detail.find("idle motion") != std::string::npos, more == 0)
            << more << ": " << c.detail;
        EXPECT_EQ(c.state == ProofState::proved && c.held > 0, more == 0)
            << more << ": " << c.detail;
    }
}

// Two hinges on one axis are redundant; tilted against each other by 1e-10 rad they lock the arm.
TEST(CertificateIdleModes, NearlyDependentRowsAreNotRedundant) {
    Side way = side_of("swing_on_two_hinges");
    const Equilibrium state = way.solved(500);
    ASSERT_EQ(way.certify(state).state, ProofState::proved);
    for (auto& constraint : way.model.constraints)
        if (auto* row = std::get_if<PerpendicularDirections>(&constraint.kind);
            row && constraint.joint == 1)
            row->i.u_local += 1e-10 * Vector3d(1, 0, 0.5);
    const Certificate locked = way.certify(state);
    EXPECT_NE(locked.state, ProofState::proved) << locked.detail;
}

TEST(CertificateIdleModes, TooLargeModelIsOpenWithAMessage) {
    std::string points, bodies, bushings;
    constexpr int n = 2000;
    for (int k = 0; k < n; ++k) {
        points += fmt::format(", p{}: [{}, 0, 0]", k, 0.1 * (k + 1));
        bodies += fmt::format("  b{}: {{origin: p{}}}\n", k, k);
        bushings += fmt::format(
            "  k{}: {{bodies: [{}, b{}], at: p{}, rates: [1e6, 1e6, 1e6], "
            "rotational_rates: [1e5, 1e5, 1e5]}}\n",
            k, k == 0 ? "ground" : fmt::format("b{}", k - 1), k, k);
    }
    const Side way(
        R"(elastocheck: 1
name: chain
units: {length: m, angle: rad, force: N}
points: {o: [0, 0, 0])" +
        points + "}\nbodies:\n" + bodies + "bushings:\n" + bushings +
        fmt::format(R"(loads: {{f: {{on: b{0}, at: p{0}, force: [0, 0, 1]}}}}
branches: {{up: {{load: f, to: 1, steps: 1}}}}
probes: {{tip: {{on: b{0}, at: p{0}}}}}
)",
                    n - 1));
    const Equilibrium drawn = way.drawn(0), next = way.drawn(1);
    const std::string why = fmt::format("not tried: {} unknowns, proofs are tried up to {}", 7 * n,
                                        max_unknowns_of_curves);
    const Certificate c = way.certify(drawn);
    EXPECT_EQ(c.state, ProofState::open);
    EXPECT_EQ(c.detail, why);
    const std::vector<Equilibrium> states{drawn, next};
    EXPECT_EQ(certify_branch(way.model, way.branch, states).detail, why);
    EXPECT_EQ(certify_limit_point(way.model, way.branch, drawn).detail, why);
}

}  // namespace
}  // namespace elastocheck::reference::certificate
