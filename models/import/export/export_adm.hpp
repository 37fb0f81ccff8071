// Exports a scene as an ADAMS dataset.
#pragma once

#include <string>

#include "elastocheck/scene.hpp"
#include "models/import/curves.hpp"
#include "models/import/import.hpp"

namespace elastocheck::importer {

struct Exported {
    std::string text;
    Notes notes;  // differences from the scene, and parts left out
};

// Formulation of a BUSHING, FIELD or GFORCE of ADAMS, whose marker J is marker i: non-conjugate
// forces along the axes of i, projected angles.
inline constexpr Formulation adams_bushing{.frame = Formulation::Frame::on_i,
                                           .angles = Formulation::Angles::projected,
                                           .conjugate = false};

// Law of a stop: force over its penetration. A bump stop is closed below the elongation `touches`, a
// rebound stop above it.
struct Contact {
    bool is_bump = false;
    double touches = 0;  // elongation of the element at which the stop touches [m]
    Rows rows;           // penetration [m], force [N], from [0, 0] on; one row for a constant rate
};
Contact contact_of(const Curve& law);

// Notes branches and dampers, for which no exported format has an entry, as left out.
void leave_out_branches(const Scene& scene, const char* why, Notes& notes);

// Throws SceneError with all missing parts, unless `allow_missing`.
void require_whole(const Exported& exported, const Scene& scene, bool allow_missing);

// Exports in SI units and the design position of the scene; joints, springs, bushings, loads and
// held drives become statements with their names. A part that ADAMS has no element for is missing:
// an error, or with `allow_missing` a note and a comment in the dataset. `notes`: earlier notes on
// the scene, to which those of the export are added.
Exported export_adm(const Scene& scene, bool allow_missing, Notes notes = {});

}  // namespace elastocheck::importer
