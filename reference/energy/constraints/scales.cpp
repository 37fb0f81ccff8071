#include "reference/energy/constraints/scales.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "models/eigen/dense.hpp"
#include "models/kinds.hpp"
#include "reference/energy/constraints/constraints.hpp"
#include "reference/energy/constraints/quadratic.hpp"
#include "reference/energy/potential/potential.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double coincident = 1e-9;  // [m] closer points count as coincident
constexpr double rounding = 1e-12;   // generous relative error of a distance
// of L or 1 rad: range of validity of the stiffness at the design pose
constexpr double linear_reach = 0.5;

// Every attachment point, in ground axes in the design pose.
std::vector<Vector3d> attachment_points(const Model& model, const Course& course,
                                        const Chart& design) {
    std::vector<Vector3d> points;
    const auto add_point = [&](const auto& p) {
        points.push_back(motion(design[p.body], p.s_local).p);
    };
    for (const auto& constraint : model.constraints) each_point(constraint.kind, add_point);
    for (const auto& elastic : model.elastics) each_point(elastic.kind, add_point);
    for (const auto* prescribed : {&course.start, &course.rate}) {
        for (const auto& force : prescribed->forces) add_point(force.at);
        for (const auto& brake : prescribed->brakes) add_point(brake.patch);
    }
    return points;
}

// Largest distance between any two of the points. By the triangle inequality it is at most
// the sum of their distances from a third point; testing from the outermost points inwards
// leaves few pairs.
double extent_of(const std::vector<Vector3d>& points) {
    Eigen::AlignedBox3d box;
    for (const auto& p : points) box.extend(p);
    Vector3d centre = Vector3d::Zero();
    if (!box.isEmpty()) centre = box.center();
    std::vector<std::pair<double, Vector3d>> outermost;
    for (const auto& p : points) outermost.emplace_back((p - centre).norm() * (1 + rounding), p);
    std::ranges::sort(outermost, std::greater{}, [](const auto& entry) { return entry.first; });
    double extent = 0;
    for (std::size_t i = 0; i < outermost.size(); ++i)
        for (std::size_t j = 0; j < i && outermost[i].first + outermost[j].first > extent; ++j)
            extent = std::max(extent, (outermost[i].second - outermost[j].second).norm());
    return extent;
}

double loads_size(const Prescribed& prescribed, double length) {
    double size = 0;
    for (const auto& force : prescribed.forces) size += force.f.norm();
    for (const auto& brake : prescribed.brakes) size += brake.f.norm();
    for (const auto& moment : prescribed.moments) size += moment.m.norm() / length;
    return size;
}

// Work of moving the joints from the design pose to Φ = 0, divided by the distance: with J dξ = -Φ,
// minimal over the free motion of the elements along the null space Z of J,
//
//   dξ = p + Z y,   p = -J⁺ Φ,   y = -(Zᵀ K Z)⁺ Zᵀ K p,   F = dξᵀ K dξ / (L |dξ|).
double dense_drive_size(const Model& model, const Prescribed& prescribed, const Chart& design,
                        const Scales& scales) {
    const VectorXd S = scales.coordinates(coordinates(model)), D = scales.rows(model);
    const ConstraintValues values = constraints(model, prescribed, design);
    const MatrixXd J_t = transposed(scaled(values.Phi_q, D, S));
    const MatrixXd K =
        S.asDiagonal() * stiffness(model, prescribed, design).dense() * S.asDiagonal();
    if (J_t.cols() == 0 || K.rows() == 0 || !J_t.allFinite() || !K.allFinite() ||
        !values.Phi.allFinite())
        return 0;
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> qr;
    qr.setThreshold(rank_threshold);
    qr.compute(J_t);
    const VectorXd closing = -D.cwiseProduct(values.Phi), p = qr.transpose().solve(closing);
    const MatrixXd Z = times_matrix(
        qr.householderQ(), MatrixXd::Identity(K.rows(), K.rows()).rightCols(K.rows() - qr.rank()));
    VectorXd dxi = p;
    if (Z.cols() > 0) {
        Eigen::CompleteOrthogonalDecomposition<MatrixXd> compliance;
        compliance.setThreshold(rank_threshold);
        const MatrixXd K_Z = K * Z, reduced = Z.transpose() * K_Z;
        const VectorXd force = K_Z.transpose() * p;
        compliance.compute(reduced);
        dxi -= Z * VectorXd(compliance.solve(force));
    }
    const double distance = dxi.norm();
    if (!(distance > scales.roundoff)) return 0;
    return dxi.dot(K * dxi) / (scales.length * distance) * std::min(1.0, linear_reach / distance);
}

