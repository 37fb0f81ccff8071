// Scene -> model: leave out and condense what no output depends on, lower the joints.
#pragma once

#include "models/model.hpp"
#include "models/scene.hpp"

namespace elastocheck {

enum class Detail {
    required,    // only what the outputs require: the passes of models/reduce/passes.hpp
    everything,  // all that is written, needed or not: what the former is to agree with
};

// What is left out or condensed is named with its reason in Model::left_out: bodies nothing reads, what does nothing or
// never stands, elements and joints within one body, duplicates; bodies fixed to each other are one, links with two
// balls distances. An output that goes with a joint is named there.
// In either detail a branch keeps its place with the drivers that are left; one that moves nothing any more is named as
// well, and the motion of a joint that has no length, offset or angle is not there.
// Pre: the scene is consistent (read_scene checks files). Never throws.
Model compile(const Scene& scene, Detail detail = Detail::required);

}  // namespace elastocheck
