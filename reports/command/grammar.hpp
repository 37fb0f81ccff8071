// What the command line takes, read off the CLI::App that parses it and prints --help: the one source of shell completion
// and of the manual.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace elastocheck::reports {

// What may stand for a value (arguments.hpp).
struct Value {
    enum class Kind { none, text, file, folder, words };
    Kind kind = Kind::none;  // none: of a flag
    std::string pattern;     // of a file: "*.yaml"
    std::vector<std::string> words;
};

struct OptionGrammar {
    std::string brief, name;  // "-o", "--output"; of a positional "", "SCENE"
    std::string value_name;   // "FOLDER"; empty of a flag
    std::string description;
    Value value;
    bool required = false, repeated = false;
};

struct CommandGrammar {
    std::string name, description;
    std::vector<OptionGrammar> positionals = {}, options = {};
};

struct Grammar {
    std::string name, description, footer;
    std::vector<OptionGrammar> options = {};
    std::vector<CommandGrammar> commands = {};  // but those that are not shown
};

Grammar grammar(CLI::App& app);

// Calls what is to be given for an option in --help what it is: FILE, FOLDER, WORD.
void name_values(CLI::App& app);

}  // namespace elastocheck::reports
