// Section: the compiled model.
#include <fmt/format.h>

#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::optional<Section> model_section(const JsonCursor& scene) {
    const JsonCursor model = scene["model"];
    Section section{.id = "model", .title = "The model as compiled", .part = Part::evidence};
    section.words = {{"source", scene["source"].text()}, {"hash", scene["input_hash"].text()}};
    Table table{.caption = "The model", .columns = {{"what", true}, {"as compiled", true}}};
    const auto row = [&](const char* what, const std::string& value) {
        if (!value.empty()) table.rows.push_back({what, value});
    };
    row("bodies", enumerated(model["bodies"].texts()));
    row("joints", enumerated(model["joints"].texts()));
    row("elastic elements", enumerated(model["elements"].texts()));
    row("coordinates", whole_number(model["coordinates"].whole()));
    row("constraints", whole_number(model["constraints"].whole()));
    row("unknowns", whole_number(model["unknowns"].whole()));
    row("degrees of freedom", whole_number(model["degrees_of_freedom"].whole()));
    row("idle modes", enumerated(model["idle_modes"].texts()));
    for (const auto& r : model["redundant"].items())
        row("redundant", fmt::format("{}: {} rows", r["joint"].text(), r["rows"].whole()));
    for (const auto& omitted : model["left_out"].items())
        row("left out", fmt::format("{}: {}", omitted["what"].text(), omitted["why"].text()));
    row("force and moment imbalance at the design position",
        fmt::format("{} N", number(model["imbalance_N"].number(), 2)));
    row("condition number, equilibrated (raw)",
        fmt::format("{} ({})", number(model["condition_equilibrated"].number(), 2),
                    number(model["condition_raw"].number(), 2)));
    if (const auto trim = scene.find("trim")) {
        for (const auto& a : (*trim)["adjusted"].items())
            row("trimmed",
                fmt::format("{}: {} {}, {}", a["name"].text(), number(a["by"].number(), 5),
                            a["unit"].text(), a["makes"].text()));
        for (const auto& c : (*trim)["conditions"].items())
            row("trimmed until",
                fmt::format("{} = {} {}, met to {}, confirmed by {} to {}", c["name"].text(),
                            number(c["asked"].number()), c["unit"].text(),
                            number(std::abs(c["missed"].number()), 2),
                            (*trim)["confirmed_by"].text(),
                            number(std::abs(c["missed_by_confirming_leg"].number()), 2)));
    }
    section.tables.push_back(std::move(table));
    if (scene.find("channels")) {
        Table outputs{.caption = "Outputs and their definitions",
                      .columns = {{"output", true}, {"unit", true}, {"definition", true}}};
        for (const auto& channel : scene["channels"].items())
            if (const auto text = channel.find("definition");
                text && (channel["main"].truth() || channel["kinematic"].truth()))
                outputs.rows.push_back(
                    {channel["name"].text(), channel["unit"].text(), text->text()});
        if (!outputs.rows.empty()) section.tables.push_back(std::move(outputs));
    }
    return section;
}

}  // namespace elastocheck::reports
