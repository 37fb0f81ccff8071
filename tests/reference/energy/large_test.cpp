// Large scenes: predicted cost, the limit of solving, the sparse method, and judging at any size.

#include "reference/energy/constraints/quadratic.hpp"
#include "reference/energy/linear_response.hpp"
#include "reference/energy/minimise/cost.hpp"
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// A cantilever of one metre in n links along x, connected by bushings or by hinges about y with
// torsion springs; an upward force at its tip. Straight in the design position.
Scene chain(int n, bool hinged) {
    const double h = 1.0 / n, k = 100 / h;
    Scene scene;
    scene.name = "chain";
    for (int b = 0; b < n; ++b) {
        scene.bodies.push_back(
            {fmt::format("b{}", b), {Vector3d(b * h, 0, 0), Eigen::Quaterniond::Identity()}});
        const BodyId i = b == 0 ? ground : b - 1;
        const Vector3d at(b == 0 ? 0 : h, 0, 0);
        scene.elastics.push_back(
            {fmt::format("k{}", b),
             support::bushing({i, at}, {b}, Vector3d::Constant(hinged ? 0 : 1e6 * n),
                              hinged ? Vector3d(0, k, 0) : Vector3d(k, k, k))});
        if (hinged)
            scene.joints.push_back({fmt::format("j{}", b), Revolute{{i, at},
                                                                    {b, Vector3d::Zero()},
                                                                    {i, Vector3d::UnitY()},
                                                                    {b, Vector3d::UnitY()}}});
    }
    const Point tip{n - 1, Vector3d(h, 0, 0)};
    scene.probes.push_back({"tip", tip});
    scene.branches = {load_branch(DeadForce{tip, Vector3d::UnitZ()}, 50)};
    scene.branches[0].name = "up", scene.branches[0].steps = 5;
    return scene;
}

// Straight links with a constant angle between them: no equilibrium, but every joint is closed.
Equilibrium bent(const Model& model, double angle) {
    const double h = 1.0 / static_cast<double>(model.bodies.size());
    Equilibrium state{.load = 50, .poses = {}, .reactions = {}};
    Vector3d r = Vector3d::Zero();
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const Eigen::Quaterniond p(
            Eigen::AngleAxisd(-angle * static_cast<double>(b + 1), Vector3d::UnitY()));
        state.poses.push_back({r, p});
        r += p * Vector3d(h, 0, 0);
    }
    return state;
}

TEST(LargeScenes, WorkIsPredictedWithinAFactorOfFour) {
    const auto is_near = [](double foreseen, double counted) {
        return std::isfinite(foreseen) && foreseen <= 4 * counted && counted <= 4 * foreseen;
    };
    std::vector<Model> models;
    for (const char* name : {"chrono_mcpherson", "pinned_bar", "four_bar", "bushing_pair"})
        models.push_back(compile(scene_named(name)));
    for (const int n : {2, 5, 12, 20})
        for (const bool hinged : {false, true}) models.push_back(compile(chain(n, hinged)));
    for (const auto& all : models) {
        const Branch branch = branch_sides(all.branches[0]).front();
        const Model model = on_branch(all, branch);
        const auto values = every_point(branch);
        const Cost cost = cost_of(model, values.size());
        const Counts counts = solve(model, branch, values).counts;
        // Besides the evaluations in charts, a state takes one and another for its Hessian.
        const auto states = static_cast<double>(counts.evaluations - counts.factorisations);
        const double evaluations = static_cast<double>(counts.factorisations) - states;
        EXPECT_TRUE(is_near(cost.states, states))
            << model.name << " " << cost.states << " " << states;
        if (is_large(model)) continue;
        EXPECT_TRUE(is_near(cost.evaluations, evaluations))
            << model.name << " " << cost.evaluations << " " << evaluations;
    }
}

TEST(LargeScenes, DenseWorkGrowsWithTheCubeAndSparseWorkLinearly) {
    for (const bool hinged : {false, true}) {
        const Model small = compile(chain(40, hinged)), twice = compile(chain(80, hinged));
        EXPECT_NEAR(dense_cost(twice, 6).operations() / dense_cost(small, 6).operations(), 8, 1e-9);
        EXPECT_NEAR(cost_of(twice, 6).operations() / cost_of(small, 6).operations(), 2, 0.1);
    }
    const Cost joints = dense_cost(compile(chain(40, true)), 6),
               bushings = dense_cost(compile(chain(40, false)), 6);
    EXPECT_GE(joints.per_evaluation, 2 * bushings.per_evaluation);  // 5 rows for 6 coordinates
}

