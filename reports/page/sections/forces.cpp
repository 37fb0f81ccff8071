// Sections: largest forces of bushings, springs and links in their own axes, a beam being one element;
// loads at the pickup points under cases.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "models/kinds.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/tables/elements.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

constexpr std::size_t max_elements = 40;

// Beams of segments, and clearances of stops [mm].
struct Elements {
    std::map<std::string, std::string> beam_of{};
    std::map<std::string, double> clearance{};

    explicit Elements(const Model& model) {
        for (const auto& elastic : model.elastics)
            if (elastic.written_as == WrittenAs::beam)
                beam_of[elastic.name] = elastic.name.substr(0, elastic.name.rfind('.'));
            else if (const auto* law = member<ScalarLaw>(elastic.kind);
                     elastic.written_as == WrittenAs::stop && law != nullptr)
                if (const auto free = clearance_of(*law)) clearance[elastic.name] = 1e3 * *free;
    }
};

using compare::LargestForceRow;

double size_of_force(const LargestForceRow* row) {
    return row == nullptr ? 0 : std::abs(row->value);
}

// The largest force and the largest moment of an element; null where it has none.
struct Largest {
    std::string element;
    const LargestForceRow *force = nullptr, *moment = nullptr;
};

// A row for every element, in descending order of the force; the segments of a beam are one element.
std::vector<Largest> largest_of(const std::vector<LargestForceRow>& forces,
                                const Elements& elements) {
    std::vector<Largest> largest;
    for (const auto& r : forces) {
        std::string name = r.element;
        if (const auto beam = elements.beam_of.find(name); beam != elements.beam_of.end())
            name = beam->second;
        auto known = std::ranges::find(largest, name, &Largest::element);
        if (known == largest.end()) known = largest.insert(largest.end(), Largest{name});
        auto& row = r.unit == "N" ? known->force : known->moment;
        if (size_of_force(&r) > size_of_force(row)) row = &r;
    }
    std::ranges::stable_sort(largest, std::ranges::greater{},
                             [&](const Largest& l) { return size_of_force(l.force); });
    return largest;
}

// "z, jounce, 3000 N"
std::string place_of(const LargestForceRow* r) {
    if (r == nullptr) return "";
    const char axis = r->output.back();
    return fmt::format("{}{}, {} {}", axis >= 'x' && axis <= 'z' ? std::string{axis} + ", " : "",
                       r->branch, short_number(r->at), r->parameter_unit);
}

// The deformation at the largest force; of a stop its penetration.
std::string deformation_of(const LargestForceRow* r, const Elements& elements) {
    if (r == nullptr || !std::isfinite(r->deformation)) return "";
    double value = r->deformation;
    const auto stop = elements.clearance.find(r->element);
    if (stop != elements.clearance.end()) value = std::max(0.0, std::abs(value) - stop->second);
    return quantity(value, r->deformation_unit);
}

}  // namespace

std::optional<Section> forces_section(const SceneAnalyses& scene) {
    const auto forces = largest_force_rows(scene.comparison);
    const Elements elements(scene.model);
    auto largest = largest_of(forces, elements);
    if (largest.empty()) return std::nullopt;
    Section section{
        .id = "forces", .title = "Forces in bushings, springs and links", .part = Part::behaviour};
    std::vector<std::string> events;
    for (std::size_t b = 0; b < scene.lift_offs.size(); ++b)
        for (const auto& event : scene.lift_offs[b])
            events.push_back(fmt::format("{} ({})", event, scene.model.branches[b].name));
    if (!events.empty()) section.words["events"] = enumerated(events);
    if (largest.size() > max_elements) {
        section.words["left_out"] = whole_number(static_cast<long>(largest.size() - max_elements));
        largest.resize(max_elements);
    }
    using enum Digits;
    using L = Largest;
    std::vector<compare::ColumnOf<L>> columns{{"element", words, &L::element}};
    for (const auto& [name, unit, row] :
         {std::tuple{"largest force", "N", &L::force}, {"largest moment", "N·m", &L::moment}}) {
        columns.push_back({name, three,
                           [row](const L& l) -> compare::AnyCell {
                               if (l.*row == nullptr) return "";
                               return (l.*row)->value;
                           },
                           "", unit});
        columns.push_back({"where", words, [row](const L& l) { return place_of(l.*row); }});
        columns.push_back({"deformed by", words,
                           [&, row](const L& l) { return deformation_of(l.*row, elements); }});
    }
    Table table = compare::table(
        {.caption = "Largest force and moment of each element over all points of the branches"},
        columns, largest);
    section.tables.push_back(std::move(table));
    return section;
}

std::optional<Section> loads_section(const SceneAnalyses& scene) {
    if (!scene.loads) return std::nullopt;
    const auto& [grade, sentence, reasons, compared, requested] = scene.loads->verdict;
    const bool confirmed = grade == compare::Grade::pass;
    Section section{.id = "loads",
                    .title = "Loads at the pickup points",
                    .part = Part::behaviour,
                    .mark = confirmed ? Mark::none : Mark::open,
                    .tables = scene.loads->tables};
    section.words = {{"sentence", sentence}, {"reasons", reasons}, {"notes", scene.loads->notes}};
    std::erase_if(section.tables, [](const Table& table) { return page_columns(table).empty(); });
    return section;
}

}  // namespace elastocheck::reports
