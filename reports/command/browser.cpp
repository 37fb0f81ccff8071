#include "reports/command/browser.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

std::vector<std::string> parts(const std::string& list, char between) {
    std::vector<std::string> all;
    std::istringstream in(list);
    for (std::string part; std::getline(in, part, between);)
        if (!part.empty()) all.push_back(part);
    return all;
}

// Looks up the first word as a shell does.
bool is_executable(const std::string& command) {
    const auto words = parts(command, ' ');
    if (words.empty()) return false;
    if (words.front().find('/') != std::string::npos)
        return ::access(words.front().c_str(), X_OK) == 0;
    for (const auto& folder : parts(variable("PATH"), ':'))
        if (::access((fs::path(folder) / words.front()).c_str(), X_OK) == 0) return true;
    return false;
}

}  // namespace

std::string browser() {
    if (const std::string ci = variable("CI"); !ci.empty() && ci != "false" && ci != "0")
        throw std::invalid_argument("--open: not in CI (variable CI is set)");
    for (const auto& command : parts(variable("BROWSER"), ':'))
        if (is_executable(command)) return command;
    if (is_executable("xdg-open")) return "xdg-open";
    throw std::invalid_argument(
        "--open: there is nothing to open a page with: $BROWSER names no program, and xdg-open (of "
        "xdg-utils) is not there");
}

void open_in(const std::string& browser, const std::string& page) {
    const std::string address = fs::absolute(page).string();
    auto words = parts(browser, ' ');
    bool placed = false;  // %s is replaced by the page, as usual for $BROWSER
    for (auto& word : words)
        if (word == "%s") word = address, placed = true;
    if (!placed) words.push_back(address);
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    // Its output goes to standard error: standard output may be a document.
    posix_spawn_file_actions_t streams;
    ::posix_spawn_file_actions_init(&streams);
    ::posix_spawn_file_actions_adddup2(&streams, STDERR_FILENO, STDOUT_FILENO);
    pid_t child = 0;
    const int failed =
        ::posix_spawnp(&child, argv.front(), &streams, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&streams);
    if (failed != 0)
        throw std::invalid_argument(fmt::format("--open: {} cannot be run ({}); the page is {}",
                                                browser, std::strerror(failed), page));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::invalid_argument(
            fmt::format("--open: {} failed; the page is {}", browser, page));
}

}  // namespace elastocheck::reports
