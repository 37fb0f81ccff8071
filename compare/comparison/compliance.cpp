#include "compare/comparison/compliance.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <variant>

#include "compare/outputs/catalogue/subject.hpp"
#include "compare/outputs/deformation.hpp"
#include "compare/outputs/positions.hpp"
#include "models/branch.hpp"
#include "models/eigen/dense.hpp"
#include "models/kinds.hpp"
#include "recursive/linear_response.hpp"
#include "reference/energy/linear_response.hpp"
#include "reference/equilibrium/linear_response.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

struct ResponseCase {
    Model model;
    Branch branch;
    Equilibrium state;
};

// The free model of compliance.hpp: jacks and tyres are removed, and their forces at this state act as static
// loads.
ResponseCase free_case(const BranchSide& side, const Equilibrium& state) {
    ResponseCase free{side.model, side.branch, state};
    const auto add_force = [&](const Point& at, double force) {
        free.model.static_loads.push_back({"held", DeadForce{at, force * Vector3d::UnitZ()}});
    };
    std::erase_if(free.branch.drivers, [&](const Driver& driver) {
        const int joint = driven_joint(driver.what);
        return joint >= 0 && is_jack(side.model, static_cast<std::size_t>(joint));
    });
    for (std::size_t k = 0; k < side.model.joints.size(); ++k)
        if (is_jack(side.model, k)) {
            add_force(side.model.joints[k].at, state.reactions[k].force.z());
            free.state.reactions[k] = {};
        }
    for (std::size_t k = 0; k < side.model.elastics.size(); ++k)
        if (const Elastic& tyre = side.model.elastics[k]; tyre.written_as == WrittenAs::tyre) {
            const Marker& at = std::get<Bushing>(tyre.kind).j;
            const Vector6 e = deformation(tyre.kind, k, side.branch, state);
            add_force({at.body, at.s_local},
                      -force_with_preload(tyre.kind, k, side.branch, state, e).z());
            std::erase_if(free.branch.drivers, [&](const Driver& driver) {
                return driven_element(driver.what) == static_cast<int>(k);
            });
        }
    free.model = on_branch(free.model, free.branch);
    return free;
}

// Adds jacks under the first wheels, each at the height of its wheel's centre.
ResponseCase jacked_case(ResponseCase response_case, std::size_t wheels) {
    for (const Wheel& wheel : std::span(response_case.model.wheels).first(wheels)) {
        const Point centre{wheel.body, wheel.centre_local};
        const Vector3d at_state = position(response_case.state.poses, centre);
        const int joint = static_cast<int>(response_case.model.joints.size());
        response_case.model.joints.push_back(
            {.name = wheel.name + " jack",
             .i = wheel.body,
             .j = ground,
             .at = centre,
             .driven = static_cast<int>(response_case.model.constraints.size())});
        response_case.model.constraints.push_back(
            {joint, PointInPlane{centre, {ground, at_state}, {ground, Vector3d::UnitZ()}, 0}});
        response_case.state.reactions.emplace_back();
    }
    return response_case;
}

// Unit disturbances, per wheel: forces [1 N] along x, y, z and moments [1 N·m] about them at the
// centre, then forces at the patch. The longitudinal force at the patch of a wheel that rolls
// is that of a brake: its moment acts on the carrier.
std::vector<Disturbance> unit_disturbances(const Model& model, const Equilibrium& state,
                                           bool with_patches) {
    std::vector<Disturbance> disturbances;
    for (const Wheel& wheel : model.wheels) {
        const Point centre{wheel.body, wheel.centre_local};
        const Vector3d d = position(state.poses, wheel.contact) - position(state.poses, centre);
        for (int k = 0; k < 3; ++k)
            disturbances.push_back(UnitWrench{centre, Vector3d::Unit(k), Vector3d::Zero()});
        for (int k = 0; k < 3; ++k)
            disturbances.push_back(UnitWrench{centre, Vector3d::Zero(), Vector3d::Unit(k)});
        for (int k = 0; with_patches && k < 3; ++k)
            disturbances.push_back(
                k == 0 && wheel.rolls()
                    ? UnitWrench{centre, Vector3d::Unit(k), d.cross(Vector3d::Unit(k))}
                    : UnitWrench{wheel.contact, Vector3d::Unit(k), Vector3d::Zero()});
    }
    return disturbances;
}

