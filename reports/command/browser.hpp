// Opens the page of `report --open` in a browser.
#pragma once

#include <string>

namespace elastocheck::reports {

// Browser program: the first existing one of the colon-separated list $BROWSER, else xdg-open.
// Throws std::invalid_argument without a browser, and where CI is set.
std::string browser();

// Runs it on the page, without a shell, and waits for it. Throws std::invalid_argument where it
// fails.
void open_in(const std::string& browser, const std::string& page);

}  // namespace elastocheck::reports
