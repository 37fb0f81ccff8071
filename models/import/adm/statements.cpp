#include "models/import/adm/statements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::importer::adm {
namespace {

using reader::is_blank, reader::is_digit, reader::trimmed;

// All keywords of a dataset, to resolve abbreviations.
constexpr std::string_view keywords[] = {
    "ACCGRAV", "ADAMS",        "ARRAY",    "BEAM",        "BUSHING",    "CONTACT",
    "CONTROL", "COSIM",        "COUPLER",  "CURVE",       "CVCV",       "DEACTIVATE",
    "DEBUG",   "DIFF",         "END",      "EQUILIBRIUM", "EXECUTION",  "FE_LOAD",
    "FE_NODE", "FE_PART",      "FIELD",    "FLEX_BODY",   "FRICTION",   "GCON",
    "GEAR",    "GFORCE",       "GRAPHICS", "GSE",         "IC",         "INCLUDE",
    "INFO",    "INTEGRATOR",   "JOINT",    "JPRIM",       "KINEMATICS", "LINEAR",
    "LIST",    "LSE",          "LSSOLVER", "MARKER",      "MATERIAL",   "MATRIX",
    "MFORCE",  "MODE",         "MOTION",   "NFORCE",      "OUTPUT",     "PART",
    "PINPUT",  "POINT_MASS",   "POUTPUT",  "PREFERENCES", "PTCV",       "PTSF",
    "REQUEST", "RESULTS",      "SECTION",  "SENSOR",      "SFORCE",     "SOLVER",
    "SPLINE",  "SPRINGDAMPER", "STRING",   "SURFACE",     "TFSISO",     "TIRE",
    "UCON",    "UNITS",        "VARIABLE", "VFORCE",      "VTORQUE",    "WHEEL"};

bool is_letter(char c) { return reader::is_letter(c) || c == '_'; }
bool is_name(char c) { return reader::is_word(c); }

// Words that an abbreviation can mean: the exact match alone, else all that begin with it.
std::vector<std::string_view> meant(std::string_view beginning,
                                    std::span<const std::string_view> words) {
    std::vector<std::string_view> found;
    for (const std::string_view word : words) {
        if (word == beginning) return {word};
        if (word.starts_with(beginning)) found.push_back(word);
    }
    return found;
}

std::vector<std::string> strings(const std::vector<std::string_view>& words) {
    return {words.begin(), words.end()};
}

// The name in a comment adams_view_name='...'.
std::optional<std::string> view_name(std::string_view comment) {
    constexpr std::string_view key = "adams_view_name='";
    const auto begin = comment.find(key);
    if (begin == comment.npos) return std::nullopt;
    comment.remove_prefix(begin + key.size());
    return std::string(comment.substr(0, comment.find('\'')));
}

struct Reading {
    Dataset& data;
    std::string name = {};      // of the next statement
    bool goes_on = false;       // the line before ended with "&"
    bool in_statement = false;  // a continuation is allowed

    [[noreturn]] void fail(const std::string& what) const {
        reader::fail(data.file, data.last_line, "", what);
    }

    void begin(std::string_view line) {
        std::size_t n = 0;
        while (n < line.size() && is_letter(line[n])) ++n;
        std::size_t slash = n;
        while (slash < line.size() && is_blank(line[slash])) ++slash;
        if (n == 0 || slash == line.size() || line[slash] != '/')
            fail(
                fmt::format("expected a statement KEYWORD/..., a line that begins with a comma, or "
                            "a comment, found {}",
                            reader::quote(line)));
        const std::string word = capitals(line.substr(0, n));
        const auto found = meant(word, keywords);
        if (found.size() > 1)
            fail(fmt::format("{} is ambiguous: {}", reader::quote(word), fmt::join(found, " or ")));
        if (found.empty())
            fail(fmt::format(
                "{} is not a statement of a dataset{}", reader::quote(word),
                reader::did_you_mean(word, strings({std::begin(keywords), std::end(keywords)}),
                                     "there are")));
        if (data.statements.size() == most_statements)
            fail(fmt::format("more than {} statements", most_statements));
        Statement statement;
        statement.keyword = found[0];
        statement.name = std::exchange(name, {});
        statement.line = data.last_line;
        line = trimmed(line.substr(slash + 1));
        std::size_t digits = 0;
        while (digits < line.size() && is_digit(line[digits])) ++digits;
        if (digits > 0) {
            const auto [end, error] =
                std::from_chars(line.data(), line.data() + digits, statement.id);
            if (error != std::errc{})
                fail(fmt::format("{} is too large for an id",
                                 reader::quote(line.substr(0, digits))));
            line.remove_prefix(digits);
        }
        line = trimmed(line);
        if (!line.empty() && line.front() == ',')
            line.remove_prefix(1);
        else if (digits > 0 && !line.empty())
            fail(fmt::format("expected a comma after the id {}, found {}", statement.id,
                             reader::quote(line)));
        statement.rest = line;
        data.statements.push_back(std::move(statement));
        in_statement = true;
    }

