// Section: the differences between two variants: numbers of the scene, figures at the design
// position, and outputs over the branches on common axes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

std::string value_or_none(const std::optional<JsonCursor>& field, int digits) {
    return field ? number(field->number(), digits) : "none";
}

// Of the base and the variant: the scenes' names, or where these are the same, their files'.
std::pair<std::string, std::string> names_of(const JsonCursor& scene, const JsonCursor& against) {
    const std::string base = scene["name"].text(), variant = against["name"].text();
    const auto file = [](const JsonCursor& of) {
        return std::filesystem::path(of["source"].text()).filename().string();
    };
    if (base != variant) return {base, variant};
    return {file(scene), file(against)};
}

Table numbers_table(const JsonCursor& against) {
    Table table{.caption = "Numbers of the scene that differ",
                .columns = {{"number", true}, {"base"}, {"variant"}, {"unit", true}}};
    for (const auto& n : against["numbers"].items()) {
        const auto base = n.find("base"), variant = n.find("variant");
        const auto as_written = [](const std::optional<JsonCursor>& side) {
            return side ? fmt::format("{}", (*side)["value"].number()) : "none";
        };
        table.rows.push_back({n["path"].text(), as_written(base), as_written(variant),
                              (variant ? *variant : *base)["unit"].text()});
    }
    return table;
}

// Those that an engineer notices, or the others.
Table figures_table(const JsonCursor& against, bool noticed) {
    Table table{.caption = noticed ? "Figures at the design position that differ"
                                   : "Figures that differ by less than an engineer notices",
                .columns = {{"figure", true},
                            {"base"},
                            {"variant"},
                            {"unit", true},
                            {"difference"},
                            {"its unit", true}}};
    table.folded = !noticed;
    for (const auto& f : against["figures"].items())
        if (noticed == !(f["noticed"].number() <= 1))
            table.rows.push_back({as_words(f["output"].text()), value_or_none(f.find("base"), 4),
                                  value_or_none(f.find("variant"), 4), f["unit"].text(),
                                  signed_number(f["difference"].number(), 3),
                                  f["unit_of_difference"].text()});
    return table;
}

Table curves_table(const JsonCursor& against) {
    Table table{.caption = "Largest difference over each branch, at equal load or drive",
                .columns = {{"branch", true},
                            {"output", true},
                            {"largest difference"},
                            {"unit", true},
                            {"at"},
                            {"", true}}};
    for (const auto& branch : against["branches"].items())
        for (const auto& c : branch["curves"].items())
            table.rows.push_back({branch["name"].text(), as_words(c["output"].text()),
                                  signed_number(c["largest"].number(), 3), c["unit"].text(),
                                  number(c["at"].number(), 4), branch["unit"].text()});
    return table;
}

Series curve(const JsonCursor& line, const std::string& title, bool variant) {
    Series series{.title = title,
                  .style = variant ? Series::Style::line : Series::Style::wide,
                  .colour = variant ? vermilion : sky};
    const auto a = line["a"].numbers(), y = line["y"].numbers();
    if (a.size() != y.size()) line.fail("not as many numbers as parameters");
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (std::isfinite(y[k]))
            series.rows.push_back({a[k], y[k]});
        else if (!series.rows.empty() && !series.rows.back().empty())
            series.rows.emplace_back();
    }
    return series;
}

// Whether two lines can be distinguished: by a hundredth of the range of the curve.
bool is_visible(const JsonCursor& curve) {
    const auto y = curve["base"]["y"].numbers();
    const auto [low, high] = std::ranges::minmax_element(y);
    return low != y.end() && std::abs(curve["largest"].number()) >= 0.01 * (*high - *low);
}

// Axis of the parameter of a branch, as on the other figures of the page: "load [N]".
std::string parameter_of(const JsonCursor& scene, const JsonCursor& compared) {
    for (const auto& branch : scene["branches"].items())
        if (branch["name"].text() == compared["name"].text())
            return sweep_of(scene, branch).parameter();
    compared["name"].fail("no such branch");
}

// What an engineer notices: on the first branch every output, on the others the angles.
FigureGroup figures(const JsonCursor& scene, const JsonCursor& against) {
    constexpr std::size_t most = 12;
    const auto [base, variant] = names_of(scene, against);
    FigureGroup group{.caption = fmt::format("Wide line: {}. Thin line: {}.", base, variant),
                      .table = curves_table(against)};
    std::string first;
    for (const auto& branch : against["branches"].items()) {
        const std::string name = branch["name"].text();
        if (first.empty()) first = name;
        const std::string x_axis = parameter_of(scene, branch);
        for (const auto& c : branch["curves"].items()) {
            const std::string unit = c["unit"].text(), output = as_words(c["output"].text());
            if (!(c["noticed"].number() > 1) || (name != first && unit != "deg") || !is_visible(c))
                continue;
            if (group.figures.size() == most) return group;
            group.figures.push_back(
                {.id = fmt::format("against-{}-{}", slug(c["output"].text()), slug(name)),
                 .title = fmt::format("{}, {}", output, name),
                 .description =
                     fmt::format("{} of both variants, {}; they differ by up to {} {}", output,
                                 name, number(std::abs(c["largest"].number()), 2), unit),
                 .x = x_axis,
                 .y = fmt::format("{} [{}]", output, unit),
                 .series = {curve(c["base"], "base", false),
                            curve(c["variant"], "variant", true)}});
        }
    }
    return group;
}

}  // namespace

std::optional<Section> against_section(const JsonCursor& scene) {
    const auto against = scene.find("against");
    if (!against) return std::nullopt;
    Section section{.id = "against", .title = "Differences of " + names_of(scene, *against).second};
    section.words = {{"base", scene["source"].text()},
                     {"variant", (*against)["source"].text()},
                     {"numbers", counted((*against)["numbers"].items().size(), "number")},
                     {"figures", counted((*against)["figures"].items().size(), "figure")}};
    for (const char* key : {"only_base", "only_variant"})
        if (const auto names = (*against)[key].texts(); !names.empty())
            section.words[key] = enumerated(names);
    for (Table table :
         {numbers_table(*against), figures_table(*against, true), figures_table(*against, false)})
        if (!table.rows.empty()) section.tables.push_back(std::move(table));
    FigureGroup group = figures(scene, *against);
    if (!group.figures.empty())
        section.figures.push_back(std::move(group));
    else if (!group.table.rows.empty())
        section.tables.push_back(std::move(group.table));
    return section;
}

}  // namespace elastocheck::reports
