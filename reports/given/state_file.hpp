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

// Whether the content is states: a JSON object, or a table with the columns `body` and `qw`.
bool holds_states(std::string_view content);

// `passed_over` receives the names of bodies of the scene that are not modelled. Throws SheetError
// "file:line: ...".
std::vector<compare::CandidateState> read_states(std::string_view content, const std::string& file,
                                                 const Scene& scene, const Model& model,
                                                 const Names& names, std::string& passed_over);

// A state as a JSON line; `load` and positions in SI units.
std::string state_line(const Model& model, const std::string& branch, const Equilibrium& state);

}  // namespace elastocheck::reports
