#include "reports/command/grammar.hpp"

#include <sstream>

namespace elastocheck::reports {
namespace {

// The name of the first check that says what to offer; the others only refuse.
std::string offer(CLI::Option& option) {
    for (int k = 0;; ++k) {
        try {
            const std::string& name = option.get_validator(k)->get_name();
            if (name == "folder" || name.starts_with("files ") || name.starts_with("words ")) return name;
        } catch (const CLI::OptionNotFound&) {
            return {};
        }
    }
}

Value value_of(CLI::Option& option) {
    if (option.get_type_size() == 0) return {};
    std::istringstream said(offer(option));
    std::string kind;
    said >> kind;
    Value value{Value::Kind::text, {}, {}};
    if (kind == "folder") value.kind = Value::Kind::folder;
    if (kind == "files") value.kind = Value::Kind::file, said >> value.pattern;
    if (kind == "words") value.kind = Value::Kind::words;
    for (std::string word; said >> word;) value.words.push_back(word);
    return value;
}

OptionGrammar of(CLI::Option& option) {
    OptionGrammar grammar;
    if (!option.get_snames().empty()) grammar.brief = "-" + option.get_snames().front();
    grammar.name = option.get_positional() ? option.get_name(true) : "--" + option.get_lnames().front();
    grammar.value = value_of(option);
    if (grammar.value.kind != Value::Kind::none)
        grammar.value_name = option.get_type_name().substr(0, option.get_type_name().find(':'));
    grammar.description = option.get_description();
    grammar.required = option.get_required();
    grammar.repeated = option.get_items_expected_max() > 1;
    return grammar;
}

std::vector<CLI::Option*> options_of(CLI::App& app) {
    return app.get_options([](CLI::Option* option) { return !option->get_group().empty(); });
}

std::vector<CLI::App*> shown_commands(CLI::App& app) {
    return app.get_subcommands([](CLI::App* command) { return !command->get_group().empty(); });
}

}  // namespace

Grammar grammar(CLI::App& app) {
    Grammar all{.name = app.get_name(), .description = app.get_description(), .footer = app.get_footer()};
    for (auto* option : options_of(app)) all.options.push_back(of(*option));
    for (auto* command : shown_commands(app)) {
        CommandGrammar one{.name = command->get_name(), .description = command->get_description()};
        for (auto* option : options_of(*command))
            (option->get_positional() ? one.positionals : one.options).push_back(of(*option));
        all.commands.push_back(std::move(one));
    }
    return all;
}

void name_values(CLI::App& app) {
    for (auto* command : shown_commands(app))
        for (auto* option : options_of(*command)) {
            const Value value = value_of(*option);
            if (value.kind == Value::Kind::file) option->type_name("FILE");
            if (value.kind == Value::Kind::folder) option->type_name("FOLDER");
            if (value.kind == Value::Kind::words) option->type_name("WORD");
        }
}

}  // namespace elastocheck::reports
