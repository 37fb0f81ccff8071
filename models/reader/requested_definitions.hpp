// Definitions of K&C figures that a scene requests in its section `definitions`. The caller checks the
// names, by compare/outputs/catalogue/catalogue.hpp.
#pragma once

#include <string>
#include <vector>

#include "models/reader/document/cursor.hpp"

namespace elastocheck::reader {

struct RequestedDefinition {
    std::string figure;  // "roll_centre_height"; empty for a set
    std::string name;    // of the definition, "planes", or of the set, "sae"
    int line = 0;
    std::string path;  // "definitions.roll_centre_height"
};

// `definitions: sae`, `definitions: [sae, planes]`, or a map of figures to names or lists of names.
// Throws SceneError for anything else.
std::vector<RequestedDefinition> requested_definitions(const Cursor& scene);

}  // namespace elastocheck::reader
