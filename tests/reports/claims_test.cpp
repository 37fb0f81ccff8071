// Claims about the command in claims/*.claims: lines of shell, and what they print.
//
//   # a claim                begins; its lines run in a new folder
//   $ elastocheck new x      a line of shell; $S is models/scenes, $C the folder of the
//                            claims, $T that of the tests, $E the program with the environment as it is
//   exit 2                   exit code of each of the lines of shell above; without this line 0
//   out part, no out part    of standard output; `no out` alone: nothing
//   err part, no err part    of standard error, likewise
//   value numbers/0/value ~ 32.5 1e-4   of the JSON document on standard output: a cell of a table (row
//       by its number or its first cell, column by its number or name), another value of a result as
//       verdict/grade, or /a/b/c of the document; a last key `size` is the number of values there.
//       Relations: = JSON or text; ~ NUMBER TOLERANCE; < NUMBER; > NUMBER; has TEXT; matches EXPRESSION
//
// An empty line ends a group of lines of shell with what is expected of each. Parts are `unescaped`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/reports/command.hpp"
#include "tests/support/escapes.hpp"

namespace elastocheck {
namespace {

using nlohmann::json;

struct ExpectedValue {
    std::string place, relation, expected;
};
struct Step {
    std::vector<std::string> shell;
    int code = 0;
    Parts parts = {};
    bool no_out = false, no_err = false;
    std::vector<ExpectedValue> values = {};
};
struct Claim {
    std::string place, text;  // "solve.claims:12"
    std::vector<Step> steps = {};
};
void PrintTo(const Claim& claim, std::ostream* out) { *out << claim.place; }

ExpectedValue value_in(const std::string& line) {
    std::smatch found;
    if (!std::regex_match(line, found, std::regex("(.+?) (=|~|<|>|has|matches) (.*)")))
        throw std::runtime_error("no relation in: value " + line);
    return {found[1], found[2], support::unescaped(found[3].str())};
}

// Position of a row or column by its number, or by what `name` reads from it.
template <class Name>
std::size_t position(const json& list, const std::string& key, Name name) {
    if (key.find_first_not_of("0123456789") == key.npos) return std::stoul(key);
    return static_cast<std::size_t>(std::ranges::find(list, json(key), name) - list.begin());
}

// Throws json::exception or std::out_of_range where nothing is there.
json value_at(const json& document, const std::string& place) {
    if (place.ends_with("/size"))
        return value_at(document, place.substr(0, place.size() - 5)).size();
    if (place.starts_with('/')) return document.at(json::json_pointer(place));
    const auto keys = parts_of(place, '/');
    for (const json& result : document.at("scenes").at(0).at("results")) {
        if (result.contains(keys[0])) return result.at(json::json_pointer("/" + place));
        if (!result.at("tables").contains(keys[0])) continue;
        const json& table = result["tables"][keys[0]];
        json part = table.at("rows");
        if (keys.size() > 1)
            part =
                json(part).at(position(part, keys[1], [](const json& row) { return row.at(0); }));
        if (keys.size() > 2)
            part = json(part).at(position(table.at("columns"), keys[2],
                                          [](const json& column) { return column.at("name"); }));
        return part;
    }
    throw std::out_of_range("no result has " + place);
}

bool holds(const json& value, const std::string& relation, const std::string& expected) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (relation == "has") return contains(text, expected);
    if (relation == "matches") return std::regex_search(text, std::regex(expected));
    if (relation == "=") return text == expected || value == json::parse(expected, nullptr, false);
    if (!value.is_number()) return false;
    std::istringstream numbers(expected);
    double number = std::nan(""), tolerance = std::nan("");
    numbers >> number >> tolerance;
    const double is = value;
    return relation == "<"   ? is < number
           : relation == ">" ? is > number
                             : std::abs(is - number) <= tolerance;
}

void expect_values(const std::string& out, const std::vector<ExpectedValue>& values) {
    const json document = json::parse(out, nullptr, false);
    for (const auto& [place, relation, expected] : values) try {
            const json value = value_at(document, place);
            EXPECT_TRUE(holds(value, relation, expected))
                << place << " is " << value << ", not " << relation << " " << expected;
        } catch (const std::exception& error) {
            ADD_FAILURE() << place << ": " << error.what() << "\n" << out.substr(0, 2000);
        }
}

std::vector<Claim> claims_in(const std::string& file) {
    std::vector<Claim> claims;
    std::ifstream lines(ELASTOCHECK_CLAIMS "/" + file);
    std::string line;
    bool ended = true;
    for (int n = 1; std::getline(lines, line); ++n) {
        const auto space = line.find(' ', line.starts_with("no ") ? 3 : 0);
        const std::string mark = line.substr(0, space),
                          rest = space == line.npos ? "" : line.substr(space + 1);
        if (mark == "#") {
            claims.push_back({file + ":" + std::to_string(n), rest});
        } else if (mark.empty()) {
            ended = true;
        } else if (mark == "$") {
            if (std::exchange(ended, false)) claims.back().steps.emplace_back();
            claims.back().steps.back().shell.push_back(rest);
        } else {
            Step& step = claims.back().steps.back();
            const std::map<std::string, std::vector<std::string>*> parts{
                {"out", &step.parts.out},
                {"err", &step.parts.err},
                {"no out", &step.parts.not_out},
                {"no err", &step.parts.not_err}};
            if (mark == "exit")
                step.code = std::stoi(rest);
            else if (line == "no out")
                step.no_out = true;
            else if (line == "no err")
                step.no_err = true;
            else if (mark == "value")
                step.values.push_back(value_in(rest));
            else
                parts.at(mark)->push_back(support::unescaped(rest));
        }
    }
    if (claims.empty()) throw std::runtime_error(file + ": no claim in it");
    return claims;
}

class Claims : public testing::TestWithParam<Claim> {};

TEST_P(Claims, Hold) {
    const Folder folder;
    const std::string begin =
        "cd " + folder.path.string() + " && S=" + scenes +
        " && C=" ELASTOCHECK_CLAIMS " && T=$C/../.. && E=" ELASTOCHECK_COMMAND
        " && elastocheck() { env -u CI -u GITHUB_ACTIONS -u GITHUB_STEP_SUMMARY $E \"$@\"; } && { ";
    for (const Step& step : GetParam().steps)
        for (const auto& line : step.shell) {
            SCOPED_TRACE(GetParam().place + ": " + line);
            const RunResult said =
                expect_result(support::shell(begin + line + "\n}"), step.code, step.parts);
            EXPECT_TRUE(!step.no_out || said.out.empty()) << said.out;
            EXPECT_TRUE(!step.no_err || said.err.empty()) << said.err;
            if (!step.values.empty()) expect_values(said.out, step.values);
        }
}

// "Typing errors are answered" -> "TypingErrorsAreAnswered"
std::string name_of(const testing::TestParamInfo<Claim>& claim) {
    std::string name;
    bool begins = true;
    for (const char c : claim.param.text) {
        const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (letter)
            name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        begins = !letter;
    }
    return name;
}

#define ELASTOCHECK_CLAIMS_IN(Suite, file) \
    INSTANTIATE_TEST_SUITE_P(Suite, Claims, testing::ValuesIn(claims_in(file ".claims")), name_of)
ELASTOCHECK_CLAIMS_IN(CommandLine, "line");
ELASTOCHECK_CLAIMS_IN(Inspect, "inspect");
ELASTOCHECK_CLAIMS_IN(Mistakes, "mistakes");
ELASTOCHECK_CLAIMS_IN(Loads, "loads");
ELASTOCHECK_CLAIMS_IN(Solve, "solve");
ELASTOCHECK_CLAIMS_IN(SpringsAtWheels, "at_wheel");
ELASTOCHECK_CLAIMS_IN(Import, "import");
ELASTOCHECK_CLAIMS_IN(Points, "points");
ELASTOCHECK_CLAIMS_IN(Reader, "reader");
ELASTOCHECK_CLAIMS_IN(Compare, "compare");
ELASTOCHECK_CLAIMS_IN(Design, "design");
ELASTOCHECK_CLAIMS_IN(Judge, "judge");
ELASTOCHECK_CLAIMS_IN(MeasuredPoints, "measured");
ELASTOCHECK_CLAIMS_IN(Sensitivity, "sensitivity");
ELASTOCHECK_CLAIMS_IN(RedundantJoints, "redundant");
ELASTOCHECK_CLAIMS_IN(Axles, "axles");
ELASTOCHECK_CLAIMS_IN(NightlyAxles, "nightly_axles");
ELASTOCHECK_CLAIMS_IN(ReportOptions, "running");
ELASTOCHECK_CLAIMS_IN(Gate, "gate");
ELASTOCHECK_CLAIMS_IN(OutputSafety, "safety");
ELASTOCHECK_CLAIMS_IN(LivePage, "live");
ELASTOCHECK_CLAIMS_IN(Interruptions, "ended");
ELASTOCHECK_CLAIMS_IN(Outcomes, "outcomes");

}  // namespace
}  // namespace elastocheck
