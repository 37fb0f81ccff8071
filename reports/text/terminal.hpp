// What is said to people: the only way to standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <string_view>

namespace elastocheck::reports {

// Whoever read standard output has read enough and closed it (`| head`): nothing is wrong, and nothing more to be done.
struct NobodyReads {};

// Writes lines of text, each for_terminal(). Throws FileError where they cannot be written, NobodyReads.
void print(std::string_view lines);
void complain(std::string_view lines);  // to standard error; where that is closed there is nobody to tell

template <class First, class... Rest>
void print(fmt::format_string<First, Rest...> format, First&& first, Rest&&... rest) {
    print(std::string_view(fmt::format(format, std::forward<First>(first), std::forward<Rest>(rest)...)));
}
template <class First, class... Rest>
void complain(fmt::format_string<First, Rest...> format, First&& first, Rest&&... rest) {
    complain(std::string_view(fmt::format(format, std::forward<First>(first), std::forward<Rest>(rest)...)));
}

// One line that is written over, where standard error is a terminal.
void progress(std::string_view what);

// Everything printed is out, or one of these is thrown: a full disk shows only here.
void finish_printing();

}  // namespace elastocheck::reports
