// Counts of proved equilibria among the points of a path, and their error bounds.
#pragma once

#include "elastocheck/compare.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {

using reference::certificate::Certificate;
using reference::certificate::ProofState;

// Adds the certificate of one point; `load` in SI, `unit` of the branch parameter for messages.
void add(Tally& tally, double load, Unit unit, const Certificate& certificate);

}  // namespace elastocheck::compare
