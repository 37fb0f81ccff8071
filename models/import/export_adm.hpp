// A scene as an ADAMS dataset, for the solver that one has.
#pragma once

#include <string>

#include "models/import/import.hpp"
#include "models/scene.hpp"

namespace elastocheck::importer {

struct Exported {
    std::string text;
    Notes notes;  // what the other program says otherwise, or not at all
};

// Throws SceneError with all that is missing, unless that is allowed.
void require_whole(const Exported& exported, const Scene& scene, bool allow_missing);

// SI throughout. The design position is the scene's; joints, springs, bushings, loads and held drives are statements of their
// names. What ADAMS has no element for is missing: an error, or with `allow_missing` a note and a comment in the dataset.
Exported export_adm(const Scene& scene, bool allow_missing);

}  // namespace elastocheck::importer
