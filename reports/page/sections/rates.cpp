// Sections: kinematic and compliance rates at the design position; the compliance matrix and the
// errors of the recursion in the rates.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/tables/rows.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::CharacteristicRow;
using compare::ComplianceRow;
using Design = std::vector<CharacteristicRow>;

// A rate of each wheel; of a spring or damper of each wheel, which has the wheel's name in its own;
// or one, which all columns share.
struct Rate {
    std::string name, unit, definition;
    bool is_key = false;
    std::vector<std::optional<CharacteristicRow>> rows{};  // one a wheel in their order
};

std::vector<std::string> words_in(std::string name) {
    std::ranges::replace_if(
        name, [](char c) { return c == '_' || c == '.' || c == '-'; }, ' ');
    std::istringstream in(name);
    return {std::istream_iterator<std::string>(in), {}};
}

// "coil motion ratio" of "coil_left.motion_ratio", and the wheel: the only one with a word of the
// name in its own, "left"; none if there is no such wheel.
std::optional<std::pair<std::string, std::size_t>> of_wheel(const std::string& output,
                                                            const std::vector<Wheel>& wheels) {
    const auto dot = output.rfind('.');
    const std::string owner = dot == output.npos ? "" : output.substr(0, dot),
                      quantity = as_words(output.substr(dot + 1));
    std::optional<std::size_t> found;
    std::string others;
    for (const auto& word : words_in(owner)) {
        std::vector<std::size_t> with;
        for (std::size_t w = 0; w < wheels.size(); ++w) {
            if (wheels[w].name == owner) return std::pair{quantity, w};
            const auto own = words_in(wheels[w].name);
            if (std::ranges::find(own, word) != own.end()) with.push_back(w);
        }
        if (with.size() != 1) {
            others += word + " ";
            continue;
        }
        if (found && *found != with[0]) return std::nullopt;
        found = with[0];
    }
    if (!found) return std::nullopt;
    return std::pair{others + quantity, *found};
}

std::vector<Rate> rates_of(const Design& design, const std::vector<Wheel>& wheels) {
    std::vector<Rate> rates;
    for (const auto& r : design) {
        const auto mine = of_wheel(r.output, wheels);
        const std::string name = mine ? mine->first : as_words(r.output);
        auto known = mine ? std::ranges::find(rates, name, &Rate::name) : rates.end();
        if (known == rates.end()) {
            const compare::Entry* entry = compare::find_entry(r.output);
            rates.push_back({name, r.unit, r.definition, entry != nullptr && entry->is.key, {}});
            known = rates.end() - 1;
            known->rows.resize(std::max<std::size_t>(1, wheels.size()));
        }
        if (mine)
            known->rows[mine->second] = r;
        else
            std::ranges::fill(known->rows, r);
    }
    return rates;
}

double value_of(const Design& design, const Wheel& wheel, std::string_view rate) {
    const auto row = std::ranges::find(design, output_of(wheel, rate), &CharacteristicRow::output);
    return row == design.end() ? NAN : row->value;
}

// Of the roll stiffness of an axle the share of the anti-roll bar: what resists roll and not heave.
void add_share_of_bar(Table& table, const Design& design, const std::vector<Wheel>& wheels) {
    double roll = 0, heave = 0;
    for (const auto& wheel : wheels) {
        roll += value_of(design, wheel, compare::figure::wheel_rate_in_roll);
        heave += value_of(design, wheel, compare::figure::wheel_rate);
    }
    if (!(roll > heave)) return;
    const double share = 100 * (roll - heave) / roll;
    table.rows.push_back({"of roll stiffness, anti-roll bar", share, share, "%",
                          "what resists opposed travel and not parallel travel: 1 − wheel rate / "
                          "wheel rate in roll"});
}

