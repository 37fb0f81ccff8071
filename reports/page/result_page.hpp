// The page of a result.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "compare/result/result.hpp"

namespace elastocheck::reports {

// HTML (templates/html/study.mustache): its tables that readers see, long ones folded, and its charts, of which those of
// one `only` are a section with these words. `made`: what made it, which version.
std::string result_page(const compare::Result& result, const std::string& title,
                        const std::map<std::string, std::string>& words,
                        const std::string& reproduce,
                        const std::vector<std::pair<std::string, std::string>>& made);

}  // namespace elastocheck::reports
