// Loops of joints: biconnected components of the graph of bodies and constraints.
// Only constraints in the same component can depend on each other.
//
// Multipliers y with Φ_qᵀ y = 0 are reactions in balance without load. Let a body, or the ground,
// separate the joints of two sides. The bodies of one side are in balance with each other and joint
// reactions on two bodies are equal and opposite, so the reactions of one side on the separating
// body sum to zero. Hence y splits into one combination on each side. The parts that cannot be
// split further are the blocks of the graph (Hopcroft and Tarjan 1973).
#pragma once

#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

// The block number of every row of Φ, from 0.
std::vector<int> loops(const Model& model);

}  // namespace elastocheck::recursive
