#include <cmath>

#include "compare/comparison/legs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

std::vector<DefinitionRow> definition_rows(const Model& model, const Comparison& comparison) {
    std::vector<DefinitionRow> rows;
    const auto defined = definition_channels(model);
    // outputs in pairs: the figure as defined here, and otherwise
    std::vector<Channel> pairs;
    for (const Channel& figure : comparison.channels)
        for (const Channel& other : definitions_of(defined, figure.name))
            if (other.unit == figure.unit) pairs.insert(pairs.end(), {figure, other});
    if (pairs.empty()) return rows;
    for (std::size_t b = 0; b < comparison.branches.size(); ++b) {
        const BranchComparison& compared = comparison.branches[b];
        const Branch& branch = model.branches[b];
        const PathCurve path =
            solve_branch(model, pairs, branch, sides_of(model, branch, compared.steps),
                         {.leg = Leg::equilibrium});
        for (std::size_t p = 0; p + 1 < pairs.size(); p += 2) {
            const auto figure =
                static_cast<std::size_t>(find_channel(comparison.channels, pairs[p].name));
            DefinitionRow row{.branch = compared.branch,
                              .output = pairs[p + 1].name,
                              .unit = symbol(pairs[p].unit),
                              .parameter_unit = symbol(compared.unit),
                              .formula = pairs[p + 1].definition};
            const auto &here = path.curve.channel(p), &otherwise = path.curve.channel(p + 1);
            bool any = false;
            for (std::size_t k = 0; k < here.size(); ++k) {
                const double difference = otherwise[k] - here[k];
                if (!std::isfinite(difference)) continue;
                any = true;
                if (k == path.curve.start) row.drawn = difference;
                if (!(std::abs(difference) <= std::abs(row.difference))) {
                    row.difference = difference;
                    row.at = path.curve.a[k];
                }
            }
            if (!any) continue;
            const auto& deviations = compared.deviation.equal_parameter.channels;
            if (figure < deviations.size()) row.deviation = finite_or_nan(deviations[figure].max);
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

}  // namespace elastocheck::compare
