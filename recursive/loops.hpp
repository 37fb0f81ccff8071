// The loops of joints: which constraints can depend on each other at all.
//
// Multipliers y with Φ_qᵀ y = 0 are reactions that no load asks for. Let them run through a body, or the ground, past
// which the joints of two sides have nothing more to do with each other. The bodies of one side are in balance with
// each other, and what joints put on two bodies is equal and opposite: so they put nothing on that body, and y is one
// combination on this side and another on that. What cannot be divided any more are the blocks of the graph of bodies
// and constraints (Hopcroft and Tarjan 1973).
#pragma once

#include <vector>

#include "models/model.hpp"

namespace elastocheck::recursive {

// The block that every row of Φ is in, numbered from 0.
std::vector<int> loops(const Model& model);

}  // namespace elastocheck::recursive
