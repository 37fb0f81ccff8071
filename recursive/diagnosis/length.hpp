// The characteristic length of a model, without its diagnosis.
#pragma once

#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

// L: root mean square lever of all attachments, invariant under motions of the ground frame [m].
double characteristic_length(const Model& model);

}  // namespace elastocheck::recursive
