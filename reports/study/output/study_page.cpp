#include "reports/study/output/study_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compare/variants/sampler.hpp"
#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"
#include "reports/files/templates.hpp"
#include "reports/page/common.hpp"
#include "reports/page/plot.hpp"
#include "reports/page/svg.hpp"
#include "reports/page/template_data.hpp"
#include "reports/text/escape.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using namespace compare::variants;
using Eigen::Index;
using json = nlohmann::ordered_json;

constexpr FileKind page_file{"page of a study",
                             R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="generator" content="elastocheck study">)"};
constexpr std::uint64_t most_points = 400;  // of a scatter plot
constexpr double golden_ratio = 0.6180339887498949;
constexpr std::size_t most_bars = 8, most_scatters = 3;

// Independent variants, evenly spread, with their variables [variants × variables].
struct Spread {
    std::vector<std::uint64_t> k;
    Eigen::MatrixXd x;
};
Spread spread(const Study& study) {
    const std::uint64_t block = block_size(study), bases = study.design.count / block;
    const std::uint64_t count = std::min(most_points, bases);
    const Sampler sampler(study);
    Spread result{.k = {}, .x = Eigen::MatrixXd(count, study.variables.size())};
    for (std::uint64_t i = 0; i < count; ++i) {
        // Not at equal distances: of a Sobol sequence those leave gaps that it does not have.
        const double within = std::fmod(static_cast<double>(i) * golden_ratio, 1.);
        const double base = (static_cast<double>(i) + within) / static_cast<double>(count) *
                            static_cast<double>(bases);
        const std::uint64_t k = std::min(bases - 1, static_cast<std::uint64_t>(base)) * block;
        result.k.push_back(k);
        result.x.row(static_cast<Index>(i)) = sampler.values(k, 1);
    }
    return result;
}

// Share of the variance of a figure by a variable, with its interval where that is known.
struct Share {
    std::size_t variable = 0;
    double value = 0, low = NAN, high = NAN;
};

// Total Sobol indices, else squared correlations; the largest first.
std::vector<Share> shares(const FigureStatistics& statistics, const Spread& at,
                          const std::vector<double>& values) {
    std::vector<Share> all;
    for (Index v = 0; v < at.x.cols(); ++v) {
        Share share{.variable = static_cast<std::size_t>(v)};
        if (statistics.sobol) {
            const auto total = statistics.sobol->total.row(v);
            share.value = total[0], share.low = total[1], share.high = total[2];
        } else {
            std::vector<double> x, y;
            for (std::size_t i = 0; i < at.k.size(); ++i)
                if (std::isfinite(values[at.k[i]])) {
                    x.push_back(at.x(static_cast<Index>(i), v));
                    y.push_back(values[at.k[i]]);
                }
            const auto n = static_cast<Index>(x.size());
            if (n == 0) continue;
            Eigen::ArrayXd a = Eigen::Map<Eigen::ArrayXd>(x.data(), n),
                           b = Eigen::Map<Eigen::ArrayXd>(y.data(), n);
            a -= a.mean(), b -= b.mean();
            const double r = (a * b).sum() / std::sqrt(a.square().sum() * b.square().sum());
            share.value = std::isfinite(r) ? r * r : 0;
        }
        all.push_back(share);
    }
    std::ranges::stable_sort(all, std::ranges::greater{}, &Share::value);
    return all;
}

Figure histogram(const Study& study, const StudyFigure& of, const FigureStatistics& statistics,
                 const std::vector<double>& values) {
    Figure figure{
        .id = "histogram",
        .title = "Distribution",
        .description = fmt::format("Histogram of {} values of {}.", statistics.count, of.name),
        .x = heading(of),
        .y = "variants"};
    constexpr double fewest = 10, most = 40;
    const auto bins = static_cast<std::size_t>(
        std::clamp(std::sqrt(static_cast<double>(statistics.count)), fewest, most));
    const double low = statistics.least,
                 width = (statistics.largest - low) / static_cast<double>(bins);
    std::vector<double> counts(bins, 0);
    const std::uint64_t block = block_size(study);
    for (std::size_t k = 0; k < values.size(); ++k)
        if (std::isfinite(values[k]) && !(study.design.indices && k % block > 1))
            ++counts[width > 0
                         ? std::min(bins - 1, static_cast<std::size_t>((values[k] - low) / width))
                         : 0];
    Series bars{.style = Series::Style::bars, .colour = blue};
    const double shown = width > 0 ? width : 1;  // of equal values
    for (std::size_t b = 0; b < bins; ++b) {
        const double from = low + shown * static_cast<double>(b);
        bars.rows.push_back({from + shown / 2, counts[b], from, from + shown, 0, counts[b]});
        if (width <= 0) break;
    }
    figure.series.push_back(std::move(bars));
    const double top = *std::ranges::max_element(counts);
    Series limits{.title = "limit", .style = Series::Style::dashed, .colour = vermilion};
    for (const double limit : {of.low, of.high})
        if (std::isfinite(limit)) {
            if (!limits.rows.empty()) limits.rows.emplace_back();
            limits.rows.push_back({limit, 0});
            limits.rows.push_back({limit, top});
        }
    if (!limits.rows.empty()) figure.series.push_back(std::move(limits));
    figure.y_low = 0;
    return figure;
}

