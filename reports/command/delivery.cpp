#include "reports/command/delivery.hpp"

#include <fmt/format.h>

#include "reports/command/program/exit_code.hpp"
#include "reports/document/document.hpp"
#include "reports/render/render.hpp"

namespace elastocheck::reports {

void add_scene(CLI::App& command, SceneRequest& request) {
    add_scene(command, request.scene);
    add_set(command, request.settings);
    add_json(command, request.as_json);
}

void add_scene_and_run(CLI::App& command, SceneRequest& request) {
    add_scene(command, request);
    add_running(command, request.running);
}

void print_document(const nlohmann::ordered_json& document) { print(document.dump(1) + "\n"); }

void deliver_files(const Delivery& delivery, const std::vector<NamedContent>& files) {
    write_folder(delivery.folder, files);
    std::string written;
    for (const auto& file : files)
        written += fmt::format("{}{}/{}", written.empty() ? "" : ", ", delivery.folder, file.name);
    written = fmt::format("Written: {}\n", written);
    delivery.as_json ? print_error(written) : print(written);
}

int deliver_result(const Delivery& delivery, nlohmann::ordered_json scene,
                   const compare::Result& result, std::vector<NamedContent> files) {
    delivery.print_text(text(result));
    if (delivery.wants_document()) {
        scene["results"] = nlohmann::ordered_json::array({json_of(result)});
        for (const auto& id : table_ids(result))
            files.push_back({id + ".csv", csv(whole_table(result, id))});
        deliver(delivery, std::move(scene), std::move(files));
    }
    return exit_code_of(result.verdict.grade);
}

void deliver(const Delivery& delivery, nlohmann::ordered_json scene,
             std::vector<NamedContent> tables) {
    nlohmann::ordered_json result = document(delivery.command, provenance());
    result["scenes"].push_back(std::move(scene));
    if (!delivery.folder.empty()) {
        tables.insert(tables.begin(), {"result.json", result.dump(1) + "\n"});
        deliver_files(delivery, tables);
    }
    if (delivery.as_json) print_document(result);
}

}  // namespace elastocheck::reports
