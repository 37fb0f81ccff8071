#include "reference/energy/constraints.hpp"

#include "reference/energy/overloaded.hpp"
#include "reference/energy/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct Rows {
    ConstraintValues& out;
    int row;

    // ∂Φ/∂(δr, δπ) of one body; ground has no coordinates.
    void add_row(BodyId body, const Vector3d& dr, const Vector3d& dpi) const {
        if (body == ground) return;
        out.Phi_q.block<1, 3>(row, 6 * body) += dr.transpose();
        out.Phi_q.block<1, 3>(row, 6 * body + 3) += dpi.transpose();
    }
};

// Φ = p_i - p_j,  δp = δr - ũ δπ
void fill(const CoincidentPoints& c, const Chart& chart, const Rows& rows) {
    const PointMotion i = motion(chart[c.i.body], c.i.s_local);
    const PointMotion j = motion(chart[c.j.body], c.j.s_local);
    rows.out.Phi.segment<3>(rows.row) = i.p - j.p;
    rows.out.dPhi.segment<3>(rows.row) = i.dp - j.dp;
    const auto add = [&](BodyId body, double sign, const Vector3d& lever) {
        if (body == ground) return;
        rows.out.Phi_q.block<3, 3>(rows.row, 6 * body) += sign * Matrix3d::Identity();
        rows.out.Phi_q.block<3, 3>(rows.row, 6 * body + 3) -= sign * skew(lever);
    };
    add(c.i.body, 1, i.lever);
    add(c.j.body, -1, j.lever);
}

// Φ = n·D, D = p_i - p_j:  δΦ = n·(δp_i - δp_j) + δπ_j·(n × D),  n·δp = n·δr + (u × n)·δπ
// Φ - Φ_c = n·ΔD + Δn·D_c
void fill(const PointInPlane& c, const Chart& chart, const Rows& rows) {
    const PointMotion i = motion(chart[c.i.body], c.i.s_local);
    const PointMotion j = motion(chart[c.j.body], c.j.s_local);
    const DirectionMotion n = turned(chart[c.normal_j.body], c.normal_j.u_local);
    const Vector3d D = i.p - j.p, dD = i.dp - j.dp;
    rows.out.Phi[rows.row] = n.u.dot(D);
    rows.out.dPhi[rows.row] = n.u.dot(dD) + n.du.dot(D - dD);
    rows.add_row(c.i.body, n.u, i.lever.cross(n.u));
    rows.add_row(c.j.body, -n.u, -j.lever.cross(n.u));
    rows.add_row(c.normal_j.body, Vector3d::Zero(), n.u.cross(D));
}

// Φ = u_i·u_j:  δΦ = (u_i × u_j)·(δπ_i - δπ_j);  Φ - Φ_c = Δu_i·u_j + u_ic·Δu_j
void fill(const PerpendicularDirections& c, const Chart& chart, const Rows& rows) {
    const DirectionMotion i = turned(chart[c.i.body], c.i.u_local);
    const DirectionMotion j = turned(chart[c.j.body], c.j.u_local);
    rows.out.Phi[rows.row] = i.u.dot(j.u);
    rows.out.dPhi[rows.row] = i.du.dot(j.u) + (i.u - i.du).dot(j.du);
    rows.add_row(c.i.body, Vector3d::Zero(), i.u.cross(j.u));
    rows.add_row(c.j.body, Vector3d::Zero(), j.u.cross(i.u));
}

// Φ = (D·D - ℓ²)/(2ℓ), a length that is regular everywhere:  δΦ = D·(δp_i - δp_j)/ℓ
// Φ - Φ_c = ΔD·(D + D_c)/(2ℓ)
void fill(const DistanceBetween& c, const Chart& chart, const Rows& rows) {
    const PointMotion i = motion(chart[c.i.body], c.i.s_local);
    const PointMotion j = motion(chart[c.j.body], c.j.s_local);
    const Vector3d D = i.p - j.p, dD = i.dp - j.dp, n = D / c.length;
    const double distance = D.norm();
    rows.out.Phi[rows.row] = (distance - c.length) * (distance + c.length) / (2 * c.length);
    rows.out.dPhi[rows.row] = dD.dot(D + (D - dD)) / (2 * c.length);
    rows.add_row(c.i.body, n, i.lever.cross(n));
    rows.add_row(c.j.body, -n, -j.lever.cross(n));
}

}  // namespace

ConstraintValues constraints(const Model& model, const Chart& chart) {
    const int m = constraint_rows(model), n = coordinates(model);
    ConstraintValues values{VectorXd::Zero(m), VectorXd::Zero(m), MatrixXd::Zero(m, n)};
    int row = 0;
    for (const auto& constraint : model.constraints) {
        std::visit([&](const auto& kind) { fill(kind, chart, Rows{values, row}); }, constraint.kind);
        row += rows(constraint.kind);
    }
    // From (δr, δπ) to (δr, δφ): δπ = J δφ.
    for (std::size_t b = 0; b < chart.placements.size(); ++b) {
        auto columns = values.Phi_q.middleCols<3>(6 * static_cast<int>(b) + 3);
        columns = (columns * chart.placements[b].J).eval();
    }
    return values;
}

}  // namespace elastocheck::reference::energy
