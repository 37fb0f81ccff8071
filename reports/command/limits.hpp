// How much a run takes on: said before the work, instead of running out of memory in it. Of what is read:
// models/reader/limits.hpp, reports/files/limits.hpp.
#pragma once

#include "models/model.hpp"
#include "models/reader/limits.hpp"

namespace elastocheck::reports {

using reader::most_steps;  // of a branch, as in a scene
// What is kept of the points of a run may take together [bytes]: what an ordinary desk or CI machine has to spare.
inline constexpr double most_memory = 4e9;

// Which points are asked for, and what is kept of them. States are never kept, outputs are: by whoever compares legs those
// of all points of all branches.
struct Asked {
    int steps = 0;  // of each branch; 0: as it says
    int every = 1;
    int legs = 1;
    bool written = false;  // also as numbers and text of a result document
};

// Throws std::invalid_argument when that takes more than `most_memory`, and says how many steps would not.
void check_memory(const Model& model, const Asked& asked);

// The same for who writes a row of `channels` outputs as each point is found: kept is what comes reversed, the first of
// the two ways of a branch, until it is written.
void check_memory_of_rows(const Model& model, const Asked& asked, std::size_t channels);

// Throws std::invalid_argument for an --every that is more than a branch has steps.
void check_every(const Model& model, int steps, int every);

}  // namespace elastocheck::reports
