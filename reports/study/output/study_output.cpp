#include "reports/study/output/study_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/variants/sampler.hpp"
#include "models/overloaded.hpp"
#include "reports/files/files.hpp"
#include "reports/study/run_study.hpp"
#include "reports/render/render.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using namespace compare::variants;
using compare::Cell;
using Eigen::Index;
using json = nlohmann::ordered_json;

constexpr FileKind variants_file{"variants", "variant,outcome,"};
constexpr std::size_t most_shown = 10;  // failed variants
// Witnesses agree to this share of the spread of a figure, or of its size.
constexpr double agree_of_spread = 1e-6, agree_of_size = 1e-9;

Cell count(std::uint64_t n) { return static_cast<double>(n); }

std::string describe_distribution(const Distribution& distribution) {
    return std::visit(
        overloaded{
            [](const Normal& d) { return fmt::format("normal, {:g}, sd {:g}", d.mean, d.sd); },
            [](const Uniform& d) { return fmt::format("uniform, {:g} to {:g}", d.low, d.high); },
            [](const Triangular& d) {
                return fmt::format("triangular, {:g} to {:g}, mode {:g}", d.low, d.high, d.mode);
            },
            [](const TruncatedNormal& d) {
                return fmt::format("normal, {:g}, sd {:g}, between {:g} and {:g}", d.mean, d.sd,
                                   d.low, d.high);
            },
            [](const Levels& d) {
                return fmt::format("list of {}, {:g} to {:g}", d.values.size(),
                                   *std::ranges::min_element(d.values),
                                   *std::ranges::max_element(d.values));
            },
            [](const Given&) { return std::string("as listed"); }},
        distribution);
}

// What was drawn, with the unit of each number: that of the scene is easily another one than meant.
compare::Table variables_table(const StudyFile& file) {
    using enum Digits;
    compare::Table table{{{"variable", "", "", true, words},
                          {"unit", "", "", true, words},
                          {"design", "", "of the scene as it is written", false, given},
                          {"distribution", "", "", true, words},
                          {"scales", "", "how many numbers, of a factor", false, hidden}},
                         {}};
    for (const Variable& variable : file.study.variables)
        table.rows.push_back({variable.name, variable.unit, variable.nominal,
                              describe_distribution(variable.distribution),
                              count(variable.scaled.size())});
    return table;
}

compare::Table figures_table(const StudyFile& file, const StudyResult& result) {
    using enum Digits;
    compare::Table table{{{"figure", "", "", true, words},
                          {"unit", "", "", true, words},
                          {"read as", "", "output and place", true, hidden},
                          {"design", "", "of the scene as it is written", false, given},
                          {"mean", "", "", false, given},
                          {"mean +-", "", "half of the interval of 95 %", false, size, "+-"},
                          {"sd", "", "standard deviation", false, given},
                          {"least", "", "", false, given},
                          {"largest", "", "", false, given}},
                         {}};
    for (const double p : percentiles) {
        const std::string head = fmt::format("{:g} %", 100 * p);
        table.columns.push_back({head, "", "percentile", false, given});
        table.columns.push_back({head + " low", "", "95 %", false, hidden});
        table.columns.push_back({head + " high", "", "95 %", false, hidden});
    }
    for (compare::Column column : std::vector<compare::Column>{
             {"values", "", "finite ones", false, whole},
             {"missing", "", "variants without a value", false, whole},
             {"undefined", "", "infinite values", false, hidden},
             {"min", "", "limit", false, given},
             {"max", "", "limit", false, given},
             {"outside", "", "share of the values outside the limits", false, percent},
             {"outside low", "", "Clopper-Pearson interval of 95 %", false, percent, "from"},
             {"outside high", "", "Clopper-Pearson interval of 95 %", false, percent, "to"}})
        table.columns.push_back(std::move(column));
    for (std::size_t j = 0; j < result.figures.size(); ++j) {
        const StudyFigure& figure = file.study.figures[j];
        const FigureStatistics& s = result.figures[j];
        auto& row = table.rows.emplace_back(std::vector<Cell>{
            figure.name, std::string(symbol(figure.unit)), figure.words, result.design.values[j],
            s.mean.value, s.mean.high - s.mean.value, s.sd, s.least, s.largest});
        for (const Interval& p : s.percentile) row.insert(row.end(), {p.value, p.low, p.high});
        const Interval outside = s.outside.value_or(Interval{});
        row.insert(row.end(), {count(s.count), count(s.missing), count(s.undefined), figure.low,
                               figure.high, outside.value, outside.low, outside.high});
        for (Cell& cell : row)  // an end without bound
            if (const double* value = std::get_if<double>(&cell); value && std::isinf(*value))
                cell = compare::nan;
    }
    return table;
}