double drive_size(const Model& model, const Prescribed& prescribed, const Chart& design,
                  const Scales& scales) {
    if (!is_large(model)) return dense_drive_size(model, prescribed, design, scales);
    const VectorXd S = scales.coordinates(coordinates(model)), D = scales.rows(model);
    const ConstraintValues values = constraints(model, prescribed, design);
    const Blocks K = scaled(stiffness(model, prescribed, design), scales);
    if (values.Phi.size() == 0 || !values.Phi.allFinite() || !K.finite()) return 0;
    const Quadratic elastic(K, Blocks{K.size}, scaled(values.Phi_q, D, S));
    const VectorXd dxi =
        elastic.minimum(VectorXd::Zero(K.size), D.cwiseProduct(values.Phi), MatrixXd(K.size, 0)).x;
    const double distance = dxi.norm();
    if (!(distance > scales.roundoff)) return 0;
    return scales.force * dxi.dot(elastic.gradient(dxi)) / distance *
           std::min(1.0, linear_reach / distance);
}

// Whether anything but loads changes; stresses and gaps of joints do not depend on loads.
bool moves_parts(const Prescribed& rate) {
    return !(rate.offset.isZero(0) && rate.gap.isZero(0) && rate.free_length.isZero(0) &&
             rate.preload.isZero(0) && rate.strength.isZero(0));
}

}  // namespace

VectorXd Scales::coordinates(int n) const {
    VectorXd S = VectorXd::Ones(n);
    for (int b = 0; b < n / 6; ++b) S.segment<3>(6 * b).setConstant(length);
    return S;
}

VectorXd Scales::rows(const Model& model) const {
    VectorXd D = VectorXd::Constant(constraint_rows(model), 1 / length);
    int row = 0;
    for (const auto& constraint : model.constraints) {
        if (is_direction(constraint.kind)) D[row] = 1;
        row += elastocheck::rows(constraint.kind);
    }
    return D;
}

Scales lengths_of(const Model& model, const Course& course) {
    const auto points = attachment_points(model, course, chart_about(design_poses(model)));
    const double extent = extent_of(points);
    double distance = 0;
    for (const auto& p : points) distance = std::max(distance, p.norm());
    for (const auto& body : model.bodies) distance = std::max(distance, body.design.r.norm());

    Scales scales;
    if (extent > coincident) scales.length = extent;
    scales.roundoff = std::numeric_limits<double>::epsilon() * (1 + distance / scales.length);
    return scales;
}

Scales scales_of(const Model& model, const Course& course, std::span<const double> values) {
    Scales scales = lengths_of(model, course);
    const Chart design = chart_about(design_poses(model));
    double a = 0;
    for (const double value : values)
        if (std::isfinite(value)) a = std::max(a, std::abs(value));
    double force =
        loads_size(course.start, scales.length) + a * loads_size(course.rate, scales.length);
    double elastic = 0;
    const std::vector<double> ends =
        moves_parts(course.rate) ? std::vector{0.0, a, -a} : std::vector{0.0};
    for (const double end : ends) {
        const Prescribed prescribed = at(course, end);
        elastic = std::max(elastic, stress_size(model, prescribed, design, scales.length) +
                                        drive_size(model, prescribed, design, scales));
    }
    force += elastic;
    if (force > 0 && std::isfinite(force)) scales.force = force;
    return scales;
}

}  // namespace elastocheck::reference::energy
