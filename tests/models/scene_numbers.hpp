// All values of a scene as labelled numbers, to compare scenes and to check for NaN.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "elastocheck/scene.hpp"

namespace elastocheck {

struct SceneNumbers {
    std::vector<std::pair<std::string, double>> all;  // in the order of the scene
    std::string where;

    void add(const std::string& what, double x) { all.emplace_back(where + "." + what, x); }
    template <class Derived>
    void add(const std::string& what, const Eigen::MatrixBase<Derived>& M) {
        for (Eigen::Index i = 0; i < M.rows(); ++i)
            for (Eigen::Index j = 0; j < M.cols(); ++j)
                add(fmt::format("{}({},{})", what, i, j), M(i, j));
    }
    void add(const std::string& what, const Point& p) {
        add(what + ".body", p.body);
        add(what + ".s_local", p.s_local);
    }
    void add(const std::string& what, const Direction& u) {
        add(what + ".body", u.body);
        add(what + ".u_local", u.u_local);
    }
    void add(const std::string& what, const Marker& m) {
        add(what + ".body", m.body);
        add(what + ".s_local", m.s_local);
        add(what + ".A_local", m.A_local.toRotationMatrix());
    }
};

inline void add_load(SceneNumbers& n, const Load& load) {
    std::visit(
        [&](const auto& l) {
            if constexpr (requires { l.at; }) n.add(load.name + ".at", l.at);
            if constexpr (requires { l.body; }) n.add(load.name + ".body", l.body);
            if constexpr (requires { l.f; }) n.add(load.name + ".f", l.f);
            if constexpr (requires { l.m; }) n.add(load.name + ".m", l.m);
            if constexpr (requires { l.f_local; }) n.add(load.name + ".f_local", l.f_local);
            if constexpr (requires { l.m_local; }) n.add(load.name + ".m_local", l.m_local);
        },
        load.kind);
}

inline void add_law(SceneNumbers& n, const std::string& name, const ScalarLaw& law) {
    if (const auto* linear = std::get_if<LinearRate>(&law)) {
        n.add(name, linear->k);
        return;
    }
    const auto& curve = std::get<Curve>(law);
    for (std::size_t k = 0; k < curve.knots.size(); ++k)
        n.add(fmt::format("{}.x_{}", name, k), curve.knots[k]);
    for (std::size_t k = 0; k < curve.pieces.size(); ++k)
        for (std::size_t c = 0; c < 4; ++c)
            n.add(fmt::format("{}.c_{}{}", name, k, c), curve.pieces[k][c]);
    n.add(name + ".known_outside", curve.known_outside);
}

inline void add_elastic(SceneNumbers& n, const ElasticKind& kind) {
    if (const auto* spring = std::get_if<AxialSpring>(&kind)) {
        n.add("i", spring->i), n.add("j", spring->j);
        add_law(n, "k", spring->law), n.add("free_length", spring->free_length);
    } else {
        const auto& bushing = std::get<Bushing>(kind);
        n.add("i", bushing.i), n.add("j", bushing.j);
        if (const auto* linear = std::get_if<LinearStiffness>(&bushing.law)) n.add("K", linear->K);
        if (const auto* axes = std::get_if<PerAxis>(&bushing.law))
            for (std::size_t k = 0; k < 6; ++k) add_law(n, fmt::format("k_{}", k), axes->axis[k]);
        n.add("preload", bushing.preload), n.add("undeformed", bushing.undeformed);
        n.add("frame", static_cast<double>(bushing.formulation.frame));
        n.add("angles", static_cast<double>(bushing.formulation.angles));
        n.add("conjugate", bushing.formulation.conjugate);
        n.add("offset_moment", bushing.formulation.offset_moment);
    }
}

inline void add_joint(SceneNumbers& n, const JointKind& kind) {
    n.add("kind", static_cast<double>(kind.index()));
    std::visit(
        [&](const auto& s) {
            n.add("i", s.i), n.add("j", s.j);
            if constexpr (requires { s.axis_i; }) n.add("axis_i", s.axis_i);
            if constexpr (requires { s.axis_j; }) n.add("axis_j", s.axis_j);
            if constexpr (requires { s.normal_i; }) n.add("normal_i", s.normal_i);
            if constexpr (requires { s.normal_j; }) n.add("normal_j", s.normal_j);
            if constexpr (requires { s.length; }) n.add("length", s.length);
            if constexpr (requires { s.offset; }) n.add("offset", s.offset);
            if constexpr (requires { s.angle; }) n.add("y_j", s.y_j), n.add("angle", s.angle);
            if constexpr (requires { s.x_i; })
                n.add("x_i", s.x_i), n.add("y_i", s.y_i), n.add("x_j", s.x_j), n.add("y_j", s.y_j);
        },
        kind);
}

inline void add_driver(SceneNumbers& n, const Driver& driver) {
    if (const auto* load = std::get_if<Load>(&driver.what)) add_load(n, *load);
    if (const auto* motion = std::get_if<Motion>(&driver.what)) n.add("motion", motion->joint);
    if (const auto* length = std::get_if<FreeLength>(&driver.what))
        n.add("free_length", length->elastic);
    if (const auto* preload = std::get_if<Preload>(&driver.what)) {
        n.add("preload", preload->elastic);
        n.add("start", driver.start * preload->direction);  // e_y at -1 is -e_y at 1
        n.add("rate", driver.rate * preload->direction);
        return;
    }
    n.add("start", driver.start);
    n.add("rate", driver.rate);
}

inline std::vector<std::pair<std::string, double>> numbers(const Scene& scene) {
    SceneNumbers n;
    for (const auto& body : scene.bodies) {
        n.where = "body " + body.name;
        n.add("r", body.design.r);
        n.add("p", body.design.p.coeffs());
    }
    for (const auto& joint : scene.joints) {
        n.where = "joint " + joint.name, add_joint(n, joint.kind);
        n.add("only_where_driven", joint.active_only_where_driven);
    }
    for (const auto& elastic : scene.elastics)
        n.where = "element " + elastic.name, add_elastic(n, elastic.kind);
    n.where = "static loads";
    for (const auto& load : scene.static_loads) add_load(n, load);
    for (const auto& branch : scene.branches) {
        n.where = "branch " + branch.name;
        for (const auto& driver : branch.drivers) add_driver(n, driver);
        n.add("unit", static_cast<double>(branch.unit));
        n.add("from", branch.from);
        n.add("to", branch.to);
        n.add("steps", branch.steps);
    }
    for (const auto& wheel : scene.wheels) {
        n.where = "wheel " + wheel.name;
        n.add("body", wheel.body);
        n.add("centre", wheel.centre_local);
        n.add("contact", wheel.contact_local);
        n.add("spin_axis", wheel.spin_axis_local);
        n.add("side", wheel.side);
        if (!wheel.steering_axis) continue;
        n.add("steering_axis.lower", wheel.steering_axis->lower);
        n.add("steering_axis.upper", wheel.steering_axis->upper);
    }
    for (const auto& probe : scene.probes) n.where = "probe " + probe.name, n.add("at", probe.at);
    for (const auto& damper : scene.dampers)
        n.where = "damper " + damper.name, n.add("i", damper.i), n.add("j", damper.j);
    if (const auto& vehicle = scene.vehicle) {
        n.where = "vehicle";
        n.add("wheelbase", vehicle->wheelbase);
        n.add("cg_height", vehicle->cg_height);
        n.add("axle", static_cast<double>(vehicle->axle));
        n.add("brake_share", vehicle->brake_share);
        n.add("drive_share", vehicle->drive_share);
    }
    return n.all;
}

}  // namespace elastocheck
