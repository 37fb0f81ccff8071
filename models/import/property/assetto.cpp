// Imports one axle of a car of Assetto Corsa (suspensions.ini): its left wheel, or a live axle, as a rigid
// mechanism with its springs. Points of the file are in m from the wheel centre: x inboard, y up, z forward;
// from VERSION 2 on RIM_OFFSET is subtracted from their x. Those of a live axle are from its middle, x to the
// left.
//
// The game's spring force is (p t + k) t with t = travel + ROD_LENGTH, k = SPRING_RATE,
// p = PROGRESSIVE_SPRING_RATE, vertical between wheel centre and body, for a strut along it. Here p is left
// out and k ROD_LENGTH is the preload. On a live axle the spring stands at ATTACH_REL_POS of the half track
// and is drawn 0.2 m long.
#include <fmt/format.h>

#include <algorithm>

#include "models/import/import.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer {
namespace {

using reader::Cursor, reader::Value;

// The value of a key of a map, added where the map lacks it.
Value& value_of_key(Value& map, const std::string& key, int line) {
    map.kind = Value::Kind::map;
    const auto found = std::ranges::find(map.keys, key);
    if (found != map.keys.end())
        return map.items[static_cast<std::size_t>(found - map.keys.begin())];
    map.keys.push_back(key);
    map.items.emplace_back().line = line;
    return map.items.back();
}

// Sections as maps of keys to values; a value with commas is a list.
Value read_ini(std::string_view text, const std::string& file) {
    Value sections;
    std::string section;
    for (reader::Lines lines(text); lines.next();) {
        std::string_view line = lines.line();
        line = reader::trimmed(line.substr(0, std::min(line.find(';'), line.find("//"))));
        if (line.empty()) continue;
        const auto equals = line.find('=');
        if (line.starts_with('[') && line.ends_with(']')) {
            section = reader::capitals(reader::trimmed(line.substr(1, line.size() - 2)));
            continue;
        }
        if (equals == line.npos || section.empty())
            fail(file, lines.number(), "", "expected [SECTION] or KEY=VALUE, found {}",
                 reader::quote(line));
        const std::string key = reader::capitals(reader::trimmed(line.substr(0, equals)));
        Value& value =
            value_of_key(value_of_key(sections, section, lines.number()), key, lines.number());
        if (value.kind != Value::Kind::empty)
            fail(file, lines.number(), key, "given twice, first in line {}", value.line);
        const auto cells = split(line.substr(equals + 1), ",");
        value.kind = cells.size() > 1 ? Value::Kind::list : Value::Kind::scalar;
        if (cells.size() == 1)
            value.text = cells[0];
        else
            for (const std::string& cell : cells)
                value.items.push_back(
                    {.kind = Value::Kind::scalar, .text = cell, .line = value.line});
    }
    return sections;
}

double number_or(const std::optional<Cursor>& section, const std::string& key, double missing) {
    const auto field = section ? section->optional(key) : std::nullopt;
    return field ? field->number() : missing;
}

struct AssettoReader {
    const Cursor& ini;
    const std::string& file;
    const std::string name;  // of the axle's section: "FRONT"
    const Cursor axle;
    Options& options;
    double version = number_or(ini.optional("HEADER"), "VERSION", 1);
    double half_track = 0.5 * axle.require("TRACK").number();  // [m]
    Draft draft = {};

    void warn(const std::string& section, const std::string& key, const char* what) {
        const auto values = ini.optional(section);
        if (const double x = number_or(values, key, 0); x != 0)
            draft.notes.warn(source_of(*values, key), fmt::format("{:g}{}", x, what));
    }
    static SourceLocation source_of(const Cursor& section, const std::string& key) {
        return {section.require(key).value->line, key};
    }