    void read(std::string_view line) {
        if (const auto mark = line.find('!'); mark != line.npos) {
            if (auto found = view_name(line.substr(mark))) name = std::move(*found);
            line = line.substr(0, mark);
        }
        line = trimmed(line);
        if (line.empty()) return;
        const bool continued = std::exchange(goes_on, line.ends_with('&'));
        if (goes_on) line = trimmed(line.substr(0, line.size() - 1));
        if (line.starts_with(',') || continued) {
            if (!in_statement) fail("continuation line without a statement before it");
            if (line.starts_with(',')) line.remove_prefix(1);
            Statement& statement = data.statements.back();
            statement.rest += '\n';
            statement.rest += line;
            return;
        }
        begin(line);
    }
};

}  // namespace

SourceLocation Statement::place() const {
    return {line, fmt::format("{}/{}{}", keyword, id ? std::to_string(id) : "",
                              name.empty() ? "" : fmt::format(" '{}'", reader::shown(name)))};
}

Dataset read_statements(std::string_view text, const std::string& file) {
    Dataset data;
    data.file = file;
    if (text.size() > largest_dataset)
        reader::fail(
            file, 0, "",
            fmt::format("larger than {} MiB, the limit for a dataset", largest_dataset >> 20));
    Reading reading{data};
    for (reader::Lines lines(text); lines.next();) {
        const std::string_view line = lines.line();
        data.last_line = lines.number();
        if (data.last_line == 1) {
            if (line.find('\0') != line.npos) reading.fail("a NUL byte: this is not a dataset");
            data.title = trimmed(line);
            continue;
        }
        const std::string_view word = trimmed(line.substr(0, line.find('!')));
        if (capitals(word) == "END" || capitals(word) == "END/") {
            data.has_end = true;
            break;
        }
        reading.read(line);
    }
    if (data.statements.empty())
        reader::fail(file, data.last_line, "", "no statement: this is not a dataset");
    return data;
}

void fail(const std::string& file, const Statement& at, const std::string& what) {
    reader::fail(file, at.line, at.place().what, what);
}

std::size_t number_at(std::string_view text, double& value, bool& is_in_degrees) {
    std::size_t n = 0;
    std::string digits;  // in the format of from_chars
    is_in_degrees = false;
    if (n < text.size() && (text[n] == '+' || text[n] == '-')) {
        if (text[n] == '-') digits += '-';
        ++n;
    }
    bool any = false;
    for (bool point = false; n < text.size() && (is_digit(text[n]) || (text[n] == '.' && !point));
         ++n) {
        if (text[n] == '.') point = true;
        any |= is_digit(text[n]);
        digits += text[n];
    }
    if (!any) return 0;
    if (n < text.size() && (text[n] == 'E' || text[n] == 'e' || text[n] == 'D' || text[n] == 'd')) {
        std::size_t k = n + 1;
        if (k < text.size() && (text[k] == '+' || text[k] == '-')) ++k;
        const std::size_t first = k;
        while (k < text.size() && is_digit(text[k])) ++k;
        if (k > first) {
            digits += 'e';
            for (std::size_t l = n + 1; l < k; ++l)
                if (text[l] != '+') digits += text[l];
            n = k;
        }
    }
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) value = std::numeric_limits<double>::infinity();
    if (n < text.size() && (text[n] == 'D' || text[n] == 'd') &&
        (n + 1 == text.size() || !is_name(text[n + 1]))) {
        is_in_degrees = true;
        ++n;
    }
    return n;
}

// ---- Arguments, from left to right; text before `at` is consumed.

namespace {

struct Scanner {
    const std::string& file;
    const Statement& statement;
    const Shape& shape;
    std::string_view text;

