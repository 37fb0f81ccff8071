// Comparison with further outputs, such as figures by other definitions.
#pragma once

#include <vector>

#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// compare() with these outputs after channels() and characteristics().
Comparison compare(const Model& model, const Options& options, const std::vector<Channel>& also);

}  // namespace elastocheck::compare
