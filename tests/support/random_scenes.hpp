// Random mechanisms for robustness tests of solvers.
//
// One to forty bodies on joints, bushings, springs, stops, curves, beams, torsion springs
// and tyres, some preloaded, some under static loads, driven by loads, jacks, angles,
// lengths and preloads. Most are consistent in the design position. On purpose, some have
// inconsistent or redundant joints, unresisted or irrelevant parts, planar geometry, or
// rates that differ by ten decades.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

// Text of a random scene file (models/scenes/README.md) that the reader accepts. It depends on the
// seed alone, on every platform: numbers are drawn from integers by operations that IEEE 754 rounds
// uniquely, and written with few digits where a library function is involved. One entry per line,
// so that lines can be removed by hand.
//
// Family `driven`: one to four bodies, nearly all on bushings, with links of fixed length, points
// on planes, springs with curves and stops. Each branch moves the length of a link, a jack, a wheel
// or the offset of another joint, so that the reactions depend on the elastic elements.
enum class Family { any, driven };
std::string random_scene(std::uint64_t seed, Family family = Family::any);

// The random scene of family `any`, read; none where it has more than three bodies or a beam, which
// take longer to solve, or where the reader refuses it because its driver moves no output.
std::optional<Scene> small_random_scene(std::uint64_t seed);

}  // namespace elastocheck::compare
