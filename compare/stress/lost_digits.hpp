// Loss of digits under other floating-point arithmetic: evaluation of the sweep
// compare::other_arithmetic.
//
// Counts how many of the sixteen digits of an answer differ from those of the unchanged scene,
// 16 + log10(distance of both / range); per scene and solver group the largest over all branch
// sides. Changed digits count whether they were correct or not; StressCell::lost counts the correct
// ones.
#pragma once

#include <string>
#include <vector>

#include "compare/stress/stress.hpp"

namespace elastocheck::compare {

// "1.2"; or a sign where there is no number:
//
//   X  wrong        !  reported failure of all requested solvers
//   ?  converged here, but not with the unchanged scene        .  not requested
using Loss = std::string;

struct LostDigits {
    // "steps", all methods of the recursion with steps; "series", ...
    std::vector<std::string> groups;
    std::vector<std::string> variants;  // "rounded up"
    struct Row {
        std::string scene;
        std::vector<std::vector<Loss>> lost;  // per variant, per group
    };
    std::vector<Row> rows;
    const StressCell* worst = nullptr;        // the cell with the largest loss; null without a loss
    const StressCell* worst_right = nullptr;  // ... of correct digits
    // reported failure here, converged with the unchanged scene
    std::vector<const StressCell*> gave_up;
};

// For the answer to a transformed scene; NaN where either solve did not converge.
double digits_lost(const StressCell& cell);

// The result points into `survival`.
LostDigits lost_digits(const Survival& survival);

}  // namespace elastocheck::compare
