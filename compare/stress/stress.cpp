#include "compare/stress/stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/deviation/agreement.hpp"
#include "compare/deviation/reactions.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
#include "elastocheck/compile.hpp"
#include "models/overloaded.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

using Construction = Variant::Construction;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double eps = std::numeric_limits<double>::epsilon();

// ---- Observed places of a state.

struct ComparedPoint {
    std::string name;
    Point at;
};

struct Placement {
    std::vector<Vector3d> p;         // per place
    std::vector<Quaterniond> turns;  // rotation of its body since the design position
};

std::vector<ComparedPoint> places_of(const Model& model, const recursive::Diagnosis& diagnosis) {
    std::vector<bool> idle(model.bodies.size());
    for (const auto& mode : diagnosis.idle)
        for (Eigen::SparseVector<double>::InnerIterator entry(mode.dq); entry; ++entry)
            if (std::abs(entry.value()) > 1e-6)
                idle[static_cast<std::size_t>(entry.index() / 6)] = true;
    std::vector<ComparedPoint> places;
    const auto add = [&](const std::string& name, const Point& at) {
        if (at.body != ground && !idle[static_cast<std::size_t>(at.body)])
            places.push_back({name, at});
    };
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
        add("body " + model.bodies[b].name, {static_cast<BodyId>(b), Vector3d::Zero()});
    for (const auto& probe : model.probes) add("probe " + probe.name, probe.at);
    for (const auto& wheel : model.wheels)
        add("wheel " + wheel.name, {wheel.body, wheel.centre_local});
    return places;
}

Placement placement(const Model& model, const std::vector<ComparedPoint>& places,
                    const Equilibrium& state) {
    Placement where;
    for (const auto& place : places) {
        const auto& drawn = model.bodies[static_cast<std::size_t>(place.at.body)].design;
        where.p.push_back(position(state.poses, place.at));
        where.turns.push_back(pose(state.poses, place.at.body).p * drawn.p.conjugate());
    }
    return where;
}

// Joints whose reaction is determined: no redundant joint shares the load, and no body of the joint
// has an idle mode.
std::vector<std::size_t> joints_of(const Model& model, const recursive::Diagnosis& diagnosis,
                                   const std::vector<ComparedPoint>& places) {
    std::vector<bool> active(model.joints.size()), known(model.bodies.size());
    for (const auto& constraint : model.constraints)
        active[static_cast<std::size_t>(constraint.joint)] = true;
    for (const auto& place : places) known[static_cast<std::size_t>(place.at.body)] = true;
    const auto is_known = [&](BodyId b) {
        return b == ground || known[static_cast<std::size_t>(b)];
    };
    std::vector<std::size_t> joints;
    for (std::size_t j = 0; j < model.joints.size(); ++j)
        if (active[j] && diagnosis.determined[j] && is_known(model.joints[j].i) &&
            is_known(model.joints[j].j))
            joints.push_back(j);
    return joints;
}

std::vector<Wrench> reactions_of(const std::vector<std::size_t>& joints, const Equilibrium& state) {
    std::vector<Wrench> reactions;
    for (const std::size_t j : joints) reactions.push_back(state.reactions[j]);
    return reactions;
}

bool is_finite(const Placement& where) {
    return std::ranges::all_of(where.p, [](const auto& p) { return p.allFinite(); }) &&
           std::ranges::all_of(where.turns, [](const auto& q) { return q.coeffs().allFinite(); });
}

// Of origins and of orientations.
struct Distance {
    double length = inf, angle = inf;  // [m], [rad]
};

// Bound of a place from the bounds of its body's origin and orientation.
double of_place(const Distance& body, const ComparedPoint& place) {
    const double lever = place.at.s_local.norm();
    return lever > 0 ? body.length + lever * body.angle : body.length;
}

