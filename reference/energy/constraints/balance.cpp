#include "reference/energy/constraints/balance.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

#include "models/kinds.hpp"
#include "reference/energy/potential/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// of the pivots of (∂DΦ/∂ξ)ᵀ, whose columns are of order one
constexpr double rank_threshold = 1e-9;
constexpr double difference = 1e-5;      // of ξ, central
constexpr double idle_stiffness = 1e-9;  // F would move such a mode by 10⁹ L

// Adjacency: bodies that an element or a constraint connects to each body, and the body itself,
// without ground.
std::vector<std::vector<BodyId>> neighbours(const Model& model) {
    std::vector<std::vector<BodyId>> of(model.bodies.size());
    for (std::size_t b = 0; b < of.size(); ++b) of[b].push_back(static_cast<BodyId>(b));
    const auto connect = [&](BodyId a, BodyId b) {
        if (a == ground || b == ground || a == b) return;
        auto& list = of[static_cast<std::size_t>(a)];
        if (std::ranges::find(list, b) == list.end()) list.push_back(b);
    };
    const auto connect_all = [&](const auto& kind) {
        each_body(kind, [&](BodyId a) { each_body(kind, [&](BodyId b) { connect(a, b); }); });
    };
    for (const auto& elastic : model.elastics) connect_all(elastic.kind);
    for (const auto& constraint : model.constraints) connect_all(constraint.kind);
    return of;
}

// Groups of bodies without a common neighbour (graph colouring, Curtis, Powell & Reid 1974): when
// they move together, each gradient entry depends on only one of them. A chain of any length takes
// three groups.
std::vector<std::vector<BodyId>> groups_apart(
    const std::vector<std::vector<BodyId>>& neighbours_of) {
    std::vector<std::vector<BodyId>> groups;
    std::vector<std::vector<bool>> touched;  // neighbours of the bodies of each group
    for (std::size_t b = 0; b < neighbours_of.size(); ++b) {
        std::size_t g = 0;
        const auto apart = [&](BodyId other) {
            return !touched[g][static_cast<std::size_t>(other)];
        };
        while (g < groups.size() && !std::ranges::all_of(neighbours_of[b], apart)) ++g;
        if (g == groups.size()) {
            groups.emplace_back();
            touched.emplace_back(neighbours_of.size(), false);
        }
        groups[g].push_back(static_cast<BodyId>(b));
        for (const BodyId other : neighbours_of[b])
            touched[g][static_cast<std::size_t>(other)] = true;
    }
    return groups;
}

}  // namespace

double largest(const Eigen::Ref<const VectorXd>& v) {
    if (v.size() == 0) return 0;
    return v.allFinite() ? v.cwiseAbs().maxCoeff() : std::numeric_limits<double>::quiet_NaN();
}

Balance balance(const Model& model, const Scales& scales, const VectorXd& gradient,
                const ConstraintValues& values) {
    const int n = static_cast<int>(gradient.size()), m = static_cast<int>(values.Phi.size());
    const VectorXd S = scales.coordinates(n), D = scales.rows(model);
    const VectorXd g = S.cwiseProduct(gradient) / scales.energy();
    Balance at{.lambda = VectorXd::Zero(m),
               .left = g,
               .Phi = D.cwiseProduct(values.Phi),
               .J_t = transposed(scaled(values.Phi_q, D, S)),
               .across = MatrixXd(n, 0),
               .along = MatrixXd::Identity(n, n),
               .independent = {}};
    if (m == 0 || n == 0 || !at.J_t.allFinite() || !g.allFinite()) return at;

    Eigen::CompleteOrthogonalDecomposition<MatrixXd> qr;
    qr.setThreshold(rank_threshold);
    qr.compute(at.J_t);
    const int rank = static_cast<int>(qr.rank());
    const MatrixXd Q = qr.householderQ();
    at.lambda = qr.solve(-g);
    at.left = g + at.J_t * at.lambda;
    at.across = Q.leftCols(rank);
    at.along = Q.rightCols(n - rank);
    for (int i = 0; i < rank; ++i) at.independent.push_back(qr.colsPermutation().indices()[i]);
    return at;
}

Balance balance(const Model& model, const Prescribed& prescribed, const Scales& scales,
                const Chart& chart) {
    return balance(model, scales, potential(model, prescribed, chart).gradient,
                   constraints(model, prescribed, chart));
}

