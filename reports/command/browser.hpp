// `report --open`.
#pragma once

#include <string>

namespace elastocheck::reports {

// The program that opens pages: what $BROWSER says (the first that there is of a list with colons), else xdg-open. Throws
// std::invalid_argument where there is none, and where CI is set: nobody looks there.
std::string browser();

// Runs it on the page, without a shell, and waits for it. Throws std::invalid_argument where it fails.
void open_in(const std::string& browser, const std::string& page);

}  // namespace elastocheck::reports
