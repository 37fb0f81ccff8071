#include "reports/command/options/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "elastocheck/channels.hpp"
#include "models/branch.hpp"

namespace elastocheck::reports {
namespace {

// Memory of one point: parameter, |Φ|, the outputs in a separate block, the reserve of growth.
double bytes_per_row(std::size_t channels, bool written) {
    // Measured on the McPherson strut: a written number takes 270 bytes more, for JSON, its text,
    // and a line of curves.csv.
    constexpr double in_document = 270;
    const auto numbers = static_cast<double>(channels + 2);
    constexpr double overhead = 2 * (sizeof(double) + sizeof(std::vector<double>));
    return overhead + numbers * (sizeof(double) + (written ? in_document : 0));
}

double points_of(const Branch& branch, const RunSize& run) {
    return 1.0 + (run.steps > 0 ? run.steps : branch.steps) / run.every;
}

// `bytes`: of one point; `subject`: the points, for the message.
void check(double points, double bytes, double steps_per_branch, const std::string& subject) {
    if (points * bytes <= max_memory) return;
    throw std::invalid_argument(fmt::format(
        "{} would take about {:.1f} GB; allowed: {:.0f} GB, which is {:.0f} steps a branch",
        subject, 1e-9 * points * bytes, 1e-9 * max_memory,
        std::floor(steps_per_branch * max_memory / (points * bytes)) - 1));
}

}  // namespace

void check_memory(const Model& model, const RunSize& run) {
    double points = 0;
    for (const auto& branch : model.branches) points += points_of(branch, run);
    const auto branches = static_cast<double>(std::max<std::size_t>(1, model.branches.size()));
    const std::size_t channels = run.channels > 0 ? run.channels : compare::channels(model).size();
    check(points, run.legs * bytes_per_row(channels, run.written), run.every * points / branches,
          fmt::format("{:.0f} points on {} branches, by {} of the legs,", points,
                      model.branches.size(), run.legs));
}

void check_memory_of_rows(const Model& model, const RunSize& run, std::size_t channels) {
    for (Branch branch : model.branches) {
        if (run.steps > 0) branch.steps = run.steps;
        const auto sides = branch_sides(branch);
        if (sides.size() < 2) continue;
        const double points = points_of(sides.front(), {.every = run.every});
        check(
            points, bytes_per_row(channels, false), branch.steps,
            fmt::format("{:.0f} points of branch '{}' that come in reverse", points, branch.name));
    }
}

void check_every(const Model& model, int steps, int every) {
    for (const auto& branch : model.branches)
        if (const int count = steps > 0 ? steps : branch.steps; every > count)
            throw std::invalid_argument(
                fmt::format("--every {}: branch '{}' has {} steps; allowed: 1 to as many", every,
                            branch.name, count));
}

}  // namespace elastocheck::reports
