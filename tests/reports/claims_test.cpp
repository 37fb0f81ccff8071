// Claims about the command in claims/*.claims: lines of shell, and what they print.
//
//   # a claim                begins; its lines run in a new folder
//   $ elastocheck new x      a line of shell; $S is models/scenes, $C the folder of the claims
//   exit 2                   exit code of each of the lines of shell above; without this line 0
//   out part, no out part    of standard output; `no out` alone: nothing
//   err part, no err part    of standard error, likewise
//
// An empty line ends a group of lines of shell with what is expected of each. Parts are `unescaped`.
#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/reports/command.hpp"
#include "tests/support/escapes.hpp"

namespace elastocheck {
namespace {

struct Step {
    std::vector<std::string> shell;
    int code = 0;
    Parts parts = {};
    bool no_out = false, no_err = false;
};
struct Claim {
    std::string place, text;  // "solve.claims:12"
    std::vector<Step> steps = {};
};
void PrintTo(const Claim& claim, std::ostream* out) { *out << claim.place; }

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
        " && C=" ELASTOCHECK_CLAIMS
        " && elastocheck() { env -u CI -u GITHUB_STEP_SUMMARY " ELASTOCHECK_COMMAND
        " \"$@\"; } && { ";
    for (const Step& step : GetParam().steps)
        for (const auto& line : step.shell) {
            SCOPED_TRACE(GetParam().place + ": " + line);
            const Said said =
                expect_said(support::says(begin + line + "\n}"), step.code, step.parts);
            EXPECT_TRUE(!step.no_out || said.out.empty()) << said.out;
            EXPECT_TRUE(!step.no_err || said.err.empty()) << said.err;
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

INSTANTIATE_TEST_SUITE_P(Line, Claims, testing::ValuesIn(claims_in("line.claims")), name_of);
INSTANTIATE_TEST_SUITE_P(Inspect, Claims, testing::ValuesIn(claims_in("inspect.claims")), name_of);
INSTANTIATE_TEST_SUITE_P(Mistakes, Claims, testing::ValuesIn(claims_in("mistakes.claims")),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Loads, Claims, testing::ValuesIn(claims_in("loads.claims")), name_of);
INSTANTIATE_TEST_SUITE_P(Solve, Claims, testing::ValuesIn(claims_in("solve.claims")), name_of);
INSTANTIATE_TEST_SUITE_P(AtWheel, Claims, testing::ValuesIn(claims_in("at_wheel.claims")), name_of);
INSTANTIATE_TEST_SUITE_P(Import, Claims, testing::ValuesIn(claims_in("import.claims")), name_of);
INSTANTIATE_TEST_SUITE_P(Compare, Claims, testing::ValuesIn(claims_in("compare.claims")), name_of);

}  // namespace
}  // namespace elastocheck
