#include "models/import/adm/statements.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

#include "adm_embedded.hpp"  // generated: text of dataset.yaml
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::adm {
namespace {

using reader::is_blank, reader::is_digit, reader::trimmed;

// The next word of a list, which is removed from it.
std::string_view next_word(std::string_view& list) {
    const std::string_view word = list.substr(0, list.find(' '));
    list.remove_prefix(std::min(word.size() + 1, list.size()));
    return word;
}

const std::vector<std::string>& keywords() {
    static const std::vector<std::string> all = [] {
        std::set<std::string> words{"END", "FRICTION"};
        for (const char* table : {"arguments", "without_equivalent"})
            for (const std::string& word : dataset_table(table).keys) words.insert(word);
        for (const char* table : {"without_effect", "if_used"})
            for (std::string_view list = dataset_table(table).text; !list.empty();)
                words.emplace(next_word(list));
        return std::vector<std::string>(words.begin(), words.end());
    }();
    return all;
}

// The one word that an abbreviation means. `kind` and `label` complete the message.
std::string_view resolved(std::string_view word, const std::vector<std::string>& words,
                          std::string_view kind, const char* label, const auto& fail) {
    const auto found = matches(word, words);
    if (found.size() > 1)
        fail(fmt::format("{} is ambiguous: {}", reader::quote(word), fmt::join(found, " or ")));
    if (found.empty())
        fail(fmt::format("{} is not a {}{}", reader::quote(word), kind,
                         reader::did_you_mean(word, words, label)));
    return found[0];
}

bool is_letter(char c) { return reader::is_letter(c) || c == '_'; }
bool is_in(char c, std::string_view set) { return set.find(c) != set.npos; }

// Number of characters from `from` on that are of a kind.
std::size_t length(std::string_view text, std::size_t from, const auto& is_of_kind) {
    const auto end =
        std::find_if_not(text.begin() + static_cast<std::ptrdiff_t>(from), text.end(), is_of_kind);
    return static_cast<std::size_t>(end - text.begin()) - from;
}
// Removes blanks and the characters `also` from the beginning.
void skip(std::string_view& text, std::string_view also) {
    text.remove_prefix(length(text, 0, [&](char c) { return is_blank(c) || is_in(c, also); }));
}

// Splits a dataset into statements, line by line.
struct LineReader {
    Dataset& data;
    const std::string& file;
    std::string name = {};      // of the next statement
    bool continues = false;     // the line before ended with "&"
    bool in_statement = false;  // a continuation is allowed

    [[noreturn]] void fail(const std::string& what) const {
        reader::fail(file, data.last_line, "", what);
    }

    void begin(std::string_view line) {
        const std::size_t n = length(line, 0, is_letter), slash = n + length(line, n, is_blank);
        if (n == 0 || slash == line.size() || line[slash] != '/')
            fail(
                "expected a statement KEYWORD/..., a line that begins with a comma, or a "
                "comment, found " +
                reader::quote(line));
        Statement s{.file = file, .line = data.last_line};
        s.keyword = resolved(capitals(line.substr(0, n)), keywords(), "statement of a dataset",
                             "there are", [&](const std::string& what) { fail(what); });
        if (data.statements.size() == max_statements)
            fail(fmt::format("more than {} statements", max_statements));
        s.name = std::exchange(name, {});
        line = trimmed(line.substr(slash + 1));
        const std::size_t digits = length(line, 0, is_digit);
        if (digits > 0 &&
            std::from_chars(line.data(), line.data() + digits, s.id).ec != std::errc{})
            fail(fmt::format("{} is too large for an id", reader::quote(line.substr(0, digits))));
        line = trimmed(line.substr(digits));
        if (line.starts_with(','))
            line.remove_prefix(1);
        else if (digits > 0 && !line.empty())
            fail(fmt::format("expected a comma after the id {}, found {}", s.id,
                             reader::quote(line)));
        s.rest = line;
        data.statements.push_back(std::move(s));
        in_statement = true;
    }

    void read(std::string_view line) {
        constexpr std::string_view before_name = "adams_view_name='";
        const auto mark = std::min(line.find('!'), line.size());
        if (const auto at = line.find(before_name, mark); at != line.npos) {
            const std::string_view named = line.substr(at + before_name.size());
            name = named.substr(0, named.find('\''));
        }
        line = trimmed(line.substr(0, mark));
        if (line.empty()) return;
        const bool continued = std::exchange(continues, line.ends_with('&'));
        if (continues) line = trimmed(line.substr(0, line.size() - 1));
        if (!line.starts_with(',') && !continued) return begin(line);
        if (!in_statement) fail("continuation line without a statement before it");
        if (line.starts_with(',')) line.remove_prefix(1);
        (data.statements.back().rest += '\n') += line;
    }
};

}  // namespace

std::vector<std::string_view> matches(std::string_view beginning,
                                      const std::vector<std::string>& words) {
    std::vector<std::string_view> found;
    for (const std::string& word : words) {
        if (word == beginning) return {word};
        if (word.starts_with(beginning)) found.push_back(word);
    }
    return found;
}

bool has_word(std::string_view list, std::string_view word) {
    while (!list.empty())
        if (const auto next = next_word(list); next.substr(0, next.find('=')) == word) return true;
    return false;
}

const reader::Value& dataset_table(std::string_view table) {
    static const reader::Value file = reader::parse_yaml(embedded_adm[0].text, "dataset.yaml");
    return *entry(file, table);
}

std::string form_of(std::string_view keyword) {
    const reader::Value* form = entry(dataset_table("arguments"), keyword);
    if (!form) form = entry(dataset_table("used"), keyword);
    if (!form) return "";
    return keyword == "JOINT" ? form->text + " " + dataset_table("friction").text : form->text;
}

Role role_of(std::string_view keyword) {
    if (entry(dataset_table("arguments"), keyword)) return Role::converted;
    if (has_word(dataset_table("if_used").text, keyword)) return Role::if_used;
    if (has_word(dataset_table("without_effect").text, keyword)) return Role::without_effect;
    return keyword == "FRICTION" ? Role::friction : Role::missing;
}

SourceLocation Statement::place() const {
    return {line, fmt::format("{}/{}{}", keyword, id ? std::to_string(id) : "",
                              name.empty() ? "" : fmt::format(" '{}'", reader::shown(name)))};
}

void Statement::fail(const std::string& what) const {
    reader::fail(std::string(file), line, place().what, what);
}

Dataset read_statements(std::string_view text, const std::string& file) {
    Dataset data;
    LineReader reading{data, file};
    for (reader::Lines lines(text); lines.next();) {
        const std::string_view line = lines.line();
        data.last_line = lines.number();
        if (data.last_line == 1) {
            if (line.find('\0') != line.npos) reading.fail("a NUL byte: this is not a dataset");
            data.title = trimmed(line);
            continue;
        }
        const std::string word = capitals(trimmed(line.substr(0, line.find('!'))));
        data.has_end = word == "END" || word == "END/";
        if (data.has_end) break;
        reading.read(line);
    }
    if (data.statements.empty()) reading.fail("no statement: this is not a dataset");
    return data;
}

std::size_t number_at(std::string_view text, double& value, bool& is_in_degrees) {
    const auto is_at = [&](std::size_t n, std::string_view set) {
        return n < text.size() && is_in(text[n], set);
    };
    const std::size_t sign = is_at(0, "+-") ? 1 : 0, whole = length(text, sign, is_digit);
    std::size_t n = sign + whole, fraction = 0;
    if (is_at(n, ".")) n += 1 + (fraction = length(text, n + 1, is_digit));
    is_in_degrees = false;
    if (whole + fraction == 0) return 0;
    std::string digits(text.substr(sign, n - sign));  // in the format of from_chars
    if (is_at(n, "EeDd")) {
        const std::size_t signed_at = n + 1, first = signed_at + (is_at(signed_at, "+-") ? 1 : 0),
                          count = length(text, first, is_digit);
        if (count > 0) {
            digits += is_at(signed_at, "-") ? "e-" : "e";
            digits += text.substr(first, count);
            n = first + count;
        }
    }
    const auto end = digits.data() + digits.size();
    if (std::from_chars(digits.data(), end, value).ec == std::errc::result_out_of_range)
        value = std::numeric_limits<double>::infinity();
    if (is_at(0, "-")) value = -value;
    is_in_degrees = is_at(n, "Dd") && (n + 1 == text.size() || !reader::is_word(text[n + 1]));
    return n + (is_in_degrees ? 1 : 0);
}

// ---- Arguments, from left to right; text that was read is removed.

namespace {

struct ArgumentScanner {
    const Statement& statement;
    std::string form = form_of(statement.keyword);
    std::vector<std::string> flags = {}, names = {};
    std::string_view text = statement.rest;

    explicit ArgumentScanner(const Statement& s) : statement(s) {
        for (std::string_view rest = form; !rest.empty();) {
            const std::string_view word = next_word(rest), name = word.substr(0, word.find('='));
            (name == word ? flags : names).emplace_back(name);
        }
    }

    // The word at the beginning; sets whether "=" follows.
    static std::string_view word(std::string_view rest, bool& assigns) {
        const bool begins = !rest.empty() && is_letter(rest[0]);
        const std::size_t n = begins ? length(rest, 0, reader::is_word) : 0,
                          k = n + length(rest, n, is_blank);
        assigns = n > 0 && k < rest.size() && rest[k] == '=';
        return rest.substr(0, n);
    }

    // Whether another argument begins here, after a comma or on a new line of a complete expression.
    bool is_argument(std::string_view rest) const {
        skip(rest, ",\n");
        bool assigns = false;
        const std::string_view name = word(rest, assigns);
        if (assigns) return true;
        rest = trimmed(rest.substr(name.size()));
        return !name.empty() && !matches(capitals(name), flags).empty() &&
               (rest.empty() || is_in(rest.front(), ",\n"));
    }

    std::string expression() {
        std::string result;
        int depth = 0;
        for (; !text.empty(); text.remove_prefix(1)) {
            const char c = text.front();
            if (c == '\\' || (depth == 0 && (c == ',' || (c == '\n' && is_argument(text))))) break;
            if (c == '\n') continue;
            depth += c == '(' ? 1 : c == ')' ? -1 : 0;
            if (depth < 0)
                statement.fail("{}: a closing bracket without an opening one",
                               reader::quote(result));
            result += c;
        }
        if (depth > 0) statement.fail("{}: a bracket is not closed", reader::quote(result));
        return std::string(trimmed(result));
    }

    std::vector<std::string> values() {
        std::vector<std::string> list;
        skip(text, "\n");
        for (;;) {
            const std::size_t n = std::min(text.find_first_of(",:\n\\"), text.size());
            list.emplace_back(trimmed(text.substr(0, n)));
            text.remove_prefix(n);
            if (text.empty() || text.front() == '\\') return list;
            if (text.front() == ':') {
                text.remove_prefix(1);
                continue;
            }
            // After a comma and/or a new line the following text is a value if it is a number.
            std::string_view rest = text;
            if (rest.front() == ',') rest.remove_prefix(1);
            skip(rest, "\n");
            double ignored = 0;
            bool degrees = false;
            if (number_at(rest, ignored, degrees) == 0) return list;
            text = rest;
        }
    }

    void read(std::vector<Argument>& arguments) {
        form = " " + form + " ";
        for (skip(text, "\n,\\"); !text.empty(); skip(text, "\n,\\")) {
            bool assigns = false;
            const std::string_view written = word(text, assigns);
            if (written.empty())
                statement.fail("expected an argument, found {}",
                               reader::quote(trimmed(text.substr(0, 80))));
            Argument argument{
                .name = std::string(resolved(
                    capitals(written), assigns ? names : flags,
                    assigns ? "known argument of this statement" : "known flag of this statement",
                    "known", [&](const auto& what) { statement.fail(what); }))};
            if (std::ranges::find(arguments, argument.name, &Argument::name) != arguments.end())
                statement.fail("{} is given twice", argument.name);
            text.remove_prefix(assigns ? text.find('=') + 1 : written.size());
            if (assigns && form.find(" " + argument.name + "=f ") != form.npos) {
                argument.kind = Argument::Kind::expression;
                argument.values = {expression()};
            } else if (assigns) {
                argument.kind = Argument::Kind::values;
                argument.values = values();
            }
            arguments.push_back(std::move(argument));
        }
    }
};

}  // namespace

const Argument* Statement::find(std::string_view argument) const {
    if (!arguments) ArgumentScanner(*this).read(arguments.emplace());
    const auto found = std::ranges::find(*arguments, argument, &Argument::name);
    return found == arguments->end() ? nullptr : &*found;
}

const Argument* Statement::mark_read(std::string_view argument) const {
    const Argument* found = find(argument);
    if (found) found->is_read = true;
    return found;
}

bool Statement::has(std::string_view argument) const {
    const Argument* found = find(argument);
    if (found && found->kind == Argument::Kind::flag) found->is_read = true;
    return found != nullptr;
}

std::vector<std::string> Statement::flags() const {
    find("");
    std::vector<std::string> result;
    for (const Argument& argument : *arguments)
        if (argument.kind == Argument::Kind::flag && has(argument.name))
            result.push_back(argument.name);
    return result;
}

std::string Statement::word(std::string_view argument) const {
    const Argument* found = mark_read(argument);
    return found && !found->values.empty() ? capitals(found->values[0]) : "";
}

std::vector<int> Statement::ids(std::string_view argument) const {
    std::vector<int> result;
    if (const Argument* found = mark_read(argument))
        for (const std::string& text : found->values) {
            int number = 0;
            const auto* const last = text.data() + text.size();
            const auto [end, error] = std::from_chars(text.data(), last, number);
            if (error != std::errc{} || end != last || number <= 0)
                fail("{}: {} is not an id; allowed: whole numbers above zero", argument,
                     reader::quote(text));
            result.push_back(number);
        }
    return result;
}

int Statement::id_of(std::string_view argument) const {
    const auto all = ids(argument);
    if (all.size() > 1) fail("{}: {} ids, expected one", argument, all.size());
    return all.empty() ? 0 : all[0];
}

std::vector<double> Statement::numbers(std::string_view argument, std::size_t least,
                                       std::size_t most, Unit unit) const {
    const Argument* found = mark_read(argument);
    std::vector<double> result;
    if (!found) return result;
    if (found->values.size() < least || found->values.size() > most)
        fail("{}: {} numbers, expected {}", argument, found->values.size(),
             least == most ? std::to_string(least) : fmt::format("{} to {}", least, most));
    for (const std::string& text : found->values) {
        double value = 0;
        bool degrees = false;
        if (number_at(text, value, degrees) != text.size() || text.empty())
            fail("{}: {} is not a number", argument, reader::quote(text));
        if (!std::isfinite(value) || std::abs(value) > 1e30)
            fail("{}: {} is out of range; allowed: up to 1e30 in size", argument,
                 reader::quote(text));
        if (degrees && unit != Unit::angle)
            fail("{}: {} is in degrees, but the argument is not an angle", argument,
                 reader::quote(text));
        result.push_back(degrees ? value * std::numbers::pi / 180 : value);
    }
    return result;
}

double Statement::number(std::string_view argument, double missing, Unit unit) const {
    const auto given = numbers(argument, 1, 1, unit);
    return given.empty() ? missing : given[0];
}

const std::string* Statement::expression(std::string_view argument) const {
    const Argument* found = mark_read(argument);
    return found && !found->values.empty() ? &found->values[0] : nullptr;
}

}  // namespace elastocheck::importer::adm
