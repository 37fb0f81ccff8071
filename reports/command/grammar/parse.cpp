// Command-line parser by CLI11; the only file that includes CLI11, whose headers take seconds to
// compile.
#include "reports/command/grammar/parse.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "models/reader/document/suggestions.hpp"
#include "reports/command/grammar/exit_code.hpp"
#include "reports/files/terminal.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

// Throws std::invalid_argument for a word that is not UTF-8 or has control characters (escape.hpp:
// flaw), since words appear in reports, annotations and terminals. A --reason may have several
// lines.
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

std::string flaw_of_a_name(const std::string& word) {
    if (word.empty()) return "'' is no name";
    if (word == "-") return "'-' is no file name; standard output is the default or --json";
    return {};
}

void check(CLI::Option& option, const Value& value) {
    if (value.kind == Value::Kind::file || value.kind == Value::Kind::folder)
        option.check(CLI::Validator(flaw_of_a_name, ""));
    if (value.kind == Value::Kind::words) option.check(CLI::IsMember(value.words).description(""));
    if (value.kind != Value::Kind::text) option.type_name(value.name);
}

// CLI11 reads numbers by the locale's decimal sign; from_chars reads a point.
void read_number(const std::string& option, const std::string& word, const RealNumber& target) {
    const std::string range = std::isfinite(target.low) || std::isfinite(target.high)
                                  ? fmt::format(" from {} to {}", target.low, target.high)
                                  : "";
    const char* first = word.data() + (word.starts_with('+') ? 1 : 0);  // from_chars rejects a plus
    const char* last = word.data() + word.size();
    double& number = *target.variable;
    const auto [end, error] = std::from_chars(first, last, number);
    if (error != std::errc{} || end != last || !std::isfinite(number) ||
        !(number >= target.low && number <= target.high))
        throw CLI::ValidationError(option, fmt::format("'{}' is not a number{}", word, range));
}

// One overload per kind of variable.
struct Adder {
    CLI::App& app;
    const Option& option;

    CLI::Option* operator()(const Flag& flag) const {
        return app.add_flag(option.names, *flag.variable, option.description);
    }
    CLI::Option* operator()(const Text& text) const {
        auto* added = app.add_option(option.names, *text.variable, option.description);
        check(*added, text.value);
        return added;
    }
    CLI::Option* operator()(const TextList& list) const {
        auto* added = app.add_option(option.names, *list.variable, option.description);
        if (list.form == TextList::Form::repeated) added->take_all()->expected(1);
        if (list.form == TextList::Form::commas) added->delimiter(',');
        check(*added, list.value);
        return added;
    }
    CLI::Option* operator()(const Integer& integer) const {
        return app.add_option(option.names, *integer.variable, option.description)
            ->check(CLI::Range(integer.low, integer.high));
    }
    CLI::Option* operator()(const IntegerList& list) const {
        return app.add_option(option.names, *list.variable, option.description)
            ->delimiter(',')
            ->check(CLI::Range(list.low, list.high));
    }
    CLI::Option* operator()(const RealNumber& number) const {
        return app
            .add_option_function<std::string>(
                option.names,
                [name = option.names, number](const std::string& word) {
                    read_number(name, word, number);
                },
                option.description)
            ->type_name("FLOAT");
    }
    CLI::Option* operator()(Settings* settings) const {
        return app
            .add_option_function<std::vector<std::string>>(
                option.names,
                [settings](const std::vector<std::string>& texts) {
                    for (const auto& text : texts) settings->push_back(parse_setting(text));
                },
                option.description)
            ->take_all()
            ->type_name("PATH=VALUE")
            ->expected(1);
    }
};

// Prints CLI11's message, and for an unknown word the nearest known one.
int explain(const CLI::App& app, const std::vector<Command>& commands, const CLI::ParseError& error,
            int argc, char** argv) {
    std::string message = error.what();
    const CLI::App* scope = &app;
    std::vector<std::string> known;
    if (!app.get_subcommands().empty()) scope = app.get_subcommands().front();
    const bool in_command = scope != &app;
    if (!in_command)
        for (const auto& command : commands)
            if (!command.hidden) known.push_back(command.name);
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
    print_error("elastocheck: {}\nSee elastocheck --help.\n", message);
    return bad_input;
}

}  // namespace

int parse_and_run(const Program& program, const std::vector<Command>& commands, int argc,
                  char** argv) {
    CLI::App app{program.description, program.name};
    app.require_subcommand(1);
    app.set_version_flag(version_option, program.version, version_help);
    app.set_help_flag(help_option, help_help);
    app.footer(program.footer);
    std::vector<const CLI::App*> parsed;
    for (const auto& command : commands) {
        auto* added = app.add_subcommand(command.name, command.description);
        if (command.hidden) added->group("");
        for (const auto& option : command.options)
            std::visit(Adder{*added, option}, option.target)->required(option.required);
        parsed.push_back(added);
    }
    try {
        check_words(argc, argv);
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {
        return app.exit(done);
    } catch (const CLI::ParseError& error) {
        return explain(app, commands, error, argc, argv);
    }
    for (std::size_t k = 0; k < commands.size(); ++k)
        if (*parsed[k]) return commands[k].run(command_line(argc, argv));
    return bug;  // one is required
}

}  // namespace elastocheck::reports