Table rates_table(const Design& design, const std::vector<Wheel>& wheels,
                  bool only_key = false) {
    std::vector<Rate> rates = rates_of(design, wheels);
    std::erase_if(rates, [&](const Rate& rate) { return only_key && !rate.is_key; });
    std::vector<compare::ColumnOf<Rate>> columns{
        {"rate", Digits::words, [](const Rate& r) { return r.name; }}};
    for (std::size_t k = 0; k < std::max<std::size_t>(1, wheels.size()); ++k)
        columns.push_back({wheels.size() < 2 ? "value" : wheels[k].name, Digits::four,
                           [=](const Rate& r) -> compare::AnyCell {
                               if (!r.rows[k]) return "";
                               if (!r.rows[k]->undefined.empty()) return "none";
                               return r.rows[k]->value;
                           }});
    columns.push_back(
        {"unit", Digits::words, [](const Rate& r) { return r.unit == "-" ? "" : r.unit; }});
    if (!only_key)
        columns.push_back({"definition", Digits::note, [](const Rate& r) {
                               std::string why;
                               for (const auto& row : r.rows)
                                   if (row) why = row->undefined;
                               return why.empty() ? r.definition
                                                  : fmt::format("{}. Here: {}", r.definition, why);
                           }});
    Table table = compare::table("", columns, rates);
    table.caption = "Rates at the design position";
    if (wheels.size() == 2) add_share_of_bar(table, design, wheels);
    for (auto& row : table.rows) row.resize(table.columns.size());
    return table;
}

// ---- Evidence

// Compliance matrix of the equilibrium leg at the start of the first branch.
std::optional<Table> matrix_table(const std::vector<ComplianceRow>& compliance,
                                  std::string_view point) {
    auto rows = compliance;
    std::erase_if(rows, [&](const ComplianceRow& r) {
        return r.leg != "equilibrium" || r.point != point ||
               r.branch != compliance.front().branch || r.a != 0;
    });
    if (rows.empty()) return std::nullopt;
    std::vector<std::string> columns{"answer"};
    if (distinct(rows, &ComplianceRow::wheel).size() > 1)
        columns = {"wheel", "answer", "loaded wheel"};
    columns.insert(columns.end(), ComplianceRow::causes.begin(), ComplianceRow::causes.end());
    Table table = with_columns(compare::table_of(rows), columns);
    table.caption = fmt::format(
        "Compliance at the {}: displacement [mm] and rotation [deg] per kN and per 100 N·m, the "
        "wheel free",
        point);
    table.detail = true;
    return table;
}

// Errors of the recursion in the rates. No share of a value that its error exceeds: it is zero.
Table errors_table(Design design) {
    for (auto& r : design) {
        r.output = as_words(r.output);
        if (!(std::abs(r.off_percent) <= 100)) r.off_percent = compare::nan;
    }
    Table table =
        with_columns(compare::table_of(design), {"output", "value", "unit", "off", "off %"});
    table.caption = "Error of the published recursion in the rates at the design position";
    table.detail = true;
    return table;
}

Design design_of(const SceneAnalyses& scene) {
    return scene.model.wheels.empty() ? Design{} : characteristic_rows(scene.comparison);
}

}  // namespace

Table key_rates(const SceneAnalyses& scene) {
    const auto design = design_of(scene);
    Table table = design.empty() ? Table{} : rates_table(design, scene.model.wheels, true);
    table.caption =
        "Key figures at the design position (lateral forces towards the middle of the vehicle, "
        "braking to the back, traction forward; toe-in positive)";
    return table;
}

std::optional<Section> rates_section(const SceneAnalyses& scene) {
    const auto design = design_of(scene);
    if (design.empty()) return std::nullopt;
    Section section{.id = "rates", .title = "Rates", .part = Part::behaviour};
    section.tables.push_back(rates_table(design, scene.model.wheels));
    return section;
}

std::optional<Section> matrices_section(const SceneAnalyses& scene) {
    const auto design = design_of(scene);
    if (design.empty()) return std::nullopt;
    Section section{.id = "matrices",
                    .title = "Compliance matrices, and the recursion’s rates",
                    .part = Part::evidence};
    const auto compliance = compliance_rows(scene.model, scene.comparison);
    for (const char* point : {"contact patch", "wheel centre"})
        if (auto table = matrix_table(compliance, point))
            section.tables.push_back(std::move(*table));
    double worst = 0;
    for (const auto& r : compliance)
        if (r.leg != "recursive" && r.a == 0) worst = std::max(worst, r.reciprocity);
    if (!compliance.empty()) section.words["reciprocity"] = number(worst, 2);
    section.tables.push_back(errors_table(design));
    return section;
}

}  // namespace elastocheck::reports
