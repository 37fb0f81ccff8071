#include "reports/command/grammar/manual.hpp"

#include <fmt/format.h>

#include <sstream>

namespace elastocheck::reports {
namespace {

// Escaped text without roff requests: backslash and hyphen literal, no dot or apostrophe at the
// start of a line.
std::string text(std::string_view words) {
    std::string roff;
    bool at_start = true;
    for (const char c : words) {
        if (at_start && (c == '.' || c == '\'')) roff += "\\&";
        if (c == '\\')
            roff += "\\e";
        else if (c == '-')
            roff += "\\-";
        else
            roff += c;
        at_start = c == '\n';
    }
    return roff;
}

std::string bold(std::string_view words) { return "\\fB" + text(words) + "\\fR"; }
std::string slanted(std::string_view words) { return "\\fI" + text(words) + "\\fR"; }

std::string value(const Value& value, const std::string& name) {
    return value.kind == Value::Kind::none ? "" : " " + slanted(name);
}

void add(std::string& page, const OptionGrammar& option) {
    const bool positional = !option.name.starts_with("-");
    page += ".TP\n";
    if (positional)
        page += slanted(option.name) + (option.repeated ? " ..." : "");
    else
        page += (option.brief.empty() ? "" : bold(option.brief) + ", ") + bold(option.name) +
                value(option.value, option.value_name);
    page += "\n" + text(option.description) + "\n";
}

// Lines without filling.
std::string lines(const std::string& words) {
    std::string roff;
    std::istringstream in(words);
    for (std::string line; std::getline(in, line);)
        if (!line.empty()) roff += (roff.empty() ? "" : ".br\n") + text(line) + "\n";
    return roff;
}

}  // namespace

std::string manual(const Grammar& grammar, const std::string& version) {
    std::string page = fmt::format(
        ".TH ELASTOCHECK 1 \"\" \"{0} {1}\" \"User Commands\"\n.SH NAME\n{0} \\- "
        "can I trust my suspension solver?\n.SH SYNOPSIS\n",
        grammar.name, text(version));
    for (const auto& command : grammar.commands) {
        page += ".B " + text(grammar.name + " " + command.name) + "\n[\\fIOPTION\\fR ...]";
        for (const auto& positional : command.positionals)
            page +=
                fmt::format(" {}{}{}{}", positional.required ? "" : "[", slanted(positional.name),
                            positional.repeated ? " ..." : "", positional.required ? "" : "]");
        page += "\n.br\n";
    }
    page += ".SH DESCRIPTION\n" + lines(grammar.description) + ".SH OPTIONS\n";
    for (const auto& option : grammar.options) add(page, option);
    page += ".SH COMMANDS\n";
    for (const auto& command : grammar.commands) {
        page += ".SS " + text(grammar.name + " " + command.name) + "\n" +
                text(command.description) + ".\n";
        for (const auto& positional : command.positionals) add(page, positional);
        for (const auto& option : command.options)
            if (option.name != "--help") add(page, option);
    }
    return page + ".SH EXIT STATUS AND FILES\n" + lines(grammar.footer);
}

}  // namespace elastocheck::reports
