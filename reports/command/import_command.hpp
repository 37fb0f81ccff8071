// `elastocheck import`: a model of another program as a scene. `elastocheck export`: a scene as theirs.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "models/reader/scene_file.hpp"

namespace elastocheck::reports {

struct ImportRequest {
    std::vector<std::string> files;
    std::string output;  // empty: standard output
    std::string wheel;
    std::vector<std::string> drop;
    bool allow_missing = false;
    bool table = false;  // of what becomes of each file, instead of a scene
    bool as_json = false;
};
inline constexpr const char* import_schema = "elastocheck/import/1";

CLI::App* add_import_command(CLI::App& app, ImportRequest& request);
int import(const ImportRequest& request);

struct ExportRequest {
    std::string scene, format = "adm";
    std::string output;  // empty: standard output
    bool allow_missing = false;
    std::vector<Setting> settings;
};

CLI::App* add_export_command(CLI::App& app, ExportRequest& request);
int export_scene(const ExportRequest& request);

}  // namespace elastocheck::reports