    [[noreturn]] void fail(const std::string& what) const { adm::fail(file, statement, what); }
    void skip_blanks() {
        while (!text.empty() && (is_blank(text.front()) || text.front() == '\n'))
            text.remove_prefix(1);
    }
    void skip_separators() {
        while (!text.empty() && (is_blank(text.front()) || text.front() == '\n' ||
                                 text.front() == ',' || text.front() == '\\'))
            text.remove_prefix(1);
    }
    // The word at the beginning, and whether "=" follows.
    static std::string_view word(std::string_view rest, bool& assigns) {
        std::size_t n = 0;
        if (n < rest.size() && is_letter(rest[n]))
            while (n < rest.size() && is_name(rest[n])) ++n;
        std::size_t k = n;
        while (k < rest.size() && is_blank(rest[k])) ++k;
        assigns = n > 0 && k < rest.size() && rest[k] == '=';
        return rest.substr(0, n);
    }
    bool is_flag(std::string_view name) const {
        return !name.empty() && !meant(capitals(name), shape.flags).empty();
    }

    // Whether another argument begins here, after a comma or on a new line of a complete
    // expression.
    bool is_argument(std::string_view rest) const {
        while (!rest.empty() &&
               (is_blank(rest.front()) || rest.front() == ',' || rest.front() == '\n'))
            rest.remove_prefix(1);
        bool assigns = false;
        const std::string_view name = word(rest, assigns);
        if (assigns) return true;
        rest = trimmed(rest.substr(name.size()));
        return is_flag(name) && (rest.empty() || rest.front() == ',' || rest.front() == '\n');
    }

    std::string expression() {
        std::string result;
        int depth = 0;
        for (; !text.empty(); text.remove_prefix(1)) {
            const char c = text.front();
            if (c == '\\' || (depth == 0 && c == ',')) break;
            if (c == '\n') {
                if (depth == 0 && is_argument(text)) break;
                continue;
            }
            depth += c == '(' ? 1 : c == ')' ? -1 : 0;
            if (depth < 0)
                fail(fmt::format("{}: a closing bracket without an opening one",
                                 reader::quote(result)));
            result += c;
        }
        if (depth > 0) fail(fmt::format("{}: a bracket is not closed", reader::quote(result)));
        return std::string(trimmed(result));
    }

    std::vector<std::string> values() {
        std::vector<std::string> list;
        skip_blanks();
        for (bool more = true; more;) {
            std::size_t n = 0;
            while (n < text.size() && text[n] != ',' && text[n] != ':' && text[n] != '\n' &&
                   text[n] != '\\')
                ++n;
            list.emplace_back(trimmed(text.substr(0, n)));
            text.remove_prefix(n);
            more = false;
            if (text.empty() || text.front() == '\\') break;
            if (text.front() == ':') {
                text.remove_prefix(1);
                more = true;
                continue;
            }
            // After a comma and/or a new line the following text is a value if it is a number.
            std::string_view rest = text;
            if (rest.front() == ',') rest.remove_prefix(1);
            while (!rest.empty() && (is_blank(rest.front()) || rest.front() == '\n'))
                rest.remove_prefix(1);
            double ignored = 0;
            bool degrees = false;
            if (number_at(rest, ignored, degrees) == 0) break;
            text = rest;
            more = true;
        }
        return list;
    }
};

}  // namespace

Arguments::Arguments(const std::string& file, const Statement& statement, const Shape& shape)
    : file_(&file), statement_(&statement) {
    std::vector<std::string_view> names = shape.values;
    names.insert(names.end(), shape.expressions.begin(), shape.expressions.end());
    Scanner scanner{file, statement, shape, statement.rest};
    for (scanner.skip_separators(); !scanner.text.empty(); scanner.skip_separators()) {
        bool assigns = false;
        const std::string_view written = Scanner::word(scanner.text, assigns);
        if (written.empty())
            fail(fmt::format("expected an argument, found {}",
                             reader::quote(trimmed(scanner.text.substr(0, 80)))));
        const std::string name = capitals(written);
        const auto& allowed = assigns ? names : shape.flags;
        const auto found = meant(name, allowed);
        if (found.size() > 1)
            fail(fmt::format("{} is ambiguous: {}", reader::quote(name), fmt::join(found, " or ")));
        if (found.empty())
            fail(fmt::format("{} is not a known {} of this statement{}", reader::quote(name),
                             assigns ? "argument" : "flag",
                             reader::did_you_mean(name, strings(allowed), "known")));
        if (find(found[0])) fail(fmt::format("{} is given twice", found[0]));
        Argument argument;
        argument.name = found[0];
        argument.is_flag = !assigns;
        scanner.text.remove_prefix(written.size());
        if (assigns) {
            scanner.text.remove_prefix(scanner.text.find('=') + 1);
            if (std::ranges::find(shape.expressions, found[0]) != shape.expressions.end())
                argument.values = {scanner.expression()};
            else
                argument.values = scanner.values();
        }
        if (statement.arguments.size() == arguments_.size())
            statement.arguments.emplace_back(found[0], false);
        arguments_.push_back(std::move(argument));
    }
}

