// Detects NaN and infinite values in a model.
// The reader rejects them; scenes built in code may have them.
#pragma once

#include <string>

#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

// Names the joints and elements whose values at the design position are NaN or overflow: "a number
// of the model is not finite in joint 'link'"; empty where all are finite. Rank, idle modes and
// conditioning are undefined for such a model.
std::string not_finite(const Model& model);

}  // namespace elastocheck::recursive
