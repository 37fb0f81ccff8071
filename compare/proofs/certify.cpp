#include "compare/proofs/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <span>

#include "compare/jobs/jobs.hpp"
#include "reference/certificate/proved_box.hpp"

namespace elastocheck::compare {
namespace {

namespace certificate = reference::certificate;

certificate::Tolerance in_si(const Tolerance& tolerance) {
    return {1e-3 * tolerance.mm, tolerance.deg * std::numbers::pi / 180};
}

std::string solver_of(const SolverSettings& solver) {
    return solver.leg == Leg::recursive ? std::string(solver.recursion.method.name)
                                        : name(solver.leg);
}

// A solver along a side of a branch, with its path and the certificates of its points.
struct SolvedSide {
    const BranchSide& side;
    SolverSettings solver;
    EquilibriumPath path = {};
    std::vector<certificate::Certificate> points = {};
    CertifiedSide result = {};
};

void solve(SolvedSide& solved, int points) {
    const BranchSide& side = solved.side;
    solved.solver.every = std::max(1, side.branch.steps / points);
    solved.path = solve_branch(side, solved.solver);
    solved.points.resize(solved.path.points.size());
    CertifiedSide& result = solved.result;
    result.branch = side.name;
    result.unit = unit_of(side.branch.unit);
    result.to = in_unit(result.unit) * side.branch.to;
    result.solver = solver_of(solved.solver);
    result.outcome = solved.path.outcome;
    result.detail = solved.path.detail;
}

// Certifies the points of all solvers at one parameter: a box proved for one may contain the others.
void certify_at(double a, std::span<SolvedSide> solvers, const certificate::Tolerance& tolerance) {
    std::vector<certificate::ProvedBox> known;
    for (SolvedSide& solved : solvers)
        for (std::size_t k = 0; k < solved.points.size(); ++k)
            if (const Equilibrium& state = solved.path.points[k]; state.load == a)
                solved.points[k] = certificate::certify(solved.side.model, solved.side.branch,
                                                        state, tolerance, known);
}

// Certifies the curve between the points of the equilibrium leg, and a limit point at the end of a path.
void certify_path(SolvedSide& solved, const CertifyOptions& options) {
    const auto& [side, solver, path, points, _] = solved;
    CertifiedSide& result = solved.result;
    if (options.curves && solver.leg == Leg::equilibrium && path.points.size() > 1)
        result.curve = certificate::certify_branch(side.model, side.branch, path.points,
                                                   in_si(options.tolerance));
    // The last point starts the search for the limit point; it claims no accuracy.
    constexpr certificate::Tolerance unlimited{
        .length = 1, .angle = 1, .force = 1e9, .moment = 1e9};
    if (path.outcome == Outcome::limit_point && !path.points.empty())
        result.limit = certificate::certify_limit_point(side.model, side.branch, path.points.back(),
                                                        unlimited);
}

}  // namespace

Tolerance claim(std::string_view text) {
    Tolerance requested = parse_tolerance(text);
    const Tolerance default_claim = parse_tolerance(claimed_accuracy);
    if (std::isinf(requested.mm)) requested.mm = default_claim.mm;
    if (std::isinf(requested.deg)) requested.deg = default_claim.deg;
    return requested;
}

CertifyStudy certify(const Model& model, const CertifyOptions& options) {
    auto solvers = options.solvers;
    if (solvers.empty()) {
        solvers = {{.leg = Leg::equilibrium}, {.leg = Leg::energy}, {.leg = Leg::series}};
    }
    CertifyStudy study;
    study.tolerance = options.tolerance;
    std::vector<BranchSide> sides;
    for (const Branch& branch : model.branches)
        std::ranges::move(sides_of(model, branch), std::back_inserter(sides));
    std::vector<SolvedSide> solved_sides;  // the solvers of a side one after the other
    for (const BranchSide& side : sides)
        for (const SolverSettings& solver : solvers) solved_sides.push_back({side, solver});
    constexpr double solving_share = 0.1;  // share of the solves in the progress
    std::vector<Job> jobs;
    for (SolvedSide& solved : solved_sides)
        jobs.push_back(
            {fmt::format("{}: solving", solved.side.name), [&] { solve(solved, options.points); }});
    run_jobs(jobs, options.threads, part(options.progress, 0, solving_share));

    certificate::Tolerance tolerance = in_si(options.tolerance);
    tolerance.max_unknowns = certificate::max_unknowns_of_points;
    jobs.clear();
    for (SolvedSide& solved : solved_sides)
        jobs.push_back({fmt::format("{}: proving the curve", solved.side.name),
                        [&] { certify_path(solved, options); }});
    for (std::size_t first = 0; first < solved_sides.size(); first += solvers.size()) {
        const auto of_side = std::span(solved_sides).subspan(first, solvers.size());
        std::set<double> parameters;
        for (const SolvedSide& solved : of_side)
            for (const Equilibrium& state : solved.path.points)
                if (std::isfinite(state.load)) parameters.insert(state.load);
        for (const double a : parameters)
            jobs.push_back({fmt::format("{}: proving points", of_side.front().side.name),
                            [&tolerance, a, of_side] { certify_at(a, of_side, tolerance); }});
    }
    run_jobs(jobs, options.threads, part(options.progress, solving_share, 1));
    for (SolvedSide& solved : solved_sides) {
        for (std::size_t k = 0; k < solved.points.size(); ++k)
            add(solved.result.tally, solved.path.points[k].load, solved.result.unit,
                solved.points[k]);
        study.sides.push_back(std::move(solved.result));
    }
    return study;
}

int CertifyStudy::points() const {
    int sum = 0;
    for (const auto& side : sides) sum += side.tally.points;
    return sum;
}
int CertifyStudy::proved() const {
    int sum = 0;
    for (const auto& side : sides) sum += side.tally.proved;
    return sum;
}
bool CertifyStudy::excluded() const {
    return std::ranges::any_of(sides, [](const auto& side) { return side.tally.excluded > 0; });
}
bool CertifyStudy::conclusive() const {
    return proved() > 0 && std::ranges::all_of(sides, [](const CertifiedSide& side) {
               if (is_not_applicable(side.outcome)) return true;
               const bool ended = side.outcome == Outcome::converged ||
                                  (side.limit && side.limit->state == ProofState::proved);
               const bool one_curve =
                   !side.curve || !side.curve->tried || side.curve->state == ProofState::proved;
               return ended && one_curve && side.tally.points > 0 &&
                      side.tally.proved == side.tally.points;
           });
}

}  // namespace elastocheck::compare
