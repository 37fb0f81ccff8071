// Exit codes of the command.
#pragma once

namespace elastocheck::reports {

enum Exit { fine = 0, limit_broken = 1, bad_input = 2, could_not_judge = 3, bug = 4 };

}  // namespace elastocheck::reports