// A force f at the patch is f at the centre and the moment d x f, d from centre to patch.
Motions motions_under_patch_force(const std::array<Motions, wrench_count>& solved,
                                  const Vector3d& d, int axis) {
    const Vector3d moment = d.cross(Vector3d::Unit(axis));
    Motions sum = solved[static_cast<std::size_t>(first_centre_force + axis)];
    for (int k = 0; k < 3; ++k) {
        const Motions& by_moment = solved[static_cast<std::size_t>(first_moment + k)];
        for (std::size_t b = 0; b < sum.size(); ++b) {
            sum[b].dr += moment[k] * by_moment[b].dr;
            sum[b].dpi += moment[k] * by_moment[b].dpi;
        }
    }
    return sum;
}

// The motions of all bodies, sorted by wheel and cause (order of unit_disturbances()). Where they were
// solved without forces at the patches, those motions are the sums of motions_under_patch_force().
std::vector<std::array<Motions, wrench_count>> by_wheel(const std::vector<Motions>& solved,
                                                        const Model& model,
                                                        const Equilibrium& state,
                                                        bool with_patches) {
    const std::size_t per_wheel = with_patches ? wrench_count : first_patch_force;
    std::vector<std::array<Motions, wrench_count>> list(model.wheels.size());
    for (std::size_t w = 0; w < list.size(); ++w) {
        const Wheel& wheel = model.wheels[w];
        for (std::size_t k = 0; k < per_wheel; ++k) list[w][k] = solved[per_wheel * w + k];
        const Vector3d d = position(state.poses, wheel.contact) -
                           position(state.poses, wheel.body, wheel.centre_local);
        for (int axis = 0; !with_patches && axis < 3; ++axis)
            list[w][static_cast<std::size_t>(first_patch_force + axis)] =
                motions_under_patch_force(list[w], d, axis);
    }
    return list;
}

// Whether 1 N or 1 N·m moves a body by a million kilometres or 10⁹ rad: its stiffness is rounding.
bool is_unresisted(const std::vector<std::array<Motions, wrench_count>>& free) {
    constexpr double unresisted = 1e9;  // [m, rad]
    for (const auto& wheel : free)
        for (const Motions& motions : wheel)
            for (const Increment& body : motions)
                if (body.dr.norm() > unresisted || body.dpi.norm() > unresisted) return true;
    return false;
}

// The responses of the jacked model from those of the free one. Under a disturbance the wheel
// centres of the free model rise by z; forces F of the jacks, with C the rise per unit force, hold
// them at the given travel t: z + C F = t. `free`: responses to the wrenches, `per_wheel` of them a
// wheel, and perhaps to the steering; the result has those to a unit travel of each wheel between
// these. Empty where C is nearly singular.
std::optional<std::vector<Motions>> held_by_jacks(const std::vector<Motions>& free,
                                                  const Model& model, const Equilibrium& state,
                                                  std::size_t per_wheel) {
    constexpr double well_posed = 1e-4;
    const std::size_t wheels = model.wheels.size();
    if (wheels == 0) return {};
    Eigen::MatrixXd z(wheels, free.size()), C(wheels, wheels);
    for (std::size_t w = 0; w < wheels; ++w) {
        const PlacedPoint centre = Subject{model, &state, w}.centre();
        for (std::size_t k = 0; k < free.size(); ++k)
            z(static_cast<Eigen::Index>(w), static_cast<Eigen::Index>(k)) =
                Subject::displacement(free[k], centre).z();
    }
    const auto lifted_at = [&](std::size_t w) { return per_wheel * w + first_centre_force + 2; };
    for (std::size_t w = 0; w < wheels; ++w)
        C.col(static_cast<Eigen::Index>(w)) = z.col(static_cast<Eigen::Index>(lifted_at(w)));
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(C);
    if (!(rcond_of(lu) > well_posed)) return {};
    const auto pushed = [&](Motions motions, const Eigen::VectorXd& F) {
        for (std::size_t w = 0; w < wheels; ++w)
            for (std::size_t b = 0; b < motions.size(); ++b) {
                motions[b].dr += F[static_cast<Eigen::Index>(w)] * free[lifted_at(w)][b].dr;
                motions[b].dpi += F[static_cast<Eigen::Index>(w)] * free[lifted_at(w)][b].dpi;
            }
        return motions;
    };
    std::vector<Motions> held;
    for (std::size_t k = 0; k < free.size(); ++k)
        held.push_back(
            pushed(free[k], lu.solve(Eigen::VectorXd(-z.col(static_cast<Eigen::Index>(k))))));
    const Eigen::MatrixXd lifts = inverse_of(lu);
    for (std::size_t w = 0; w < wheels; ++w)
        held.insert(held.begin() + static_cast<std::ptrdiff_t>(per_wheel * wheels + w),
                    pushed(Motions(model.bodies.size()), lifts.col(static_cast<Eigen::Index>(w))));
    return held;
}

