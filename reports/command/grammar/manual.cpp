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

std::string list(const std::vector<OptionGrammar>& options) {
    std::string page;
    for (const auto& o : options)
        page +=
            ".TP\n" + (o.brief.empty() ? "" : "\\fB" + text(o.brief) + "\\fR, ") +
            (o.name.starts_with('-') ? "\\fB" : "\\fI") + text(o.name) + "\\fR" +
            (o.value_name.empty() || !o.name.starts_with('-') ? ""
                                                              : " \\fI" + o.value_name + "\\fR") +
            "\n" + text(o.description) + "\n";
    return page;
}

}  // namespace

std::string manual(const Grammar& all, const std::string& version) {
    std::string page = ".TH ELASTOCHECK 1 \"\" \"" + all.name + " " + text(version) +
                       "\" \"User Commands\"\n.SH NAME\n" + all.name +
                       " \\- verification of suspension solvers by independent solutions\n.SH SYNOPSIS\n.B " + all.name +
                       "\nCOMMAND [OPTION ...]\n.SH DESCRIPTION\n" + text(all.description) +
                       "\n.SH OPTIONS\n" + list(all.options) + ".SH COMMANDS\n";
    for (const auto& command : all.commands)
        page += ".SS " + text(all.name + " " + command.name) + "\n" + text(command.description) +
                ".\n" + list(command.positionals) + list(command.options);
    return page + ".SH EXIT STATUS AND FILES\n" + text(all.footer) + "\n";
}

}  // namespace elastocheck::reports
