// Scene -> model: lower the joints, leave out what no output depends on.
#pragma once

#include "models/model.hpp"
#include "models/scene.hpp"

namespace elastocheck {

// Left out, each with its reason in Model::left_out:
//  - a body (with everything attached to it) that no chain of joints and elements connects to an output;
//  - a body that hangs on one other body only and carries no load, no preload and no output:
//    it follows freely;
//  - an element whose rates and preload are all zero; a load on a body that was left out, or of size zero.
// Pre: the scene is consistent (read_scene checks files). Never throws.
Model compile(const Scene& scene);

}  // namespace elastocheck
