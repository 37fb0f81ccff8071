// Batches of variants against each variant solved alone, and that no variant affects another.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive_batch.hpp"
#include "models/branch.hpp"
#include "recursive/batch/kernels.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/series/sides.hpp"
#include "recursive/stepping/stability.hpp"
#include "tests/recursive/random.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

using Paths = std::map<std::size_t, std::vector<EquilibriumPath>>;

Paths in_batch(const Model& design, const std::vector<Model>& variants,
               const BatchOptions& options) {
    Paths paths;
    solve_batch(design, variants, options,
                [&](std::size_t variant, std::size_t branch, const EquilibriumPath& path) {
                    EXPECT_EQ(paths[variant].size(), branch) << "branches come in their order";
                    paths[variant].push_back(path);
                });
    return paths;
}
EquilibriumPath alone(const Model& model, const Branch& branch, const Analysis& analysis,
                      const BatchOptions& options) {
    return solve(model, branch, {.method = {"series", 0, options.series}, .steps = options.points},
                 analysis);
}

// Largest difference of the poses and wrenches of two paths, over the largest coordinate, force and
// moment; infinite where they have other points.
double difference(const EquilibriumPath& a, const EquilibriumPath& b) {
    if (a.points.size() != b.points.size()) return std::numeric_limits<double>::infinity();
    double length = 0, turn = 0, force = 0, moment = 0, reach = 0, max_force = 0, max_moment = 0;
    const auto grow = [](double& most, double by) {
        if (!(by <= most)) most = by;
    };
    for (std::size_t k = 0; k < a.points.size(); ++k) {
        const Equilibrium &p = a.points[k], &q = b.points[k];
        EXPECT_EQ(p.load, q.load);
        for (std::size_t body = 0; body < p.poses.size(); ++body) {
            grow(length, (p.poses[body].r - q.poses[body].r).norm());
            grow(reach, p.poses[body].r.norm());
            grow(turn, p.poses[body].p.angularDistance(q.poses[body].p));
        }
        for (std::size_t joint = 0; joint < p.reactions.size(); ++joint) {
            grow(force, (p.reactions[joint].force - q.reactions[joint].force).norm());
            grow(max_force, p.reactions[joint].force.norm());
            grow(moment, (p.reactions[joint].moment - q.reactions[joint].moment).norm());
            grow(max_moment, p.reactions[joint].moment.norm());
        }
    }
    const auto over = [](double by, double whole) { return whole > 0 ? by / whole : by; };
    // a moment about the joint's point may be the rounding of forces at levers of a metre
    return std::max({over(length, reach), turn, over(force, max_force),
                     over(moment, std::max(max_moment, max_force))});
}

// The scene's branch as two branches, one to each side, with what is active on it.
Model on_sides(const Model& model, std::size_t branch) {
    Model result = on_branch(model, model.branches.at(branch));
    result.branches = branch_sides(model.branches[branch]);
    return result;
}

// The scene with hardpoints moved by up to 2 mm and rates scaled by up to a fifth.
Model variant(const std::string& file, const std::vector<Number>& numbers, std::size_t branch,
              Random& random) {
    std::vector<Setting> settings;
    for (const Number& number : numbers) {
        const double unit = number.unit == "mm" ? 1 : 1e-3;
        if (number.path.starts_with("points.") && !number.path.ends_with(".y"))
            settings.push_back(setting(number.path, number.value + 2 * unit * random(-1, 1)));
        if (number.path.ends_with(".rate"))
            settings.push_back(setting(number.path, number.value * random(0.8, 1.2)));
    }
    return on_sides(compile(read_scene(file, settings)), branch);
}

// Variants of a scene in a batch and alone. Returns how many were solved in the batch itself.
void expect_as_alone(const std::string& name, std::size_t branch, int count) {
    Random random;
    const std::string file = std::string(ELASTOCHECK_SCENES) + "/" + name + ".yaml";
    const Scene scene = read_scene(file);
    const Model design = on_sides(compile(scene), branch);
    std::vector<Model> variants;
    for (int k = 0; k < count; ++k)
        variants.push_back(variant(file, scene.numbers, branch, random));
    const BatchOptions options;
    const Paths paths = in_batch(design, variants, options);
    ASSERT_EQ(paths.size(), variants.size());
    double worst = 0;
    int converged = 0, together = 0, branches = 0;
    for (const auto& [k, found] : paths) {
        const Model& model = variants[k];
        ASSERT_EQ(found.size(), model.branches.size());
        const Analysis analysis = analyse(model);
        for (std::size_t b = 0; b < found.size(); ++b) {
            const EquilibriumPath expected = alone(model, model.branches[b], analysis, options);
            EXPECT_EQ(found[b].outcome, expected.outcome) << name << ", variant " << k;
            const double apart = difference(found[b], expected);
            EXPECT_LE(apart, 1e-12) << name << ", variant " << k << ", branch " << b;
            if (!(apart <= worst)) worst = apart;
            converged += expected.outcome == Outcome::converged;
            ++branches;
            together += apart > 0;  // alone it would be the same to the last bit
        }
    }
    EXPECT_GT(converged, branches / 2) << "most variants reach the ends of their branches";
    fmt::print("{}: {} of {} branches in lanes, largest relative difference {:.1e}\n", name,
               together, branches, worst);
}

