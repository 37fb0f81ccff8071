#include "models/import/adm/geometry.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::adm {

using Eigen::Matrix3d, Eigen::Vector3d;

Vector3d vector(const Statement& s, std::string_view argument) {
    const auto v = s.numbers(argument, 3, 3);
    return v.empty() ? Vector3d::Zero() : Vector3d(v[0], v[1], v[2]);
}

namespace {

constexpr std::size_t max_chain = 100;  // of markers, each given relative to the next (RM)

// Size in SI of an entry of a table of units.
double size_of(const reader::Value& table, std::string_view name) {
    const std::string& digits = entry(table, name)->text;
    double si = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), si);
    return si;
}

// The size of a unit in SI; its name may be abbreviated. Without the argument, that of the system.
double unit(const Statement& s, std::string_view argument, const reader::Value* system) {
    if (!s.has(argument)) return system && argument != "TIME" ? size_of(*system, argument) : 1;
    const std::string word = s.word(argument);
    const reader::Value& table = *entry(dataset_table("units"), argument);
    if (const auto found = matches(word, table.keys); found.size() == 1)
        return size_of(table, found[0]);
    s.fail("{}: {} is not a known unit{}", argument, reader::quote(word),
           reader::did_you_mean(word, table.keys, "known"));
}

Units read_units(const Dataset& data, const std::string& file) {
    const Statement* found = nullptr;
    for (const Statement& s : data.statements)
        if (s.is("UNITS") && std::exchange(found, &s) != nullptr)
            s.fail("a second UNITS statement; allowed: one");
    if (!found)
        reader::fail(file, data.last_line, "UNITS", "missing: the units of the file are unknown");
    const Statement& s = *found;
    const bool has_system = s.has("SYSTEM");
    const reader::Value* system =
        has_system ? entry(dataset_table("systems"), s.word("SYSTEM")) : nullptr;
    if (has_system && !system)
        s.fail("SYSTEM: {} is not a known system of units; known: {}",
               reader::quote(s.word("SYSTEM")), fmt::join(dataset_table("systems").keys, ", "));
    const double force = unit(s, "FORCE", system);
    Units units;
    units.mass = unit(s, "MASS", system);
    const double length = units.metre = unit(s, "LENGTH", system);
    units.second = unit(s, "TIME", system);
    for (const std::string_view name : {"FORCE", "LENGTH"})
        if (!has_system && !s.has(name)) s.fail("{} is missing", name);
    units.length_name = length == 1 ? "m" : "mm";
    units.force_name = force == 1e3 ? "kN" : "N";
    units.length = length == 1 || length == 1e-3 ? 1 : length * 1000;
    units.force = force == 1e3 ? 1 : force;
    std::string written = has_system ? "SYSTEM=" + s.word("SYSTEM") : "";
    if (!has_system)
        for (const char* name : {"FORCE", "MASS", "LENGTH", "TIME"})
            written += (written.empty() ? "" : ", ") + (s.has(name) ? s.word(name) : "(default)");
    units.remark =
        fmt::format("Units of the file: {}; in the scene {}, {}, kg, rad{}.", written,
                    units.length_name, units.force_name,
                    units.length != 1 || units.force != 1
                        ? ", since a scene does not have the file's units: numbers are converted"
                        : "");
    return units;
}

Matrix3d rotation_about(int axis, double angle) {
    return Eigen::AngleAxisd(angle, Vector3d::Unit(axis)).toRotationMatrix();
}

// Origin and axes from `origin` (QP, QG), Euler angles 3-1-3 (REULER), or two points: z along the
// first, x in the half plane of the second; with USEXP the roles of x and z are swapped.
Frame read_frame(const Statement& s, const char* origin, const char* z_name, const char* x_name,
                 double length) {
    const Vector3d q = vector(s, origin);
    Frame frame{.r = length * q};
    const bool has_z = s.has(z_name), has_x = s.has(x_name);
    if (s.has("REULER")) {
        if (has_z || has_x) s.fail("REULER together with {} or {}", z_name, x_name);
        const auto a = s.numbers("REULER", 3, 3, Statement::Unit::angle);
        frame.A = rotation_about(2, a[0]) * rotation_about(0, a[1]) * rotation_about(2, a[2]);
        return frame;
    }
    if (!has_z && !has_x) return frame;
    const bool use_x = s.has("USEXP");
    const auto towards = [&](const char* name, bool is_given, const Vector3d& otherwise) {
        const Vector3d u = is_given ? Vector3d(vector(s, name) - q) : otherwise;
        if (!(u.norm() > 0)) s.fail("{} coincides with {}; it must be another point", name, origin);
        return is_given ? Vector3d(u.normalized()) : u;
    };
    const Vector3d z = towards(z_name, has_z, Vector3d::UnitZ()),
                   x = towards(x_name, has_x, Vector3d::UnitX()), first = use_x ? x : z;
    if (use_x && !has_x) s.fail("USEXP without {}", x_name);
    if (!use_x && !has_z) s.fail("{} without {}", x_name, z_name);
    Vector3d second = use_x ? z : x;
    if (!(use_x ? has_z : has_x) && !(std::abs(first.dot(second)) < 0.9))
        second = Vector3d::UnitY();
    if (!(first.cross(second).norm() > 1e-9))
        s.fail("{} and {} are on one line with {}", z_name, x_name, origin);
    const Vector3d y = (use_x ? second.cross(x) : z.cross(second)).normalized();
    frame.A << (use_x ? x : Vector3d(y.cross(z))), y, (use_x ? Vector3d(x.cross(y)) : z);
    return frame;
}

