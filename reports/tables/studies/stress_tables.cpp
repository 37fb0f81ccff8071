#include "reports/tables/studies/stress_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "reports/tables/render.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::CellVerdict;
using compare::finite_or_nan;
using compare::Survival;

constexpr std::array verdicts{
    CellVerdict::right,     CellVerdict::no_claim, CellVerdict::reported_failure,
    CellVerdict::elsewhere, CellVerdict::unjudged, CellVerdict::wrong};
constexpr std::size_t terminal_width = 118;  // of a terminal

compare::Column words(std::string name, std::string description = {}) {
    return {std::move(name), {}, std::move(description), true};
}

std::string signs(const Survival& survival, const std::string& scene, const std::string& sweep,
                  const std::string& variant = {}) {
    std::string all;
    for (const auto& solver : survival.solvers)
        all += sign(survival, scene, sweep, solver, variant);
    return all;
}

// Rows of the map: scenes by sweep, and the variants of extreme scenes.
struct Rows {
    std::vector<std::string> scenes, sweeps;
    std::vector<std::pair<std::string, std::string>> extremes;  // scene, variant
};
Rows rows_of(const Survival& survival) {
    Rows rows;
    for (const auto& sweep : survival.sweeps)
        if (sweep != compare::extreme) rows.sweeps.push_back(sweep);
    for (const auto& cell : survival.cells) {
        if (cell.sweep == compare::extreme) {
            const std::pair row{cell.scene, cell.variant};
            if (std::ranges::find(rows.extremes, row) == rows.extremes.end())
                rows.extremes.push_back(row);
        } else if (std::ranges::find(rows.scenes, cell.scene) == rows.scenes.end()) {
            rows.scenes.push_back(cell.scene);
        }
    }
    return rows;
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
         {"apart", "mm", "distance from the result of the untransformed scene"},
         {"error", "mm", "of any place, at most"},
         {"claim", "mm", "accuracy that the solver claims; empty without a tolerance"},
         {"range", "mm",
          "largest displacement of a point; the size of the scene where nothing moves"},
         words("reason"),
         words("detail", "message of the solver")},
        {}};
    for (const auto& c : survival.cells)
        table.rows.push_back({c.scene, c.sweep, c.variant, c.side, c.solver, name(c.outcome),
                              name(c.verdict), name(c.knowledge), c.digits, 1e3 * c.apart,
                              1e3 * c.error, finite_or_nan(1e3 * c.claim), 1e3 * c.range, c.why,
                              c.detail});
    return table;
}

std::string stress_text(const Survival& survival) {
    std::string text;
    const auto out = std::back_inserter(text);
    const Rows rows = rows_of(survival);
    std::size_t head = 0;
    for (const auto& scene : rows.scenes) head = std::max(head, scene.size());
    std::size_t column = survival.solvers.size();
    for (const auto& sweep : rows.sweeps) column = std::max(column, sweep.size());
    const std::size_t at_once = std::max<std::size_t>(1, (terminal_width - head) / (column + 2));
    for (std::size_t first = 0; first < rows.sweeps.size(); first += at_once) {
        const std::size_t last = std::min(first + at_once, rows.sweeps.size());
        fmt::format_to(out, "{:<{}}", "", head);
        for (std::size_t s = first; s < last; ++s)
            fmt::format_to(out, "  {:<{}}", rows.sweeps[s], column);
        text += '\n';
        for (const auto& scene : rows.scenes) {
            fmt::format_to(out, "{:<{}}", scene, head);
            for (std::size_t s = first; s < last; ++s)
                fmt::format_to(out, "  {:<{}}", signs(survival, scene, rows.sweeps[s]), column);
            text += '\n';
        }
        text += '\n';
    }
    std::size_t row_head = 0;
    for (const auto& [scene, variant] : rows.extremes)
        row_head = std::max(row_head, scene.size() + variant.size() + 2);
    for (const auto& [scene, variant] : rows.extremes)
        fmt::format_to(out, "{:<{}}  {}\n", scene + ", " + variant, row_head,
                       signs(survival, scene, std::string(compare::extreme), variant));
    if (!rows.extremes.empty()) text += '\n';
    text += "One sign for each of";
    for (const auto& solver : survival.solvers) fmt::format_to(out, " {}", solver);
    text +=
        ", the worst of all variants of a sweep:\n"
        "  0 ... 9  correct digits of the range of motion (9: nine or more)    !  reported as "
        "failed each time\n"
        "  ~  another proved equilibrium    ?  converged, not judged    X  WRONG    .  not run\n";
    text += '\n';
    for (const auto verdict : verdicts)
        fmt::format_to(out, "{} {}{}", survival.count(verdict), name(verdict),
                       verdict == verdicts.back() ? "" : ", ");
    fmt::format_to(out, ": {} cells\n", survival.cells.size());
    for (const auto& s : survival.skipped)
        fmt::format_to(out, "not run: {}, {}: {}\n", s.scene, s.variant, s.why);
    for (const auto& cell : survival.cells)
        if (cell.verdict == CellVerdict::wrong)
            fmt::format_to(out, "WRONG: {}: {}\n", where(cell), cell.why);
    return text;
}

json stress_json(const Survival& survival) {
    json map = json::array(), extremes = json::array(), counts = json::object(),
         skipped = json::array();
    const Rows rows = rows_of(survival);
    for (const auto& scene : rows.scenes) {
        json row = json::array();
        for (const auto& sweep : rows.sweeps) row.push_back(signs(survival, scene, sweep));
        map.push_back({{"scene", scene}, {"signs", row}});
    }
    for (const auto& [scene, variant] : rows.extremes)
        extremes.push_back(
            {{"scene", scene},
             {"variant", variant},
             {"signs", signs(survival, scene, std::string(compare::extreme), variant)}});
    for (const auto verdict : verdicts) counts[name(verdict)] = survival.count(verdict);
    for (const auto& s : survival.skipped)
        skipped.push_back(
            {{"scene", s.scene}, {"sweep", s.sweep}, {"variant", s.variant}, {"why", s.why}});
    json wrong = json::array();
    for (const auto& c : survival.cells)
        if (c.verdict == CellVerdict::wrong)
            wrong.push_back({{"scene", c.scene},
                             {"variant", c.variant},
                             {"way", c.side},
                             {"solver", c.solver},
                             {"why", c.why}});
    return {{"solvers", survival.solvers},
            {"sweeps", rows.sweeps},
            {"map", map},
            {"extremes", extremes},
            {"counts", counts},
            {"wrong", wrong},
            {"skipped", skipped},
            {"cells", table_json(cell_table(survival))}};
}

}  // namespace elastocheck::reports
