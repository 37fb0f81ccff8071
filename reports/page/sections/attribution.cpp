// Section: attribution of the formulation gap.
#include <fmt/format.h>

#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/tables/select.hpp"
#include "reports/tables/studies/study_tables.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

struct Term {
    const char *key, *name;
    Colour colour;
};
constexpr Term terms[] = {{"lever", "lever arm of the stored force", vermilion},
                          {"axis", "axis and law of the stored force", blue},
                          {"load", "load’s lever", ochre}};

// Range of an output over a branch, from the study.
double range_of(const compare::Table& outputs, const std::string& output) {
    const auto found = where(outputs, "output", output);
    return found.rows.empty() ? NAN : number(found, 0, "range");
}

// Figure of one reading of one branch.
std::optional<FigureGroup> group(const std::string& name, const std::string& reading,
                                 const compare::Table& shares, const compare::Table& outputs) {
    Figure figure{.id = fmt::format("gap-{}", slug(name)),
                  .title = fmt::format("{}: contributions to the gap", name),
                  .description = {},
                  .x = "contribution at the end [% of the output’s range]",
                  .y = ""};
    FigureGroup group;
    group.table = page_table(
        fmt::format("Gap at the end of branch {}, {}: whole = lever + axis + load + rest", name,
                    reading),
        shares, gap_columns);
    for (const auto& term : terms)
        figure.series.push_back({term.name, Series::Style::bars, term.colour});
    double row = 0;
    std::string gaps;
    for (std::size_t r = 0; r < shares.rows.size(); ++r) {
        const ChannelInfo channel{words(shares, r, "output"), words(shares, r, "unit")};
        const double range = range_of(outputs, channel.name), whole = number(shares, r, "whole");
        if (!(range > 1e-9) || !(std::abs(whole) > 1e-9)) continue;
        --row;
        figure.y_ticks.emplace_back(row, channel.label());
        for (std::size_t t = 0; t < std::size(terms); ++t) {
            const double value = 100 * number(shares, r, terms[t].key) / range;
            const double middle = row + 0.26 * (1 - static_cast<double>(t));
            figure.series[t].rows.push_back({value / 2, middle, std::min(0.0, value),
                                             std::max(0.0, value), middle - 0.11, middle + 0.11});
        }
        gaps +=
            fmt::format(" {}: {} % of its range.", channel.label(), number(100 * whole / range, 2));
    }
    if (row == 0) return std::nullopt;
    figure.y_low = row - 0.6;
    figure.y_high = -0.4;
    figure.height = std::max(0.8, 0.35 + 0.13 * -row);
    figure.description = "Bars of the three contributions per output. Whole gap:" + gaps;
    group.caption = fmt::format("Branch {}, {}.", name, reading);
    group.figures.push_back(std::move(figure));
    return group;
}

}  // namespace

std::optional<Section> attribution_section(const JsonCursor& scene) {
    const auto study = scene.find("convergence");
    if (!study) return std::nullopt;
    Section section{.id = "attribution",
                    .title = "Contributions to the formulation gap",
                    .part = Part::evidence};
    const auto outputs = read_table((*study)["outputs"], compare::study_table({}));
    const auto gaps = read_table((*study)["gap"], compare::gap_table({}, {}));
    if (gaps.rows.empty()) return std::nullopt;
    for (const auto& branch : distinct(gaps, "branch")) {
        if (!leads(scene, branch)) continue;
        const auto found = where(gaps, "branch", branch);
        const std::string reading = distinct(found, "reading").front();
        const auto shares = where(found, "reading", reading);
        if (const auto& why = words(shares, 0, "not attributed"); !why.empty())
            section.words["notes"].push_back({{"branch", branch}, {"why", why}});
        else if (auto made = group(branch, reading, shares,
                                   where(where(outputs, "branch", branch), "reading", reading)))
            section.figures.push_back(std::move(*made));
    }
    section.words["empty"] = section.figures.empty();
    return section;
}

}  // namespace elastocheck::reports
