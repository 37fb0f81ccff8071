// Interval proofs of points of the built-in scenes, by every leg: correct points are proved, wrong
// ones are not.
#include "elastocheck/energy.hpp"
#include "reference/certificate/proved_box.hpp"
#include "tests/reference/certificate/sides.hpp"

namespace elastocheck::reference::certificate {
namespace {

const std::vector<compare::Leg> exact_legs{compare::Leg::equilibrium, compare::Leg::energy,
                                           compare::Leg::series};

std::string at(const std::string& scene, const Walked& walk, const Equilibrium& state,
               const Certificate& c) {
    return fmt::format("{} '{}' by {} at {}: {}: {}", scene, walk.branch.name,
                       compare::name(walk.leg), state.load, name(c.state), c.detail);
}

// Residuals of the legs at the centre of the box, relative to the acting forces: the certificate
// has the same equations.
void expect_met(const Residuals& r, double force, double length, const std::string& where) {
    EXPECT_LE(r.length, 1e-11 * length) << where;
    EXPECT_LE(r.direction, 1e-11) << where;
    EXPECT_LE(r.force, 1e-9 * force) << where;
    EXPECT_LE(r.moment, 1e-9 * force * length) << where;
}

TEST(Certificate, EveryPointOfEveryBuiltInSceneIsProvedForEveryLeg) {
    int proved = 0;
    for (const auto& scene : support::scene_names())
        for (const auto& walk : walked(scene, 1, exact_legs))
            for (const auto& state : walk.points) {
                const Certificate c = certify(walk.model, walk.branch, state);
                ASSERT_EQ(c.state, ProofState::proved) << at(scene, walk, state, c);
                EXPECT_LE(c.error.length, 1e-9) << at(scene, walk, state, c);
                EXPECT_GT(c.unique.length, c.error.length) << at(scene, walk, state, c);
                EXPECT_GT(c.unique.angle, c.error.angle) << at(scene, walk, state, c);
                EXPECT_TRUE(c.stable) << at(scene, walk, state, c);
                ++proved;
            }
    EXPECT_GT(proved, 700);
}

TEST(Certificate, CentreOfTheBoxSatisfiesTheEquationsOfTheOtherLegs) {
    for (const auto& scene : support::scene_names())
        for (const auto& walk : walked(scene, 1, {compare::Leg::equilibrium}))
            for (const auto& state : walk.points) {
                const Certificate c = certify(walk.model, walk.branch, state);
                const auto where = at(scene, walk, state, c);
                ASSERT_EQ(c.centre.poses.size(), state.poses.size()) << where;
                // Rounding of the stiffest element: about 1e10 N/m times an ulp of a metre.
                expect_met(equilibrium::residuals(walk.model, walk.branch, c.centre), 1e4, 1,
                           where);
                if (!support::has_potential(support::scene(scene))) continue;
                expect_met(energy::residuals(walk.model, walk.branch, c.centre), 1e4, 1, where);
            }
}

// A box that is proved for one leg proves nearby states of the others with their distances and excludes others. With an
// idle motion each state has its own equations, so that no box is shared.
TEST(Certificate, KnownBoxProvesTheStatesOfOtherLegsAndExcludesWrongOnes) {
    const auto walks = walked("double_wishbone", 1, exact_legs);
    for (std::size_t w = 0; w < walks.size(); w += exact_legs.size())
        for (std::size_t k = 0; k < walks[w].points.size(); ++k) {
            std::vector<ProvedBox> known;
            for (std::size_t leg = 0; leg < exact_legs.size(); ++leg) {
                const Walked& walk = walks[w + leg];
                Equilibrium state = walk.points[k];
                const Certificate alone = certify(walk.model, walk.branch, state),
                                  c = certify(walk.model, walk.branch, state, {}, known);
                const auto where = at("double_wishbone", walk, state, c);
                EXPECT_EQ(known.size(), 1u) << where;
                ASSERT_EQ(c.state, ProofState::proved) << where;
                EXPECT_NEAR(c.error.length, alone.error.length, 1e-12) << where;
                // the search for the box without another equilibrium ends when within 0.85 of the
                // largest, from each centre at another size
                EXPECT_NEAR(c.unique.length / alone.unique.length, 1, 0.25) << where;
                EXPECT_EQ(c.stable, alone.stable) << where;
                state.poses[0].r.x() += 1e-6;
                const Certificate wrong = certify(walk.model, walk.branch, state, {}, known);
                EXPECT_EQ(wrong.state, ProofState::excluded) << where;
                EXPECT_NEAR(wrong.error.length, 1e-6, 1e-9) << where;
            }
        }
    const Side strut(compile(support::scene("mcpherson")));  // its spin is idle
    std::vector<ProvedBox> none;
    const Equilibrium state = strut.solved(0.4 * strut.branch.to);
    EXPECT_EQ(certify(strut.model, strut.branch, state, {}, none).state, ProofState::proved);
    EXPECT_TRUE(none.empty());
}

TEST(Certificate, WrenchOnAnIdleMotionAboveItsLimitIsNamed) {
    const Side strut(compile(support::scene("mcpherson")));
    const Equilibrium state = strut.solved(0.4 * strut.branch.to);
    const Certificate c = certify(strut.model, strut.branch, state, {.held = 0});
    EXPECT_EQ(c.state, ProofState::open) << c.detail;
    EXPECT_NE(c.detail.find("N·m on an idle motion"), std::string::npos) << c.detail;
}

// ---- Wrong points

struct OnMcPherson : Side {
    Equilibrium state;
    explicit OnMcPherson(double share)
        : Side(compile(support::scene("mcpherson"))), state(solved(share * branch.to)) {}
};

TEST(Certificate, PerturbedPointIsExcludedWithItsDistanceFromTheEquilibrium) {
    const OnMcPherson p(0.4);
    ASSERT_EQ(p.certify(p.state).state, ProofState::proved);
    const auto excluded = [&](const std::string& what, const auto& change) {
        Equilibrium wrong = p.state;
        change(wrong);
        const Certificate c = p.certify(wrong);
        EXPECT_EQ(c.state, ProofState::excluded)
            << what << ": " << name(c.state) << " " << c.detail;
        return c;
    };
    for (std::size_t body = 0; body < 3; ++body) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const double by : {1e-3, 1e-6, 1e-8}) {
                const auto c =
                    excluded(fmt::format("body {} moved by {} m along {}", body, by, axis),
                             [&](Equilibrium& s) { s.poses[body].r[axis] += by; });
                if (by < 1e-3) {
                    EXPECT_NE(c.detail.find("away"), std::string::npos) << c.detail;
                }
            }
            if (body != 2)  // the strut's own spin is idle
                excluded(fmt::format("body {} turned by 1e-3 about {}", body, axis),
                         [&](Equilibrium& s) {
                             s.poses[body].p =
                                 Eigen::Quaterniond(Eigen::AngleAxisd(1e-3, Vector3d::Unit(axis))) *
                                 s.poses[body].p;
                         });
        }
    }
    for (std::size_t joint = 0; joint < p.state.reactions.size(); ++joint)
        for (int axis = 0; axis < 3; ++axis) {
            excluded(fmt::format("1 N of joint {} along {}", joint, axis),
                     [&](Equilibrium& s) { s.reactions[joint].force[axis] += 1; });
            excluded(fmt::format("1 N·m of joint {} about {}", joint, axis),
                     [&](Equilibrium& s) { s.reactions[joint].moment[axis] += 1; });
        }
    for (const double by : {1., -1., 1e-2})
        excluded(fmt::format("judged at {} N more", by), [&](Equilibrium& s) { s.load += by; });
}

