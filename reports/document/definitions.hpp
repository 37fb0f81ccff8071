// What every output means. The one place: `elastocheck inspect`, result.json, the report, and (a test
// compares) reports/README.md all say it in these words.
#pragma once

#include <string>

#include "compare/channels.hpp"

namespace elastocheck::reports {

std::string definition(const compare::Channel& channel);

inline constexpr const char* travel_definition =
    "displacement of the wheel centre (or the first probe) along the resultant force of the branch, positive "
    "with "
    "the force of load factor 1; counted from where the branch begins";

}  // namespace elastocheck::reports
