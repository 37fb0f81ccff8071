// Kinematics and compliance as tables.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "compare/comparison/characteristics.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/tables/table.hpp"

namespace elastocheck::compare {
namespace {

Column words(std::string name, std::string description = "") {
    return {std::move(name), "", std::move(description), true};
}

// At a = 0, as a leg has it.
double at_start(const LegRun& run, std::size_t channel) {
    return run.curve.values.empty() ? nan : run.curve.values[run.curve.start][channel];
}

constexpr std::array directions{"x", "y", "z"};
std::string component(const char* what, Eigen::Index k) {
    return fmt::format("{} {}", what, directions[static_cast<std::size_t>(k % 3)]);
}

}  // namespace

Table characteristic_table(const Comparison& comparison) {
    Table table{"characteristics",
                {words("output"),
                 words("unit"),
                 {"value", "",
                  "at a = 0 of the first branch, by the equilibrium leg; none if it is undefined"},
                 {"references apart", "", "second reference less equilibrium leg"},
                 {"recursion", "", "by the matrix that the recursion factorises there"},
                 {"off", "", "recursion less equilibrium leg"},
                 {"off %", "%", "of the value"},
                 words("undefined", "reason for a missing value"),
                 words("definition")},
                {}};
    if (comparison.branches.empty()) return table;
    const BranchComparison& branch = comparison.branches.front();
    const auto run = [&](Leg leg) -> const LegRun& {
        return branch.runs[static_cast<std::size_t>(leg)];
    };
    for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
        const Channel& channel = comparison.channels[c];
        if (!std::holds_alternative<Characteristic>(channel.reads)) continue;
        const double is = at_start(run(Leg::equilibrium), c),
                     second = at_start(run(branch.second), c),
                     recursion = at_start(run(Leg::recursive), c);
        table.rows.push_back({channel.name, symbol(channel.unit), finite_or_nan(is),
                              finite_or_nan(second - is), finite_or_nan(recursion),
                              finite_or_nan(recursion - is),
                              finite_or_nan(100 * (recursion - is) / std::abs(is)),
                              is == undefined ? channel.undefined : "", channel.definition});
    }
    return table;
}

Table compliance_table(const Model& model, const Comparison& comparison) {
    Table table{
        "compliance",
        {words("branch"),
         {"a", "", "parameter of the branch"},
         words("unit", "of a"),
         words("leg"),
         words("point",
               "where forces act and displacements are read: wheel centre or contact patch"),
         words("wheel", "whose displacement is given"),
         words("answer",
               "displacement of the point in mm, rotation of the wheel in deg, ground axes"),
         words("loaded wheel", "on which forces and moments act, all jacks and tyres removed")},
        {}};
    for (Eigen::Index k = 0; k < 6; ++k)
        table.columns.push_back({component(k < 3 ? "force" : "moment", k), "",
                                 k < 3 ? "response per kN" : "response per 100 N·m"});
    table.columns.push_back({"reciprocity", "",
                             "|C - Cᵀ| / |C| of the whole matrix at the wheel centres, rotations "
                             "counted by the tyre's radius"});
    for (const auto& branch : comparison.branches)
        for (const auto& run : branch.runs)
            for (const auto& at : run.compliance)
                for (const double per_si = in_unit(run.curve.unit);
                     const auto& [point, C] :
                     {std::pair{"wheel centre", &at.centre}, {"contact patch", &at.patch}})
                    for (Eigen::Index r = 0; r < C->rows(); ++r)
                        for (Eigen::Index loaded = 0; loaded < C->cols(); loaded += 6) {
                            const auto wheel = [&](Eigen::Index k) {
                                return model.wheels[static_cast<std::size_t>(k / 6)].name;
                            };
                            const bool moves = r % 6 < 3;
                            std::vector<Cell> row{branch.branch,
                                                  parameter_in(run.curve.unit, at.a / per_si),
                                                  symbol(run.curve.unit),
                                                  name(run.leg),
                                                  point,
                                                  wheel(r),
                                                  component(moves ? "displacement" : "rotation", r),
                                                  wheel(loaded)};
                            for (Eigen::Index k = 0; k < 6; ++k)
                                row.emplace_back(in_table_units(*C, r, loaded + k));
                            row.emplace_back(at.reciprocity);
                            table.rows.push_back(std::move(row));
                        }
    return table;
}

}  // namespace elastocheck::compare
