// Terminal output: the only writer to standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace elastocheck::reports {

// The reader closed standard output (`| head`): not an error, and no more output is needed.
struct OutputClosed {};

// Writes lines of text, each through for_terminal(). Throws FileError where they cannot
// be written, OutputClosed where the reader has gone.
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

// Shows on standard error what runs, and the share of the work that is done, 0 to 1: on a terminal
// by a bar that is rewritten in place, else by a line every ten seconds. Empty: the work has ended.
// May be called by any thread.
void progress(std::string_view what, double done = std::numeric_limits<double>::quiet_NaN());
void hide_progress();  // from now on

// What a command writes, kept for a program that runs it in its own process.
struct Collected {
    std::function<void(std::string_view what, double done)> progress = {};
    std::string printed = {}, errors = {};
    std::string text = {};  // of a result that is printed as a document
};
// While one exists, nothing is written to the streams of the process.
struct Collecting {
    explicit Collecting(Collected& into);
    Collecting(const Collecting&) = delete;
    Collecting& operator=(const Collecting&) = delete;
    ~Collecting();
};
// The text of a result, where the document is printed: dropped, unless output is collected.
void print_beside_document(std::string_view text);

// Line of progress after so many seconds: "[######------]  50 %, 12 s left: jounce: energy leg", cut
// to the width of the terminal; without a bar for a width of zero.
std::string progress_line(std::string_view what, double done, double seconds, int width);

// Flushes all output. Throws FileError, OutputClosed: a full disk is detected only here.
void finish_printing();

}  // namespace elastocheck::reports
