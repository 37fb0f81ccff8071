#include "reports/document/curves.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "reports/json/json_cursor.hpp"
#include "reports/tables/render.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {

std::string curves_csv(const nlohmann::ordered_json& result, const std::string& file) {
    std::string csv = "scene,branch,leg,parameter,parameter unit,output,unit,value\n";
    for (const auto& scene : JsonCursor{&result, "", &file}["scenes"].items()) {
        if (!scene.find("branches")) continue;
        for (const auto& branch : scene["branches"].items())
            for (const auto& leg : branch["legs"].items()) {
                const JsonCursor curve = leg["curve"], columns = curve["values"];
                const auto a = curve["a"].numbers();
                const std::string unit = for_csv(branch["unit"].text());
                const std::string whose = for_csv(scene["name"].text()) + "," +
                                          for_csv(branch["name"].text()) + "," +
                                          for_csv(leg["leg"].text());
                for (const auto& channel : scene["channels"].items()) {
                    const std::string name = channel["name"].text();
                    const std::string what = for_csv(name) + "," + for_csv(channel["unit"].text());
                    const auto values = columns[name].numbers();
                    if (values.size() != a.size())
                        columns[name].fail("not as many numbers as parameters");
                    for (std::size_t k = 0; k < values.size(); ++k)
                        csv += fmt::format(
                            "{},{},{},{},{}\n", whose, a[k], unit, what,
                            std::isnan(values[k]) ? "" : fmt::format("{:.17g}", values[k]));
                }
            }
    }
    return csv;
}

std::string forces_csv(const nlohmann::ordered_json& result, const std::string& file) {
    const compare::Table one = compare::force_table({});
    compare::Table all = one;
    all.columns.insert(all.columns.begin(), compare::Column{.name = "scene", .words = true});
    for (const auto& scene : JsonCursor{&result, "", &file}["scenes"].items()) {
        const auto forces = scene.find("forces");
        if (!forces) continue;
        for (auto row : read_table(*forces, one).rows) {
            row.insert(row.begin(), compare::Cell(scene["name"].text()));
            all.rows.push_back(std::move(row));
        }
    }
    return csv(all);
}

}  // namespace elastocheck::reports
