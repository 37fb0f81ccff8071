#include "reports/command/browser.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

bool succeeds(const std::string& line) { return std::system(line.c_str()) == 0; }

bool is_there(const std::string& command) {
    const std::string program = command.substr(0, command.find(' '));
    return !program.empty() && succeeds("command -v " + for_shell(program) + " >/dev/null 2>&1");
}

}  // namespace

std::string browser() {
    if (const std::string ci = variable("CI"); !ci.empty() && ci != "false" && ci != "0")
        throw std::invalid_argument("--open: not in CI (variable CI is set)");
    std::istringstream list(variable("BROWSER"));
    for (std::string command; std::getline(list, command, ':');)
        if (is_there(command)) return command;
    if (is_there("xdg-open")) return "xdg-open";
    throw std::invalid_argument(
        "--open: there is nothing to open a page with: $BROWSER names no program, and xdg-open (of "
        "xdg-utils) is not there");
}

void open_in(const std::string& browser, const std::string& page) {
    const std::string address = for_shell(std::filesystem::absolute(page).string());
    std::string line = browser;
    if (const auto at = line.find("%s"); at != line.npos)
        line.replace(at, 2, address);
    else
        line += " " + address;
    // Its output goes to standard error: standard output may be a document.
    if (!succeeds(line + " >&2"))
        throw std::invalid_argument(
            fmt::format("--open: {} failed; the page is {}", browser, page));
}

}  // namespace elastocheck::reports
