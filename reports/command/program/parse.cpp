#include "reports/command/program/parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "models/reader/document/suggestions.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"
#include "reports/files/terminal.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

// Path of a document by its name in the source tree: PREFIX/share/doc/elastocheck/NAME of an
// installed program, or the one in the source tree; else only its name.
std::string documentation(const std::string& name) {
    const std::filesystem::path file = beside_program({"share/doc/elastocheck/" + name, name});
    return file.empty() ? name : file.string();
}

// Throws std::invalid_argument for a word that is not UTF-8 or has control characters
// (escape.hpp: flaw), since words appear in reports, annotations and terminals. A --reason may
// have several lines.
void check_words(int argc, char** argv) {
    for (int k = 1; k < argc; ++k) {
        const std::string_view word = argv[k];
        std::string one_line(word);
        if (word.starts_with("--reason=") || std::string_view(argv[k - 1]) == "--reason")
            std::ranges::replace(one_line, '\n', ' ');
        if (const std::string wrong = flaw(one_line); !wrong.empty())
            throw std::invalid_argument(fmt::format("'{}': {}; names are one line of UTF-8 text",
                                                    for_terminal(word), wrong));
    }
}

// The command as given, for a shell; without --jobs and --quiet, which do not change a result.
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

// Prints CLI11's message, and for an unknown word the nearest known one.
int explain(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
    std::string message = error.what();
    const CLI::App* scope = &app;
    std::vector<std::string> known;
    if (!app.get_subcommands().empty()) scope = app.get_subcommands().front();
    const bool in_command = scope != &app;
    if (!in_command)
        for (const auto* command : commands())
            if (command->group != Group::hidden) known.emplace_back(command->name);
    for (const auto* option : scope->get_options())
        if (!option->get_lnames().empty()) known.push_back("--" + option->get_lnames().front());
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
        dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        for (int k = 1; k < argc; ++k) {
            const std::string argument = argv[k], word = argument.substr(0, argument.find('='));
            const bool option = word.starts_with("--");
            if ((!in_command && k == 1 && !option) ||
                (option && std::ranges::find(known, word) == known.end())) {
                message =
                    fmt::format("{} {}{}", option ? "unknown option" : "unknown command",
                                reader::quote(word), reader::did_you_mean(word, known, "known"));
                break;
            }
        }
    }
    print_error("elastocheck: {}\nSee elastocheck {}--help.\n", message,
                in_command ? scope->get_name() + " " : "");
    return bad_input;
}

}  // namespace

std::string footer(std::string (*path_of)(const std::string& document)) {
    return fmt::format(
        "Exit codes: 0 success, 1 failed judgement or gate, 2 bad input, 3 could not judge, 4 "
        "internal error.\nScene files: {}\nOutput files: {}\n",
        path_of("models/scenes/README.md"), path_of("reports/README.md"));
}

int parse_and_run(int argc, char** argv) {
    CLI::App app{
        "Verification of a suspension solver: one scene, solved by three independent methods:\n"
        "the linear recursive formula of Kang's paper, the full equilibrium equations, and "
        "an energy minimisation.",
        "elastocheck"};
    app.require_subcommand(1);
    app.set_version_flag("--version", version_text(provenance()),
                         "print version, commit and libraries");
    app.set_help_flag("-h,--help", "print this help; after a command, its options");
    app.footer(footer(documentation));
    std::vector<std::pair<const CLI::App*, Run>> runs;
    for (const auto* command : commands()) {
        auto* added = app.add_subcommand(command->name, command->description);
        added->group(command->group == Group::hidden ? "" : groups[int(command->group)]);
        runs.emplace_back(added, command->set_up(*added));
    }
    try {
        check_words(argc, argv);
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {
        return app.exit(done);
    } catch (const CLI::ParseError& error) {
        return explain(app, error, argc, argv);
    }
    for (const auto& [command, run] : runs)
        if (*command) return run(command_line(argc, argv));
    return bug;  // one is required
}

}  // namespace elastocheck::reports