    // Coordinates in the axes of the scene [m]. `line` 0: a point that gets no role.
    void add_point(const std::string& key, int line, double forward, double left, double up) {
        draft.points.add(1000 * Eigen::Vector3d(forward, left, up), key, {line, key});
    }
    // (x, y, z) of the file is (z, origin + direction · x, y) in the axes of the scene.
    void add_point(const Cursor& section, const std::string& key, double origin, double direction) {
        const Cursor field = section.require(key);
        const auto p = field.list(3, "numbers");
        add_point(key, field.value->line, p[2].number(), origin + direction * p[0].number(),
                  p[1].number());
        draft.notes.count("point");
    }

    void read_corner(const Value& type) {
        const Value* roles = entry(type, "roles");
        const double offset = version >= 2 && !roles ? number_or(axle, "RIM_OFFSET", 0) : 0;
        draft.remarks = {fmt::format(
            "The left wheel of [{}], x forward, y left, z up; the origin is in the middle of the "
            "car at the height of the wheel centres. RIM_OFFSET {:g} m is subtracted from the "
            "points.",
            name, offset)};
        const auto& keys = entry(type, "points")->items;
        for (std::size_t k = 0; k < keys.size(); ++k) {
            add_point(axle, keys[k].text, half_track + offset, -1);
            if (roles)
                options.roles.push_back(fmt::format("{}={}", roles->items[k].text, keys[k].text));
        }
        add_point("WHEEL_CENTRE", source_of(axle, "TRACK").line, 0, half_track, 0);
        add_spring("spring", entry(type, "spring")->text);
        if (options.both_wheels)
            add_bar();
        else
            warn("ARB", name,
                 " N/m between both wheels is not in the scene, which has one (--both-wheels)");
    }

    void add_spring(const std::string& spring_name, const std::string& ends) {
        const double k = number_or(axle, "SPRING_RATE", 0);
        if (k == 0) return;
        const std::string preload = computed(k * number_or(axle, "ROD_LENGTH", 0));
        draft.springs.push_back(
            {spring_name,
             fmt::format("{{{}, rate: {}, preload: {}}}", ends, computed(k / 1000), preload),
             source_of(axle, "SPRING_RATE")});
        draft.notes.count("spring");
    }

    // Of four links the two with the lowest outer ends are the lower ones; a fifth is a Panhard rod.
    void read_live_axle(const Value& type) {
        const auto links_of_axle = ini.optional("AXLE");
        if (!links_of_axle) fail(file, 0, "[AXLE]", "missing; it has the links of the axle");
        const Cursor link_count = links_of_axle->require("LINK_COUNT");
        const double count = link_count.number();
        if (count != 4 && count != 5)
            fail(file, link_count.value->line, "LINK_COUNT", "{:g}; known: 4, 5", count);
        draft.remarks = {fmt::format(
            "The live axle of [{}], x forward, y left, z up; the origin is in its middle.", name)};
        struct Link {
            std::string key;
            Eigen::Vector3d outer;
        };
        std::vector<Link> links;
        for (std::size_t k = 0; k < 2 * static_cast<std::size_t>(count); ++k) {
            const std::string& key = entry(type, "points")->items[k].text;
            add_point(*links_of_axle, key, 0, 1);
            if (k % 2 && k < 8)
                links.push_back({key.substr(0, 2), draft.points.positions().back()});
            if (k >= 8)
                options.roles.push_back(
                    fmt::format("panhard_{}={}", k % 2 ? "outer" : "inner", key));
        }
        std::ranges::stable_sort(links, {}, [](const Link& link) { return link.outer.z(); });
        for (std::size_t k = 0; k < 4; ++k) {
            // links 0 and 1, 2 and 3 are pairs
            const double y = links[k].outer.y(), y_of_other = links[k ^ 1].outer.y();
            const bool is_left = y != y_of_other ? y > y_of_other : k % 2;
            for (const auto& [end, part] : {std::pair{"inner", "CAR"}, {"outer", "AXLE"}})
                options.roles.push_back(fmt::format("{}_{}_{}={}_{}", is_left ? "left" : "right",
                                                    k < 2 ? "lower" : "upper", end, links[k].key,
                                                    part));
        }
        const double seat = half_track *
                            (version >= 4 ? number_or(links_of_axle, "ATTACH_REL_POS", 1) : 1),
                     leaf = version >= 3 ? number_or(links_of_axle, "LEAF_SPRING_LAT_K", 0) : 0;
        for (const auto& [side, sign] : {std::pair{"left", 1.0}, {"right", -1.0}}) {
            const std::string of_side = side;
            add_point(of_side + "_wheel_centre", source_of(axle, "TRACK").line, 0,
                      sign * half_track, 0);
            add_point(of_side + "_seat", 0, 0, sign * seat, 0);
            add_point(of_side + "_top", 0, 0, sign * seat, 0.2);
            add_spring(of_side + "_spring", replaced(entry(type, "spring")->text, "SIDE", side));
            if (leaf != 0)
                draft.bushings.push_back(
                    {of_side + "_leaf",
                     fmt::format("{{bodies: [ground, axle], at: {}_seat, rates: [0, {}, 0], "
                                 "rotational_rates: [0, 0, 0]}}",
                                 side, computed(leaf / 1000)),
                     source_of(*links_of_axle, "LEAF_SPRING_LAT_K")});
        }
        add_bar();
    }

