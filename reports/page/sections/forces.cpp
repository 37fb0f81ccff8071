// Section: largest forces of bushings, springs and links in their own axes; a beam is one element.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/tables/rows.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
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

using compare::ForceRow;

double size_of(const ForceRow* row) { return row == nullptr ? 0 : std::abs(row->value); }

// The largest force and the largest moment of an element; null where it has none.
struct Largest {
    std::string element;
    const ForceRow *force = nullptr, *moment = nullptr;
};

}  // namespace

std::optional<Section> forces_section(const JsonCursor& scene) {
    const auto field = scene.find("forces");
    if (!field) return std::nullopt;
    const auto forces = read_rows<ForceRow>(*field);
    const Elements elements = elements_of(scene);
    std::vector<Largest> largest;
    std::map<std::tuple<std::string, double, std::string>, const ForceRow*> at;
    for (const auto& r : forces) {
        at[{r.branch, r.end, r.output}] = &r;
        if ((r.unit != "N" && r.unit != "N·m") || !(size_of(&r) > nothing)) continue;
        std::string name = r.element;
        if (const auto beam = elements.beam_of.find(name); beam != elements.beam_of.end())
            name = beam->second;
        auto known = std::ranges::find(largest, name, &Largest::element);
        if (known == largest.end()) known = largest.insert(largest.end(), Largest{name});
        auto& row = r.unit == "N" ? known->force : known->moment;
        if (size_of(&r) > size_of(row)) row = &r;
    }
    if (largest.empty()) return std::nullopt;
    std::ranges::stable_sort(largest, std::ranges::greater{},
                             [&](const Largest& l) { return size_of(l.force); });
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
    const auto cells = [&](const ForceRow* r) -> std::vector<std::string> {
        if (r == nullptr) return {"", "", ""};
        const auto deformed = at.find({r->branch, r->end, deformation_of(r->output)});
        std::string by;
        if (deformed != at.end()) {
            double value = deformed->second->value;
            const auto stop = elements.clearance.find(r->element);
            if (stop != elements.clearance.end())
                value = std::max(0.0, std::abs(value) - stop->second);
            by = quantity(value, deformed->second->unit);
        }
        const char axis = r->output.back();
        return {
            number(r->value),
            fmt::format("{}{}, {} {}", axis >= 'x' && axis <= 'z' ? std::string{axis} + ", " : "",
                        r->branch, number(r->end), r->end_unit),
            by};
    };
    for (const auto& l : largest) {
        std::vector<std::string> row{l.element};
        for (const auto* r : {l.force, l.moment}) {
            const auto three = cells(r);
            row.insert(row.end(), three.begin(), three.end());
        }
        table.rows.push_back(std::move(row));
    }
    section.tables.push_back(std::move(table));
    return section;
}

}  // namespace elastocheck::reports
