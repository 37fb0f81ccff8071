#include "reports/command/grammar/arguments.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "reports/text/escape.hpp"

namespace elastocheck::reports {

void check_words(int argc, char** argv) {
    for (int k = 1; k < argc; ++k) {
        const std::string_view word = argv[k];
        std::string one_line(word);
        const bool reason =
            word.starts_with("--reason=") || std::string_view(argv[k - 1]) == "--reason";
        if (reason)
            for (char& c : one_line) c = c == '\n' ? ' ' : c;
        if (const std::string wrong = flaw(one_line); !wrong.empty())
            throw std::invalid_argument(fmt::format("'{}': {}; names are one line of UTF-8 text",
                                                    for_terminal(word), wrong));
    }
}

std::string command_line(int argc, char** argv) {
    std::string line = "elastocheck";
    for (int k = 1; k < argc; ++k) {
        const std::string_view word = argv[k];
        if (word == "--jobs") ++k;
        if (word == "--quiet" || word == "--jobs" || word.starts_with("--jobs=")) continue;
        line += " " + for_shell(word);
    }
    return line;
}

}  // namespace elastocheck::reports
