// Imports one axle of a car of Assetto Corsa (suspensions.ini): its left wheel, or a live axle, as a rigid
// mechanism with its springs. Points of the file are in m from the wheel centre: x inboard, y up, z forward. From
// VERSION 2 on RIM_OFFSET is subtracted from x of all of them. Those of a live axle are from its middle, x to
// the left.
//
// The force of a spring is (p t + k) t of t = travel + ROD_LENGTH, vertical between wheel centre and body; of a
// strut along it. On a live axle it stands at ATTACH_REL_POS of the half track, 0.2 m long.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "models/import/import.hpp"
#include "models/import/property/columns.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer {
namespace {

struct IniValue {
    int line = 0;
    std::string text;
};
using IniSection = std::map<std::string, IniValue>;
using IniFile = std::map<std::string, IniSection>;

IniFile read_ini(std::string_view text, const std::string& file) {
    IniFile sections;
    std::string section;
    for (reader::Lines lines(text); lines.next();) {
        std::string_view line = lines.line();
        line = reader::trimmed(line.substr(0, std::min(line.find(';'), line.find("//"))));
        if (line.empty()) continue;
        const auto equals = line.find('=');
        if (line.starts_with('[') && line.ends_with(']')) {
            section = reader::capitals(reader::trimmed(line.substr(1, line.size() - 2)));
        } else if (equals == line.npos || section.empty()) {
            fail(file, lines.number(), "", "expected [SECTION] or KEY=VALUE, found {}",
                 reader::quote(line));
        } else {
            const std::string key = reader::capitals(reader::trimmed(line.substr(0, equals)));
            const IniValue value{lines.number(),
                                 std::string(reader::trimmed(line.substr(equals + 1)))};
            const auto [first, is_new] = sections[section].emplace(key, value);
            if (!is_new)
                fail(file, lines.number(), key, "given twice, first in line {}",
                     first->second.line);
        }
    }
    return sections;
}

struct AssettoAxle {
    const std::string& file;
    const std::string& name;  // of its section
    const IniSection& section;

    const IniValue& value(const std::string& key) const {
        const auto found = section.find(key);
        if (found == section.end()) fail(file, 0, key, "missing in [{}]", name);
        return found->second;
    }
    std::vector<double> numbers(const std::string& key, std::size_t count) const {
        const IniValue& given = value(key);
        std::vector<double> result;
        for (std::size_t begin = 0; begin <= given.text.size();) {
            const std::size_t comma = std::min(given.text.find(',', begin), given.text.size());
            const auto cell =
                reader::trimmed(std::string_view(given.text).substr(begin, comma - begin));
            const auto number = coordinate(cell, false);
            if (!number) fail(file, given.line, key, "{} is not a number", reader::quote(cell));
            result.push_back(*number);
            begin = comma + 1;
        }
        if (result.size() != count)
            fail(file, given.line, key, "{} numbers, expected {}", result.size(), count);
        return result;
    }
    double number(const std::string& key) const { return numbers(key, 1)[0]; }
    double number_or(const std::string& key, double missing) const {
        return section.contains(key) ? number(key) : missing;
    }
};

// The mechanism of each type, and its points.
struct AssettoType {
    std::string_view type;
    const char* mechanism;
    std::vector<std::string> keys;
};
const std::vector<AssettoType>& assetto_types() {
    static const std::vector<AssettoType> all{
        {"DWB",
         "double_wishbone",
         {"WBCAR_TOP_FRONT", "WBCAR_TOP_REAR", "WBCAR_BOTTOM_FRONT", "WBCAR_BOTTOM_REAR",
          "WBTYRE_TOP", "WBTYRE_BOTTOM", "WBCAR_STEER", "WBTYRE_STEER"}},
        {"STRUT",
         "strut",
         {"STRUT_CAR", "STRUT_TYRE", "WBCAR_BOTTOM_FRONT", "WBCAR_BOTTOM_REAR", "WBTYRE_BOTTOM",
          "WBCAR_STEER", "WBTYRE_STEER"}},
        {"ML",
         "five_link",
         {"JOINT0_CAR", "JOINT0_TYRE", "JOINT1_CAR", "JOINT1_TYRE", "JOINT2_CAR", "JOINT2_TYRE",
          "JOINT3_CAR", "JOINT3_TYRE", "JOINT4_CAR", "JOINT4_TYRE"}},
        {"AXLE",
         "live_axle",
         {"J0_CAR", "J0_AXLE", "J1_CAR", "J1_AXLE", "J2_CAR", "J2_AXLE", "J3_CAR", "J3_AXLE",
          "J4_CAR", "J4_AXLE"}}};
    return all;
}

// The links of a multi-link are numbered, and any of the first four can have any place.
constexpr std::array links{"upper_front", "upper_rear", "lower_front", "lower_rear", "tie_rod"};

struct AssettoReader {
    const IniFile& ini;
    const std::string& file;
    const AssettoAxle axle;
    const AssettoType& type;
    Options& options;
    Draft draft = {};
    double version = 1;
    double half_track = 0;  // [m]

