// Words that name a figure: "OUTPUT", or "OUTPUT@BRANCH:PARAMETER".
#pragma once

#include <span>
#include <string_view>

#include "elastocheck/channels.hpp"

namespace elastocheck::compare {

// Where the output ends: an output may have an "@" of its own, "left.lateral_force_steer@parallel".
std::size_t end_of_output(std::string_view figure, std::span<const Channel> outputs);

}  // namespace elastocheck::compare
