// Scene -> model: lower the joints, leave out what no output depends on.
#pragma once

#include "models/model.hpp"
#include "models/scene.hpp"

namespace elastocheck {

// Left out, each with its reason in Model::left_out:
//  - a body (with everything attached to it) that no chain of joints and elements connects to an output;
//  - a body that hangs on one other body only and carries no load, no preload, no driver and no output: it
//    follows freely;
//  - an element whose rates and preload are all zero, unless a branch drives its preload; a load on a body that
//    was left out, or of size zero;
//  - a joint that stands only where it is driven, when no branch drives it; a driver that moves nothing.
// A branch keeps its place with the drivers that are left; one that moves nothing any more is named as well.
// Pre: the scene is consistent (read_scene checks files). Never throws.
Model compile(const Scene& scene);

}  // namespace elastocheck
