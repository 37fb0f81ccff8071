#include "reports/command/grammar/grammar.hpp"

namespace elastocheck::reports {
namespace {

// Description of an option's variable for completion and the manual: value, name of the value,
// repeatability.
struct Describer {
    OptionGrammar& option;

    void describe(Value value, const std::string& name, bool repeated = false) const {
        option.value = std::move(value);
        option.value_name = name;
        option.repeated = repeated;
    }
    void operator()(const Flag&) const { describe({Value::Kind::none, {}, {}}, ""); }
    void operator()(const Text& text) const { describe(text.value, value_name(text.value)); }
    void operator()(const TextList& list) const {
        describe(list.value, value_name(list.value), list.form != TextList::Form::repeated);
    }
    void operator()(const Integer&) const { describe({}, "INT"); }
    void operator()(const IntegerList&) const { describe({}, "INT", true); }
    void operator()(const RealNumber&) const { describe({}, "FLOAT"); }
    void operator()(const Settings*) const { describe({}, "PATH=VALUE"); }
};

OptionGrammar of(const Option& option) {
    OptionGrammar grammar;
    const auto comma = option.names.find(',');
    if (comma != option.names.npos) grammar.brief = option.names.substr(0, comma);
    grammar.name = comma == option.names.npos ? option.names : option.names.substr(comma + 1);
    grammar.description = option.description;
    grammar.required = option.required;
    std::visit(Describer{grammar}, option.target);
    return grammar;
}

OptionGrammar flag(const std::string& brief, const std::string& name,
                   const std::string& description) {
    OptionGrammar grammar;
    grammar.brief = brief, grammar.name = name, grammar.description = description;
    grammar.value.kind = Value::Kind::none;
    return grammar;
}

}  // namespace

std::string value_name(const Value& value) {
    switch (value.kind) {
        case Value::Kind::none: return "";
        case Value::Kind::text: return "TEXT";
        case Value::Kind::file: return "FILE";
        case Value::Kind::folder: return "FOLDER";
        case Value::Kind::words:
        case Value::Kind::similar_words: return "WORD";
    }
    return "";
}

Grammar grammar(const Program& program, const std::vector<Command>& commands) {
    Grammar all{.name = program.name, .description = program.description, .footer = program.footer};
    const OptionGrammar help = flag("-h", "--help", help_help);
    all.options = {flag("", "--version", version_help), help};
    for (const auto& command : commands) {
        if (command.hidden) continue;
        CommandGrammar one{
            .name = command.name, .description = command.description, .options = {help}};
        for (const auto& option : command.options)
            (option.names.starts_with("-") ? one.options : one.positionals).push_back(of(option));
        all.commands.push_back(std::move(one));
    }
    return all;
}

}  // namespace elastocheck::reports
