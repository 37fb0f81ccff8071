// What the formulation gap is made of.
#include <fmt/format.h>

#include <cmath>

#include "reports/page/numbers.hpp"
#include "reports/page/sections/common.hpp"
#include "reports/page/sections/sections.hpp"

namespace elastocheck::reports {
namespace {

struct Term {
    const char *key, *name;
    Colour colour;
};
constexpr Term terms[] = {{"lever", "stored force’s lever", vermilion},
                          {"axis", "its axis and law", blue},
                          {"load", "load’s lever", ochre}};

// The range of a channel over the branch, as the study knows it.
double range_of(const Field& branch, const std::string& channel) {
    for (const auto& method : branch["methods"].items())
        for (const auto& entry : method["at_equal_parameter"].items())
            if (entry["channel"].text() == channel) return entry["range"].number();
    return NAN;
}

std::optional<FigureGroup> group(const Field& branch) {
    const Field attribution = branch["gap_attribution"];
    const auto shares = attribution["at_equal_parameter"].items();
    if (shares.empty()) return std::nullopt;
    const std::string name = branch["name"].text(), reading = at_equal_parameter(branch["unit"].text());
    Figure figure{.id = fmt::format("gap-{}", slug(name)),
                  .title = fmt::format("{}: contributions to the gap", name),
                  .description = {},
                  .x = "contribution at the end [% of the output’s range]",
                  .y = ""};
    FigureGroup group;
    group.table = {.caption = fmt::format(
                       "Gap at the end of branch {}, {}: whole = lever + axis + load + rest", name, reading),
                   .columns = {{"output", true},
                               {"whole"},
                               {"stored force’s lever"},
                               {"its axis and law"},
                               {"load’s lever"},
                               {"rest"},
                               {"± band"}}};
    for (const auto& term : terms) figure.series.push_back({term.name, Series::Style::bars, term.colour});
    double row = 0;
    std::string words;
    for (const auto& share : shares) {
        const ChannelInfo channel{share["channel"].text(), share["unit"].text()};
        std::vector<std::string> cells{channel.heading()};
        for (const char* key : {"whole", "lever", "axis", "load", "rest"})
            cells.push_back(deviation_number(share[key].number()));
        cells.push_back(number(share["band"].number(), 2));
        group.table.rows.push_back(cells);
        const double range = range_of(branch, channel.name);
        if (!(range > 1e-9) || !(std::abs(share["whole"].number()) > 1e-9)) continue;
        --row;
        figure.y_ticks.emplace_back(row, channel.label());
        for (std::size_t t = 0; t < std::size(terms); ++t) {
            const double value = 100 * share[terms[t].key].number() / range;
            const double middle = row + 0.26 * (1 - static_cast<double>(t));
            figure.series[t].rows.push_back({value / 2, middle, std::min(0.0, value), std::max(0.0, value),
                                             middle - 0.11, middle + 0.11});
        }
        words += fmt::format(" {}: {} % of its range.", channel.label(),
                             number(100 * share["whole"].number() / range, 2));
    }
    if (row == 0) return std::nullopt;
    figure.y_low = row - 0.6;
    figure.y_high = -0.4;
    figure.height = std::max(0.8, 0.35 + 0.13 * -row);
    figure.description = "Bars of the three contributions per output. Whole gap:" + words;
    group.caption = fmt::format("Branch {}, {}.", name, reading);
    group.figures.push_back(std::move(figure));
    return group;
}

}  // namespace

std::optional<Section> attribution_section(const Field& scene) {
    const auto study = scene.find("convergence");
    if (!study) return std::nullopt;
    Section section{.id = "attribution", .title = "What the formulation gap is made of"};
    bool any = false;
    for (const auto& branch : (*study)["branches"].items()) {
        const auto attribution = branch.find("gap_attribution");
        if (!attribution) continue;
        any = true;
        if (const std::string why = (*attribution)["not_attributed"].text(); !why.empty())
            section.words["notes"].push_back({{"branch", branch["name"].text()}, {"why", why}});
        if (auto made = group(branch)) section.figures.push_back(std::move(*made));
    }
    section.words["empty"] = section.figures.empty();
    return any ? std::optional(section) : std::nullopt;
}

}  // namespace elastocheck::reports
