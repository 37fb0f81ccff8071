// Loads a scene for a command: reads, trims, compiles.
#pragma once

#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/scene.hpp"
#include "elastocheck/trim.hpp"
#include "models/reader/plausibility.hpp"
#include "reports/document/scene_analyses.hpp"

namespace elastocheck::reports {

// --set PATH=VALUE, repeatable: changes numbers of the scene file before it is read.
using Settings = std::vector<Setting>;

// A requested trim was not reached or not confirmed by the second reference; the scene is not
// judged. what() reads "FILE:LINE: trim: ...".
struct NotTrimmed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct LoadedScene {
    Scene scene;  // trimmed
    Model model;
    std::optional<compare::TrimRecord> trim;
    // of the reader and of the settled state: "FILE:LINE: field: ..."
    std::vector<std::string> warnings = {};
    // outputs by the definitions that the scene asks for, "camber@kingpin", after its own outputs
    std::vector<compare::Channel> definitions = {};
};

// Trims and compiles a scene read from `file`. Throws SceneError for an ill-posed trim, NotTrimmed.
LoadedScene trimmed_and_compiled(reader::SceneAndWarnings read, const std::string& file,
                                 Detail detail = Detail::required);
// Reads the file too, and prints the warnings to standard error. Throws SceneError and NotTrimmed. With
// `not_trimmed`, the exception of a failed trim is stored there, and the scene is loaded without a trim.
LoadedScene load_scene(const std::string& file, const Settings& settings,
                       Detail detail = Detail::required, std::exception_ptr* not_trimmed = nullptr);

// The results on a scene before anything is solved (compiled model, trim, warnings, hash of `file`, the
// scene's), and the same as in result.json.
SceneAnalyses analyses_of(const LoadedScene& loaded, const std::string& file);
nlohmann::ordered_json document_of(const LoadedScene& loaded, const std::string& file);

// The outputs of --channels, names or patterns with *, in that order, each once; without patterns
// channels() and the definitions that the scene asks for. Forces of bushings, springs and links,
// characteristics and other definitions, whose cost is comparable to a step of a leg, are among them
// only if requested by name. Throws std::invalid_argument for a pattern without a match, with the
// nearest name.
std::vector<compare::Channel> requested_channels(const LoadedScene& loaded,
                                                 const std::vector<std::string>& patterns);

// The branch that an option names. Throws std::invalid_argument for an unknown name, with the nearest.
const Branch& branch_named(const Model& model, const std::string& name,
                           const char* option = "--branch");

}  // namespace elastocheck::reports
