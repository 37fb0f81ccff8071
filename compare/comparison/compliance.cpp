#include "compare/comparison/compliance.hpp"

#include <algorithm>
#include <functional>
#include <variant>

#include "compare/outputs/deformation.hpp"
#include "compare/outputs/positions.hpp"
#include "models/branch.hpp"
#include "models/kinds.hpp"
#include "recursive/linear_response.hpp"
#include "reference/energy/linear_response.hpp"
#include "reference/equilibrium/linear_response.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

// A jack: a plane that carries a point of a wheel and is active only where driven.
bool is_jack(const Model& model, std::size_t joint) {
    const ModelJoint& j = model.joints[joint];
    return j.active_only_where_driven && j.j == ground &&
           std::ranges::any_of(model.constraints,
                               [&](const Constraint& c) {
                                   return c.joint == static_cast<int>(joint) &&
                                          std::holds_alternative<PointInPlane>(c.kind);
                               }) &&
           std::ranges::any_of(model.wheels, [&](const Wheel& wheel) {
               return wheel.body == j.i &&
                      (wheel.centre_local == j.at.s_local || wheel.contact_local == j.at.s_local);
           });
}

// A tyre: a bushing between ground and a wheel with stiffness in d_z only, active only where
// driven.
const Bushing* tyre(const Elastic& elastic) {
    return elastic.active_only_where_driven ? std::get_if<Bushing>(&elastic.kind) : nullptr;
}

// Vertical force of a tyre on its wheel [N].
double tyre_force(const Bushing& tyre, std::size_t element, const Branch& branch,
                  const Equilibrium& state) {
    double stress = tyre.preload.z();
    for (const auto& driver : branch.drivers)
        if (const Vector6* direction = preload(driver.what);
            direction != nullptr && driven_element(driver.what) == static_cast<int>(element))
            stress += (driver.start + driver.rate * state.load) * direction->z();
    const auto& K = std::get<LinearStiffness>(tyre.law).K;
    return -(stress + K(2, 2) * deformation(tyre, state).z());
}

struct ResponseCase {
    Model model;
    Branch branch;
    Equilibrium state;
};

ResponseCase freed(const BranchSide& side, const Equilibrium& state) {
    ResponseCase free{side.model, side.branch, state};
    const auto push = [&](const Point& at, double force) {
        free.model.static_loads.push_back({"held", DeadForce{at, force * Vector3d::UnitZ()}});
    };
    std::erase_if(free.branch.drivers, [&](const Driver& driver) {
        const int joint = driven_joint(driver.what);
        return joint >= 0 && is_jack(side.model, static_cast<std::size_t>(joint));
    });
    for (std::size_t k = 0; k < side.model.joints.size(); ++k)
        if (is_jack(side.model, k)) {
            push(side.model.joints[k].at, state.reactions[k].force.z());
            free.state.reactions[k] = {};
        }
    for (std::size_t k = 0; k < side.model.elastics.size(); ++k)
        if (const Bushing* at = tyre(side.model.elastics[k])) {
            push({at->j.body, at->j.s_local}, tyre_force(*at, k, side.branch, state));
            std::erase_if(free.branch.drivers, [&](const Driver& driver) {
                return driven_element(driver.what) == static_cast<int>(k);
            });
        }
    free.model = on_branch(free.model, free.branch);
    return free;
}

// Adds jacks under the first wheels, each at the height of its wheel's centre.
ResponseCase jacked_up(ResponseCase freed_case, std::size_t wheels) {
    for (const Wheel& wheel : std::span(freed_case.model.wheels).first(wheels)) {
        const Point centre{wheel.body, wheel.centre_local};
        const Vector3d here = position(freed_case.state.poses, centre);
        const int joint = static_cast<int>(freed_case.model.joints.size());
        freed_case.model.joints.push_back(
            {.name = wheel.name + " jack",
             .i = wheel.body,
             .j = ground,
             .at = centre,
             .driven = static_cast<int>(freed_case.model.constraints.size())});
        freed_case.model.constraints.push_back(
            {joint, PointInPlane{centre, {ground, here}, {ground, Vector3d::UnitZ()}, 0}});
        freed_case.state.reactions.emplace_back();
    }
    return freed_case;
}