TEST(LargeScenes, TooLargeSceneIsNotSolvedAndItsWorkIsReported) {
    for (const bool hinged : {false, true}) {
        const auto path = solve(chain(1000, hinged), 0, std::vector<double>(1000, 50));
        EXPECT_EQ(path.outcome, Outcome::too_large);
        EXPECT_TRUE(path.points.empty());
        EXPECT_EQ(path.counts.evaluations, 0);
        for (const char* part :
             {"branch 'up': about ", "e+1",
              "operations for 6000 coordinates, the limit of the energy leg is 1e+11"})
            EXPECT_NE(path.detail.find(part), std::string::npos) << path.detail;
        EXPECT_STREQ(name(path.outcome), "too large");
        const Model model = compile(chain(1000, hinged));
        const Equilibrium state{0, std::vector<Pose>(model.bodies.size()), {}, 0};
        const Disturbance pull = UnitWrench{{999, Vector3d::Zero()}, Vector3d::UnitX()};
        EXPECT_EQ(linear_response(model, model.branches[0], state, {&pull, 1}).outcome,
                  Outcome::too_large);
    }
}

// A cantilever of equal links with torsion springs k under a force P at its tip: with the angle φ
// of each link, k (φ_i - φ_{i-1}) = Σ_{j >= i} P h cos φ_j. From a tip angle down to the root the
// equations give one angle after another; the tip angle is found by bisection.
double height_of_the_tip(int n, double P) {
    const double h = 1.0 / n, k = 100 / h;
    const auto shot = [&](double tip) {
        double phi = tip, moment = 0, height = 0;
        for (int i = 0; i < n; ++i) {
            moment += P * h * std::cos(phi);
            height += h * std::sin(phi);
            phi -= moment / k;
        }
        return std::pair(phi, height);  // the root's angle must be zero
    };
    double low = 0, high = 1.5;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (shot(middle).first < 0 ? low : high) = middle;
    }
    return shot(low).second;
}

TEST(LargeScenes, ChainOfHingesEqualsItsDiscreteSolution) {
    for (const int n : {16, 300}) {
        const Scene scene = chain(n, true);
        const auto path = solve(scene, 0, every_point(scene.branches[0]));
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        ASSERT_EQ(path.points.size(), 6u);
        for (const auto& point : path.points) {
            const Pose& last = point.poses.back();
            const double z = (last.r + last.p * Vector3d(1.0 / n, 0, 0)).z();
            EXPECT_NEAR(z, height_of_the_tip(n, point.load), 1e-10) << n << " " << point.load;
        }
        EXPECT_GE(path.points.back().poses.back().r.z(), 0.1);
    }
}

TEST(LargeScenes, SparseMinimumIsStationaryInTheDenseConditions) {
    for (const bool hinged : {false, true}) {
        const Scene scene = chain(20, hinged);
        const Model model = compile(scene);
        EXPECT_TRUE(is_large(model));
        const auto path = solve(scene, 0, every_point(scene.branches[0]));
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        const Course course = course_of(model, model.branches[0]);
        for (const auto& point : path.points) {
            const Scales scales = scales_of(model, course, {&point.load, 1});
            const auto prescribed = at(course, point.load);
            const Balance dense = balance(model, prescribed, scales, chart_about(point.poses));
            EXPECT_LE(largest(dense.Phi), 1e-12);
            const Modes modes =
                modes_of(dense, hessian(model, prescribed, scales, point.poses, dense.lambda));
            EXPECT_LE(excess(dense.projected_gradient, dense.Phi, modes, scales, 1e-12), 1e-11);
            EXPECT_GT(modes.stiffness[0], modes.idle_limit);
        }
    }
}

TEST(LargeScenes, SoftestModesEqualThoseOfTheDenseHessian) {
    const Model model = compile(chain(20, true));
    const Scales scales = lengths_of(model, course_of(model, model.branches[0]));
    const auto centre = bent(model, 0.05).poses;
    const Prescribed nothing = nothing_prescribed(model);
    const Chart chart = chart_about(centre);
    const Balance dense = balance(model, nothing, scales, chart);
    const Modes all = modes_of(dense, hessian(model, nothing, scales, centre, dense.lambda));
    const Quadratic quadratic(
        scaled(hessian_blocks(model, nothing, scales, centre, dense.lambda), scales),
        scaled(load_blocks(nothing, centre), scales),
        scaled(constraints(model, nothing, chart).Phi_q, scales.rows(model),
               scales.coordinates(coordinates(model))));
    const Modes some = quadratic.softest({});
    EXPECT_EQ(some.other_falling_modes, 0);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(some.stiffness[i] / all.stiffness[i], 1, 1e-3) << i;
    Random random;
    const VectorXd b = random.many(coordinates(model));
    const VectorXd x = quadratic.minimum(b, {}, Eigen::MatrixXd(b.size(), 0)).x,
                   y = -all.Z * (all.Z.transpose() * b).cwiseQuotient(all.stiffness);
    EXPECT_LE((x - y).norm(), 1e-7 * y.norm());
}

