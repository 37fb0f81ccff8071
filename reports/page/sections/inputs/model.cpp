// Section: the compiled model.
#include <fmt/format.h>

#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

template <class Part>
std::string names_of(const std::vector<Part>& parts) {
    std::vector<std::string> names;
    for (const auto& part : parts) names.push_back(part.name);
    return enumerated(names);
}

// What the model is made of, and what the trim made of it.
Table parts(const SceneAnalyses& scene) {
    const Model& model = scene.model;
    const auto& d = scene.diagnosis;
    Table table = words_table("The model", {"what", "as compiled"});
    const auto row = [&](const char* what, const std::string& value) {
        if (!value.empty()) table.rows.push_back({what, value});
    };
    row("bodies", names_of(model.bodies));
    row("joints", names_of(model.joints));
    row("elastic elements", names_of(model.elastics));
    row("coordinates", whole_number(d.coordinates));
    row("constraints", whole_number(d.rows));
    row("unknowns", whole_number(d.coordinates + d.rows));
    row("degrees of freedom", whole_number(d.degrees_of_freedom()));
    std::vector<std::string> idle;
    for (const auto& mode : d.idle) idle.push_back(mode.description);
    row("idle modes", enumerated(idle));
    for (const auto& r : d.redundant)
        row("redundant", fmt::format("{}: {} rows",
                                     model.joints[static_cast<std::size_t>(r.joint)].name, r.rows));
    for (const auto& omitted : model.omitted)
        row("left out", fmt::format("{}: {}", omitted.what, omitted.why));
    row("force and moment imbalance at the design position",
        fmt::format("{} N", number(d.imbalance, 2)));
    row("condition number, equilibrated (raw)",
        fmt::format("{} ({})", number(scene.conditioning.equilibrated, 2),
                    number(scene.conditioning.raw, 2)));
    if (!scene.trim) return table;
    for (const auto& a : scene.trim->adjusted)
        row("trimmed",
            fmt::format("{}: {} {}, {}", a.name, number(a.by, 5), symbol(a.unit), a.makes));
    for (const auto& c : scene.trim->conditions)
        row("trimmed until",
            fmt::format("{} = {} {}, met to {}, confirmed by {} to {}", c.name, number(c.target),
                        symbol(c.unit), number(std::abs(c.missed), 2),
                        name(scene.trim->confirmed_by), number(std::abs(c.confirmed), 2)));
    return table;
}

}  // namespace

std::optional<Section> model_section(const SceneAnalyses& scene) {
    Section section{.id = "model", .title = "The model as compiled", .part = Part::evidence};
    section.words = {{"source", scene.scene.source}, {"hash", scene.hash}};
    section.tables.push_back(parts(scene));
    Table outputs = words_table("Outputs and their definitions", {"output", "unit", "definition"});
    for (const auto& channel : scene.comparison.channels)
        if (channel.main || channel.kinematic())
            outputs.rows.push_back({channel.name, symbol(channel.unit), channel.definition});
    section.tables.push_back(std::move(outputs));
    return section;
}

}  // namespace elastocheck::reports
