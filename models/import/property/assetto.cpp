// Imports one axle of a car of Assetto Corsa (suspensions.ini): its left wheel, as a rigid mechanism.
// Points of the file are in m from the wheel centre: x inboard, y up, z forward. From VERSION 2 on RIM_OFFSET
// is subtracted from x of all of them.
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
          "JOINT3_CAR", "JOINT3_TYRE", "JOINT4_CAR", "JOINT4_TYRE"}}};
    return all;
}

// The links of a multi-link are numbered, and any of the first four can have any place.
constexpr std::array links{"upper_front", "upper_rear", "lower_front", "lower_rear", "tie_rod"};

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
        fail(file, type.line, "TYPE", "{} is not read; known: DWB, STRUT, ML (live axles are not)",
             reader::quote(type.text));
    double version = 1, offset = 0;
    if (const auto head = ini.find("HEADER"); head != ini.end() && head->second.contains("VERSION"))
        version = AssettoAxle{file, head->first, head->second}.number("VERSION");
    if (axle.section.contains("RIM_OFFSET") && version >= 2 && known->type != "ML")
        offset = axle.number("RIM_OFFSET");
    const double middle = 0.5 * axle.number("TRACK");
    Draft draft;
    draft.title = std::filesystem::path(file).stem().string() + ", " + reader::small_letters(name);
    draft.source = file;
    draft.format = "suspensions.ini of Assetto Corsa";
    draft.units = "{length: mm, angle: deg, force: N}";
    draft.remarks = {fmt::format(
        "The left wheel of [{}], x forward, y left, z up; the origin is in the middle of the car "
        "at "
        "the height of the wheel centres. RIM_OFFSET {:g} m is subtracted from the points.",
        name, offset)};
    for (std::size_t k = 0; k < known->keys.size(); ++k) {
        const std::string& key = known->keys[k];
        const auto p = axle.numbers(key, 3);
        draft.points.add(1000 * Eigen::Vector3d(p[2], middle - (p[0] - offset), p[1]), key,
                         {axle.value(key).line, key});
        draft.notes.count("point");
        if (known->type == "ML")
            options.roles.push_back(
                fmt::format("{}_{}={}", links[k / 2], k % 2 ? "outer" : "inner", key));
    }
    draft.points.add(1000 * Eigen::Vector3d(0, middle, 0), "WHEEL_CENTRE",
                     {axle.value("TRACK").line, "WHEEL_CENTRE"});
    for (const char* rate : {"SPRING_RATE", "PROGRESSIVE_SPRING_RATE", "BUMP_STOP_RATE"})
        if (axle.section.contains(rate) && axle.number(rate) != 0)
            draft.notes.warn({axle.value(rate).line, rate},
                             fmt::format("{:g}, at the wheel, is not in the scene, which is rigid",
                                         axle.number(rate)));
    for (const char* angle : {"STATIC_CAMBER", "TOE_OUT"})
        if (axle.section.contains(angle) && axle.number(angle) != 0)
            draft.notes.warn({axle.value(angle).line, angle},
                             fmt::format("{:g} is not in the scene: its wheel stands upright, "
                                         "straight ahead",
                                         axle.number(angle)));
    if (options.as.empty()) options.as = known->mechanism;
    options.axle.clear();
    return draft;
}

}  // namespace elastocheck::importer
