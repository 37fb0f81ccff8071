// Taylor tests of all hand-derived derivatives: V(x + h s) = V(x) + h g·s + O(h²), and the same for
// every row of Φ.

#include <numbers>

#include "models/laws.hpp"
#include "reference/energy/constraints/balance.hpp"
#include "reference/energy/potential/laws.hpp"
#include "reference/energy/potential/relative_rotation.hpp"
#include "reference/energy/potential/rotation.hpp"
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Frame = Formulation::Frame;
using Angles = Formulation::Angles;

MatrixXd matrix(const Jacobian& Phi_q) { return transposed(Phi_q).transpose(); }

struct Case {
    std::string name;
    Model model;
    Prescribed prescribed;
};

// Two bodies in random poses; each case adds elements or constraints between them or to ground.
Model two_bodies(Random& random) {
    Model model;
    model.bodies = {{"a", random.pose()}, {"b", random.pose()}};
    return model;
}

constexpr std::pair<BodyId, BodyId> pairs[] = {{0, 1}, {1, 0}, {0, ground}, {ground, 1}};

Matrix6 coupled_stiffness(Random& random) {
    Matrix6 R;
    for (int i = 0; i < 6; ++i) R.col(i) = random.many(6);
    return R * R.transpose();  // positive definite, anisotropic, without zero entries
}

Point point(Random& random, BodyId body) { return {body, random.vector()}; }
Direction direction(Random& random, BodyId body) { return {body, random.unit()}; }

PerAxis random_curves(Random& random) {
    PerAxis law;
    for (int k = 0; k < 6; ++k) law.axis[static_cast<std::size_t>(k)] = random.smooth_curve(1 + k);
    law.axis[1] = LinearRate{2};
    return law;
}

// Springs, bushings of every formulation that has an energy, with every law, forces and moments,
// unchanged and driven.
std::vector<Case> potentials(Random& random) {
    std::vector<Case> cases;
    const auto add = [&](const std::string& name, Model model, auto prescribe) {
        Prescribed prescribed = nothing_prescribed(model);
        prescribe(prescribed);
        cases.push_back({name, std::move(model), prescribed});
    };
    const auto nothing = [](Prescribed&) {};
    for (const auto& [i, j] : pairs) {
        const std::string ends = fmt::format(" {}-{}", i, j);
        Model spring = two_bodies(random), bushing = two_bodies(random);
        spring.elastics = {
            {"", AxialSpring{point(random, i), point(random, j), LinearRate{3}, 0.7}}};
        bushing.elastics = {{"", Bushing{{i, random.vector(), random.rotation()},
                                         {j, random.vector(), random.rotation()},
                                         LinearStiffness{coupled_stiffness(random)},
                                         random.many(6)}}};
        add("spring" + ends, spring, nothing);
        add("bushing" + ends, bushing, nothing);
        add("driven spring" + ends, spring, [&](Prescribed& p) {
            p.free_length << random();
            p.preload(0, 0) = random();
        });
        for (const auto frame : {Frame::on_i, Frame::on_j, Frame::middle})
            for (const auto measure : {Angles::rotation_vector, Angles::cardan, Angles::projected})
                for (const bool curved : {false, true}) {
                    Bushing b{{i, random.vector(), random.rotation(1)},
                              {j, random.vector(), random.rotation(1)},
                              curved ? SpatialLaw{random_curves(random)}
                                     : LinearStiffness{coupled_stiffness(random)},
                              random.many(6),
                              random.many(6, 0.3),
                              {frame, measure}};
                    Model model = two_bodies(random);
                    model.elastics = {{"", frame == Frame::on_j ? markers_swapped(b) : b}};
                    add(fmt::format("formulation {} {} {}{}", static_cast<int>(frame),
                                    static_cast<int>(measure), curved ? "curves" : "linear", ends),
                        model, [&](Prescribed& p) { p.preload = random.many(6); });
                }
    }
    add("force", two_bodies(random), [&](Prescribed& p) {
        p.forces = {{point(random, 0), random.vector()}, {point(random, 1), random.vector()}};
    });
    add("moment", two_bodies(random), [&](Prescribed& p) {
        p.moments = {{0, random.vector()}, {1, random.vector()}};
    });
    add("brake", two_bodies(random), [&](Prescribed& p) {
        p.brakes = {{point(random, 1), 0, random.vector()}, {point(random, 0), 1, random.vector()}};
    });
    return cases;
}

