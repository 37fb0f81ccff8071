// A branch that drives a length to zero: an error of a scene, a row with its reason of a study.
#pragma once

#include "elastocheck/read_scene.hpp"

namespace elastocheck::reader {

struct LengthVanishes : SceneError {
    using SceneError::SceneError;
};

}  // namespace elastocheck::reader