// Largest distance over all places; NaN if any number is NaN.
Distance apart(const Placement& a, const Placement& b) {
    Distance most{0, 0};
    for (std::size_t k = 0; k < a.p.size(); ++k) {
        const double length = (a.p[k] - b.p[k]).norm(),
                     angle = a.turns[k].angularDistance(b.turns[k]);
        if (!(length <= most.length)) most.length = length;
        if (!(angle <= most.angle)) most.angle = angle;
    }
    return is_finite(a) && is_finite(b) ? most : Distance{nan, nan};
}

Placement transforms(const Placement& where, const Transform& how) {
    Placement moved;
    for (const auto& p : where.p) moved.p.emplace_back(how.length * (how.M * p) + how.t);
    for (const auto& turn : where.turns)
        moved.turns.emplace_back(
            Eigen::Matrix3d(how.M * turn.toRotationMatrix() * how.M.transpose()));
    return moved;
}

// ---- Results of all solvers on one branch side.

struct Found {
    Outcome outcome = Outcome::converged;
    std::string detail;
    bool threw = false;  // an exception, which is a bug; its text is in `detail`
    std::vector<Placement> placements;
    std::vector<std::vector<Wrench>> reactions;  // per point, of SideRun::joints
    std::vector<bool> elsewhere;                 // per point: off, but proved
};

// Accuracy of a state: of every body, or of every place.
struct Claim {
    Distance bound = {};
    bool of_bodies = true;

    double length(const ComparedPoint& place) const {
        return of_bodies ? of_place(bound, place) : bound.length;
    }
    // Largest over all places.
    Distance most(const std::vector<ComparedPoint>& places) const {
        Distance worst{0, bound.angle};
        for (const auto& place : places) worst.length = std::max(worst.length, length(place));
        return worst;
    }
};

// True state of one point: x_T and e.
struct Known {
    Knowledge how = Knowledge::none;
    Placement where = {};
    Claim within = {.of_bodies = false};
    bool stable = false;                 // proved to be stable; only for a proved state
    bool idle = false;                   // whether the proof held an idle motion
    std::vector<Wrench> reactions = {};  // of SideRun::joints; empty where they are unknown
    double force = 0, moment = 0;        // error bounds of `reactions` [N], [N·m]
};

struct SideRun {
    std::string name;
    std::size_t points = 0;  // requested number
    std::vector<ComparedPoint> places;
    // joints whose reactions are compared: determined, and between bodies that have a place
    std::vector<std::size_t> joints;
    std::vector<std::string> joint_names;
    bool anything_idle = false;  // idle bodies have no place
    Scale scale = {};            // of the acting forces
    double size = 1, reach = 1;  // L; the largest coordinate [m]
    std::vector<Found> found;    // per solver
    std::vector<Known> known;    // per point
};

struct TrialRun {
    std::vector<SideRun> sides;
    double seconds = 0;  // processor time
};

// Exact except for rounding.
Distance exact(double size) { return {1e-9 * size, 1.7453292520e-8}; }

bool is_reference(const Solver& solver) {
    return solver.settings.leg == Leg::equilibrium || solver.settings.leg == Leg::energy;
}

Claim claim_of(const Solver& solver, double size) {
    const Distance rounding = exact(size);
    if (is_reference(solver)) return {rounding, false};
    return std::visit(overloaded{[&](const recursive::Adaptive& method) -> Claim {
                                     return {{std::max(method.length_tolerance, rounding.length),
                                              std::max(method.angle_tolerance, rounding.angle)}};
                                 },
                                 [&](const recursive::Series& method) -> Claim {
                                     return {{std::max(method.tolerance, rounding.length),
                                              std::max(method.tolerance / size, rounding.angle)},
                                             false};
                                 },
                                 [](const auto&) -> Claim { return {}; }},
                      solver.settings.recursion.method.kind);
}

std::size_t index_of(const std::vector<Solver>& solvers, std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(solvers, name, &Solver::name) -
                                    solvers.begin());
}

