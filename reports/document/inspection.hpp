// `elastocheck inspect`: the scene as read and compiled, before anything is solved.
#pragma once

#include <optional>

#include "compare/result/result.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::reports {

struct Inspected {
    const Scene& scene;  // trimmed
    const Model& model;  // as solved
    const std::optional<compare::TrimRecord>& trim;
};

// A table for each kind of part, of the trim, the outputs, what is redundant, idle, left out, and of
// where the branches settle; of the numbers of the file and the matrix of a step as details.
compare::Result inspection(const Inspected& inspected);
// The beginning of every list, for a terminal: a generated scene has thousands of parts.
compare::Result shortened(compare::Result result);
// With the details.
compare::Result verbose(compare::Result result);

}  // namespace elastocheck::reports
