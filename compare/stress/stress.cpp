#include "compare/stress/stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "compare/comparison/compare.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "elastocheck/compile.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;
using reference::certificate::certify;
using reference::certificate::ProofState;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double exact_angle = 1.7453292520e-8;  // 1e-6 deg

// ---- Compared outputs: vectors in ground axes, each of two or three channels.

enum Quantity : std::size_t { of_position, of_direction, of_force, of_moment };
constexpr std::array symbols{"m", "rad", "N", "N·m"};  // by Quantity
using Limits = std::array<double, 4>;                  // likewise

struct Output {
    std::string name;  // of its first channel
    Quantity quantity = of_position;
    std::size_t channel = 0;  // the first of them; of a direction: toe, then camber
    std::vector<BodyId> bodies = {};
    double side = 1;  // of a direction
};
using Vectors = std::map<std::string, Vector3d>;  // by name; SI, in the axes of the unchanged scene

// The output whose first channel this is, if any.
std::optional<Output> output(const Model& model, const Channel& channel, std::size_t c) {
    if (const auto* coordinate = std::get_if<Coordinate>(&channel.reads);
        coordinate != nullptr && channel.name.ends_with("_x"))
        return Output{channel.name, of_position, c, {coordinate->at.body}};
    if (is_figure(channel, figure::toe)) {
        const Wheel& wheel = model.wheels[std::get<Catalogued>(channel.reads).of];
        return Output{channel.name, of_direction, c, {wheel.body}, double(wheel.side)};
    }
    if (const auto* reaction = std::get_if<Reaction>(&channel.reads);
        reaction != nullptr && reaction->component % 3 == 0) {
        const ModelJoint& joint = model.joints[static_cast<std::size_t>(reaction->joint)];
        return Output{
            channel.name, reaction->component == 0 ? of_force : of_moment, c, {joint.i, joint.j}};
    }
    return std::nullopt;
}

// Outputs of the determined channels that read no body with an idle mode.
std::vector<Output> outputs_of(const Model& model, const recursive::Diagnosis& diagnosis,
                               const std::vector<Channel>& channels,
                               const std::vector<bool>& determined) {
    const auto idle = bodies_with_idle_mode(model, diagnosis);
    std::vector<Output> outputs;
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (auto candidate = determined[c] ? output(model, channels[c], c) : std::nullopt)
            if (std::ranges::none_of(candidate->bodies, [&](BodyId body) {
                    return body != ground && idle[static_cast<std::size_t>(body)];
                }))
                outputs.push_back(std::move(*candidate));
    return outputs;
}

// The outputs of a point, mapped back to the axes, lengths and forces of the unchanged scene;
// without reactions that are undefined there.
Vectors values_of(const std::vector<Output>& outputs, const std::vector<double>& row,
                  const Transform& transform) {
    Vectors values;
    for (const Output& output : outputs) {
        const double *v = &row[output.channel], toe = v[0] / in_unit(Unit::deg),
                     camber = v[1] / in_unit(Unit::deg);
        Vector3d x(v[0], v[1], v[2]);
        if (output.quantity >= of_force && x.array().isInf().any()) continue;
        switch (output.quantity) {
            case of_position: x = (x / in_unit(Unit::mm) - transform.t) / transform.length; break;
            case of_direction:
                x = {std::cos(camber) * std::sin(toe),
                     output.side * std::cos(camber) * std::cos(toe), -std::sin(camber)};
                break;
            case of_force: x /= transform.force; break;
            case of_moment:
                x *= transform.M.determinant() / (transform.force * transform.length);
                break;
        }
        values[output.name] = transform.M.transpose() * x;
    }
    return values;
}

// Largest distance of the positions; NaN counts as largest.
double distance(const std::vector<Output>& outputs, const Vectors& a, const Vectors& b) {
    double largest = 0;
    for (const Output& output : outputs)
        if (output.quantity == of_position && a.contains(output.name) && b.contains(output.name))
            largest = worse(largest, (a.at(output.name) - b.at(output.name)).norm());
    return largest;
}