// Agreement of two solvers without a common equation within their claims. The series is used last:
// it is not independent in the definition of a bushing's deformation.
Known agreed(const std::vector<Solver>& solvers, const SideRun& run, std::size_t point) {
    std::vector<std::size_t> witnesses;
    for (const char* name : {"equilibrium", "energy", "series"})
        witnesses.push_back(index_of(solvers, name));
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
        const auto i = witnesses[static_cast<std::size_t>(a)],
                   j = witnesses[static_cast<std::size_t>(b)];
        const Found &one = run.found[i], &other = run.found[j];
        if (point >= one.placements.size() || point >= other.placements.size()) continue;
        const Distance distance = apart(one.placements[point], other.placements[point]);
        const Distance c_i = claim_of(solvers[i], run.size).most(run.places),
                       c_j = claim_of(solvers[j], run.size).most(run.places);
        if (!(distance.length <= c_i.length + c_j.length &&
              distance.angle <= c_i.angle + c_j.angle))
            continue;
        const Found& tighter = c_i.length <= c_j.length ? one : other;
        Known known{Knowledge::references,
                    tighter.placements[point],
                    {{distance.length + eps * run.reach, distance.angle + eps}, false}};
        known.reactions = tighter.reactions[point];
        return known;
    }
    return {};
}

// Tolerance of a proof: a small share of the scene and of the acting forces, in any units.
reference::certificate::Tolerance tolerance_of(const SideRun& run, double force) {
    const double length = std::max(1e-9 * run.size, 1e3 * eps * run.reach),
                 share = 1e-6 * std::max(force, 1e-9);
    return {.length = length,
            .angle = 1.7453292520e-8,
            .force = share,
            .moment = share * run.size,
            .held = share,
            .gap = length};
}

// Proof from the first of the accurate states for which it succeeds.
Known proved(const BranchSide& side, const SideRun& run,
             const std::vector<std::vector<Equilibrium>>& states, std::size_t point,
             const reference::certificate::Tolerance& tolerance) {
    for (const auto& path : states) {
        if (point >= path.size()) continue;
        const auto certificate =
            reference::certificate::certify(side.model, side.branch, path[point], tolerance);
        // A weakly resisted motion that is held for the proof stays at its value in the state, not
        // at equilibrium.
        const bool weakly_resisted = certificate.held > 0 && !run.anything_idle;
        if (certificate.answer == reference::certificate::Answer::proved && !weakly_resisted)
            return {Knowledge::proved,
                    placement(side.model, run.places, path[point]),
                    {{certificate.error.length, certificate.error.angle}, true},
                    certificate.stable,
                    certificate.held > 0,
                    reactions_of(run.joints, path[point]),
                    certificate.error.force,
                    certificate.error.moment};
    }
    return {};
}

// Lower bound of the exceedance of a claim, and the claim; 0 and 0 if it holds.
struct Breach {
    Distance least{0, 0}, claimed{0, 0};
    std::string where;
    bool any() const { return !(least.length <= 0 && least.angle <= 0); }
};

// |x - x_T| minus e, minus the rounding of the coordinates of both states, which grows with their
// distance from the origin.
Breach breach(const SideRun& run, const Claim& claim, const Placement& where, const Known& known) {
    Breach worst;
    const double digits = 4 * eps;
    for (std::size_t k = 0; k < run.places.size(); ++k) {
        const ComparedPoint& place = run.places[k];
        const double within = known.within.length(place) + digits * run.reach,
                     length = (where.p[k] - known.where.p[k]).norm() - within,
                     angle = where.turns[k].angularDistance(known.where.turns[k]) -
                             known.within.bound.angle - digits;
        if (length <= claim.length(place) && angle <= claim.bound.angle) continue;
        if (!(length <= worst.least.length) || !worst.any())
            worst = {{length, angle}, {claim.length(place), claim.bound.angle}, place.name};
    }
    return worst;
}

// Reactions are judged where the claim is less than this, of the size: their bound follows from it
// (bound_of_reactions).
constexpr double coarse = 1e-4;

