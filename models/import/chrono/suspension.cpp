#include "models/import/chrono/suspension.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/import/curves.hpp"
#include "models/reader/words.hpp"

namespace elastocheck::importer::chrono {
namespace {

using reader::Cursor;

// The force of a closed stop in Chrono::Vehicle, "from an ADAMS/Car example", over its penetration; constant beyond.
const Rows stop_table{{0, 0},       {0.002, 200},  {0.004, 400},   {0.006, 600},
                      {0.008, 800}, {0.01, 1000},  {0.02, 2500},   {0.03, 4500},
                      {0.04, 7500}, {0.05, 12500}, {0.06, 125000}, {0.07, 125000}};

Vector3d vector(const Cursor& at) {
    const auto items = at.list(3, "numbers");
    return {items[0].number(), items[1].number(), items[2].number()};
}

const std::set<std::string> of_motion_or_pictures{"Inertia",
                                                  "Moments of Inertia",
                                                  "Products of Inertia",
                                                  "Radius",
                                                  "Width",
                                                  "Visualization",
                                                  "Link Radius",
                                                  "Center Link Inertia",
                                                  "Side Link Inertia",
                                                  "Damping Coefficient",
                                                  "Damping Curve Data",
                                                  "Degressivity Compression",
                                                  "Degressivity Expansion",
                                                  "Rotational Damping",
                                                  "Location Stabilizer",
                                                  "Portal Offset"};

}  // namespace

Matrix3d frame_along(const Vector3d& w, const Vector3d& towards) {
    Matrix3d A;
    A.col(2) = w.normalized();
    Vector3d v = w.cross(towards);
    if (!(v.norm() > 1e-9 * w.norm() * towards.norm())) v = A.col(2).unitOrthogonal();
    A.col(1) = v.normalized();
    A.col(0) = A.col(1).cross(A.col(2));
    return A;
}

// ---- Reading

Cursor Suspension::at(const char* path) const {
    Cursor found = file_;
    std::string_view rest(path);
    std::string prefix;
    for (;;) {
        const std::size_t end = std::min(rest.find('/'), rest.size());
        const std::string key(rest.substr(0, end));
        prefix += (prefix.empty() ? "" : "/") + key;
        used_.insert(prefix);
        found = found.require(key);
        if (end == rest.size()) return found;
        rest.remove_prefix(end + 1);
    }
}

bool Suspension::has(const char* path) const {
    std::optional<Cursor> found = file_;
    std::string_view rest(path);
    for (;;) {
        const std::size_t end = std::min(rest.find('/'), rest.size());
        if (found->value->kind != reader::Value::Kind::map) return false;
        found = found->optional(std::string(rest.substr(0, end)));
        if (!found) return false;
        if (end == rest.size()) return true;
        rest.remove_prefix(end + 1);
    }
}

Vector3d Suspension::left(const char* path) const { return vector(at(path)); }

Place Suspension::place(const char* path) const { return {at(path).value->line, path}; }

void Suspension::note_unused() {
    Notes& notes = draft_.notes;
    std::map<std::string, std::string> dynamic;
    for (std::size_t k = 0; k < file_.value->keys.size(); ++k) {
        const std::string& part = file_.value->keys[k];
        const auto& item = file_.value->items[k];
        if (part == "Axle") {
            notes.leave_out("being of motion alone", {item.line, "Axle (inertia of the drive shaft)"});
            continue;
        }
        if (part == "Vehicle-Frame Inertia" || part == "Independent" || part == "Steerable" ||
            part == "Antiroll Body" || part == "Output" || part == "Camber Angle (deg)" ||
            part == "Toe Angle (deg)" || part == "Name" || part == "Type" || part == "Template")
            continue;
        if (!used_.contains(part)) {
            notes.miss({item.line, part}, "not known of this template");
            continue;
        }
        if (item.kind != reader::Value::Kind::map) continue;
        for (std::size_t n = 0; n < item.keys.size(); ++n) {
            const std::string& key = item.keys[n];
            if (used_.contains(part + "/" + key)) continue;
            if (of_motion_or_pictures.contains(key))
                dynamic[key] += (dynamic[key].empty() ? "of " : ", ") + part;
            else if (!key.starts_with("Spring") && !key.starts_with("Free") && !key.ends_with("Length") &&
                     key != "Preload" && key != "Map Data" && key != "Deformation" &&
                     !key.ends_with("Bushing Data"))
                notes.warn({item.items[n].line, part + "/" + key},
                           "not known of this template, and not used");
        }
    }
    for (const auto& [key, parts] : dynamic)
        notes.leave_out("being of motion or of pictures alone", {0, key + " " + parts});
}

// ---- Writing

std::string Suspension::hardpoint(const std::string& name, const Vector3d& p, const char* path) {
    return draft_.points.at(p, name, path ? place(path) : Place{});
}

void Suspension::body(const std::string& name, const Vector3d& com, const char* part, const char* mass) {
    Fields fields;
    fields.add("origin", hardpoint(name + ".cm", com, nullptr));
    const std::string path = std::string(part) + "/" + mass;
    if (has(path.c_str())) {
        const double m = real(path.c_str());
        if (!options_.drop_dynamics && m > 0) fields.add("mass", m);
    }
    draft_.bodies.push_back({body_names_.take(name), "{" + fields.text() + "}", place(part)});
    draft_.notes.count("bodies");
}

void Suspension::joint(const std::string& name, const char* type, const std::string& i, const std::string& j,
                       Fields fields, const Place& from) {
    Fields all;
    all.add("type", type).add("bodies", "[" + i + ", " + j + "]");
    draft_.joints.push_back({joint_names_.take(name), "{" + all.text() + ", " + fields.text() + "}", from});
    draft_.notes.count("joints");
}

void Suspension::spherical(const std::string& name, const std::string& i, const std::string& j,
                           const Vector3d& p, const char* path) {
    joint(name, "spherical", i, j, Fields{}.add("at", hardpoint(name, p, path)), place(path));
}

void Suspension::universal(const std::string& name, const std::string& i, const std::string& j,
                           const Vector3d& p, const Vector3d& x, const Vector3d& y, const char* path) {
    const Vector3d u = x.normalized(), v = (y - u.dot(y) * u).normalized();
    if (const double off = std::abs(u.dot(y.normalized())); off > 1e-9)
        draft_.notes.warn(
            place(path),
            fmt::format("the axes of the universal joint are {:.2g} rad off the right angle; here the "
                        "second is put right",
                        std::asin(std::min(off, 1.0))));
    joint(
        name, "universal", i, j,
        Fields{}.add("at", hardpoint(name, p, path)).add("axis_i", direction(u)).add("axis_j", direction(v)),
        place(path));
}

void Suspension::revolute(const std::string& name, const std::string& i, const std::string& j,
                          const Vector3d& p, const Vector3d& axis, const char* path) {
    joint(name, "revolute", i, j,
          Fields{}.add("at", hardpoint(name, p, path)).add("axis", direction(axis.normalized())),
          place(path));
}

void Suspension::fixed(const std::string& name, const std::string& i, const std::string& j, const Vector3d& p,
                       const char* path) {
    joint(name, "fixed", i, j, Fields{}.add("at", hardpoint(name, p, path)), place(path));
}

void Suspension::distance(const std::string& name, const std::string& i, const Vector3d& from,
                          const std::string& j, const Vector3d& to, const char* path) {
    joint(name, "distance", i, j,
          Fields{}
              .add("from", hardpoint(name + ".inner", from, path))
              .add("to", hardpoint(name + ".outer", to, path)),
          place(path));
}

void Suspension::in_plane(const std::string& name, const std::string& i, const std::string& j,
                          const Vector3d& p, const Vector3d& normal, const Place& from) {
    joint(name, "in_plane", i, j,
          Fields{}.add("at", hardpoint(name, p, nullptr)).add("normal", direction(normal.normalized())),
          from);
}

// One bushing, whose frame rides on body 2: F = K_lin δ, T = K_rot θ, θ the rotation vector, both straight along its axes.
// F is the same in all directions, so it goes through both points. T is the gradient of an energy where K_rot is the same
// about all axes; where it is not, as in place of a revolute, it is what Chrono says: without one.
void Suspension::joint_or_bushing(Kind kind, const std::string& name, const std::string& body1,
                                  const std::string& body2, const Vector3d& p, const Matrix3d& frame,
                                  const char* path, const std::optional<Cursor>& data) {
    if (!data) {
        if (kind == Kind::revolute) return revolute(name, body1, body2, p, frame.col(2), path);
        if (kind == Kind::universal)
            return universal(name, body1, body2, p, frame.col(0), frame.col(1), path);
        return spherical(name, body1, body2, p, path);
    }
    const double linear = data->require("Stiffness Linear").number(),
                 rotational = data->require("Stiffness Rotational").number();
    double free = 0;
    if (const auto dof = data->optional("DOF"))
        if (const auto k = dof->optional("Stiffness Rotational")) free = k->number();
    const auto rate = [&](int axis) {
        const bool is_free = kind == Kind::spherical || (kind == Kind::revolute ? axis == 2 : axis != 2);
        return is_free ? free : rotational;
    };
    Fields fields;
    fields.add("bodies", "[" + body2 + ", " + body1 + "]").add("at", hardpoint(name, p, path));
    const bool is_round = rate(0) == rate(1) && rate(1) == rate(2);
    if (!is_round)
        fields.add("frame",
                   fmt::format("{{z: {}, x: {}}}", direction(frame.col(2)), direction(frame.col(0))));
    fields.add("rates", fmt::format("[{0}, {0}, {0}]", number(linear)))
        .add("rotational_rates",
             fmt::format("[{}, {}, {}]", number(rate(0)), number(rate(1)), number(rate(2))));
    if (!is_round) fields.add("formulation", "{conjugate: false}");
    draft_.bushings.push_back({element_names_.take(name), "{" + fields.text() + "}", place(path)});
    draft_.notes.count("bushings");
}

void Suspension::tsda(const std::string& name, const std::string& i, const Vector3d& from,
                      const std::string& j, const Vector3d& to, const Cursor& data) {
    const Place here{data.value->line, data.path};
    const double drawn = (to - from).norm();
    Fields fields;
    fields.add("bodies", "[" + i + ", " + j + "]")
        .add("from", draft_.points.at(from, name + ".top", here))
        .add("to", draft_.points.at(to, name + ".seat", here));
    const auto put = [&](std::vector<Entry>& list) {
        list.push_back({element_names_.take(name), "{" + fields.text() + "}", here});
    };
    const auto k = data.optional("Spring Coefficient"), curve = data.optional("Spring Curve Data"),
               map = data.optional("Map Data");
    const double preload = data.optional("Preload") ? data.require("Preload").number() : 0;
    const bool damps = data.optional("Damping Coefficient") || data.optional("Damping Curve Data");
    if (!map && !curve && (!k || k->number() == 0) && preload == 0) {  // a damper
        if (options_.drop_dynamics)
            draft_.notes.leave_out("by --drop dynamics", here);
        else
            put(draft_.dampers);
        return;
    }
    if (damps && side > 0)
        draft_.notes.leave_out("being of motion alone", {here.line, "damping of " + here.what});
    if (!data.optional("Free Length") && !map) data.require("Free Length");
    const double free = data.optional("Free Length") ? data.require("Free Length").number() : drawn;
    double force = 0;  // at the design position, pushing apart
    if (k) {
        const double rate = k->number();
        if (rate < 0) k->fail("negative; no spring of a scene is");
        force = preload - rate * (drawn - free);
        if (const double length = free + preload / rate; preload == 0)
            fields.add("rate", rate).add("free_length", free);
        else if (length > 0)
            fields.add("rate", rate).add("free_length", length);
        else
            fields.add("rate", rate).add("preload", force);
    } else {
        // Over l - L0. Chrono runs straight between the rows, and holds the ends.
        Rows rows;
        if (curve) {
            for (const Cursor& row : curve->items()) {
                const auto cells = row.list(2, "numbers, deflection and force");
                rows.emplace_back(cells[0].number(), cells[1].number() - preload);
            }
        } else {
            // A map over speed (rows) and deformation (columns): at rest, the row of speed zero, or between its neighbours.
            const auto columns = data.require("Deformation").items();
            const auto lines = map->items();
            std::vector<std::pair<double, std::vector<double>>> by_speed;
            for (const Cursor& line : lines) {
                const auto cells =
                    line.list(columns.size() + 1, "numbers, a speed and a force for each deformation");
                std::vector<double> forces;
                for (std::size_t n = 1; n < cells.size(); ++n) forces.push_back(cells[n].number());
                by_speed.emplace_back(cells[0].number(), forces);
            }
            for (std::size_t n = 0; n < columns.size(); ++n) {
                double at_rest = NAN;
                for (std::size_t m = 0; m < by_speed.size(); ++m) {
                    if (by_speed[m].first == 0) at_rest = by_speed[m].second[n];
                    if (m > 0 && by_speed[m - 1].first < 0 && by_speed[m].first > 0) {
                        const double t = -by_speed[m - 1].first / (by_speed[m].first - by_speed[m - 1].first);
                        at_rest = (1 - t) * by_speed[m - 1].second[n] + t * by_speed[m].second[n];
                    }
                }
                if (!std::isfinite(at_rest)) map->fail("no row of speed zero, nor any around it");
                rows.emplace_back(columns[n].number(), at_rest - preload);
            }
            if (std::ranges::all_of(rows, [](const auto& row) { return row.second == 0; })) {
                if (options_.drop_dynamics)
                    draft_.notes.leave_out("by --drop dynamics", here);
                else
                    put(draft_.dampers);
                return;
            }
        }
        if (rows.size() < 2) data.fail("a curve needs at least two rows");
        for (std::size_t n = 1; n < rows.size(); ++n)
            if (!(rows[n].first > rows[n - 1].first) || rows[n].second < rows[n - 1].second)
                data.fail(
                    fmt::format("row {}: a deflection that does not rise, or a force that falls, which no "
                                "spring of a scene has",
                                n + 1));
        const double x = drawn - free;
        const auto above = std::ranges::find_if(rows, [&](const auto& row) { return row.first > x; });
        if (above == rows.begin())
            force = -rows.front().second;
        else if (above == rows.end())
            force = -rows.back().second;
        else
            force = -((above - 1)->second + (x - (above - 1)->first) / (above->first - (above - 1)->first) *
                                                (above->second - (above - 1)->second));
        if (side > 0)
            if (const double off = off_straight(rows); off > 1e-9)
                draft_.notes.warn(
                    here, fmt::format(
                              "Chrono runs straight between the rows, a scene smoothly: up to {:.2g} of the "
                              "largest force apart",
                              off));
        fields.add("curve", "{table: " + table(rows) + ", outside: unknown}").add("free_length", free);
    }
    const auto least = data.optional("Minimum Length"), most = data.optional("Maximum Length");
    if (side > 0) {
        if (force < 0 && free != drawn)
            draft_.notes.warn(here, fmt::format("in tension at the design position: {:.4g} N", -force));
        if (least && most && least->number() > most->number())
            draft_.notes.warn(
                here,
                fmt::format(
                    "its minimum length {} is above its maximum length {}: both stops are always closed",
                    least->value->text, most->value->text));
        else if ((least && least->number() > drawn) || (most && most->number() < drawn))
            draft_.notes.warn(here, fmt::format("a stop is closed at the design length {:.4g} m", drawn));
        if (least || most)
            draft_.notes.warn(
                here, fmt::format(
                          "Chrono's stops run straight between their rows, a scene smoothly: up to {:.2g} of "
                          "125 kN apart",
                          off_straight(stop_table)));
    }
    const auto stop = [&](double clearance) {
        return fmt::format("{{clearance: {}, curve: {{table: {}}}}}", computed(clearance), table(stop_table));
    };
    if (least) fields.add("bump_stop", stop(drawn - least->number()));
    if (most) fields.add("rebound_stop", stop(most->number() - drawn));
    put(draft_.springs);
    draft_.notes.count("springs");
}

void Suspension::torsion(const std::string& name, const std::string& i, const std::string& j,
                         const Vector3d& p, const Vector3d& axis, double rate, double moment,
                         const char* path) {
    Fields fields;
    fields.add("bodies", "[" + i + ", " + j + "]")
        .add("at", hardpoint(name, p, nullptr))
        .add("axis", direction(axis));
    fields.add("rate", rate);
    if (moment != 0) fields.add("preload_moment", computed(moment));
    draft_.torsion_springs.push_back({element_names_.take(name), "{" + fields.text() + "}", place(path)});
    draft_.notes.count("torsion springs");
}

// Rz(∓toe) Rx(∓camber) of the chassis, - on the left. Its spin is held: nothing at rest turns it.
void Suspension::spindle(const std::string& carrier) {
    const std::string name = sided("spindle");
    const Vector3d centre = point("Spindle/COM");
    body(name, centre, "Spindle");
    draft_.points.at(centre, name, place("Spindle/COM"));
    fixed(sided("wheel_bearing"), name, carrier, centre, "Spindle/COM");
    const auto angle = [&](const char* key) {
        const auto given = file_.optional(key);
        return given ? given->number() * std::numbers::pi / 180 : 0.0;
    };
    const double toe = angle("Toe Angle (deg)"), camber = angle("Camber Angle (deg)");
    Vector3d axis = Eigen::AngleAxisd(-side * toe, Vector3d::UnitZ()) *
                    (Eigen::AngleAxisd(-side * camber, Vector3d::UnitX()) * Vector3d(Vector3d::UnitY()));
    axis *= side;
    draft_.wheels.push_back({side > 0 ? "left" : "right",
                             "{" +
                                 Fields{}
                                     .add("body", name)
                                     .add("centre", hardpoint(name, centre, "Spindle/COM"))
                                     .add("spin_axis", direction(axis))
                                     .add("side", side > 0 ? "left" : "right")
                                     .text() +
                                 "}",
                             place("Spindle")});
}

void Suspension::link(const std::string& name, const char* part, const Vector3d& com, const std::string& i,
                      const Vector3d& at_i, const std::string& j, const Vector3d& at_j, bool universal_at_j,
                      const char* path_i, const char* path_j) {
    body(name, com, part);
    spherical(name + ".inner", i, name, at_i, path_i);
    if (!universal_at_j) return spherical(name + ".outer", name, j, at_j, path_j);
    const Matrix3d A = frame_along(at_j - at_i, Vector3d::UnitX());
    universal(name + ".outer", name, j, at_j, A.col(0), A.col(1), path_j);
}

void Suspension::tierod(const char* part, const char* chassis_end, const char* outer_end,
                        const std::string& on_outer) {
    const std::string inner_path = std::string(part) + "/" + chassis_end,
                      outer_path = std::string(part) + "/" + outer_end;
    const Vector3d inner = point(inner_path.c_str()), outer = point(outer_path.c_str());
    const std::string name = sided("tierod"), path(part);
    const bool is_body =
        has((path + "/Mass").c_str()) && has((path + "/Inertia").c_str()) && has((path + "/Radius").c_str());
    if (!is_body) return distance(name, "ground", inner, on_outer, outer, outer_path.c_str());
    body(name, 0.5 * (inner + outer), part);
    std::optional<Cursor> data;
    if (has((path + "/Bushing Data").c_str())) data = at((path + "/Bushing Data").c_str());
    Matrix3d A = frame_along(outer - inner, Vector3d::UnitX());
    joint_or_bushing(Kind::spherical, name + ".outer", on_outer, name, outer, Matrix3d::Identity(),
                     outer_path.c_str(), data);
    joint_or_bushing(Kind::universal, name + ".inner", "ground", name, inner, A, inner_path.c_str(), data);
}

}  // namespace elastocheck::importer::chrono