struct Case {
    const char* scene;
    std::size_t branch;
};
// Branch 1 is a vertical load, with bump stops or an anti-roll bar under weight.
constexpr Case cases[] = {
    {"chrono_mcpherson", 0}, {"mcpherson_strut", 1}, {"double_wishbone", 1}, {"front_axle", 1}};

TEST(Batch, EachVariantEqualsItsScalarSolution) {
    for (const auto& [scene, branch] : cases) expect_as_alone(scene, branch, 20);
}
TEST(NightlyBatch, ThousandVariantsEqualTheirScalarSolutions) {
    for (const auto& [scene, branch] : cases) expect_as_alone(scene, branch, 1000);
}

// The first scene is at rest, the second settles under a preload, the third has curves.
TEST(SharedStart, SidesSolvedTogetherEqualEachSolvedAlone) {
    for (const char* name : {"chrono_mcpherson", "chrono_mcpherson_preload", "double_wishbone"}) {
        Model model = compile(support::scene(name));
        std::vector<Branch> sides = model.branches;
        if (std::string(name) == "double_wishbone") {
            model = on_sides(model, 1);
            sides = model.branches;
        }
        const Analysis analysis = analyse(model);
        const recursive::Series options;
        const auto together = series::follow_sides(model, sides, options, analysis);
        ASSERT_EQ(together.size(), sides.size());
        for (std::size_t k = 0; k < sides.size(); ++k) {
            const series::Path own = series::follow(model, sides[k], options, analysis);
            EXPECT_EQ(together[k].outcome, own.outcome) << name;
            EXPECT_EQ(together[k].expansions.size(), own.expansions.size()) << name;
            EXPECT_LE(difference(series::sample(model, together[k], sides[k], 20),
                                 series::sample(model, own, sides[k], 20)),
                      1e-12)
                << name << ", side " << k;
            const bool shares = k > 0 && std::string(name) != "double_wishbone";
            EXPECT_EQ(together[k].counts.iterations < own.counts.iterations, shares) << name;
        }
    }
}

// The first scene settles under a preload, the second over curves. A branch with other values at a = 0 does not use the
// kept start.
TEST(KeptStart, IsUsedOnlyByBranchesThatBeginThere) {
    for (const char* name : {"chrono_mcpherson_preload", "double_wishbone"}) {
        const Model model = on_sides(compile(support::scene(name)), 0);
        const Analysis analysis = analyse(model);
        Analysis kept = analysis;
        series::keep_start(model, model.branches.front(), {}, kept);
        ASSERT_TRUE(kept.settled) << name;
        std::vector<Branch> branches(3, model.branches.front());
        branches[1].to *= -0.5;
        for (Driver& driver : branches[2].drivers)
            driver.start += 0.01 * branches[2].to * driver.rate;
        for (std::size_t k = 0; k < branches.size(); ++k) {
            const series::Path own = series::follow(model, branches[k], {}, analysis),
                               from = series::follow(model, branches[k], {}, kept);
            EXPECT_EQ(own.outcome, Outcome::converged) << own.detail;
            EXPECT_EQ(from.outcome, own.outcome) << name;
            EXPECT_LE(difference(series::sample(model, from, branches[k], 20),
                                 series::sample(model, own, branches[k], 20)),
                      1e-12)
                << name << ", branch " << k;
            EXPECT_EQ(from.counts.iterations < own.counts.iterations, k < 2) << name;
        }
        // Kept for other values, from the start that was kept: the same equilibrium.
        series::keep_start(model, branches[2], {}, kept);
        ASSERT_TRUE(kept.settled) << name;
        EXPECT_LE(difference(series::sample(model, series::follow(model, branches[2], {}, kept),
                                            branches[2], 20),
                             series::sample(model, series::follow(model, branches[2], {}, analysis),
                                            branches[2], 20)),
                  1e-12)
            << name;
        series::keep_start(model, branches[0], {}, kept);
        for (Driver& driver : branches[0].drivers) driver.rate = 0;
        const series::Path still = series::follow(model, branches[0], {}, kept);
        EXPECT_EQ(still.outcome, Outcome::converged);
        EXPECT_EQ(still.counts.iterations, 0) << "nothing is to be solved";
        const auto points = series::sample(model, still, branches[0], 2).points;
        ASSERT_EQ(points.size(), 3u);
        const auto first =
            series::sample(model, series::follow(model, branches[1], {}, analysis), branches[1], 1);
        for (std::size_t b = 0; b < model.bodies.size(); ++b)
            EXPECT_LE((points[2].poses[b].r - first.points[0].poses[b].r).norm(), 1e-12);
    }
}

