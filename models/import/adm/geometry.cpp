#include "models/import/adm/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::importer::adm {

using Eigen::Vector3d;

Vector3d vector(const std::vector<double>& v) {
    return v.empty() ? Vector3d::Zero() : Vector3d(v[0], v[1], v[2]);
}

namespace {

using Eigen::Matrix3d;

struct Named {
    std::string_view name;
    double si;
};
constexpr std::size_t longest_chain = 100;                          // of markers in markers
constexpr double pound = 0.45359237, g_n = 9.80665, inch = 0.0254;  // [kg], [m/s²], [m]

constexpr Named lengths[] = {
    {"MILLIMETER", 1e-3},  {"METER", 1},           {"CENTIMETER", 1e-2},
    {"KILOMETER", 1e3},    {"INCH", inch},         {"FOOT", 12 * inch},
    {"YARD", 36 * inch},   {"MILE", 63360 * inch}, {"MICROINCH", 1e-6 * inch},
    {"MILS", 1e-3 * inch}, {"MICROMETER", 1e-6},   {"NANOMETER", 1e-9},
    {"ANGSTROM", 1e-10}};
constexpr Named forces[] = {{"NEWTON", 1},
                            {"KNEWTON", 1e3},
                            {"MEGANEWTON", 1e6},
                            {"CENTINEWTON", 1e-2},
                            {"MILLINEWTON", 1e-3},
                            {"MICRONEWTON", 1e-6},
                            {"NANONEWTON", 1e-9},
                            {"DYNE", 1e-5},
                            {"POUND_FORCE", pound* g_n},
                            {"KPOUND_FORCE", 1e3 * pound* g_n},
                            {"OUNCE_FORCE", pound / 16 * g_n},
                            {"KILOGRAM_FORCE", g_n},
                            {"POUNDAL", pound * 12 * inch}};
constexpr Named masses[] = {{"KILOGRAM", 1},
                            {"GRAM", 1e-3},
                            {"MILLIGRAM", 1e-6},
                            {"MICROGRAM", 1e-9},
                            {"NANOGRAM", 1e-12},
                            {"POUND_MASS", pound},
                            {"KPOUND_MASS", 1e3 * pound},
                            {"OUNCE_MASS", pound / 16},
                            {"SLUG", pound* g_n / (12 * inch)},
                            {"SLINCH", pound* g_n / inch},
                            {"TONNE", 1e3},
                            {"US_TON", 2000 * pound}};
constexpr Named times[] = {{"SECOND", 1},         {"MILLISECOND", 1e-3}, {"MILLISECONDS", 1e-3},
                           {"MICROSECOND", 1e-6}, {"NANOSECOND", 1e-9},  {"MINUTE", 60},
                           {"HOUR", 3600},        {"DAY", 86400}};

template <std::size_t n>
double unit(const Arguments& at, std::string_view argument, const Named (&table)[n]) {
    const std::string word = at.word(argument);
    std::vector<std::string> names, found;
    double si = 0;
    for (const Named& entry : table) {
        names.emplace_back(entry.name);
        if (entry.name == word) return entry.si;
        if (entry.name.starts_with(word) && !word.empty()) {
            found.emplace_back(entry.name);
            si = entry.si;
        }
    }
    if (found.size() == 1) return si;
    at.fail(fmt::format("{}: {} is not a known unit{}", argument, reader::quote(word),
                        reader::did_you_mean(word, names, "known")));
}

Units read_units(const Dataset& data) {
    const Statement* found = nullptr;
    for (const Statement& statement : data.statements)
        if (statement.keyword == "UNITS") {
            if (found) fail(data.file, statement, "a second UNITS statement; allowed: one");
            found = &statement;
        }
    if (!found)
        reader::fail(data.file, data.last_line, "UNITS",
                     "missing: the units of the file are unknown");
    const Arguments at(data.file, *found,
                       {{}, {"FORCE", "MASS", "LENGTH", "TIME", "SYSTEM", "UCF"}, {}});
    double force = 1, mass = 1, length = 1, time = 1;
    if (at.has("SYSTEM")) {
        struct System {
            std::string_view name;
            double force, mass, length;
        };
        constexpr System systems[] = {{"MKS", 1, 1, 1},
                                      {"CGS", 1e-5, 1e-3, 1e-2},
                                      {"FPS", pound * g_n, pound, 12 * inch},
                                      {"IPS", pound * g_n, pound, inch}};
        const std::string word = at.word("SYSTEM");
        const auto system = std::ranges::find(systems, word, &System::name);
        if (system == std::end(systems))
            at.fail(
                fmt::format("SYSTEM: {} is not a known system of units; known: MKS, CGS, FPS, IPS",
                            reader::quote(word)));
        force = system->force, mass = system->mass, length = system->length;
    }
    if (at.has("FORCE")) force = unit(at, "FORCE", forces);
    if (at.has("MASS")) mass = unit(at, "MASS", masses);
    if (at.has("LENGTH")) length = unit(at, "LENGTH", lengths);
    if (at.has("TIME")) time = unit(at, "TIME", times);
    if (!at.has("SYSTEM"))
        for (const std::string_view name : {"FORCE", "LENGTH"})
            if (!at.has(name)) at.fail(fmt::format("{} is missing", name));
    Units units;
    units.metre = length;
    units.second = time;
    units.mass = mass;
    units.length_name = length == 1 ? "m" : "mm";
    units.force_name = force == 1e3 ? "kN" : "N";
    units.length = length == 1 ? 1 : length == 1e-3 ? 1 : length * 1000;
    units.force = force == 1e3 ? 1 : force;
    const auto as_written = [&](std::string_view name) {
        return at.has(name) ? at.word(name) : std::string("(default)");
    };
    units.remark = at.has("SYSTEM")
                       ? fmt::format("Units of the file: SYSTEM={}", at.word("SYSTEM"))
                       : fmt::format("Units of the file: {}, {}, {}, {}", as_written("FORCE"),
                                     as_written("MASS"), as_written("LENGTH"), as_written("TIME"));
    units.remark +=
        fmt::format("; in the scene {}, {}, kg, rad{}.", units.length_name, units.force_name,
                    units.length != 1 || units.force != 1
                        ? ", since a scene does not have the file's units: numbers are converted"
                        : "");
    return units;
}

Matrix3d about(int axis, double angle) {
    return Eigen::AngleAxisd(angle, Vector3d::Unit(axis)).toRotationMatrix();
}
// Euler angles 3-1-3: body-fixed about z, the new x, the new z.
Matrix3d euler_313(const std::vector<double>& a) {
    return about(2, a[0]) * about(0, a[1]) * about(2, a[2]);
}

// Origin and axes from `origin` (QP, QG), REULER, or two points: z along the first, x in the half
// plane of the second; with USEXP the roles of x and z are swapped.
Frame read_frame(const Arguments& at, const char* origin, const char* z_name, const char* x_name,
                 double length) {
    Frame frame;
    const Vector3d q = vector(at.numbers(origin, 3, 3));
    frame.r = length * q;
    if (at.has("REULER")) {
        if (at.has(z_name) || at.has(x_name))
            at.fail(fmt::format("REULER together with {} or {}", z_name, x_name));
        frame.A = euler_313(at.angles("REULER", 3));
        return frame;
    }
    if (!at.has(z_name) && !at.has(x_name)) return frame;
    const bool use_x = at.has("USEXP");
    const auto towards = [&](const char* name, Vector3d& u) {
        if (!at.has(name)) return false;
        u = vector(at.numbers(name, 3, 3)) - q;
        if (!(u.norm() > 0))
            at.fail(fmt::format("{} coincides with {}; it must be another point", name, origin));
        u.normalize();
        return true;
    };
    Vector3d z = Vector3d::UnitZ(), x = Vector3d::UnitX();
    const bool has_z = towards(z_name, z), has_x = towards(x_name, x);
    const Vector3d& first = use_x ? x : z;
    if (use_x && !has_x) at.fail(fmt::format("USEXP without {}", x_name));
    if (!use_x && !has_z) at.fail(fmt::format("{} without {}", x_name, z_name));
    Vector3d second = use_x ? z : x;
    if (!(use_x ? has_z : has_x))
        second = std::abs(first.dot(second)) < 0.9 ? second : Vector3d(Vector3d::UnitY());
    if (!(first.cross(second).norm() > 1e-9))
        at.fail(fmt::format("{} and {} are on one line with {}", z_name, x_name, origin));
    if (use_x) {
        frame.A.col(0) = x;
        frame.A.col(1) = second.cross(x).normalized();
        frame.A.col(2) = x.cross(frame.A.col(1));
    } else {
        frame.A.col(2) = z;
        frame.A.col(1) = z.cross(second).normalized();
        frame.A.col(0) = Vector3d(frame.A.col(1)).cross(z);
    }
    return frame;
}

const Shape part_shape{{"GROUND"},
                       {"MASS", "CM", "IM", "IP", "QG", "REULER", "ZG", "XG", "VX", "VY", "VZ",
                        "WX", "WY", "WZ", "VM", "WM", "EXACT", "MATERIAL", "VELOCITY"},
                       {}};
const Shape marker_shape{{"USEXP", "FLOATING"},
                         {"PART", "POINT_MASS", "FLEX_BODY", "FE_PART", "QP", "REULER", "ZP", "XP",
                          "RM", "NODE_ID", "NODE_LABEL"},
                         {}};

Part read_part(const Dataset& data, const Statement& statement, const Units& units) {
    const Arguments at(data.file, statement, part_shape);
    Part part;
    part.statement = &statement;
    part.is_ground = at.has("GROUND");
    if (part.is_ground) return part;
    part.pose = read_frame(at, "QG", "ZG", "XG", units.length);
    part.mass = at.number("MASS", 0) * units.mass;
    if (part.mass < 0) at.fail("MASS is negative");
    part.cm = at.id("CM");
    return part;
}

}  // namespace

