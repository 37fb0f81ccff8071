#include "reference/energy/potential.hpp"

#include <cmath>
#include <numbers>

#include "reference/energy/overloaded.hpp"
#include "reference/energy/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

// One element in its chart. The law is U = ½ eᵀ K e + bᵀ e (a constant is dropped), so that
//
//   U - U_c = δᵀ (σ_c + ½ K δ),   ∂U/∂e = σ_c + K δ,   δ = e - e_c,   stress σ_c = K e_c + b.
template <int N>
struct Element {
    BodyId i, j;
    Matrix<double, N, 1> sigma_c, delta;
    Matrix<double, N, N> K;
    Matrix<double, N, 6> E_i, E_j;  // ∂e/∂(δr, δπ) of either body
};

// ℓ = |D|, D = p_j - p_i:  δℓ = n·(δp_j - δp_i), n = D/ℓ, and δp = δr + δπ × u, so n·δp = n·δr + (u × n)·δπ.
// ℓ - ℓ_c = ΔD·(D + D_c)/(ℓ + ℓ_c).
Element<1> element(const AxialSpring& spring, const Chart& chart) {
    const PointMotion i = motion(chart[spring.i.body], spring.i.s_local);
    const PointMotion j = motion(chart[spring.j.body], spring.j.s_local);
    const Vector3d D = j.p - i.p, dD = j.dp - i.dp, D_c = D - dD;
    const double l = D.norm(), l_c = D_c.norm();
    const Vector3d n = D / l;
    Element<1> e;
    e.i = spring.i.body;
    e.j = spring.j.body;
    e.K << spring.k;
    e.sigma_c << spring.k * (l_c - spring.free_length);
    e.delta << dD.dot(D + D_c) / (l + l_c);
    e.E_i << -n.transpose(), -i.lever.cross(n).transpose();
    e.E_j << n.transpose(), j.lever.cross(n).transpose();
    return e;
}

// d = A_Iᵀ D, θ = log(A_Iᵀ A_J), A the markers' axes. A small rotation turns A_I by δA_I = δπ_i × A_I, so
//
//   δd = A_Iᵀ (δp_J - δp_I + D × δπ_i)
//   δθ = J⁻¹(θ) A_Iᵀ (δπ_j - δπ_i)
//
// and the changes since the centre, with A_I = (1 + T_i) A_Ic and q = q_Icᴴ (1 + Δ_i)ᴴ (1 + Δ_j) q_Jc the
// relative quaternion:
//
//   d - d_c = A_Iᵀ ΔD + (T_i A_Ic)ᵀ D_c,   q - q_c = q_Icᴴ (Δ_iᴴ + Δ_j + Δ_iᴴ Δ_j) q_Jc.
Element<6> element(const Bushing& bushing, const Chart& chart) {
    const Placement& body_i = chart[bushing.i.body];
    const Placement& body_j = chart[bushing.j.body];
    const PointMotion i = motion(body_i, bushing.i.s_local);
    const PointMotion j = motion(body_j, bushing.j.s_local);
    const Vector3d D = j.p - i.p, dD = j.dp - i.dp, D_c = D - dD;
    const Quaterniond q_i = body_i.centre.p * bushing.i.A_local.normalized();
    const Quaterniond q_j = body_j.centre.p * bushing.j.A_local.normalized();
    const Matrix3d A_c = q_i.toRotationMatrix();
    const Matrix3d dA = body_i.turn * A_c;
    const Matrix3d A = A_c + dA;

    Quaterniond dq = body_i.dp.conjugate() * body_j.dp;
    dq.coeffs() += body_i.dp.conjugate().coeffs() + body_j.dp.coeffs();
    dq = q_i.conjugate() * dq * q_j;
    Quaterniond q_c = q_i.conjugate() * q_j;
    if (q_c.w() < 0) {
        q_c.coeffs() *= -1;
        dq.coeffs() *= -1;
    }
    const LogChange log = log_change(q_c, dq);
    const Matrix3d G = inverse_turn_jacobian(log.theta_c + log.dtheta) * A.transpose();

    Vector6 e_c;
    e_c << A_c.transpose() * D_c, log.theta_c;
    Element<6> e;
    e.i = bushing.i.body;
    e.j = bushing.j.body;
    e.K = bushing.K;
    e.sigma_c = bushing.K * e_c + bushing.preload;
    e.delta << A.transpose() * dD + dA.transpose() * D_c, log.dtheta;
    // ⎡ -A_Iᵀ   A_Iᵀ (ũ_I + D̃) ⎤   ⎡ A_Iᵀ   -A_Iᵀ ũ_J    ⎤
    // ⎣   0      -J⁻¹ A_Iᵀ      ⎦   ⎣  0      J⁻¹ A_Iᵀ    ⎦
    e.E_i << -A.transpose(), A.transpose() * skew(i.lever + D), Matrix3d::Zero(), -G;
    e.E_j << A.transpose(), -A.transpose() * skew(j.lever), Matrix3d::Zero(), G;
    return e;
}

