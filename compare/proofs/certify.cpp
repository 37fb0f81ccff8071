#include "compare/proofs/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

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

CertifiedSide certify_side(const BranchSide& side, SolverSettings solver,
                           const CertifyOptions& options,
                           std::vector<certificate::ProvedBox>& known) {
    CertifiedSide result;
    result.branch = side.name;
    result.unit = unit_of(side.branch.unit);
    result.to = in_unit(result.unit) * side.branch.to;
    result.solver = solver_of(solver);
    solver.every = std::max(1, side.branch.steps / options.points);
    const EquilibriumPath path = solve_branch(side, solver);
    result.outcome = path.outcome;
    result.detail = path.detail;
    for (const Equilibrium& state : path.points)
        add(result.tally, state.load, result.unit,
            certificate::certify(side.model, side.branch, state, in_si(options.tolerance), known));
    if (options.curves && solver.leg == Leg::equilibrium && path.points.size() > 1)
        result.curve = certificate::certify_branch(side.model, side.branch, path.points,
                                                   in_si(options.tolerance));
    // The last point starts the search for the limit point; it claims no accuracy.
    constexpr certificate::Tolerance anywhere{1, 1, 1e9, 1e9};
    if (path.outcome == Outcome::limit_point && !path.points.empty())
        result.limit =
            certificate::certify_limit_point(side.model, side.branch, path.points.back(), anywhere);
    return result;
}

}  // namespace

Tolerance claim(std::string_view text) {
    Tolerance requested = parse_tolerance(text);
    const Tolerance usual = parse_tolerance(claimed_accuracy);
    if (std::isinf(requested.mm)) requested.mm = usual.mm;
    if (std::isinf(requested.deg)) requested.deg = usual.deg;
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
    study.sides.resize(sides.size() * solvers.size());
    std::vector<Job> jobs;
    for (std::size_t w = 0; w < sides.size(); ++w)
        jobs.push_back({fmt::format("{}: proving what the solvers find", sides[w].name), [&, w] {
                            std::vector<certificate::ProvedBox> known;
                            for (std::size_t s = 0; s < solvers.size(); ++s)
                                study.sides[w * solvers.size() + s] =
                                    certify_side(sides[w], solvers[s], options, known);
                        }});
    run_jobs(jobs, options.threads, options.progress);
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
               const bool one_curve = !side.curve || side.curve->state == ProofState::proved;
               return ended && one_curve && side.tally.points > 0 &&
                      side.tally.proved == side.tally.points;
           });
}

}  // namespace elastocheck::compare