Frame placed(const Frame& a, const Frame& b) { return {a.r + a.A * b.r, a.A * b.A}; }

Geometry read_geometry(const Dataset& data) {
    Geometry geometry;
    geometry.units = read_units(data);
    int ground = 0;
    for (const Statement& statement : data.statements) {
        if (statement.keyword != "PART" && statement.keyword != "POINT_MASS") continue;
        Part part = read_part(data, statement, geometry.units);
        if (part.is_ground && ground)
            fail(data.file, statement,
                 fmt::format("a second ground; the first is PART/{}", ground));
        if (part.is_ground) ground = statement.id;
        geometry.parts.emplace(statement.id, part);
    }
    if (!ground)
        reader::fail(data.file, data.last_line, "PART", "none of them is GROUND; one must be");

    // Poses relative to the part, or to another marker of the part.
    std::map<int, std::pair<Frame, int>> local;
    int last_body = 0;
    std::set<int> flexible;
    for (const Statement& statement : data.statements) {
        const bool is_flexible = statement.keyword == "FLEX_BODY" || statement.keyword == "FE_PART";
        if (is_flexible) flexible.insert(statement.id);
        if (is_flexible || statement.keyword == "PART" || statement.keyword == "POINT_MASS")
            last_body = statement.id;
        if (statement.keyword != "MARKER") continue;
        const Arguments at(data.file, statement, marker_shape);
        Marker marker;
        marker.statement = &statement;
        marker.part = last_body;
        marker.floats = at.has("FLOATING");
        for (const char* part : {"PART", "POINT_MASS", "FLEX_BODY", "FE_PART"})
            if (at.has(part)) marker.part = at.id(part);
        if (!geometry.parts.contains(marker.part) && !flexible.contains(marker.part))
            at.fail(marker.part ? fmt::format("there is no PART/{}", marker.part)
                                : "belongs to no part");
        geometry.markers.emplace(statement.id, marker);
        local[statement.id] = {read_frame(at, "QP", "ZP", "XP", geometry.units.length),
                               at.id("RM")};
    }

    // Resolves chains of RM references, each link once.
    for (auto& [id, marker] : geometry.markers) {
        std::vector<int> chain;
        for (int at = id; at;) {
            chain.push_back(at);
            const int next = local.at(at).second;
            if (!next) break;
            const auto& from = *geometry.markers.at(at).statement;
            if (!geometry.markers.contains(next))
                fail(data.file, from, fmt::format("RM: there is no MARKER/{}", next));
            if (chain.size() == longest_chain || std::ranges::find(chain, next) != chain.end())
                fail(data.file, from,
                     fmt::format(
                         "RM: MARKER/{} refers to itself, or by a chain of more than {} markers",
                         next, longest_chain));
            if (geometry.markers.at(next).part != geometry.markers.at(at).part)
                fail(data.file, from, fmt::format("RM: MARKER/{} is on another part", next));
            at = next;
        }
        for (std::size_t k = chain.size() - 1; k-- > 0;)
            local.at(chain[k]) = {placed(local.at(chain[k + 1]).first, local.at(chain[k]).first),
                                  0};
        const auto part = geometry.parts.find(marker.part);
        marker.pose = part == geometry.parts.end() ? local.at(id).first
                                                   : placed(part->second.pose, local.at(id).first);
    }

    Eigen::AlignedBox3d box;
    for (const auto& [id, marker] : geometry.markers)
        if (!marker.floats) box.extend(marker.pose.r);
    for (const auto& [id, part] : geometry.parts)
        if (part.cm && !geometry.markers.contains(part.cm))
            fail(data.file, *part.statement, fmt::format("CM: there is no MARKER/{}", part.cm));
    geometry.size = box.isEmpty() || !(box.diagonal().norm() > 0) ? 1 : box.diagonal().norm();
    return geometry;
}

}  // namespace elastocheck::importer::adm
