// Error of a branch that drives a length to zero. A study records it as the outcome of a variant.
#pragma once

#include "elastocheck/read_scene.hpp"

namespace elastocheck::reader {

struct LengthVanishes : SceneError {
    using SceneError::SceneError;
};

}  // namespace elastocheck::reader