std::string failure_text(const Response& response) {
    return std::string(name(response.outcome)) +
           (response.detail.empty() ? "" : ": " + response.detail);
}

// Begins with the elimination orders of a similar model, where its matrices have the same pattern.
recursive::ResponseAnalysis analysis_like(const std::optional<recursive::ResponseAnalysis>& before,
                                          const Model& model) {
    const recursive::EliminationOrder order = before ? before->analysis.system.lu.order : nullptr;
    recursive::ResponseAnalysis made{recursive::analyse(model, order)};
    if (before && order->pattern == made.analysis.system.lu.order->pattern)
        made.orders = before->orders;
    return made;
}

}  // namespace

Analyses with_orders_of(const Analyses& other) {
    Analyses made;
    made.one_factorisation = other.one_factorisation;
    for (const auto cache : {&Analyses::free, &Analyses::jacked, &Analyses::tied}) {
        const auto& [last, before_it, equilibrium] = other.*cache;
        (made.*cache).before = last ? last : before_it;
    }
    return made;
}

Response linear_response(const SolverSettings& solver, const Model& model, const Branch& branch,
                         const Equilibrium& state, std::span<const Disturbance> disturbances,
                         ResponseCache& cache) {
    const auto recursion = [&](const recursive::Method& method) {
        if (!cache.recursion) cache.recursion = analysis_like(cache.before, model);
        return recursive::linear_response(model, branch, state, disturbances, method,
                                          *cache.recursion);
    };
    switch (solver.leg) {
        case Leg::recursive: return recursion(solver.recursion.method);
        case Leg::series: return recursion(recursive::find_method("series").value());
        case Leg::equilibrium:
            return reference::equilibrium::linear_response(model, branch, state, disturbances,
                                                           &cache.equilibrium);
        case Leg::energy:
            return reference::energy::linear_response(model, branch, state, disturbances);
    }
    return {};
}

