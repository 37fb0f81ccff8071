#include "reference/energy/constraints/constraints.hpp"

#include <cmath>
#include <numbers>

#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Rows of one constraint, and the displacement of its length, offset or angle.
struct Rows {
    ConstraintValues& out;
    int row;
    double moved;

    // ∂Φ/∂(δr, δπ) of one body; ground has no coordinates.
    void add_row(BodyId body, const Vector3d& dr, const Vector3d& dpi, int after = 0) const {
        if (body != ground) out.Phi_q.slopes.push_back({row + after, body, dr, dpi});
    }
    // Scales the last added row.
    void scale(double factor) const {
        auto& slopes = out.Phi_q.slopes;
        for (auto s = slopes.rbegin(); s != slopes.rend() && s->row == row; ++s) {
            s->dr *= factor;
            s->dpi *= factor;
        }
    }
};

// Φ = p_i - p_j,  δp = δr - ũ δπ
void fill(const CoincidentPoints& c, const Chart& chart, const Rows& rows) {
    const PointMotion i = motion(chart[c.i.body], c.i.s_local);
    const PointMotion j = motion(chart[c.j.body], c.j.s_local);
    rows.out.Phi.segment<3>(rows.row) = i.p - j.p;
    rows.out.dPhi.segment<3>(rows.row) = i.displacement - j.displacement;
    for (int k = 0; k < 3; ++k) {  // e_k·δp = e_k·δr + (u × e_k)·δπ
        const Vector3d e = Vector3d::Unit(k);
        rows.add_row(c.i.body, e, i.lever.cross(e), k);
        rows.add_row(c.j.body, -e, -j.lever.cross(e), k);
    }
}

// Φ = n·D - h, D = p_i - p_j:  δΦ = n·(δp_i - δp_j) + δπ_j·(n × D),  n·δp = n·δr + (u × n)·δπ
// Φ - Φ_c = n·ΔD + Δn·D_c
void fill(const PointInPlane& c, const Chart& chart, const Rows& rows) {
    const PointMotion i = motion(chart[c.i.body], c.i.s_local);
    const PointMotion j = motion(chart[c.j.body], c.j.s_local);
    const DirectionMotion n = turned(chart[c.normal_j.body], c.normal_j.u_local);
    const Vector3d D = i.p - j.p, dD = i.displacement - j.displacement;
    rows.out.Phi[rows.row] = n.u.dot(D) - (c.offset + rows.moved);
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

// Φ = (D·D - ℓ²)/(2ℓ), a length that is differentiable everywhere:  δΦ = D·(δp_i - δp_j)/ℓ
// Φ - Φ_c = ΔD·(D + D_c)/(2ℓ)
void fill(const DistanceBetween& c, const Chart& chart, const Rows& rows) {
    const PointMotion i = motion(chart[c.i.body], c.i.s_local);
    const PointMotion j = motion(chart[c.j.body], c.j.s_local);
    const Vector3d D = i.p - j.p, dD = i.displacement - j.displacement;
    const double distance = D.norm(), length = c.length + rows.moved;
    const Vector3d n = D / length;
    rows.out.Phi[rows.row] = (distance - length) * (distance + length) / (2 * length);
    rows.out.dPhi[rows.row] = dD.dot(D + (D - dD)) / (2 * length);
    rows.add_row(c.i.body, n, i.lever.cross(n));
    rows.add_row(c.j.body, -n, -j.lever.cross(n));
}

// Direction perpendicular to the one at α in the plane of x_j and y_j: v(α) = cos α y_j - sin α
// x_j,  v(α + π/2) = dv/dα
Direction across(const DirectionAtAngle& c, double alpha) {
    return {c.j.body, std::cos(alpha) * c.y_j.u_local - std::sin(alpha) * c.j.u_local};
}

// Φ = u_i·v(α): perpendicularity to v.
void fill(const DirectionAtAngle& c, const Chart& chart, const Rows& rows) {
    fill(PerpendicularDirections{c.i, across(c, c.angle + rows.moved)}, chart, rows);
}

// ---- ∂/∂a: Φ_a in `out.Phi` and ∂²Φ/∂x∂a in `out.Phi_q`, where the offset moves with `rate`.

void fill_rate(const CoincidentPoints&, const Chart&, const Rows&, double) {}
void fill_rate(const PerpendicularDirections&, const Chart&, const Rows&, double) {}

// Φ = n·D - h:  ∂Φ/∂h = -1
void fill_rate(const PointInPlane&, const Chart&, const Rows& rows, double rate) {
    rows.out.Phi[rows.row] = -rate;
}

// Φ = D·D/(2ℓ) - ℓ/2:  ∂Φ/∂ℓ = -D·D/(2ℓ²) - ½,  Φ_x ~ 1/ℓ so that ∂Φ_x/∂ℓ = -Φ_x/ℓ
void fill_rate(const DistanceBetween& c, const Chart& chart, const Rows& rows, double rate) {
    fill(c, chart, rows);
    const double length = c.length + rows.moved;
    const Vector3d D =
        motion(chart[c.i.body], c.i.s_local).p - motion(chart[c.j.body], c.j.s_local).p;
    rows.out.Phi[rows.row] = -rate * (0.5 * D.squaredNorm() / (length * length) + 0.5);
    rows.scale(-rate / length);
}

// ∂Φ/∂α = u_i·v(α + π/2)
void fill_rate(const DirectionAtAngle& c, const Chart& chart, const Rows& rows, double rate) {
    fill(PerpendicularDirections{c.i, across(c, c.angle + rows.moved + std::numbers::pi / 2)},
         chart, rows);
    rows.out.Phi[rows.row] *= rate;
    rows.scale(rate);
}

// From (δr, δπ) to (δr, δφ): δπ = J δφ.
void to_chart(const Chart& chart, Jacobian& Phi_q) {
    for (auto& slope : Phi_q.slopes)
        slope.dpi = (chart[slope.body].J.transpose() * slope.dpi).eval();
}

ConstraintValues zero_values(const Model& model) {
    const int m = constraint_rows(model), n = coordinates(model);
    ConstraintValues values{VectorXd::Zero(m), VectorXd::Zero(m), {m, n, {}}};
    values.Phi_q.slopes.reserve(3 * static_cast<std::size_t>(m));
    return values;
}

// f(kind, position in Model::constraints, first row) for every constraint.
template <class F>
void for_each_constraint(const Model& model, F f) {
    int row = 0;
    for (int k = 0; k < static_cast<int>(model.constraints.size()); ++k) {
        const auto& kind = model.constraints[static_cast<std::size_t>(k)].kind;
        f(kind, k, row);
        row += rows(kind);
    }
}

}  // namespace