// ---- The derivatives of these models by a number.

// Of the position of a point p of a body, which moves by dp within it.
Vector3d position_rate(const Equilibrium& state, const StateRate& by, const Point& p,
                       const Vector3d& dp_local) {
    const Eigen::Quaterniond& A = pose(state.poses, p.body).p;
    Vector3d rate = A * dp_local;
    if (p.body != ground) {
        const Increment& body = by.increments[static_cast<std::size_t>(p.body)];
        rate += body.dr + body.dpi.cross(A * p.s_local);
    }
    return rate;
}

// The marker on ground keeps the axes of d_z where only it moves; else they turn by ω.
double tyre_force_rate(const Bushing& tyre, const Bushing& d, std::size_t element,
                       const Branch& branch, const Branch& branch_rate, const Equilibrium& state,
                       const StateRate& by) {
    double stress = d.preload.z();
    for (std::size_t k = 0; k < branch.drivers.size(); ++k) {
        const Driver &driver = branch.drivers[k], &change = branch_rate.drivers[k];
        const Vector6 *direction = preload(driver.what), *turned = preload(change.what);
        if (direction == nullptr || driven_element(driver.what) != static_cast<int>(element))
            continue;
        stress += (change.start + change.rate * state.load) * direction->z() +
                  (driver.start + driver.rate * state.load) * turned->z();
    }
    const Eigen::Quaterniond A = pose(state.poses, tyre.i.body).p * tyre.i.A_local;
    const Eigen::Quaterniond turn = d.i.A_local * tyre.i.A_local.conjugate();
    Vector3d omega = pose(state.poses, tyre.i.body).p * (2 * turn.vec());
    if (tyre.i.body != ground) omega += by.increments[static_cast<std::size_t>(tyre.i.body)].dpi;
    const Point i{tyre.i.body, tyre.i.s_local}, j{tyre.j.body, tyre.j.s_local};
    const Vector3d D = position(state.poses, j) - position(state.poses, i),
                   dD = position_rate(state, by, j, d.j.s_local) -
                        position_rate(state, by, i, d.i.s_local);
    const double dz = (A.conjugate() * (dD - omega.cross(D))).z() - d.undeformed.z();
    const auto& K = std::get<LinearStiffness>(tyre.law).K;
    const auto& dK = std::get<LinearStiffness>(d.law).K;
    return -(stress + dK(2, 2) * deformation(tyre, state).z() + K(2, 2) * dz);
}

// Of freed(), in its order. `rate`: of side.model, with its branch first.
Model freed_rate(const BranchSide& side, const Equilibrium& state, const Model& rate,
                 const StateRate& by) {
    Model free = rate;
    const Branch& branch_rate = rate.branches.front();
    std::vector<bool> drops(side.branch.drivers.size(), false);
    const auto drop = [&](const auto& driven_part, int k) {
        for (std::size_t d = 0; d < drops.size(); ++d)
            if (driven_part(side.branch.drivers[d].what) == k) drops[d] = true;
    };
    const auto push = [&](const Point& at, double force) {
        free.static_loads.push_back({"held", DeadForce{at, force * Vector3d::UnitZ()}});
    };
    for (std::size_t k = 0; k < side.model.joints.size(); ++k)
        if (is_jack(side.model, k)) {
            push(rate.joints[k].at, by.reactions[k].force.z());
            drop(driven_joint, static_cast<int>(k));
        }
    for (std::size_t k = 0; k < side.model.elastics.size(); ++k)
        if (const Bushing* at = tyre(side.model.elastics[k])) {
            const auto& d = std::get<Bushing>(rate.elastics[k].kind);
            push({at->j.body, d.j.s_local},
                 tyre_force_rate(*at, d, k, side.branch, branch_rate, state, by));
            drop(driven_element, static_cast<int>(k));
        }
    Branch left = branch_rate;
    left.drivers.clear();
    for (std::size_t d = 0; d < drops.size(); ++d)
        if (!drops[d]) left.drivers.push_back(branch_rate.drivers[d]);
    return on_branch(free, left);
}

