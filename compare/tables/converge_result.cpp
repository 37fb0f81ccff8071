// The convergence of methods over the number of steps, and of the series over its order, for readers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "compare/result/result.hpp"
#include "compare/studies/converge.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::compare {
namespace {

// Levels side by side: one row per method, or method and output, one column per step count. For
// readers alone.
Table over_steps(const std::vector<StepRow>& levels, bool by_output, double StepRow::*value,
                 const char* unit) {
    Table wide;
    for (const char* key : {"method", "output", "unit"})
        if (by_output || wide.columns.empty())
            wide.columns.push_back({.name = key, .words = true, .digits = Digits::words});
    const std::size_t keys = wide.columns.size();
    const auto steps = distinct(levels, &StepRow::steps);
    for (const double n : steps)
        wide.columns.push_back(
            {.name = fmt::format("{:g}", n), .unit = unit, .digits = Digits::size});
    for (const auto& level : levels) {
        std::vector<Cell> row{level.method, level.output, level.unit};
        row.resize(keys);
        auto into = std::ranges::find_if(wide.rows, [&](const auto& other) {
            return std::equal(row.begin(), row.end(), other.begin());
        });
        if (into == wide.rows.end()) {
            row.resize(keys + steps.size(), nan);
            into = wide.rows.insert(into, std::move(row));
        }
        const auto at = std::ranges::find(steps, level.steps) - steps.begin();
        (*into)[keys + static_cast<std::size_t>(at)] = level.*value;
    }
    return wide;
}

// `id_prefix`: of the ids of its tables, "candidate_" for a candidate.
void add(Result& result, const Study& study, const std::vector<BranchAttribution>& attribution,
         const std::string& id_prefix) {
    const auto outputs = study_rows(study);
    const auto steps = step_rows(study);
    const auto gaps = gap_rows(study.channels, attribution);
    const auto part = [&](const std::string& id, Table table, std::string caption) {
        table.id = id.empty() ? "" : id_prefix + id;
        table.caption = (id_prefix.empty() || caption.empty() ? "" : "the candidate, ") + caption;
        result.tables.push_back(std::move(table));
    };
    for (const auto& branch : distinct(outputs, &StudyRow::branch)) {
        const auto levels = where(steps, &StepRow::branch, branch);
        const auto branch_rows = where(outputs, &StudyRow::branch, branch);
        for (const auto& reading : distinct(levels, &StepRow::reading)) {
            const std::string place = fmt::format("branch '{}' {}: ", branch, reading);
            part("convergence", table_of(where(branch_rows, &StudyRow::reading, reading)),
                 place +
                     "order at which the largest step error over the branch falls, and the "
                     "formulation gap, which no step count removes");
            part("",
                 over_steps(where(levels, &StepRow::reading, reading), true, &StepRow::largest, ""),
                 place + "step errors, largest over the branch, over the steps");
        }
        // A candidate does not give |Φ|.
        if (std::ranges::any_of(
                levels, [](const StepRow& row) { return std::isfinite(row.constraint_error); }))
            part("", over_steps(levels, false, &StepRow::constraint_error, "m"),
                 fmt::format("branch '{}': |Φ| at its end, eq. (31), over the steps", branch));
        const auto branch_gaps = where(gaps, &GapRow::branch, branch);
        for (const auto& reading : distinct(branch_gaps, &GapRow::reading))
            part("attribution", table_of(where(branch_gaps, &GapRow::reading, reading)),
                 fmt::format("branch '{}' {}: what the gap of the recursion is made of, whole = "
                             "lever + axis + load + rest",
                             branch, reading));
    }
    part("step_errors", table_of(steps), "");
    result.charts.push_back({.id = id_prefix + "step_errors",
                             .title = "Step error, largest over the branch",
                             .table = id_prefix + "step_errors",
                             .x = "steps",
                             .y = {"largest"},
                             .by = {"branch", "reading", "output", "method"},
                             .log_x = true,
                             .log_y = true});
    std::ranges::copy(study.inconclusive, std::back_inserter(result.verdict.reasons));
}

// The series at one order and tolerance on a side of a branch.
struct SideLevel {
    const BranchOrders* side;
    const OrderLevel* level;
};

std::vector<ColumnOf<SideLevel>> order_columns() {
    using enum Digits;
    using Level = SideLevel;
    return {{"branch", hidden, [](const Level& l) { return l.side->branch; }},
            {"tolerance", given, [](const Level& l) { return 1e3 * l.level->tolerance; },
             "that is required of the method", "mm"},
            {"order", whole, [](const Level& l) { return l.level->order; }},
            {"outcome", words, [](const Level& l) { return elastocheck::name(l.level->outcome); }},
            {"expansions", whole, [](const Level& l) { return l.level->expansions; }},
            {"rejected", hidden, [](const Level& l) { return l.level->rejected; }},
            {"factorisations", whole, [](const Level& l) { return l.level->work.factorisations; }},
            {"solves", whole, [](const Level& l) { return l.level->work.solves; }},
            {"evaluations", hidden, [](const Level& l) { return l.level->work.evaluations; }},
            {"error", size, [](const Level& l) { return l.level->error.mm; },
             "from the equilibrium leg, largest over all points", "mm"},
            {"angle error", size, [](const Level& l) { return l.level->error.deg; }, "likewise",
             "deg", "error"},
            {"residual", size, [](const Level& l) { return l.level->force; },
             "or N·m: largest residual of an expansion in the balance", "N"},
            {"error at ends", hidden, [](const Level& l) { return l.level->error_end; },
             "largest at the end of an expansion, as it estimates it", "m"},
            {"first reach", percent, [](const Level& l) { return l.level->first_reach; },
             "of the first expansion, share of the branch"},
            {"distance of references", hidden,
             [](const Level& l) { return l.side->uncertainty.mm; }, "", "mm"},
            {"distance of references' angles", hidden,
             [](const Level& l) { return l.side->uncertainty.deg; }, "", "deg"},
            {"singularity", hidden, [](const Level& l) { return l.level->nearest.radius; },
             "distance of the nearest, seen from the start, in lengths of the branch"},
            {"its angle", hidden, [](const Level& l) { return l.level->nearest.angle; },
             "direction", "rad"},
            {"its misfit", hidden, [](const Level& l) { return l.level->nearest.misfit; },
             "relative residual of the fit to the coefficients"},
            {"not compared", hidden, [](const Level& l) { return l.side->failure; }, "why"}};
}

void add(Result& result, const BranchOrders& side) {
    std::vector<SideLevel> levels;
    for (const auto& level : side.levels) levels.push_back({&side, &level});
    Table& part = result.tables.emplace_back(
        table({.id = "orders",
               .caption = fmt::format(
                   "branch '{}', the series over its order; error to the equilibrium leg, {}",
                   side.branch,
                   side.failure.empty() ? fmt::format("references {:.1e} mm, {:.1e} deg apart",
                                                      side.uncertainty.mm, side.uncertainty.deg)
                                        : "which has no result to compare with: " + side.failure)},
              order_columns(), levels));
    // A linear branch has none.
    if (const auto& nearest = side.levels.back().nearest; std::isfinite(nearest.radius))
        part.notes.push_back(fmt::format(
            "nearest singularity of the branch as seen from its start: at {:.3g} times its length, "
            "{:.0f}° from the direction of the branch",
            nearest.radius, nearest.angle * 180 / std::numbers::pi));
}

}  // namespace

Result result_of(const Model& model, const ConvergenceStudies& studies) {
    Result result{.analysis = "converge"};
    if (studies.methods || studies.candidate)
        result.about.push_back(
            model.name +
            "\nvalue - truth = step error (to the method's own limit) + formulation gap (own limit "
            "- reference) + reference uncertainty\nStudied are positions and angles; forces, "
            "moments and rates are compared by `elastocheck compare`.");
    if (studies.methods) add(result, *studies.methods, studies.attribution, "");
    for (const auto& side : studies.orders) add(result, side);
    if (studies.candidate) add(result, *studies.candidate, {}, "candidate_");
    const bool conclusive = (!studies.methods || studies.methods->conclusive()) &&
                            (!studies.candidate || studies.candidate->conclusive()) &&
                            (studies.orders.empty() || compare::conclusive(studies.orders));
    if (!conclusive && result.verdict.reasons.empty())
        result.verdict.reasons.emplace_back(studies.orders.empty()
                                                ? "nothing was studied"
                                                : "no order of the series gave a result");
    result.verdict.grade = conclusive ? Grade::pass : Grade::not_judged;
    result.verdict.sentence = conclusive ? "conclusive" : "INCONCLUSIVE";
    return result;
}

}  // namespace elastocheck::compare