ConstraintValues constraints(const Model& model, const Prescribed& prescribed, const Chart& chart) {
    ConstraintValues values = zero_values(model);
    for_each_constraint(model, [&](const ConstraintKind& kind, int k, int row) {
        std::visit(
            [&](const auto& c) {
                fill(c, chart, Rows{values, row, prescribed.offset[k]});
            },
            kind);
    });
    values.Phi -= prescribed.gap;
    to_chart(chart, values.Phi_q);
    return values;
}

void add_curvature(const ConstraintKind& kind, double offset, const Chart& chart,
                   const double* lambda, Blocks& H) {
    const auto lever = [&](const Point& p) -> Carried {
        return {p.body, motion(chart[p.body], p.s_local).lever};
    };
    const auto direction = [&](const Direction& d) -> Carried {
        return {d.body, turned(chart[d.body], d.u_local).u};
    };
    const auto between = [&](const Point& i, const Point& j) -> Vector3d {
        return motion(chart[i.body], i.s_local).p - motion(chart[j.body], j.s_local).p;
    };
    const auto cosine = [&](const Direction& i, const Direction& j) {
        add_curvature_of_cosine(lambda[0], direction(i), direction(j), H);
    };
    std::visit(
        overloaded{[&](const CoincidentPoints& c) {
                       const Vector3d f(lambda[0], lambda[1], lambda[2]);
                       add_curvature_along(f, lever(c.i), H);
                       add_curvature_along(-f, lever(c.j), H);
                   },
                   [&](const PointInPlane& c) {
                       const Carried n{c.normal_j.body, lambda[0] * direction(c.normal_j).u};
                       add_curvature_of_offset(n, between(c.i, c.j), lever(c.i), lever(c.j), H);
                   },
                   [&](const PerpendicularDirections& c) { cosine(c.i, c.j); },
                   [&](const DistanceBetween& c) {
                       const double by_length = lambda[0] / (c.length + offset);
                       add_curvature_of_difference(by_length * between(c.i, c.j),
                                                   by_length * Matrix3d::Identity(), lever(c.i),
                                                   lever(c.j), H);
                   },
                   [&](const DirectionAtAngle& c) { cosine(c.i, across(c, c.angle + offset)); }},
        kind);
}

ConstraintRates constraint_rates(const Model& model, const Prescribed& prescribed,
                                 const Prescribed& rate, const Chart& chart) {
    ConstraintValues rates = zero_values(model);
    for_each_constraint(model, [&](const ConstraintKind& kind, int k, int row) {
        if (rate.offset[k] == 0) return;
        std::visit(
            [&](const auto& c) {
                fill_rate(c, chart, Rows{rates, row, prescribed.offset[k]}, rate.offset[k]);
            },
            kind);
    });
    to_chart(chart, rates.Phi_q);
    return {rates.Phi - rate.gap, rates.Phi_q};
}

std::optional<double> measured_offset(const ConstraintKind& kind, const Chart& chart) {
    const auto between = [&](const auto& c) -> Vector3d {
        return motion(chart[c.i.body], c.i.s_local).p - motion(chart[c.j.body], c.j.s_local).p;
    };
    const auto axis = [&](const Direction& d) { return turned(chart[d.body], d.u_local).u; };
    using Measured = std::optional<double>;
    return std::visit(
        overloaded{
            [](const CoincidentPoints&) -> Measured { return {}; },
            [](const PerpendicularDirections&) -> Measured { return {}; },
            [&](const PointInPlane& c) -> Measured { return axis(c.normal_j).dot(between(c)); },
            [&](const DistanceBetween& c) -> Measured { return between(c).norm(); },
            [&](const DirectionAtAngle& c) -> Measured {
                const Vector3d u = axis(c.i);
                const double alpha = std::atan2(u.dot(axis(c.y_j)), u.dot(axis(c.j)));
                return c.angle + std::remainder(alpha - c.angle, 2 * std::numbers::pi);
            }},
        kind);
}

double own_offset(const ConstraintKind& kind) {
    const double* value = driven_number(kind);
    return value != nullptr ? *value : 0;
}

}  // namespace elastocheck::reference::energy