int hessian_evaluations(const Model& model) {
    return 12 * static_cast<int>(groups_apart(neighbours(model)).size());
}

MatrixXd hessian(const Model& model, const Prescribed& prescribed, const Scales& scales,
                 const std::vector<Pose>& centre, const VectorXd& lambda) {
    const int n = coordinates(model);
    const VectorXd S = scales.coordinates(n);
    const VectorXd lambda_D = scales.rows(model).cwiseProduct(lambda) * scales.energy();  // SI
    Chart chart = chart_about(centre);
    const auto gradient_at = [&](const std::vector<BodyId>& bodies, int axis,
                                 double xi) -> VectorXd {
        VectorXd x = VectorXd::Zero(n);
        for (const BodyId b : bodies) x[6 * b + axis] = S[6 * b + axis] * xi;
        move_to(chart, x);
        return gradient_at_centre_stress(model, prescribed, chart) +
               transposed_times(constraints(model, prescribed, chart).Phi_q, lambda_D);
    };
    const auto neighbours_of = neighbours(model);
    MatrixXd geometric = MatrixXd::Zero(n, n);
    for (const auto& bodies : groups_apart(neighbours_of)) {
        for (int axis = 0; axis < 6; ++axis) {
            const VectorXd change =
                (gradient_at(bodies, axis, difference) - gradient_at(bodies, axis, -difference)) /
                (2 * difference);
            for (const BodyId b : bodies)
                for (const BodyId other : neighbours_of[static_cast<std::size_t>(b)])
                    geometric.block<6, 1>(6 * other, 6 * b + axis) =
                        change.segment<6>(6 * other) / S[6 * b + axis];
        }
    }
    move_to(chart, VectorXd::Zero(n));
    const MatrixXd H =
        stiffness(model, prescribed, chart) + 0.5 * (geometric + geometric.transpose());
    return S.asDiagonal() * H * S.asDiagonal() / scales.energy();
}

// With g the gradient of everything but the moment, in ground axes: ∂V/∂φ = Jᵀ g - m with
// J = 1 + ½ φ̃ + ..., whereas the balance is g - m. They differ by
// (1 - Jᵀ) g = ½ φ × g = ½ φ × m, since g = m at equilibrium.
MatrixXd moment_stiffness(const Prescribed& prescribed, const Scales& scales, int n) {
    MatrixXd A = MatrixXd::Zero(n, n);
    for (const auto& moment : prescribed.moments) {
        const int row = 6 * moment.body + 3;
        A.block<3, 3>(row, row) -= 0.5 * skew(moment.m) / scales.energy();
    }
    return A;
}

Modes modes_of(const Balance& at, const MatrixXd& H) {
    Modes modes;
    if (at.along.cols() == 0) return {at.along, VectorXd(0), 0};
    const bool free = at.across.cols() == 0;  // `along` is then the unit matrix
    const MatrixXd reduced = free ? H : MatrixXd(at.along.transpose() * H * at.along);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(reduced);
    modes.Z = free ? eigen.eigenvectors() : MatrixXd(at.along * eigen.eigenvectors());
    modes.stiffness = eigen.eigenvalues();
    const double roundoff = 50 * std::numeric_limits<double>::epsilon();
    modes.idle_limit = idle_stiffness + roundoff * modes.stiffness.cwiseAbs().maxCoeff();
    return modes;
}

std::vector<int> Modes::resisting() const {
    std::vector<int> which;
    for (int i = 0; i < count(); ++i)
        if (!idle(i)) which.push_back(i);
    return which;
}

MatrixXd Modes::idle_motions() const {
    std::vector<int> which;
    for (int i = 0; i < count(); ++i)
        if (idle(i)) which.push_back(i);
    return Z(Eigen::all, which);
}

double excess(const VectorXd& left, const VectorXd& Phi, const Modes& modes, const Scales& scales,
              double tolerance) {
    if (!left.allFinite() || !Phi.allFinite()) return std::numeric_limits<double>::quiet_NaN();
    double worst = largest(Phi);
    const VectorXd g = modes.Z.transpose() * left;
    for (int i = 0; i < modes.count(); ++i) {
        const double allowed = 1 + 8 * scales.roundoff * std::abs(modes.stiffness[i]) / tolerance;
        worst = std::max(worst, std::abs(g[i]) / allowed);
    }
    return worst;
}

}  // namespace elastocheck::reference::energy
