// Beams as chains of bushings, each with its frame at the middle of its segment, against the
// continuous beam. Every chain is clamped to ground at the origin and lies along x.
#include <Eigen/Eigenvalues>
#include <numbers>

#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;

struct Beam {
    double length = 1.2, EA = 8e7, EI_y = 2400, EI_z = 2400, GJ = 1800;  // [m] [N] [N·m²]
    int n = 8;

    double segment() const { return length / n; }
    Matrix6 stiffness() const {
        const double l = segment();
        Matrix6 K = Matrix6::Zero();
        K.diagonal() << EA / l, 12 * EI_z / (l * l * l), 12 * EI_y / (l * l * l), GJ / l, EI_y / l,
            EI_z / l;
        return K;
    }
    // A body at every node except the first; `at` is the tip.
    Model model() const {
        Model model;
        model.name = "beam";
        const double l = segment();
        Bushing segment{Marker{}, Marker{}, LinearStiffness{stiffness()}};
        segment.formulation.frame = Formulation::Frame::middle;
        for (int k = 0; k < n; ++k) {
            model.bodies.push_back({fmt::format("node {}", k + 1), {Vector3d((k + 1) * l, 0, 0)}});
            segment.i = {k - 1, Vector3d(l / 2, 0, 0)};
            segment.j = {k, Vector3d(-l / 2, 0, 0)};
            model.elastics.push_back({fmt::format("segment {}", k + 1), segment});
        }
        return model;
    }
    BodyId tip() const { return n - 1; }
    const Pose& tip(const Equilibrium& state) const { return state.poses.back(); }
};

EquilibriumPath bend(const Beam& beam, const LoadKind& load, double to, int steps) {
    const Branch branch = load_branch("bend", {{"load", load}}, to, steps);
    return solve(beam.model(), branch, sweep(branch));
}

// T = G J φ / L for any number of segments, over more than one turn of the tip. The bending
// stiffness prevents the lateral buckling of a shaft under torque (Greenhill).
TEST(Beams, ABarTwistsByItsTorqueTimesLengthOverGJ) {
    for (const int n : {1, 3, 10}) {
        const Beam beam{.EI_y = 24e3, .EI_z = 24e3, .n = n};
        const double turn = n == 1 ? 3 : 7;  // one segment ends at half a turn
        const auto path =
            bend(beam, DeadMoment{beam.tip(), Vector3d::UnitX()}, turn * beam.GJ / beam.length, 5);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& state : path.points) {
            const double phi = state.load * beam.length / beam.GJ;
            const Eigen::Quaterniond expected(Eigen::AngleAxisd(phi, Vector3d::UnitX()));
            EXPECT_LE(beam.tip(state).p.angularDistance(expected), 1e-10) << n << " " << state.load;
            EXPECT_LE((beam.tip(state).r - Vector3d(beam.length, 0, 0)).norm(), 1e-12) << n;
        }
    }
}

// Under a moment M at its tip every segment turns by θ = M l / EI about its middle: the nodes lie
// on a circle of radius (l/2) cot(θ/2) = (l/θ)(1 - θ²/12 + ...): the beam's own circle EI/M to
// second order in 1/n. The width prevents lateral buckling.
TEST(Beams, ATipMomentRollsTheBeamIntoACircle) {
    std::vector<double> errors;
    for (const int n : {5, 10, 20}) {
        const Beam beam{.EI_z = 24e4, .GJ = 18e4, .n = n};
        const double M = 2 * pi * beam.EI_y / beam.length;
        const auto path = bend(beam, DeadMoment{beam.tip(), -Vector3d::UnitY()}, M, 8);
        ASSERT_EQ(path.outcome, Outcome::converged) << n << ": " << path.detail;
        double worst = 0, worst_circle = 0;
        for (const auto& state : path.points) {
            if (state.load == 0) continue;
            const double l = beam.segment(), theta = state.load * l / beam.EI_y;
            for (int k = 1; k <= n; ++k) {
                const Vector3d on_arc(std::sin(k * theta), 0, 1 - std::cos(k * theta));
                const Vector3d& r = state.poses[static_cast<std::size_t>(k - 1)].r;
                worst = std::max(worst, (r - 0.5 * l / std::tan(theta / 2) * on_arc).norm());
                worst_circle = std::max(worst_circle, (r - l / theta * on_arc).norm());
            }
        }
        EXPECT_LE(worst, 1e-9 * beam.length) << n;
        errors.push_back(worst_circle);
    }
    for (std::size_t i = 1; i < errors.size(); ++i)
        EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 2, 0.1) << errors[i];
}

