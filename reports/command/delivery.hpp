// Output of a command: text on the terminal, one JSON document on standard output, or files in a
// folder.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/files/folder.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {

struct Delivery {
    std::string folder = {};  // -o, or the file of `solve`; empty: none
    bool as_json = false;
    std::string command = {};  // command line as given, for the document

    bool wants_document() const { return as_json || !folder.empty(); }
    void print_text(std::string_view text) const {
        if (!as_json) print(text);
    }
};

// Writes one document, and nothing else, to standard output.
void print_document(const nlohmann::ordered_json& document);

// Writes the result document of one scene: to the folder, with curves.csv and `tables` beside it,
// in one step; to standard output; or both.
void deliver(const Delivery& delivery, nlohmann::ordered_json scene,
             std::vector<NamedContent> tables);

}  // namespace elastocheck::reports
