#include "reference/energy/potential/potential.hpp"

#include "reference/energy/potential/laws.hpp"
#include "reference/energy/potential/relative_rotation.hpp"
#include "reference/energy/potential/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Smallest distance from a singularity of the angles [rad]. Closer to it rounding decides the
// branch of the angles: near half a turn the sign of the axis, on which the logarithm depends.
constexpr double singularity_margin = 1e-3;

// Geometry of one element in its chart: its deformation and the derivatives with respect
// to the poses.
template <int N>
struct Deformation {
    BodyId i, j;
    Matrix<double, N, 1> e_c, delta;  // e(x_c), and e(x) - e(x_c) without cancellation
    Matrix<double, N, 6> E_i, E_j;    // ∂e/∂(δr, δπ) of either body
};

// ℓ = |D|, D = p_j - p_i:  δℓ = n·(δp_j - δp_i), n = D/ℓ, and δp = δr + δπ × u, so
// n·δp = n·δr + (u × n)·δπ. ℓ - ℓ_c = ΔD·(D + D_c)/(ℓ + ℓ_c).
Deformation<1> deformation(const AxialSpring& spring, const Chart& chart) {
    const PointMotion i = motion(chart[spring.i.body], spring.i.s_local);
    const PointMotion j = motion(chart[spring.j.body], spring.j.s_local);
    const Vector3d D = j.p - i.p, dD = j.displacement - i.displacement, D_c = D - dD;
    const double l = D.norm(), l_c = D_c.norm();
    const Vector3d n = D / l;
    Deformation<1> e;
    e.i = spring.i.body;
    e.j = spring.j.body;
    e.e_c << l_c;
    e.delta << dD.dot(D + D_c) / (l + l_c);
    e.E_i << -n.transpose(), -i.lever.cross(n).transpose();
    e.E_j << n.transpose(), j.lever.cross(n).transpose();
    return e;
}

// d = A_fᵀ D, θ by the formulation, A_f the axes of the frame, A_I and A_J of the markers. A small
// rotation rotates the frame by δπ_f, of which the share P is that of j (0: the frame is fixed to
// i):
//
//   δπ_f = δπ_i + P (δπ_j - δπ_i)
//   δd = A_fᵀ (δp_J - δp_I + D × δπ_f)
//   δθ = S A_Iᵀ (δπ_j - δπ_i),   S = J⁻¹(θ) for the rotation vector (relative_rotation.hpp)
//
// and the changes since the centre, with A_I = (1 + T_i) A_Ic, A_f = A_I C and the relative
// quaternion q = q_Icᴴ (1 + Δ_i)ᴴ (1 + Δ_j) q_Jc:
//
//   d - d_c = A_fᵀ ΔD + ΔA_fᵀ D_c,   ΔA_f = T_i A_Ic C + A_Ic ΔC,
//   q - q_c = q_Icᴴ (Δ_iᴴ + Δ_j + Δ_iᴴ Δ_j) q_Jc.
Deformation<6> deformation(const Bushing& bushing, const Chart& chart) {
    const Placement& body_i = chart[bushing.i.body];
    const Placement& body_j = chart[bushing.j.body];
    const PointMotion i = motion(body_i, bushing.i.s_local);
    const PointMotion j = motion(body_j, bushing.j.s_local);
    const Vector3d D = j.p - i.p, dD = j.displacement - i.displacement, D_c = D - dD;
    const Quaterniond q_i = body_i.centre.p * bushing.i.A_local.normalized();
    const Quaterniond q_j = body_j.centre.p * bushing.j.A_local.normalized();
    const Matrix3d A_c = q_i.toRotationMatrix();
    const Matrix3d dA = body_i.rotation_minus_one * A_c;
    const Matrix3d A = A_c + dA;

    Quaterniond dq = body_i.quaternion_minus_one.conjugate() * body_j.quaternion_minus_one;
    dq.coeffs() +=
        body_i.quaternion_minus_one.conjugate().coeffs() + body_j.quaternion_minus_one.coeffs();
    dq = q_i.conjugate() * dq * q_j;
    Quaterniond q_c = q_i.conjugate() * q_j;
    if (q_c.w() < 0) {
        q_c.coeffs() *= -1;
        dq.coeffs() *= -1;
    }
    const Matrix3d A_Jc = q_j.toRotationMatrix(), dA_J = body_j.rotation_minus_one * A_Jc;
    const RelativeRotation B{q_c, dq, q_c.toRotationMatrix(),
                             A.transpose() * dA_J + dA.transpose() * A_Jc};
    const AngleChange theta = angles(bushing.formulation.angles, B);
    const Matrix3d G = theta.slope * A.transpose();

    Matrix3d A_fc = A_c, dA_f = dA, P = Matrix3d::Zero();
    if (bushing.formulation.frame == Formulation::Frame::middle) {
        const HalfWay half = half_way(B);
        A_fc = A_c * (half.C - half.dC);
        dA_f = dA * half.C + A_c * half.dC;
        P = A * half.share * A.transpose();
    }
    const Matrix3d A_f = A_fc + dA_f;
    const Matrix3d D_j = skew(D) * P, D_i = skew(D) - D_j;

    Deformation<6> e;
    e.i = bushing.i.body;
    e.j = bushing.j.body;
    e.e_c << A_fc.transpose() * D_c, theta.theta_c;
    e.delta << A_f.transpose() * dD + dA_f.transpose() * D_c, theta.dtheta;
    // ⎡ -A_fᵀ   A_fᵀ (ũ_I + D̃ (1 - P)) ⎤   ⎡ A_fᵀ   A_fᵀ (D̃ P - ũ_J) ⎤
    // ⎣   0      -S A_Iᵀ               ⎦   ⎣  0      S A_Iᵀ          ⎦
    e.E_i << -A_f.transpose(), A_f.transpose() * (skew(i.lever) + D_i), Matrix3d::Zero(), -G;
    e.E_j << A_f.transpose(), A_f.transpose() * (D_j - skew(j.lever)), Matrix3d::Zero(), G;
    return e;
}