// The error that a solver claims, in the units of the unchanged scene: 1e-9 L and 1e-6 deg for a
// reference, the tolerance for `adaptive` and the series, infinite for fixed steps. For forces it
// is infinite where the claim of positions is 1e-4 L or more. With F the largest acting force, L
// the size, ε k X the rounding of the stiffest element (agreement.hpp):
//
//   force    max(1e-6, 1000 length / L) F + 1000 ε k X          moment    L times that
Limits claim_of(const Solver& solver, const Scale& scale, const Transform& transform) {
    constexpr double coarse = 1e-4, no_force = 1e-12;
    const double L = scale.length;
    Limits claim{1e-9 * L, exact_angle, inf, inf};
    if (solver.settings.leg == Leg::recursive) {
        const auto& kind = solver.settings.recursion.method.kind;
        const auto* adaptive = std::get_if<recursive::Adaptive>(&kind);
        const auto* series = std::get_if<recursive::Series>(&kind);
        if (adaptive == nullptr && series == nullptr) return {inf, inf, inf, inf};
        const double length = adaptive ? adaptive->length_tolerance : series->tolerance,
                     angle = adaptive ? adaptive->angle_tolerance : series->tolerance / L;
        claim[of_position] = std::max(claim[of_position], length + (adaptive ? L * angle : 0));
        claim[of_direction] = std::max(claim[of_direction], angle);
    }
    if (claim[of_position] < coarse * L) {
        const double share = std::max(1e-6, 1000 * claim[of_position] / L);
        claim[of_force] =
            (share * std::max(scale.force, no_force) + 1000 * scale.round_off) / transform.force;
        claim[of_moment] = claim[of_force] * L / transform.length;
    }
    claim[of_position] /= transform.length;
    return claim;
}

// ---- Runs of all solvers on one branch side.

struct Run {
    bool requested = false;
    Outcome outcome = Outcome::converged;
    std::string detail = {};
    std::vector<Equilibrium> states = {};  // start, about the middle, end, as far as it came
    std::vector<Vectors> points = {};      // the same
    Limits claim = {};
};

// True outputs x_T of one point, known to within e.
struct Known {
    std::string by = {};  // "proof"; empty: unknown
    Vectors values = {};
    Limits error = {};
    bool proved = false, stable = false;  // by a proof, which includes stability
    bool idle = false;                    // the proof held an idle mode in its position
};

struct SideRun {
    BranchSide side;
    std::string exception = {};  // its message
    std::vector<Output> outputs = {};
    reference::certificate::Tolerance tolerance = {};  // of proofs
    double size = 1, rounding = 0;  // L and 4 ε X [m], in the lengths of the unchanged scene
    std::vector<Run> runs = {};     // per solver
    std::vector<Known> known = {};  // per requested point
};

// Message on the output that exceeds claim + e + rounding by the largest factor; empty where none does.
std::string breach(const std::vector<Output>& outputs, const Limits& claim, const Vectors& values,
                   const Known& known, double rounding) {
    const Limits round_off{rounding, 4 * eps, 0, 0};
    std::string why;
    double worst = 1;
    for (const Output& output : outputs) {
        const auto value = values.find(output.name), truth = known.values.find(output.name);
        if (value == values.end() || truth == known.values.end()) continue;
        const Quantity q = output.quantity;
        const double deviation = (value->second - truth->second).norm(),
                     ratio = deviation / (claim[q] + known.error[q] + round_off[q]);
        if (deviation == 0 || ratio <= worst) continue;
        worst = ratio;
        why = fmt::format("{} deviates by {:.3e} {}, and at most {:.3e} is claimed", output.name,
                          deviation, symbols[q], claim[q]);
    }
    return why;
}

// The k-th point by the first state of the accurate solvers that can be proved; unknown if none can.
Known proved(const SideRun& run, const std::vector<const Run*>& accurate, std::size_t k,
             bool anything_idle) {
    for (const Run* path : accurate) {
        if (k >= path->states.size()) continue;
        const auto certificate =
            certify(run.side.model, run.side.branch, path->states[k], run.tolerance);
        const auto& e = certificate.error;
        // A weakly resisted motion that is held for the proof stays at its value in the state, not
        // at equilibrium.
        if (certificate.state == ProofState::proved && (certificate.held == 0 || anything_idle))
            return {"proof",
                    path->points[k],
                    {e.length + run.size * e.angle, e.angle, e.force, e.moment},
                    true,
                    certificate.stable,
                    certificate.held > 0};
    }
    return {};
}

// The k-th point by two accurate solvers that agree within their claims; unknown if none do.
Known agreed(const SideRun& run, const std::vector<const Run*>& accurate, std::size_t k) {
    for (const auto& [i, j] : {std::pair{0u, 1u}, {0u, 2u}, {1u, 2u}}) {
        const Run &one = *accurate[i], &other = *accurate[j];
        if (k < one.points.size() && k < other.points.size() &&
            breach(run.outputs, one.claim, one.points[k],
                   {.values = other.points[k], .error = other.claim}, run.rounding)
                .empty())
            return {"references", one.points[k], one.claim};
    }
    return {};
}