    void warn(const std::string& section, const std::string& key, const char* what) {
        const auto found = ini.find(section);
        if (found == ini.end() || !found->second.contains(key)) return;
        const AssettoAxle of{file, section, found->second};
        if (const double x = of.number(key); x != 0)
            draft.notes.warn({of.value(key).line, key}, fmt::format("{:g}{}", x, what));
    }

    // Line 0: of no role.
    void add_point(const std::string& key, int line, double forward, double left, double up) {
        draft.points.add(1000 * Eigen::Vector3d(forward, left, up), key, {line, key});
    }

    void read_corner() {
        double offset = 0;
        if (version >= 2 && type.type != "ML") offset = axle.number_or("RIM_OFFSET", 0);
        draft.remarks = {fmt::format(
            "The left wheel of [{}], x forward, y left, z up; the origin is in the middle of the "
            "car at the height of the wheel centres. RIM_OFFSET {:g} m is subtracted from the "
            "points.",
            axle.name, offset)};
        for (std::size_t k = 0; k < type.keys.size(); ++k) {
            const std::string& key = type.keys[k];
            const auto p = axle.numbers(key, 3);
            add_point(key, axle.value(key).line, p[2], half_track - (p[0] - offset), p[1]);
            draft.notes.count("point");
            if (type.type == "ML")
                options.roles.push_back(
                    fmt::format("{}_{}={}", links[k / 2], k % 2 ? "outer" : "inner", key));
        }
        add_point("WHEEL_CENTRE", axle.value("TRACK").line, 0, half_track, 0);
        add_spring("spring", type.type == "STRUT"
                                 ? "bodies: [wheel, strut], from: strut_lower, to: strut_top"
                                 : "at_wheel: true");
        if (options.both_wheels)
            add_bar();
        else
            warn("ARB", axle.name,
                 " N/m between both wheels is not in the scene, which has one (--both-wheels)");
    }

    void add_spring(const std::string& name, const std::string& place) {
        const double k = axle.number_or("SPRING_RATE", 0);
        if (k == 0) return;
        const std::string preload = computed(k * axle.number_or("ROD_LENGTH", 0));
        draft.springs.push_back(
            {name,
             fmt::format("{{{}, rate: {}, preload: {}}}", place, computed(k / 1000), preload),
             {axle.value("SPRING_RATE").line, "SPRING_RATE"}});
        draft.notes.count("spring");
    }

    // The two lowest links are the lower ones; the fifth is a bar across.
    void read_live_axle() {
        const auto section = ini.find("AXLE");
        if (section == ini.end()) fail(file, 0, "[AXLE]", "missing; it has the links of the axle");
        const AssettoAxle of{file, section->first, section->second};
        const double count = of.number("LINK_COUNT");
        if (count != 4 && count != 5)
            fail(file, of.value("LINK_COUNT").line, "LINK_COUNT", "{:g}; known: 4, 5", count);
        draft.remarks = {fmt::format(
            "The live axle of [{}], x forward, y left, z up; the origin is in its middle.",
            axle.name)};
        std::vector<std::pair<double, std::string>> by_height;
        std::map<std::string, double> left;
        for (std::size_t k = 0; k < 2 * static_cast<std::size_t>(count); ++k) {
            const std::string& key = type.keys[k];
            const auto p = of.numbers(key, 3);
            add_point(key, of.value(key).line, p[2], p[0], p[1]);
            draft.notes.count("point");
            const std::string link = key.substr(0, 2);
            if (k % 2 && k < 8) by_height.emplace_back(p[1], link), left[link] = p[0];
            if (k >= 8)
                options.roles.push_back(
                    fmt::format("panhard_{}={}", k % 2 ? "outer" : "inner", key));
        }
        std::ranges::stable_sort(by_height, {}, &std::pair<double, std::string>::first);
        for (std::size_t k = 0; k < 4; ++k) {
            const std::string &link = by_height[k].second, &twin = by_height[k ^ 1].second;
            const bool is_left = left[link] != left[twin] ? left[link] > left[twin] : k % 2;
            for (const auto& [end, part] : {std::pair{"inner", "CAR"}, {"outer", "AXLE"}})
                options.roles.push_back(fmt::format("{}_{}_{}={}_{}", is_left ? "left" : "right",
                                                    k < 2 ? "lower" : "upper", end, link, part));
        }
        const double seat = half_track * (version >= 4 ? of.number_or("ATTACH_REL_POS", 1) : 1),
                     leaf = version >= 3 ? of.number_or("LEAF_SPRING_LAT_K", 0) : 0;
        for (const auto& [side, sign] : {std::pair{"left", 1.0}, {"right", -1.0}}) {
            const std::string name = side;
            const int line = axle.value("TRACK").line;
            add_point(name + "_wheel_centre", line, 0, sign * half_track, 0);
            add_point(name + "_seat", 0, 0, sign * seat, 0);
            add_point(name + "_top", 0, 0, sign * seat, 0.2);
            add_spring(name + "_spring", fmt::format("bodies: [axle, ground], from: {0}_seat, to: "
                                                     "{0}_top",
                                                     name));
            if (leaf != 0)
                draft.bushings.push_back(
                    {name + "_leaf",
                     fmt::format("{{bodies: [ground, axle], at: {}_seat, rates: [0, {}, 0], "
                                 "rotational_rates: [0, 0, 0]}}",
                                 name, computed(leaf / 1000)),
                     {of.value("LEAF_SPRING_LAT_K").line, "LEAF_SPRING_LAT_K"}});
        }
        add_bar();
    }

