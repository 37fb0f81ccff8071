// Spread of the outputs over bushing formulations as terminal text.
#pragma once

#include <string>

#include "compare/studies/formulations.hpp"

namespace elastocheck::reports {

// `comparison` is of the same scene.
std::string formulation_text(const compare::FormulationStudy& study,
                             const compare::Comparison& comparison);

}  // namespace elastocheck::reports
