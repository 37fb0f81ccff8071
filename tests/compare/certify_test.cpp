// Interval proofs of paths and their use in a comparison.
#include <gtest/gtest.h>

#include "compare/comparison/compare.hpp"
#include "compare/proofs/certify.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

CertifyOptions by(Leg leg, int points = 4) {
    CertifyOptions options;
    options.tolerance = parse_tolerance(claimed_accuracy);
    options.solvers = {{.leg = leg}};
    options.points = points;
    return options;
}

TEST(Certify, EverySideOfEveryBranchIsProvedForEachReference) {
    const Model model = compile(support::scene("mcpherson"));
    for (const Leg leg : {Leg::equilibrium, Leg::energy, Leg::series}) {
        const CertifyStudy study = certify(model, by(leg));
        std::size_t sides = 0;
        for (const Branch& branch : model.branches) sides += sides_of(model, branch).size();
        ASSERT_EQ(study.sides.size(), sides);
        EXPECT_TRUE(study.conclusive());
        for (const CertifiedSide& side : study.sides) {
            EXPECT_GE(side.tally.points, 5) << side.branch;
            EXPECT_EQ(side.tally.proved, side.tally.points)
                << side.branch << ": " << side.tally.not_proved;
            EXPECT_LE(side.tally.error.length, 1e-9) << side.branch;
            EXPECT_GT(side.tally.unique.length, side.tally.error.length) << side.branch;
        }
    }
}

TEST(Certify, StudyWithoutBranchesIsNotConclusive) { EXPECT_FALSE(CertifyStudy{}.conclusive()); }

TEST(Certify, OneOpenPointMakesTheStudyInconclusiveAndIsNamed) {
    CertifyStudy study;
    CertifiedSide& side = study.sides.emplace_back();
    side.unit = Unit::newton;
    Certificate proved;
    proved.state = ProofState::proved;
    proved.error = {1e-12, 1e-12, 1e-9, 1e-9};
    proved.unique = {1e-4, 1e-4, 1, 1};
    add(side.tally, 0, side.unit, proved);
    EXPECT_TRUE(study.conclusive());
    Certificate open;
    open.detail = "the box is too wide";
    add(side.tally, 120, side.unit, open);
    EXPECT_FALSE(study.conclusive());
    EXPECT_FALSE(study.excluded());
    EXPECT_EQ(side.tally.not_proved, "open at 120 N: the box is too wide");
    EXPECT_EQ(side.tally.error.length, 1e-12);  // of the proved points only
}

TEST(Certify, ExcludedReferenceMakesTheComparisonInconclusive) {
    Scene scene = support::scene("pinned_bar");
    scene.branches.resize(1);
    const Model model = compile(scene);
    Comparison found = compare(model);
    ASSERT_TRUE(found.conclusive());
    BranchComparison& branch = found.branches[0];
    EXPECT_GT(branch.runs[1].proved.points, 0);
    EXPECT_EQ(branch.runs[1].proved.proved, branch.runs[1].proved.points);
    branch.runs[1].proved.excluded = 1;
    branch.runs[1].proved.not_proved = "excluded at 3 N";
    const Objections objections = disagreements(model, found.channels, model.branches[0], branch);
    ASSERT_FALSE(objections.empty());
    EXPECT_NE(objections.worst.front().what.find(
                  "provably no equilibrium: excluded at 3 N; the energy leg is right, by proof"),
              std::string::npos)
        << objections.worst.front().what;
}

TEST(Certify, ComparisonWithoutTheProveOptionProvesNoPoint) {
    Options options;
    options.prove = false;
    EXPECT_EQ(
        compare(compile(support::scene("pinned_bar")), options).branches[0].runs[1].proved.points,
        0);
}

}  // namespace
}  // namespace elastocheck::compare
