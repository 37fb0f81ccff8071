// Section: first screen with the suspension, the verdict and key figures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/tables/table.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/suspension.hpp"
#include "reports/tables/select.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

// "A", or "A / B" for two ends.
std::string both(const std::vector<std::string>& values) {
    std::string text;
    for (const auto& value : values) text += (text.empty() ? "" : "\u00a0/\u00a0") + value;
    return text;
}

// Up to three significant digits, no finer than a thousandth.
std::string key_number(double value) {
    if (std::abs(value) < 5e-4) return "0";
    return signed_number(value, std::abs(value) < 0.0995 ? 2 : 3);
}

// As entered: "−80", "+3000".
std::string end_number(double a) {
    return (a > 0 ? "+" : a < 0 ? "−" : "") + fmt::format("{:.4g}", std::abs(a));
}

// One end of the sweep, by the equilibrium leg.
struct End {
    JsonCursor branch;
    LegCurve curve;
    std::size_t at = 0;
    double a = 0;  // of the parameter
};

std::vector<End> ends_of(const Sweep& sweep) {
    std::vector<End> ends;
    for (const auto& branch : sweep.branches) {
        const LegCurve curve = curve_of(branch, "equilibrium");
        if (curve.a.empty()) continue;
        for (const std::size_t at : {std::size_t{0}, curve.a.size() - 1})
            if (at != curve.start()) ends.push_back({branch, curve, at, curve.a[at]});
    }
    std::ranges::sort(ends, {}, [](const End& end) { return end.a; });
    return ends;
}

// "travel −80 / +80 mm", "vertical −2000 / +3000 N"
std::string range_of(const Sweep& sweep, const std::vector<End>& ends) {
    std::vector<std::string> values;
    for (const auto& end : ends) values.push_back(end_number(end.a));
    return fmt::format("{} {}\u00a0{}", sweep.name, both(values), sweep.unit);
}

struct Tile {
    std::string value, label;
};

// Rates at the ends of the sweep for one wheel; for the other only where they differ.
void add_rates(std::vector<Tile>& tiles, const JsonCursor& scene, const Sweep& sweep) {
    for (const bool ride : {false, true}) {
        std::vector<std::string> wheels;
        for (const auto& rate : scene["rate_errors"].items())
            if (std::ranges::find(wheels, rate["wheel"].text()) == wheels.end())
                wheels.push_back(rate["wheel"].text());
        std::vector<Tile> mine;
        for (const auto& wheel : wheels) {
            std::vector<std::pair<double, std::array<std::string, 3>>> ends;
            for (const auto& branch : sweep.branches)
                for (const auto& rate : scene["rate_errors"].items()) {
                    if (rate["branch"].text() != branch["name"].text() ||
                        rate["wheel"].text() != wheel)
                        continue;
                    const double k = rate[ride ? "ride_rate_N_per_mm" : "wheel_rate_N_per_mm"]
                                         .number(),
                                 off = rate[ride ? "ride_off" : "off"].number();
                    if (!std::isfinite(k)) continue;
                    ends.push_back({rate["to"].number(),
                                    {number(k, 3), end_number(rate["to"].number()),
                                     (off > 0 ? "+" : "") + percent(off)}});
                }
            std::ranges::sort(ends, {}, [](const auto& end) { return end.first; });
            std::vector<std::string> rates, to, offs;
            for (const auto& [a, text] : ends)
                rates.push_back(text[0]), to.push_back(text[1]), offs.push_back(text[2]);
            if (rates.empty()) continue;
            const Tile tile{
                both(rates) + "\u00a0N/mm",
                fmt::format("{}{}, mean from 0 to {}\u00a0{}; the recursion’s is off by {}",
                            wheel.empty() || wheels.size() == 1 ? "" : wheel + " ",
                            ride ? "ride rate, with the tyre" : "wheel rate", both(to), sweep.unit,
                            both(offs))};
            if (std::ranges::none_of(mine,
                                     [&](const Tile& other) { return other.value == tile.value; }))
                mine.push_back(tile);
        }
        tiles.insert(tiles.end(), mine.begin(), mine.end());
    }
}

// Rates at the design position; the first of equal wheels.
void add_characteristics(std::vector<Tile>& tiles, const JsonCursor& scene) {
    const auto found = scene.find("characteristics");
    if (!found) return;
    struct Wanted {
        const char *name, *text;
    };
    constexpr Wanted wanted[] = {
        {"wheel_rate", "wheel rate"},
        {"roll_centre_height", "roll centre above the road"},
        {"bump_steer", "bump steer (toe-in in jounce positive)"},
        {"lateral_force_steer", "lateral force steer (force inwards, toe-in positive)"}};
    const compare::Table table = read_table((*found)["design"], compare::characteristic_table({}));
    for (const auto& [name, text] : wanted)
        for (std::size_t r = 0; r < table.rows.size(); ++r) {
            const std::string& output = words(table, r, "output");
            if (output != name && !output.ends_with("." + std::string(name))) continue;
            const double value = reports::number(table, r, "value"),
                         off = reports::number(table, r, "off");
            if (std::isfinite(value))
                tiles.push_back(
                    {fmt::format("{}\u00a0{}", number(value, 3), words(table, r, "unit")),
                     fmt::format(
                         "{}{}, at the design position{}",
                         output == name ? "" : output.substr(0, output.find('.')) + " ", text,
                         std::isfinite(off)
                             ? fmt::format("; the recursion’s is off by {}", key_number(off))
                             : "")});
            break;
        }
}

