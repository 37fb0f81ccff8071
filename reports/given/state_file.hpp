// States of a scene in a file: JSON lines {"branch", "load", "bodies": {NAME: {"position",
// "orientation"}}}, or a table with a row per body. Formats in reports/README.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "elastocheck/candidate.hpp"
#include "elastocheck/scene.hpp"
#include "reports/given/headings.hpp"

namespace elastocheck::reports {

// By a JSON object, or a column `body`.
bool holds_states(std::string_view content);

// `passed_over`: bodies of the scene that are not modelled. Throws SheetError "file:line: ...".
std::vector<compare::CandidateState> read_states(std::string_view content, const std::string& file,
                                                 const Scene& scene, const Model& model,
                                                 const Names& names, std::string& passed_over);

// The states of a path as JSON lines, one per state; `load` in SI.
std::string state_line(const Model& model, const std::string& branch, const Equilibrium& state);

}  // namespace elastocheck::reports
