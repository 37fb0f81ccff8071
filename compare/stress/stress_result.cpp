// The survival of legs and methods at extremes for readers.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "compare/result/result.hpp"
#include "compare/stress/stress.hpp"

namespace elastocheck::compare {
namespace {

constexpr std::array verdicts{
    CellVerdict::right,     CellVerdict::no_claim, CellVerdict::reported_failure,
    CellVerdict::elsewhere, CellVerdict::unjudged, CellVerdict::wrong};

std::vector<ColumnOf<StressCell>> cell_columns() {
    constexpr Digits hidden = Digits::hidden;
    using C = StressCell;
    return {
        {"scene", hidden, &C::scene},
        {"sweep", hidden, &C::sweep},
        {"variant", hidden, &C::variant},
        {"side", hidden, &C::side, "of a branch, from where it begins"},
        {"solver", hidden, &C::solver},
        {"outcome", hidden, [](const C& c) { return name(c.outcome); }},
        {"verdict", hidden, [](const C& c) { return name(c.verdict); }},
        {"known by", hidden, &C::known_by, "source of the true state"},
        {"digits", hidden, &C::digits, "-log10 of the error over the range"},
        {"error", hidden, [](const C& c) { return 1e3 * c.error; }, "of any place, at most", "mm"},
        {"claim", hidden, [](const C& c) { return 1e3 * c.claim; },
         "accuracy that the solver claims; empty without a tolerance", "mm"},
        {"range", hidden, [](const C& c) { return 1e3 * c.range; },
         "largest displacement of a point; the size of the scene where nothing moves", "mm"},
        {"reason", hidden, &C::why},
        {"detail", hidden, &C::detail, "message of the solver"}};
}

// One row per scene and sweep, and per variant of an extreme scene, with a sign per solver: the
// worst of the cells.
struct MapRow {
    std::string scene, variants, signs;
};

Table map_of(const Survival& survival) {
    constexpr std::string_view worst_first = "X?~0123456789!.";
    std::vector<MapRow> rows;
    for (const auto& cell : survival.cells) {
        const std::string& variants = cell.sweep == extreme ? cell.variant : cell.sweep;
        auto row = std::ranges::find_if(rows, [&](const MapRow& other) {
            return other.scene == cell.scene && other.variants == variants;
        });
        if (row == rows.end())
            row =
                rows.insert(row, {cell.scene, variants, std::string(survival.solvers.size(), '.')});
        const auto solver = std::ranges::find(survival.solvers, cell.solver);
        char& now = row->signs[static_cast<std::size_t>(solver - survival.solvers.begin())];
        if (worst_first.find(sign(cell)) < worst_first.find(now)) now = sign(cell);
    }
    return table<MapRow>({.id = "map"},
                         {{"scene", Digits::words, &MapRow::scene},
                          {"variants", Digits::words, &MapRow::variants},
                          {"signs", Digits::words, &MapRow::signs,
                           fmt::format("one for each of {}", fmt::join(survival.solvers, " "))}},
                         rows);
}

}  // namespace

Result result_of(const Survival& survival) {
    Result result{.analysis = "stress"};
    result.tables = {
        map_of(survival), table({.id = "cells"}, cell_columns(), survival.cells),
        table<CellVerdict>(
            {.id = "counts"},
            {{"verdict", Digits::hidden, [](CellVerdict v) { return name(v); }},
             {"cells", Digits::hidden, [&](CellVerdict v) { return survival.count(v); }}},
            verdicts)};
    result.notes.push_back(fmt::format(
        "One sign for each of {}, the worst of the variants:\n"
        "  0 ... 9  correct digits of the range of motion (9: nine or more)    !  reported as "
        "failed each time\n"
        "  ~  another proved equilibrium    ?  converged, not judged    X  WRONG    .  not run\n",
        fmt::join(survival.solvers, " ")));
    for (const auto& cell : survival.cells)
        if (cell.verdict == CellVerdict::wrong)
            result.notes.push_back(fmt::format("WRONG: {}, {}, {}: {}: {}", cell.scene,
                                               cell.variant, cell.side, cell.solver, cell.why));
    std::string counts;
    for (const auto verdict : verdicts)
        counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", survival.count(verdict),
                              name(verdict));
    result.verdict = {.grade = survival.count(CellVerdict::wrong) > 0 ? Grade::fail
                               : survival.judged() == 0               ? Grade::not_judged
                                                                      : Grade::pass,
                      .sentence = fmt::format("{}: {} cells", counts, survival.cells.size()),
                      .compared = survival.judged()};
    return result;
}

}  // namespace elastocheck::compare