// The energy leg solves all built-in suspensions with all values of their branches.
TEST(LargeScenes, BuiltInSuspensionsAreNotTooLarge) {
    for (const char* name : {"mcpherson", "solid_axle_leaf", "front_axle", "twist_beam"}) {
        const Model all = compile(scene_named(name));
        for (const auto& branch : all.branches)
            EXPECT_LE(cost_of(on_branch(all, branch), static_cast<std::size_t>(branch.steps) + 1)
                          .operations(),
                      Options{}.operation_limit)
                << name << " " << branch.name;
    }
}

// Sparse and dense QR give the same projected gradient, also with redundant rows.
TEST(LargeScenes, SparseProjectedGradientEqualsTheDenseOne) {
    Random random;
    for (const bool doubled : {false, true}) {
        Scene scene = chain(20, true);
        if (doubled) {
            for (int k : {3, 4, 9})
                scene.joints.push_back(scene.joints[static_cast<std::size_t>(k)]);
            for (std::size_t k = 20; k < scene.joints.size(); ++k) scene.joints[k].name += "again";
        }
        const Model model = compile(scene, Detail::everything);
        const Scales scales = lengths_of(model, course_of(model, model.branches[0]));
        const Chart chart = chart_about(bent(model, 0.05).poses);
        const auto values = constraints(model, nothing_prescribed(model), chart);
        EXPECT_EQ(values.Phi.size(), doubled ? 115 : 100);
        const VectorXd gradient = random.many(coordinates(model)),
                       S = scales.coordinates(coordinates(model));
        const Balance dense = balance(model, scales, gradient, values);
        EXPECT_EQ(dense.independent.size(), 100u);
        const auto [projected, lambda] =
            project_gradient(scaled(values.Phi_q, scales.rows(model), S),
                             S.cwiseProduct(gradient) / scales.energy());
        EXPECT_LE((projected - dense.projected_gradient).norm(), 1e-13 * gradient.norm());
        EXPECT_GE(projected.norm(), 0.01 * gradient.norm());
        // also the multipliers, of minimum norm where the rows are redundant
        EXPECT_LE((lambda - dense.lambda).norm(), 1e-10 * dense.lambda.norm());
    }
}

// At the equilibrium's own poses the residual is zero; moved by a micrometre, bushings in a chain
// of a thousand links exert forces, and hinges open.
TEST(LargeScenes, MicrometreInAChainOfThousandLinksIsDetected) {
    for (const bool hinged : {false, true}) {
        const Model model = compile(chain(1000, hinged));
        Equilibrium state = bent(model, 0);
        state.load = 0;  // straight in the design position
        const Residuals before = residuals(model, model.branches[0], state);
        EXPECT_LE(largest(before), 1e-6);  // 1e9 N/m times the round-off of a metre
        state.poses[500].r.z() += 1e-6;
        const Residuals after = residuals(model, model.branches[0], state);
        if (hinged)
            EXPECT_NEAR(after.length, 1e-6, 1e-12);
        else
            EXPECT_NEAR(after.force, 2 * 1e9 * 1e-6, 1);
    }
}

// With all hinges closed only moments remain: the part of the springs' moments that the force does
// not balance.
TEST(LargeScenes, UnbalancedChainOfHingesHasAMomentResidual) {
    const Model model = compile(chain(300, true));
    const Residuals left = residuals(model, model.branches[0], bent(model, 1e-3));
    EXPECT_LE(left.length, 1e-14);
    EXPECT_TRUE(std::isfinite(left.moment));
    EXPECT_GE(left.moment, 1e-3);
    Equilibrium lost = bent(model, 1e-3);
    lost.poses[200].r.x() = NAN;
    EXPECT_TRUE(std::isnan(residuals(model, model.branches[0], lost).force));
}

}  // namespace
}  // namespace elastocheck::reference::energy
