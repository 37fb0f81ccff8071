// Exports a suspension for Chrono::Vehicle, in its template GenericWheeledSuspension.
#pragma once

#include "models/import/export/export_adm.hpp"

namespace elastocheck::importer {

// Formulation of Chrono's bushing, whose marker on body 2 is marker i: non-conjugate forces along
// the axes of i, the rotation vector.
inline constexpr Formulation chrono_bushing{.conjugate = false};

// Exports in SI units, x forward, y left, z up; the frame of the suspension is that of the scene. A
// scene with one left wheel is written as mirrored, which gives Chrono both sides; with two wheels
// only pairs of bodies that are mirror images of each other are. A part that the template cannot
// represent (loads, held drives, stops and bushings other than Chrono's) is missing: an error, or
// with `allow_missing` a note at the head. `notes`: earlier notes on the scene, to which those of the
// export are added.
Exported export_chrono(const Scene& scene, bool allow_missing, Notes notes = {});

}  // namespace elastocheck::importer
