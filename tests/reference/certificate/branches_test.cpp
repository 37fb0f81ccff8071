// Interval proofs of whole branches as one curve, and of limit points.
#include "tests/reference/certificate/sides.hpp"

namespace elastocheck::reference::certificate {
namespace {

TEST(CertifyBranch, McPhersonBranchIsProvedToBeOneCurveWithinAMillionthOfAMillimetre) {
    for (const auto& walk : walked("mcpherson", 300)) {
        const Tube tube = certify_branch(walk.model, walk.branch, walk.points);
        EXPECT_EQ(tube.state, ProofState::proved) << tube.detail;
        EXPECT_EQ(tube.from, 0);
        EXPECT_EQ(tube.to, walk.branch.to);
        EXPECT_LE(tube.width.length, 1e-9);
        EXPECT_LE(tube.pieces, 60);
        EXPECT_NE(tube.detail.find("idle motion of 'strut'"), std::string::npos) << tube.detail;
    }
}

TEST(CertifyBranch, PerturbedStatesAreNotProved) {
    auto walk = walked("mcpherson", 30).front();
    auto& points = walk.points;
    ASSERT_EQ(certify_branch(walk.model, walk.branch, points).state, ProofState::proved);
    auto moved = points;
    moved[7].poses[1].r[2] += 1e-8;
    const Tube off = certify_branch(walk.model, walk.branch, moved);
    EXPECT_EQ(off.state, ProofState::open);
    EXPECT_NE(off.detail.find("beyond the tolerance"), std::string::npos) << off.detail;
    auto loads = points;
    loads[7].load += 0.1;
    EXPECT_EQ(certify_branch(walk.model, walk.branch, loads).state, ProofState::open);
    auto back = points;
    std::swap(back[7], back[8]);
    EXPECT_NE(certify_branch(walk.model, walk.branch, back).detail.find("turn back"),
              std::string::npos);
    EXPECT_EQ(certify_branch(walk.model, walk.branch, std::span(points).first(1)).state,
              ProofState::open);
}

// Force at the apex height z: F(z) = 2 k (ℓ - ℓ₀) z / ℓ, ℓ² = b² + z²; largest where ℓ³ = ℓ₀ b².
struct Arch {
    static constexpr double k = 100e3, b = 0.3, h = 0.08;
    static double length() { return std::hypot(b, h); }
    static double force(double z) { return 2 * k * z * (1 - length() / std::hypot(b, z)); }
    static double limit_height() {
        const double l = std::cbrt(length() * b * b);
        return std::sqrt(l * l - b * b);
    }
};
struct OnArch : Side {
    using Side::Side;
    Equilibrium at(double z, double load) const {
        Equilibrium state = drawn(load);
        state.poses[0].r[2] = z;
        return state;
    }
};
OnArch arch() {
    Model model = compile(support::scene("two_spring_arch"));
    model.branches.front().to = -1500;
    return OnArch(model);
}

TEST(CertifyLimitPoint, LimitOfTheArchIsEnclosedToRounding) {
    const OnArch on = arch();
    const double z = Arch::limit_height(), limit = Arch::force(z);
    EXPECT_NEAR(limit, -211.516594, 1e-6);
    for (const double off : {0., 1e-4, -1e-3, 3e-3}) {
        const LimitPoint found = certify_limit_point(
            on.model, on.branch, on.at(z + off, Arch::force(z + off)), {.length = 1e-2});
        EXPECT_EQ(found.state, ProofState::proved) << found.detail;
        EXPECT_LE(found.from, limit + 1e-10);
        EXPECT_GE(found.to, limit - 1e-10);
        EXPECT_LT(found.to - found.from, 1e-9);
    }
    const LimitPoint far =
        certify_limit_point(on.model, on.branch, on.at(z + 1e-4, Arch::force(z + 1e-4)));
    EXPECT_EQ(far.state, ProofState::open);
    EXPECT_NE(far.detail.find("from the state"), std::string::npos) << far.detail;
}

TEST(CertifyLimitPoint, MonotonicBranchHasNoLimitPoint) {
    const auto walk = walked("mcpherson", 3).front();
    const LimitPoint found = certify_limit_point(walk.model, walk.branch, walk.points[1]);
    EXPECT_EQ(found.state, ProofState::open);
    EXPECT_FALSE(found.detail.empty());
}

// Height at a load slightly below the limit, on the stable and on the unstable side.
double height(double load, bool standing) {
    double low = standing ? Arch::limit_height() : 0,
           high = standing ? Arch::h : Arch::limit_height();
    for (int k = 0; k < 200; ++k) {
        const double z = (low + high) / 2;
        ((Arch::force(z) < load) == standing ? low : high) = z;
    }
    return (low + high) / 2;
}

TEST(Certificate, PointsOfTheArchAreProvedUpToItsLimitPoint) {
    const OnArch on = arch();
    const double limit = Arch::force(Arch::limit_height());
    for (const double share : {1e-2, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
        const double load = limit * (1 - share);
        for (const bool standing : {true, false}) {
            // The error of the closed form in doubles is an ulp of the load over
            // the remaining stiffness.
            const Certificate c = on.certify(on.at(height(load, standing), load), {.length = 1e-7});
            EXPECT_EQ(c.state, ProofState::proved) << share << ": " << c.detail;
            EXPECT_EQ(c.stable, standing) << share;
        }
    }
    // No equilibrium beyond the limit.
    const Certificate past = on.certify(on.at(Arch::limit_height(), limit * (1 + 1e-6)));
    EXPECT_EQ(past.state, ProofState::excluded) << past.detail;
}

// The stiffness vanishes halfway to the other equilibrium.
TEST(Certificate, UniquenessRadiusExcludesTheNeighbouringEquilibriaOfTheArch) {
    const OnArch on = arch();
    const double limit = Arch::force(Arch::limit_height());
    double share = 0.1;
    for (int k = 0; k < 60; ++k, share *= 0.75) {
        const double load = limit * (1 - share), high = height(load, true),
                     low = height(load, false);
        for (const double z : {high, low}) {
            const Certificate c = on.certify(on.at(z, load), {.length = 1e-7});
            ASSERT_EQ(c.state, ProofState::proved) << share << ": " << c.detail;
            EXPECT_LT(c.unique.length, 0.51 * (high - low)) << share;
            EXPECT_GT(c.unique.length, 0.02 * (high - low)) << share;
        }
    }
}

TEST(Certificate, EachOfTheThreeEquilibriaOfTheArchIsProved) {
    const OnArch on = arch();
    const double load = -120, below = [&] {
        double low = -2, high = -Arch::h;
        for (int k = 0; k < 200; ++k)
            (Arch::force((low + high) / 2) < load ? low : high) = (low + high) / 2;
        return low;
    }();
    const double heights[] = {height(load, true), height(load, false), below};
    for (int k = 0; k < 3; ++k) {
        const Certificate c = on.certify(on.at(heights[k], load));
        EXPECT_EQ(c.state, ProofState::proved) << k << c.detail;
        EXPECT_EQ(c.stable, k != 1) << k;
        for (int other = 0; other < 3; ++other)
            if (other != k) {
                EXPECT_LT(c.unique.length, std::abs(heights[k] - heights[other]));
            }
    }
}

}  // namespace
}  // namespace elastocheck::reference::certificate
