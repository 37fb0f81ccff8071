#include "tests/mutation/anchor.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace elastocheck::mutation {

namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

// The end of the comment, string or character literal at `i`, or `i` where none begins. An
// apostrophe inside a number separates digits.
std::size_t literal_end(std::string_view text, std::size_t i) {
    const auto to = [&](std::string_view end) {
        const std::size_t found = text.find(end, i + 2);
        return found == text.npos ? text.size() : found + end.size();
    };
    if (text.substr(i, 2) == "/*") return to("*/");
    if (text.substr(i, 2) == "//") return std::min(text.find('\n', i), text.size());
    if (text.substr(i, 2) == "R\"") {
        const std::size_t open = std::min(text.find('(', i), text.size());
        std::string end(1, ')');
        return to(end.append(text.substr(i + 2, open - i - 2)).append("\""));
    }
    const bool separates_digits = text[i] == '\'' && i > 0 && is_word(text[i - 1]);
    if ((text[i] != '"' && text[i] != '\'') || separates_digits) return i;
    for (std::size_t k = i + 1; k < text.size(); ++k) {
        if (text[k] == '\\')
            ++k;
        else if (text[k] == text[i])
            return k + 1;
    }
    return text.size();
}

bool is_comment(std::string_view text, std::size_t i) {
    return text.substr(i, 2) == "/*" || text.substr(i, 2) == "//";
}

// The text with comments and the contents of literals blanked, character for character.
std::string structure(std::string_view text) {
    std::string plain(text);
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t end = literal_end(text, i);
        std::fill(plain.begin() + static_cast<std::ptrdiff_t>(i),
                  plain.begin() + static_cast<std::ptrdiff_t>(end), ' ');
        i = std::max(end, i + 1);
    }
    return plain;
}

std::size_t skip_space(std::string_view plain, std::size_t i) {
    while (i < plain.size() && is_space(plain[i])) ++i;
    return i;
}

// Behind the bracket that closes the one at `i`.
std::size_t closed(std::string_view plain, std::size_t i) {
    int depth = 0;
    for (; i < plain.size(); ++i) {
        depth += plain[i] == '(' || plain[i] == '{' || plain[i] == '[';
        depth -= plain[i] == ')' || plain[i] == '}' || plain[i] == ']';
        if (depth == 0) return i + 1;
    }
    return i;
}

std::string_view word_before(std::string_view plain, std::size_t i) {
    while (i > 0 && is_space(plain[i - 1])) --i;
    std::size_t begin = i;
    while (begin > 0 && is_word(plain[begin - 1])) --begin;
    return plain.substr(begin, i - begin);
}

char character_before(std::string_view plain, std::size_t i) {
    while (i > 0 && is_space(plain[i - 1])) --i;
    return i > 0 ? plain[i - 1] : '\0';
}

// Is the word at `i` a member that is accessed through a pointer?
bool is_member_access(std::string_view plain, std::size_t i) {
    while (i > 0 && is_space(plain[i - 1])) --i;
    return i > 1 && plain.substr(i - 2, 2) == "->";
}

// The end of the body that follows a function's parameters or a struct's name at `i`, or 0 for a
// declaration or a call: between them stand only qualifiers, a return type, bases or initialisers.
std::size_t body_end(std::string_view plain, std::size_t i) {
    for (; i < plain.size(); ++i) {
        const char c = plain[i];
        if (c == '(') {
            i = closed(plain, i) - 1;
        } else if (c == '{') {
            const std::size_t end = closed(plain, i), next = skip_space(plain, end);
            const bool initialises_member =
                next < plain.size() && (plain[next] == ',' || plain[next] == '{');
            if (!initialises_member) return end;
            i = end - 1;
        } else if (!is_word(c) && !is_space(c) &&
                   std::string_view("<>:,&*-").find(c) == std::string_view::npos) {
            return 0;
        }
    }
    return 0;
}

// The end of the initialised variable whose value begins at `i`.
std::size_t variable_end(std::string_view plain, std::size_t i) {
    while (i < plain.size() && plain[i] != ';') {
        if (plain[i] == '(' || plain[i] == '{' || plain[i] == '[')
            i = closed(plain, i);
        else if (plain[i] == ')' || plain[i] == '}')
            return 0;  // a default argument, or an enumerator
        else
            ++i;
    }
    return std::min(i + 1, plain.size());
}

// `text` without comments and white space; `at` receives the position of each character left.
std::string squeezed(std::string_view text, std::vector<std::size_t>& at) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t end = std::max(literal_end(text, i), i + 1);
        if (!is_comment(text, i))
            for (std::size_t k = i; k < end; ++k) {
                if (is_space(text[k])) continue;
                result += text[k];
                at.push_back(k);
            }
        i = end;
    }
    return result;
}

}  // namespace

std::vector<Range> definitions(std::string_view text, std::string_view name) {
    const std::string plain = structure(text);
    constexpr std::array kinds{"struct", "class", "enum", "union"};
    constexpr std::array no_types{"namespace", "return",    "else", "throw",
                                  "case",      "co_return", "new",  "not"};
    std::vector<Range> result;
    for (std::size_t i = plain.find(name); i != plain.npos; i = plain.find(name, i + 1)) {
        const std::size_t behind = i + name.size();
        if ((i > 0 && is_word(plain[i - 1])) || (behind < plain.size() && is_word(plain[behind])))
            continue;
        const std::string_view word = word_before(plain, i);
        const char before = character_before(plain, i);
        const std::size_t next = skip_space(plain, behind);
        if (next >= plain.size()) break;
        std::size_t end = 0;
        const bool is_after_type =
            (!word.empty() && !std::ranges::count(no_types, word)) ||
            (std::string_view(">&*:~").find(before) != std::string_view::npos &&
             !is_member_access(plain, i));
        if (std::ranges::count(kinds, word)) {
            end = body_end(plain, behind);
        } else if (is_after_type && plain[next] == '(') {
            end = body_end(plain, next);
        } else if (is_after_type && (plain[next] == '=' || plain[next] == '{') &&
                   plain[next + 1] != '=') {
            end = variable_end(plain, next);
        }
        if (end > 0) result.push_back({i, end});
    }
    return result;
}

std::vector<Range> occurrences(std::string_view text, Range range, std::string_view expression) {
    std::vector<std::size_t> at, ignored;
    const std::string inside = squeezed(text.substr(range.begin, range.end - range.begin), at);
    const std::string wanted = squeezed(expression, ignored);
    std::vector<Range> result;
    if (wanted.empty()) return result;
    for (std::size_t i = inside.find(wanted); i != inside.npos; i = inside.find(wanted, i + 1)) {
        const std::size_t begin = range.begin + at[i];
        const std::size_t end = range.begin + at[i + wanted.size() - 1] + 1;
        const bool cuts_word = (is_word(wanted.front()) && begin > 0 && is_word(text[begin - 1])) ||
                               (is_word(wanted.back()) && end < text.size() && is_word(text[end]));
        if (!cuts_word) result.push_back({begin, end});
    }
    return result;
}

}  // namespace elastocheck::mutation
