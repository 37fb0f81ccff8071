// Bushing formulations with an energy, with every law: gradient and Hessian of the potential.
#include "models/laws.hpp"
#include "reference/energy/constraints/balance.hpp"
#include "reference/energy/potential/laws.hpp"
#include "reference/energy/potential/relative_rotation.hpp"
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Frame = Formulation::Frame;
using Angles = Formulation::Angles;

constexpr Frame frames[] = {Frame::on_i, Frame::on_j, Frame::middle};
constexpr Angles measures[] = {Angles::rotation_vector, Angles::cardan, Angles::projected};
constexpr std::pair<BodyId, BodyId> pairs_of_bodies[] = {{0, 1}, {1, 0}, {0, ground}, {ground, 1}};

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

struct Formulated {
    std::string name;
    Model model;  // as compiled
};

std::vector<Formulated> cases(Random& random) {
    std::vector<Formulated> all;
    for (const Frame frame : frames)
        for (const Angles measure : measures)
            for (const bool curved : {false, true})
                for (const auto& [i, j] : pairs_of_bodies) {
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
                         model});
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
Places inside(Random& random, const Formulated& one, double size) {
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

Potential potential_at(const Formulated& one, Chart& chart, const VectorXd& x) {
    move_to(chart, x);
    return potential(one.model, nothing_prescribed(one.model), chart);
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

}  // namespace
}  // namespace elastocheck::reference::energy