compare::Table sobol_table(const StudyFile& file, const StudyResult& result) {
    using enum Digits;
    compare::Table table{{{"figure", "", "", true, words},
                          {"variable", "", "", true, words},
                          {"first", "", "first-order Sobol index", false, three},
                          {"first low", "", "bootstrap, 95 %", false, three, "from"},
                          {"first high", "", "bootstrap, 95 %", false, three, "to"},
                          {"total", "", "total Sobol index", false, three},
                          {"total low", "", "bootstrap, 95 %", false, three, "from"},
                          {"total high", "", "bootstrap, 95 %", false, three, "to"},
                          {"blocks", "", "complete blocks of variants", false, hidden},
                          {"left out", "", "blocks with a variant without a value", false, hidden}},
                         {}};
    for (std::size_t j = 0; j < result.figures.size(); ++j) {
        const FigureStatistics& s = result.figures[j];
        if (!s.sobol) continue;
        for (std::size_t v = 0; v < file.study.variables.size(); ++v) {
            const auto i = static_cast<Index>(v);
            table.rows.push_back({file.study.figures[j].name, file.study.variables[v].name,
                                  s.sobol->first(i, 0), s.sobol->first(i, 1), s.sobol->first(i, 2),
                                  s.sobol->total(i, 0), s.sobol->total(i, 1), s.sobol->total(i, 2),
                                  count(s.blocks), count(s.blocks_left_out)});
        }
    }
    return table;
}

compare::Table witness_table(const StudyFile& file, const StudyResult& result) {
    using enum Digits;
    compare::Table table{{{"figure", "", "", true, words},
                          {"unit", "", "", true, words},
                          {"difference", "", "largest, series less equilibrium", false, size},
                          {"of variant", "", "", false, whole},
                          {"witnesses", "", "with both values", false, whole},
                          {"one only", "", "one of the two has no value", false, whole}},
                         {}};
    for (std::size_t j = 0; j < result.witnesses.size(); ++j) {
        const WitnessDifference& w = result.witnesses[j];
        table.rows.push_back({file.study.figures[j].name,
                              std::string(symbol(file.study.figures[j].unit)), w.largest,
                              count(w.at), count(w.count), count(w.one_sided)});
    }
    return table;
}

compare::Table failed_table(const StudyResult& result) {
    using enum Digits;
    compare::Table table{{{"variant", "", "", false, whole},
                          {"outcome", "", "", true, words},
                          {"reason", "", "", true, words}},
                         {}};
    for (const LedgerRow& row : result.failed)
        table.rows.push_back(
            {count(row.k), std::string(name(row.figures.outcome)), row.figures.reason});
    return table;
}

void judge_witnesses(const StudyFile& file, StudyResult& result) {
    for (std::size_t j = 0; j < result.witnesses.size(); ++j) {
        const WitnessDifference& w = result.witnesses[j];
        const FigureStatistics& s = result.figures[j];
        const std::string& figure = file.study.figures[j].name;
        if (w.one_sided > 0)
            result.disagreements.push_back(
                fmt::format("{}: in {} variants only one of series and equilibrium has a value",
                            figure, w.one_sided));
        const double allowed = std::max(agree_of_spread * (s.largest - s.least),
                                        agree_of_size * std::max(1.0, std::abs(s.mean.value)));
        if (w.count > 0 && !(w.largest <= allowed))
            result.disagreements.push_back(fmt::format(
                "{}: series and equilibrium differ by {:.2g} {} in variant {}; allowed: {:.2g}",
                figure, w.largest, symbol(file.study.figures[j].unit), w.at, allowed));
    }
}

}  // namespace

StudyResult evaluate_study(const StudyFile& file, const Ledger& ledger) {
    const std::uint64_t size = file.study.design.count;
    StudyResult result{.summary = ledger.summary(size),
                       .figures = {},
                       .design = file.solver.solve_alone(file.design, compare::Leg::series),
                       .witnesses = ledger.witnesses(size),
                       .failed = ledger.failed(size, most_shown),
                       .content_hash = ledger.content_hash(size),
                       .disagreements = {}};
    for (std::size_t j = 0; j < file.study.figures.size(); ++j)
        result.figures.push_back(statistics(file.study, j, ledger.values(j, size)));
    judge_witnesses(file, result);
    return result;
}