// Geometry and law together: U(e) = s u(e - e₀) + bᵀ e.
template <int N>
struct Element : Deformation<N>, LawValues<N> {
    Matrix<double, N, 1> of_law;  // ∂u/∂e
};

template <int N>
Element<N> element(const Deformation<N>& e, LawValues<N> law, double s,
                   const Matrix<double, N, 1>& b) {
    const Matrix<double, N, 1> of_law = law.stress;
    law.change = s * law.change + b.dot(e.delta);
    law.stress_c = s * law.stress_c + b;
    law.stress = s * law.stress + b;
    law.stiffness *= s;
    return {e, law, of_law};
}

Element<1> element(const AxialSpring& spring, const Prescribed& prescribed, int k,
                   const Chart& chart) {
    const Deformation<1> e = deformation(spring, chart);
    const Vector1 e_0(spring.free_length + prescribed.free_length[k]), b(prescribed.preload(0, k));
    return element<1>(e, values(spring.law, e.e_c - e_0, e.delta), 1 + prescribed.strength[k], b);
}

Element<6> element(const Bushing& bushing, const Prescribed& prescribed, int k,
                   const Chart& chart) {
    const Deformation<6> e = deformation(bushing, chart);
    const Vector6 b = bushing.preload + prescribed.preload.col(k),
                  e_0 = bushing.undeformed + prescribed.free_length[k] * Vector6::Unit(2);
    return element<6>(e, values(bushing.law, e.e_c - e_0, e.delta), 1 + prescribed.strength[k], b);
}

// f(k, element) for every element with wanted(k), in the model's order.
template <class Wanted, class F>
void for_each_element(const Model& model, const Prescribed& prescribed, const Chart& chart,
                      Wanted wanted, F f) {
    for (int k = 0; k < static_cast<int>(model.elastics.size()); ++k)
        if (wanted(k))
            std::visit([&](const auto& kind) { f(k, element(kind, prescribed, k, chart)); },
                       model.elastics[static_cast<std::size_t>(k)].kind);
}
template <class F>
void for_each_element(const Model& model, const Prescribed& prescribed, const Chart& chart, F f) {
    for_each_element(
        model, prescribed, chart, [](int) { return true; }, f);
}

template <int N>
void add_gradient(const Element<N>& e, const Matrix<double, N, 1>& stress, VectorXd& g) {
    if (e.i != ground) g.segment<6>(6 * e.i) += e.E_i.transpose() * stress;
    if (e.j != ground) g.segment<6>(6 * e.j) += e.E_j.transpose() * stress;
}