SideRun walk_all(const Variant& variant, const BranchSide& side,
                 const std::vector<Solver>& solvers) {
    SideRun run;
    run.name = side.name;
    const auto diagnosis = recursive::diagnose(side.model);
    run.places = places_of(side.model, diagnosis);
    run.anything_idle = !diagnosis.idle.empty();
    run.joints = joints_of(side.model, diagnosis, run.places);
    for (const std::size_t j : run.joints) run.joint_names.push_back(side.model.joints[j].name);
    const int every = std::max(1, (side.branch.steps + 1) / 2);  // start, about the middle, end
    run.points = requested_parameters({side}, every).size();
    std::vector<std::vector<Equilibrium>> states(solvers.size());
    for (std::size_t s = 0; s < solvers.size(); ++s) {
        const Solver& solver = solvers[s];
        Found& found = run.found.emplace_back();
        found.elsewhere.resize(run.points);
        if (!variant.requested.empty() && !is_reference(solver) &&
            std::ranges::find(variant.requested, solver.name) == variant.requested.end())
            continue;
        SolverSettings settings = solver.settings;
        settings.every = every;
        try {
            const WithArithmetic in_force(variant.arithmetic);
            const EquilibriumPath path = walk(side, settings, [&](const Equilibrium& state) {
                found.placements.push_back(placement(side.model, run.places, state));
                found.reactions.push_back(reactions_of(run.joints, state));
                states[s].push_back(state);
            });
            found.outcome = path.outcome;
            found.detail = path.detail;
        } catch (const std::exception& error) {
            found.threw = true;
            found.detail = error.what();
        }
    }
    std::vector<std::vector<Equilibrium>> exactly;
    for (const char* name : {"equilibrium", "energy", "series"})
        exactly.push_back(states[index_of(solvers, name)]);
    const Equilibrium drawn = design_state(side.model);
    const auto any = std::ranges::find_if(exactly, [](const auto& path) { return !path.empty(); });
    run.scale =
        scale_of(side.model, side.branch,
                 any == exactly.end() ? std::span(&drawn, 1) : std::span<const Equilibrium>(*any));
    run.size = run.scale.length;
    run.reach = run.size;
    for (const auto& body : side.model.bodies)
        run.reach = std::max(run.reach, body.design.r.cwiseAbs().maxCoeff());
    const auto tolerance = tolerance_of(run, run.scale.force);
    for (std::size_t k = 0; k < run.points; ++k) {
        Known known;
        if (variant.known == Construction::nothing_moves)
            known = {Knowledge::construction,
                     placement(side.model, run.places, drawn),
                     {{eps * run.reach, eps}, false}};
        // then the truth is taken from the default arithmetic
        const bool same_scene = variant.arithmetic != Arithmetic::nearest;
        if (known.how == Knowledge::none && !same_scene)
            known = proved(side, run, exactly, k, tolerance);
        if (known.how == Knowledge::none && !same_scene) known = agreed(solvers, run, k);
        run.known.push_back(known);
        if (known.how != Knowledge::proved) continue;
        for (std::size_t s = 0; s < solvers.size(); ++s) {
            Found& found = run.found[s];
            if (k >= found.placements.size()) continue;
            const Claim claim = claim_of(solvers[s], run.size);
            found.elsewhere[k] =
                (breach(run, claim, found.placements[k], known).any() &&
                 reference::certificate::certify(side.model, side.branch, states[s][k], tolerance)
                         .answer == reference::certificate::Answer::proved);
        }
    }
    return run;
}

TrialRun run(const Trial& trial, const std::vector<Solver>& solvers) {
    TrialRun result;
    const double start = processor_time();
    const Model model = compile(trial.variant.scene);
    for (const auto& branch : model.branches)
        for (const auto& side : sides_of(model, branch)) {
            if (side.branch.drivers.empty()) continue;
            result.sides.push_back(walk_all(trial.variant, side, solvers));
        }
    result.seconds = processor_time() - start;
    return result;
}

// ---- CellVerdict.

