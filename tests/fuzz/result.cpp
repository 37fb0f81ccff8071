#include <algorithm>
#include <array>

#include "reports/json/json_cursor.hpp"
#include "reports/page/report/report.hpp"
#include "reports/text/escape.hpp"
#include "tests/fuzz/targets.hpp"

namespace elastocheck::fuzz {
namespace {

// Nothing in a CSV file that a spreadsheet would compute: numbers begin with a sign, words that do are no words.
void expect_no_formula(std::string_view file, std::string_view csv) {
    bool quoted = false, begins = true;
    for (std::size_t k = 0; k < csv.size(); ++k) {
        const char c = csv[k], next = k + 1 < csv.size() ? csv[k + 1] : ',';
        const bool digit =
            (next >= '0' && next <= '9') || next == '.' || next == 'i' || next == 'n';
        if (begins && (c == '=' || c == '@' || ((c == '+' || c == '-') && !digit)))
            throw Fault(std::string(file) + ": a formula: " + std::string(csv.substr(k, 80)));
        if (c == '"') quoted = !quoted;
        begins =
            c == ';' || (!quoted && (c == ',' || c == '\n')) || (begins && (c == '"' || c == ' '));
    }
}

}  // namespace

void expect_plain(std::string_view what, std::string_view text) {
    std::string one_line(text);
    std::ranges::replace(one_line, '\n', ' ');
    if (const std::string wrong = reports::flaw(one_line); !wrong.empty())
        throw Fault(std::string(what) + ": " + wrong);
}

void result(std::string_view input) {
    try {
        const auto document = reports::parse_result(input, "fuzz.json");
        for (const auto& [name, content] : reports::report_texts(document, "fuzz.json")) {
            expect_plain("the name of a file", name);
            if (name.find('/') != name.npos) throw Fault("a file outside its folder: " + name);
            expect_plain(name, content);
            if (name.ends_with(".csv")) expect_no_formula(name, content);
        }
    } catch (const reports::ResultError& error) {
        if (!std::string_view(error.what()).starts_with("fuzz.json: "))
            throw Fault(std::string("a refusal without a place: ") + error.what());
    }
}

}  // namespace elastocheck::fuzz
