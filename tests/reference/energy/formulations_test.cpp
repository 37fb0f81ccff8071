// Bushing formulations with an energy, with every law: the stated energy, its gradient and Hessian,
// and the end of the branch at the end of a law.
#include <numbers>

#include "models/laws.hpp"
#include "reference/energy/constraints/balance.hpp"
#include "reference/energy/potential/laws.hpp"
#include "reference/energy/potential/relative_rotation.hpp"
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Frame = Formulation::Frame;
using Angles = Formulation::Angles;

constexpr Frame frames[] = {Frame::on_i, Frame::on_j, Frame::middle};
constexpr Angles measures[] = {Angles::rotation_vector, Angles::cardan, Angles::projected};
constexpr std::pair<BodyId, BodyId> pairs[] = {{0, 1}, {1, 0}, {0, ground}, {ground, 1}};

SpatialLaw random_law(Random& random, bool curved) {
    if (!curved) {
        Matrix6 R;
        for (int i = 0; i < 6; ++i) R.col(i) = random.many(6);
        return LinearStiffness{R * R.transpose()};
    }
    PerAxis law;
    for (int k = 0; k < 6; ++k) law.axis[static_cast<std::size_t>(k)] = random.smooth_curve(1 + k);
    law.axis[1] = LinearRate{2};
    return law;
}

struct Case {
    std::string name;
    Bushing bushing;  // as requested, with its frame on j too
    Model model;      // as compiled
};

std::vector<Case> cases(Random& random) {
    std::vector<Case> all;
    for (const Frame frame : frames)
        for (const Angles measure : measures)
            for (const bool curved : {false, true})
                for (const auto& [i, j] : pairs) {
                    Bushing b{{i, random.vector(), random.rotation(1)},
                              {j, random.vector(), random.rotation(1)},
                              random_law(random, curved),
                              random.many(6),
                              random.many(6, 0.3),
                              {frame, measure}};
                    Model model;
                    model.bodies = {{"a", {}}, {"b", {}}};
                    model.elastics = {{"b", frame == Frame::on_j ? markers_swapped(b) : b}};
                    all.push_back(
                        {fmt::format("frame {} angles {} {} {}-{}", static_cast<int>(frame),
                                     static_cast<int>(measure), curved ? "curves" : "linear", i, j),
                         b, model});
                }
    return all;
}

Quaterniond relative(const Bushing& b, const std::vector<Pose>& poses) {
    const auto axes = [&](const Marker& m) {
        return m.body == ground ? m.A_local : poses[static_cast<std::size_t>(m.body)].p * m.A_local;
    };
    return axes(b.i).conjugate() * axes(b.j);
}

// Poses well inside the range of the formulation, far from the design pose, on the sheet of the
// principal values of `B`; x leads to a second such set of poses.
struct Places {
    std::vector<Pose> centre;
    VectorXd x;
};
Places inside(Random& random, const Case& one, double size) {
    const auto& b = std::get<Bushing>(one.model.elastics[0].kind);
    for (;;) {
        Places places{
            {{random.vector(), random.rotation(2)}, {random.vector(), random.rotation(2)}},
            random.many(12, size)};
        Chart chart = chart_about(places.centre);
        move_to(chart, places.x);
        if (way_to_the_end(b.formulation, relative(b, places.centre)) >= 0.4 &&
            way_to_the_end(b.formulation, relative(b, poses(chart))) >= 0.4)
            return places;
    }
}

// ---- The laws of include/elastocheck/mechanism.hpp, implemented independently from the poses.

double u(const ScalarLaw& law, double x) {
    if (const auto* line = std::get_if<LinearRate>(&law)) return 0.5 * line->k * x * x;
    // verified in laws_test.cpp: the integral of f from 0
    return values(law, Vector1(0.0), Vector1(x)).change;
}
double u(const SpatialLaw& law, const Vector6& x) {
    if (const auto* line = std::get_if<LinearStiffness>(&law)) return 0.5 * x.dot(line->K * x);
    double sum = 0;
    for (int k = 0; k < 6; ++k)
        sum += u(std::get<PerAxis>(law).axis[static_cast<std::size_t>(k)], x[k]);
    return sum;
}

