// One axle of a vehicle of Chrono::Vehicle, with its steering and anti-roll bar from their files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "models/import/chrono/suspension.hpp"
#include "models/import/import.hpp"
#include "models/reader/document/cursor.hpp"

namespace elastocheck::importer::chrono {

// A parsed file; its cursors refer to it.
struct JsonFile {
    // Throws SceneError for invalid JSON and anything but an object.
    JsonFile(std::string_view text, const std::string& file);
    JsonFile(const JsonFile&) = delete;

    std::string name;
    reader::Value tree;
    mutable std::vector<Number> numbers;
    mutable reader::Accesses accesses;
    reader::Cursor root;
};

// Adds a suspension of any template to the draft of `s`.
struct Made {
    bool mirrors;               // the left side is written, the scene mirrors it
    std::string antiroll_body;  // "lower_arm*", of one that mirrors; empty: unknown
};
Made make(Suspension& s);

// Adds the branch of travel, and that of roll.
void add_travel(const Suspension& s, bool roll, Draft& draft);

// The axle in `options` of the vehicle. Files that it names are in the data folder, the closest
// folder above the vehicle's that has the file of the suspension. Throws SceneError "file:line: ...".
Draft import_vehicle(const JsonFile& vehicle, const Options& options);

}  // namespace elastocheck::importer::chrono