// Index pairs of the places that the two versions of a scene share.
struct Match {
    std::vector<std::size_t> here, there;
};
Match match(const std::vector<ComparedPoint>& here, const std::vector<ComparedPoint>& there) {
    Match both;
    for (std::size_t k = 0; k < here.size(); ++k) {
        const auto same = std::ranges::find(there, here[k].name, &ComparedPoint::name);
        if (same == there.end()) continue;
        both.here.push_back(k);
        both.there.push_back(static_cast<std::size_t>(same - there.begin()));
    }
    return both;
}
Placement only(const Placement& where, const std::vector<std::size_t>& places) {
    Placement some;
    for (const auto k : places) some.p.push_back(where.p[k]), some.turns.push_back(where.turns[k]);
    return some;
}

// Outcomes that claim that no equilibrium continues the branch.
bool says_that_it_ends(Outcome outcome) {
    switch (outcome) {
        case Outcome::singular:
        case Outcome::limit_point:
        case Outcome::bifurcation_point:
        case Outcome::branch_lost:
        case Outcome::inconsistent_constraints:
        case Outcome::loaded_idle_mode: return true;
        case Outcome::converged:
        case Outcome::not_finite:
        case Outcome::iteration_limit:
        case Outcome::diverged:
        case Outcome::not_conservative:
        case Outcome::too_large:
        case Outcome::outside_table: return false;
    }
    return false;
}

// Whether every point is a proved stable equilibrium. A motion that is idle at one point and held
// by its load at the next has jumped: these are equilibria, but no branch.
bool all_proved(const SideRun& run) {
    return std::ranges::all_of(run.known, [&](const Known& known) {
        return known.how == Knowledge::proved && known.stable &&
               known.idle == run.known.front().idle;
    });
}

// Reason where both references report the end of the branch and no state beyond is proved; else
// empty.
std::string ended(const std::vector<Solver>& solvers, const SideRun& run) {
    if (all_proved(run)) return {};
    std::string why;
    for (std::size_t s = 0; s < solvers.size(); ++s) {
        if (!is_reference(solvers[s])) continue;
        if (!says_that_it_ends(run.found[s].outcome) ||
            run.found[s].placements.size() >= run.points)
            return {};
        why = run.found[s].detail;
    }
    return why;
}

bool all_known(const SideRun& run) {
    return std::ranges::all_of(run.known,
                               [](const Known& known) { return known.how != Knowledge::none; });
}

// Largest displacement of any place over the known points.
double range_of(const SideRun& run) {
    double range = 0;
    const Known* start = nullptr;
    for (const auto& known : run.known) {
        if (known.how == Knowledge::none) continue;
        if (start == nullptr) start = &known;
        range = std::max(range, apart(start->where, known.where).length);
    }
    return range > 1e-9 * run.size ? range : run.size;
}

