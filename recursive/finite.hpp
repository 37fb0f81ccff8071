// Whether a model is numbers at all. The reader lets no other pass; whoever builds a scene in code may make one.
#pragma once

#include <string>

#include "models/model.hpp"

namespace elastocheck::recursive {

// What gives a number that is none, or one beyond all, as it is drawn: "as drawn a number is not finite in joint 'link'";
// empty where nothing does. Of rank, idle modes and conditioning nothing can be told then.
std::string not_finite(const Model& model);

}  // namespace elastocheck::recursive