// The truth of a scene that is not transformed: by construction, by proof, or by agreement.
void find_truth(SideRun& run, const std::vector<Solver>& solvers, const Variant& variant,
                const Vectors& design, bool anything_idle) {
    std::vector<const Run*> accurate;
    for (const char* name : {"equilibrium", "energy", "series"})
        accurate.push_back(&run.runs[static_cast<std::size_t>(
            std::ranges::find(solvers, name, &Solver::name) - solvers.begin())]);
    for (std::size_t k = 0; k < run.known.size(); ++k) {
        if (variant.known == Variant::Construction::nothing_moves)
            run.known[k] = {"construction", design, {run.rounding, eps, inf, inf}};
        else
            run.known[k] = proved(run, accurate, k, anything_idle);
        if (run.known[k].by.empty()) run.known[k] = agreed(run, accurate, k);
    }
}

void run_side(SideRun& result, const Variant& variant, Model model,
              const std::vector<Solver>& solvers) {
    const Transform transform = variant.transforms.value_or(Transform{});
    const BranchSide& side = result.side;
    model.branches = {side.branch};
    const int every = std::max(1, (side.branch.steps + 1) / 2);  // start, about the middle, end
    result.known.resize(requested_parameters({side}, every).size());
    const Comparison comparison = compare(model, {.recursion = solvers.front().settings.recursion,
                                                  .every = every,
                                                  .prove = false,
                                                  .times = false});
    const BranchComparison& branch = comparison.branches.front();
    const auto diagnosis = recursive::diagnose(side.model);
    result.outputs = outputs_of(model, diagnosis, comparison.channels, branch.determined);
    Scale scale = branch.run(Leg::equilibrium).scale;
    if (branch.run(Leg::equilibrium).curve.a.empty())
        for (const LegRun& run : branch.runs) scale = larger(scale, run.scale);
    double reach = scale.length;  // X
    for (const auto& body : model.bodies)
        reach = std::max(reach, body.design.r.cwiseAbs().maxCoeff());
    result.size = scale.length / transform.length;
    result.rounding = 4 * eps * reach / transform.length;
    const double length = std::max(1e-9 * scale.length, 1e3 * eps * reach),
                 least = 1e-6 * std::max(scale.force, 1e-9);  // [N]
    result.tolerance = {length, exact_angle, least, least * scale.length, least, length};
    for (std::size_t s = 0; s < solvers.size(); ++s) {
        Run& run = result.runs[s];
        SolverSettings settings = solvers[s].settings;
        const bool compared = s == 0 || settings.leg != Leg::recursive;
        run.requested =
            compared || variant.requested.empty() ||
            std::ranges::find(variant.requested, solvers[s].name) != variant.requested.end();
        if (!run.requested) continue;
        settings.every = every;
        const LegRun leg_run = compared
                                   ? branch.run(settings.leg)
                                   : compare::run(model, comparison.channels,
                                                  model.branches.front(), {side}, settings, false);
        run.claim = claim_of(solvers[s], scale, transform);
        run.outcome = leg_run.outcome;
        run.detail = leg_run.detail;
        const auto& [front, start, middle, back] = leg_run.landmarks;
        for (std::size_t k = 0; k < leg_run.curve.a.size(); ++k)
            for (const auto* state : {&start, &middle, &back})
                if (*state &&
                    parameter_in(leg_run.curve.unit, (*state)->load) == leg_run.curve.a[k]) {
                    run.states.push_back(**state);
                    run.points.push_back(
                        values_of(result.outputs, leg_run.curve.values[k], transform));
                    break;
                }
    }
    if (!variant.transforms)
        find_truth(result, solvers, variant,
                   values_of(result.outputs,
                             evaluate(model, comparison.channels, design_state(model)), {}),
                   !diagnosis.idle.empty());
}

std::vector<SideRun> run_trial(const Trial& trial, const std::vector<Solver>& solvers) {
    std::vector<SideRun> sides;
    const Model model = compile(trial.variant.scene);
    for (const auto& branch : model.branches)
        for (const auto& side : sides_of(model, branch)) {
            if (side.branch.drivers.empty()) continue;
            sides.push_back({.side = side, .runs = std::vector<Run>(solvers.size())});
            try {
                run_side(sides.back(), trial.variant, model, solvers);
            } catch (const std::exception& error) {
                sides.back().exception = error.what();
            }
        }
    return sides;
}

