#include "tests/legs/legs.hpp"

#include <stdexcept>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/linear_response.hpp"
#include "reference/energy/linear_response.hpp"
#include "reference/equilibrium/linear_response.hpp"

namespace elastocheck::legs {

namespace rec = elastocheck::recursive;

void PrintTo(const Leg& leg, std::ostream* out) {
    *out << (leg.kind == Leg::equilibrium ? "equilibrium"
             : leg.kind == Leg::energy    ? "energy"
                                          : leg.method.name);
}

std::vector<Leg> accurate_legs() {
    return {{Leg::equilibrium},
            {Leg::energy},
            {Leg::recursive, *rec::find_method("series")},
            {Leg::recursive, {"adaptive", 3, rec::Adaptive{1e-12, 1e-12}}}};
}

std::vector<Leg> exact_legs() {
    return {{Leg::equilibrium}, {Leg::energy}, {Leg::recursive, *rec::find_method("series")}};
}

std::vector<Leg> legs_by_every_method() {
    std::vector<Leg> all{{Leg::equilibrium}, {Leg::energy}};
    for (const auto& method : rec::methods) all.push_back({Leg::recursive, method});
    return all;
}

EquilibriumPath solve(const Leg& leg, const SideModel& side, int steps) {
    if (leg.kind == Leg::recursive)
        return rec::solve(side.model, side.branch, {.method = leg.method, .steps = steps});
    return solve(leg, side, every_point(side.branch, steps));
}
EquilibriumPath solve(const Leg& leg, const SideModel& side, std::span<const double> values) {
    return leg.kind == Leg::energy ? reference::energy::solve(side.model, side.branch, values)
                                   : reference::equilibrium::solve(side.model, side.branch, values);
}

Residuals residuals(const Leg& leg, const SideModel& side, const Equilibrium& state) {
    return leg.kind == Leg::equilibrium
               ? reference::equilibrium::residuals(side.model, side.branch, state)
           : leg.kind == Leg::energy ? reference::energy::residuals(side.model, side.branch, state)
                                     : rec::residuals(side.model, side.branch, state);
}

Response linear_response(const Leg& leg, const SideModel& side, const Equilibrium& state,
                         const Disturbance& disturbance) {
    const std::span<const Disturbance> one(&disturbance, 1);
    return leg.kind == Leg::equilibrium
               ? reference::equilibrium::linear_response(side.model, side.branch, state, one)
           : leg.kind == Leg::energy
               ? reference::energy::linear_response(side.model, side.branch, state, one)
               : rec::linear_response(side.model, side.branch, state, one, leg.method);
}

SideModel side_of(const Model& model, std::size_t n) {
    const Branch side = branch_sides(model.branches.at(n)).back();
    return {on_branch(model, side), side};
}
SideModel side_of(const Scene& scene, std::size_t n) { return side_of(compile(scene), n); }

EquilibriumPath solved(const Leg& leg, const SideModel& side, int steps, double balance) {
    EquilibriumPath path = solve(leg, side, steps);
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    EXPECT_EQ(path.points.size(), static_cast<std::size_t>(steps) + 1);
    // Missing points are NaN, so that the claims about them fail.
    const Vector3d none = Vector3d::Constant(NAN);
    path.points.resize(static_cast<std::size_t>(steps) + 1,
                       {NAN,
                        {side.model.bodies.size(), Pose{none}},
                        {side.model.joints.size(), Wrench{none, none}}});
    if (!leg.exact()) return path;
    Worst geometry, forces;
    for (const auto& state : path.points) {
        const Residuals left = residuals(leg, side, state);
        geometry.add(std::fmax(left.length, left.direction), state.load);
        forces.add(std::fmax(left.force, left.moment), state.load);
    }
    EXPECT_TRUE(within(geometry, 1e-10));
    EXPECT_TRUE(within(forces, leg.wider(balance)));
    return path;
}

Scene block(const std::vector<ScalarLaw>& laws) {
    Scene s;
    s.name = "block";
    s.bodies = {{"block", {}}};
    s.joints = {{"guide", Translational{{0}, {ground}, {0, Z}, ground_z}}};
    for (const auto& law : laws)
        s.elastics.push_back({"spring", AxialSpring{{ground, -Z}, {0}, law, 1}});
    s.branches = {load_branch(DeadForce{{0}, Z}, 1)};
    s.probes = {{"block", {0}}};
    return s;
}

Vector3d drawn_position(const Scene& scene, const Point& p) {
    if (p.body == ground) return p.s_local;
    const Pose& design = scene.bodies.at(static_cast<std::size_t>(p.body)).design;
    return design.r + design.p * p.s_local;
}

Scene with_jack(Scene s) {
    const Point centre = wheel_centre(s);
    s.joints.push_back(
        {"jack", InPlane{centre, {ground, drawn_position(s, centre)}, ground_z}, true});
    return s;
}

Scene with_rack(Scene s) {
    auto& tie = std::get<Distance>(s.joints.at(2).kind);
    const Vector3d inner = tie.j.s_local;
    const auto rack = static_cast<BodyId>(s.bodies.size());
    s.bodies.push_back({"rack", {inner}});
    tie.j = {rack};
    s.joints.push_back({"guide", Translational{{rack}, {ground, inner}, {rack, Y}, ground_y}});
    s.joints.push_back({"rack", InPlane{{rack}, {ground, inner}, ground_y}});
    return s;
}

std::size_t joint_named(const Model& model, const std::string& name) {
    for (std::size_t k = 0; k < model.joints.size(); ++k)
        if (model.joints[k].name == name) return k;
    throw std::out_of_range(name);
}

double distance(const Equilibrium& a, const Equilibrium& b, BodyId idle) {
    if (a.poses.size() != b.poses.size()) return INFINITY;
    double worst = 0;
    for (std::size_t k = 0; k < a.poses.size(); ++k)
        if (static_cast<BodyId>(k) != idle)
            worst = std::max({worst, (a.poses[k].r - b.poses[k].r).norm(),
                              a.poses[k].p.angularDistance(b.poses[k].p)});
    return worst;
}

}  // namespace elastocheck::legs