Part read_part(const Statement& s, const Units& units) {
    Part part{.statement = &s, .is_ground = s.has("GROUND"), .pose = {}};
    if (part.is_ground) return part;
    part.pose = read_frame(s, "QG", "ZG", "XG", units.length);
    part.mass = s.number("MASS", 0) * units.mass;
    if (part.mass < 0) s.fail("MASS is negative");
    part.cm = s.id_of("CM");
    return part;
}

// Pose of a marker in its part, or in another marker of the part.
struct Local {
    Frame frame;
    int reference = 0;  // id of that marker; 0: the part
};

// Expresses the pose of a marker, and of all markers on its chain of RM references, in the part.
void resolve(const Geometry& geometry, int id, std::map<int, Local>& local) {
    std::vector<int> chain;
    for (int next = id; next; next = local.at(next).reference) {
        if (!chain.empty()) {
            const Marker& from = geometry.markers.at(chain.back());
            const auto to = geometry.markers.find(next);
            if (to == geometry.markers.end())
                from.statement->fail("RM: there is no MARKER/{}", next);
            if (chain.size() == max_chain || std::ranges::find(chain, next) != chain.end())
                from.statement->fail(
                    "RM: MARKER/{} refers to itself, or by a chain of more than {} markers", next,
                    max_chain);
            if (to->second.part != from.part)
                from.statement->fail("RM: MARKER/{} is on another part", next);
        }
        chain.push_back(next);
    }
    for (std::size_t k = chain.size() - 1; k-- > 0;)
        local.at(chain[k]) = {composed(local.at(chain[k + 1]).frame, local.at(chain[k]).frame)};
}

}  // namespace

Frame composed(const Frame& a, const Frame& b) { return {a.r + a.A * b.r, a.A * b.A}; }

Geometry read_geometry(const Dataset& data, const std::string& file) {
    Geometry geometry{.units = read_units(data, file), .parts = {}, .markers = {}};
    int ground = 0;
    for (const Statement& s : data.statements) {
        if (!s.is("PART POINT_MASS")) continue;
        const Part part = read_part(s, geometry.units);
        if (part.is_ground && ground) s.fail("a second ground; the first is PART/{}", ground);
        if (part.is_ground) ground = s.id;
        geometry.parts.emplace(s.id, part);
    }
    if (!ground) reader::fail(file, data.last_line, "PART", "none of them is GROUND; one must be");

    std::map<int, Local> local;
    int last_body = 0;
    std::set<int> flexible;
    for (const Statement& s : data.statements) {
        if (s.is("FLEX_BODY FE_PART")) flexible.insert(s.id);
        if (s.is("FLEX_BODY FE_PART PART POINT_MASS")) last_body = s.id;
        if (!s.is("MARKER")) continue;
        Marker marker{.statement = &s, .part = last_body, .floats = s.has("FLOATING"), .pose = {}};
        for (const char* part : {"PART", "POINT_MASS", "FLEX_BODY", "FE_PART"})
            if (s.has(part)) marker.part = s.id_of(part);
        if (!geometry.parts.contains(marker.part) && !flexible.contains(marker.part))
            s.fail(marker.part ? fmt::format("there is no PART/{}", marker.part)
                               : "belongs to no part");
        geometry.markers.emplace(s.id, marker);
        local[s.id] = {read_frame(s, "QP", "ZP", "XP", geometry.units.length), s.id_of("RM")};
    }
    Eigen::AlignedBox3d box;
    for (auto& [id, marker] : geometry.markers) {
        resolve(geometry, id, local);
        const auto part = geometry.parts.find(marker.part);
        const Frame& frame = local.at(id).frame;
        marker.pose = part == geometry.parts.end() ? frame : composed(part->second.pose, frame);
        if (!marker.floats) box.extend(marker.pose.r);
    }
    for (const auto& [id, part] : geometry.parts)
        if (part.cm && !geometry.markers.contains(part.cm))
            part.statement->fail("CM: there is no MARKER/{}", part.cm);
    geometry.size = box.isEmpty() || !(box.diagonal().norm() > 0) ? 1 : box.diagonal().norm();
    return geometry;
}

}  // namespace elastocheck::importer::adm
