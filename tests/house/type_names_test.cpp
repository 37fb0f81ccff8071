// A type name stands once in a namespace, anonymous ones included: a search for it leads to one
// definition, and two sources with the same one cannot meet in a unity batch.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

using Places = std::vector<std::string>;
using Definitions = std::map<std::string, Places>;  // of "namespace::Name"

// Adds the structs, classes and enums that a source defines at namespace scope, which starts in
// column 0.
void add_definitions(std::istream& source, const std::string& path, Definitions& definitions) {
    static const std::regex opening(R"(^(?:inline )?namespace ([\w:]*) ?\{)"),
        closing(R"(^\}  // namespace)"),
        definition(R"(^(?:struct|class|enum class) (\w+)(?: final)?(?: : [^;]*)? \{)");
    std::vector<std::string> open;
    std::string line;
    for (int number = 1; std::getline(source, line); ++number) {
        if (line.empty() || std::string_view("nisce}").find(line.front()) == std::string::npos)
            continue;
        std::smatch match;
        if (std::regex_search(line, match, opening)) {
            open.push_back(match[1]);
        } else if (std::regex_search(line, closing) && !open.empty()) {
            open.pop_back();
        } else if (std::regex_search(line, match, definition)) {
            std::string name;
            for (const auto& part : open)
                if (!part.empty()) name += part + "::";
            definitions[name + match[1].str()].push_back(path + ":" + std::to_string(number));
        }
    }
}

std::string joined(const Places& places) {
    std::string text;
    for (const auto& place : places) text += (text.empty() ? "" : ", ") + place;
    return text;
}

TEST(TypeNames, EveryTypeIsDefinedOnceInItsNamespace) {
    const fs::path tree = ELASTOCHECK_ROOT;
    Definitions definitions;
    for (const char* folder : {"include", "models", "recursive", "reference", "compare", "reports"})
        for (const auto& entry : fs::recursive_directory_iterator(tree / folder)) {
            const auto extension = entry.path().extension();
            if (extension != ".cpp" && extension != ".hpp") continue;
            std::ifstream source(entry.path());
            add_definitions(source, fs::relative(entry.path(), tree).generic_string(), definitions);
        }
    EXPECT_GT(definitions.size(), 500u);
    for (const auto& [name, places] : definitions)
        EXPECT_EQ(places.size(), 1u) << name << " is defined at " << joined(places);
}

TEST(TypeNames, DefinitionsAreRecognisedInTheirNamespace) {
    std::istringstream source(
        "namespace elastocheck::compare {\nnamespace {\nstruct Reading {\n};\n"
        "}  // namespace\nenum class Grade { pass, fail };\nstruct Later;\n"
        "}  // namespace elastocheck::compare\nclass Outside final : public Base {\n};\n");
    Definitions definitions;
    add_definitions(source, "file.hpp", definitions);
    EXPECT_EQ(definitions, (Definitions{{"elastocheck::compare::Reading", {"file.hpp:3"}},
                                        {"elastocheck::compare::Grade", {"file.hpp:6"}},
                                        {"Outside", {"file.hpp:9"}}}));
}

}  // namespace
