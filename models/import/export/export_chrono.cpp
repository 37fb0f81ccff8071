// Writes the entries of GenericWheeledSuspension: the inverse of chrono/chrono.cpp.
#include "models/import/export/export_chrono.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <set>

#include "elastocheck/read_scene.hpp"
#include "models/import/chrono/suspension.hpp"
#include "models/import/curves.hpp"
#include "models/kinds.hpp"
#include "models/laws.hpp"

namespace elastocheck::importer {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using json = nlohmann::ordered_json;

json coordinates(const Vector3d& v) { return json::array({v.x(), v.y(), v.z()}); }

Matrix3d frame(const Vector3d& x, const Vector3d& z) {
    Matrix3d A;
    A.col(2) = z.normalized();
    A.col(0) = (x - x.dot(A.col(2)) * A.col(2)).normalized();
    A.col(1) = Vector3d(A.col(2)).cross(Vector3d(A.col(0)));
    return A;
}
Matrix3d with_z(const Vector3d& z) { return frame(z.unitOrthogonal(), z); }
Matrix3d with_x(const Vector3d& x) { return frame(x, x.unitOrthogonal()); }

class ChronoWriter {
  public:
    ChronoWriter(const Scene& scene, Exported& result) : scene_(scene), result_(result) {}

    void write_suspension() {
        const auto left =
            std::ranges::find_if(scene_.wheels, [](const Wheel& w) { return w.side > 0; });
        if (left == scene_.wheels.end() || scene_.wheels.size() > 2)
            throw SceneError(
                fmt::format("{}: wheels: a suspension of Chrono has a left wheel, and its mirror "
                            "image or the right one",
                            scene_.source));
        mirrored_ = scene_.wheels.size() == 1;
        pair_bodies();
        json root{{"Name", scene_.name},
                  {"Type", "Suspension"},
                  {"Template", "GenericWheeledSuspension"},
                  {"Vehicle-Frame Inertia", false},
                  {"Independent", mirrored_},
                  {"Steerable", false}};
        spindle(root, *left);
        for (const char* section : {"Bodies", "Joints", "Distance Constraints", "TSDAs", "RSDAs"})
            root[section] = json::array();
        for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
            const Name& name = names_[b];
            if (name.side < 0 || static_cast<BodyId>(b) == spindle_ ||
                static_cast<BodyId>(b) == other_spindle_ || is_rolling(static_cast<BodyId>(b)))
                continue;  // written by its mirror image, or a spindle, which Chrono adds itself
            root["Bodies"].push_back({{"Name", name.stem},
                                      {"Mirrored", mirrored_ || name.side != 0},
                                      {"Position", coordinates(scene_.bodies[b].design.r)},
                                      {"Rotation", {1, 0, 0, 0}},
                                      {"Mass", 1},
                                      {"Moments of Inertia", {1, 1, 1}},
                                      {"Products of Inertia", {0, 0, 0}}});
        }
        for (const Joint& joint : scene_.joints) write(root, joint);
        // Springs first: they include their stops.
        for (const bool stops : {false, true})
            for (const Elastic& elastic : scene_.elastics)
                if ((elastic.written_as == WrittenAs::stop) == stops) write(root, elastic);
        for (const Load& load : scene_.static_loads)
            miss("load '" + load.name + "'", "a suspension file has no loads");
        leave_out_branches(scene_, "without an entry", result_.notes);
        result_.notes.leave_out("without effect at rest", {0, "masses (all written as 1)"});
        result_.text = "// Exported by elastocheck\n";
        for (const auto& line : described(result_.notes))
            result_.text += fmt::format("// {}\n", line);
        result_.text += root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
    }

  private:
    struct Name {
        std::string stem;  // without "_left" or "_right" of a pair
        int side = 0;      // of one of a pair: +1 left, -1 right
    };

    bool is_rolling(BodyId body) const {
        return std::ranges::any_of(scene_.wheels, [&](const Wheel& wheel) {
            return wheel.rolls() && wheel.contact.body == body;
        });
    }

    void miss(const std::string& what, const std::string& why) {
        result_.notes.miss({0, what}, why);
    }

    // Pairs "arm_left" and "arm_right" if they are mirror images at the design position.
    void pair_bodies() {
        const auto& bodies = scene_.bodies;
        for (const Body& body : bodies) names_.push_back({body.name});
        if (mirrored_) return;
        for (std::size_t a = 0; a < bodies.size(); ++a)
            for (std::size_t b = 0; b < bodies.size(); ++b) {
                if (!bodies[a].name.ends_with("_left") || !bodies[b].name.ends_with("_right"))
                    continue;
                const std::string stem = bodies[a].name.substr(0, bodies[a].name.size() - 5);
                Vector3d image = bodies[b].design.r;
                image.y() = -image.y();
                if (bodies[b].name == stem + "_right" &&
                    (image - bodies[a].design.r).norm() <= 1e-12) {
                    names_[a] = {stem, +1};
                    names_[b] = {stem, -1};
                }
            }
    }

