#include "reports/text/escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "models/reader/document/characters.hpp"

namespace elastocheck::reports {
namespace {

using reader::Character, reader::first_character;

// Starts a spreadsheet formula at the beginning of a cell; the last four are the full-width forms.
bool begins_formula(char32_t code) {
    return code == '=' || code == '+' || code == '-' || code == '@' || code == 0xFF1D ||
           code == 0xFF0B || code == 0xFF0D || code == 0xFF20;
}

// The entity of HTML and XML for a character of markup, else null.
const char* entity_of(char32_t code) {
    return code == '&'   ? "&amp;"
           : code == '<' ? "&lt;"
           : code == '>' ? "&gt;"
           : code == '"' ? "&quot;"
                         : nullptr;
}

// Replaces every character by the result of `put`.
template <class Put>
std::string translated(std::string_view text, Put&& put) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Character c = first_character(text);
        result += put(c);
        text.remove_prefix(c.bytes.size());
    }
    return result;
}

bool is_number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double ignored = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ignored);
    return error == std::errc() && end == text.data() + text.size();
}

constexpr std::string_view stand_in = "\uFFFD";  // for characters that cannot be displayed

}  // namespace

std::string flaw(std::string_view text) {
    while (!text.empty()) {
        const Character c = first_character(text);
        const auto code = static_cast<unsigned>(c.code);
        if (!c.valid) return fmt::format("byte {:#04x} is not UTF-8", code);
        if (c.control()) return fmt::format("it has the control character U+{:04X}", code);
        if (c.turns_writing())
            return fmt::format("it has U+{:04X}, which changes the direction of writing", code);
        text.remove_prefix(c.bytes.size());
    }
    return "";
}

std::string for_terminal(std::string_view text) {
    return translated(text, [](const Character& c) -> std::string {
        if (c.plain()) return std::string(c.bytes);
        const auto code = static_cast<unsigned>(c.code);
        if (c.code == '\n') return "\\n";
        return c.code < 0x100 ? fmt::format("\\x{:02x}", code) : fmt::format("\\x{{{:x}}}", code);
    });
}

std::string for_html(std::string_view text) {
    return translated(text, [](const Character& c) -> std::string {
        if (!c.plain()) return std::string(c.code == '\n' || c.code == '\t' ? " " : stand_in);
        if (const char* entity = entity_of(c.code)) return entity;
        return c.code == '\'' ? "&apos;" : std::string(c.bytes);
    });
}

std::string for_script(std::string_view json) {
    std::string text;
    for (const char c : json)
        if (c == '<')
            text += "\\u003c";
        else
            text += c;
    return text;
}

std::string for_markdown(std::string_view text) {
    // At the start of a line "- x", "+ x", "1. x" would be lists, "---" and "===" rules.
    const std::size_t leading_digits = std::min(text.find_first_not_of("0123456789"), text.size());
    const std::size_t first_repeated =
        std::min(text.find_first_not_of(text.substr(0, 1)), text.size());
    const auto is_blank = [&](std::size_t at) {
        return at >= text.size() || text[at] == ' ' || text[at] == '\t';
    };
    return translated(text, [&](const Character& c) -> std::string {
        if (!c.plain())
            return std::string(c.code == '\n' || c.code == '\r' || c.code == '\t' ? " " : stand_in);
        const auto at = static_cast<std::size_t>(c.bytes.data() - text.data());
        const bool bullet_or_rule = at == 0 && (c.code == '-' || c.code == '+' || c.code == '=') &&
                                    is_blank(first_repeated) && text.size() > 1;
        const bool numbered =
            at == leading_digits && at > 0 && (c.code == '.' || c.code == ')') && is_blank(at + 1);
        const bool link = (c.code == ':' && text.substr(at).starts_with("://")) ||
                          (c.code == '.' && at >= 3 && text.substr(at - 3, 3) == "www");
        const bool markup =
            std::string_view("\\`*_[]<>#|~&$").find(c.bytes) != std::string_view::npos;
        return fmt::format("{}{}", markup || bullet_or_rule || numbered || link ? "\\" : "",
                           c.bytes);
    });
}

std::string for_csv(std::string_view text) {
    // `begins`: start of a cell, also after a comma or a semicolon, the separator of some programs
    bool quoted = false, begins = !is_number(text);
    std::string field = translated(text, [&](const Character& c) -> std::string {
        if (!c.plain()) return " ";
        quoted = quoted || c.code == ',' || c.code == '"' || c.code == ';';
        const bool formula = begins && begins_formula(c.code);
        begins = c.code == ';' || c.code == ',' || (begins && (c.code == ' ' || c.code == '"'));
        return (formula ? "'" : "") + (c.code == '"' ? std::string(R"("")") : std::string(c.bytes));
    });
    return quoted ? fmt::format("\"{}\"", field) : field;
}

std::string for_xml(std::string_view text) {
    return translated(text, [](const Character& c) -> std::string {
        if (const char* entity = entity_of(c.code)) return entity;
        return c.plain() || c.code == '\n' ? std::string(c.bytes) : "?";
    });
}

std::string for_github(std::string_view text) {
    return translated(text, [](const Character& c) -> std::string {
        if (c.code == '\n') return "%0A";
        if (c.code == '\r') return "%0D";
        if (!c.plain()) return "?";
        return c.code == '%' ? "%25" : std::string(c.bytes);
    });
}

std::string for_github_property(std::string_view text) {
    return translated(for_github(text), [](const Character& c) -> std::string {
        return c.code == ':' ? "%3A" : c.code == ',' ? "%2C" : std::string(c.bytes);
    });
}

std::string for_shell(std::string_view text) {
    const bool plain = !text.empty() && text.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyz"
                                            "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                            "-_./=,:+@%") == text.npos;
    if (plain) return std::string(text);
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string(R"('\'')") : std::string(1, c);
    return quoted + "'";
}

}  // namespace elastocheck::reports