// Of jacked_up(): the planes follow the wheel centres. `wheels`: of the model and of its rate.
Model jacked_up_rate(Model free, const Model& model, std::size_t wheels, const Equilibrium& state,
                     const StateRate& by) {
    for (std::size_t w = 0; w < wheels; ++w) {
        const Wheel& wheel = model.wheels[w];
        const Point centre{wheel.body, free.wheels[w].centre_local};
        const Vector3d here =
            position_rate(state, by, {wheel.body, wheel.centre_local}, free.wheels[w].centre_local);
        const int joint = static_cast<int>(free.joints.size());
        free.joints.push_back({.name = wheel.name + " jack",
                               .i = wheel.body,
                               .j = ground,
                               .at = centre,
                               .driven = static_cast<int>(free.constraints.size())});
        free.constraints.push_back(
            {joint, PointInPlane{centre, {ground, here}, {ground, Vector3d::Zero()}, 0}});
    }
    return free;
}

// Unit forces and moments at the wheel centres, then forces at the patches.
std::vector<Disturbance> causes_at(const Model& model, bool with_patches) {
    std::vector<Disturbance> list;
    for (const Wheel& wheel : model.wheels) {
        const Point centre{wheel.body, wheel.centre_local}, patch{wheel.body, wheel.contact_local};
        for (int k = 0; k < 3; ++k)
            list.push_back(UnitWrench{centre, Vector3d::Unit(k), Vector3d::Zero()});
        for (int k = 0; k < 3; ++k)
            list.push_back(UnitWrench{centre, Vector3d::Zero(), Vector3d::Unit(k)});
        for (int k = 0; with_patches && k < 3; ++k)
            list.push_back(UnitWrench{patch, Vector3d::Unit(k), Vector3d::Zero()});
    }
    return list;
}

// A force f at the patch is f at the centre and the moment d x f, d from centre to patch.
Motions at_patch_of(const std::array<Motions, causes>& solved, const Vector3d& d, int axis) {
    const Vector3d moment = d.cross(Vector3d::Unit(axis));
    Motions sum = solved[static_cast<std::size_t>(at_centre + axis)];
    for (int k = 0; k < 3; ++k) {
        const Motions& turn = solved[static_cast<std::size_t>(moment_on + k)];
        for (std::size_t b = 0; b < sum.size(); ++b) {
            sum[b].dr += moment[k] * turn[b].dr;
            sum[b].dpi += moment[k] * turn[b].dpi;
        }
    }
    return sum;
}

std::vector<std::array<Motions, causes>> by_wheel(const std::vector<Motions>& all,
                                                  const Model& model, const Equilibrium& state,
                                                  bool with_patches) {
    const std::size_t each = with_patches ? causes : at_patch;
    std::vector<std::array<Motions, causes>> list(model.wheels.size());
    for (std::size_t w = 0; w < list.size(); ++w) {
        const Wheel& wheel = model.wheels[w];
        for (std::size_t k = 0; k < each; ++k) list[w][k] = all[each * w + k];
        const Vector3d d = position(state.poses, wheel.body, wheel.contact_local) -
                           position(state.poses, wheel.body, wheel.centre_local);
        for (int axis = 0; !with_patches && axis < 3; ++axis)
            list[w][static_cast<std::size_t>(at_patch + axis)] = at_patch_of(list[w], d, axis);
    }
    return list;
}

// Whether 1 N or 1 N·m moves a wheel by a million kilometres: the stiffness there is rounding.
bool is_unresisted(const std::vector<std::array<Motions, causes>>& free) {
    constexpr double nowhere = 1e9;
    for (const auto& wheel : free)
        for (const Motions& motions : wheel)
            for (const Increment& body : motions)
                if (body.dr.norm() > nowhere || body.dpi.norm() > nowhere) return true;
    return false;
}

