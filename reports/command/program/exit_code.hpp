// Exit codes of the command.
#pragma once

#include "elastocheck/compare.hpp"

namespace elastocheck::reports {

enum Exit { fine = 0, limit_broken = 1, bad_input = 2, could_not_judge = 3, bug = 4 };

inline int exit_code_of(compare::Grade verdict) {
    return verdict == compare::Grade::pass   ? fine
           : verdict == compare::Grade::fail ? limit_broken
                                             : could_not_judge;
}

}  // namespace elastocheck::reports