// ---- Verdict.

// Whether the outcome claims that no equilibrium continues the branch.
bool reports_end(Outcome outcome) {
    constexpr std::array ends{Outcome::singular,          Outcome::limit_point,
                              Outcome::bifurcation_point, Outcome::branch_lost,
                              Outcome::loaded_idle_mode,  Outcome::inconsistent_constraints};
    return std::ranges::find(ends, outcome) != ends.end();
}

// Whether the points are proved to be a stable branch. Where a mode is idle at one point and held by its
// load at the next, the equilibria are not on one branch.
bool all_proved(const SideRun& run) {
    return std::ranges::all_of(run.known, [&](const Known& known) {
        return known.proved && known.stable && known.idle == run.known.front().idle;
    });
}

// Reason that a reference gives where both references, the last two solvers, report the end of the
// branch and its points are not all proved; else empty.
std::string end_by_references(const SideRun& run, const SideRun& truth) {
    if (all_proved(truth)) return {};
    for (std::size_t s = run.runs.size() - 2; s < run.runs.size(); ++s)
        if (!reports_end(run.runs[s].outcome) || run.runs[s].points.size() >= truth.known.size())
            return {};
    return run.runs.back().detail;
}

// Largest displacement of any position over the known points.
double range_of(const SideRun& run) {
    double range = 0;
    const Known* start = nullptr;
    for (const Known& known : run.known) {
        if (known.by.empty()) continue;
        if (start == nullptr) start = &known;
        range = std::max(range, distance(run.outputs, start->values, known.values));
    }
    return range > 1e-9 * run.size ? range : run.size;
}

StressCell judge(const Trial& trial, const Solver& solver, std::size_t s, const SideRun& run,
                 const SideRun* base) {
    const Run& judged = run.runs[s];
    const SideRun& truth = base != nullptr ? *base : run;
    // A transform rounds the coordinates of the scene.
    const double rounding = (base != nullptr ? 2500 : 1) * run.rounding;
    StressCell cell{trial.scene, trial.sweep,    trial.variant.label, run.side.name,
                    solver.name, judged.outcome, judged.detail};
    cell.range = range_of(truth);
    const auto wrong = [&](std::string why) {
        cell.verdict = CellVerdict::wrong;
        cell.why = std::move(why);
        return cell;
    };
    if (!run.exception.empty()) return wrong("ended with an exception: " + run.exception);
    if (!judged.points.empty()) cell.claim = judged.claim[of_position];
    const bool claims = std::isfinite(judged.claim[of_position]);
    const Run* base_run = base != nullptr ? &base->runs[s] : nullptr;
    const bool both_converged = base_run != nullptr && judged.outcome == Outcome::converged &&
                                base_run->outcome == Outcome::converged;
    bool unknown = false;
    double error = 0;
    std::string breaks, elsewhere;
    for (std::size_t k = 0; k < judged.points.size(); ++k) {
        for (const auto& [name, value] : judged.points[k])
            if (!value.allFinite()) return wrong("a state is not finite: " + name);
        if (both_converged && !claims && k < base_run->points.size() && breaks.empty())
            breaks = breach(run.outputs, {1e-7 * cell.range, 1e-7, inf, inf}, judged.points[k],
                            {.values = base_run->points[k]}, rounding);
        if (k >= truth.known.size() || truth.known[k].by.empty()) {
            unknown = true;
            continue;
        }
        const Known& known = truth.known[k];
        cell.known_by = base != nullptr ? "the unchanged scene" : known.by;
        error = worse(error, distance(run.outputs, judged.points[k], known.values) +
                                 known.error[of_position]);
        std::string why = breach(run.outputs, judged.claim, judged.points[k], known, rounding);
        if (why.empty()) continue;
        // Not wrong if it is another proved equilibrium; of a transformed scene it must be the same one
        // as without the transform.
        const bool same_as_unchanged =
            base_run == nullptr ||
            (k < base_run->points.size() &&
             breach(run.outputs, judged.claim, judged.points[k],
                    {.values = base_run->points[k], .error = base_run->claim}, rounding)
                 .empty());
        const bool is_another =
            known.proved && same_as_unchanged &&
            certify(run.side.model, run.side.branch, judged.states[k], run.tolerance).state ==
                ProofState::proved;
        (is_another ? elsewhere : breaks) = std::move(why);
    }
    if (!cell.known_by.empty()) cell.error = error;
    if (!breaks.empty()) return wrong(breaks);
    if (solver.settings.leg != Leg::recursive && reports_end(judged.outcome)) {
        if (base != nullptr &&
            std::ranges::all_of(base->known, [](const Known& known) { return !known.by.empty(); }))
            return wrong("reports an end of the branch, which is known in the unchanged scene");
        if (all_proved(truth) && !judged.points.empty())
            return wrong("reports an end of the branch, and another solver's states are proved");
    }
    if (judged.outcome != Outcome::converged) {
        cell.verdict = CellVerdict::reported_failure;
        return cell;
    }
    if (judged.points.size() < truth.known.size())
        return wrong("converged, but points are missing");
    if (trial.variant.known == Variant::Construction::no_equilibrium)
        return wrong("converged although by construction no equilibrium exists");
    if (const auto end = end_by_references(run, truth); !end.empty())
        return wrong("converged where both references report: " + end);
    if (!elsewhere.empty()) {
        cell.verdict = CellVerdict::elsewhere;
        cell.why = "at another equilibrium, which is also proved: " + elsewhere;
    } else if (!unknown) {
        cell.verdict = claims ? CellVerdict::right : CellVerdict::no_claim;
    }
    if (!unknown) cell.digits = std::clamp(-std::log10(error / cell.range), 0.0, 16.0);
    return cell;
}

}  // namespace