template <class AtPoint>
Carried lever_at(const AtPoint& p, const Chart& chart) {
    return {p.body, motion(chart[p.body], p.s_local).lever};
}

// ---- σ·∂²e/∂x² at the centre of the chart.

// ∂²|D|/∂D² = (1 - n nᵀ)/|D|
void add_geometric(const AxialSpring& spring, const Vector6& stress, const Chart& chart,
                   Blocks& H) {
    const Vector3d D = motion(chart[spring.j.body], spring.j.s_local).p -
                       motion(chart[spring.i.body], spring.i.s_local).p;
    const double l = D.norm();
    const Vector3d n = D / l;
    add_curvature_of_difference(stress[0] * n,
                                stress[0] / l * (Matrix3d::Identity() - n * n.transpose()),
                                lever_at(spring.j, chart), lever_at(spring.i, chart), H);
}

// σ_d·d = n·D with n = A_f σ_d, and σ_θ·θ(β), exp(β) = exp(-a_i) exp(a_j) with a = A_Iᵀ φ:
//
//   β = Δ - ½ a_i × a_j + ...,   Δ = a_j - a_i
//
// With the frame on i, n turns with i; θ contributes g·(-½ a_i × a_j) + ½ Δᵀ T Δ, g = Sᵀ σ_θ. A
// frame in the middle, A_f = A_I exp(γ) C, turns by γ = P β + ... beyond that, Γ = A_I P A_Iᵀ:
//
//   (φ_i × (γ × n) + ½ γ × (γ × n))·D + δD·(γ × n),   γ = Γ (φ_j - φ_i) here
//   m·(second order of γ),                            m = A_Iᵀ (n × D), so that g gains Pᵀ m
void add_geometric(const Bushing& bushing, const Vector6& stress, const Chart& chart, Blocks& H) {
    const BodyId i = bushing.i.body, j = bushing.j.body;
    const Carried u_i = lever_at(bushing.i, chart), u_j = lever_at(bushing.j, chart);
    const Vector3d D =
        motion(chart[j], bushing.j.s_local).p - motion(chart[i], bushing.i.s_local).p;
    const Quaterniond q_i = chart[i].centre.p * bushing.i.A_local.normalized();
    const Quaterniond q_j = chart[j].centre.p * bushing.j.A_local.normalized();
    Quaterniond q = q_i.conjugate() * q_j;
    if (q.w() < 0) q.coeffs() *= -1;
    const RelativeRotation B{q, Quaterniond(0, 0, 0, 0), q.toRotationMatrix(), Matrix3d::Zero()};
    const Matrix3d A = q_i.toRotationMatrix();

    const Vector3d sigma_theta = stress.tail<3>();
    Vector3d g = Vector3d::Zero();
    Matrix3d T = Matrix3d::Zero();  // by φ_j - φ_i, ground axes
    if (!sigma_theta.isZero(0)) {
        g = A * angles(bushing.formulation.angles, B).slope.transpose() * sigma_theta;
        T = A * angle_curvature(bushing.formulation.angles, q, sigma_theta) * A.transpose();
    }
    Vector3d n = A * stress.head<3>();
    if (!n.isZero(0)) {
        if (bushing.formulation.frame == Formulation::Frame::middle) {
            const HalfWay half = half_way(B);
            n = A * (half.C * stress.head<3>());
            const Vector3d m = n.cross(D);
            const Matrix3d Gamma = A * half.share * A.transpose(), n_Gamma = skew(n) * Gamma,
                           D_n_Gamma = skew(D) * n_Gamma;
            g += Gamma.transpose() * m;
            T += Gamma.transpose() * turn_curvature(D, n) * Gamma +
                 A * half_way_curvature(q, A.transpose() * m) * A.transpose();
            add_pair(i, 3, j, 3, D_n_Gamma, H);
            add_pair(i, 3, i, 3, -D_n_Gamma, H);
            for (const auto& [lever, sign] : {std::pair{&u_j, 1.0}, {&u_i, -1.0}}) {
                const Matrix3d lever_n_Gamma = sign * skew(lever->u) * n_Gamma;
                add_pair(lever->body, 0, j, 3, -sign * n_Gamma, H);
                add_pair(lever->body, 0, i, 3, sign * n_Gamma, H);
                add_pair(lever->body, 3, j, 3, -lever_n_Gamma, H);
                add_pair(lever->body, 3, i, 3, lever_n_Gamma, H);
            }
        }
        add_curvature_of_offset({i, n}, D, u_j, u_i, H);
    }
    // each quadratic form here is ½ xᵀ M x, so half of M and Mᵀ
    add_pair(i, 3, i, 3, 0.5 * T, H);
    add_pair(j, 3, j, 3, 0.5 * T, H);
    add_pair(i, 3, j, 3, 0.5 * skew(g) - T, H);
}