// The elastica under a dead tip force F across:  EI θ'' = -F cos θ,  θ(0) = 0,  θ'(L) = 0, by
// shooting for θ'(0).
struct Tip {
    double x, z;
};
Tip elastica(double F, double EI, double L) {
    const int steps = 4000;
    Tip tip{};
    const auto curvature_at_the_tip = [&](double kappa) {
        std::array<double, 4> y{0, kappa, 0, 0};  // θ, θ', x, z
        const auto rate = [&](const std::array<double, 4>& v) {
            return std::array<double, 4>{v[1], -F / EI * std::cos(v[0]), std::cos(v[0]),
                                         std::sin(v[0])};
        };
        const double h = L / steps;
        for (int k = 0; k < steps; ++k) {
            const auto ahead = [&](const std::array<double, 4>& by, double factor) {
                auto v = y;
                for (std::size_t i = 0; i < 4; ++i) v[i] += factor * by[i];
                return v;
            };
            const auto a = rate(y), b = rate(ahead(a, h / 2)), c = rate(ahead(b, h / 2)),
                       d = rate(ahead(c, h));
            for (std::size_t i = 0; i < 4; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
        }
        tip = {y[2], y[3]};
        return y[1];
    };
    double low = 0, high = F * L / EI;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (curvature_at_the_tip(middle) < 0 ? low : high) = middle;
    }
    return tip;
}

TEST(Beams, ATipForceBendsTheBeamIntoTheElastica) {
    const Beam one;
    const double F = 4 * one.EI_y / (one.length * one.length);
    const Tip exact = elastica(F, one.EI_y, one.length);
    // tabulated by Mattiasson (1981) for F L²/EI = 4
    EXPECT_NEAR(exact.z / one.length, 0.66996, 1e-5);
    std::vector<double> errors;
    for (const int n : {4, 8, 16}) {
        const Beam beam{.EA = 1e9, .n = n};  // inextensible, as the elastica
        const auto path = bend(beam, DeadForce{{beam.tip()}, Vector3d::UnitZ()}, F, 4);
        ASSERT_EQ(path.outcome, Outcome::converged) << n << ": " << path.detail;
        const Vector3d r = beam.tip(path.points.back()).r;
        errors.push_back(std::hypot(r.x() - exact.x, r.z() - exact.z));
    }
    for (std::size_t i = 1; i < errors.size(); ++i)
        EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 2, 0.15) << errors[i];
    EXPECT_LE(errors.back(), 3e-3 * one.length);
}

// Least P at which ½ xᵀ (K - P G) x of small deflections is singular, x = (w, φ) of every node. A
// segment is deformed by d := w_j - w_i - ½ l (φ_i + φ_j) and φ_j - φ_i, and shortens by ¼ l
// (φ_i² + φ_j²) + ½ d (φ_i + φ_j).
double critical_load(double EI, double L, int n) {
    const double l = L / n;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * n + 2, 2 * n + 2), G = K;
    for (int i = 0; i < 2 * n; i += 2) {
        Eigen::Vector4d d(-1, -l / 2, 1, -l / 2), bend(0, -1, 0, 1), mean(0, 0.5, 0, 0.5);
        K.block<4, 4>(i, i) +=
            12 * EI / (l * l * l) * d * d.transpose() + EI / l * bend * bend.transpose();
        G.block<4, 4>(i, i) += d * mean.transpose() + mean * d.transpose();
        G(i + 1, i + 1) += l / 2;
        G(i + 3, i + 3) += l / 2;
    }
    const Eigen::MatrixXd free_K = K.bottomRightCorner(2 * n, 2 * n),
                          free_G = G.bottomRightCorner(2 * n, 2 * n);
    return 1 / free_K.ldlt().solve(free_G).eval().eigenvalues().real().maxCoeff();
}

// Under axial pressure the chain ceases to be a minimum at its own critical load, which converges
// to Euler's P = π² EI / (4 L²) with second order in 1/n.
TEST(Beams, AColumnIsLostAtEulersLoad) {
    std::vector<double> errors;
    for (const int n : {2, 4, 8}) {
        const Beam beam{.EA = 1e10, .EI_y = 3000, .n = n};  // buckles about z
        const double P = critical_load(beam.EI_z, beam.length, n);
        errors.push_back(P / (pi * pi * beam.EI_z / (4 * beam.length * beam.length)) - 1);
        const Branch branch = load_branch(
            "press", {{"load", DeadForce{{beam.tip()}, -Vector3d::UnitX()}}}, 1.2 * P, 1);
        const double loads[] = {P * (1 - 1e-5), P * (1 + 1e-5)};
        const auto path = solve(beam.model(), branch, loads);
        EXPECT_EQ(path.outcome, Outcome::bifurcation_point) << n << path.detail;
        EXPECT_NE(path.detail.find("stops being a minimum"), std::string::npos) << path.detail;
        EXPECT_EQ(path.points.size(), 1u) << path.detail;
    }
    for (std::size_t i = 1; i < errors.size(); ++i)
        EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 2, 0.2)
            << errors[i - 1] << " " << errors[i];
}

}  // namespace
}  // namespace elastocheck::reference::energy
