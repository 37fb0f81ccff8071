#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>

#include "models/import/chrono/suspension.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/text_file.hpp"

namespace elastocheck::importer::chrono {

using reader::Cursor;
namespace fs = std::filesystem;

namespace {

// Files of a vehicle: Chrono names them relative to its data folder.
class DataFolder {
  public:
    explicit DataFolder(const std::string& vehicle) : from_(fs::path(vehicle).parent_path()) {}

    std::unique_ptr<JsonFile> read(const Cursor& named) {
        const fs::path file = find(named.text("a file"), named);
        const reader::TextFile content =
            reader::read_text(file, reader::Pipes::refused, largest_json + 1);
        if (!content.trouble.empty())
            named.fail(fmt::format("{}: {}", file.string(), content.trouble));
        return std::make_unique<JsonFile>(content.text, file.string());
    }

  private:
    // The first file decides which folder it is.
    fs::path find(const std::string& name, const Cursor& named) {
        std::error_code error;
        if (!folder_.empty()) {
            if (fs::path file = (folder_ / name).lexically_normal(); fs::exists(file, error))
                return file;
            named.fail(fmt::format("there is no file {} in the data folder {}", reader::quote(name),
                                   folder_.string()));
        }
        const fs::path absolute = fs::absolute(from_.empty() ? "." : from_, error);
        fs::path folder = from_.empty() ? "." : from_;
        for ([[maybe_unused]] const auto& part : absolute) {
            if (fs::exists(folder / name, error)) {
                folder_ = folder.lexically_normal();
                return (folder / name).lexically_normal();
            }
            folder /= "..";
        }
        named.fail(
            fmt::format("there is no file {} in the folder of the vehicle or in one above "
                        "it: Chrono looks for it in its data folder",
                        reader::quote(name)));
    }

