#include "reports/command/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compare/channels.hpp"

namespace elastocheck::reports {

double bytes_per_point(const Model& model, bool written) {
    const auto numbers = static_cast<double>(compare::channels(model).size() + 2);
    const double state = sizeof(Equilibrium) + static_cast<double>(model.bodies.size()) * sizeof(Pose) +
                         static_cast<double>(model.joints.size()) * sizeof(Wrench);
    // Measured on the McPherson strut: 1.7 kB a point in all, and written 270 bytes a number on top: JSON,
    // its text, a line of curves.csv, each grown by doubling.
    constexpr double as_text = 32, in_document = 270;
    return state + numbers * (sizeof(double) + as_text) + (written ? numbers * in_document : 0);
}

void check_memory(const Model& model, int steps, int legs, bool written) {
    double points = 0;
    for (const auto& branch : model.branches) points += 1.0 + (steps > 0 ? steps : branch.steps);
    const double each = legs * bytes_per_point(model, written), needed = points * each;
    if (needed <= most_memory) return;
    const double allowed =
        most_memory / (each * static_cast<double>(std::max<std::size_t>(1, model.branches.size())));
    throw std::invalid_argument(fmt::format(
        "{:.0f} points on {} branches, by {} of the legs, would take about {:.1f} GB; allowed: {:.0f} "
        "GB, which is {:.0f} steps a branch",
        points, model.branches.size(), legs, 1e-9 * needed, 1e-9 * most_memory, std::floor(allowed) - 1));
}

}  // namespace elastocheck::reports