// A chart and a place in it, both well inside the range of a bushing's angles, far from
// the design pose.
struct Places {
    std::vector<Pose> centre;
    VectorXd x;
};
Places inside(Random& random, const Case& one, double size) {
    const auto* b =
        one.model.elastics.empty() ? nullptr : std::get_if<Bushing>(&one.model.elastics[0].kind);
    const auto is_inside = [&](const std::vector<Pose>& poses) {
        const auto axes = [&](const Marker& m) {
            return m.body == ground ? m.A_local
                                    : poses[static_cast<std::size_t>(m.body)].p * m.A_local;
        };
        return distance_to_singularity(b->formulation, axes(b->i).conjugate() * axes(b->j)) >= 0.4;
    };
    for (;;) {
        Places places{{random.pose(), random.pose()}, random.many(12, size)};
        Chart chart = chart_about(places.centre);
        move_to(chart, places.x);
        if (b == nullptr || (is_inside(places.centre) && is_inside(poses(chart)))) return places;
    }
}

// Every kind of constraint, unchanged and with its length, offset or angle moved.
std::vector<Case> constraint_cases(Random& random) {
    std::vector<Case> cases;
    const auto add = [&](const std::string& name, const ConstraintKind& kind) {
        Case one{name, two_bodies(random), {}};
        one.model.joints = {{name, 0, 1, {}}};
        one.model.constraints = {{0, kind}};
        one.prescribed = nothing_prescribed(one.model);
        cases.push_back(one);
        one.name += ", moved";
        one.prescribed.offset << 0.3;
        one.prescribed.gap = random.many(rows(kind));
        cases.push_back(one);
    };
    for (const auto& [i, j] : pairs) {
        const std::string ends = fmt::format(" {}-{}", i, j);
        add("coincident points" + ends, CoincidentPoints{point(random, i), point(random, j)});
        add("point in plane" + ends,
            PointInPlane{point(random, i), point(random, j), direction(random, j), 0.2});
        add("perpendicular" + ends,
            PerpendicularDirections{direction(random, i), direction(random, j)});
        add("distance" + ends, DistanceBetween{point(random, i), point(random, j), 0.9});
        const Direction x = direction(random, j);
        const Direction y{j, x.u_local.unitOrthogonal()};
        add("direction at angle" + ends, DirectionAtAngle{direction(random, i), x, y, 0.7});
    }
    return cases;
}

struct Values {
    VectorXd f;  // any number of functions
    MatrixXd f_x;
};

// Remainders of the first-order expansion in several directions, at h and h/2. Returns the observed
// order; 2 when there is no remainder at all.
template <class F>
double observed_order(Random& random, int n, const VectorXd& x, F values_at,
                      double roundoff = 1e-14) {
    const Values at = values_at(x);
    double remainder[2] = {0, 0};
    for (int k = 0; k < 8; ++k) {
        const VectorXd s = random.many(n);
        for (const int half : {0, 1}) {
            const double h = half ? 2e-4 : 4e-4;
            remainder[half] += (values_at(x + h * s).f - at.f - h * at.f_x * s).squaredNorm();
        }
    }
    if (std::sqrt(remainder[0]) <= roundoff * (1 + at.f_x.norm())) return 2;
    return 0.5 * std::log2(remainder[0] / remainder[1]);
}

TEST(Derivatives, GradientOfEveryPotentialIsFirstOrderExact) {
    Random random;
    for (int repeat = 0; repeat < 6; ++repeat) {
        for (const auto& one : potentials(random)) {
            const auto [centre, place] = inside(random, one, 0.6);
            Chart chart = chart_about(centre);
            const auto values = [&](const VectorXd& x) -> Values {
                move_to(chart, x);
                const Potential V = potential(one.model, one.prescribed, chart);
                return {VectorXd::Constant(1, V.change), V.gradient.transpose()};
            };
            EXPECT_NEAR(observed_order(random, 12, place, values), 2, 0.1) << one.name;
        }
    }
}

