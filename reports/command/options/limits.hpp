// Memory limits of a run, checked before the work. Limits of inputs: models/reader/document/limits.hpp,
// reports/files/limits.hpp.
#pragma once

#include <cstddef>

#include "elastocheck/model.hpp"
#include "models/reader/document/limits.hpp"

namespace elastocheck::reports {

using reader::max_steps;  // of a branch, as in a scene
// Limit for the stored points of a run [bytes]: available on an ordinary desktop or CI machine.
inline constexpr double max_memory = 4e9;

// Requested points and what is stored of them. Outputs are stored, states never; a comparison of
// legs stores the outputs of all points of all branches.
struct RunSize {
    int steps = 0;  // of each branch; 0: the branch's own number
    int every = 1;
    int legs = 1;
    bool written = false;      // also as numbers and text of a result document
    std::size_t channels = 0;  // 0: those of the model
};

// Throws std::invalid_argument with the largest possible number of steps above `max_memory`.
void check_memory(const Model& model, const RunSize& run);

// The same for output row by row with `channels` outputs: only the first of two branch sides is
// stored, since it is solved in reverse.
void check_memory_of_rows(const Model& model, const RunSize& run, std::size_t channels);

// Throws std::invalid_argument for an --every larger than the steps of a branch.
void check_every(const Model& model, int steps, int every);

}  // namespace elastocheck::reports
