// Interval proofs of the points of a live page, a few at a time (reference/certificate).
#pragma once

#include "reports/live/engine.hpp"

namespace elastocheck::live {

// Proves `count` stations of the branch `request.only`, from the `first` on in ascending order of the
// parameter; its points and settings are those of a solve(). Throws as prepared(). The answer:
//   claim     distance from the computed state that is to be proved: mm, deg
//   stations  a [unit of the branch], answer ("proved", "excluded", "open"), detail, error_mm: bound
//             of the distance to the true equilibrium, unique_mm: no other equilibrium has its points
//             this near, stable; distances null where there is none
//   limits    where the branch ends in a limit point, with the last stations: answer, detail, from,
//             to: bounds of its parameter
nlohmann::ordered_json prove(Session& session, const Request& request, int first, int count);

}  // namespace elastocheck::live
