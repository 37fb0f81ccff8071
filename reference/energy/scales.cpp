#include "reference/energy/scales.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/energy/overloaded.hpp"
#include "reference/energy/potential.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// Every point at which something is attached, in ground axes at the design pose.
std::vector<Vector3d> attachment_points(const Model& model, const Branch& branch, const Chart& design) {
    std::vector<Vector3d> points;
    const auto add_point = [&](const auto& p) { points.push_back(motion(design[p.body], p.s_local).p); };
    const auto add_pair = [&](const auto& kind) {
        add_point(kind.i);
        add_point(kind.j);
    };
    for (const auto& constraint : model.constraints)
        std::visit(overloaded{[](const PerpendicularDirections&) {}, add_pair}, constraint.kind);
    for (const auto& elastic : model.elastics) std::visit(add_pair, elastic.kind);
    for (const auto* loads : {&model.static_loads, &branch.loads}) {
        for (const auto& load : *loads)
            if (const auto* force = std::get_if<DeadForce>(&load.kind)) add_point(force->at);
    }
    return points;
}

double size_of(const std::vector<Load>& loads, double length) {
    double size = 0;
    for (const auto& load : loads) {
        size += std::visit(overloaded{[](const DeadForce& force) { return force.f.norm(); },
                                      [&](const DeadMoment& moment) { return moment.m.norm() / length; }},
                           load.kind);
    }
    return size;
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
        if (std::holds_alternative<PerpendicularDirections>(constraint.kind)) D[row] = 1;
        row += elastocheck::rows(constraint.kind);
    }
    return D;
}

Scales scales_of(const Model& model, const Branch& branch, std::span<const double> loads) {
    const Chart design = chart_about(design_poses(model));
    const auto points = attachment_points(model, branch, design);
    double extent = 0, distance = 0;
    for (const auto& p : points) {
        distance = std::max(distance, p.norm());
        for (const auto& q : points) extent = std::max(extent, (p - q).norm());
    }
    for (const auto& body : model.bodies) distance = std::max(distance, body.design.r.norm());

    Scales scales;
    if (extent > 1e-9) scales.length = extent;
    scales.roundoff = std::numeric_limits<double>::epsilon() * (1 + distance / scales.length);

    double a = std::abs(branch.to);
    for (const double load : loads)
        if (std::isfinite(load)) a = std::max(a, std::abs(load));
    const double force = size_of(model.static_loads, scales.length) +
                         a * size_of(branch.loads, scales.length) + stress_size(model, design, scales.length);
    if (force > 0 && std::isfinite(force)) scales.force = force;
    return scales;
}

}  // namespace elastocheck::reference::energy
