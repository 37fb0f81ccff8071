// All values of a scene as labelled numbers, to compare scenes and to check for NaN.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "elastocheck/scene.hpp"
#include "models/kinds.hpp"

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

// All members of a joint, an element or a load: points, markers and directions i, j, k ... in their
// order, the others by their names.
template <class K>
void add_members(SceneNumbers& n, const K& kind, const std::string& of = "") {
    char last = 'i';
    const auto next = [&] { return of + last++; };
    n.add(of + "kind", static_cast<double>(kind.index()));
    each_member(kind,
                overloaded{[&](const BodyId& body) { n.add(of + "on", body); },
                           [&](const Point& p) { n.add(next(), p); },
                           [&](const Direction& u) { n.add(next(), u); },
                           [&](const Marker& m) { n.add(next(), m); },
                           [&](Length<const double> x) { n.add(of + "length", x.value); },
                           [&](PlaneAngle<const double> x) { n.add(of + "angle", x.value); },
                           [&](ForceAndMoment<const Vector6> x) { n.add("preload", x.value); },
                           [&](Deformation<const Vector6> x) { n.add("undeformed", x.value); },
                           [&](LoadVector<const Eigen::Vector3d> x) { n.add(of + "is", x.value); },
                           [&](const ScalarLaw& law) { add_law(n, "law", law); },
                           [&](const SpatialLaw& law) {
                               if (const Matrix6* all = matrix_of(law)) n.add("law", *all);
                               if (const PerAxis* axes = axes_of(law))
                                   for (std::size_t k = 0; k < 6; ++k)
                                       add_law(n, fmt::format("law_{}", k), axes->axis[k]);
                           },
                           [&](const Formulation& f) {
                               n.add("frame", static_cast<double>(f.frame));
                               n.add("angles", static_cast<double>(f.angles));
                               n.add("conjugate", f.conjugate);
                               n.add("offset_moment", f.offset_moment);
                           }});
}

inline void add_load(SceneNumbers& n, const Load& load) {
    add_members(n, load.kind, load.name + ".");
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

// Of a scene or a model.
template <class S>
std::vector<std::pair<std::string, double>> numbers(const S& scene) {
    SceneNumbers n;
    for (const auto& body : scene.bodies) {
        n.where = "body " + body.name;
        n.add("r", body.design.r);
        n.add("p", body.design.p.coeffs());
    }
    for (const auto& joint : scene.joints) {
        n.where = "joint " + joint.name;
        if constexpr (requires { joint.kind; }) {
            add_members(n, joint.kind);
        } else {
            n.add("i", joint.i);
            n.add("j", joint.j);
            n.add("at", joint.at);
        }
        n.add("only_where_driven", joint.active_only_where_driven);
    }
    for (const auto& elastic : scene.elastics) {
        n.where = "element " + elastic.name;
        add_members(n, elastic.kind);
        n.add("only_where_driven", elastic.active_only_where_driven);
        n.add("written_as", static_cast<double>(elastic.written_as));
    }
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
        n.add("contact", wheel.contact);
        n.add("spin_axis", wheel.spin_axis_local);
        n.add("side", wheel.side);
        n.add("tyre_rate", wheel.tyre_rate);
        if (!wheel.steering_axis) continue;
        n.add("steering_axis.lower", wheel.steering_axis->lower);
        n.add("steering_axis.upper", wheel.steering_axis->upper);
    }
    for (const auto& probe : scene.probes) {
        n.where = "probe " + probe.name;
        n.add("at", probe.at);
    }
    for (const auto& damper : scene.dampers) {
        n.where = "damper " + damper.name;
        n.add("i", damper.i);
        n.add("j", damper.j);
    }
    if constexpr (requires { scene.trim; })
        if (const auto& trim = scene.trim) {
            n.where = "trim";
            for (const auto& one : trim->adjust) {
                add_driver(n, {one.what, 0, one.per_unit});
                n.add("unit", static_cast<double>(one.unit));
            }
            for (const auto& one : trim->until) {
                n.add("condition", static_cast<double>(one.what.index()));
                std::visit(
                    [&](const auto& what) {
                        if constexpr (requires { what.axis; })
                            n.add("axis", what.axis);
                        else
                            n.add("wheel", what.wheel);
                    },
                    one.what);
                if (one.value) n.add("value", *one.value);
            }
        }
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