    void add_bar() {
        const auto bars = ini.find("ARB");
        if (bars == ini.end()) return;
        const AssettoAxle bar{file, bars->first, bars->second};
        if (const double k = bar.number_or(axle.name, 0); k != 0)
            draft.springs.push_back(
                {"antiroll_bar",
                 fmt::format("{{at_wheel: [left, right], rate: {}}}", computed(k / 1000)),
                 {bar.value(axle.name).line, axle.name}});
    }

    void warn_of_the_rest() {
        for (const char* rate : {"PROGRESSIVE_SPRING_RATE", "BUMP_STOP_RATE"})
            warn(axle.name, rate, ", at the wheel, is not in the scene");
        warn("HEAVE_" + axle.name, "SPRING_RATE", " N/m of both wheels is not in the scene");
        for (const char* angle : {"STATIC_CAMBER", "TOE_OUT"})
            warn(axle.name, angle,
                 " is not in the scene: its wheel stands upright, straight ahead");
    }
};

}  // namespace

Draft import_assetto(std::string_view text, const std::string& file, Options& options) {
    const IniFile ini = read_ini(text, file);
    std::vector<std::string> axles;
    for (const char* name : {"FRONT", "REAR"})
        if (ini.contains(name)) axles.push_back(reader::small_letters(name));
    if (axles.empty())
        fail(file, 0, "", "no section [FRONT] or [REAR]: this is not a suspensions.ini");
    if (options.axle.empty() ? axles.size() > 1
                             : std::ranges::find(axles, options.axle) == axles.end())
        fail(file, 0, "--axle", "choose an axle of the file: {}", fmt::join(axles, ", "));
    const std::string name = reader::capitals(options.axle.empty() ? axles[0] : options.axle);
    const AssettoAxle axle{file, name, ini.at(name)};
    const IniValue& type = axle.value("TYPE");
    const auto known =
        std::ranges::find(assetto_types(), reader::capitals(type.text), &AssettoType::type);
    if (known == assetto_types().end())
        fail(file, type.line, "TYPE", "{} is not read; known: DWB, STRUT, ML, AXLE",
             reader::quote(type.text));
    AssettoReader reading{ini, file, axle, *known, options};
    if (const auto head = ini.find("HEADER"); head != ini.end())
        reading.version = AssettoAxle{file, head->first, head->second}.number_or("VERSION", 1);
    reading.half_track = 0.5 * axle.number("TRACK");
    reading.draft.title =
        std::filesystem::path(file).stem().string() + ", " + reader::small_letters(name);
    reading.draft.source = file;
    reading.draft.format = "suspensions.ini of Assetto Corsa";
    reading.draft.units = "{length: mm, angle: deg, force: N}";
    if (known->type == "AXLE")
        reading.read_live_axle();
    else
        reading.read_corner();
    reading.warn_of_the_rest();
    if (options.as.empty()) options.as = known->mechanism;
    options.axle.clear();
    return std::move(reading.draft);
}

}  // namespace elastocheck::importer
