// Section: kinematics and compliance at the design position with the error of the recursion, their
// curves over travel and steering, and the compliance matrix.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/tables/table.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/tables/select.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

std::string off_by(double off, double share) {
    if (!std::isfinite(off)) return "–";
    if (off == 0 || std::abs(share) < 1e-4) return "0";
    return std::isfinite(share)
               ? fmt::format("{} ({}\u202f%)", signed_number(off, 2), signed_number(share, 2))
               : signed_number(off, 2);
}

Table figures_table(const compare::Table& at_design) {
    Table table{.caption = "Kinematics and compliance at the design position",
                .columns = {{"figure", true},
                            {"value"},
                            {"unit", true},
                            {"error of the published recursion"},
                            {"definition", true}}};
    for (std::size_t r = 0; r < at_design.rows.size(); ++r) {
        const std::string name = as_words(words(at_design, r, "output"));
        const std::string& undefined = words(at_design, r, "undefined");
        table.rows.push_back(
            {name, undefined.empty() ? number(reports::number(at_design, r, "value"), 4) : "none",
             words(at_design, r, "unit"),
             off_by(reports::number(at_design, r, "off"), reports::number(at_design, r, "off %")),
             undefined.empty()
                 ? words(at_design, r, "definition")
                 : fmt::format("{}. Here: {}", words(at_design, r, "definition"), undefined)});
    }
    return table;
}

// Compliance matrix of the equilibrium leg at the start of the first branch, at the contact
// patches.
std::optional<Table> matrix_table(const compare::Table& compliance, std::string_view point) {
    std::vector<std::size_t> rows;
    for (std::size_t r = 0; r < compliance.rows.size(); ++r)
        if (words(compliance, r, "leg") == "equilibrium" &&
            words(compliance, r, "point") == point &&
            words(compliance, r, "branch") == words(compliance, 0, "branch") &&
            reports::number(compliance, r, "a") == 0)
            rows.push_back(r);
    if (rows.empty()) return std::nullopt;
    Table table{.caption = fmt::format("Compliance at the {}: displacement [mm] and rotation [deg] "
                                       "per kN and per 100 N·m, the "
                                       "wheel free",
                                       point),
                .columns = {{"answer", true}}};
    const bool several = std::ranges::any_of(rows, [&](auto r) {
        return words(compliance, r, "wheel") != words(compliance, rows[0], "wheel");
    });
    if (several) table.columns = {{"wheel", true}, {"answer", true}, {"loaded wheel", true}};
    constexpr const char* causes[] = {"force x",  "force y",  "force z",
                                      "moment x", "moment y", "moment z"};
    for (const char* cause : causes) table.columns.push_back({cause});
    for (const auto r : rows) {
        std::vector<std::string> row{words(compliance, r, "answer")};
        if (several)
            row = {words(compliance, r, "wheel"), row[0], words(compliance, r, "loaded wheel")};
        for (const char* cause : causes) {
            const double value = reports::number(compliance, r, cause);
            row.push_back(std::abs(value) < 1e-9 ? "0" : number(value, 3));
        }
        table.rows.push_back(std::move(row));
    }
    table.folded = point != "contact patch";
    return table;
}

// ---- Curves over travel and steering.

struct Drawn {
    std::string_view name, title;
};
constexpr Drawn over_travel[] = {
    {"wheel_rate", "Wheel rate"},
    {"roll_centre_height", "Roll centre height"},
    {"bump_steer", "Bump steer"},
    {"bump_camber", "Bump camber"},
    {"caster", "Caster"},
    {"motion_ratio", "Motion ratio"},
    {"recession_gradient", "Recession"},
    {"lateral_force_steer", "Lateral force steer"},
};
constexpr Drawn over_steering[] = {
    {"steer_gradient", "Steer gradient"},           {"scrub_radius", "Scrub radius"},
    {"mechanical_trail", "Mechanical trail"},       {"caster", "Caster"},
    {"kingpin_inclination", "Kingpin inclination"},
};

bool is(const std::string& channel, std::string_view name) {
    return channel == name || channel.ends_with("." + std::string(name));
}

