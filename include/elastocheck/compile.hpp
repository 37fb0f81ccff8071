// Compiles a scene to a model: removes parts that no output depends on, and lowers the joints.
#pragma once

#include "elastocheck/model.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck {

enum class Detail {
    required,    // only the parts that the outputs require: the passes of models/compile/passes.hpp
    everything,  // all parts of the scene: reference for the reduced model
};

// Every removed or condensed part is listed with its reason in Model::omitted: bodies that no output reads,
// parts without effect or never active, elements and joints within one body, duplicates. Bodies fixed to each
// other are merged, links with two balls become distances. An output lost with a joint is listed there. In
// either detail a branch keeps its place and its remaining drivers; a branch that moves nothing is listed as
// well. The motion of a joint without length, offset or angle is removed. Pre: the scene is consistent
// (read_scene checks files). Never throws.
Model compile(const Scene& scene, Detail detail = Detail::required);

}  // namespace elastocheck