std::string outcomes_text(const StudyResult& result) {
    std::vector<std::string> parts;
    for (std::size_t o = 0; o < result.summary.by_outcome.size(); ++o)
        if (result.summary.by_outcome[o] > 0)
            parts.push_back(fmt::format("{} {}", result.summary.by_outcome[o],
                                        name(static_cast<VariantOutcome>(o))));
    if (result.summary.by_equilibrium > 0)
        parts.push_back(fmt::format("{} of all by the equilibrium leg, where series declines",
                                    result.summary.by_equilibrium));
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<std::pair<std::string, compare::Table>> study_tables(const StudyFile& file,
                                                                 const StudyResult& result) {
    return {{"Variables", variables_table(file)},
            {"Figures", figures_table(file, result)},
            {"Shares of the variance (Sobol indices)", sobol_table(file, result)},
            {fmt::format("Every {} variants by the equilibrium leg too", file.study.witness),
             file.study.witness > 0 ? witness_table(file, result) : compare::Table{}},
            {"The first failed variants", failed_table(result)}};
}

std::string study_text(const StudyFile& file, const StudyResult& result) {
    const std::uint64_t size = file.study.design.count;
    std::string out =
        fmt::format("{} of {} variants: {}\n\n", result.summary.rows, size, outcomes_text(result));
    std::string_view between = "";
    for (const auto& [caption, table] : study_tables(file, result)) {
        if (table.rows.empty()) continue;
        // The first two explain themselves.
        const bool named = caption != "Variables" && caption != "Figures";
        out += std::string(between) + (named ? caption + "\n" : "") + text(table);
        between = "\n";
    }
    out += fmt::format("\nContent {}\n", result.content_hash);
    return out;
}

json study_json(const StudyFile& file, const StudyResult& result) {
    json outcomes = json::object();
    for (std::size_t o = 0; o < result.summary.by_outcome.size(); ++o)
        outcomes[name(static_cast<VariantOutcome>(o))] = result.summary.by_outcome[o];
    return {{"study", file.file},
            {"scene", file.scene_file},
            {"identity",
             {{"scene", file.identity.scene},
              {"study", file.identity.study},
              {"version", file.identity.version}}},
            {"count", file.study.design.count},
            {"rows", result.summary.rows},
            {"outcomes", outcomes},
            {"variables", table_json(variables_table(file))},
            {"figures", table_json(figures_table(file, result))},
            {"sobol", table_json(sobol_table(file, result))},
            {"witnesses", table_json(witness_table(file, result))},
            {"disagreements", result.disagreements},
            {"failed", table_json(failed_table(result))},
            {"content", result.content_hash}};
}

std::string heading(const Variable& variable) {
    return variable.unit.empty() ? variable.name
                                 : fmt::format("{} [{}]", variable.name, variable.unit);
}
std::string heading(const StudyFigure& figure) {
    return fmt::format("{} [{}]", figure.name, symbol(figure.unit));
}

void write_study_csv(const StudyFile& file, const Ledger& ledger,
                     const std::filesystem::path& output) {
    AtomicFile out(output, variants_file);
    std::string line = "variant,outcome,reason";
    for (const Variable& variable : file.study.variables) line += "," + for_csv(heading(variable));
    for (const StudyFigure& figure : file.study.figures) line += "," + for_csv(heading(figure));
    out.add(line + "\n");
    const Sampler sampler(file.study);
    std::uint64_t first = 0, end = 0;  // of the drawn values
    Eigen::MatrixXd values;
    const auto number = [](double value) {
        return std::isnan(value) ? std::string() : fmt::format("{}", value);
    };
    ledger.each_row(file.study.design.count, [&](const LedgerRow& row) {
        if (row.k >= end) {
            first = row.k - row.k % batch_size;
            end = std::min(first + batch_size, file.study.design.count);
            values = sampler.values(first, end - first);
        }
        line =
            fmt::format("{},{},{}", row.k, name(row.figures.outcome), for_csv(row.figures.reason));
        for (const double value : values.row(static_cast<Index>(row.k - first)))
            line += "," + number(value);
        for (const double value : row.figures.values) line += "," + number(value);
        out.add(line + "\n");
    });
    out.finish();
}

}  // namespace elastocheck::reports