    json body(BodyId id) const {
        if (id == ground) return "Chassis";
        const Name& name = names_[static_cast<std::size_t>(id)];
        if (name.side == 0) return name.stem;
        return json::array({name.stem, name.side > 0 ? "Left" : "Right"});
    }
    Vector3d position(BodyId id, const Vector3d& s) const {
        return id == ground ? s
                            : Vector3d(scene_.bodies[static_cast<std::size_t>(id)].design.r + s);
    }
    Vector3d position(const Point& point) const { return position(point.body, point.s_local); }

    // The body to which a body is fixed, if a fixed joint alone holds it; else ground.
    BodyId held_by(BodyId id) const {
        BodyId carrier = ground;
        int uses = 0;
        for (const Joint& joint : scene_.joints)
            std::visit(
                [&](const auto& kind) {
                    if (kind.i.body != id && kind.j.body != id) return;
                    uses += joint.active_only_where_driven ? 0 : 1;
                    if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, Fixed>)
                        carrier = kind.i.body == id ? kind.j.body : kind.i.body;
                },
                joint.kind);
        for (const Elastic& elastic : scene_.elastics) {
            const auto [i, j] = ends(elastic.kind);
            uses += i == id || j == id;
        }
        return uses == 1 ? carrier : ground;
    }

    // Spin axis outboard: e = side · Rz(-side · toe) Rx(-side · camber) y (chrono/suspension.cpp), here of
    // the left side.
    void spindle(json& root, const Wheel& left) {
        BodyId on = left.body;
        if (const BodyId carrier = held_by(on); carrier != ground) {
            spindle_ = on;
            on = carrier;
            for (const Wheel& wheel : scene_.wheels)
                if (wheel.side < 0) other_spindle_ = wheel.body;
        }
        for (const Wheel& wheel : scene_.wheels)
            if (wheel.side < 0 && (Vector3d(left.spin_axis_local.x(), -left.spin_axis_local.y(),
                                            left.spin_axis_local.z()) -
                                   wheel.spin_axis_local)
                                          .norm() > 1e-12)
                miss("wheel " + wheel.name, "its axis is not the left one's image");
        const Vector3d e = left.spin_axis_local.normalized();
        const double deg = 180 / std::numbers::pi;
        root["Camber Angle (deg)"] = -deg * std::asin(std::clamp(e.z(), -1.0, 1.0));
        root["Toe Angle (deg)"] = deg * std::atan2(e.x(), e.y());
        json attached = body(on);
        root["Spindle"] = {{"Attachment Body", attached.is_array() ? attached[0] : attached},
                           {"Mass", 1},
                           {"COM", coordinates(position(left.body, left.centre_local))},
                           {"Inertia", {1, 1, 1}},
                           {"Radius", 0.1},
                           {"Width", 0.1}};
    }

    json& entry(json& root, const char* section, const std::string& name, BodyId i, BodyId j) {
        root[section].push_back(
            {{"Name", name}, {"Mirrored", mirrored_}, {"Body1", body(i)}, {"Body2", body(j)}});
        return root[section].back();
    }
    // Completes an entry of "Joints".
    json& joint(json& entry, const char* type, const Vector3d& at, const Matrix3d& A) {
        const Eigen::Quaterniond q(A);
        entry["Type"] = type;
        entry["Position"] = coordinates(at);
        entry["Rotation"] = json::array({q.w(), q.x(), q.y(), q.z()});
        return entry;
    }

    void write(json& root, const Joint& scene_joint) {
        if (scene_joint.active_only_where_driven)
            return result_.notes.leave_out("active only where a branch drives it",
                                           {0, "drive '" + scene_joint.name + "'"});
        if (is_rolling(ends(scene_joint.kind).i))
            return result_.notes.leave_out("of the wheels, which Chrono adds itself",
                                           {0, "joint '" + scene_joint.name + "'"});
        const auto write_as = [&](const char* type, const auto& k,
                                  const Matrix3d& A = Matrix3d::Identity()) {
            joint(entry(root, "Joints", scene_joint.name, k.i.body, k.j.body), type, position(k.j),
                  A);
        };
        const auto miss_joint = [&](const char* why) {
            miss("joint '" + scene_joint.name + "'", why);
        };
        std::visit(
            overloaded{
                [&](const Spherical& k) { write_as("Spherical", k); },
                [&](const Revolute& k) { write_as("Revolute", k, with_z(k.axis_j.u_local)); },
                [&](const Universal& k) {
                    write_as("Universal", k,
                             frame(k.axis_i.u_local, k.axis_i.u_local.cross(k.axis_j.u_local)));
                },
                [&](const Fixed& k) {
                    const auto is_spindle = [&](BodyId id) {
                        return id != ground && (id == spindle_ || id == other_spindle_);
                    };
                    if (!is_spindle(k.i.body) && !is_spindle(k.j.body))
                        write_as("Lock", k);  // else Chrono adds the joint itself
                },
                [&](const InLine& k) { write_as("Point Line", k, with_x(k.axis_j.u_local)); },
                [&](const InPlane& k) {
                    if (k.offset != 0 || scene_joint.name.ends_with(".drive"))
                        return miss_joint(
                            "it is driven, which is defined by the vehicle, not by the suspension");
                    write_as("Point Plane", k, with_z(k.normal_j.u_local));
                },
                [&](const Distance& k) {
                    const Vector3d from = position(k.i), to = position(k.j);
                    if (std::abs((to - from).norm() - k.length) > 1e-12 * k.length)
                        return miss_joint("its length differs from the design position");
                    json& rod =
                        entry(root, "Distance Constraints", scene_joint.name, k.i.body, k.j.body);
                    rod["Point1"] = coordinates(from);
                    rod["Point2"] = coordinates(to);
                },
                [&](const Angle&) {
                    miss_joint(
                        "it is driven, which is defined by the vehicle, not by the suspension");
                },
                [&](const auto&) { miss_joint("Chrono's reader treats this kind as a lock"); }},
            scene_joint.kind);
    }

    void write(json& root, const Elastic& elastic) {
        if (elastic.active_only_where_driven)
            return result_.notes.leave_out("active only where a branch drives it",
                                           {0, "tyre '" + elastic.name + "'"});
        std::visit([&](const auto& kind) { write(root, elastic, kind); }, elastic.kind);
    }

    template <class OtherKind>
    void write(json&, const Elastic& elastic, const OtherKind&) {
        miss("element '" + elastic.name + "'", "Chrono has no element of this kind");
    }
    void write(json& root, const Elastic& elastic, const AxialSpring& spring) {
        const Curve* curve = curve_of(spring.law);
        if (elastic.written_as == WrittenAs::stop) return require_written(elastic, spring);
        if (curve && curve->knots.size() < 2)
            return miss("element '" + elastic.name + "'",
                        "its law is not a table and has no entry");
        json& tsda = entry(root, "TSDAs", elastic.name, spring.i.body, spring.j.body);
        tsda["Point1"] = coordinates(position(spring.i));
        tsda["Point2"] = coordinates(position(spring.j));
        tsda["Free Length"] = spring.free_length;
        add_stops(tsda, spring);
        if (!curve) {
            tsda["Spring Coefficient"] = std::get<LinearRate>(spring.law).k;
            return;
        }
        json rows = json::array();
        for (std::size_t k = 0; k < curve->knots.size(); ++k)
            rows.push_back({curve->knots[k], curve->pieces[k + 1][0]});
        tsda["Spring Curve Data"] = rows;
        result_.notes.warn({0, "element '" + elastic.name + "'"},
                           is_straight(*curve)
                               ? "Chrono keeps the force constant beyond the ends of a table, a "
                                 "scene extrapolates or ends there"
                               : "Chrono interpolates linearly and keeps the force constant beyond "
                                 "the ends, a scene interpolates smoothly");
    }

    // ---- Stops. Chrono creates them between the ends of a spring, with one fixed curve, if both
    // lengths are given.

    static bool is_between_same(const AxialSpring& a, const AxialSpring& b) {
        const auto same = [](const Point& p, const Point& q) {
            return p.body == q.body && p.s_local == q.s_local;
        };
        return same(a.i, b.i) && same(a.j, b.j);
    }

    // Whether a stop is a bump stop, and the length at which it touches [m]; none unless its curve is
    // Chrono's (its forces at the rows, constant beyond them).
    static std::optional<std::pair<bool, double>> chrono_stop(const AxialSpring& stop) {
        const auto& law = std::get<Curve>(stop.law);
        const Contact contact = contact_of(law);
        const double inward = contact.is_bump ? -1 : 1, largest = chrono::stop_table.back().second;
        const auto is_off = [&](double p, double f) {
            return std::abs(inward * force(law, contact.touches + inward * p) - f) > 1e-9 * largest;
        };
        for (const auto& [p, f] : chrono::stop_table)
            if (is_off(p, f)) return std::nullopt;
        if (!law.known_outside || is_off(1, largest)) return std::nullopt;
        return std::pair{contact.is_bump, stop.free_length + contact.touches};
    }

    // Adds the stops between the spring's points to its entry.
    void add_stops(json& entry, const AxialSpring& spring) {
        constexpr double never = 1e3;  // length that no suspension reaches [m]
        std::optional<double> shortest, longest;
        for (const Elastic& elastic : scene_.elastics) {
            const auto* stop = std::get_if<AxialSpring>(&elastic.kind);
            if (elastic.written_as != WrittenAs::stop || !is_between_same(*stop, spring)) continue;
            const auto touches = chrono_stop(*stop);
            auto& length = touches && touches->first ? shortest : longest;
            if (!touches || length) continue;
            length = touches->second;
            written_.insert(elastic.name);
            if (is_straight(std::get<Curve>(stop->law))) continue;
            const InterpolantDeviation deviation = deviation_from_lines(chrono::stop_table);
            result_.notes.warn({0, "element '" + elastic.name + "'"},
                               fmt::format("Chrono interpolates its stop linearly, a scene "
                                           "smoothly: the difference is up to {:.3g} of {:.3g} N",
                                           deviation.force, deviation.largest_force));
        }
        if (!shortest && !longest) return;
        entry["Minimum Length"] = shortest.value_or(0);
        entry["Maximum Length"] = longest.value_or(never);
    }

    // Notes a stop as missing unless it was written with a spring.
    void require_written(const Elastic& elastic, const AxialSpring& stop) {
        if (written_.contains(elastic.name)) return;
        miss("element '" + elastic.name + "'",
             chrono_stop(stop)
                 ? "Chrono's stops belong to a spring between the same points, one per direction"
                 : "stops in Chrono have one hard-coded curve, and this one differs");
    }

    // Writes a torsion spring, or a bushing that Chrono can represent: one frame, isotropic in displacement,
    // with one rotational rate about z and one across.
    void write(json& root, const Elastic& elastic, const Bushing& b) {
        const std::string element = "element '" + elastic.name + "'";
        const Matrix6* stiffness = matrix_of(b.law);
        const Matrix3d A = b.i.A_local.toRotationMatrix();
        if (elastic.written_as == WrittenAs::torsion_spring) {
            if (!stiffness || !b.preload.isZero(0) || !b.undeformed.isZero(0))
                return miss(element, "a torsion spring with a curve, a preload or a free angle");
            json& rsda = entry(root, "RSDAs", elastic.name, b.i.body, b.j.body);
            rsda["Position"] = coordinates(position(b.i.body, b.i.s_local));
            rsda["Axis"] = coordinates(A.col(2));
            rsda["Free Angle"] = 0;
            rsda["Spring Coefficient"] = (*stiffness)(5, 5);
            return;
        }
        if (!stiffness || !stiffness->isDiagonal(0) || !b.preload.isZero(0) ||
            !b.undeformed.isZero(0) ||
            (position(b.i.body, b.i.s_local) - position(b.j.body, b.j.s_local)).norm() > 1e-12)
            return miss(element,
                        "Chrono's bushing has one frame, rates along its axes and no preload");
        const Vector6 k = stiffness->diagonal();
        const bool is_isotropic = k[3] == k[4] && k[4] == k[5];
        if (k[0] != k[1] || k[1] != k[2] || k[3] != k[4] ||
            !(b.formulation == chrono_bushing || (is_isotropic && b.formulation == Formulation{})))
            return miss(element,
                        "Chrono's bushing has one rate for all translations and two for rotations, "
                        "about z and across it; this one differs");
        json& bushing = joint(entry(root, "Joints", elastic.name, b.j.body, b.i.body), "Revolute",
                              position(b.j.body, b.j.s_local), A);
        bushing["Bushing Data"] = {{"Stiffness Linear", k[0]},
                                   {"Damping Linear", 0},
                                   {"Stiffness Rotational", k[3]},
                                   {"Damping Rotational", 0},
                                   {"DOF",
                                    {{"Stiffness Linear", 0},
                                     {"Damping Linear", 0},
                                     {"Stiffness Rotational", k[5]},
                                     {"Damping Rotational", 0}}}};
    }

    const Scene& scene_;
    Exported& result_;
    std::vector<Name> names_;
    std::set<std::string> written_;  // stops, with their springs
    bool mirrored_ = false;          // the scene has the left side; Chrono adds its mirror image
    BodyId spindle_ = ground, other_spindle_ = ground;
};

}  // namespace

Exported export_chrono(const Scene& scene, bool allow_missing, Notes notes) {
    Exported result{.text = {}, .notes = std::move(notes)};
    ChronoWriter(scene, result).write_suspension();
    require_whole(result, scene, allow_missing);
    return result;
}

}  // namespace elastocheck::importer
