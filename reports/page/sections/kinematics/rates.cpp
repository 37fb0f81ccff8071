// Section: kinematic and compliance rates at the design position, by what causes them.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/tables/rows.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/kinematics/cases.hpp"

namespace elastocheck::reports {
namespace {

using compare::CharacteristicRow;
using Design = std::vector<CharacteristicRow>;

// A rate of each wheel, or of its spring or damper, which has the wheel's name in its own; or a rate
// of the axle, the same for all wheels.
struct Rate {
    std::string name, unit, definition{};
    compare::Properties properties{};
    std::vector<std::optional<CharacteristicRow>> rows{};  // one a wheel in their order
};

std::vector<Rate> rates_of(const Design& design, const std::vector<Wheel>& wheels) {
    std::vector<Rate> rates;
    for (const auto& r : design) {
        const auto dot = r.output.rfind('.');
        const std::string owner = dot == r.output.npos ? "" : r.output.substr(0, dot);
        const auto wheel =
            owner.empty() && wheels.size() > 1 ? std::nullopt : wheel_of(owner, wheels);
        const std::string stem = wheel ? wheel->first : owner,
                          name = (stem.empty() ? "" : stem + " ") +
                                 as_words(owner.empty() ? r.output : r.output.substr(dot + 1));
        auto known = wheel ? std::ranges::find(rates, name, &Rate::name) : rates.end();
        if (known == rates.end()) {
            const compare::Entry* entry = compare::find_entry(r.output);
            rates.push_back({name, r.unit, r.definition});
            known = rates.end() - 1;
            if (entry != nullptr) known->properties = entry->properties;
            known->rows.resize(std::max<std::size_t>(1, wheels.size()));
        }
        if (wheel)
            known->rows[wheel->second] = r;
        else
            std::ranges::fill(known->rows, r);
    }
    return rates;
}

Table rates_table(const std::vector<Rate>& rates, const std::vector<Wheel>& wheels,
                  std::string caption) {
    std::vector<compare::ColumnOf<Rate>> columns{{"rate", Digits::words, &Rate::name}};
    for (std::size_t k = 0; k < std::max<std::size_t>(1, wheels.size()); ++k)
        columns.push_back({wheels.size() < 2 ? "value" : wheels[k].name, Digits::four,
                           [=](const Rate& r) -> compare::AnyCell {
                               if (!r.rows[k]) return "";
                               if (!r.rows[k]->undefined.empty()) return "none";
                               return r.rows[k]->value;
                           }});
    columns.push_back(
        {"unit", Digits::words, [](const Rate& r) { return r.unit == "-" ? "" : r.unit; }});
    Table table = compare::table({.caption = std::move(caption)}, columns, rates);
    for (const auto& rate : rates)
        for (const auto& row : rate.rows)
            if (const std::string why = row ? row->undefined : "";
                !why.empty() && (table.notes.empty() || !table.notes.back().starts_with(rate.name)))
                table.notes.push_back(fmt::format("{}: {}", rate.name, why));
    return table;
}

Design design_of(const SceneAnalyses& scene) {
    return scene.model.wheels.empty() ? Design{} : characteristic_rows(scene.comparison);
}

}  // namespace

Table key_rates(const SceneAnalyses& scene) {
    const auto design = design_of(scene);
    if (design.empty()) return {};
    auto rates = rates_of(design, scene.model.wheels);
    std::erase_if(rates, [](const Rate& rate) { return !rate.properties.is_key_figure; });
    return rates_table(
        rates, scene.model.wheels,
        "Key figures at the design position (lateral forces towards the middle of the vehicle, "
        "braking to the back, traction forward; toe-in positive)");
}

std::optional<Section> rates_section(const SceneAnalyses& scene) {
    const auto design = design_of(scene);
    if (design.empty()) return std::nullopt;
    Section section{.id = "rates", .title = "Rates", .part = Part::behaviour};
    const auto rates = rates_of(design, scene.model.wheels);
    std::vector<std::pair<std::string, std::vector<Rate>>> groups;
    for (const auto& rate : rates) {
        const std::string cause = rate.properties.compliance ? "compliance" : rate.properties.cause;
        auto known =
            std::ranges::find(groups, cause, [](const auto& group) { return group.first; });
        if (known == groups.end()) known = groups.emplace(known, cause, std::vector<Rate>{});
        known->second.push_back(rate);
    }
    for (const auto& [cause, of_group] : groups)
        section.tables.push_back(
            rates_table(of_group, scene.model.wheels, "At the design position: " + cause));
    section.tables.push_back(compare::table<Rate>(
        {.caption = "Definitions of the rates", .detail = true},
        {{"rate", Digits::words, &Rate::name}, {"definition", Digits::note, &Rate::definition}},
        rates));
    return section;
}

}  // namespace elastocheck::reports
