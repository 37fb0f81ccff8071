#include "reports/command/grammar/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "reports/command/grammar/parse.hpp"
#include "reports/files/subprocess.hpp"

namespace elastocheck::reports {
namespace {

constexpr const char* bash =
    R"sh(# bash completion of elastocheck. Made by `elastocheck completion bash`.
_elastocheck() {
    local word=${COMP_WORDS[COMP_CWORD]} offers
    [ "$word" != = ] || word= # --option=value comes as three words
    offers=$("$1" complete "${COMP_LINE:0:COMP_POINT}" 2>/dev/null)
    case $offers in
    # Folders to walk through, and the files of a pattern.
    :folders) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$word") ;;
    :files*)
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X "!${offers#:files }" -- "$word")
        ;;
    *) mapfile -t COMPREPLY < <(compgen -W "$(sed 's/  .*//' <<< "$offers")" -- "$word") ;;
    esac
}
complete -F _elastocheck elastocheck
)sh";

constexpr const char* zsh = R"sh(#compdef elastocheck
# zsh completion of elastocheck. Made by `elastocheck completion zsh`.
_elastocheck() {
    local -a offers
    offers=("${(@f)$($words[1] complete "${(j: :)words[1,CURRENT]}" 2>/dev/null)}")
    compset -P '*='
    case $offers[1] in
    :folders) _files -/ ;;
    :files*) _files -g "${offers[1]#:files }" ;;
    *)
        offers=("${(@)offers//:/\\:}")
        offers=("${(@)offers/  /:}")
        _describe elastocheck offers
        ;;
    esac
}
if [ "$funcstack[1]" = _elastocheck ]; then
    _elastocheck "$@"
else
    compdef _elastocheck elastocheck
fi
)sh";

constexpr const char* fish =
    R"sh(# fish completion of elastocheck. Made by `elastocheck completion fish`.
function __elastocheck_offers
    set -l token (commandline -ct)
    set -l words (commandline -opc)
    set -l offers ($words[1] complete (commandline -cp) 2>/dev/null)
    set -l before (string match -r -- '^--[^=]*=' $token)
    switch "$offers[1]"
        case ':folders'
            __fish_complete_directories $token
        case ':files *'
            __fish_complete_suffix (string replace ':files *' '' -- $offers[1])
        case '*'
            for offer in $offers
                echo "$before"(string replace '  ' \t -- $offer)
            end
    end
end
complete -c elastocheck -f -a '(__elastocheck_offers)'
)sh";

using Offers = std::vector<std::pair<std::string, std::string>>;  // words and descriptions

void add_names(Offers& list, const std::string& names, const std::string& description) {
    for (std::size_t from = 0; from < names.size();) {
        const std::size_t to = std::min(names.find(',', from), names.size());
        list.emplace_back(names.substr(from, to - from), description);
        from = to + 1;
    }
}

std::string text_of(const Offers& list) {
    std::string text;
    for (const auto& [word, description] : list)
        text += word + (description.empty() ? "" : "  " + description) + "\n";
    return text;
}

std::string text_of(const Value& value) {
    switch (value.kind) {
        case Value::Kind::words:
        case Value::Kind::similar_words: return fmt::format("{}\n", fmt::join(value.words, "\n"));
        case Value::Kind::file: return fmt::format(":files {}\n", value.pattern);
        case Value::Kind::folder: return ":folders\n";
        case Value::Kind::none:
        case Value::Kind::text: break;
    }
    return {};
}

bool has_name(const Option& option, const std::string& name) {
    return name.starts_with('-') && ("," + option.names + ",").find("," + name + ",") != name.npos;
}

}  // namespace

std::string completion(const std::string& shell) {
    return shell == "bash" ? bash : shell == "zsh" ? zsh : fish;
}

std::string offers(const std::vector<Command>& commands, const std::string& line) {
    std::vector<std::string> words;
    try {
        words = words_of(line + "x");  // the last word may be empty
    } catch (const std::invalid_argument&) {
        return {};  // within quotes
    }
    words.back().pop_back();
    if (const auto equals = words.back().find('=');
        words.back().starts_with("--") && equals != std::string::npos) {
        words.push_back(words.back().substr(equals + 1));
        words[words.size() - 2].resize(equals);
    }
    const std::string word = words.back(), before = words.size() > 1 ? words[words.size() - 2] : "";
    words.pop_back();
    const auto given =
        std::ranges::find_if(words.begin() + std::min<std::ptrdiff_t>(1, std::ssize(words)),
                             words.end(), [](const std::string& w) { return !w.starts_with('-'); });
    Offers list;
    if (given == words.end()) {
        for (const auto& command : commands)
            if (!command.hidden) list.emplace_back(command.name, command.description);
        add_names(list, version_option, version_help);
        add_names(list, help_option, help_help);
        return text_of(list);
    }
    const auto command = std::ranges::find(commands, *given, &Command::name);
    if (command == commands.end()) return {};
    for (const auto& option : command->options)
        if (has_name(option, before) && value_of(option).kind != Value::Kind::none)
            return text_of(value_of(option));
    for (const auto& option : command->options) {
        if (word.starts_with('-') && option.names.starts_with('-'))
            add_names(list, option.names, option.description);
        if (!word.starts_with('-') && !option.names.starts_with('-'))
            return text_of(value_of(option));
    }
    if (word.starts_with('-')) add_names(list, help_option, help_help);
    return text_of(list);
}

}  // namespace elastocheck::reports