std::string failure_text(const Response& response) {
    return std::string(name(response.outcome)) +
           (response.detail.empty() ? "" : ": " + response.detail);
}

}  // namespace

int steering_joint(const Model& model) {
    for (const auto& branch : model.branches)
        for (const auto& driver : branch.drivers)
            if (const int joint = driven_joint(driver.what);
                joint >= 0 && driver.rate != 0 && !is_jack(model, static_cast<std::size_t>(joint)))
                return joint;
    return -1;
}

Response linear_response(const SolverSettings& solver, const Model& model, const Branch& branch,
                         const Equilibrium& state, std::span<const Disturbance> disturbances,
                         std::optional<recursive::ResponseAnalysis>& analysis) {
    const auto recursion = [&](const recursive::Method& method) {
        if (!analysis) analysis.emplace(recursive::analyse(model));
        return recursive::linear_response(model, branch, state, disturbances, method, *analysis);
    };
    switch (solver.leg) {
        case Leg::recursive: return recursion(solver.recursion.method);
        case Leg::series: return recursion(recursive::find_method("series").value());
        case Leg::equilibrium:
            return reference::equilibrium::linear_response(model, branch, state, disturbances);
        case Leg::energy:
            return reference::energy::linear_response(model, branch, state, disturbances);
    }
    return {};
}

WheelResponse wheel_response(const BranchSide& side, const SolverSettings& solver, int steering,
                             const Equilibrium& state, Analyses& analyses) {
    WheelResponse response;
    const std::size_t wheels = side.model.wheels.size();
    const ResponseCase freed_case = freed(side, state);
    // The references refine their answers, so that those at the patch may be summed. The recursion
    // does not: its sums would differ from its own answers by 1e-10.
    const bool with_patches = solver.leg == Leg::recursive || solver.leg == Leg::series;
    const auto wrenches = causes_at(side.model, with_patches);
    if (const Response free = linear_response(solver, freed_case.model, freed_case.branch,
                                              freed_case.state, wrenches, analyses.free);
        free.outcome == Outcome::converged)
        response.free = by_wheel(free.increments, side.model, state, with_patches);
    else {
        response.why_not_free = failure_text(free);
        response.nothing_resists =
            free.outcome == Outcome::loaded_idle_mode || free.outcome == Outcome::singular;
    }
    if (is_unresisted(response.free))
        response.free.clear(), response.why_not_free = "only rounding resists a motion",
                               response.nothing_resists = true;

    const std::size_t first = freed_case.model.joints.size();
    const bool steers =
        steering >= 0 && freed_case.model.joints[static_cast<std::size_t>(steering)].driven >= 0;
    const auto on_jacks = [&](std::size_t count,
                              std::optional<recursive::ResponseAnalysis>& analysis) {
        const ResponseCase up = jacked_up(freed_case, count);
        std::vector<Disturbance> changes = wrenches;
        for (std::size_t w = 0; w < count; ++w)
            changes.push_back(Motion{static_cast<int>(first + w)});
        if (steers) changes.push_back(Motion{steering});
        return linear_response(solver, up.model, up.branch, up.state, changes, analysis);
    };
    Response jacked = on_jacks(wheels, analyses.jacked);
    if (jacked.outcome == Outcome::inconsistent_constraints && wheels > 1)
        if (Response one = on_jacks(1, analyses.tied); one.outcome == Outcome::converged) {
            jacked = std::move(one);
            response.tied = true;
        }
    if (jacked.outcome != Outcome::converged) {
        response.why_not = failure_text(jacked);
        response.blocked = jacked.outcome == Outcome::inconsistent_constraints;
        return response;
    }
    if (steers) {
        response.steering = std::move(jacked.increments.back());
        jacked.increments.pop_back();
    }
    response.held = by_wheel(jacked.increments, side.model, state, with_patches);
    response.travel.assign(
        jacked.increments.end() - static_cast<std::ptrdiff_t>(response.tied ? 1 : wheels),
        jacked.increments.end());
    response.travel.resize(wheels, Motions(side.model.bodies.size()));
    return response;
}

