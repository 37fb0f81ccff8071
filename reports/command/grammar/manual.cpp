#include "reports/command/grammar/manual.hpp"

namespace elastocheck::reports {
namespace {

// Text in roff: backslash and hyphen literal, no request at the start of a line, lines kept.
std::string text(std::string_view words) {
    std::string roff;
    for (const char c : words) {
        const bool start = roff.empty() || roff.back() == '\n';
        if (start && (c == '.' || c == '\'')) roff += "\\&";
        if (c == '\n' && !start) roff += "\n.br";
        if (c != '\n' || !start) roff += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    }
    return roff;
}

// "-o,--output": both in bold; a positional in italics.
std::string entry(const std::string& names, const std::string& value,
                  const std::string& description) {
    const bool positional = !names.starts_with('-');
    std::string page = std::string(".TP\n") + (positional ? "\\fI" : "\\fB");
    for (const char c : names) page += c == ',' ? "\\fR, \\fB" : text(std::string(1, c));
    return page + "\\fR" + (value.empty() || positional ? "" : " \\fI" + value + "\\fR") + "\n" +
           text(description) + "\n";
}

}  // namespace

std::string manual(const Program& program, const std::vector<Command>& commands,
                   const std::string& version) {
    const std::string help = entry(help_option, "", help_help);
    std::string page =
        ".TH ELASTOCHECK 1 \"\" \"" + program.name + " " + text(version) +
        "\" \"User Commands\"\n.SH NAME\n" + program.name +
        " \\- verification of suspension solvers by independent solutions\n.SH SYNOPSIS\n.B " +
        program.name + "\nCOMMAND [OPTION ...]\n.SH DESCRIPTION\n" + text(program.description) +
        "\n.SH OPTIONS\n" + entry(version_option, "", version_help) + help + ".SH COMMANDS\n";
    for (const auto& command : commands) {
        if (command.hidden) continue;
        std::string positionals, options = help;
        for (const auto& o : command.options)
            (o.names.starts_with('-') ? options : positionals) +=
                entry(o.names, value_of(o).name, o.description);
        page += ".SS " + text(program.name + " " + command.name) + "\n" +
                text(command.description) + ".\n" + positionals + options;
    }
    return page + ".SH EXIT STATUS AND FILES\n" + text(program.footer) + "\n";
}

}  // namespace elastocheck::reports