Figure bars_of(const StudyFile& file, const StudyFigure& of, const std::vector<Share>& shares,
               bool is_sobol) {
    Figure figure{.id = "shares",
                  .title = is_sobol ? "Shares of the variance" : "Squared correlation",
                  .description = fmt::format(
                      "{} of {}:", is_sobol ? "Total Sobol indices" : "Correlations", of.name),
                  .x = is_sobol ? "total Sobol index" : "squared correlation with the variable"};
    Series bars{.style = Series::Style::bars, .colour = blue},
        whiskers{.title = is_sobol ? "interval of 95 %" : "", .colour = ink};
    double row = 0;
    for (const Share& share : shares) {
        if (row <= -static_cast<double>(most_bars)) break;
        --row;
        const std::string& name = file.study.variables[share.variable].name;
        figure.y_ticks.emplace_back(row, name);
        bars.rows.push_back({share.value / 2, row, std::min(0.0, share.value),
                             std::max(0.0, share.value), row - 0.3, row + 0.3});
        if (std::isfinite(share.low)) {
            if (!whiskers.rows.empty()) whiskers.rows.emplace_back();
            whiskers.rows.push_back({share.low, row});
            whiskers.rows.push_back({share.high, row});
        }
        figure.description += fmt::format(" {} {};", name, number(share.value, 2));
    }
    figure.description.back() = '.';
    figure.series.push_back(std::move(bars));
    if (!whiskers.rows.empty()) figure.series.push_back(std::move(whiskers));
    figure.y_low = row - 0.6, figure.y_high = -0.4;
    figure.height = 0.45 + 0.08 * -row;
    return figure;
}

Figure scatter(const Variable& variable, Index v, const StudyFigure& of, const Spread& at,
               const std::vector<double>& values) {
    Figure figure{.id = "scatter",
                  .title = "Over " + variable.name,
                  .description = fmt::format("{} of up to {} variants over {}.", of.name,
                                             at.k.size(), variable.name),
                  .x = heading(variable),
                  .y = heading(of)};
    Series points{.style = Series::Style::points, .colour = blue};
    for (std::size_t i = 0; i < at.k.size(); ++i) {
        if (!std::isfinite(values[at.k[i]])) continue;
        if (!points.rows.empty()) points.rows.emplace_back();
        points.rows.push_back({at.x(static_cast<Index>(i), v), values[at.k[i]]});
    }
    figure.series.push_back(std::move(points));
    return figure;
}

std::string words_of(const StudyFigure& figure, const FigureStatistics& s) {
    const std::string_view unit = symbol(figure.unit);
    constexpr int digits = 4;
    if (s.count == 0) return "No variant has a value.";
    std::string words = fmt::format("{}: mean {}, standard deviation {}, from {} to {} {}.",
                                    figure.words, number(s.mean.value, digits), number(s.sd),
                                    number(s.least, digits), number(s.largest, digits), unit);
    if (s.outside)
        words += fmt::format(" Outside the limits: {} ({} to {} with 95 % confidence).",
                             percent(s.outside->value), percent(s.outside->low),
                             percent(s.outside->high));
    if (s.missing > 0) words += fmt::format(" {} variants have no value.", s.missing);
    return words;
}

}  // namespace

void write_study_page(const StudyFile& file, const StudyResult& result, const Ledger& ledger,
                      const std::string& command, const std::filesystem::path& output) {
    const Study& study = file.study;
    const Spread at = spread(study);
    json figures = json::array();
    std::size_t drawn = 0;
    for (std::size_t j = 0; j < study.figures.size(); ++j) {
        const StudyFigure& of = study.figures[j];
        const FigureStatistics& statistics = result.figures[j];
        json plots = json::array();
        const auto draw_one = [&](const Figure& figure) {
            plots.push_back({{"title", figure.title},
                             {"svg", illustrate(draw(figure), fmt::format("f{}", ++drawn),
                                                figure.title, figure.description)
                                         .inlined}});
        };
        if (statistics.count > 0) {
            const std::vector<double> values = ledger.values(j, study.design.count);
            const auto ordered = shares(statistics, at, values);
            draw_one(histogram(study, of, statistics, values));
            draw_one(bars_of(file, of, ordered, statistics.sobol.has_value()));
            for (std::size_t i = 0; i < std::min(most_scatters, ordered.size()); ++i) {
                const std::size_t v = ordered[i].variable;
                draw_one(scatter(study.variables[v], static_cast<Index>(v), of, at, values));
            }
        }
        figures.push_back(
            {{"id", fmt::format("figure-{}", j + 1)},
             {"name", of.name},
             {"words", words_of(of, statistics)},
             {"plots", plots},
             {"caption",
              fmt::format("Distribution of all values; {}; values of up to {} variants over the "
                          "variables that matter most.",
                          statistics.sobol ? "total Sobol indices with bootstrap intervals"
                                           : "squared correlations of these variants",
                          at.k.size())}});
    }
    json tables = json::array();
    constexpr std::size_t most_rows = 15;  // of a table that is open
    for (const auto& [caption, table] : study_tables(file, result)) {
        if (table.rows.empty()) continue;
        Table shown = page_table(caption, table);
        shown.folded = shown.rows.size() > most_rows;
        tables.push_back(table_data(shown));
    }
    const Provenance made = provenance();
    const Table by{
        .caption = "Made by",
        .columns = {{"what", true}, {"which", true}},
        .rows = {{"elastocheck", file.identity.version},
                 {"compiler", made.compiler},
                 {"scene", fmt::format("{}, hash {}", file.scene_file, file.identity.scene)},
                 {"study", fmt::format("{}, hash {}", file.file, file.identity.study)},
                 {"content", result.content_hash}}};
    const json data = {{"title", "Study " + std::filesystem::path(file.file).stem().string()},
                       {"answer", fmt::format("{} of {} variants: {}.", result.summary.rows,
                                              study.design.count, outcomes_text(result))},
                       {"notes", result.disagreements},
                       {"figures", figures},
                       {"tables", tables},
                       {"provenance", table_data(by)},
                       {"reproduce", for_terminal(command)},
                       {"tints", tints()}};
    write_whole(output, render("html/study", data, Escape::html), page_file);
}

}  // namespace elastocheck::reports