    void add_bar() {
        const auto bars = ini.optional("ARB");
        if (const double k = number_or(bars, name, 0); k != 0)
            draft.springs.push_back(
                {"antiroll_bar",
                 fmt::format("{{at_wheel: [left, right], rate: {}}}", computed(k / 1000)),
                 source_of(*bars, name)});
    }

    void warn_of_unused() {
        for (const char* rate : {"PROGRESSIVE_SPRING_RATE", "BUMP_STOP_RATE"})
            warn(name, rate, ", at the wheel, is not in the scene");
        warn("HEAVE_" + name, "SPRING_RATE", " N/m of both wheels is not in the scene");
        for (const char* angle : {"STATIC_CAMBER", "TOE_OUT"})
            warn(name, angle, " is not in the scene: its wheel stands upright, straight ahead");
    }
};

}  // namespace

Draft import_assetto(std::string_view text, const std::string& file, Options& options) {
    const Value sections = read_ini(text, file);
    std::vector<Number> numbers;
    const Cursor ini{&sections, "", &file, &numbers};
    std::vector<std::string> axles;
    for (const char* name : {"front", "rear"})
        if (ini.optional(reader::capitals(name))) axles.emplace_back(name);
    if (axles.empty())
        fail(file, 0, "", "no section [FRONT] or [REAR]: this is not a suspensions.ini");
    if (options.axle.empty() ? axles.size() > 1
                             : std::ranges::find(axles, options.axle) == axles.end())
        fail(file, 0, "--axle", "choose an axle of the file: {}", fmt::join(axles, ", "));
    const std::string name = options.axle.empty() ? axles[0] : options.axle;
    const Cursor axle = ini.require(reader::capitals(name));
    const Value& type_in_file = *axle.require("TYPE").value;
    const Value& types = mechanism_table("assetto");
    const Value* type = entry(types, reader::capitals(type_in_file.text));
    if (!type)
        fail(file, type_in_file.line, "TYPE", "{} is not read; known: {}",
             reader::quote(type_in_file.text), fmt::join(types.keys, ", "));
    AssettoReader reading{ini, file, reader::capitals(name), axle, options};
    reading.draft = draft_of_points(file, "suspensions.ini of Assetto Corsa");
    reading.draft.title += ", " + name;
    const std::string& mechanism = entry(*type, "mechanism")->text;
    if (mechanism == "live_axle")
        reading.read_live_axle(*type);
    else
        reading.read_corner(*type);
    reading.warn_of_unused();
    if (options.as.empty()) options.as = mechanism;
    options.axle.clear();
    return std::move(reading.draft);
}

}  // namespace elastocheck::importer
