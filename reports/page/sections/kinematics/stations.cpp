// Section: tables of the outputs at stations of the load cases, with the wheels as columns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/given/wheels.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/kinematics/cases.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::drawn_over;
using compare::Over;

// A quantity of each wheel, once where the wheels agree.
Table at_stations(const SceneAnalyses& scene, const Case& c, const std::string& caption,
                  const std::vector<Quantity>& quantities) {
    std::vector<std::size_t> chosen = thinned(c.curve.a.size(), 9);
    if (std::ranges::find(chosen, c.curve.start) == chosen.end() &&
        c.curve.start < c.curve.a.size())
        chosen.insert(std::ranges::lower_bound(chosen, c.curve.start), c.curve.start);
    std::vector<compare::ColumnOf<std::size_t>> columns;
    const auto add = [&](const std::string& name, std::vector<double> values) {
        columns.push_back(
            {name, columns.empty() ? Digits::place : Digits::four,
             [values = std::move(values)](std::size_t k) { return at_rest(values[k]); }});
    };
    if (!c.sweep.lifts()) add(c.sweep.parameter, c.curve.a);  // else by travel
    for (const auto& quantity : quantities) {
        const auto outputs = outputs_of(scene, quantity.name);
        std::vector<std::vector<double>> values;
        for (const auto& of : outputs) {
            values.push_back(c.curve.channel(of.channel));
            const Scale scale = scale_of(quantity, of.wheel.side, values.back(), c.curve.start);
            for (double& value : values.back()) value = scale(value);
        }
        const bool agree =
            values.size() == 2 && std::ranges::equal(values[0], values[1], [](double a, double b) {
                return std::isnan(a) ? std::isnan(b) : std::abs(a - b) <= 1e-9 + 1e-4 * std::abs(a);
            });
        for (std::size_t k = 0; k < (agree ? 1 : values.size()); ++k) {
            const std::string whose = outputs[k].of_all || agree || outputs[k].wheel.name.empty()
                                          ? ""
                                          : " " + outputs[k].wheel.name;
            add(fmt::format("{}{} [{}]", label_of(quantity), whose, outputs[k].unit), values[k]);
        }
    }
    Table table = compare::table("", columns, chosen);
    table.caption = caption;
    return table;
}

// Changes at the ends of a load case, a quantity a row.
Table at_ends(const SceneAnalyses& scene, const Case& c, std::vector<Quantity> quantities) {
    const auto& wheels = scene.model.wheels;
    const std::string direction = push_of(scene, c, wheels[0]).positive;
    std::erase_if(quantities, [&](const Quantity& quantity) {
        return outputs_of(scene, quantity.name).size() != wheels.size();
    });
    std::vector<compare::ColumnOf<Quantity>> columns{
        {"change", Digits::words, [&](const Quantity& quantity) {
             return fmt::format("{} [{}], {}", as_words(quantity.name),
                                outputs_of(scene, quantity.name)[0].unit, quantity.sign);
         }}};
    for (const std::size_t k : {std::size_t{0}, c.curve.a.size() - 1})
        for (std::size_t w = 0; w < wheels.size() && k != c.curve.start; ++w)
            columns.push_back(
                {fmt::format("{}{}{} {}", wheels[w].name, wheels[w].name.empty() ? "at " : ", ",
                             short_number(push_of(scene, c, wheels[w]).factor * c.curve.a[k]),
                             c.sweep.unit),
                 Digits::three, [&scene, &c, k, w](const Quantity& quantity) {
                     const FoundOutput of = outputs_of(scene, quantity.name)[w];
                     const auto values = c.curve.channel(of.channel);
                     return at_rest(
                         scale_of(quantity, of.wheel.side, values, c.curve.start)(values[k]));
                 }});
    Table table = compare::table("", columns, quantities);
    table.caption = fmt::format("{}{}{}: changes since the start of the branch", c.legend(),
                                direction.empty() ? "" : ", ", direction);
    return table;
}

}  // namespace

std::optional<Section> stations_section(const SceneAnalyses& scene) {
    if (scene.model.wheels.empty()) return std::nullopt;
    Section section{
        .id = "stations", .title = "Outputs at stations of the load cases", .part = Part::evidence};
    std::vector<Quantity> over_travel{{std::string(compare::figure::travel), "", ""}};
    const auto drawn = drawn_over(Over::travel), steered = drawn_over(Over::steering);
    over_travel.insert(over_travel.end(), drawn.begin(), drawn.begin() + 6);
    std::vector<std::string> shown;  // one load case of each kind of lift
    for (const auto& c : cases_of(scene, [](const Sweep&) { return true; })) {
        if (c.sweep.lifts() && std::ranges::find(shown, c.sweep.kind) == shown.end()) {
            shown.push_back(c.sweep.kind);
            std::string caption = fmt::format("{}, load case {}", c.sweep.kind, c.legend());
            caption[0] = static_cast<char>(std::toupper(caption[0]));
            section.tables.push_back(at_stations(scene, c, caption, over_travel));
        } else if (c.sweep.kind == "steering") {
            std::vector<Quantity> quantities(steered.begin(), steered.begin() + 4);
            for (const auto& effort :
                 efforts_of(*c.sweep.branches.front().requested, scene.comparison.channels))
                quantities.push_back({effort, "", ""});
            section.tables.push_back(
                at_stations(scene, c, "Steering, load case " + c.legend(), quantities));
        } else if (pushes(c.sweep)) {
            section.tables.push_back(at_ends(scene, c, drawn_over(Over::load)));
        }
    }
    if (section.tables.empty()) return std::nullopt;
    return section;
}

}  // namespace elastocheck::reports
