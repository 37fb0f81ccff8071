// Grammar of the command line in the form that shell completion and the manual print.
#pragma once

#include <string>
#include <vector>

#include "reports/command/grammar/command.hpp"
#include "reports/command/grammar/parse.hpp"

namespace elastocheck::reports {

struct OptionGrammar {
    std::string brief, name;  // "-o", "--output"; for a positional "", "SCENE"
    std::string value_name;   // "FOLDER"; empty for a flag
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
    std::vector<CommandGrammar> commands = {};  // without the hidden ones
};

Grammar grammar(const Program& program, const std::vector<Command>& commands);

// Type name of a value in --help: FILE, FOLDER, WORD, TEXT.
std::string value_name(const Value& value);

}  // namespace elastocheck::reports