void judge_points(const Solver& solver, const Found& found, const SideRun& run, StressCell& cell) {
    double worst = 0;
    bool any_unknown = false, breaks = false, elsewhere = false;
    const Claim claim_here = claim_of(solver, run.size);
    const Distance claim = claim_here.most(run.places);
    for (std::size_t k = 0; k < found.placements.size(); ++k) {
        if (!is_finite(found.placements[k])) {
            cell.verdict = CellVerdict::wrong;
            cell.why = "a state is not finite";
            return;
        }
        cell.claim = claim.length;
        if (k >= run.known.size() || run.known[k].how == Knowledge::none) {
            any_unknown = true;
            continue;
        }
        const Known& known = run.known[k];
        if (cell.knowledge == Knowledge::none || known.how == Knowledge::transforms)
            cell.knowledge = known.how;
        const Distance d = apart(found.placements[k], known.where);
        worst = std::max(worst, d.length + known.within.most(run.places).length);
        if (const Breach broken = breach(run, claim_here, found.placements[k], known);
            broken.any()) {
            (found.elsewhere[k] ? elsewhere : breaks) = true;
            cell.why = fmt::format(
                "{} deviates by {:.3e} mm and {:.3e} rad at least, and claims {:.3e} mm and {:.3e} "
                "rad",
                broken.where, 1e3 * std::max(0.0, broken.least.length),
                std::max(0.0, broken.least.angle), 1e3 * broken.claimed.length,
                broken.claimed.angle);
        } else if (claim.length < coarse * run.size) {
            cell.reactions += static_cast<int>(known.reactions.size());
            const ReactionBound bound = bound_of_reactions(claim.length, run.scale);
            if (std::string off = reaction_off(
                    run.joint_names, found.reactions[k], known.reactions,
                    {bound.force + known.force, bound.moment + known.moment}, run.scale);
                !off.empty()) {
                breaks = true;
                cell.why = std::move(off);
            }
        }
    }
    if (cell.knowledge != Knowledge::none) {
        cell.error = worst;
        cell.digits = std::clamp(-std::log10(worst / cell.range), 0.0, 16.0);
    }
    if (breaks)
        cell.verdict = CellVerdict::wrong;
    else if (found.outcome != Outcome::converged)
        cell.verdict = CellVerdict::reported_failure, cell.digits = nan;
    else if (elsewhere)
        cell.verdict = CellVerdict::elsewhere,
        cell.why = "at another equilibrium, which is also proved: " + cell.why;
    else if (any_unknown)
        cell.verdict = CellVerdict::unjudged, cell.digits = nan;
    else
        cell.verdict = std::isfinite(claim.length) ? CellVerdict::right : CellVerdict::no_claim;
}

// Invariance check: a transformed mechanism must give the same answer, within the claim of the
// solver, or without a claim within 1e-7 of the movement and ten thousand roundings of the largest
// coordinate. The step error depends on the reference point of a body's increments; without a claim
// the check applies only where rigidly connected bodies use the same reference body. Nor does it
// apply to steps that an absolute tolerance chooses where lengths have another scale.
void judge_invariance(const Solver& solver, const Found& found, const SideRun& run,
                      const Found& base_found, const SideRun& base, const Transform& how,
                      StressCell& cell) {
    if (found.outcome != Outcome::converged || base_found.outcome != Outcome::converged) return;
    if (cell.verdict == CellVerdict::wrong) return;
    const Match both = match(run.places, base.places);
    const bool same_bodies =
        both.here.size() == run.places.size() && both.there.size() == base.places.size();
    const bool other_steps =
        how.length != 1 && solver.settings.leg == Leg::recursive &&
        std::holds_alternative<recursive::Adaptive>(solver.settings.recursion.method.kind);
    for (std::size_t k = 0; k < std::min(found.placements.size(), base_found.placements.size());
         ++k) {
        const Placement here = only(found.placements[k], both.here),
                        there = transforms(only(base_found.placements[k], both.there), how);
        const Distance d = apart(here, there);
        const Distance c = claim_of(solver, run.size).most(run.places),
                       c_base = claim_of(solver, base.size).most(base.places);
        if (!std::isfinite(c.length) && (!same_bodies || other_steps)) continue;
        const double rounding = 1e4 * eps * run.reach,
                     allowed = std::isfinite(c.length) && std::isfinite(c_base.length)
                                   ? c.length + how.length * c_base.length + rounding
                                   : 1e-7 * cell.range + rounding;
        if (!(d.length <= allowed)) {
            cell.verdict = CellVerdict::wrong;
            cell.why = fmt::format("differs by {:.2e} mm from its result for the unchanged scene",
                                   1e3 * d.length);
        }
    }
}

// Distance from the answer of the unchanged scene, in its frame; NaN unless both converged.
double apart(const Found& found, const SideRun& run, const Found& base_found, const SideRun& base,
             const Transform& how) {
    if (found.outcome != Outcome::converged || base_found.outcome != Outcome::converged) return nan;
    const Match both = match(run.places, base.places);
    double off = 0;
    for (std::size_t k = 0; k < std::min(found.placements.size(), base_found.placements.size());
         ++k) {
        const Distance d = apart(only(found.placements[k], both.here),
                                 transforms(only(base_found.placements[k], both.there), how));
        if (!(d.length <= off)) off = d.length;
    }
    return off / how.length;
}

