// Mechanisms nobody designed, for whoever wants to know what a solver makes of them.
//
// One to forty bodies on joints, bushings, springs, stops, curves, beams, torsion springs and tyres, some preloaded, some
// standing under loads, driven by loads, jacks, angles, lengths and preloads. Most fit as drawn; some contradict
// themselves, repeat what holds already, have parts that nothing resists or that do nothing, lie in one plane, or have
// rates ten decades apart, on purpose.
#pragma once

#include <cstdint>
#include <string>

namespace elastocheck::compare {

// The text of a scene file (models/scenes/README.md), which the reader takes. It is the same for one seed wherever it is
// made: the numbers are drawn from integers, by operations that IEEE 754 rounds one way, and written with few digits
// where a library has a part in them. One entry a line, so that lines can be taken out by hand.
std::string random_scene(std::uint64_t seed);

}  // namespace elastocheck::compare