const char* name(CellVerdict verdict) {
    constexpr std::array names{"right",     "no claim", "reported failure",
                               "elsewhere", "unjudged", "wrong"};
    return names[static_cast<std::size_t>(verdict)];
}

std::vector<Solver> solvers() {
    std::vector<Solver> list;
    for (const auto& method : recursive::methods)
        list.push_back(
            {std::string(method.name), {.leg = Leg::recursive, .recursion = {.method = method}}});
    for (const Leg leg : {Leg::equilibrium, Leg::energy}) list.push_back({name(leg), {.leg = leg}});
    return list;
}

int Survival::count(CellVerdict verdict) const {
    return static_cast<int>(std::ranges::count(cells, verdict, &StressCell::verdict));
}
int Survival::judged() const {
    return static_cast<int>(cells.size()) - count(CellVerdict::unjudged);
}

Survival stress(std::span<const Trial> trials, int threads, const Progress& progress) {
    Survival survival;
    const auto all_solvers = solvers();
    for (const auto& solver : all_solvers) survival.solvers.push_back(solver.name);

    // Trials run independently, in parallel, until they are judged.
    std::vector<std::vector<SideRun>> runs(trials.size());
    std::vector<Job> jobs;
    for (std::size_t t = 0; t < trials.size(); ++t)
        jobs.push_back({fmt::format("{}, {}", trials[t].scene, trials[t].variant.label),
                        [&, t] { runs[t] = run_trial(trials[t], all_solvers); }});
    run_jobs(jobs, threads, progress);

    for (std::size_t t = 0; t < trials.size(); ++t) {
        const auto unchanged = std::ranges::find_if(trials, [&](const Trial& other) {
            return other.scene == trials[t].scene && other.sweep == as_it_is;
        });
        const bool has_base = trials[t].variant.transforms && unchanged != trials.end();
        const auto& base =
            runs[has_base ? static_cast<std::size_t>(unchanged - trials.begin()) : t];
        for (std::size_t side = 0; side < runs[t].size(); ++side)
            for (std::size_t s = 0; s < all_solvers.size(); ++s)
                if (runs[t][side].runs[s].requested || !runs[t][side].exception.empty())
                    survival.cells.push_back(
                        judge(trials[t], all_solvers[s], s, runs[t][side],
                              has_base && side < base.size() ? &base[side] : nullptr));
    }
    return survival;
}

char sign(const StressCell& cell) {
    switch (cell.verdict) {
        case CellVerdict::right:
        case CellVerdict::no_claim:
            return static_cast<char>('0' + std::clamp(static_cast<int>(cell.digits), 0, 9));
        case CellVerdict::reported_failure: return '!';
        case CellVerdict::elsewhere: return '~';
        case CellVerdict::unjudged: return '?';
        case CellVerdict::wrong: return 'X';
    }
    return '.';
}

}  // namespace elastocheck::compare