// The strut turned about its own axis is another equilibrium; under a moment about that axis there is none.
TEST(Certificate, StrutTurnedAboutItsFreeAxisIsProvedAndAMomentAboutThatAxisIsExcluded) {
    const OnMcPherson p(0.4);
    const Certificate before = p.certify(p.state);
    EXPECT_NE(before.detail.find("idle motion of 'strut'"), std::string::npos) << before.detail;
    EXPECT_GT(before.held, 0);
    EXPECT_LT(before.held, 1e-9);
    // Rotates the strut about the axis of its tube, which passes through its origin, the top.
    Equilibrium spun = p.state;
    std::vector<Vector3d> across;
    Pose& strut = spun.poses[2];
    for (const auto& constraint : p.model.constraints)
        if (const auto* row = std::get_if<PerpendicularDirections>(&constraint.kind)) {
            if (row->i.body != 2 && row->j.body != 2) continue;
            // The axis is the cross product of two directions on the strut that are normal to it.
            across.push_back((row->i.body == 2 ? row->i : row->j).u_local);
            if (across.size() < 2) continue;
            strut.p = strut.p * Eigen::Quaterniond(Eigen::AngleAxisd(
                                    0.3, across[0].cross(across[1]).normalized()));
        }
    EXPECT_GT(strut.p.angularDistance(p.state.poses[2].p), 0.29);
    const Certificate after = p.certify(spun);
    EXPECT_EQ(after.state, ProofState::proved) << after.detail;

    Model pushed = p.model;
    for (const double moment : {0.1, 1e-7}) {
        const Vector3d axis = across[0].cross(across[1]).normalized();
        pushed.static_loads = {{"push", FollowerMoment{2, moment * axis}}};
        const Certificate c = certify(pushed, p.branch, p.state);
        EXPECT_EQ(c.state, ProofState::excluded) << moment << ": " << c.detail;
        EXPECT_NE(c.detail.find("is loaded by"), std::string::npos) << moment << ": " << c.detail;
    }
    // A follower moment with a part across the axis rotates with the strut, so that the load on the
    // wheel depends on the spin: it is not idle.
    pushed.static_loads = {{"push", FollowerMoment{2, Vector3d(0.1, 0.1, 0.1)}}};
    EXPECT_EQ(certify(pushed, p.branch, p.state).state, ProofState::excluded);
}

TEST(Certificate, StateOfAnotherModelIsRejectedAndNaNIsOpen) {
    const OnMcPherson p(0.1);
    Equilibrium short_of = p.state;
    short_of.poses.pop_back();
    EXPECT_THROW(p.certify(short_of), std::invalid_argument);
    Equilibrium nan = p.state;
    nan.poses[0].r[1] = std::nan("");
    EXPECT_EQ(p.certify(nan).state, ProofState::open);
    nan = p.state;
    nan.reactions[0].force[0] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(p.certify(nan).state, ProofState::open);
}

}  // namespace
}  // namespace elastocheck::reference::certificate
