// A suspension as Chrono::Vehicle has it: the template of any joints, GenericWheeledSuspension.
#pragma once

#include "models/import/export_adm.hpp"

namespace elastocheck::importer {

// SI, x forward, y left, z up; the frame of the suspension is that of the scene. Of one left wheel everything is mirrored, as
// Chrono wants it; of two the bodies that are each other's image are. What the template has no place for (loads, stops,
// held drives, bushings that are not Chrono's) is missing: an error, or with `allow_missing` a note at the head.
Exported export_chrono(const Scene& scene, bool allow_missing);

}  // namespace elastocheck::importer
