#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "models/import/chrono/suspension.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::chrono {
namespace {

using reader::Value;

constexpr int deepest_json = 32;

// How far a text was read.
struct Position {
    char line_end;  // LF, or CR where there is none
    int line = 1;
    char last = 0;  // character read
};

// Characters of a text, which move the position.
struct Characters {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    const char* next;
    Position* position;

    const char& operator*() const { return *next; }
    Characters& operator++() {
        position->last = *next++;
        position->line += position->last == position->line_end ? 1 : 0;
        return *this;
    }
    bool operator==(const Characters& other) const { return next == other.next; }
};

// Collects the parser's events into a tree of values.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
  public:
    TreeBuilder(const std::string& file, const Position& position)
        : file_(file), position_(position) {}

    Value root;

    bool null() override { return add({.line = position_.line}); }
    bool boolean(bool value) override { return add_scalar(value ? "true" : "false"); }
    bool number_integer(number_integer_t value) override { return add_number(value); }
    bool number_unsigned(number_unsigned_t value) override { return add_number(value); }
    // The parser hands over the number with the decimal point of the locale.
    bool number_float(number_float_t, const string_t& text) override {
        string_t number = text;
        if (const auto at = number.find_first_not_of("0123456789+-eE"); at != number.npos)
            number[at] = '.';
        return add_number(number);
    }
    bool string(string_t& text) override { return add_scalar(text, true); }
    bool binary(binary_t&) override { return false; }  // not in JSON text
    bool start_object(std::size_t) override { return begin(Value::Kind::map); }
    bool start_array(std::size_t) override { return begin(Value::Kind::list); }
    bool end_object() override { return end(); }
    bool end_array() override { return end(); }
    bool key(string_t& name) override {
        Open& map = open_.back();
        if (std::ranges::find(map.value.keys, name) != map.value.keys.end())
            fail(fmt::format("{} is given twice", reader::quote(name)));
        if (map.value.keys.size() > 1000) fail("more than 1000 keys in one object");
        map.value.keys.push_back(name);
        map.key_line = position_.line;
        return true;
    }
    bool parse_error(std::size_t, const std::string&,
                     const nlohmann::detail::exception& error) override {
        std::string_view what = error.what();  // "[...] parse error at line ...: what is wrong"
        what.remove_prefix(what.find("] ") + 2);
        if (what.starts_with("parse error")) what.remove_prefix(what.find(": ") + 2);
        fail(fmt::format("invalid JSON: {}", what));
    }

  private:
    struct Open {
        Value value;
        int key_line = 0;  // of the last key
    };

    [[noreturn]] void fail(const std::string& what) const {
        reader::fail(file_, position_.line, "", what);
    }
    bool add(Value value) {
        if (open_.empty()) {
            root = std::move(value);
        } else {
            Open& parent = open_.back();
            if (parent.value.kind == Value::Kind::map) value.line = parent.key_line;
            parent.value.items.push_back(std::move(value));
        }
        return true;
    }
    bool add_scalar(std::string text, bool is_string = false, int line = 0) {
        return add({.kind = Value::Kind::scalar,
                    .text = std::move(text),
                    .line = line > 0 ? line : position_.line,
                    .is_string = is_string});
    }
    // The parser has read the character behind the number as well.
    bool add_number(const std::string& text) {
        const bool is_beyond = position_.last == position_.line_end;
        return add_scalar(text, false, position_.line - (is_beyond ? 1 : 0));
    }
    bool add_number(auto value) { return add_number(std::to_string(value)); }
    bool begin(Value::Kind kind) {
        if (open_.size() == deepest_json)
            fail(fmt::format("nested more than {} levels deep", deepest_json));
        open_.push_back({.value = {.kind = kind, .line = position_.line}});
        return true;
    }
    bool end() {
        Value complete = std::move(open_.back().value);
        open_.pop_back();
        return add(std::move(complete));
    }

    const std::string& file_;
    const Position& position_;
    std::vector<Open> open_;
};

Value parse_json(std::string_view text, const std::string& file) {
    if (text.size() > largest_json)
        reader::fail(file, 0, "", "larger than 1 MiB, the limit for a suspension");
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.find('\0') != text.npos || !reader::is_utf8(text))
        reader::fail(file, 0, "", "not plain text (UTF-8): this is not JSON");
    Position position{text.find('\n') == text.npos ? '\r' : '\n'};
    TreeBuilder builder(file, position);
    constexpr bool strict = true, ignore_comments = true;
    nlohmann::json::sax_parse(Characters{text.data(), &position},
                              Characters{text.data() + text.size(), &position}, &builder,
                              nlohmann::json::input_format_t::json, strict, ignore_comments);
    return std::move(builder.root);
}

}  // namespace

JsonFile::JsonFile(std::string_view text, const std::string& file)
    : name(file), tree(parse_json(text, name)), root{&tree, "", &name, &numbers, {}, &accesses} {
    if (tree.kind != Value::Kind::map)
        root.fail("expected an object: this is not a file of Chrono::Vehicle");
}

}  // namespace elastocheck::importer::chrono