TEST(Derivatives, JacobianOfEveryConstraintIsFirstOrderExact) {
    Random random;
    for (int repeat = 0; repeat < 25; ++repeat) {
        for (const auto& one : constraint_cases(random)) {
            Chart chart = chart_about({random.pose(), random.pose()});
            const auto values = [&](const VectorXd& x) -> Values {
                move_to(chart, x);
                const ConstraintValues c = constraints(one.model, one.prescribed, chart);
                return {c.Phi, matrix(c.Phi_q)};
            };
            EXPECT_NEAR(observed_order(random, 12, random.many(12, 0.8), values), 2, 0.1)
                << one.name;
        }
    }
}

// Random rates of everything a driver can move, together or one by one.
Prescribed random_rate(const Model& model, Random& random) {
    Prescribed rate = nothing_prescribed(model);
    for (BodyId b = 0; b < 2; ++b) {
        rate.forces.push_back({point(random, b), random.vector()});
        rate.moments.push_back({b, random.vector()});
        rate.brakes.push_back({point(random, 1 - b), b, random.vector()});
    }
    rate.offset = random.many(static_cast<int>(rate.offset.size()));
    rate.free_length = random.many(static_cast<int>(rate.free_length.size()));
    for (Eigen::Index k = 0; k < rate.preload.cols(); ++k) rate.preload.col(k) = random.many(6);
    rate.gap = random.many(static_cast<int>(rate.gap.size()));
    return rate;
}

// g(a + h) = g(a) + ∂g/∂a h + O(h²), for the gradient of V under every driver, along two
// rates at once.
TEST(Derivatives, RateOfEveryGradientIsFirstOrderExact) {
    Random random;
    for (int repeat = 0; repeat < 6; ++repeat) {
        for (const auto& one : potentials(random)) {
            const auto [centre, place] = inside(random, one, 0.6);
            Chart chart = chart_about(centre);
            move_to(chart, place);
            const Prescribed rates[] = {random_rate(one.model, random),
                                        random_rate(one.model, random)};
            const auto values = [&](const VectorXd& a) -> Values {
                const Prescribed now = sum(sum(one.prescribed, a[0], rates[0]), a[1], rates[1]);
                MatrixXd g_a(12, 2);
                for (const int k : {0, 1})
                    g_a.col(k) = gradient_rate(one.model, now, rates[k], chart);
                return {potential(one.model, now, chart).gradient, g_a};
            };
            EXPECT_NEAR(observed_order(random, 2, random.many(2), values, 1e-12), 2, 0.1)
                << one.name;
        }
    }
}

// As above, for every constraint and its Jacobian.
TEST(Derivatives, RateOfEveryConstraintIsFirstOrderExact) {
    Random random;
    for (int repeat = 0; repeat < 25; ++repeat) {
        for (const auto& one : constraint_cases(random)) {
            Chart chart = chart_about({random.pose(), random.pose()});
            move_to(chart, random.many(12, 0.8));
            const Prescribed rates[] = {random_rate(one.model, random),
                                        random_rate(one.model, random)};
            const auto values = [&](const VectorXd& a) -> Values {
                const Prescribed now = sum(sum(one.prescribed, a[0], rates[0]), a[1], rates[1]);
                const ConstraintValues c = constraints(one.model, now, chart);
                const MatrixXd Phi_q = matrix(c.Phi_q);
                VectorXd f(c.Phi.size() + Phi_q.size());
                MatrixXd f_a(f.size(), 2);
                f << c.Phi, Phi_q.reshaped();
                for (const int k : {0, 1}) {
                    const ConstraintRates c_a = constraint_rates(one.model, now, rates[k], chart);
                    f_a.col(k) << c_a.Phi_a, matrix(c_a.Phi_qa).reshaped();
                }
                return {f, f_a};
            };
            EXPECT_NEAR(observed_order(random, 2, random.many(2, 0.1), values, 1e-12), 2, 0.1)
                << one.name;
        }
    }
}

