#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "models/import/chrono/suspension.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/text_file.hpp"

namespace elastocheck::importer::chrono {

using reader::Cursor;
namespace fs = std::filesystem;

namespace {

// Reads the files of a vehicle, whose names are relative to Chrono's data folder.
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
    // The first file that is read determines the data folder.
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

// Gives all entries and notes of the draft without a file name this one.
void set_file(Draft& draft, const std::string& file) {
    const auto mark = [&](SourceLocation& from) {
        if (from.file.empty() && !from.what.empty()) from.file = file;
    };
    for (Entry& point : draft.points.entries()) mark(point.from);
    for (const auto& [name, entries] : draft.sections())
        for (Entry& entry : *entries) mark(entry.from);
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

// The steering of an axle, read before the suspension that may be attached to it.
struct AxleSteering {
    std::optional<Cursor> subsystem = {};  // its entry in the vehicle's file
    std::unique_ptr<JsonFile> file = {};
    bool is_known = false;  // its template is supported
};

AxleSteering steering_of(const Cursor& root, const Cursor& axle, DataFolder& data, Draft& draft) {
    AxleSteering steering;
    const auto index = axle.optional("Steering Index");
    if (!index) return steering;
    const auto subsystems = root.require("Steering Subsystems").items();
    const double k = index->number();
    if (!(k >= 0) || k != std::floor(k) || !(k < static_cast<double>(subsystems.size())))
        index->fail(fmt::format("{} is not a steering subsystem; there are {}, counted from 0",
                                index->found(), subsystems.size()));
    steering.subsystem = subsystems[static_cast<std::size_t>(k)];
    steering.file = data.read(steering.subsystem->require("Input File"));
    const Cursor named = steering.file->root.require("Template");
    const auto& known = templates_section("steerings");
    steering.is_known = entry(known, named.text("a template"));
    if (!steering.is_known)
        draft.notes.miss(
            {named.value->line, named.path, steering.file->name},
            fmt::format("{} is not a supported steering; known: {}; without it the tie rods are "
                        "on ground",
                        named.found(), fmt::join(known.keys, ", ")));
    return steering;
}

// The anti-roll bar of an axle, on a suspension that the scene mirrors; false if there is none that a
// scene can represent.
bool add_antiroll_bar(const Cursor& axle, const Vector3d& location, DataFolder& data,
                      const std::string& on, Suspension& whole) {
    const auto named = axle.optional("Antirollbar Input File");
    if (!named) return false;
    Draft& draft = whole.draft();
    const auto file = data.read(*named);
    Suspension s(file->root, whole.options(), draft);
    s.antiroll_body = on;
    s.origin = vector(axle.require("Antirollbar Location")) - location;
    const Cursor type = file->root.require("Template");
    const auto& known = templates_section("antiroll_bars");
    bool is_known = entry(known, type.text("a template"));
    if (!is_known)
        draft.notes.miss({type.value->line, type.path, file->name},
                         fmt::format("{} is not a supported anti-roll bar; known: {}", type.found(),
                                     fmt::join(known.keys, ", ")));
    else if (on.empty())
        draft.notes.miss({named->value->line, named->path, *named->file},
                         "an anti-roll bar on this template of a suspension");
    is_known = is_known && !on.empty() && run_template(s, "antiroll_bars");
    set_file(draft, file->name);
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
    Suspension whole(root, options, draft);  // to note what is left out of the vehicle's file
    const Cursor axles = root.require("Axles");
    const auto entries = axles.items();
    const std::size_t chosen = axle_of(options, axles, vehicle.name);
    const Cursor& axle = entries[chosen];
    const Vector3d location = vector(axle.require("Suspension Location"));
    DataFolder data(vehicle.name);
    const auto suspension_file = data.read(axle.require("Suspension Input File"));
    Suspension suspension(suspension_file->root, options, draft);

    const AxleSteering steered = steering_of(root, axle, data, draft);
    if (steered.is_known) suspension.steering_link = "steering_link";
    if (suspension_file->root.require("Type").text("a type") != "Suspension")
        suspension_file->root.require("Type").fail("not a suspension");
    const bool mirrors = make(suspension);
    set_file(draft, suspension_file->name);
    const bool steers = steered.is_known && suspension.is_steered;
    if (steers) {
        Suspension s(steered.file->root, options, draft);
        s.origin = vector(steered.subsystem->require("Location")) - location;
        s.turn = rotation(steered.subsystem->require("Orientation"));
        run_template(s, "steerings");
        set_file(draft, steered.file->name);
        suspension.steering_joint = s.steering_joint;
        suspension.steering_range = s.steering_range;
    }
    const bool has_bar = add_antiroll_bar(axle, location, data, suspension.antiroll_body, whole);
    if (steered.is_known && !steers)
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
    if (const auto subsystems = root.optional("Steering Subsystems"))
        for (const Cursor& other : subsystems->items())
            if (!steered.subsystem || other.value != steered.subsystem->value || !steers)
                whole.leave_out(other, "not of this axle");
    whole.report_unread();

    add_travel(suspension, !mirrors || has_bar, draft);
    if (steers)
        draft.branches.push_back(
            {"steer",
             fmt::format(
                 "{{drive: joints.{}, from: {}, to: {}, steps: 60, hold: {{{}}}}}",
                 suspension.steering_joint, number(-suspension.steering_range),
                 number(suspension.steering_range),
                 suspension.one_freedom ? "left.travel: 0" : "left.travel: 0, right.travel: 0"),
             {}});
    return draft;
}

}  // namespace elastocheck::importer::chrono
