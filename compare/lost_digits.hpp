// What other arithmetic costs: of the sweep compare::other_arithmetic, the digits that each scene loses by each group of
// solvers, the worst of all ways and of all solvers of a group.
#pragma once

#include <string>
#include <vector>

#include "compare/stress.hpp"

namespace elastocheck::compare {

// "1.2"; or why there is no number:
//
//   X  wrong      !  an honest outcome, by all that were asked      ?  nothing is known to lose digits of      .  not asked
using Loss = std::string;

struct LostDigits {
    std::vector<std::string> groups;    // "steps", all methods of the recursion that take them; "series", ...
    std::vector<std::string> variants;  // "rounded up"
    struct Row {
        std::string scene;
        std::vector<std::vector<Loss>> lost;  // per variant, per group
    };
    std::vector<Row> rows;
    const StressCell* worst = nullptr;       // the one that loses most digits; none where nobody loses any
    std::vector<const StressCell*> gave_up;  // honest here, converged with the scene as it is
};

// Points into `survival`.
LostDigits lost_digits(const Survival& survival);

}  // namespace elastocheck::compare
