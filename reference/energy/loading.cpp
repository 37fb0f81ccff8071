#include "reference/energy/loading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/energy/chart.hpp"
#include "reference/energy/overloaded.hpp"
#include "reference/energy/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// Every point at which something is attached, in ground axes at the design pose.
std::vector<Vector3d> attachment_points(const Model& model, const Branch& branch, const Chart& design) {
    std::vector<Vector3d> points;
    const auto add_point = [&](BodyId body, const Vector3d& s_local) {
        points.push_back(motion(design[body], s_local).p);
    };
    const auto add_pair = [&](const auto& kind) {
        add_point(kind.i.body, kind.i.s_local);
        add_point(kind.j.body, kind.j.s_local);
    };
    for (const auto& constraint : model.constraints) {
        std::visit(overloaded{[](const PerpendicularDirections&) {}, add_pair}, constraint.kind);
    }
    for (const auto& elastic : model.elastics) std::visit(add_pair, elastic.kind);
    for (const auto* loads : {&model.static_loads, &branch.loads}) {
        for (const auto& load : *loads) {
            if (const auto* force = std::get_if<DeadForce>(&load.kind))
                add_point(force->at.body, force->at.s_local);
        }
    }
    return points;
}

double size_of(const LoadKind& load, double length) {
    return std::visit(overloaded{[](const DeadForce& force) { return force.f.norm(); },
                                 [&](const DeadMoment& moment) { return moment.m.norm() / length; }},
                      load);
}

// What an element holds at the design pose, as a force [N].
double held(const ElasticKind& elastic, const Chart& design, double length) {
    return std::visit(overloaded{[&](const AxialSpring& s) {
                                     const Vector3d D = motion(design[s.j.body], s.j.s_local).p -
                                                        motion(design[s.i.body], s.i.s_local).p;
                                     return s.k * std::abs(D.norm() - s.free_length);
                                 },
                                 [&](const Bushing& b) {
                                     return b.preload.head<3>().norm() + b.preload.tail<3>().norm() / length;
                                 }},
                      elastic);
}

}  // namespace

void add(Loading& loading, const std::vector<Load>& loads, double factor) {
    for (const auto& load : loads) {
        std::visit(overloaded{[&](const DeadForce& force) {
                                  if (force.at.body != ground)
                                      loading.forces.push_back({force.at, factor * force.f});
                              },
                              [&](const DeadMoment& moment) {
                                  if (moment.body != ground)
                                      loading.moments.push_back({moment.body, factor * moment.m});
                              }},
                   load.kind);
    }
}

Loading loading_at(const Model& model, const Branch& branch, double a) {
    Loading loading;
    add(loading, model.static_loads, 1);
    add(loading, branch.loads, a);
    return loading;
}

Loading settling_at(const Model& model, double tau) {
    Loading loading;
    add(loading, model.static_loads, 1 - tau);
    loading.relief = tau;
    return loading;
}

// With g the gradient of everything but the moment, in ground axes: ∂V/∂φ = Jᵀ g - m, J = 1 + ½ φ̃ + ...,
// whereas the balance is g - m. To first order they differ by (1 - Jᵀ) g = ½ φ × g = ½ φ × m, since g = m
// where they balance.
Eigen::MatrixXd moment_stiffness(const Loading& loading, const Scales& scales, int n) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    for (const auto& moment : loading.moments) {
        const int row = 6 * moment.body + 3;
        A.block<3, 3>(row, row) -= 0.5 * skew(moment.m) / scales.energy();
    }
    return A;
}

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

    Scales scales;
    double extent = 0, distance = 0;
    for (const auto& p : points) {
        distance = std::max(distance, p.norm());
        for (const auto& q : points) extent = std::max(extent, (p - q).norm());
    }
    for (const auto& body : model.bodies) distance = std::max(distance, body.design.r.norm());
    if (extent > 1e-9) scales.length = extent;
    scales.roundoff = std::numeric_limits<double>::epsilon() * (1 + distance / scales.length);

    double a = std::abs(branch.to);
    for (const double load : loads)
        if (std::isfinite(load)) a = std::max(a, std::abs(load));
    double force = 0;
    for (const auto& load : model.static_loads) force += size_of(load.kind, scales.length);
    for (const auto& load : branch.loads) force += a * size_of(load.kind, scales.length);
    for (const auto& elastic : model.elastics) force += held(elastic.kind, design, scales.length);
    if (force > 0) scales.force = force;
    return scales;
}

}  // namespace elastocheck::reference::energy