    fs::path from_, folder_;
};

// Marks all that came into the draft without the name of a file as from this one.
void from_file(Draft& draft, const std::string& file) {
    const auto mark = [&](SourceLocation& from) {
        if (from.file.empty() && !from.what.empty()) from.file = file;
    };
    for (auto* list :
         {&draft.points.entries(), &draft.bodies, &draft.joints, &draft.bushings, &draft.springs,
          &draft.stops, &draft.torsion_springs, &draft.wheels, &draft.dampers})
        for (Entry& entry : *list) mark(entry.from);
    for (auto& [why, places] : draft.notes.omitted)
        for (auto& place : places) mark(place);
    for (auto* list : {&draft.notes.warnings, &draft.notes.missing})
        for (auto& [place, what] : *list) mark(place);
}

// Position of the axle that --axle chooses.
std::size_t axle_of(const Options& options, const Cursor& axles, const std::string& file) {
    const std::size_t count = axles.items().size();
    if (count == 0) axles.fail("expected a list with at least one axle");
    const std::string& wanted = options.axle;
    if (wanted == "front" || (wanted.empty() && count == 1)) return 0;
    if (wanted == "rear") return count - 1;
    for (std::size_t number = 1; number <= count; ++number)
        if (wanted == std::to_string(number)) return number - 1;
    const std::string allowed = fmt::format("front, rear, or a number from 1 to {}", count);
    if (wanted.empty())
        axles.fail(fmt::format("there are {}; choose one with --axle: {}", count, allowed));
    reader::fail(file, 0, "--axle",
                 fmt::format("{} is not an axle of the vehicle; allowed: {}", reader::quote(wanted),
                             allowed));
}

double positive(const Suspension& s, const std::string& path) {
    const double x = s.real(path);
    if (!(x > 0)) s.at(path).fail("not above zero");
    return x;
}
double largest_angle(const Suspension& s, const std::string& part) {
    return positive(s, part + "/Maximum Angle (deg)") * std::numbers::pi / 180;
}

// What moves the steering link, and how far to each side [m] or [rad].
struct Steering {
    std::string joint;
    double range;
};

// The rack moves along y of the steering's frame, by the angle of the pinion times its radius.
Steering rack_and_pinion(Suspension& s) {
    const std::string com = "Steering Link/COM";
    const FilePoint centre = s.placed({0, s.real(com), 0}, com);
    s.body("steering_link", centre, "Steering Link");
    s.joint("rack", "translational", "steering_link", "ground",
            Fields{}
                .add("at", s.hardpoint("rack", centre))
                .add("axis", direction(s.turn.col(1)))
                .add("held", "true"),
            s.place("Steering Link"));
    if (const auto length = s.optional("Steering Link/Length"))
        s.leave_out(*length, "only for visualisation");
    return {"rack", positive(s, "Pinion/Radius") * largest_angle(s, "Pinion")};
}

// The arm turns in the chassis and moves the link by a universal joint. The idler arm is massless:
// the link's point keeps its distance from the axis, in a plane across the axis.
Steering pitman_arm(Suspension& s) {
    const auto along = [&](const std::string& path) {
        const Vector3d u = s.turn * vector(s.at(path));
        if (!(u.norm() > 1e-9)) s.at(path).fail("not a direction: all components are zero");
        return Vector3d(u.normalized());
    };
    s.body("steering_link", s.point("Steering Link/COM"), "Steering Link");
    s.body("pitman_arm", s.point("Pitman Arm/COM"), "Pitman Arm");
    const FilePoint pivot = s.point("Revolute Joint/Location");
    s.joint("pitman_arm", "revolute", "pitman_arm", "ground",
            Fields{}
                .add("at", s.hardpoint("pitman_arm.pivot", pivot))
                .add("axis", direction(along("Revolute Joint/Direction")))
                .add("held", "true"),
            s.place("Revolute Joint"));
    s.universal("pitman_arm.end", "pitman_arm", "steering_link",
                s.point("Universal Joint/Location"), along("Universal Joint/Direction Arm"),
                along("Universal Joint/Direction Link"));
    const std::string idler = "Revolute-Spherical Joint";
    const FilePoint inner = s.point(idler + "/Location Chassis"),
                    outer = s.point(idler + "/Location Link");
    const Vector3d axis = along(idler + "/Direction");
    if (const Vector3d arm = outer - inner; !(std::abs(axis.dot(arm)) <= 1e-6 * arm.norm()))
        s.draft().notes.warn(s.place(idler),
                             "not perpendicular to its axis, as Chrono requires; the scene keeps "
                             "the link's point in the plane through its position in the file");
    s.distance("idler_arm", "ground", inner, "steering_link", outer);
    s.in_plane("idler_arm.plane", "steering_link", "ground", outer, axis);
    if (const auto ends = s.optional("Tierod Locations"))
        s.leave_out(*ends, "only for visualisation");
    return {"pitman_arm", largest_angle(s, "Revolute Joint")};
}

// Two arms about y, joined by a rotational spring, each with a rigid link to the suspension. In
// Chrono the right arm turns on the left one instead of on the chassis, about the same axis. The
// suspension is one that the scene mirrors.
void antiroll_bar(Suspension& s, const std::string& on) {
    const double L = positive(s, "Arm/Length"), W = s.real("Arm/Width"),
                 H = s.real("Droplink/Height");
    if (H == 0) s.at("Droplink/Height").fail("a link without length");
    const FilePoint bearing = s.placed({0, L / 2, 0}, "Arm/Length");
    s.body("antiroll_bar*", bearing, "Arm");
    s.revolute("antiroll_bar.bearing*", "ground", "antiroll_bar*", bearing, Vector3d::UnitY());
    s.distance("antiroll_bar.link*", "antiroll_bar*", s.placed({W, L, 0}, "Arm/Width"), on,
               s.placed({W, L, H}, "Droplink/Height"));
    s.torsion("antiroll_bar.twist", "antiroll_bar_left", "antiroll_bar_right",
              s.placed(Vector3d::Zero(), "RSD/Spring Coefficient"), Vector3d::UnitY(),
              s.real("RSD/Spring Coefficient"));
}

// The steering of an axle: its file is known before the suspension is attached to it.
struct AxleSteering {
    std::optional<Cursor> subsystem = {};
    std::unique_ptr<JsonFile> file = {};
    Steering (*steer)(Suspension&) = nullptr;
};

AxleSteering steering_of(const Cursor& root, const Cursor& axle, DataFolder& data, Draft& draft) {
    AxleSteering found;
    const auto index = axle.optional("Steering Index");
    if (!index) return found;
    const auto all = root.require("Steering Subsystems").items();
    const double k = index->number();
    if (!(k >= 0) || k != std::floor(k) || !(k < static_cast<double>(all.size())))
        index->fail(fmt::format("{} is not a steering subsystem; there are {}, counted from 0",
                                index->found(), all.size()));
    found.subsystem = all[static_cast<std::size_t>(k)];
    found.file = data.read(found.subsystem->require("Input File"));
    const Cursor named = found.file->root.require("Template");
    const std::string name = named.text("a template");
    found.steer = name == "RackPinion"  ? rack_and_pinion
                  : name == "PitmanArm" ? pitman_arm
                                        : nullptr;
    if (!found.steer)
        draft.notes.miss({named.value->line, named.path, found.file->name},
                         fmt::format("{} is not a supported steering; known: RackPinion, "
                                     "PitmanArm; without it the tie rods are on ground",
                                     named.found()));
    return found;
}

// The anti-roll bar of an axle; false if there is none that a scene can represent.
bool add_antiroll_bar(const Cursor& axle, const Vector3d& location, DataFolder& data,
                      const Made& made, Suspension& whole) {
    const auto named = axle.optional("Antirollbar Input File");
    if (!named) return false;
    Draft& draft = whole.draft();
    const auto file = data.read(*named);
    Suspension s(file->root, whole.options(), draft);
    s.origin = vector(axle.require("Antirollbar Location")) - location;
    const Cursor type = file->root.require("Template");
    bool is_known = false;
    if (type.text("a template") != "AntirollBarRSD") {
        draft.notes.miss({type.value->line, type.path, file->name},
                         fmt::format("{} is not a supported anti-roll bar; known: AntirollBarRSD",
                                     type.found()));
    } else if (made.antiroll_body.empty()) {
        draft.notes.miss({named->value->line, named->path, *named->file},
                         "an anti-roll bar on this template of a suspension");
    } else {
        antiroll_bar(s, made.antiroll_body);
        s.leave_out(s.at("Type"), "without effect on the mechanism");
        s.report_unread();
        is_known = true;
    }
    from_file(draft, file->name);
    return is_known;
}

}  // namespace

Draft import_vehicle(const JsonFile& vehicle, const Options& options) {
    const Cursor& root = vehicle.root;
    if (const auto named = root.require("Template"); named.text("a template") != "WheeledVehicle")
        named.fail(
            fmt::format("{} is not a supported template; known: WheeledVehicle", named.found()));
    Draft draft;
    draft.source = vehicle.name;
    Suspension whole(root, options, draft);  // for its notes
    const Cursor axles = root.require("Axles");
    const auto entries = axles.items();
    const std::size_t chosen = axle_of(options, axles, vehicle.name);
    const Cursor& axle = entries[chosen];
    const Vector3d location = vector(axle.require("Suspension Location"));
    DataFolder data(vehicle.name);
    const auto suspension_file = data.read(axle.require("Suspension Input File"));
    Suspension suspension(suspension_file->root, options, draft);

    const AxleSteering steered = steering_of(root, axle, data, draft);
    if (steered.steer) suspension.steering_link = "steering_link";
    if (suspension_file->root.require("Type").text("a type") != "Suspension")
        suspension_file->root.require("Type").fail("not a suspension");
    const Made made = make(suspension);
    from_file(draft, suspension_file->name);

    std::optional<Steering> steering;
    if (steered.steer && suspension.is_steered) {
        Suspension s(steered.file->root, options, draft);
        s.origin = vector(steered.subsystem->require("Location")) - location;
        s.turn = rotation(steered.subsystem->require("Orientation"));
        steering = steered.steer(s);
        s.leave_out(s.at("Type"), "without effect on the mechanism");
        s.report_unread();
        from_file(draft, steered.file->name);
    }

    const bool has_bar = add_antiroll_bar(axle, location, data, made, whole);

    if (steered.steer && !steering)
        whole.leave_out(*axle.optional("Steering Index"),
                        "since no part of the suspension is attached to the steering");
    draft.title = root.optional("Name") ? root.require("Name").text("a name") : draft.title;
    draft.title += fmt::format(", axle {}", chosen + 1);
    draft.format = fmt::format("{}, axle {} of {}", draft.format, chosen + 1, entries.size());
    draft.remarks = {
        fmt::format("m, N, kg, rad as in the files; x forward, y left, z up; the origin is the "
                    "Suspension Location, {} in the chassis. Chassis and subchassis are ground.",
                    triple(location)),
        "The files have no gravity and no tyre: the branches move the wheels on jacks."};
    const auto leave_out = [&](const Cursor& object, const char* unused) {
        const reader::Value& table = templates_section(unused);
        for (const std::string& key : table.keys)
            if (const auto field = object.optional(key))
                whole.leave_out(*field, entry(table, key)->text);
    };
    leave_out(axle, "unused_of_axle");
    for (std::size_t k = 0; k < entries.size(); ++k)
        if (k != chosen) whole.leave_out(entries[k], "another axle");
    leave_out(root, "unused_of_vehicle");
    if (const auto all = root.optional("Steering Subsystems"))
        for (const Cursor& other : all->items())
            if (!steered.subsystem || other.value != steered.subsystem->value || !steering)
                whole.leave_out(other, "not of this axle");
    whole.report_unread();

    add_travel(suspension, !made.mirrors || has_bar, draft);
    if (steering)
        draft.branches.push_back(
            {"steer",
             fmt::format(
                 "{{drive: joints.{0}, from: {1}, to: {2}, steps: 60, hold: {{{3}}}}}",
                 steering->joint, number(-steering->range), number(steering->range),
                 suspension.one_freedom ? "left.travel: 0" : "left.travel: 0, right.travel: 0"),
             {}});
    return draft;
}

}  // namespace elastocheck::importer::chrono
