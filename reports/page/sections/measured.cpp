#include "reports/page/sections/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/numbers.hpp"
#include "reports/page/sections/common.hpp"
#include "reports/page/sections/sections.hpp"

namespace elastocheck::reports {

bool measured_over_parameter(const Field& scene) {
    const auto measured = scene.find("measured");
    return measured && !measured->find("abscissa");
}

std::optional<Series> measured_series(const Field& scene, const Sweep& sweep, const std::string& channel,
                                      bool change) {
    const auto measured = scene.find("measured");
    if (!measured) return std::nullopt;
    const Field columns = (*measured)["columns"];
    const auto abscissa = measured->find("abscissa");
    const auto across = abscissa ? columns.find(abscissa->text()) : measured->find("parameter");
    const auto column = channel.empty() ? measured->find("parameter") : columns.find(channel);
    if (!across || !column) return std::nullopt;
    const auto x = across->numbers(), y = column->numbers();
    const auto of = (*measured)["branch"].texts();
    if (x.size() != y.size() || of.size() != x.size()) column->fail("not as many numbers as points");
    Series series{"measured", Series::Style::rings, purple, 5};
    for (const auto& branch : sweep.branches) {
        const std::string name = branch["name"].text();
        const LegCurve curve = curve_of(branch, "equilibrium");
        double first = 0;
        if (change)
            if (const auto values = curve.channel(channel); !values.empty()) first = values[curve.start()];
        for (std::size_t k = 0; k < x.size(); ++k)
            if (of[k] == name) series.rows.push_back({x[k], y[k] - first});
    }
    if (series.rows.empty()) return std::nullopt;
    return series;
}

std::optional<Series> measured_for(const Field& scene, const Sweep& sweep, const Field& branch,
                                   const std::string& channel, bool change) {
    const auto measured = scene.find("measured");
    if (!measured || !(*measured)["branch_given"].truth())
        return measured_series(scene, sweep, channel, change);
    return measured_series(scene, {sweep.name, sweep.unit, sweep.abscissa, {branch}}, channel, change);
}

double value_between(const Series& measured, double x) {
    auto rows = measured.rows;
    std::erase_if(rows, [](const auto& row) { return !std::isfinite(row[0]) || !std::isfinite(row[1]); });
    std::ranges::sort(rows);
    for (std::size_t k = 1; k < rows.size(); ++k) {
        const auto &a = rows[k - 1], &b = rows[k];
        if (a[0] <= x && x <= b[0] && a[0] < b[0]) return a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
    }
    return NAN;
}

std::optional<Section> measured_section(const Field& scene) {
    const auto measured = scene.find("measured");
    if (!measured) return std::nullopt;
    Section section{.id = "measured", .title = "Against the measurement"};
    section.words = {{"over_load", measured_over_parameter(scene)},
                     {"file", (*measured)["file"].text()},
                     {"hash", (*measured)["hash"].text()},
                     {"points", (*measured)["points"].whole()}};
    for (const auto& reading : (*measured)["readings"].items()) {
        Table table{.caption = fmt::format("Deviation from the measurement, {}", reading["reading"].text()),
                    .columns = {{"output", true},
                                {"points"},
                                {"published recursion, max"},
                                {"rms"},
                                {"equilibrium, max"},
                                {"rms"},
                                {"energy, max"},
                                {"rms"}}};
        for (const auto& row : reading["channels"].items()) {
            std::vector<std::string> cells{fmt::format("{} [{}]", row["channel"].text(), row["unit"].text()),
                                           whole_number(row["compared"].whole())};
            for (const char* leg : {"recursive", "equilibrium", "energy"}) {
                cells.push_back(signed_number(row[leg]["signed_max"].number()));
                cells.push_back(number(row[leg]["rms"].number(), 2));
            }
            table.rows.push_back(cells);
        }
        section.tables.push_back(std::move(table));
    }
    return section;
}

}  // namespace elastocheck::reports
