#include "reports/page/sections/inputs/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/given/wheels.hpp"
#include "reports/page/common.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

using compare::StaticRow;

double settled_value(double value) { return std::abs(value) < 5e-5 ? 0 : value; }

Table alignment_table(const SceneAnalyses& scene) {
    const auto values = static_rows(scene.model, scene.comparison);
    const auto outputs = distinct(values, &StaticRow::output);
    using Output = std::string;
    const auto row_of = [&](const Output& output, const std::string& wheel) {
        return std::ranges::find_if(values, [&](const StaticRow& row) {
            return row.output == output && row.wheel == wheel;
        });
    };
    std::vector<compare::ColumnOf<Output>> columns{
        {"of the wheel", Digits::words, [&](const Output& output) {
             return fmt::format("{} [{}]", as_words(output),
                                std::ranges::find(values, output, &StaticRow::output)->unit);
         }}};
    for (const auto& [state, of] :
         {std::pair{"drawn", &StaticRow::drawn}, {"settled", &StaticRow::settled}})
        for (const auto& wheel : scene.model.wheels)
            columns.push_back(
                {fmt::format("{}{}{}", state, wheel.name.empty() ? "" : " ", wheel.name),
                 Digits::four, [&, of](const Output& output) {
                     const auto row = row_of(output, wheel.name);
                     return row == values.end() ? compare::nan : settled_value((*row).*of);
                 }});
    Table table = compare::table("", columns, outputs);
    table.caption =
        fmt::format("Static alignment as drawn and as settled{} (toe-in, top outwards positive)",
                    scene.trim ? " after the trim" : "");
    return table;
}

Table trim_table(const SceneAnalyses& scene) {
    const bool balanced = scene.trim->bushings == Trim::Bushings::balanced;
    auto rows = scene.trim->adjusted;
    using Adjusted = decltype(rows)::value_type;
    std::erase_if(rows, [&](const Adjusted& a) {
        return balanced && a.name.starts_with("bushings.") && a.name.ends_with(".preload");
    });
    Table table = compare::table<Adjusted>(
        "",
        {{"what", Digits::words, [](const Adjusted& a) { return a.name; }},
         {"by", Digits::four,
          [](const Adjusted& a) {
              return fmt::format("{} {}", signed_number(a.by, 4), symbol(a.unit));
          }},
         {"makes", Digits::note, [](const Adjusted& a) { return a.makes; }}},
        rows);
    table.caption = balanced ? "The trim adjusted; preloads of all bushings (in “The model as "
                               "compiled”) balance the drawn position"
                             : "The trim adjusted; bushings are unloaded as drawn";
    return table;
}

}  // namespace elastocheck::reports
