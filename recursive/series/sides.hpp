// Branches with the same drivers, such as the two sides of one branch: they share their start.
#pragma once

#include <span>
#include <vector>

#include "recursive/series/path.hpp"

namespace elastocheck::recursive::series {

// Whether two branches have the same drivers with the same numbers: then they differ in
// their range only.
bool same_drivers(const Branch& a, const Branch& b);

// Whether two lists drive the same quantities to the same values at load factor 0.
bool same_values(std::span<const Driver> a, std::span<const Driver> b);

// The paths of several branches. Those in sequence with the same drivers share the settled start and
// the expansion there, whose coefficient x_k is r^k times as large where the range is r times as
// long. Models with curves and paths by arc length share nothing. The results are those of follow(),
// within rounding.
std::vector<Path> follow_sides(const Model& model, std::span<const Branch> sides,
                               const recursive::Series& options, const Analysis& analysis);

}  // namespace elastocheck::recursive::series