template <class F>
void for_each_element(const Model& model, const Loading& loading, const Chart& chart, F f) {
    const Chart design = loading.relief != 0 ? chart_about(design_poses(model)) : Chart{};
    for (const auto& elastic : model.elastics) {
        std::visit(
            [&](const auto& kind) {
                auto e = element(kind, chart);
                if (loading.relief != 0) e.sigma_c -= loading.relief * element(kind, design).sigma_c;
                f(e);
            },
            elastic.kind);
    }
}

template <int N>
void add_gradient(const Element<N>& e, const Matrix<double, N, 1>& stress, VectorXd& g) {
    if (e.i != ground) g.segment<6>(6 * e.i) += e.E_i.transpose() * stress;
    if (e.j != ground) g.segment<6>(6 * e.j) += e.E_j.transpose() * stress;
}

// -f·Δp, and its gradient in (δr, δπ).
double add_forces(const Loading& loading, const Chart& chart, VectorXd& g) {
    double change = 0;
    for (const auto& force : loading.forces) {
        const PointMotion at = motion(chart[force.at.body], force.at.s_local);
        change -= force.f.dot(at.dp);
        g.segment<3>(6 * force.at.body) -= force.f;
        g.segment<3>(6 * force.at.body + 3) -= at.lever.cross(force.f);
    }
    return change;
}

// From (δr, δπ) to (δr, δφ): δπ = J δφ.
void to_chart(const Chart& chart, VectorXd& g) {
    for (std::size_t b = 0; b < chart.placements.size(); ++b) {
        auto moment = g.segment<3>(6 * static_cast<int>(b) + 3);
        moment = (chart.placements[b].J.transpose() * moment).eval();
    }
}

// -m·φ: its own chart coordinate, so after `to_chart`.
double add_moments(const Loading& loading, const Chart& chart, VectorXd& g) {
    double change = 0;
    for (const auto& moment : loading.moments) {
        change -= moment.m.dot(chart[moment.body].phi);
        g.segment<3>(6 * moment.body + 3) -= moment.m;
    }
    return change;
}

}  // namespace

Potential potential(const Model& model, const Loading& loading, const Chart& chart) {
    Potential V{0, VectorXd::Zero(coordinates(model))};
    for_each_element(model, loading, chart, [&]<int N>(const Element<N>& e) {
        const Matrix<double, N, 1> K_delta = e.K * e.delta;
        V.change += e.delta.dot(e.sigma_c + 0.5 * K_delta);
        add_gradient<N>(e, e.sigma_c + K_delta, V.gradient);
    });
    V.change += add_forces(loading, chart, V.gradient);
    to_chart(chart, V.gradient);
    V.change += add_moments(loading, chart, V.gradient);
    return V;
}

VectorXd gradient_at_centre_stress(const Model& model, const Loading& loading, const Chart& chart) {
    VectorXd g = VectorXd::Zero(coordinates(model));
    for_each_element(model, loading, chart,
                     [&]<int N>(const Element<N>& e) { add_gradient<N>(e, e.sigma_c, g); });
    add_forces(loading, chart, g);
    to_chart(chart, g);
    add_moments(loading, chart, g);
    return g;
}

MatrixXd stiffness(const Model& model, const Chart& chart) {
    MatrixXd H = MatrixXd::Zero(coordinates(model), coordinates(model));
    for_each_element(model, {}, chart, [&]<int N>(const Element<N>& e) {
        const auto add_block = [&](BodyId a, const Matrix<double, N, 6>& E_a, BodyId b,
                                   const Matrix<double, N, 6>& E_b) {
            if (a != ground && b != ground) H.block<6, 6>(6 * a, 6 * b) += E_a.transpose() * e.K * E_b;
        };
        add_block(e.i, e.E_i, e.i, e.E_i);
        add_block(e.i, e.E_i, e.j, e.E_j);
        add_block(e.j, e.E_j, e.i, e.E_i);
        add_block(e.j, e.E_j, e.j, e.E_j);
    });
    return H;
}

double stress_size(const Model& model, const Chart& chart, double length) {
    double size = 0;
    for_each_element(model, {}, chart, [&]<int N>(const Element<N>& e) {
        if constexpr (N == 1)
            size += std::abs(e.sigma_c[0]);
        else
            size += e.sigma_c.template head<3>().norm() + e.sigma_c.template tail<3>().norm() / length;
    });
    return size;
}

Matrix3Xd bushing_rotations(const Model& model, const std::vector<Pose>& poses) {
    const auto axes = [&](const Marker& m) {
        return m.body == ground ? m.A_local : poses[static_cast<std::size_t>(m.body)].p * m.A_local;
    };
    Matrix3Xd theta(3, model.elastics.size());
    int column = 0;
    for (const auto& elastic : model.elastics) {
        const auto* b = std::get_if<Bushing>(&elastic.kind);
        if (b && !(b->K.bottomRows<3>().isZero(0) && b->preload.tail<3>().isZero(0)))
            theta.col(column++) = rotation_vector(axes(b->i).conjugate() * axes(b->j));
    }
    return theta.leftCols(column);
}

bool within_half_turn(const Model& model, const std::vector<Pose>& poses) {
    const Matrix3Xd theta = bushing_rotations(model, poses);
    return theta.cols() == 0 || theta.colwise().norm().maxCoeff() <= std::numbers::pi - 1e-3;
}

}  // namespace elastocheck::reference::energy
