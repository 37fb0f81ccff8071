// A command of the program as data: name, help text, options with the variables that they set, and
// the function that runs it. The parser with its --help (parse.hpp) and the manual page use this
// description.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "elastocheck/read_scene.hpp"

namespace elastocheck::reports {

// --set PATH=VALUE, repeatable: changes numbers of the scene file before it is read.
using Settings = std::vector<Setting>;

// Kind of an option's value. The parser rejects others.
struct Value {
    enum class Kind {
        none,  // a flag without value
        text,
        file,    // no empty name, and not `-`
        folder,  // likewise
        words,   // one of `words`
    };
    Kind kind = Kind::text;
    std::string name = "TEXT";  // in --help
    std::vector<std::string> words = {};
};
inline Value a_file() { return {Value::Kind::file, "FILE", {}}; }
inline Value a_folder() { return {Value::Kind::folder, "FOLDER", {}}; }
inline Value one_of(std::vector<std::string> words) {
    return {Value::Kind::words, "WORD", std::move(words)};
}

// Variables set by options. Each outlives the parsing, usually as a member of a request that `run`
// shares.
struct Flag {
    bool* variable;
};
struct Text {
    std::string* variable;
    Value value = {};
};
struct TextList {
    enum class Form { separate, repeated, commas };  // A B C | --option A --option B | A,B,C
    std::vector<std::string>* variable;
    Form form;
    Value value = {};
};
struct Integer {
    int* variable;
    int low, high;
};
struct IntegerList {  // 10,20,40
    std::vector<int>* variable;
    int low, high;
};
struct RealNumber {  // finite, with a decimal point in any locale
    double* variable;
    double low, high;
};
using Target = std::variant<Flag, Text, TextList, Integer, IntegerList, RealNumber, Settings*>;

struct Option {
    std::string names;  // "-o,--output"; for a positional "SCENE"
    Target target;
    std::string description;
    bool required = false;
};
Value value_of(const Option& option);

struct Command {
    std::string name, description;
    std::vector<Option> options;
    // Returns the exit code; receives the command line as given.
    std::function<int(const std::string& command_line)> run;
    bool hidden = false;  // from --help and the manual
};

// Options shared by several commands.
Option scene_option(std::string& file);                                     // SCENE, required
Option set_option(Settings& settings);                                      // --set
Option json_option(bool& wanted);                                           // --json
Option keep_all_option(bool& wanted);                                       // --keep-all
Option every_option(int& every);                                            // --every
Option output_option(std::string& folder, const std::string& description);  // -o,--output FOLDER

}  // namespace elastocheck::reports
