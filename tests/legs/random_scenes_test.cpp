// Property-based tests on small random scenes: a result is correct, or the outcome is a failure.
#include <map>

#include "elastocheck/compile.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "tests/legs/legs.hpp"
#include "tests/support/random_scenes.hpp"

namespace elastocheck::legs {
namespace {

// Distance of two states over the bodies that no idle mode moves, whose position is arbitrary.
struct Compared {
    std::vector<bool> determined;

    explicit Compared(const Model& model) : determined(model.bodies.size(), true) {
        for (const auto& mode : recursive::diagnose(model).idle)
            for (std::size_t b = 0; b < determined.size(); ++b)
                if (mode.dq.segment<6>(6 * static_cast<Eigen::Index>(b)).norm() > 1e-6)
                    determined[b] = false;
    }
    double operator()(const Equilibrium& a, const Equilibrium& b) const {
        double worst = 0;
        for (std::size_t k = 0; k < determined.size(); ++k)
            if (determined[k])
                worst = std::max({worst, (a.poses[k].r - b.poses[k].r).norm(),
                                  a.poses[k].p.angularDistance(b.poses[k].p)});
        return worst;
    }
};

// The first `count` seeds whose scene is small.
std::vector<std::pair<std::uint64_t, OneWay>> random_sides(std::uint64_t count) {
    std::vector<std::pair<std::uint64_t, OneWay>> all;
    for (std::uint64_t seed = 1; seed <= count; ++seed)
        if (const auto scene = compare::small_random_scene(seed))
            all.emplace_back(seed, side_of(*scene));
    return all;
}

struct RandomMechanisms : LegTest {};
ELASTOCHECK_FOR(accurate_legs, RandomMechanisms);

TEST_P(RandomMechanisms, EndAlikeInOneStepAndInTwenty) {
    int solved = 0;
    for (const auto& [seed, side] : random_sides(150)) {
        const auto fine = solve(leg(), side, 20);
        EXPECT_EQ(fine.outcome == Outcome::converged, fine.detail.empty()) << seed;
        ASSERT_EQ(fine.outcome == Outcome::converged, fine.points.size() == 21) << seed;
        if (fine.outcome != Outcome::converged) continue;
        ++solved;
        const auto coarse = solve(leg(), side, 1);
        ASSERT_EQ(coarse.outcome, Outcome::converged) << seed << ": " << coarse.detail;
        EXPECT_LE(Compared(side.model)(coarse.points.back(), fine.points.back()),
                  leg().exact() ? 1e-8 : 1e-6)
            << seed;
    }
    EXPECT_GE(solved, 20);
}

// Where both references agree, adaptive steps and the series agree with them or decline; where both
// references end, no method goes on.
TEST(RandomScenes, AreRightOrReportedAsUnsolved) {
    const Leg equilibrium{Leg::equilibrium}, energy{Leg::energy};
    int judged = 0, declined = 0;
    std::string which;
    for (const auto& [seed, side] : random_sides(200)) {
        const auto one = solve(equilibrium, side, 4), other = solve(energy, side, 4);
        const Compared apart(side.model);
        const bool both = one.outcome == Outcome::converged && other.outcome == Outcome::converged;
        bool agree = both;
        for (std::size_t k = 0; both && k < one.points.size(); ++k)
            agree = agree && apart(one.points[k], other.points[k]) <= 1e-7;
        judged += agree;
        for (const auto& method : recursive::methods) {
            const auto path = solve({Leg::recursive, method}, side, 20);
            EXPECT_EQ(path.outcome == Outcome::converged, path.detail.empty()) << seed;
            for (const auto& point : path.points)
                for (const auto& pose : point.poses)
                    ASSERT_TRUE(pose.r.allFinite() && pose.p.coeffs().allFinite()) << seed;
            const bool ended = one.outcome != Outcome::converged &&
                               other.outcome != Outcome::converged &&
                               other.outcome != Outcome::not_conservative;
            EXPECT_FALSE(ended && path.outcome == Outcome::converged)
                << seed << ": " << method.name << " goes on; " << one.detail << "; "
                << other.detail;
            if (!agree || recursive::has_steps(method)) continue;
            if (path.outcome != Outcome::converged) {
                ++declined;
                which += fmt::format("\n{} {}: {}", seed, method.name, path.detail);
                continue;
            }
            const double bound = method.name == "series" ? 1e-7 : 2e-5;
            for (std::size_t k = 0; k < one.points.size(); ++k)
                EXPECT_LE(apart(path.points[5 * k], one.points[k]), bound)
                    << seed << " " << method.name;
        }
    }
    EXPECT_LE(declined, judged / 25) << which;
    EXPECT_GE(judged, 40);
}

}  // namespace
}  // namespace elastocheck::legs
