// Counts of proved equilibria among the points of a path (reference/certificate), and their error
// bounds.
#pragma once

#include <string>

#include "compare/outputs/channels.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {

using reference::certificate::Answer;
using reference::certificate::Certificate;

// Counts over some points of a path, and the largest proved error bounds.
struct Tally {
    int points = 0, proved = 0, excluded = 0, open = 0;
    int stable = 0;  // of the proved points
    // Of the proved points: largest distance to the true equilibrium, and smallest radius within
    // which it is unique. [m, rad, N, N·m]
    reference::certificate::Extent error{0, 0, 0, 0}, unique;
    double held = 0, gap = 0;  // as in Certificate
    // additional statement of the certificate at the last point; empty: none
    std::string theorem = {};
    std::string not_proved = {};  // of the first point without a proof: place and reason

    void add(double load, Unit unit, const Certificate& certificate);
};

}  // namespace elastocheck::compare
