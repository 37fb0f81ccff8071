// Residuals of a state from any leg in the conditions of this leg.
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "elastocheck/energy.hpp"
#include "models/branch.hpp"
#include "models/kinds.hpp"
#include "reference/energy/constraints/balance.hpp"
#include "reference/energy/potential/conservative.hpp"
#include "reference/energy/potential/recentre.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::VectorXd;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double max_or_nan(double a, double b) {
    return std::isnan(a) || std::isnan(b) ? unknown : std::max(a, b);
}

}  // namespace

Residuals residuals(const Model& given_model, const Branch& branch,
                    const Equilibrium& given_state) {
    if (!fits_branch(given_model, branch))
        throw std::invalid_argument("the model has parts that are inactive on branch '" +
                                    branch.name + "', or the branch has two sides");
    if (given_state.poses.size() != given_model.bodies.size())
        return {unknown, unknown, unknown, unknown};
    const Eigen::Vector3d centre = centre_of(given_model);
    const Model model = about(given_model, centre);
    Equilibrium state = given_state;
    state.poses = moved_by(std::move(state.poses), -centre);
    const Chart chart = chart_about(state.poses);
    const Course course = course_of(model, branch);
    const Prescribed prescribed = at(course, state.load);
    const Scales scales = lengths_of(model, course);
    const ConstraintValues values = constraints(model, prescribed, chart);
    const VectorXd S = scales.coordinates(coordinates(model));
    const VectorXd gradient =
        project_gradient(scaled(values.Phi_q, scales.rows(model), S),
                         S.cwiseProduct(potential(model, prescribed, chart).gradient))
            .gradient;

    Residuals worst;
    int row = 0;
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        const auto& kind = model.constraints[k].kind;
        double error = largest(values.Phi.segment(row, rows(kind)));
        // Φ of a length or an angle is also zero on the mirrored side.
        const double given = own_offset(kind) + prescribed.offset[static_cast<Eigen::Index>(k)];
        if (const auto measured = measured_offset(kind, chart)) {
            const double off = *measured - given;
            error = max_or_nan(
                error, std::abs(is_angle(kind) ? std::remainder(off, 2 * std::numbers::pi) : off));
        }
        double& worst_of_kind = is_direction(kind) ? worst.direction : worst.length;
        worst_of_kind = max_or_nan(worst_of_kind, error);
        row += rows(kind);
    }
    // An orientation counts as a direction too: it must be a unit quaternion.
    for (const auto& pose : state.poses)
        worst.direction = max_or_nan(worst.direction, std::abs(pose.p.norm() - 1));
    if (why_not_conservative(model, branch) ||
        !within_laws(model, turning_bushings(model, course), state.poses))
        worst.force = worst.moment = unknown;
    for (std::size_t b = 0; b < state.poses.size(); ++b) {
        const int at = 6 * static_cast<int>(b);
        worst.force = max_or_nan(worst.force, largest(gradient.segment<3>(at)) / scales.length);
        worst.moment = max_or_nan(worst.moment, largest(gradient.segment<3>(at + 3)));
    }
    return worst;
}

}  // namespace elastocheck::reference::energy