StressCell judge(const Trial& trial, const std::vector<Solver>& solvers, std::size_t s,
                 const SideRun& run, const SideRun* base) {
    const Found& found = run.found[s];
    StressCell cell;
    cell.scene = trial.scene, cell.sweep = trial.sweep, cell.variant = trial.variant.label;
    cell.side = run.name, cell.solver = solvers[s].name;
    cell.outcome = found.outcome, cell.detail = found.detail;
    cell.range = range_of(run);
    if (found.threw) {
        cell.verdict = CellVerdict::wrong;
        cell.why = "ended with an exception";
        return cell;
    }
    judge_points(solvers[s], found, run, cell);
    if (base != nullptr)
        cell.apart = apart(found, run, base->found[s], *base, *trial.variant.transforms);
    if (cell.verdict == CellVerdict::wrong) return cell;
    if (is_reference(solvers[s]) && says_that_it_ends(found.outcome)) {
        if (base != nullptr && all_known(*base))
            cell.verdict = CellVerdict::wrong,
            cell.why =
                "reports that no equilibrium continues the branch, "
                "but finds one in the transformed scene";
        else if (all_proved(run) && !found.placements.empty())
            cell.verdict = CellVerdict::wrong,
            cell.why =
                "reports that no equilibrium continues the branch, "
                "but the states of another solver are proved";
    }
    if (found.outcome != Outcome::converged) return cell;
    const std::string end = ended(solvers, run);
    if (found.placements.size() < run.points)
        cell.verdict = CellVerdict::wrong, cell.why = "converged, but points are missing";
    else if (trial.variant.known == Construction::no_equilibrium)
        cell.verdict = CellVerdict::wrong,
        cell.why = "converged although by construction no equilibrium exists";
    else if (!end.empty())
        cell.verdict = CellVerdict::wrong,
        cell.why = "converged where both references report: " + end;
    else if (base != nullptr)
        judge_invariance(solvers[s], found, run, base->found[s], *base, *trial.variant.transforms,
                         cell);
    return cell;
}

// Truth of a transformed scene, taken from the unchanged scene where it is known only there.
void lend(const SideRun& base, const Transform& how, SideRun& run) {
    const Match both = match(run.places, base.places);
    if (both.here.size() != run.places.size()) return;
    for (std::size_t k = 0; k < std::min(run.known.size(), base.known.size()); ++k)
        if (run.known[k].how == Knowledge::none && base.known[k].how != Knowledge::none)
            run.known[k] = {
                Knowledge::transforms,
                transforms(only(base.known[k].where, both.there), how),
                {{how.length * base.known[k].within.most(base.places).length + eps * run.reach,
                  base.known[k].within.bound.angle},
                 false}};
}

template <class T>
std::vector<std::string> distinct(std::span<const T> all, std::string T::*member) {
    std::vector<std::string> names;
    for (const auto& one : all)
        if (std::ranges::find(names, one.*member) == names.end()) names.push_back(one.*member);
    return names;
}

}  // namespace

const char* name(Knowledge knowledge) {
    switch (knowledge) {
        case Knowledge::none: return "none";
        case Knowledge::construction: return "construction";
        case Knowledge::proved: return "proof";
        case Knowledge::references: return "references";
        case Knowledge::transforms: return "the unchanged scene";
    }
    return "";
}

const char* name(CellVerdict verdict) {
    switch (verdict) {
        case CellVerdict::right: return "right";
        case CellVerdict::no_claim: return "unpromised";
        case CellVerdict::reported_failure: return "honest";
        case CellVerdict::elsewhere: return "elsewhere";
        case CellVerdict::unjudged: return "unjudged";
        case CellVerdict::wrong: return "wrong";
    }
    return "";
}

std::vector<Solver> solvers() {
    std::vector<Solver> all;
    for (const auto& method : recursive::methods)
        all.push_back(
            {std::string(method.name), {.leg = Leg::recursive, .recursion = {.method = method}}});
    for (const Leg leg : {Leg::equilibrium, Leg::energy}) all.push_back({name(leg), {.leg = leg}});
    return all;
}