WheelResponse wheel_response(const BranchSide& side, const SolverSettings& solver, int steering,
                             const Equilibrium& state, Analyses& analyses, bool with_free) {
    WheelResponse response;
    const std::size_t wheels = side.model.wheels.size();
    const ResponseCase response_case = free_case(side, state);
    // The references refine their solutions, so that the response to a force at the patch of a
    // wheel that does not roll may be a sum. The recursion does not: such sums differ from its
    // solutions by 1e-10.
    const bool refines =
        analyses.one_factorisation || solver.leg == Leg::equilibrium || solver.leg == Leg::energy;
    const bool with_patches = !refines || std::ranges::any_of(side.model.wheels, &Wheel::rolls);
    const auto wrenches = unit_disturbances(side.model, state, with_patches);
    const std::size_t first = response_case.model.joints.size();
    const bool steers =
        steering >= 0 && response_case.model.joints[static_cast<std::size_t>(steering)].driven >= 0;
    std::optional<std::vector<Motions>> held;  // by the same factorisation
    if (with_free) {
        const auto response_to = [&](std::span<const Disturbance> list) {
            return linear_response(solver, response_case.model, response_case.branch,
                                   response_case.state, list, analyses.free);
        };
        std::vector<Disturbance> with_steering = wrenches;
        if (steers && refines) with_steering.push_back(Motion{steering});
        Response free = response_to(with_steering);
        if (free.outcome == Outcome::converged && refines)
            held = held_by_jacks(free.increments, side.model, state,
                                 with_patches ? wrench_count : first_patch_force);
        else if (with_steering.size() > wrenches.size())
            free = response_to(wrenches);
        if (free.outcome == Outcome::converged) {
            response.free = by_wheel(free.increments, side.model, state, with_patches);
        } else {
            response.why_not_free = failure_text(free);
            response.nothing_resists =
                free.outcome == Outcome::loaded_idle_mode || free.outcome == Outcome::singular;
        }
    }
    if (is_unresisted(response.free)) {
        response.free.clear();
        response.why_not_free = "only rounding resists a motion";
        response.nothing_resists = true;
        held.reset();
    }

    const auto jacked_response = [&](std::size_t count, ResponseCache& cache) {
        const ResponseCase up = jacked_case(response_case, count);
        std::vector<Disturbance> changes = wrenches;
        for (std::size_t w = 0; w < count; ++w)
            changes.push_back(Motion{static_cast<int>(first + w)});
        if (steers) changes.push_back(Motion{steering});
        return linear_response(solver, up.model, up.branch, up.state, changes, cache);
    };
    Response jacked = held ? Response{Outcome::converged, "", std::move(*held)}
                           : jacked_response(wheels, analyses.jacked);
    if (jacked.outcome == Outcome::inconsistent_constraints && wheels > 1)
        if (Response one = jacked_response(1, analyses.tied); one.outcome == Outcome::converged) {
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
    response.jacked = by_wheel(jacked.increments, side.model, state, with_patches);
    response.travel.assign(
        jacked.increments.end() - static_cast<std::ptrdiff_t>(response.tied ? 1 : wheels),
        jacked.increments.end());
    response.travel.resize(wheels, Motions(side.model.bodies.size()));
    return response;
}

Eigen::MatrixXd compliance(const Model& model, WheelPoint point, const Equilibrium& state,
                           const WheelResponse& response) {
    const auto n = static_cast<Eigen::Index>(response.free.size());
    const int force = point == WheelPoint::centre ? first_centre_force : first_patch_force;
    Eigen::MatrixXd C(6 * n, 6 * n);
    for (Eigen::Index j = 0; j < n; ++j)
        for (int k = 0; k < 6; ++k) {
            const auto& motions = response.free[static_cast<std::size_t>(j)]
                                               [static_cast<std::size_t>(k < 3 ? force + k : k)];
            for (Eigen::Index i = 0; i < n; ++i) {
                const Subject wheel{model, &state, static_cast<std::size_t>(i)};
                const bool centre = point == WheelPoint::centre;
                C.block<6, 1>(6 * i, 6 * j + k)
                    << wheel.displacement(motions, centre ? wheel.centre() : wheel.patch()),
                    wheel.rotation(motions);
                // longitudinal: of the point held by the brake, where that force acts
                if (!centre)
                    C(6 * i, 6 * j + k) = wheel.displacement(motions, wheel.braked_patch()).x();
            }
        }
    return C;
}

double reciprocity(const Model& model, const Eigen::MatrixXd& C) {
    if (C.size() == 0) return nan;
    Eigen::VectorXd size = Eigen::VectorXd::Ones(C.rows());
    for (std::size_t w = 0; w < model.wheels.size(); ++w) {
        const double radius = drawn_arm(model, model.wheels[w]).norm();
        if (radius > 0) size.segment<3>(static_cast<Eigen::Index>(6 * w + 3)).setConstant(radius);
    }
    const Eigen::MatrixXd scaled = size.asDiagonal() * C * size.asDiagonal();
    return (scaled - scaled.transpose()).cwiseAbs().maxCoeff() / scaled.cwiseAbs().maxCoeff();
}

double in_table_units(const Eigen::MatrixXd& C, Eigen::Index row, Eigen::Index column) {
    return C(row, column) * in_unit(row % 6 < 3 ? Unit::mm : Unit::deg) *
           (column % 6 < 3 ? 1e3 : 100);
}

std::string compliance_row_name(const Model& model, const std::string& point, Eigen::Index row) {
    const std::string& wheel = model.wheels[static_cast<std::size_t>(row / 6)].name;
    return fmt::format("{}, {}{} {}", point, wheel.empty() ? "" : wheel + " ",
                       row % 6 < 3 ? "displacement" : "rotation", "xyz"[row % 3]);
}

}  // namespace elastocheck::compare