Model mcpherson() { return compile(support::scene("chrono_mcpherson")); }
AxialSpring& coil(Model& model) {
    for (auto& elastic : model.elastics)
        if (auto* spring = std::get_if<AxialSpring>(&elastic.kind)) return *spring;
    throw std::logic_error("no spring");
}
std::vector<Model> several(const Model& model, int count) {
    std::vector<Model> variants;
    for (int k = 0; k < count; ++k) {
        variants.push_back(model);
        std::get<LinearRate>(coil(variants.back()).law).k *= 1 + 0.01 * k;
    }
    return variants;
}

// The variant at `odd` is reported as where it is solved alone, and the others to the last bit as in
// a batch without it.
void expect_no_neighbour_affected(const Model& design, std::vector<Model> variants, std::size_t odd,
                                  const Model& what) {
    const BatchOptions options;
    const Paths before = in_batch(design, variants, options);
    variants[odd] = what;
    const Paths after = in_batch(design, variants, options);
    ASSERT_EQ(after.size(), variants.size());
    for (std::size_t k = 0; k < variants.size(); ++k)
        for (std::size_t b = 0; b < after.at(k).size(); ++b) {
            const EquilibriumPath& path = after.at(k)[b];
            if (k != odd) {
                EXPECT_EQ(path.outcome, Outcome::converged);
                EXPECT_EQ(difference(path, before.at(k)[b]), 0) << "variant " << k;
                continue;
            }
            const EquilibriumPath expected = alone(what, what.branches[b], analyse(what), options);
            EXPECT_EQ(path.outcome, expected.outcome);
            EXPECT_EQ(path.detail, expected.detail);
            ASSERT_EQ(path.points.size(), expected.points.size());
            EXPECT_TRUE(path.points.empty() || difference(path, expected) == 0);
        }
}

TEST(Batch, NonFiniteVariantFailsWithoutAffectingTheOthers) {
    const Model design = mcpherson();
    for (std::size_t odd = 0; odd < 4; ++odd) {
        Model broken = design;
        std::get<LinearRate>(coil(broken).law).k = std::nan("");
        expect_no_neighbour_affected(design, several(design, 4), odd, broken);
        broken = design;
        broken.bodies[0].design.r.x() = std::nan("");
        expect_no_neighbour_affected(design, several(design, 4), odd, broken);
    }
}

TEST(Batch, VariantOfAnotherStructureFailsWithoutAffectingTheOthers) {
    const Model design = mcpherson();
    Model other = design;
    other.elastics.pop_back();
    expect_no_neighbour_affected(design, several(design, 5), 1, other);
    other = design;
    other.branches.pop_back();
    expect_no_neighbour_affected(design, several(design, 5), 4, other);
    other = design;
    for (auto& elastic : other.elastics)
        if (auto* bushing = std::get_if<Bushing>(&elastic.kind))
            bushing->formulation.angles = Formulation::Angles::cardan;
    expect_no_neighbour_affected(design, several(design, 5), 2, other);
}

// Without the coil the strut has one more motion that nothing resists.
TEST(Batch, VariantWithAnotherIdleModeFailsWithoutAffectingTheOthers) {
    const Model design = mcpherson();
    Model loose = design;
    std::get<LinearRate>(coil(loose).law).k = 0;
    expect_no_neighbour_affected(design, several(design, 6), 3, loose);
    // A mode that is idle in the design, and is not where the mount resists it.
    Model held = design;
    for (auto& elastic : held.elastics)
        if (auto* bushing = std::get_if<Bushing>(&elastic.kind))
            std::get<LinearStiffness>(bushing->law).K(5, 5) += 1;
    expect_no_neighbour_affected(design, several(design, 6), 5, held);
}

TEST(Batch, VariantWithALimitPointFailsWithoutAffectingTheOthers) {
    const Model arch = compile(support::scene("two_spring_arch"));
    Model design = arch;
    design.branches.clear();
    for (const Branch& branch : arch.branches)
        for (const Branch& side : branch_sides(branch)) design.branches.push_back(side);
    for (Branch& branch : design.branches) branch.to *= 0.2;
    std::vector<Model> variants(4, design);
    Model far = design;
    for (Branch& branch : far.branches) branch.to *= 50;
    bool limit = false;
    for (const Branch& branch : far.branches)
        limit = limit || alone(far, branch, analyse(far), {}).outcome == Outcome::limit_point;
    ASSERT_TRUE(limit);
    expect_no_neighbour_affected(design, variants, 2, far);
}

