// Size limits of external input.
#pragma once

#include <cstddef>

namespace elastocheck::reports {

// [bytes] of any file
inline constexpr std::size_t largest_file = std::size_t{512} << 20;
inline constexpr std::size_t largest_baseline = std::size_t{64} << 20;     // [bytes]
inline constexpr std::size_t largest_measurement = std::size_t{64} << 20;  // [bytes]
inline constexpr std::size_t max_measured_points = 100'000;  // points in a measurement

inline constexpr int deepest_json = 64;
inline constexpr double largest_json = 2e9;  // [bytes] in memory, estimated before parsing

}  // namespace elastocheck::reports