void Arguments::fail(const std::string& what) const { adm::fail(*file_, *statement_, what); }

const Argument* Arguments::find(std::string_view name) const {
    const auto found = std::ranges::find(arguments_, name, &Argument::name);
    return found == arguments_.end() ? nullptr : &*found;
}

void Arguments::mark_read(std::string_view name) const {
    for (auto& [argument, is_read] : statement_->arguments) is_read |= argument == name;
}

const Argument* Arguments::taken(std::string_view name) const {
    mark_read(name);
    return find(name);
}

bool Arguments::has(std::string_view name) const {
    const Argument* argument = find(name);
    if (argument && argument->is_flag) mark_read(name);
    return argument != nullptr;
}

std::vector<std::string> Arguments::flags() const {
    std::vector<std::string> result;
    for (const Argument& argument : arguments_)
        if (argument.is_flag) {
            mark_read(argument.name);
            result.push_back(argument.name);
        }
    return result;
}

double Arguments::read(const Argument& argument, const std::string& text, bool is_angle) const {
    double value = 0;
    bool degrees = false;
    if (number_at(text, value, degrees) != text.size() || text.empty())
        fail(fmt::format("{}: {} is not a number", argument.name, reader::quote(text)));
    if (!std::isfinite(value) || std::abs(value) > 1e30)
        fail(fmt::format("{}: {} is out of range; allowed: up to 1e30 in size", argument.name,
                         reader::quote(text)));
    if (degrees && !is_angle)
        fail(fmt::format("{}: {} is in degrees, but the argument is not an angle", argument.name,
                         reader::quote(text)));
    return degrees ? value * std::numbers::pi / 180 : value;
}

std::string Arguments::word(std::string_view name) const {
    const Argument* argument = taken(name);
    return argument && !argument->values.empty() ? capitals(argument->values[0]) : "";
}

std::vector<int> Arguments::ids(std::string_view name) const {
    std::vector<int> result;
    if (const Argument* argument = taken(name))
        for (const std::string& text : argument->values) {
            int id = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
            if (error != std::errc{} || end != text.data() + text.size() || id <= 0)
                fail(fmt::format("{}: {} is not an id; allowed: whole numbers above zero", name,
                                 reader::quote(text)));
            result.push_back(id);
        }
    return result;
}

int Arguments::id(std::string_view name) const {
    const auto all = ids(name);
    if (all.size() > 1) fail(fmt::format("{}: {} ids, expected one", name, all.size()));
    return all.empty() ? 0 : all[0];
}

std::vector<double> Arguments::list(std::string_view name, std::size_t least, std::size_t most,
                                    bool angles) const {
    const Argument* argument = taken(name);
    std::vector<double> result;
    if (!argument) return result;
    if (argument->values.size() < least || argument->values.size() > most)
        fail(fmt::format(
            "{}: {} numbers, expected {}", name, argument->values.size(),
            least == most ? std::to_string(least) : fmt::format("{} to {}", least, most)));
    for (const std::string& text : argument->values)
        result.push_back(read(*argument, text, angles));
    return result;
}

double Arguments::number(std::string_view name, double missing) const {
    const auto one = list(name, 1, 1, false);
    return one.empty() ? missing : one[0];
}
double Arguments::angle(std::string_view name, double missing) const {
    const auto one = list(name, 1, 1, true);
    return one.empty() ? missing : one[0];
}
std::vector<double> Arguments::numbers(std::string_view name, std::size_t least,
                                       std::size_t most) const {
    return list(name, least, most, false);
}
std::vector<double> Arguments::angles(std::string_view name, std::size_t count) const {
    return list(name, count, count, true);
}

const std::string* Arguments::expression(std::string_view name) const {
    const Argument* argument = taken(name);
    return argument && !argument->values.empty() ? &argument->values[0] : nullptr;
}

}  // namespace elastocheck::importer::adm
