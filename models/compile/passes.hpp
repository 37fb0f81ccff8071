// Model reduction: the passes of compile(), in their order.
// They keep only what the outputs of a scene require. Each removes or condenses one kind of part
// and lists it in Scene::omitted with its reason. No output changes by more than round-off, except
// that the reactions of removed joints are lost.
#pragma once

#include "elastocheck/scene.hpp"

namespace elastocheck::reduce {

// Removes zero loads, and drivers without effect.
void drop_zero_loads(Scene& scene);

// Removes joints and elements that are active only where driven but never driven, and elements
// without law and preload, unless their preload is driven.
void drop_never_active(Scene& scene);

// Merges bodies connected by Fixed joints at the design position into one, with the name of the
// first, or into ground. A body with a wheel or a probe is never merged into ground.
void weld(Scene& scene);

// Removes joints and elements with both ends on one body, or on ground: nothing deforms or moves
// them. Strained or driven ones stay, for the legs to judge.
void drop_within_one_body(Scene& scene);

// Removes bodies that no chain of joints and elements, not through ground, connects to an output.
void drop_unconnected_to_outputs(Scene& scene);

// Removes bodies connected to one other body only, without load, preload, driver or output.
void drop_free_followers(Scene& scene);

// Removes joints whose equations are contained in those of another joint between the same bodies.
void drop_duplicates(Scene& scene);

// Replaces bodies with two spherical joints to two other bodies, and nothing else, by a distance joint
// with the body's name. Their spin about their own axis, which nothing resists, is removed too.
void replace_links(Scene& scene);

}  // namespace elastocheck::reduce