// A driven angle in the opposite direction satisfies Φ = 0 too; the residuals must distinguish it.
TEST(Constraints, OppositeDirectionOfADrivenAngleHasAResidual) {
    Model model;
    model.bodies = {{"a", {}}};
    for (const double angle : {-4.0, -1.0, 0.0, 0.4, 2.0, 3.1, 7.0}) {
        const DirectionAtAngle kind{
            {0, Vector3d::UnitX()}, {ground, Vector3d::UnitX()}, {ground, Vector3d::UnitY()}, 0};
        for (const bool opposite : {false, true}) {
            const Eigen::Quaterniond turn(
                Eigen::AngleAxisd(angle + (opposite ? std::numbers::pi : 0), Vector3d::UnitZ()));
            const Chart chart = chart_about({{Vector3d::Zero(), turn}});
            const double apart =
                std::remainder(*measured_offset(kind, chart) - angle, 2 * std::numbers::pi);
            EXPECT_NEAR(std::abs(apart), opposite ? std::numbers::pi : 0, 1e-12) << angle;
        }
    }
}

// The bushing's law is regular at rest, θ = 0 and d = 0.
TEST(Derivatives, BushingAtRestIsRegular) {
    Random random;
    Model model = two_bodies(random);
    const Pose& a = model.bodies[0].design;
    model.bodies[1].design = a;
    model.elastics = {{"", Bushing{Marker{0}, Marker{1}, LinearStiffness{coupled_stiffness(random)},
                                   random.many(6)}}};
    Chart chart = chart_about({a, a});
    const auto values = [&](const VectorXd& x) -> Values {
        move_to(chart, x);
        const Potential V = potential(model, nothing_prescribed(model), chart);
        return {VectorXd::Constant(1, V.change), V.gradient.transpose()};
    };
    for (const double size : {0.0, 1e-12, 1e-6, 1e-4, 1e-2}) {
        EXPECT_NEAR(observed_order(random, 12, random.many(12, size), values), 2, 0.1) << size;
    }
}

TEST(Derivatives, HessianAgreesWithDifferencesOfTheGradient) {
    Random random;
    Scales scales;
    scales.length = 0.7;
    scales.force = 1.3;
    for (const auto& one : potentials(random)) {
        Model model = one.model;
        for (const auto& c : constraint_cases(random)) {
            model.joints.push_back(c.model.joints[0]);
            model.constraints.push_back(
                {static_cast<int>(model.joints.size()) - 1, c.model.constraints[0].kind});
        }
        Prescribed prescribed = one.prescribed;
        prescribed.offset = random.many(static_cast<int>(model.constraints.size()), 0.3);
        prescribed.gap = VectorXd::Zero(constraint_rows(model));
        const auto centre = inside(random, one, 0.1).centre;
        const VectorXd lambda = random.many(constraint_rows(model));
        const MatrixXd H = hessian(model, prescribed, scales, centre, lambda);
        const VectorXd S = scales.coordinates(12);
        Chart chart = chart_about(centre);
        MatrixXd D(12, 12);
        for (int i = 0; i < 12; ++i) {
            VectorXd g[2];
            for (const int side : {0, 1}) {
                move_to(chart, S.cwiseProduct((side ? 1e-5 : -1e-5) * VectorXd::Unit(12, i)));
                g[side] = potential(model, prescribed, chart).gradient / scales.energy() +
                          matrix(constraints(model, prescribed, chart).Phi_q).transpose() *
                              scales.rows(model).cwiseProduct(lambda);
            }
            D.col(i) = S.cwiseProduct(g[1] - g[0]) / 2e-5;
        }
        EXPECT_LE((H - D).norm(), 1e-7 * H.norm()) << one.name;
        EXPECT_LE((H - H.transpose()).norm(), 1e-14 * H.norm()) << one.name;
    }
}

