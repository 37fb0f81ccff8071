#include "reports/document/curves.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "compare/tables/rows.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/render/render.hpp"
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

namespace {

struct SceneForce {
    std::string scene{};
    compare::ForceRow force{};
};
void describe(auto& field, compare::Described<SceneForce> auto& r) {
    field("scene", r.scene);
    describe(field, r.force);
}

}  // namespace

std::string forces_csv(const nlohmann::ordered_json& result, const std::string& file) {
    std::vector<SceneForce> all;
    for (const auto& scene : JsonCursor{&result, "", &file}["scenes"].items())
        if (const auto forces = scene.find("forces"))
            for (const auto& row : read_rows<compare::ForceRow>(*forces))
                all.push_back({scene["name"].text(), row});
    return csv(all);
}

}  // namespace elastocheck::reports
