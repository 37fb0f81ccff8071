// Only what the outputs of a scene require: the passes of compile(), in their order. Each takes one kind of thing out of
// the scene, or condenses it, and names it in Scene::left_out with its reason. No output changes by more than round-off;
// the ones that go with their joints are named with them.
#pragma once

#include "models/scene.hpp"

namespace elastocheck::reduce {

// Loads of size zero; drivers that move nothing and hold nothing.
void drop_what_does_nothing(Scene& scene);

// Joints and elements that stand only where they are driven, when nothing drives them; elements without law and preload,
// unless their preload is driven.
void drop_what_never_stands(Scene& scene);

// Bodies held together by Fixed joints as drawn become one, which has the name of the first, or ground. A body with
// a wheel or a probe is never made part of ground.
void weld(Scene& scene);

// Joints and elements with both ends on one body, or on ground: nothing deforms or moves them. What is strained there, or
// driven, stays, to be judged by who solves it.
void drop_what_is_within_one_body(Scene& scene);

// Bodies that no chain of joints and elements, not through ground, connects to an output.
void drop_what_no_output_sees(Scene& scene);

// Bodies that hang on one other body only and have no load, no preload, no driver and no output: they follow freely.
void drop_free_followers(Scene& scene);

// Joints that hold nothing but what another between the same bodies holds as well, in the same equations.
void drop_duplicates(Scene& scene);

// Bodies with two spherical joints to two others, and nothing else: each is a distance, called like the body. Their
// spin about their own axis, which nothing resists, goes with them.
void shorten_links(Scene& scene);

}  // namespace elastocheck::reduce
