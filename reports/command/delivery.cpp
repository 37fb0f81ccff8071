#include "reports/command/delivery.hpp"

#include <fmt/format.h>

#include "reports/document/curves.hpp"
#include "reports/document/document.hpp"

namespace elastocheck::reports {

void print_document(const nlohmann::ordered_json& document) { print(document.dump(1) + "\n"); }

void deliver(const Delivery& delivery, nlohmann::ordered_json scene,
             std::vector<NamedContent> tables) {
    nlohmann::ordered_json result = document(delivery.command, provenance());
    result["scenes"].push_back(std::move(scene));
    if (!delivery.folder.empty()) {
        if (result["scenes"][0].contains("branches"))
            tables.insert(tables.begin(), {"curves.csv", curves_csv(result, "result.json")});
        tables.insert(tables.begin(), {"result.json", result.dump(1) + "\n"});
        write_folder(delivery.folder, tables);
        std::string written;
        for (const auto& file : tables)
            written +=
                fmt::format("{}{}/{}", written.empty() ? "" : ", ", delivery.folder, file.name);
        if (delivery.as_json)
            print_error("Written: {}\n", written);
        else
            print("Written: {}\n", written);
    }
    if (delivery.as_json) print_document(result);
}

}  // namespace elastocheck::reports
