// Section: head of the page with the load cases, what the wheels stand on, and the conventions of signs.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compare/outputs/wheel_load.hpp"
#include "models/kinds.hpp"
#include "reports/document/document.hpp"
#include "reports/given/wheels.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

// What the wheels stand on in a branch.
std::string supports_of(const Model& model, const Branch& branch) {
    std::set<std::string> kinds;
    for (const auto& driver : branch.drivers) {
        const int joint = driven_joint(driver.what), element = driven_element(driver.what);
        if (joint >= 0 && compare::wheel_on_jack(model, joint))
            kinds.insert(driver.rate != 0 ? "jacks that move" : "jacks at held height");
        if (element >= 0 && compare::wheel_on_tyre(model, element)) kinds.insert("their tyres");
    }
    if (kinds.empty()) return "dead forces, free in height";
    return enumerated({kinds.begin(), kinds.end()});
}

// Drivers that move with the parameter: "lateral left and lateral right (opposed)".
std::string moved_in(const Model& model, const Branch& branch) {
    std::vector<std::string> names;
    for (const auto& driver : branch.drivers)
        if (driver.rate != 0)
            names.push_back(as_words(driven_name(model, driver.what)) +
                            (driver.rate < 0 ? " (opposed)" : ""));
    for (auto& name : names) std::ranges::replace(name, '.', ' ');
    return enumerated(names);
}

}  // namespace

std::optional<Section> conditions_section(const SceneAnalyses& scene) {
    const Model& model = scene.model;
    if (model.wheels.empty() || scene.only == "evidence") return std::nullopt;
    Section section{.id = "conditions", .title = "Test conditions and signs"};
    std::vector<std::string> rolling, fixed, tyres, loads;
    for (const auto& wheel : model.wheels) {
        (wheel.rolls() ? rolling : fixed).push_back(wheel.name);
        if (wheel.tyre_rate > 0)
            tyres.push_back(fmt::format("{}{}{} N/mm", wheel.name, wheel.name.empty() ? "" : " ",
                                        short_number(1e-3 * wheel.tyre_rate)));
    }
    auto& words = section.words;
    words["rolls"] = fixed.empty();
    words["fixed"] = rolling.empty();
    words["several"] = model.wheels.size() > 1;
    if (!tyres.empty()) words["tyres"] = enumerated(tyres);
    for (const auto& load : model.static_loads) {
        const std::string name =
            load.name.starts_with("gravity.") ? "weights" : as_words(load.name);
        if (std::ranges::find(loads, name) == loads.end()) loads.push_back(name);
    }
    if (!loads.empty()) words["loads"] = enumerated(loads);
    words["trim"] = scene.trim.has_value();
    if (const auto& vehicle = model.vehicle)
        words["vehicle"] = {{"wheelbase", short_number(1e3 * vehicle->wheelbase)},
                            {"height", short_number(1e3 * vehicle->cg_height)},
                            {"brake", percent(vehicle->brake_share)},
                            {"drive", percent(vehicle->drive_share)}};
    using B = ComparedBranch;
    Table table = compare::table<B>(
        {.caption = "Load cases"},
        {{"load case", Digits::words, [](const B& b) { return as_words(b.name()); }},
         {"test", Digits::words, [&](const B& b) { return load_case(model, *b.requested); }},
         {"from", Digits::place, [](const B& b) { return b.from(); }},
         {"to", Digits::place, [](const B& b) { return b.to(); }},
         {"unit", Digits::words, [](const B& b) { return b.unit(); }},
         {"moves", Digits::words, [&](const B& b) { return moved_in(model, *b.requested); }},
         {"the wheels stand on", Digits::words,
          [&](const B& b) { return supports_of(model, *b.requested); }}},
        branches_of(scene));
    section.tables.push_back(std::move(table));
    return section;
}

}  // namespace elastocheck::reports
