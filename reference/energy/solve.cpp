#include "elastocheck/energy.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "models/branch.hpp"
#include "models/parameter_unit.hpp"
#include "reference/energy/constraints/reactions.hpp"
#include "reference/energy/minimise/cost.hpp"
#include "reference/energy/minimise/settle.hpp"
#include "reference/energy/potential/conservative.hpp"
#include "reference/energy/potential/recentre.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::VectorXd;

Equilibrium equilibrium(const Path& path, const State& state) {
    const Chart chart = chart_about(state.poses);
    const ConstraintValues values = constraints(path.model, at(path.course, state.a), chart);
    const VectorXd lambda =
        path.scales.energy() * path.scales.rows(path.model).cwiseProduct(state.balance.lambda);
    return {state.a, state.poses, reactions(path.model, chart, values, lambda), values.Phi.norm()};
}

// Detects a link whose length would not be positive.
std::optional<Failure> impossible_length(const Path& path, double a) {
    const Prescribed prescribed = at(path.course, a);
    for (std::size_t k = 0; k < path.model.constraints.size(); ++k) {
        const auto& constraint = path.model.constraints[k];
        const auto* distance = std::get_if<DistanceBetween>(&constraint.kind);
        if (!distance) continue;
        const double length = distance->length + prescribed.offset[static_cast<Eigen::Index>(k)];
        if (!(length > 0))
            return Failure{
                Outcome::inconsistent_constraints,
                fmt::format("joint '{}' would have the length {:.6g} mm",
                            path.model.joints[static_cast<std::size_t>(constraint.joint)].name,
                            1e3 * length)};
    }
    return {};
}

// Reason for the end of the branch before a: a joint that cannot be closed there takes precedence.
Failure reason(const Path& path, const State& last, double a, const Failure& failure) {
    const bool may_open =
        !path.course.rate.offset.isZero(0) &&
        (failure.outcome == Outcome::branch_lost || failure.outcome == Outcome::limit_point ||
         failure.outcome == Outcome::bifurcation_point ||
         failure.outcome == Outcome::iteration_limit);
    if (may_open)
        if (const auto joint = contradicting_joint(path, a, last.poses))
            return {Outcome::inconsistent_constraints,
                    fmt::format("joint '{}' cannot be closed", *joint)};
    return failure;
}

}  // namespace

EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> values,
                      const Options& options, const PointVisitor& visit) {
    if (!fits_branch(model, branch))
        throw std::invalid_argument("the model has parts that are inactive on branch '" +
                                    branch.name + "', or the branch has two sides");
    EquilibriumPath result;
    if (const auto culprit = why_not_conservative(model, branch)) {
        result.outcome = Outcome::not_conservative;
        result.detail = fmt::format("branch '{}': {}", branch.name, *culprit);
        return result;
    }
    if (const double operations = cost_of(model, values.size()).operations();
        operations > options.operation_limit) {
        result.outcome = Outcome::too_large;
        result.detail = fmt::format(
            "branch '{}': about {:.1g} operations for {} coordinates, the limit of the energy leg "
            "is {:.1g}",
            branch.name, operations, coordinates(model), options.operation_limit);
        return result;
    }
    const auto fail = [&](const Failure& failure, const std::string& where,
                          const std::string& reached) {
        result.outcome = failure.outcome;
        result.detail =
            fmt::format("branch '{}', {}: {}{}", branch.name, where, failure.what, reached);
        return result;
    };
    const auto in_units = [&](double a) { return parameter_text(branch.unit, a, 10); };

    std::vector<double> ends(values.begin(), values.end());
    ends.push_back(branch.to);
    const Eigen::Vector3d centre = centre_of(model);
    const Model here = about(model, centre);
    const Course course = course_of(here, branch);
    double span = 0;
    for (const double a : ends)
        if (std::isfinite(a)) span = std::max(span, std::abs(a));
    Path path{
        here, options,      scales_of(here, course, ends), course, turning_bushings(here, course),
        span, result.counts};

    const std::string settling = "settling from the design pose";
    if (const auto failure = impossible_length(path, 0)) return fail(*failure, settling, "");
    State settled;
    if (const auto failure = settle(path, settled)) return fail(*failure, settling, "");
    path.start_modes = settled.modes;
    Continuation continuation = start_continuation(path, settled);
    for (const double a : values) {
        if (!std::isfinite(a))
            return fail({Outcome::not_finite, "the value is not finite"}, "at " + in_units(a), "");
        const std::string reached = "; the last equilibrium found is at ";
        if (const auto failure = impossible_length(path, a))
            return fail(*failure, "at " + in_units(a), reached + in_units(continuation.state.a));
        if (const auto failure = advance(path, continuation, a))
            return fail(reason(path, continuation.state, a, *failure), "at " + in_units(a),
                        reached + in_units(continuation.state.a));
        Equilibrium point = equilibrium(path, continuation.state);
        point.poses = moved_by(std::move(point.poses), centre);
        if (visit)
            visit(point);
        else
            result.points.push_back(std::move(point));
    }
    return result;
}

}  // namespace elastocheck::reference::energy
