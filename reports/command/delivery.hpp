// Output of a command: text on the terminal, a JSON document on standard output, files in a folder.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/result/result.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/folder.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {

struct Delivery {
    std::string folder = {};  // -o, or the file of `solve`; empty: none
    bool as_json = false;
    std::string command = {};  // command line as given, for the document

    bool wants_document() const { return as_json || !folder.empty(); }
    void print_text(std::string_view text) const {
        as_json ? print_beside_document(text) : print(text);
    }
};

// Options that the commands on scenes share.
struct Request {
    std::string folder;  // -o
    Settings settings;
    bool as_json = false;
    Running running;

    Delivery delivery(const std::string& line) const {
        return {.folder = folder, .as_json = as_json, .command = line};
    }
};
struct SceneRequest : Request {
    std::string scene;
};
void add_scene(CLI::App& command, SceneRequest& request);          // SCENE, --set, --json
void add_scene_and_run(CLI::App& command, SceneRequest& request);  // and --jobs, --quiet

// Writes one document, and nothing else, to standard output.
void print_document(const nlohmann::ordered_json& document);

// Writes the files to the folder in one step, and names them on the terminal.
void deliver_files(const Delivery& delivery, const std::vector<NamedContent>& files);

// Prints a result as text, with --json as the document; with a folder writes there result.json, a CSV file
// for each of its tables, and `files`, in one step. `scene` is document_of() of its scene. Returns the exit
// code of its verdict.
int deliver_result(const Delivery& delivery, nlohmann::ordered_json scene,
                   const compare::Result& result, std::vector<NamedContent> files = {});

// Writes the result document of one scene to the folder, with `tables`, to standard output, or both.
void deliver(const Delivery& delivery, nlohmann::ordered_json scene,
             std::vector<NamedContent> tables);

}  // namespace elastocheck::reports
