// What other arithmetic costs: of the sweep compare::other_arithmetic, how many of a double's sixteen digits of an answer
// differ from those of the scene as it is, 16 + log10(distance of both / range), of each scene and each group of solvers the
// most of all ways. They are lost to rounding, whether they were right or not; of those that were right, StressCell::lost.
#pragma once

#include <string>
#include <vector>

#include "compare/stress.hpp"

namespace elastocheck::compare {

// "1.2"; or why there is no number:
//
//   X  wrong      !  an honest outcome, by all that were asked      ?  converged, and not with the scene as it is      .  not asked
using Loss = std::string;

struct LostDigits {
    std::vector<std::string> groups;    // "steps", all methods of the recursion that take them; "series", ...
    std::vector<std::string> variants;  // "rounded up"
    struct Row {
        std::string scene;
        std::vector<std::vector<Loss>> lost;  // per variant, per group
    };
    std::vector<Row> rows;
    const StressCell* worst = nullptr;        // the one that loses most digits; none where nobody loses any
    const StressCell* worst_right = nullptr;  // ... that were right
    std::vector<const StressCell*> gave_up;   // honest here, converged with the scene as it is
};

// Of an answer that was told otherwise; NaN where either did not converge.
double digits_lost(const StressCell& cell);

// Points into `survival`.
LostDigits lost_digits(const Survival& survival);

}  // namespace elastocheck::compare
