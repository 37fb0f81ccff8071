// `elastocheck man`: the manual page elastocheck(1) in roff, made of the --help texts of all commands.
#include "reports/command/program/command.hpp"
#include "reports/command/program/parse.hpp"
#include "reports/files/provenance.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {
namespace {

// Text in roff: backslash and hyphen literal, no request at the start of a line, lines kept.
std::string roff(std::string_view words) {
    std::string text;
    for (const char c : words) {
        const bool start = text.empty() || text.back() == '\n';
        if (start && (c == '.' || c == '\'')) text += "\\&";
        if (c == '\n' && !start) text += "\n.br";
        if (c != '\n' || !start) text += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    }
    return text;
}

// "-o,--output FOLDER": the names in bold; a positional in italics.
std::string entry(const CLI::Option& option) {
    const bool positional = option.get_positional();
    const std::string type = option.get_type_name(), value = type.substr(0, type.find(':'));
    std::string text = std::string(".TP\n") + (positional ? "\\fI" : "\\fB");
    for (const char c : option.get_name(positional, true))
        text += c == ',' ? "\\fR, \\fB" : roff(std::string(1, c));
    return text + "\\fR" + (value.empty() || positional ? "" : " \\fI" + value + "\\fR") + "\n" +
           roff(option.get_description()) + "\n";
}

// Options of a command or of the program, positionals first.
std::string entries(const CLI::App& app) {
    std::string text;
    for (const bool positional : {true, false})
        for (const auto* option : app.get_options())
            if (option->get_positional() == positional) text += entry(*option);
    return text;
}

std::string manual(const CLI::App& program) {
    const std::string& name = program.get_name();
    std::string page = ".TH ELASTOCHECK 1 \"\" \"" + name + " " + roff(provenance().version) +
                       "\" \"User Commands\"\n.SH NAME\n" + name +
                       " \\- verification of suspension solvers by independent solutions\n"
                       ".SH SYNOPSIS\n.B " +
                       name + "\nCOMMAND [OPTION ...]\n.SH DESCRIPTION\n" +
                       roff(program.get_description()) + "\n.SH OPTIONS\n" + entries(program);
    for (const char* group : groups) {
        page += ".SH " + roff(group) + "\n";
        for (const auto* command : program.get_subcommands({}))
            if (command->get_group() == group)
                page += ".SS " + roff(name + " " + command->get_name()) + "\n" +
                        roff(command->get_description()) + ".\n" + entries(*command);
    }
    const auto installed = [](const std::string& document) {
        return "PREFIX/share/doc/elastocheck/" + document;
    };
    return page + ".SH EXIT STATUS AND FILES\n" + roff(footer(installed)) + "\n";
}

const Command man_command{Group::hidden, "man", "Print the page of the manual",
                          [](CLI::App& command) -> Run {
                              return [&program = *command.get_parent()](const std::string&) {
                                  print(manual(program));
                                  return fine;
                              };
                          }};

}  // namespace
}  // namespace elastocheck::reports