Vector6 deformation(const Bushing& b, const std::vector<Pose>& poses) {
    const auto at = [&](BodyId body) {
        return body == ground ? Pose{} : poses[static_cast<std::size_t>(body)];
    };
    const auto place = [&](const Marker& m) -> Vector3d {
        return at(m.body).r + at(m.body).p * m.s_local;
    };
    const Quaterniond A_i = at(b.i.body).p * b.i.A_local, A_j = at(b.j.body).p * b.j.A_local;
    const Matrix3d B = (A_i.conjugate() * A_j).toRotationMatrix();
    Vector3d theta;
    switch (b.formulation.angles) {
        case Angles::rotation_vector: {
            const Eigen::AngleAxisd turn(B);
            theta = turn.angle() * turn.axis();
            break;
        }
        case Angles::cardan:
            theta << std::atan2(-B(1, 2), B(2, 2)), std::asin(B(0, 2)),
                std::atan2(-B(0, 1), B(0, 0));
            break;
        case Angles::projected:
            theta << std::atan2(-B(1, 2), B(2, 2)), std::atan2(B(0, 2), B(2, 2)),
                std::atan2(B(1, 0), B(0, 0));
            break;
    }
    Quaterniond A_f = A_i;
    if (b.formulation.frame == Frame::on_j) A_f = A_j;
    if (b.formulation.frame == Frame::middle) A_f = A_i.slerp(0.5, A_j);
    Vector6 e;
    e << A_f.conjugate() * (place(b.j) - place(b.i)), theta;
    return e;
}

// A frame on j has the angles of the bushing with exchanged markers, with opposite sign.
double stated_energy(const Bushing& b, const std::vector<Pose>& poses) {
    Vector6 e = deformation(b, poses);
    if (b.formulation.frame == Frame::on_j) {
        Bushing other = b;
        std::swap(other.i, other.j);
        e.tail<3>() = -deformation(other, poses).tail<3>();
    }
    return u(b.law, e - b.undeformed) + b.preload.dot(e);
}

Potential potential_at(const Case& one, Chart& chart, const VectorXd& x) {
    move_to(chart, x);
    return potential(one.model, nothing_prescribed(one.model), chart);
}

TEST(Formulations, EnergyIsTheOneStated) {
    Random random;
    double worst = 0;
    for (int repeat = 0; repeat < 10; ++repeat) {
        for (const auto& one : cases(random)) {
            const auto [centre, x] = inside(random, one, 0.3);
            Chart chart = chart_about(centre);
            const double change = potential_at(one, chart, x).change;
            const double before = stated_energy(one.bushing, centre),
                         expected = stated_energy(one.bushing, poses(chart)) - before;
            const double error =
                std::abs(change - expected) / (1 + std::abs(before) + std::abs(expected));
            EXPECT_LE(error, 1e-12) << one.name;
            worst = std::max(worst, error);
        }
    }
    EXPECT_LE(worst, 2e-13);
}

TEST(Formulations, GradientIsFirstOrderExact) {
    Random random;
    for (int repeat = 0; repeat < 5; ++repeat) {
        for (const auto& one : cases(random)) {
            const auto [centre, x] = inside(random, one, 0.6);
            Chart chart = chart_about(centre);
            const Potential V = potential_at(one, chart, x);
            double remainder[2] = {0, 0};
            for (int k = 0; k < 8; ++k) {
                const VectorXd s = random.many(12);
                for (const int half : {0, 1}) {
                    const double h = half ? 1e-4 : 2e-4;
                    const double d = potential_at(one, chart, x + h * s).change - V.change -
                                     h * V.gradient.dot(s);
                    remainder[half] += d * d;
                }
            }
            EXPECT_NEAR(0.5 * std::log2(remainder[0] / remainder[1]), 2, 0.1) << one.name;
        }
    }
}

// The Hessian at the centre of a chart against central differences of the gradient.
TEST(Formulations, HessianAgreesWithDifferencesOfTheGradient) {
    Random random;
    const Scales scales;
    for (const auto& one : cases(random)) {
        const auto centre = inside(random, one, 0.1).centre;
        const MatrixXd H =
            hessian(one.model, nothing_prescribed(one.model), scales, centre, VectorXd(0));
        Chart chart = chart_about(centre);
        MatrixXd expected(12, 12);
        const double h = 1e-5;
        for (int i = 0; i < 12; ++i) {
            const VectorXd s = h * VectorXd::Unit(12, i);
            expected.col(i) =
                (potential_at(one, chart, s).gradient - potential_at(one, chart, -s).gradient) /
                (2 * h);
        }
        EXPECT_LE((H - expected).norm(), 2e-7 * (1 + H.norm())) << one.name;
    }
}

TEST(Formulations, ChangesKeepTheirRelativeAccuracy) {
    Random random;
    double worst = 0;
    for (int repeat = 0; repeat < 10; ++repeat) {
        for (const auto& one : cases(random)) {
            const auto centre = inside(random, one, 0.1).centre;
            Chart chart = chart_about(centre);
            const VectorXd x = random.many(12, 1e-10),
                           g_c = potential_at(one, chart, VectorXd::Zero(12)).gradient;
            const Potential V = potential_at(one, chart, x);
            worst = std::max(worst, std::abs(V.change - 0.5 * (g_c + V.gradient).dot(x)) /
                                        (g_c.norm() * x.norm()));
        }
    }
    EXPECT_LE(worst, 2e-14);
}

