#include "reports/command/import_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "compare/trim.hpp"
#include "models/import/export_adm.hpp"
#include "models/import/export_chrono.hpp"
#include "models/import/import.hpp"
#include "models/reader/scene_file.hpp"
#include "reports/command/arguments.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/exit_code.hpp"
#include "reports/files/files.hpp"
#include "reports/text/terminal.hpp"

namespace elastocheck::reports {
namespace {

constexpr FileKind scene_file{"scene made by import", "# Imported from "};
constexpr FileKind dataset_file{"dataset made by export", "Exported model name:"};
constexpr FileKind suspension_file{"suspension made by export", "// Exported by elastocheck"};

importer::Options options(const ImportRequest& request) {
    return {.wheel = request.wheel,
            .drop_dynamics = !request.drop.empty(),
            .allow_missing = request.allow_missing};
}

std::string first_line(std::string text) { return text.substr(0, text.find('\n')); }

// What becomes of each file, a row each; an import that is refused is a row as well.
int print_table(const ImportRequest& request) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    if (!request.as_json) print("| file | bodies | joints | elements | outcome |\n|---|---|---|---|---|\n");
    for (const std::string& file : request.files) {
        const std::string name = std::filesystem::path(file).filename().string();
        nlohmann::ordered_json row{{"file", name}};
        std::string outcome;
        try {
            const importer::Imported result = importer::import_file(file, options(request));
            outcome = result.notes.missing.empty()
                          ? "imported"
                          : fmt::format("imported, {} missing", result.notes.missing.size());
            if (!result.notes.warnings.empty())
                outcome += fmt::format(", {} warning{}", result.notes.warnings.size(),
                                       result.notes.warnings.size() == 1 ? "" : "s");
            row.update({{"bodies", result.bodies}, {"joints", result.joints}, {"elements", result.elements}});
        } catch (const SceneError& error) {
            outcome = first_line(error.what());
            if (outcome.starts_with(file)) outcome = "refused: " + name + outcome.substr(file.size());
        }
        row["outcome"] = outcome;
        const auto count = [&](const char* key) {
            return row.contains(key) ? std::to_string(row[key].get<int>()) : "-";
        };
        if (!request.as_json)
            print("| {} | {} | {} | {} | {} |\n", name, count("bodies"), count("joints"), count("elements"),
                  outcome);
        rows.push_back(row);
    }
    if (request.as_json) print_document({{"schema", import_schema}, {"files", rows}});
    return fine;
}

}  // namespace

CLI::App* add_import_command(CLI::App& app, ImportRequest& request) {
    auto* command = app.add_subcommand(
        "import",
        "Make a scene of another program's model: ADAMS .adm, Chrono::Vehicle .json, hardpoints .sub");
    command->add_option("FILE", request.files, "the model (.adm, .json, .sub)")
        ->required()
        ->check(a_file("*"));
    command->add_option("-o,--output", request.output, "write the scene to this file instead")
        ->check(a_file("*.yaml"));
    command->add_option("--wheel", request.wheel,
                        "the part that carries the wheel, or a marker at its centre: name or id (.adm)");
    command
        ->add_option("--drop", request.drop,
                     "dynamics: leave out whole what acts against motion alone, friction too")
        ->check(one_of({"dynamics"}));
    command->add_flag("--allow-missing", request.allow_missing,
                      "warn of what a scene cannot represent, instead of refusing the file");
    command->add_flag("--table", request.table, "of any number of files: only what becomes of each");
    add_json(*command, request.as_json);
    return command;
}

int import(const ImportRequest& request) {
    if (request.table) return print_table(request);
    if (request.files.size() > 1)
        throw std::invalid_argument("import: one FILE at a time makes a scene; several with --table");
    const importer::Imported result = importer::import_file(request.files.front(), options(request));
    if (!request.output.empty()) write_whole(request.output, result.yaml, scene_file);
    const auto lines = importer::told(result.notes);
    if (request.as_json) {
        print_document({{"schema", import_schema},
                        {"files",
                         {{{"file", request.files.front()},
                           {"bodies", result.bodies},
                           {"joints", result.joints},
                           {"elements", result.elements},
                           {"notes", lines},
                           {"missing", result.notes.missing.size()},
                           {"text", result.yaml}}}}});
        return fine;
    }
    if (request.output.empty()) {
        print("{}", result.yaml);
        for (const auto& line : lines)
            if (line.starts_with("Warning") || line.starts_with("MISSING"))
                complain("elastocheck: {}\n", line);
        return fine;
    }
    for (const auto& line : lines) print("{}\n", line);
    print("{}: {} bodies, {} joints, {} elements\n", request.output, result.bodies, result.joints,
          result.elements);
    return fine;
}

CLI::App* add_export_command(CLI::App& app, ExportRequest& request) {
    auto* command =
        app.add_subcommand("export", "Write a scene as another program's model, trimmed: ADAMS, Chrono");
    command->add_option("SCENE", request.scene, "scene file (YAML)")->required()->check(a_file("*.yaml"));
    command
        ->add_option("--format", request.format,
                     "adm (default): an ADAMS dataset; chrono: a suspension of Chrono::Vehicle (JSON)")
        ->check(one_of({"adm", "chrono"}));
    command->add_option("-o,--output", request.output, "write it to this file instead")
        ->check(a_file("*.adm *.json"));
    command->add_flag("--allow-missing", request.allow_missing,
                      "warn of what the other program has no element for, instead of refusing the scene");
    add_settings(*command, request.settings);
    return command;
}

int export_scene(const ExportRequest& request) {
    const Scene scene = compare::trim(read_scene(request.scene, request.settings)).scene;
    const bool chrono = request.format == "chrono";
    const importer::Exported result = chrono ? importer::export_chrono(scene, request.allow_missing)
                                             : importer::export_adm(scene, request.allow_missing);
    if (request.output.empty())
        print("{}", result.text);
    else
        write_whole(request.output, result.text, chrono ? suspension_file : dataset_file);
    for (const auto& line : importer::told(result.notes))
        if (line.starts_with("Warning") || line.starts_with("MISSING")) complain("elastocheck: {}\n", line);
    return fine;
}

}  // namespace elastocheck::reports
