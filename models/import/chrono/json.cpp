#include "models/import/chrono/json.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::chrono {
namespace {

using reader::Value;

class Parser {
  public:
    Parser(std::string_view text, const std::string& file)
        : text_(text), file_(file), line_end_(text.find('\n') == text.npos ? '\r' : '\n') {}

    Value whole() {
        Value root = value(0);
        skip();
        if (!text_.empty()) fail("text after the end of the document");
        return root;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { reader::fail(file_, line_, "", what); }
    [[noreturn]] void expected(const char* what) const {
        if (text_.empty()) fail(fmt::format("the file ends, expected {}", what));
        fail(fmt::format(
            "expected {}, found {}", what,
            reader::quote(text_.substr(0, std::min<std::size_t>(text_.find('\n'), 20)))));
    }

    void advance(std::size_t n) {
        line_ += static_cast<int>(
            std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(n), line_end_));
        text_.remove_prefix(n);
    }

    void skip() {
        for (;;) {
            const std::size_t n = std::min(text_.find_first_not_of(" \t\r\n"), text_.size());
            advance(n);
            if (text_.starts_with("//")) {
                advance(std::min(text_.find(line_end_), text_.size()));
            } else if (text_.starts_with("/*")) {
                const std::size_t end = text_.find("*/", 2);
                if (end == text_.npos) fail("a comment /* is not closed");
                advance(end + 2);
            } else {
                return;
            }
        }
    }

    bool take(char c) {
        skip();
        if (text_.empty() || text_.front() != c) return false;
        text_.remove_prefix(1);
        return true;
    }

    // Decodes the simple escapes only; names and numbers of a suspension contain no others.
    std::string string() {
        if (!take('"')) expected("a string in double quotes");
        std::string result;
        for (;;) {
            if (text_.empty() || text_.front() == '\n') fail("a string is not closed");
            const char c = text_.front();
            if (static_cast<unsigned char>(c) < 0x20) fail("a control character in a string");
            text_.remove_prefix(1);
            if (c == '"') return result;
            if (c != '\\') {
                result += c;
                continue;
            }
            if (text_.empty()) fail("a string is not closed");
            const char escaped = text_.front();
            if (std::string_view("\"\\/bfnrtu").find(escaped) == std::string_view::npos)
                fail("an unknown escape sequence in a string");
            result += escaped == '"' || escaped == '\\' || escaped == '/' ? escaped : '?';
            text_.remove_prefix(1);
        }
    }

    Value value(int depth) {
        if (depth > deepest_json)
            fail(fmt::format("nested more than {} levels deep", deepest_json));
        skip();
        Value result{.kind = Value::Kind::scalar, .line = line_};
        if (text_.empty()) expected("a value");
        const char c = text_.front();
        if (c == '{') {
            text_.remove_prefix(1);
            result.kind = Value::Kind::map;
            if (take('}')) return result;
            do {
                skip();
                const int line = line_;
                std::string key = string();
                if (!take(':')) expected("a colon");
                if (std::ranges::find(result.keys, key) != result.keys.end())
                    fail(fmt::format("{} is given twice", reader::quote(key)));
                if (result.keys.size() > 1000) fail("more than 1000 keys in one object");
                Value item = value(depth + 1);
                item.line = line;
                result.keys.push_back(std::move(key));
                result.items.push_back(std::move(item));
            } while (take(','));
            if (!take('}')) expected("a comma or }");
            return result;
        }
        if (c == '[') {
            text_.remove_prefix(1);
            result.kind = Value::Kind::list;
            if (take(']')) return result;
            do result.items.push_back(value(depth + 1));
            while (take(','));
            if (!take(']')) expected("a comma or ]");
            return result;
        }
        if (c == '"') {
            result.text = string();
            result.is_string = true;
            return result;
        }
        const std::size_t n = std::min(text_.find_first_of(" \t\r\n,]}/:"), text_.size());
        result.text = text_.substr(0, n);
        if (result.text == "null") {
            result.kind = Value::Kind::nothing;
            result.text.clear();
        } else if (result.text != "true" && result.text != "false" &&
                   (n == 0 || (c != '-' && (c < '0' || c > '9')) ||
                    result.text.find_first_not_of("0123456789+-.eE") != std::string::npos)) {
            expected("a value");
        }
        text_.remove_prefix(n);
        return result;
    }

    std::string_view text_;
    const std::string& file_;
    char line_end_;  // CR alone, LF, or CR LF
    int line_ = 1;
};

}  // namespace

Value parse_json(std::string_view text, const std::string& file) {
    if (text.size() > largest_json)
        reader::fail(file, 0, "", "larger than 1 MiB, the limit for a suspension");
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.find('\0') != text.npos || !reader::is_utf8(text))
        reader::fail(file, 0, "", "not plain text (UTF-8): this is not JSON");
    return Parser(text, file).whole();
}

}  // namespace elastocheck::importer::chrono