std::vector<Trial> trials(const std::string& name, const Scene& scene,
                          std::span<const Sweep> sweeps) {
    std::vector<Trial> all;
    for (const auto& sweep : sweeps)
        for (auto& variant : sweep.variants(scene))
            all.push_back({name, sweep.name, std::move(variant)});
    return all;
}

int Survival::count(CellVerdict verdict) const {
    return static_cast<int>(std::ranges::count(cells, verdict, &StressCell::verdict));
}
int Survival::judged() const {
    return static_cast<int>(cells.size()) - count(CellVerdict::unjudged);
}

Survival stress(std::span<const Trial> trials, const StressOptions& options) {
    Survival survival;
    const auto who = solvers();
    survival.scenes = distinct(trials, &Trial::scene);
    survival.sweeps = distinct(trials, &Trial::sweep);
    for (const auto& solver : who) survival.solvers.push_back(solver.name);

    // Trials run independently, in parallel, until they are judged.
    std::vector<TrialRun> runs(trials.size());
    std::vector<Job> jobs;
    for (std::size_t t = 0; t < trials.size(); ++t)
        if (trials[t].variant.skipped.empty())
            jobs.push_back({fmt::format("{}, {}", trials[t].scene, trials[t].variant.label),
                            [&, t] { runs[t] = run(trials[t], who); }});
    run_jobs(jobs, options.threads, options.progress);

    for (std::size_t t = 0; t < trials.size(); ++t) {
        const Trial& trial = trials[t];
        survival.seconds += runs[t].seconds;
        if (runs[t].seconds > survival.dearest.seconds)
            survival.dearest = {trial.scene, trial.variant.label, runs[t].seconds};
        if (!trial.variant.skipped.empty())
            survival.skipped.push_back(
                {trial.scene, trial.sweep, trial.variant.label, trial.variant.skipped});
        const TrialRun* base = nullptr;
        if (trial.variant.transforms)
            for (std::size_t b = 0; b < trials.size(); ++b)
                if (trials[b].scene == trial.scene && trials[b].sweep == as_it_is) base = &runs[b];
        for (std::size_t w = 0; w < runs[t].sides.size(); ++w) {
            SideRun& side = runs[t].sides[w];
            const SideRun* same =
                base != nullptr && w < base->sides.size() ? &base->sides[w] : nullptr;
            if (same != nullptr) lend(*same, *trial.variant.transforms, side);
            for (std::size_t s = 0; s < who.size(); ++s) {
                const bool requested = side.found[s].threw || !side.found[s].placements.empty() ||
                                       side.found[s].outcome != Outcome::converged;
                if (requested) survival.cells.push_back(judge(trial, who, s, side, same));
            }
        }
    }
    return survival;
}

char sign(const Survival& survival, const std::string& scene, const std::string& sweep,
          const std::string& solver, const std::string& variant) {
    char result = '.';
    double digits = std::numeric_limits<double>::infinity();
    bool unjudged = false, elsewhere = false;
    for (const auto& cell : survival.cells) {
        if (cell.scene != scene || cell.sweep != sweep || cell.solver != solver ||
            (!variant.empty() && cell.variant != variant))
            continue;
        if (cell.verdict == CellVerdict::wrong) return 'X';
        if (result == '.') result = '!';
        unjudged |= cell.verdict == CellVerdict::unjudged;
        elsewhere |= cell.verdict == CellVerdict::elsewhere;
        if (cell.verdict == CellVerdict::right || cell.verdict == CellVerdict::no_claim)
            digits = std::min(digits, cell.digits);
    }
    if (unjudged) return '?';
    if (elsewhere) return '~';
    return std::isfinite(digits)
               ? static_cast<char>('0' + std::clamp(static_cast<int>(digits), 0, 9))
               : result;
}

}  // namespace elastocheck::compare