TEST(Batch, PosesDoNotDependOnWhetherWrenchesAreRecorded) {
    const Model design = mcpherson();
    const std::vector<Model> variants = several(design, 7);
    const Paths with = in_batch(design, variants, {}),
                without = in_batch(design, variants, {.wrenches = false});
    for (const auto& [k, paths] : with)
        for (std::size_t b = 0; b < paths.size(); ++b)
            for (std::size_t p = 0; p < paths[b].points.size(); ++p)
                for (std::size_t body = 0; body < design.bodies.size(); ++body) {
                    const Pose &one = paths[b].points[p].poses[body],
                               &other = without.at(k)[b].points[p].poses[body];
                    EXPECT_EQ(one.r, other.r);
                    EXPECT_EQ(one.p.coeffs(), other.p.coeffs());
                }
}

// On a processor without AVX2 both runs are the same.
TEST(Batch, ResultsDoNotDependOnTheInstructionSet) {
    const std::string file = std::string(ELASTOCHECK_SCENES) + "/front_axle.yaml";
    const Scene scene = read_scene(file);
    Random random;
    std::vector<Model> variants;
    for (int k = 0; k < 4; ++k) variants.push_back(variant(file, scene.numbers, 1, random));
    const Paths chosen = in_batch(variants.front(), variants, {});
    batch::use_avx2(false);
    const Paths baseline = in_batch(variants.front(), variants, {});
    batch::use_avx2(true);
    for (const auto& [k, paths] : chosen)
        for (std::size_t b = 0; b < paths.size(); ++b)
            EXPECT_EQ(difference(paths[b], baseline.at(k)[b]), 0) << "variant " << k;
}

// 1 - 1.4 t + ..., whose minimum of 0.014 lies at t = 1.08: the batch judged only minima within the step.
TEST(Batch, LowDeterminantJustBesideTheStepIsLeftToTheScalarSolution) {
    const std::array<double, 3> determinants{1, 0.3, 0.02};
    EXPECT_TRUE(may_reach_zero(determinants));
    int evaluations = 0;
    (void)lowest_determinant(determinants, [&](double) {
        ++evaluations;
        return 1.;
    });
    EXPECT_GT(evaluations, 0);
    EXPECT_FALSE(may_reach_zero({1, 0.9, 0.8}));
}

TEST(Batch, UnsupportedRecordingsAreRejected) {
    const Model design = mcpherson();
    const auto ignore = [](std::size_t, std::size_t, const EquilibriumPath&) {};
    const std::vector<Model> variants{design};
    EXPECT_THROW(solve_batch(design, variants, {.points = 0}, ignore), std::invalid_argument);
    EXPECT_THROW(solve_batch(design, variants, {.series = {.arc_length = true}}, ignore),
                 std::invalid_argument);
}

TEST(Batch, LaneArithmeticEqualsThatOfDoubles) {
    Random random;
    for (int trial = 0; trial < 1000; ++trial) {
        std::array<double, 4> a{}, b{};
        batch::Lanes x = 0, y = 0;
        for (int k = 0; k < 4; ++k) {
            a[static_cast<std::size_t>(k)] = random(-1, 1);
            b[static_cast<std::size_t>(k)] = trial % 10 == k ? std::nan("") : random(-1, 1);
            set_lane(x, k, a[static_cast<std::size_t>(k)]);
            set_lane(y, k, b[static_cast<std::size_t>(k)]);
        }
        const batch::Lanes sum = x + y, quotient = x / y, larger = batch::larger(y, x);
        for (int k = 0; k < 4; ++k) {
            const auto at = static_cast<std::size_t>(k);
            if (std::isnan(b[at])) continue;
            EXPECT_EQ(lane(sum, k), a[at] + b[at]);
            EXPECT_EQ(lane(quotient, k), a[at] / b[at]);
            EXPECT_EQ(lane(larger, k), std::max(a[at], b[at]));
        }
    }
}

// A variant whose driven length vanishes before the end of the branch.
TEST(Batch, VariantWithInconsistentJointsIsReported) {
    const Model design = compile(support::scene_of("recursive/scenes/rod_that_vanishes"));
    std::vector<Model> variants(5, design);
    std::get<DistanceBetween>(variants[2].constraints[0].kind).length = 0.08;
    const auto paths = in_batch(design, variants, {.points = 10});
    for (const auto& [variant, path] : paths)
        EXPECT_EQ(path[0].outcome,
                  variant == 2 ? Outcome::inconsistent_constraints : Outcome::converged)
            << variant << " " << path[0].detail;
}

}  // namespace
}  // namespace elastocheck::recursive