// -f·Δp, and its gradient in (δr, δπ).
double add_forces(const Prescribed& prescribed, const Chart& chart, VectorXd& g) {
    double change = 0;
    const auto add = [&](const DeadForce& force) {
        const PointMotion point = motion(chart[force.at.body], force.at.s_local);
        change -= force.f.dot(point.displacement);
        g.segment<3>(6 * force.at.body) -= force.f;
        g.segment<3>(6 * force.at.body + 3) -= point.lever.cross(force.f);
    };
    for (const auto& force : prescribed.forces) add(force);
    for (const auto& brake : prescribed.brakes) add(dead_force(brake, chart));
    return change;
}

// Converts a gradient from (δr, δπ) to (δr, δφ): δπ = J δφ.
void to_chart(const Chart& chart, VectorXd& g) {
    for (std::size_t b = 0; b < chart.placements.size(); ++b) {
        auto moment = g.segment<3>(6 * static_cast<int>(b) + 3);
        moment = (chart.placements[b].J.transpose() * moment).eval();
    }
}

// -m·φ in chart coordinates, so after `to_chart`.
double add_moments(const Prescribed& prescribed, const Chart& chart, VectorXd& g) {
    double change = 0;
    for (const auto& moment : prescribed.moments) {
        change -= moment.m.dot(chart[moment.body].phi);
        g.segment<3>(6 * moment.body + 3) -= moment.m;
    }
    return change;
}

}  // namespace

Potential potential(const Model& model, const Prescribed& prescribed, const Chart& chart) {
    Potential V{0, VectorXd::Zero(coordinates(model))};
    for_each_element(model, prescribed, chart, [&]<int N>(int, const Element<N>& e) {
        V.change += e.change;
        add_gradient<N>(e, e.stress, V.gradient);
    });
    V.change += add_forces(prescribed, chart, V.gradient);
    to_chart(chart, V.gradient);
    V.change += add_moments(prescribed, chart, V.gradient);
    return V;
}

VectorXd gradient_rate(const Model& model, const Prescribed& prescribed, const Prescribed& rate,
                       const Chart& chart) {
    VectorXd g = VectorXd::Zero(coordinates(model));
    const auto is_driven = [&](int k) {
        return !rate.preload.col(k).isZero(0) || rate.strength[k] != 0 || rate.free_length[k] != 0;
    };
    for_each_element(model, prescribed, chart, is_driven, [&]<int N>(int k, const Element<N>& e) {
        Matrix<double, N, 1> stress_rate =
            rate.preload.col(k).head<N>() + rate.strength[k] * e.of_law;
        stress_rate -= e.stiffness.col(N == 1 ? 0 : 2) * rate.free_length[k];
        add_gradient<N>(e, stress_rate, g);
    });
    add_forces(rate, chart, g);
    to_chart(chart, g);
    add_moments(rate, chart, g);
    return g;
}

DeadForce dead_force(const BrakeForce& brake, const Chart& chart) {
    const Placement &carrier = chart[brake.body], &wheel = chart[brake.patch.body];
    const Vector3d lever = wheel.centre.r + wheel.A_c * brake.patch.s_local - carrier.centre.r;
    return {{brake.body, carrier.A_c.transpose() * lever}, brake.f};
}

void add_curvature(const ElasticKind& element, const Vector6& stress, const Chart& chart,
                   Blocks& H) {
    std::visit([&](const auto& kind) { add_geometric(kind, stress, chart, H); }, element);
}

void add_curvature(const DeadForce& force, const Chart& chart, Blocks& H) {
    add_curvature_along(-force.f, lever_at(force.at, chart), H);
}

