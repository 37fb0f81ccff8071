// Opens the page of `report --open` in a browser.
#pragma once

#include <string>

namespace elastocheck::reports {

// Command of a browser: the first of the colon-separated list $BROWSER whose program exists, else
// xdg-open. Throws std::invalid_argument without a browser, and where CI is set.
std::string browser();

// Runs it in a shell with the page in place of %s, or after it, and waits for it. Throws
// std::invalid_argument where it fails.
void open_in(const std::string& browser, const std::string& page);

}  // namespace elastocheck::reports