namespace {

ResponseRates response_rates(Leg leg, const ResponseCase& of,
                             std::span<const Disturbance> disturbances,
                             std::span<const Model> rates,
                             std::optional<recursive::ResponseAnalysis>& analysis) {
    switch (leg) {
        case Leg::recursive:
        case Leg::series:
            if (!analysis) analysis.emplace(recursive::analyse(of.model));
            return recursive::response_rates(of.model, of.branch, of.state, disturbances, rates,
                                             *analysis);
        case Leg::equilibrium:
            return reference::equilibrium::response_rates(of.model, of.branch, of.state,
                                                          disturbances, rates);
        case Leg::energy:
            return reference::energy::response_rates(of.model, of.branch, of.state, disturbances,
                                                     rates);
    }
    return {};
}

void add(Motions& sum, double weight, const Motions& motions) {
    for (std::size_t b = 0; b < sum.size(); ++b) {
        sum[b].dr += weight * motions[b].dr;
        sum[b].dpi += weight * motions[b].dpi;
    }
}

// Of by_wheel() without patches: a force is at its centre, which moves in its body, or at the patch.
std::vector<std::array<Motions, causes>> by_wheel_rate(
    const std::vector<Motions>& solved, const std::vector<std::array<Motions, causes>>& at,
    const Model& model, const Equilibrium& state, const Model& rate, const StateRate& by) {
    std::vector<std::array<Motions, causes>> list(model.wheels.size());
    for (std::size_t w = 0; w < list.size(); ++w) {
        const Wheel &wheel = model.wheels[w], &d = rate.wheels[w];
        const Point centre{wheel.body, wheel.centre_local}, patch{wheel.body, wheel.contact_local};
        const Vector3d within = pose(state.poses, wheel.body).p * d.centre_local,
                       arm = position(state.poses, patch) - position(state.poses, centre),
                       darm = position_rate(state, by, patch, d.contact_local) -
                              position_rate(state, by, centre, d.centre_local);
        for (std::size_t k = 0; k < at_patch; ++k) list[w][k] = solved[at_patch * w + k];
        for (int axis = 0; axis < 3; ++axis) {
            Motions& force = list[w][static_cast<std::size_t>(at_centre + axis)];
            const Vector3d moment = within.cross(Vector3d::Unit(axis));
            for (int k = 0; k < 3; ++k)
                add(force, moment[k], at[w][static_cast<std::size_t>(moment_on + k)]);
        }
        for (int axis = 0; axis < 3; ++axis) {
            Motions& force = list[w][static_cast<std::size_t>(at_patch + axis)];
            force = list[w][static_cast<std::size_t>(at_centre + axis)];
            const Vector3d moment = arm.cross(Vector3d::Unit(axis)),
                           dmoment = darm.cross(Vector3d::Unit(axis));
            for (int k = 0; k < 3; ++k) {
                const auto turn = static_cast<std::size_t>(moment_on + k);
                add(force, moment[k], list[w][turn]);
                add(force, dmoment[k], at[w][turn]);
            }
        }
    }
    return list;
}

std::string failure_text(const ResponseRate& rate) {
    return std::string(name(rate.outcome)) + (rate.detail.empty() ? "" : ": " + rate.detail);
}

}  // namespace