std::optional<FigureGroup> figure(const JsonCursor& scene, const JsonCursor& branch,
                                  const Drawn& drawn, const std::string& x_axis,
                                  bool over_abscissa) {
    FigureGroup group;
    Figure figure{
        .id = fmt::format("{}-{}", slug(std::string(drawn.name)), slug(branch["name"].text())),
        .title = std::string(drawn.title),
        .x = x_axis};
    const LegCurve truth = curve_of(branch, "equilibrium"),
                   recursion = curve_of(branch, "recursive");
    int colour = sky;
    double low = INFINITY, high = -INFINITY;
    for (const auto& channel : channels_of(scene)) {
        if (!is(channel.name, drawn.name) || !truth.values.find(channel.name)) continue;
        figure.y = fmt::format("{} [{}]", drawn.title, channel.unit);
        const std::string whose =
            channel.name == drawn.name
                ? ""
                : channel.name.substr(0, channel.name.size() - drawn.name.size() - 1);
        for (const auto* curve : {&truth, &recursion}) {
            const auto values = curve->channel(channel.name);
            const auto& x = over_abscissa && !curve->x.empty() ? curve->x : curve->a;
            const bool reference = curve == &truth;
            Series series{.title = fmt::format("{}{}", whose.empty() ? "" : whose + ", ",
                                               reference ? "reference" : "published recursion"),
                          .style = reference ? Series::Style::wide : Series::Style::line,
                          .colour = static_cast<Colour>(reference ? colour : vermilion)};
            for (const auto k : thinned(values.size(), 81)) {
                if (!std::isfinite(values[k])) {
                    if (!series.rows.empty()) series.rows.emplace_back();
                    continue;
                }
                series.rows.push_back({x[k], values[k]});
                if (reference) low = std::min(low, values[k]), high = std::max(high, values[k]);
            }
            if (!series.rows.empty()) figure.series.push_back(std::move(series));
        }
        break;  // the first of two wheels, or of several springs
    }
    if (figure.series.empty() || !(high - low > 1e-6 * std::max(1e-3, std::abs(high))))
        return std::nullopt;
    figure.description = fmt::format("{} over {}: by the reference between {} and {}.", figure.y,
                                     x_axis, number(low, 3), number(high, 3));
    group.caption = fmt::format("{} over {}, {}.", drawn.title, x_axis, branch["name"].text());
    group.table = {.caption = figure.y, .columns = {{x_axis}}, .folded = true};
    for (const auto& series : figure.series) group.table.columns.push_back({series.title});
    for (const auto k : thinned(figure.series.front().rows.size(), 7)) {
        const auto& first = figure.series.front().rows[k];
        if (first.empty()) continue;
        std::vector<std::string> row{number(first[0], 4)};
        for (const auto& series : figure.series) {
            const auto at = std::ranges::find_if(series.rows, [&](const auto& r) {
                return !r.empty() && std::abs(r[0] - first[0]) <= 1e-6 * (1 + std::abs(first[0]));
            });
            row.push_back(at == series.rows.end() ? "–" : number((*at)[1], 4));
        }
        group.table.rows.push_back(std::move(row));
    }
    group.figures.push_back(std::move(figure));
    return group;
}

}  // namespace

std::optional<Section> characteristics_section(const JsonCursor& scene) {
    const auto found = scene.find("characteristics");
    if (!found) return std::nullopt;
    Section section{.id = "characteristics", .title = "Kinematics and compliance"};
    const compare::Table at_design =
                             read_table((*found)["design"], compare::characteristic_table({})),
                         compliance =
                             read_table((*found)["compliance"], compare::compliance_table({}, {}));
    bool travelled = false, steered = false;
    for (const auto& branch : scene["branches"].items()) {
        const auto moved = branch["drivers"]["moved"].texts();
        const bool jack =
            std::ranges::any_of(moved, [](const auto& name) { return name.ends_with("jack"); });
        const bool travel =
            jack || (branch["unit"].text() == "N" && !abscissa_of(scene, branch).empty() &&
                     abscissa_of(scene, branch).find("travel") != std::string::npos &&
                     branch["drivers"]["held"].texts().empty());
        const bool steering =
            !jack && branch["unit"].text() != "N" && branch["unit"].text() != "N·m";
        if (travel && !travelled) {
            travelled = true;
            for (const auto& drawn : over_travel)
                if (auto made = figure(scene, branch, drawn, abscissa_of(scene, branch), true))
                    section.figures.push_back(std::move(*made));
        } else if (steering && !steered) {
            steered = true;
            for (const auto& drawn : over_steering)
                if (auto made =
                        figure(scene, branch, drawn, sweep_of(scene, branch).parameter(), false))
                    section.figures.push_back(std::move(*made));
        }
    }
    section.tables.push_back(figures_table(at_design));
    for (const char* point : {"contact patch", "wheel centre"})
        if (auto table = matrix_table(compliance, point))
            section.tables.push_back(std::move(*table));
    double worst = 0;
    for (std::size_t r = 0; r < compliance.rows.size(); ++r)
        if (words(compliance, r, "leg") != "recursive" && reports::number(compliance, r, "a") == 0)
            worst = std::max(worst, reports::number(compliance, r, "reciprocity"));
    if (!compliance.rows.empty()) section.words["reciprocity"] = number(worst, 2);
    return section;
}

}  // namespace elastocheck::reports