// The balance in ground axes is the gradient at the centre of a chart, here recentred at every
// state. Away from equilibrium that of the chart's potential, Jᵀ g, changes by ½ g × φ more.
TEST(Derivatives, LoadsWithoutPotentialAddTheirStiffnessToTheHessian) {
    Random random;
    Scales scales;
    scales.length = 0.7, scales.force = 1.3;
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Model model = two_bodies(random);
        Prescribed p = nothing_prescribed(model);
        p.forces = {{point(random, 1), random.vector()}};
        p.moments = {{0, random.vector()}};
        p.brakes = {{point(random, 1), 0, random.vector()}, {point(random, 0), 1, random.vector()}};
        const auto centre = std::vector{random.pose(), random.pose()};
        const VectorXd S = scales.coordinates(12);
        const auto balanced = [&](const std::vector<Pose>& at) -> VectorXd {
            return S.cwiseProduct(potential(model, p, chart_about(at)).gradient) / scales.energy();
        };
        MatrixXd K = hessian(model, p, scales, centre, VectorXd()) +
                     load_stiffness(p, scales, centre),
                 D(12, 12);
        const VectorXd g = balanced(centre);
        for (const int turn : {3, 9}) K.block<3, 3>(turn, turn) -= 0.5 * skew(g.segment<3>(turn));
        for (int i = 0; i < 12; ++i) {
            VectorXd sides[2];
            for (const int side : {0, 1}) {
                Chart chart = chart_about(centre);
                move_to(chart, S.cwiseProduct((side ? 1e-5 : -1e-5) * VectorXd::Unit(12, i)));
                sides[side] = balanced(poses(chart));
            }
            D.col(i) = (sides[1] - sides[0]) / 2e-5;
        }
        EXPECT_LE((K - D).norm(), 1e-8 * K.norm());
    }
}

// The laws of include/elastocheck/mechanism.hpp, implemented independently from the poses.
double energy(const Model& model, const std::vector<Pose>& poses) {
    const auto at = [&](BodyId body) {
        return body == ground ? Pose{} : poses[static_cast<std::size_t>(body)];
    };
    const auto place = [&](const auto& p) -> Vector3d {
        return at(p.body).r + at(p.body).p * p.s_local;
    };
    double U = 0;
    for (const auto& elastic : model.elastics) {
        if (const auto* spring = std::get_if<AxialSpring>(&elastic.kind)) {
            const double stretch =
                (place(spring->j) - place(spring->i)).norm() - spring->free_length;
            U += 0.5 * std::get<LinearRate>(spring->law).k * stretch * stretch;
        } else {
            const auto& b = std::get<Bushing>(elastic.kind);
            const Eigen::Quaterniond A_i = at(b.i.body).p * b.i.A_local,
                                     A_j = at(b.j.body).p * b.j.A_local;
            const Eigen::AngleAxisd turn(A_i.conjugate() * A_j);
            Vector6 e;
            e << A_i.conjugate() * (place(b.j) - place(b.i)), turn.angle() * turn.axis();
            U += 0.5 * e.dot(std::get<LinearStiffness>(b.law).K * e) + b.preload.dot(e);
        }
    }
    return U;
}

TEST(Potential, PotentialEqualsTheEnergyOfTheElementLaws) {
    Random random;
    double worst = 0;
    for (int repeat = 0; repeat < 20; ++repeat) {
        for (const auto& one : potentials(random)) {
            if (!one.name.starts_with("spring") && !one.name.starts_with("bushing")) continue;
            const std::vector<Pose> centre{random.pose(), random.pose()};
            Chart chart = chart_about(centre);
            // Small enough for the logarithm to stay on its sheet in most cases; the
            // others are skipped.
            move_to(chart, random.many(12, 0.1));
            const double expected = energy(one.model, poses(chart)) - energy(one.model, centre);
            if (rotations(one.model, turning_bushings(one.model, {one.prescribed, one.prescribed}),
                          centre)
                    .norm() > 2.8)
                continue;
            double change = potential(one.model, one.prescribed, chart).change;
            worst = std::max(worst, std::abs(change - expected) / (1 + energy(one.model, centre)));
        }
    }
    EXPECT_LE(worst, 1e-13);
}

