// Terminal output: the only writer to standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <string_view>

namespace elastocheck::reports {

// The reader closed standard output (`| head`): not an error, and no more output is needed.
struct OutputClosed {};

// Writes lines of text, each through for_terminal(). Throws FileError where they cannot be written,
// OutputClosed.
void print(std::string_view lines);
void print_error(std::string_view lines);  // to standard error; ignored where that is closed

template <class First, class... Rest>
void print(fmt::format_string<First, Rest...> format, First&& first, Rest&&... rest) {
    print(std::string_view(
        fmt::format(format, std::forward<First>(first), std::forward<Rest>(rest)...)));
}
template <class First, class... Rest>
void print_error(fmt::format_string<First, Rest...> format, First&& first, Rest&&... rest) {
    print_error(std::string_view(
        fmt::format(format, std::forward<First>(first), std::forward<Rest>(rest)...)));
}

// One line that is overwritten by the next, where standard error is a terminal.
void progress(std::string_view what);

// Flushes all output, or throws one of these: a full disk is detected only here.
void finish_printing();

}  // namespace elastocheck::reports
