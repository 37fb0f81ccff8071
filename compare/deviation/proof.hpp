// Counts of proved equilibria among the points of a path, and their error bounds.
#pragma once

#include "elastocheck/compare.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {

using reference::certificate::Certificate;
using reference::certificate::ProofState;

// Counts one point; `load` in SI.
void add(Tally& tally, double load, Unit unit, const Certificate& certificate);

}  // namespace elastocheck::compare
