#include "compare/deviation/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "compare/deviation/deviation.hpp"
#include "compare/outputs/deformation.hpp"
#include "compare/outputs/positions.hpp"
#include "elastocheck/compare.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double roundings = 16;    // c: number of roundings that add up in one stored force
constexpr double no_force = 1e-12;  // [N]: smaller forces count as zero
constexpr double metre = 1;         // least size of which lengths are a share

// ---- Elastic laws, one function each: the largest stiffness.

// [N/m], rotational and coupling entries as forces at a lever L per displacement of its end.
double stiffness(const LinearStiffness& u, double L) {
    const double K_T = u.K.topLeftCorner<3, 3>().cwiseAbs().maxCoeff(),
                 K_R = u.K.bottomRightCorner<3, 3>().cwiseAbs().maxCoeff(),
                 coupled = u.K.topRightCorner<3, 3>().cwiseAbs().maxCoeff();
    return std::max({K_T, coupled / L, K_R / (L * L)});
}
double stiffness(const PerAxis& u, double L) {
    double k = 0;
    for (std::size_t axis = 0; axis < 6; ++axis)
        k = std::max(k, max_slope(u.axis[axis]) / (axis < 3 ? 1 : L * L));
    return k;
}

double value(const Driver& driver, double a) { return driver.start + driver.rate * a; }

// A wrench as one force [N], the moment as a force at the lever L.
double as_force(const Vector3d& f, const Vector3d& m, double L) {
    return worse(f.norm(), m.norm() / L);
}

// Elastic force of an element, acting load: as a force [N].
double stored(const ElasticKind& kind, std::size_t k, const Branch& branch,
              const Equilibrium& state, double L) {
    const Vector6 F =
        force_with_preload(kind, k, branch, state, deformation(kind, k, branch, state));
    return as_force(F.head<3>(), F.tail<3>(), L);
}

double acting(const LoadKind& load, double factor, double L) {
    return std::abs(factor) * (load_vector(load).norm() / (is_moment(load) ? L : 1));
}

// Attachment points in the design position.
std::vector<Vector3d> attachments(const Model& model) {
    std::vector<Vector3d> points;
    const auto add = [&](const auto& p) { points.push_back(drawn(model, {p.body, p.s_local})); };
    for (const auto& body : model.bodies) points.push_back(body.design.r);
    for (const auto& joint : model.joints) add(joint.at);
    for (const auto& elastic : model.elastics) each_point(elastic.kind, add);
    for (const auto& wheel : model.wheels) add(Point{wheel.body, wheel.centre_local});
    for (const auto& probe : model.probes) add(probe.at);
    return points;
}

}  // namespace

Scale scale_of(const Model& model, const Branch& branch, std::span<const Equilibrium> states) {
    Scale scale;
    Eigen::AlignedBox3d box;
    double reach = 0;  // X
    for (const auto& p : attachments(model)) {
        box.extend(p);
        reach = worse(reach, p.norm());
    }
    const double size = box.isEmpty() ? 0 : box.diagonal().norm();
    // of the coordinates: only rounding separates the points
    constexpr double at_one_place = 1e-12;
    scale.length = size > at_one_place * reach ? size : metre;
    const double L = scale.length;

    double k = 0;
    for (const auto& elastic : model.elastics)
        each_member(
            elastic.kind,
            overloaded{[&](const ScalarLaw& law) { k = worse(k, max_slope(law)); },
                       [&](const SpatialLaw& law) {
                           k = worse(
                               k, std::visit([&](const auto& u) { return stiffness(u, L); }, law));
                       }});
    for (const auto& load : model.static_loads)
        scale.force = worse(scale.force, acting(load.kind, 1, L));
    for (const auto& state : states) {
        for (const auto& driver : branch.drivers)
            if (const Load* load = driven_load(driver.what))
                scale.force = worse(scale.force, acting(load->kind, value(driver, state.load), L));
        for (std::size_t e = 0; e < model.elastics.size(); ++e)
            scale.force = worse(scale.force, stored(model.elastics[e].kind, e, branch, state, L));
        for (const auto& w : state.reactions)
            scale.force = worse(scale.force, as_force(w.force, w.moment, L));
        for (const auto& body : state.poses) reach = worse(reach, body.r.norm());
    }
    scale.round_off = epsilon * k * std::max(reach, L);
    return scale;
}

Scale larger(const Scale& a, const Scale& b) {
    return {worse(a.force, b.force), worse(a.length, b.length), worse(a.round_off, b.round_off)};
}

Bounds bounds_of(const Agreement& agreement, const Scale& scale) {
    const double F = std::max(scale.force, no_force), rounding = roundings * scale.round_off;
    const double lengths = 1e3 * std::max(scale.length, metre);  // [mm]
    Bounds bounds;
    bounds.scale = scale;
    bounds.length = agreement.length * lengths;
    bounds.angle = agreement.angle;
    bounds.force = agreement.wrench * F + rounding;
    bounds.moment = bounds.force * scale.length;
    bounds.residual_force = agreement.residual_force * F + rounding;
    bounds.residual_moment = bounds.residual_force * scale.length;
    bounds.residual_length = agreement.residual_length * lengths;
    return bounds;
}

std::string describe(const Bounds& b) {
    return fmt::format(
        "positions to {:.2g} mm, angles to {:.2g} deg, reactions to {:.2g} N and {:.2g} N·m, "
        "balances to "
        "{:.2g} N "
        "and {:.2g} N·m, constraints to {:.2g} mm (largest force {:.4g} N, size {:.3g} m, "
        "round-off of "
        "stiffness "
        "times length {:.2g} N)",
        b.length, b.angle, b.force, b.moment, b.residual_force, b.residual_moment,
        b.residual_length, b.scale.force, b.scale.length, b.scale.round_off);
}

}  // namespace elastocheck::compare
