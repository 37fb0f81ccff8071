// How much the outputs depend on the formulation of the bushings, for a terminal.
#pragma once

#include <string>

#include "compare/formulations.hpp"

namespace elastocheck::reports {

// Of the same scene's comparison.
std::string formulation_text(const compare::FormulationStudy& study, const compare::Comparison& comparison);

}  // namespace elastocheck::reports
