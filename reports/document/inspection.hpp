// `elastocheck inspect`: the scene as read and compiled, before anything is solved.
#pragma once

#include <optional>

#include "compare/result/result.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::reports {

// Input of inspection(), which refers to it during the call only.
struct InspectionInput {
    const Scene& scene;  // after the trim
    const Model& model;  // the compiled scene
    const std::optional<compare::TrimRecord>& trim;
};

// Tables of size, parts, trim, branches (with the displacements where they settle), outputs, redundant
// constraints, idle modes and omitted parts; as details the matrix of a step and the numbers of the file.
compare::Result inspection(const InspectionInput& input);
// The first 40 rows of every table but the outputs: a generated scene has thousands of parts.
compare::Result shortened(compare::Result result);
// Shows the tables that are marked as details, too.
compare::Result verbose(compare::Result result);

}  // namespace elastocheck::reports
