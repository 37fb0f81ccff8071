#include "compare/proofs/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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

CertifiedWay certify_way(const BranchSide& way, SolverSettings solver,
                         const CertifyOptions& options) {
    CertifiedWay result;
    result.branch = way.name;
    result.unit = unit_of(way.branch.unit);
    result.to = in_unit(result.unit) * way.branch.to;
    result.solver = solver_of(solver);
    solver.every = std::max(1, way.branch.steps / options.points);
    const EquilibriumPath path = walk(way, solver);
    result.outcome = path.outcome;
    result.detail = path.detail;
    for (const Equilibrium& state : path.points)
        add(result.tally, state.load, result.unit,
            certificate::certify(way.model, way.branch, state, in_si(options.tolerance)));
    if (solver.leg == Leg::equilibrium && path.points.size() > 1)
        result.curve = certificate::certify_branch(way.model, way.branch, path.points,
                                                   in_si(options.tolerance));
    // The last point starts the search for the limit point; it claims no accuracy.
    constexpr certificate::Tolerance anywhere{1, 1, 1e9, 1e9};
    if (path.outcome == Outcome::limit_point && !path.points.empty())
        result.limit =
            certificate::certify_limit_point(way.model, way.branch, path.points.back(), anywhere);
    return result;
}

}  // namespace

Tolerance claim(std::string_view text) {
    Tolerance asked = parse_tolerance(text);
    const Tolerance usual = parse_tolerance(claimed_accuracy);
    if (std::isinf(asked.mm)) asked.mm = usual.mm;
    if (std::isinf(asked.deg)) asked.deg = usual.deg;
    return asked;
}

CertifyStudy certify(const Model& model, const CertifyOptions& options) {
    auto solvers = options.solvers;
    if (solvers.empty()) {
        solvers = {{.leg = Leg::equilibrium}, {.leg = Leg::energy}, {.leg = Leg::series}};
    }
    CertifyStudy study;
    study.tolerance = options.tolerance;
    for (const Branch& branch : model.branches) {
        for (const BranchSide& way : sides_of(model, branch)) {
            for (const SolverSettings& solver : solvers) {
                if (options.progress)
                    options.progress(
                        fmt::format("{}: proving what {} finds", way.name, solver_of(solver)));
                study.ways.push_back(certify_way(way, solver, options));
            }
        }
    }
    return study;
}

int CertifyStudy::points() const {
    int sum = 0;
    for (const auto& way : ways) sum += way.tally.points;
    return sum;
}
int CertifyStudy::proved() const {
    int sum = 0;
    for (const auto& way : ways) sum += way.tally.proved;
    return sum;
}
bool CertifyStudy::excluded() const {
    return std::ranges::any_of(ways, [](const auto& way) { return way.tally.excluded > 0; });
}
bool CertifyStudy::conclusive() const {
    return proved() > 0 && std::ranges::all_of(ways, [](const CertifiedWay& way) {
               if (is_not_applicable(way.outcome)) return true;
               const bool ended = way.outcome == Outcome::converged ||
                                  (way.limit && way.limit->answer == Answer::proved);
               return ended && way.tally.points > 0 && way.tally.proved == way.tally.points;
           });
}

}  // namespace elastocheck::compare
