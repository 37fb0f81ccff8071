// Section: largest forces of bushings, springs and links in their own axes; a beam is one element.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/tables/table.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/tables/render.hpp"
#include "reports/tables/select.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

constexpr std::size_t most_elements = 40;
constexpr double nothing = 1e-6;  // [N], [N·m]

// Deformation conjugate to a force: "mount.displacement_x" for "mount.elastic_force_x".
std::string deformation_of(std::string output) {
    constexpr std::pair<const char*, const char*> pairs[] = {{".elastic_force_", ".displacement_"},
                                                             {".elastic_moment_", ".rotation_"},
                                                             {".force", ".deflection"},
                                                             {".moment", ".angle"}};
    for (const auto& [force, deformation] : pairs)
        if (const auto at = output.rfind(force); at != std::string::npos)
            return output.replace(at, std::string(force).size(), deformation);
    return {};
}

// Beams of segments, and clearances of stops [mm].
struct Elements {
    std::map<std::string, std::string> beam_of;
    std::map<std::string, double> clearance;
};
Elements elements_of(const JsonCursor& scene) {
    Elements elements;
    if (const auto list = scene.find("elements"))
        for (const auto& element : list->items()) {
            const std::string name = element["name"].text(), kind = element["kind"].text();
            if (kind == "beam") elements.beam_of[name] = element["beam"].text();
            if (kind == "stop") elements.clearance[name] = element["clearance_mm"].number();
        }
    return elements;
}

// Rows of the largest force and the largest moment of an element; none where it has neither.
struct Largest {
    std::string element;
    std::optional<std::size_t> force, moment;
};

}  // namespace

std::optional<Section> forces_section(const JsonCursor& scene) {
    const auto field = scene.find("forces");
    if (!field) return std::nullopt;
    const compare::Table forces = read_table(*field, compare::force_table({}));
    const Elements elements = elements_of(scene);
    const auto size = [&](std::size_t r) { return std::abs(number(forces, r, "value")); };
    std::vector<Largest> largest;
    std::map<std::tuple<std::string, double, std::string>, std::size_t> at;  // branch, end, output
    for (std::size_t r = 0; r < forces.rows.size(); ++r) {
        at[{words(forces, r, "branch"), number(forces, r, "end"), words(forces, r, "output")}] = r;
        const std::string& unit = words(forces, r, "unit");
        if ((unit != "N" && unit != "N·m") || !(size(r) > nothing)) continue;
        std::string name = words(forces, r, "element");
        if (const auto beam = elements.beam_of.find(name); beam != elements.beam_of.end())
            name = beam->second;
        auto known = std::ranges::find(largest, name, &Largest::element);
        if (known == largest.end()) known = largest.insert(largest.end(), Largest{name, {}, {}});
        auto& row = unit == "N" ? known->force : known->moment;
        if (!row || size(r) > size(*row)) row = r;
    }
    if (largest.empty()) return std::nullopt;
    std::ranges::stable_sort(largest, std::ranges::greater{},
                             [&](const Largest& l) { return l.force ? size(*l.force) : 0; });
    Section section{
        .id = "forces", .title = "Forces in bushings, springs and links", .part = Part::behaviour};
    if (largest.size() > most_elements) {
        section.words["left_out"] = whole_number(static_cast<long>(largest.size() - most_elements));
        largest.resize(most_elements);
    }
    Table table{.caption = "Largest force and moment of each element at the ends of the branches",
                .columns = {{"element", true},
                            {"largest force [N]"},
                            {"where", true},
                            {"deformed by"},
                            {"largest moment [N·m]"},
                            {"where", true},
                            {"deformed by"}}};
    const auto cells = [&](std::optional<std::size_t> r) -> std::vector<std::string> {
        if (!r) return {"", "", ""};
        const std::string &output = words(forces, *r, "output"),
                          &element = words(forces, *r, "element");
        const std::string deformation = deformation_of(output);
        const auto deformed =
            at.find({words(forces, *r, "branch"), number(forces, *r, "end"), deformation});
        std::string by;
        if (deformed != at.end()) {
            double value = number(forces, deformed->second, "value");
            const auto stop = elements.clearance.find(element);
            if (stop != elements.clearance.end())
                value = std::max(0.0, std::abs(value) - stop->second);
            by = quantity(value, words(forces, deformed->second, "unit"));
        }
        const char axis = output.back();
        return {
            number(number(forces, *r, "value")),
            fmt::format("{}{}, {} {}", axis >= 'x' && axis <= 'z' ? std::string{axis} + ", " : "",
                        words(forces, *r, "branch"), number(number(forces, *r, "end")),
                        words(forces, *r, "end unit")),
            by};
    };
    for (const auto& l : largest) {
        std::vector<std::string> row{l.element};
        for (const auto r : {l.force, l.moment}) {
            const auto three = cells(r);
            row.insert(row.end(), three.begin(), three.end());
        }
        table.rows.push_back(std::move(row));
    }
    section.tables.push_back(std::move(table));
    return section;
}

}  // namespace elastocheck::reports
