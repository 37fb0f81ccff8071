// Property-based test on small random scenes: the result does not depend on the number of steps.
#include "tests/support/random_scenes.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "tests/legs/legs.hpp"

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
std::vector<std::pair<std::uint64_t, SideModel>> random_sides(std::uint64_t count) {
    std::vector<std::pair<std::uint64_t, SideModel>> all;
    for (std::uint64_t seed = 1; seed <= count; ++seed)
        if (const auto scene = compare::small_random_scene(seed))
            all.emplace_back(seed, side_of(*scene));
    return all;
}

struct RandomMechanisms : LegTest {};
ELASTOCHECK_FOR(accurate_legs, RandomMechanisms);

TEST_P(RandomMechanisms, OutcomeDoesNotDependOnTheNumberOfSteps) {
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

}  // namespace
}  // namespace elastocheck::legs
