#include "reports/tables/studies/stress_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "reports/render/render.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::CellVerdict;
using compare::finite_or_nan;
using compare::Survival;

constexpr std::array verdicts{
    CellVerdict::right,     CellVerdict::no_claim, CellVerdict::reported_failure,
    CellVerdict::elsewhere, CellVerdict::unjudged, CellVerdict::wrong};

compare::Column words(std::string name, std::string description = {}) {
    return {std::move(name), {}, std::move(description), true};
}

std::string where(const compare::StressCell& cell) {
    return fmt::format("{}, {}, {}: {}", cell.scene, cell.variant, cell.side, cell.solver);
}

}  // namespace

compare::Table cell_table(const Survival& survival) {
    compare::Table table{
        {words("scene"),
         words("sweep"),
         words("variant"),
         words("way", "of a branch, from where it begins"),
         words("solver"),
         words("outcome"),
         words("verdict"),
         words("known by", "source of the true state"),
         {"digits", "", "-log10 of the error over the range"},
         {"error", "mm", "of any place, at most"},
         {"claim", "mm", "accuracy that the solver claims; empty without a tolerance"},
         {"range", "mm",
          "largest displacement of a point; the size of the scene where nothing moves"},
         words("reason"),
         words("detail", "message of the solver")},
        {}};
    for (const auto& c : survival.cells)
        table.rows.push_back({c.scene, c.sweep, c.variant, c.side, c.solver, name(c.outcome),
                              name(c.verdict), c.known_by, c.digits, 1e3 * c.error,
                              finite_or_nan(1e3 * c.claim), 1e3 * c.range, c.why, c.detail});
    return table;
}

compare::Table map_table(const Survival& survival) {
    constexpr std::string_view worst_first = "X?~0123456789!.";
    compare::Table table{};
    for (const char* name : {"scene", "variants", "signs"})
        table.columns.push_back({name, {}, {}, true, Digits::words});
    for (const auto& cell : survival.cells) {
        const std::string& variants = cell.sweep == compare::extreme ? cell.variant : cell.sweep;
        const auto is_row = [&](const auto& row) {
            return row[0] == compare::Cell(cell.scene) && row[1] == compare::Cell(variants);
        };
        auto row = std::ranges::find_if(table.rows, is_row);
        if (row == table.rows.end())
            row = table.rows.insert(
                row, {cell.scene, variants, std::string(survival.solvers.size(), '.')});
        const auto solver = std::ranges::find(survival.solvers, cell.solver);
        char& now = std::get<std::string>(
            (*row)[2])[static_cast<std::size_t>(solver - survival.solvers.begin())];
        if (worst_first.find(sign(cell)) < worst_first.find(now)) now = sign(cell);
    }
    return table;
}

std::string stress_text(const Survival& survival) {
    std::string result = text(map_table(survival)) + "\nOne sign for each of";
    const auto out = std::back_inserter(result);
    for (const auto& solver : survival.solvers) fmt::format_to(out, " {}", solver);
    result +=
        ", the worst of the variants:\n"
        "  0 ... 9  correct digits of the range of motion (9: nine or more)    !  reported as "
        "failed each time\n"
        "  ~  another proved equilibrium    ?  converged, not judged    X  WRONG    .  not run\n\n";
    for (const auto verdict : verdicts)
        fmt::format_to(out, "{} {}{}", survival.count(verdict), name(verdict),
                       verdict == verdicts.back() ? "" : ", ");
    fmt::format_to(out, ": {} cells\n", survival.cells.size());
    for (const auto& cell : survival.cells)
        if (cell.verdict == CellVerdict::wrong)
            fmt::format_to(out, "WRONG: {}: {}\n", where(cell), cell.why);
    return result;
}

json stress_json(const Survival& survival) {
    json counts = json::object();
    for (const auto verdict : verdicts) counts[name(verdict)] = survival.count(verdict);
    return {{"solvers", survival.solvers},
            {"map", table_json(map_table(survival))},
            {"counts", counts},
            {"cells", table_json(cell_table(survival))}};
}

}  // namespace elastocheck::reports