Blocks stiffness(const Model& model, const Prescribed& prescribed, const Chart& chart) {
    Blocks H{coordinates(model)};
    for_each_element(model, prescribed, chart, [&]<int N>(int, const Element<N>& e) {
        const auto add_block = [&](BodyId a, const Matrix<double, N, 6>& E_a, BodyId b,
                                   const Matrix<double, N, 6>& E_b) {
            if (a == ground || b == ground) return;
            const Matrix6 K = E_a.transpose() * e.stiffness * E_b;
            for (const int row : {0, 3})
                for (const int column : {0, 3})
                    H.blocks.push_back({6 * a + row, 6 * b + column, K.block<3, 3>(row, column)});
        };
        add_block(e.i, e.E_i, e.i, e.E_i);
        add_block(e.i, e.E_i, e.j, e.E_j);
        add_block(e.j, e.E_j, e.i, e.E_i);
        add_block(e.j, e.E_j, e.j, e.E_j);
    });
    return H;
}

Matrix<double, 6, Eigen::Dynamic> stresses(const Model& model, const Prescribed& prescribed,
                                           const Chart& chart) {
    Matrix<double, 6, Eigen::Dynamic> sigma = Matrix<double, 6, Eigen::Dynamic>::Zero(
        6, static_cast<Eigen::Index>(model.elastics.size()));
    for_each_element(model, prescribed, chart, [&]<int N>(int k, const Element<N>& e) {
        sigma.col(k).template head<N>() = e.stress_c;
    });
    return sigma;
}

double stress_size(const Model& model, const Prescribed& prescribed, const Chart& chart,
                   double length) {
    const auto sigma = stresses(model, prescribed, chart);
    return sigma.topRows<3>().colwise().norm().sum() +
           sigma.bottomRows<3>().colwise().norm().sum() / length;
}

std::vector<int> turning_bushings(const Model& model, const Course& course) {
    std::vector<int> bushings;
    for (int k = 0; k < static_cast<int>(model.elastics.size()); ++k) {
        const auto depends_on_rotation = [&](const Bushing& b) {
            Vector6 sigma = b.preload.cwiseAbs() + course.start.preload.col(k).cwiseAbs() +
                            course.rate.preload.col(k).cwiseAbs();
            const bool force_turns = b.formulation.frame == Formulation::Frame::middle;
            return resists_rotation(b.law) || !sigma.tail<3>().isZero(0) ||
                   (force_turns && (resists(b.law) || !sigma.isZero(0)));
        };
        const auto* bushing =
            std::get_if<Bushing>(&model.elastics[static_cast<std::size_t>(k)].kind);
        if (bushing && depends_on_rotation(*bushing)) bushings.push_back(k);
    }
    return bushings;
}

namespace {

// f(bushing, its relative rotation) for each listed bushing.
template <class F>
void for_each_rotation(const Model& model, const std::vector<int>& bushings,
                       const std::vector<Pose>& poses, F f) {
    const auto axes = [&](const Marker& m) {
        return m.body == ground ? m.A_local : poses[static_cast<std::size_t>(m.body)].p * m.A_local;
    };
    for (const int k : bushings) {
        const auto& b = std::get<Bushing>(model.elastics[static_cast<std::size_t>(k)].kind);
        f(b, axes(b.i).conjugate() * axes(b.j));
    }
}

}  // namespace

Matrix3Xd rotations(const Model& model, const std::vector<int>& bushings,
                    const std::vector<Pose>& poses) {
    Matrix3Xd theta(3, 2 * static_cast<Eigen::Index>(bushings.size()));
    int column = 0;
    for_each_rotation(model, bushings, poses, [&](const Bushing& b, const Quaterniond& q) {
        const bool half_way = b.formulation.frame == Formulation::Frame::middle;
        theta.col(column++) = angles_of(b.formulation.angles, q);
        theta.col(column++) = half_way ? rotation_vector(q) : Vector3d::Zero();
    });
    return theta;
}

bool within_laws(const Model& model, const std::vector<int>& bushings,
                 const std::vector<Pose>& poses) {
    bool within = true;
    for_each_rotation(model, bushings, poses, [&](const Bushing& b, const Quaterniond& q) {
        within = within && distance_to_singularity(b.formulation, q) >= singularity_margin;
    });
    return within;
}

}  // namespace elastocheck::reference::energy