TEST(Potential, IsUnchangedByARigidMotionOfEverything) {
    Random random;
    double worst_change = 0, worst_force = 0;
    for (int repeat = 0; repeat < 100; ++repeat) {
        Model model = two_bodies(random);
        model.elastics = {{"", AxialSpring{point(random, 0), point(random, 1), LinearRate{3}, 0.7}},
                          {"", Bushing{{1, random.vector(), random.rotation()},
                                       {0, random.vector(), random.rotation()},
                                       LinearStiffness{coupled_stiffness(random)},
                                       random.many(6)}}};
        const std::vector<Pose> centre{random.pose(), random.pose()};
        Chart chart = chart_about(centre);
        const Vector3d t = random.vector(), phi = random.unit() * random(0, 3);
        const Eigen::AngleAxisd Q(phi.norm(), phi.normalized());
        VectorXd x(12);
        for (int b = 0; b < 2; ++b) {
            const Vector3d& r = centre[static_cast<std::size_t>(b)].r;
            x.segment<6>(6 * b) << Q * r + t - r, phi;
        }
        const VectorXd g = potential(model, nothing_prescribed(model), chart).gradient;
        move_to(chart, x);
        worst_change = std::max(
            worst_change,
            std::abs(potential(model, nothing_prescribed(model), chart).change) / g.norm());
        const Vector3d force = g.segment<3>(0) + g.segment<3>(6);
        const Vector3d moment = g.segment<3>(3) + g.segment<3>(9) +
                                centre[0].r.cross(g.segment<3>(0)) +
                                centre[1].r.cross(g.segment<3>(6));
        worst_force = std::max(worst_force, std::max(force.norm(), moment.norm()) / g.norm());
    }
    EXPECT_LE(worst_change, 1e-14);
    EXPECT_LE(worst_force, 1e-14);
}

// A change of 1e-10 at a level of 1 has a relative error of 1e-13: by the trapezoidal rule
// V(x) - V(0) = ½ (g(0) + g(x))·x + O(x³).
TEST(Potential, ChangesKeepTheirRelativeAccuracy) {
    Random random;
    for (int repeat = 0; repeat < 10; ++repeat) {
        for (const auto& one : potentials(random)) {
            Chart chart = chart_about(inside(random, one, 0.1).centre);
            const VectorXd g_c = potential(one.model, one.prescribed, chart).gradient,
                           x = random.many(12, 1e-10);
            move_to(chart, x);
            const Potential V = potential(one.model, one.prescribed, chart);
            const double expected = 0.5 * (g_c + V.gradient).dot(x);
            EXPECT_LE(std::abs(V.change - expected) / (g_c.norm() * x.norm()),
                      one.name.starts_with("formulation") ? 2e-14 : 1e-14)
                << one.name;
        }
    }
}

TEST(Constraints, ChangesAgreeWithValuesAndKeepTheirRelativeAccuracy) {
    Random random;
    double worst = 0, worst_small = 0;
    for (int repeat = 0; repeat < 20; ++repeat) {
        for (const auto& one : constraint_cases(random)) {
            Chart chart = chart_about({random.pose(), random.pose()});
            const ConstraintValues c = constraints(one.model, one.prescribed, chart);
            EXPECT_TRUE(c.dPhi.isZero(0)) << one.name;
            move_to(chart, random.many(12, 0.5));
            const ConstraintValues now = constraints(one.model, one.prescribed, chart);
            worst = std::max(worst, (now.Phi - c.Phi - now.dPhi).norm());
            const VectorXd x = random.many(12, 1e-10);
            move_to(chart, x);
            const ConstraintValues near = constraints(one.model, one.prescribed, chart);
            const VectorXd expected = 0.5 * (matrix(c.Phi_q) + matrix(near.Phi_q)) * x;
            worst_small = std::max(
                worst_small, (near.dPhi - expected).norm() / (matrix(c.Phi_q).norm() * x.norm()));
        }
    }
    EXPECT_LE(worst, 2e-14);
    EXPECT_LE(worst_small, 1e-14);
}

}  // namespace
}  // namespace elastocheck::reference::energy
