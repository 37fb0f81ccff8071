// Section: attribution of the formulation gap.
#include <fmt/format.h>

#include <cmath>

#include "compare/tables/rows.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::GapRow;
using compare::StudyRow;

struct Term {
    double GapRow::*share;
    const char* name;
    Colour colour;
};
constexpr Term terms[] = {{&GapRow::lever, "lever arm of the stored force", vermilion},
                          {&GapRow::axis, "axis and law of the stored force", blue},
                          {&GapRow::load, "load’s lever", ochre}};

// Figure of one reading of one branch.
std::optional<FigureGroup> group(const std::string& name, const std::string& reading,
                                 const std::vector<GapRow>& shares,
                                 const std::vector<StudyRow>& outputs) {
    Figure figure{.id = fmt::format("gap-{}", slug(name)),
                  .title = fmt::format("{}: contributions to the gap", name),
                  .description = {},
                  .x = "contribution at the end [% of the output’s range]",
                  .y = ""};
    FigureGroup group;
    group.table = page_table(
        fmt::format("Gap at the end of branch {}, {}: whole = lever + axis + load + rest", name,
                    reading),
        shares);
    for (const auto& term : terms)
        figure.series.push_back({term.name, Series::Style::bars, term.colour});
    double row = 0;
    std::string gaps;
    for (const auto& of : shares) {
        const ChannelInfo channel{of.output, of.unit};
        const auto studied = std::ranges::find(outputs, of.output, &StudyRow::output);
        const double range = studied == outputs.end() ? NAN : studied->range;
        if (!(range > 1e-9) || !(std::abs(of.whole) > 1e-9)) continue;
        --row;
        figure.y_ticks.emplace_back(row, channel.label());
        for (std::size_t t = 0; t < std::size(terms); ++t) {
            const double value = 100 * of.*terms[t].share / range;
            const double middle = row + 0.26 * (1 - static_cast<double>(t));
            figure.series[t].rows.push_back({value / 2, middle, std::min(0.0, value),
                                             std::max(0.0, value), middle - 0.11, middle + 0.11});
        }
        gaps += fmt::format(" {}: {} % of its range.", channel.label(),
                            number(100 * of.whole / range, 2));
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
    const auto outputs = read_rows<StudyRow>((*study)["outputs"]);
    const auto gaps = read_rows<GapRow>((*study)["gap"]);
    if (gaps.empty()) return std::nullopt;
    for (const auto& branch : distinct(gaps, &GapRow::branch)) {
        if (!leads(scene, branch)) continue;
        const auto found = where(gaps, &GapRow::branch, branch);
        const std::string reading = found.front().reading;
        const auto shares = where(found, &GapRow::reading, reading);
        if (const auto& why = shares.front().not_attributed; !why.empty())
            section.words["notes"].push_back({{"branch", branch}, {"why", why}});
        else if (auto made = group(
                     branch, reading, shares,
                     where(where(outputs, &StudyRow::branch, branch), &StudyRow::reading, reading)))
            section.figures.push_back(std::move(*made));
    }
    section.words["empty"] = section.figures.empty();
    return section;
}

}  // namespace elastocheck::reports