// Formulations differ to second order: for a small deformation ε, the energies of all nine differ
// by ε³.
TEST(Formulations, AllAreTheSameWhereTheDeformationIsSmall) {
    Random random;
    const SpatialLaw law = random_law(random, false);
    const VectorXd x = random.many(12);
    double spread[2];
    for (const int half : {0, 1}) {
        std::vector<double> energies;
        for (const Frame frame : frames)
            for (const Angles measure : measures) {
                Bushing b{Marker{0}, Marker{1}, law};
                b.formulation = {frame, measure};
                Chart chart = chart_about({Pose{}, Pose{}});
                move_to(chart, (half ? 0.5e-2 : 1e-2) * x);
                energies.push_back(stated_energy(b, poses(chart)));
            }
        spread[half] = *std::ranges::max_element(energies) - *std::ranges::min_element(energies);
        EXPECT_GT(spread[half], 1e-9 * energies[0]);
    }
    EXPECT_NEAR(std::log2(spread[0] / spread[1]), 3, 0.1);
}

// A body on one bushing, rotated about an axis by a moment until the law ends: no half turn, no
// gimbal lock is passed.
TEST(Formulations, WhereALawEndsTheBranchEnds) {
    const double k = 500, pi = std::numbers::pi;
    struct End {
        Frame frame;
        Angles angles;
        int axis;
        double angle;
    };
    for (const auto& [frame, measure, axis, end] :
         {End{Frame::on_i, Angles::rotation_vector, 0, pi},
          End{Frame::middle, Angles::rotation_vector, 1, pi},
          End{Frame::on_i, Angles::cardan, 1, pi / 2},
          End{Frame::middle, Angles::cardan, 1, pi / 2}, End{Frame::on_i, Angles::cardan, 2, pi},
          End{Frame::on_i, Angles::projected, 1, pi / 2},
          End{Frame::on_i, Angles::projected, 2, pi}}) {
        Model model;
        model.bodies = {{"body", {}}};
        Bushing b{Marker{ground}, Marker{0}, LinearStiffness{}};
        // Stiff across the axis: otherwise a dead moment would buckle the body about the other axes
        // first.
        stiffness_of(b).diagonal() << 1e5, 1e5, 1e5, 50 * k, 50 * k, 50 * k;
        stiffness_of(b)(3 + axis, 3 + axis) = k;
        b.formulation = {frame, measure};
        model.elastics = {{"bushing", b}};
        const Branch branch = load_branch("turn", {{"moment", DeadMoment{0, Vector3d::Unit(axis)}}},
                                          1.2 * k * end, 12);
        const auto path = solve(model, branch, sweep(branch));
        const std::string what =
            fmt::format("frame {} angles {} axis {}: {}", static_cast<int>(frame),
                        static_cast<int>(measure), axis, path.detail);
        EXPECT_EQ(path.outcome, Outcome::branch_lost) << what;
        for (const auto& state : path.points) {
            EXPECT_LT(state.load, k * end) << what;
            const Quaterniond expected(Eigen::AngleAxisd(state.load / k, Vector3d::Unit(axis)));
            EXPECT_LE(state.poses[0].p.angularDistance(expected), 1e-8) << what;
        }
        EXPECT_GE(path.points.size(), 10u) << what;
    }
}

// F only along e₀: a bushing deformed in the design position settles where its force is zero.
TEST(Formulations, ABushingSettlesToItsUndeformedOffset) {
    for (const Frame frame : {Frame::on_i, Frame::middle}) {
        Model model;
        model.bodies = {{"body", {}}};
        Bushing b{Marker{ground}, Marker{0}, LinearStiffness{}};
        stiffness_of(b).diagonal() << 1e5, 2e5, 3e5, 500, 600, 700;
        b.undeformed << 0.003, -0.002, 0.001, 0.02, 0.01, -0.03;
        b.formulation.frame = frame;
        model.elastics = {{"bushing", b}};
        const Branch branch =
            load_branch("push", {{"force", DeadForce{{0}, Vector3d::UnitX()}}}, 1, 1);
        const double loads[] = {0};
        const auto path = solve(model, branch, loads);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        EXPECT_LE((deformation(b, path.points[0].poses) - b.undeformed).norm(), 1e-11);
    }
}

}  // namespace
}  // namespace elastocheck::reference::energy
