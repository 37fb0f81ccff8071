#include "reports/command/grammar/completion.hpp"

#include <fmt/format.h>

#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

std::string names_of(const std::vector<OptionGrammar>& options) {
    std::string names;
    for (const auto& option : options) {
        if (!option.brief.empty()) names += option.brief + " ";
        names += option.name + " ";
    }
    if (!names.empty()) names.pop_back();
    return names;
}

std::string names_of(const std::vector<CommandGrammar>& commands) {
    std::string names;
    for (const auto& command : commands) names += (names.empty() ? "" : " ") + command.name;
    return names;
}

// ---- bash: one function, a case for each option that takes a value and each command.

// Statement that sets COMPREPLY for a value.
std::string bash_offer(const Value& value) {
    switch (value.kind) {
        case Value::Kind::words:
        case Value::Kind::similar_words:
            return fmt::format("_elastocheck_words {}",
                               for_shell(fmt::format("{}", fmt::join(value.words, " "))));
        case Value::Kind::file: return "_elastocheck_files " + for_shell(value.pattern);
        case Value::Kind::folder: return "_elastocheck_files /";
        default: return ":";
    }
}

std::string bash(const Grammar& grammar) {
    std::string values, commands;
    for (const auto& command : grammar.commands) {
        for (const auto& option : command.options)
            if (option.value.kind != Value::Kind::none)
                values += fmt::format(
                    "        '{0} {1}'{2}) {3}; return ;;\n", command.name, option.name,
                    option.brief.empty() ? ""
                                         : fmt::format(" | '{} {}'", command.name, option.brief),
                    bash_offer(option.value));
        commands += fmt::format(
            "        {}) options={}; offer={} ;;\n", command.name,
            for_shell(names_of(command.options)),
            for_shell(command.positionals.empty() ? ":"
                                                  : bash_offer(command.positionals.front().value)));
    }
    return fmt::format(R"(# bash completion of {0}. Made by `{0} completion bash`.
_elastocheck_words() {{
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$word")
}}
# Folders to walk through, and the files of a pattern; of / folders alone.
_elastocheck_files() {{
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -d -- "$word"; [ "$1" = / ] || compgen -f -X "!$1" -- "$word")
}}
_elastocheck() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command= options= offer= k
    COMPREPLY=()
    # --option=value comes as three words.
    if [ "$word" = = ]; then
        word=
    elif [ "$before" = = ]; then
        before=${{COMP_WORDS[COMP_CWORD - 2]}}
    fi
    for ((k = 1; k < COMP_CWORD; ++k)); do
        case ${{COMP_WORDS[k]}} in
        -*) ;;
        *)
            command=${{COMP_WORDS[k]}}
            break
            ;;
        esac
    done
    if [ -z "$command" ]; then
        _elastocheck_words {1}
        return
    fi
    case "$command $before" in
{2}    esac
    case $command in
{3}    esac
    case $word in
    -*) _elastocheck_words "$options" ;;
    *) eval "$offer" ;;
    esac
}}
complete -F _elastocheck {0}
)",
                       grammar.name,
                       for_shell(names_of(grammar.commands) + " " + names_of(grammar.options)),
                       values, commands);
}

// ---- zsh: _arguments of each command.

// Escapes brackets, colons and backslashes for a specification of _arguments.
std::string zsh_text(std::string_view words) {
    std::string safe;
    for (const char c : words) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') safe += '\\';
        safe += c;
    }
    return safe;
}

std::string zsh_action(const OptionGrammar& option) {
    const std::string tag = zsh_text(option.value_name.empty() ? option.name : option.value_name);
    switch (option.value.kind) {
        case Value::Kind::none: return "";
        case Value::Kind::words:
        case Value::Kind::similar_words:
            return fmt::format(":{}:({})", tag, fmt::join(option.value.words, " "));
        case Value::Kind::file:
            return fmt::format(":{}:_files -g \"{}\"", tag, option.value.pattern);
        case Value::Kind::folder: return fmt::format(":{}:_files -/", tag);
        case Value::Kind::text: return fmt::format(":{}: ", tag);
    }
    return "";
}

