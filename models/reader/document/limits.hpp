// Size limits of a scene. Exceeding one is reported with the field, before any work is done.
#pragma once

#include <cstddef>

namespace elastocheck::reader {

inline constexpr std::size_t largest_text = 1 << 20;  // [bytes] of a scene, or of a table file
// a scene needs five: bushings, one bushing, stiffness, its rows
inline constexpr std::size_t deepest_nesting = 16;
inline constexpr std::size_t longest_name = 64;    // [bytes]
inline constexpr std::size_t max_bodies = 10'000;  // with twins and the nodes of beams
inline constexpr int max_segments = 1'000;         // of one beam
inline constexpr std::size_t max_rows = 10'000;    // of one table
inline constexpr int max_steps = 1'000'000;        // of one branch
inline constexpr double max_poses = 1e7;           // of one branch: steps times bodies

}  // namespace elastocheck::reader