// Changes of outputs at the ends; equal wheels are shown once.
void add_changes(std::vector<Tile>& tiles, const JsonCursor& scene, const Sweep& sweep) {
    struct Wanted {
        const char *name, *text;
    };
    constexpr Wanted wanted[] = {
        {"toe", "toe change (toe-in positive)"},
        {"camber", "camber change (top outwards positive)"},
        {"wheel_centre_y", "wheel centre, change of y (to the left positive)"},
        {"wheel_centre_x", "wheel centre, change of x (forward positive)"}};
    const auto ends = ends_of(sweep);
    const auto channels = channels_of(scene);
    for (const auto& [name, text] : wanted) {
        std::vector<Tile> mine;
        for (const auto& channel : channels) {
            const auto dot = channel.name.rfind('.');
            if ((dot == std::string::npos ? channel.name : channel.name.substr(dot + 1)) != name)
                continue;
            std::vector<std::string> values;
            for (const auto& end : ends) {
                const auto curve = end.curve.channel(channel.name);
                values.push_back(key_number(curve[end.at] - curve[end.curve.start()]));
            }
            if (std::ranges::all_of(values, [](const std::string& v) { return v == "0"; }))
                continue;
            const std::string whose =
                dot == std::string::npos ? "" : channel.name.substr(0, dot) + " ";
            mine.push_back({fmt::format("{}\u00a0{}", both(values), channel.unit),
                            fmt::format("{}{}, {}", whose, text, range_of(sweep, ends))});
        }
        const bool same =
            std::ranges::all_of(mine, [&](const Tile& t) { return t.value == mine.front().value; });
        if (same && mine.size() > 1) {
            mine.resize(1);
            mine[0].label = fmt::format("{}, each wheel, {}", text, range_of(sweep, ends));
        }
        tiles.insert(tiles.end(), mine.begin(), mine.end());
    }
}

}  // namespace

std::optional<Section> first_section(const JsonCursor& scene) {
    Section section{.id = "first", .title = "In one sentence"};
    json& words = section.words;
    const auto judgement = scene.find("judgement");
    const JsonCursor verdict = scene["verdict"];
    if (judgement && verdict["conclusive"].truth()) {
        const std::string found = (*judgement)["verdict"].text();
        words["sentence"] = (*judgement)["sentence"].text();
        section.mark = found == "pass" ? Mark::pass : found == "fail" ? Mark::fail : Mark::open;
    } else {
        words["conclusive"] = verdict["conclusive"].truth();
        words["reasons"] = verdict["reasons"].texts();
        section.mark = Mark::open;
    }
    std::vector<Tile> tiles;
    if (const auto sweep = leading_sweep(scene); sweep && !sweep->branches.empty()) {
        if (sweep->lifts) add_rates(tiles, scene, *sweep);
        add_changes(tiles, scene, *sweep);
    }
    add_characteristics(tiles, scene);
    for (const auto& tile : tiles)
        words["tiles"].push_back({{"value", tile.value}, {"label", tile.label}});

    const auto suspension = suspension_of(scene);
    if (!suspension) return section;
    const std::string noun = noun_of(*suspension);
    bool right = !scene["drawing"]["points"].items().empty() && !suspension->wheels.empty();
    for (const auto& wheel : suspension->wheels)  // all wheels on the right side; y points left
        right = right && suspension->points[wheel.centre].at[1] < 0;
    FigureGroup group;
    group.figures = draw_views(*suspension, {axonometric_view(right)}, large_frame(*suspension));
    Figure& figure = group.figures.front();
    figure.title = fmt::format("The {}", noun);
    std::vector<std::string> names, moved;
    for (const auto& point : suspension->points)
        if (point.hardpoint && std::ranges::find(names, point.name) == names.end())
            names.push_back(point.name);
    for (const auto& position : suspension->moved) moved.push_back(position.title);
    figure.description = fmt::format(
        "The {} seen {}, to scale, with its points {}{}.", noun, axonometric_view(right).from,
        enumerated(names), moved.empty() ? "" : ", and in pale lines at " + enumerated(moved));
    group.caption = fmt::format(
        "Design position to scale{}{}.", moved.empty() ? "" : ", pale lines: " + enumerated(moved),
        suspension->wheels.empty() ? "" : "; the tyre’s width is only drawn");
    group.table = {.caption = "Points",
                   .columns = {{"point", true}, {"x [mm]"}, {"y [mm]"}, {"z [mm]"}}};
    std::vector<std::string> listed;
    for (const auto& point : suspension->points) {
        if (std::ranges::find(listed, point.name) != listed.end()) continue;
        listed.push_back(point.name);
        group.table.rows.push_back(
            {point.name, number(point.at[0], 4), number(point.at[1], 4), number(point.at[2], 4)});
    }
    group.table.folded = true;
    section.figures.push_back(std::move(group));
    return section;
}

}  // namespace elastocheck::reports
