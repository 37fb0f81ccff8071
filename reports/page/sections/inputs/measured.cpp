#include "reports/page/sections/inputs/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

bool measured_over_parameter(const JsonCursor& scene, const Sweep& sweep) {
    const auto measured = scene.find("measured");
    if (!measured) return false;
    const auto abscissa = measured->find("abscissa");
    if (!abscissa) return true;
    const auto x = (*measured)["columns"][abscissa->text()].numbers();
    const auto of = (*measured)["branch"].texts();
    bool points = false, travel = false;
    for (std::size_t k = 0; k < of.size() && k < x.size(); ++k)
        if (sweep.has(of[k])) points = true, travel = travel || std::isfinite(x[k]);
    return points && !travel;
}

std::optional<Series> measured_series(const JsonCursor& scene, const Sweep& sweep,
                                      const std::string& by, const std::string& channel) {
    const auto measured = scene.find("measured");
    if (!measured) return std::nullopt;
    const JsonCursor columns = (*measured)["columns"];
    const auto across = by.empty() ? measured->find("parameter") : columns.find(by);
    const auto column = columns.find(channel);
    if (!across || !column) return std::nullopt;
    const auto x = across->numbers(), y = column->numbers();
    const auto of = (*measured)["branch"].texts();
    if (x.size() != y.size() || of.size() != x.size())
        column->fail("not as many numbers as points");
    Series series{.title = "measured", .style = Series::Style::rings, .colour = purple, .mark = 5};
    bool any = false;
    for (std::size_t k = 0; k < x.size(); ++k)
        if (sweep.has(of[k]) && std::isfinite(x[k]))
            series.rows.push_back({x[k], y[k]}), any = any || std::isfinite(y[k]);
    if (!any) return std::nullopt;
    return series;
}

std::optional<Section> measured_section(const JsonCursor& scene) {
    const auto measured = scene.find("measured");
    if (!measured) return std::nullopt;
    Section section{
        .id = "measured", .title = "Comparison with the measurement", .part = Part::behaviour};
    bool over_load = false;
    if (scene.find("branches"))
        for (const auto& sweep : sweeps_of(scene))
            over_load =
                over_load || (measured_over_parameter(scene, sweep) && !sweep.abscissa.empty());
    section.words = {{"over_load", over_load},
                     {"file", (*measured)["file"].text()},
                     {"hash", (*measured)["hash"].text()},
                     {"points", (*measured)["points"].whole()}};
    if (const auto left_out = measured->find("left_out"); left_out && !left_out->texts().empty())
        section.words["left_out"] = enumerated(left_out->texts());
    if (const auto findings = measured->find("findings"); findings && !findings->texts().empty())
        section.words["findings"] = enumerated(findings->texts());
    for (const auto& reading : (*measured)["readings"].items()) {
        Table table{
            .caption = fmt::format("Deviation from the measurement, {}", reading["reading"].text()),
            .columns = {{"test", true},
                        {"output", true},
                        {"points"},
                        {"gradient measured"},
                        {"of the model"},
                        {"unit", true},
                        {"full solution, max"},
                        {"rms"},
                        {"published recursion, max"},
                        {"rms"}}};
        for (const auto& row : reading["channels"].items()) {
            const JsonCursor gradient = row["gradient"];
            std::vector<std::string> cells{
                row["branch"].text(),
                fmt::format("{} [{}]", row["channel"].text(), row["unit"].text()),
                whole_number(row["compared"].whole()),
                signed_number(gradient["measured"].number()),
                signed_number(gradient["model"].number()),
                gradient["unit"].text()};
            for (const char* leg : {"equilibrium", "recursive"}) {
                cells.push_back(signed_number(row[leg]["signed_max"].number()));
                cells.push_back(number(row[leg]["rms"].number(), 2));
            }
            table.rows.push_back(cells);
        }
        if (!table.rows.empty()) section.tables.push_back(std::move(table));
    }
    if (const auto loops = measured->find("loops"); loops && !loops->items().empty()) {
        Table table{
            .caption = "Hysteresis of the measurement: its two ways, whose mean is compared",
            .columns = {
                {"branch", true}, {"output", true}, {"largest width"}, {"at", true}, {"points"}}};
        for (const auto& loop : loops->items())
            table.rows.push_back(
                {loop["branch"].text(),
                 fmt::format("{} [{}]", loop["channel"].text(), loop["unit"].text()),
                 number(loop["width"].number(), 2),
                 fmt::format("{:.4g} {}", loop["at"].number(), loop["at_unit"].text()),
                 whole_number(loop["points"].whole())});
        section.tables.push_back(std::move(table));
    }
    return section;
}

}  // namespace elastocheck::reports
