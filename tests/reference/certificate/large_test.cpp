// Points of systems whose inverse is not kept: proved row by row.
#include "elastocheck/equilibrium.hpp"
#include "tests/benchmark/families.hpp"
#include "tests/reference/certificate/sides.hpp"

namespace elastocheck::reference::certificate {
namespace {

using families::Family;
using families::Hinge;
using families::Kind;

constexpr Tolerance large{.max_unknowns = max_unknowns_of_points};

// The state at full load, and moved away from it.
void prove_and_exclude(const Family& family) {
    const Side side(families::scene(family));
    Equilibrium state = side.solved(side.branch.to);
    const Certificate proved = side.certify(state, large);
    EXPECT_EQ(proved.state, ProofState::proved) << proved.detail;
    EXPECT_TRUE(proved.stable);
    EXPECT_LT(proved.error.length, 1e-11);
    EXPECT_GT(proved.unique.length, 10 * proved.error.length);

    for (Pose& pose : state.poses) pose.r.z() += 1e-6;
    const Certificate moved = side.certify(state, large);
    EXPECT_EQ(moved.state, ProofState::excluded) << moved.detail;
}

TEST(CertificateOfLargeModels, PointOfAChainOfTwoHundredBodiesIsProvedOrExcluded) {
    prove_and_exclude({Kind::chain, 200});
}

TEST(CertificateOfLargeModels, PointOfAChainOfAHundredJointsIsProvedOrExcluded) {
    prove_and_exclude({Kind::chain, 100, Hinge::revolute});
}

TEST(CertificateOfLargeModels, ModelWithMoreUnknownsThanTheLimitIsReportedAsNotTried) {
    const Side side(families::scene({Kind::chain, 200}));
    const Certificate c = side.certify(side.drawn(0));
    EXPECT_EQ(c.state, ProofState::open);
    EXPECT_EQ(c.detail, "not tried: 1400 unknowns, proofs are tried up to 500");
}

TEST(NightlyCertificateOfLargeModels, PointOfAChainOfTwoThousandBodiesIsProvedOrExcluded) {
    prove_and_exclude({Kind::chain, 2000});
}

}  // namespace
}  // namespace elastocheck::reference::certificate
