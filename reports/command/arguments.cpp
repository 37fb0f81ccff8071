#include "reports/command/arguments.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "reports/text/escape.hpp"

namespace elastocheck::reports {

void check_words(int argc, char** argv) {
    for (int k = 1; k < argc; ++k) {
        const std::string_view word = argv[k];
        std::string one_line(word);
        const bool reason = word.starts_with("--reason=") || std::string_view(argv[k - 1]) == "--reason";
        if (reason)
            for (char& c : one_line) c = c == '\n' ? ' ' : c;
        if (const std::string wrong = flaw(one_line); !wrong.empty())
            throw std::invalid_argument(
                fmt::format("'{}': {}; names are one line of UTF-8 text", for_terminal(word), wrong));
    }
}

std::string command_line(int argc, char** argv) {
    std::string line = "elastocheck";
    for (int k = 1; k < argc; ++k) line += " " + for_shell(argv[k]);
    return line;
}

namespace {

std::string no_name(const std::string& word) {
    if (word.empty()) return "'' is no name";
    if (word == "-") return "'-' is no name; what goes to standard output goes there by itself, or by --json";
    return {};
}

}  // namespace

CLI::Validator a_file(const std::string& pattern) { return {no_name, "", "files " + pattern}; }

CLI::Validator a_folder() { return {no_name, "", "folder"}; }

CLI::Validator one_of(const std::vector<std::string>& words) {
    return CLI::IsMember(words).description("").name(fmt::format("words {}", fmt::join(words, " ")));
}

CLI::Validator such_as(const std::vector<std::string>& words) {
    return {[](std::string&) { return std::string(); }, "", fmt::format("words {}", fmt::join(words, " "))};
}

void add_json(CLI::App& command, bool& wanted) {
    command.add_flag("--json", wanted, "one JSON document on standard output, and nothing else there");
}

void add_settings(CLI::App& command, Settings& settings) {
    command
        .add_option_function<std::vector<std::string>>(
            "--set",
            [&settings](const std::vector<std::string>& texts) {
                for (const auto& text : texts) settings.push_back(parse_setting(text));
            },
            "change a value of the scene, in the file's units: --set points.tie_rod_inner.z=-0.055")
        ->take_all()
        ->type_name("PATH=VALUE")
        ->expected(1);
}

CLI::Option* add_number(CLI::App& command, const std::string& name, double& number, double low, double high,
                        const std::string& text) {
    const std::string range =
        std::isfinite(low) || std::isfinite(high) ? fmt::format(" from {} to {}", low, high) : "";
    return command
        .add_option_function<std::string>(
            name,
            [name, &number, low, high, range](const std::string& word) {
                // A plus is all that from_chars refuses of what people write.
                const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
                const char* last = word.data() + word.size();
                const auto [end, error] = std::from_chars(first, last, number);
                if (error != std::errc{} || end != last || !std::isfinite(number) ||
                    !(number >= low && number <= high))
                    throw CLI::ValidationError(name, fmt::format("'{}' is no number{}", word, range));
            },
            text)
        ->type_name("FLOAT");
}

}  // namespace elastocheck::reports