WheelResponseRates wheel_response_rates(const BranchSide& side, Leg leg, int steering,
                                        const Equilibrium& state, std::span<const Model> rates,
                                        std::span<const StateRate> state_rates, bool with_free,
                                        Analyses& analyses) {
    const Model& model = side.model;
    WheelResponseRates all;
    all.by.resize(rates.size());
    const std::size_t wheels = model.wheels.size();
    const ResponseCase free = freed(side, state);
    std::vector<Model> free_rates;
    for (std::size_t k = 0; k < rates.size(); ++k)
        free_rates.push_back(freed_rate(side, state, rates[k], state_rates[k]));
    const auto wrenches = causes_at(model, false);
    if (with_free) {
        const ResponseRates found = response_rates(leg, free, wrenches, free_rates, analyses.free);
        const bool there = found.at.outcome == Outcome::converged;
        if (there)
            all.at.free = by_wheel(found.at.increments, model, state, false);
        else {
            all.at.why_not_free = failure_text(found.at);
            all.at.nothing_resists = found.at.outcome == Outcome::loaded_idle_mode ||
                                     found.at.outcome == Outcome::singular;
        }
        for (std::size_t k = 0; k < rates.size(); ++k)
            if (!there)
                all.by[k].why_not_free = all.at.why_not_free;
            else if (found.by[k].outcome != Outcome::converged)
                all.by[k].why_not_free = failure_text(found.by[k]);
            else
                all.by[k].free = by_wheel_rate(found.by[k].increments, all.at.free, model, state,
                                               rates[k], state_rates[k]);
    }

    const std::size_t first = free.model.joints.size();
    const bool steers =
        steering >= 0 && free.model.joints[static_cast<std::size_t>(steering)].driven >= 0;
    const auto on_jacks = [&](std::size_t count,
                              std::optional<recursive::ResponseAnalysis>& analysis) {
        const ResponseCase up = jacked_up(free, count);
        std::vector<Model> up_rates;
        for (std::size_t k = 0; k < rates.size(); ++k)
            up_rates.push_back(jacked_up_rate(free_rates[k], model, count, state, state_rates[k]));
        std::vector<Disturbance> changes = wrenches;
        for (std::size_t w = 0; w < count; ++w)
            changes.push_back(Motion{static_cast<int>(first + w)});
        if (steers) changes.push_back(Motion{steering});
        return response_rates(leg, up, changes, up_rates, analysis);
    };
    ResponseRates jacked = on_jacks(wheels, analyses.jacked);
    if (jacked.at.outcome == Outcome::inconsistent_constraints && wheels > 1)
        if (ResponseRates one = on_jacks(1, analyses.tied); one.at.outcome == Outcome::converged) {
            jacked = std::move(one);
            all.at.tied = true;
        }
    if (jacked.at.outcome != Outcome::converged) {
        all.at.why_not = failure_text(jacked.at);
        for (auto& by : all.by) by.why_not = all.at.why_not;
        return all;
    }
    // The steering joint, then the jacks, from the end of the answers.
    const auto take = [&](std::vector<Motions>& increments, auto& to) {
        if (steers) {
            to.steering = std::move(increments.back());
            increments.pop_back();
        }
        to.travel.assign(increments.end() - static_cast<std::ptrdiff_t>(all.at.tied ? 1 : wheels),
                         increments.end());
        to.travel.resize(wheels, Motions(model.bodies.size()));
    };
    take(jacked.at.increments, all.at);
    all.at.held = by_wheel(jacked.at.increments, model, state, false);
    for (std::size_t k = 0; k < rates.size(); ++k) {
        WheelResponseRate& by = all.by[k];
        if (jacked.by[k].outcome != Outcome::converged) {
            by.why_not = failure_text(jacked.by[k]);
            continue;
        }
        take(jacked.by[k].increments, by);
        by.held = by_wheel_rate(jacked.by[k].increments, all.at.held, model, state, rates[k],
                                state_rates[k]);
    }
    return all;
}

Vector3d turned(const Motions& motions, BodyId body) {
    return body == ground ? Vector3d::Zero() : motions[static_cast<std::size_t>(body)].dpi;
}

Vector3d moved(const Equilibrium& state, const Motions& motions, const Point& point) {
    if (point.body == ground) return Vector3d::Zero();
    const auto b = static_cast<std::size_t>(point.body);
    return motions[b].dr + motions[b].dpi.cross(state.poses[b].p * point.s_local);
}

}  // namespace elastocheck::compare
