// Comparison of the legs as terminal text.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "compare/comparison/compare.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reports {

// Largest deviation with sign, its place, root mean square and share of the range: 36 characters
// wide.
std::string deviation_cells(const compare::Deviation& deviation);

std::string tables(const Model& model, const compare::Comparison& comparison);

// "no value of a.force_y, b.force_y: ...", of the reactions that are `undefined`; empty if none is.
std::string not_determined(std::span<const compare::Channel> channels,
                           const std::function<bool(std::size_t)>& is_undefined);

}  // namespace elastocheck::reports
