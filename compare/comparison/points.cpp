#include "compare/comparison/points.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/outputs/not_a_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace elastocheck::compare {
namespace {

// Whether two branches lie on different sides of a = 0, so that a point without the name of its branch
// belongs to at most one.
bool on_opposite_sides(const Branch& a, const Branch& b) {
    const auto low = [](const Branch& x) { return std::min(x.from, x.to); };
    const auto high = [](const Branch& x) { return std::max(x.from, x.to); };
    return high(a) <= 0 ? low(b) >= 0 : low(a) >= 0 && high(b) <= 0;
}

}  // namespace

std::vector<PointColumn> as_absolute_values(const Model& model, const Comparison& comparison,
                                            std::vector<PointColumn> columns) {
    if (std::ranges::none_of(columns, &PointColumn::change)) return columns;
    const auto drawn = evaluate(model, comparison.channels, design_state(model));
    for (auto& column : columns) {
        if (column.change)
            for (double& value : column.values) value += drawn[column.channel];
        column.change = false;
    }
    return columns;
}

std::vector<double> abscissa_values(const Curve& curve, std::optional<std::size_t> channel) {
    auto over = channel ? curve.channel(*channel) : curve.a;
    if (!trend(over).monotonic()) over.clear();
    return over;
}

bool reaches(const std::vector<double>& values, double x) {
    if (values.empty()) return false;
    // A driven end, and the start of a branch, have this value in every leg up to rounding.
    const double rounding = 1e-9 * std::abs(values.back() - values.front());
    return x >= std::min(values.front(), values.back()) - rounding &&
           x <= std::max(values.front(), values.back()) + rounding;
}

std::vector<int> branches_of(const Model& model, const Comparison& comparison,
                             const std::vector<std::string>& names, const std::vector<double>& x,
                             std::optional<std::size_t> channel) {
    const auto& branches = comparison.branches;
    std::vector<int> positions;
    if (!names.empty()) {
        for (const auto& name : names) {
            const auto match = std::ranges::find(branches, name, &BranchComparison::branch);
            if (match == branches.end())
                throw std::invalid_argument(fmt::format("the scene has no branch '{}'", name));
            positions.push_back(static_cast<int>(match - branches.begin()));
        }
        return positions;
    }
    std::vector<std::vector<double>> x_of_branches;  // empty: no point lies on the branch
    for (const auto& branch : branches)
        x_of_branches.push_back(abscissa_values(branch.run(Leg::equilibrium).curve, channel));
    for (std::size_t a = 0; a < branches.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
            if (!x_of_branches[a].empty() && !x_of_branches[b].empty() &&
                !on_opposite_sides(model.branches[a], model.branches[b]))
                throw std::invalid_argument(
                    fmt::format("branches '{}' and '{}' are on the same side; each point needs the "
                                "name of its branch",
                                branches[b].branch, branches[a].branch));
    for (const double place : x) {
        const auto match = std::ranges::find_if(
            x_of_branches,
            [&](const std::vector<double>& of_branch) { return reaches(of_branch, place); });
        positions.push_back(
            match == x_of_branches.end() ? -1 : static_cast<int>(match - x_of_branches.begin()));
    }
    return positions;
}

std::vector<Place> places_of(const Model& model, const Comparison& comparison,
                             const Points& points) {
    std::vector<Place> places(std::max(points.a.size(), points.at.size()));
    for (const bool by_parameter : {true, false}) {
        std::vector<double> x(places.size(), nan);
        for (std::size_t k = 0; k < places.size(); ++k) {
            const bool has_parameter = k < points.a.size() && std::isfinite(points.a[k]);
            if (has_parameter == by_parameter)
                x[k] = by_parameter ? points.a[k] : k < points.at.size() ? points.at[k] : nan;
        }
        if (std::ranges::none_of(x, [](double v) { return std::isfinite(v); })) continue;
        const auto branch = branches_of(model, comparison, points.branch, x,
                                        by_parameter ? std::nullopt : points.abscissa);
        for (std::size_t k = 0; k < places.size(); ++k)
            if (std::isfinite(x[k])) places[k] = {branch[k], by_parameter, x[k]};
    }
    return places;
}

}  // namespace elastocheck::compare
