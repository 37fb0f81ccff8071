// Models of other programs as scenes: a file in, the text of a scene out, which the ordinary reader then reads.
// What each format means, and what of it a scene can say: README.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "models/import/draft.hpp"

namespace elastocheck::importer {

struct Options {
    std::string wheel;  // the body that is the wheel carrier, or a marker on it; empty: what the format says
    bool drop_dynamics =
        false;  // what acts against motion alone is left out whole: dampers, friction, masses without gravity
    bool allow_missing = false;  // what cannot be represented is a warning instead of an error
};

struct Imported {
    std::string yaml;
    Notes notes;
    int bodies = 0, elements = 0, joints = 0;
};

// By its name: .adm, .json, .sub. Throws SceneError "file:line: ...": what is wrong with it, or has no place in a scene.
Imported import_file(const std::filesystem::path& file, const Options& options);

// The same from text. `file` stands for it in messages and in the head of the scene, and says the format.
Imported import_text(std::string_view text, const std::string& file, const Options& options);

// ---- One for each format.
Draft import_adm(std::string_view text, const std::string& file, const Options& options);
Draft import_chrono(std::string_view text, const std::string& file, const Options& options);
Draft import_subsystem(std::string_view text, const std::string& file, const Options& options);

}  // namespace elastocheck::importer
