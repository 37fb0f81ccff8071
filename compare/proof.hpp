// How many points of a path are proved to be equilibria (reference/certificate), and how well.
#pragma once

#include <string>

#include "compare/channels.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {

using reference::certificate::Answer;
using reference::certificate::Certificate;

// Of some points of a path: how many are proved, and the worst that was proved.
struct Tally {
    int points = 0, proved = 0, excluded = 0, open = 0;
    int stable = 0;  // of the proved
    // Of the proved: at most this far from the true equilibrium, which is alone at least this far. [m, rad, N, N·m]
    reference::certificate::Extent error{0, 0, 0, 0}, unique;
    double held = 0, gap = 0;     // Certificate
    std::string theorem = {};     // what it says beyond the equations, of the last point; empty: nothing
    std::string not_proved = {};  // of the first point that is not: where, and why

    void add(double load, Unit unit, const Certificate& certificate);
};

}  // namespace elastocheck::compare