std::string zsh(const Grammar& grammar) {
    std::string commands, cases;
    const auto specifications = [](const CommandGrammar& command) {
        std::string all;
        for (const auto& option : command.options)
            for (const auto& name : {option.brief, option.name})
                if (!name.empty())
                    all += " \\\n            " +
                           for_shell(fmt::format("{}{}[{}]{}", option.repeated ? "*" : "", name,
                                                 zsh_text(option.description), zsh_action(option)));
        for (const auto& positional : command.positionals)
            all += " \\\n            " +
                   for_shell((positional.repeated ? "*" : "1") + zsh_action(positional));
        return all;
    };
    for (const auto& command : grammar.commands) {
        commands +=
            "        " + for_shell(command.name + ":" + zsh_text(command.description)) + "\n";
        cases += fmt::format("    {})\n        _arguments{}\n        ;;\n", command.name,
                             specifications(command));
    }
    return fmt::format(R"(#compdef {0}
# zsh completion of {0}. Made by `{0} completion zsh`.
_elastocheck() {{
    local -a commands
    commands=(
{1}    )
    if ((CURRENT == 2)); then
        _describe command commands
        return
    fi
    shift words
    ((CURRENT--))
    case $words[1] in
{2}    esac
}}
if [ "$funcstack[1]" = _elastocheck ]; then
    _elastocheck "$@"
else
    compdef _elastocheck {0}
fi
)",
                       grammar.name, commands, cases);
}

// ---- fish: a line for each option of each command.

// Single-quoted text: fish interprets \\ and \' there.
std::string fish_text(std::string_view words) {
    std::string safe = "'";
    for (const char c : words) {
        if (c == '\\' || c == '\'') safe += '\\';
        safe += c;
    }
    return safe + "'";
}

// -F: also files, which `complete -f` has disabled.
std::string fish_action(const Value& value) {
    switch (value.kind) {
        case Value::Kind::none: return "";
        case Value::Kind::words:
        case Value::Kind::similar_words:
            return " -x -a " + fish_text(fmt::format("{}", fmt::join(value.words, " ")));
        case Value::Kind::file:
            return " -x -a " +
                   fish_text(fmt::format("(__fish_complete_suffix {})", value.pattern.substr(1)));
        case Value::Kind::folder: return " -x -a '(__fish_complete_directories)'";
        case Value::Kind::text: return " -x";
    }
    return "";
}

std::string fish(const Grammar& grammar) {
    std::string text = fmt::format(
        "# fish completion of {0}. Made by `{0} completion fish`.\ncomplete -c {0} -f\n",
        grammar.name);
    const auto add = [&](const std::string& condition, const OptionGrammar& option) {
        text += fmt::format("complete -c {} -n {}", grammar.name, fish_text(condition));
        if (!option.brief.empty()) text += " -s " + option.brief.substr(1);
        if (option.name.starts_with("--")) text += " -l " + option.name.substr(2);
        text += fish_action(option.value) + " -d " + fish_text(option.description) + "\n";
    };
    for (const auto& option : grammar.options) add("__fish_use_subcommand", option);
    for (const auto& command : grammar.commands) {
        text += fmt::format("complete -c {} -n __fish_use_subcommand -a {} -d {}\n", grammar.name,
                            command.name, fish_text(command.description));
        for (const auto* list : {&command.positionals, &command.options})
            for (const auto& option : *list)
                add("__fish_seen_subcommand_from " + command.name, option);
    }
    return text;
}

}  // namespace

std::string completion(const Grammar& grammar, const std::string& shell) {
    return shell == "bash" ? bash(grammar) : shell == "zsh" ? zsh(grammar) : fish(grammar);
}

}  // namespace elastocheck::reports
