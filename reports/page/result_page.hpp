// The page of a result.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "compare/result/result.hpp"

namespace elastocheck::reports {

// HTML (templates/html/study.mustache): the tables, long ones folded, and the charts; the charts with one
// name in Chart::only are a section, headed by the text of that name in `words`. `made`: programs that
// made it, and their versions.
std::string result_page(const compare::Result& result, const std::string& title,
                        const std::map<std::string, std::string>& words,
                        const std::string& reproduce,
                        const std::vector<std::pair<std::string, std::string>>& made);

}  // namespace elastocheck::reports
