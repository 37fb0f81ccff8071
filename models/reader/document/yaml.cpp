#include "models/reader/document/yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "elastocheck/read_scene.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/limits.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::reader {
namespace {

int line_of(const YAML::Mark& mark) { return std::max(mark.line, 0) + 1; }

// Collects the parser's events into a tree of values.
class TreeBuilder final : public YAML::EventHandler {
  public:
    TreeBuilder(const std::string& file_name, Syntax syntax)
        : file(file_name),
          is_json(syntax == Syntax::json),
          deepest(is_json ? 32 : deepest_nesting) {}

    Value root;

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (std::exchange(seen_document, true))
            fail_at(mark, "text after the end of the scene; a scene is a single YAML document");
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add({.line = line_of(mark)}); }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
        fail_at(mark, "aliases (*name) are not part of the scene format; repeat the value");
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  const std::string& text) override {
        refuse_tag(mark, tag);
        refuse_unprintable(mark, text);
        add({.kind = Value::Kind::scalar,
             .text = text,
             .line = line_of(mark),
             .is_string = is_json && tag == "!",
             .row = mark.line,
             .column = mark.column});
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {
        begin(Value::Kind::list, mark, tag);
    }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                    YAML::EmitterStyle::value) override {
        begin(Value::Kind::map, mark, tag);
    }
    void OnSequenceEnd() override { end(); }
    void OnMapEnd() override { end(); }

  private:
    // An unfinished list or map, and the key of a map that has no value yet.
    struct Open {
        Value value;
        std::string key{};
        int key_line = 0;                                  // 0: no pending key
        std::unordered_map<std::string, int> key_lines{};  // of all keys so far
    };

    void begin(Value::Kind kind, const YAML::Mark& mark, const std::string& tag) {
        refuse_tag(mark, tag);
        if (expects_key()) fail_at(mark, "a list or map where the name of a field is expected");
        if (open.size() == deepest)
            fail_at(mark, fmt::format("nested more than {} levels deep", deepest));
        open.push_back({.value = {.kind = kind, .line = line_of(mark)}});
    }

    void end() {
        Value complete = std::move(open.back().value);
        open.pop_back();
        add(std::move(complete));
    }

    void add(Value value) {
        if (open.empty()) {
            root = std::move(value);
        } else if (expects_key()) {
            take_key(std::move(value));
        } else {
            Open& parent = open.back();
            if (parent.value.kind == Value::Kind::map) {
                value.line = std::exchange(parent.key_line, 0);
                parent.value.keys.push_back(std::move(parent.key));
            }
            parent.value.items.push_back(std::move(value));
        }
    }

    void take_key(Value value) {
        if (value.kind != Value::Kind::scalar)
            fail(file, value.line, path(), "the name of a field is missing before ':'");
        Open& map = open.back();
        const auto [first, is_new] = map.key_lines.emplace(value.text, value.line);
        if (!is_new)
            fail(file, value.line, path(),
                 fmt::format("{} is given twice, first on line {}", quote(value.text),
                             first->second));
        map.key = std::move(value.text);
        map.key_line = value.line;
    }

    bool expects_key() const {
        return !open.empty() && open.back().value.kind == Value::Kind::map &&
               open.back().key_line == 0;
    }

    void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
        // "?" and "!": yaml-cpp's own tags of plain and quoted scalars
        const bool is_own = tag.empty() || tag == "?" || tag == "!";
        if (!is_own)
            fail_at(mark, fmt::format("tags ({}) are not part of the scene format", quote(tag)));
    }

    // Names from quoted text go into tables, scripts and terminals. yaml-cpp turns some escapes
    // (\N, \_) into bytes that are not UTF-8.
    void refuse_unprintable(const YAML::Mark& mark, const std::string& whole) const {
        std::string_view text = whole;
        while (!text.empty()) {
            const Character c = first_character(text);
            if (!c.valid)
                fail_at(mark, "an escape sequence that is not UTF-8; write the character itself");
            if (c.control()) fail_at(mark, quote(whole) + " is not one line of plain text");
            if (c.turns_writing())
                fail_at(mark, "a character that changes the direction of writing");
            text.remove_prefix(c.bytes.size());
        }
    }

    // The keys from the root to the current position, "joints.ball_joint".
    std::string path() const {
        std::string path;
        for (const Open& level : open)
            if (level.key_line != 0) path = child_path(path, level.key);
        return path;
    }

    [[noreturn]] void fail_at(const YAML::Mark& mark, const std::string& what) const {
        fail(file, line_of(mark), path(), what);
    }

    const std::string& file;
    const bool is_json;
    const std::size_t deepest;
    bool seen_document = false;
    std::vector<Open> open;
};

// yaml-cpp treats some control characters as the end of the text, and reports need valid UTF-8.
void refuse_binary(std::string_view text, const std::string& file) {
    int line = 1;
    for (std::size_t at = 0; at < text.size();) {
        const auto c = static_cast<unsigned char>(text[at]);
        if (c == '\n') ++line;
        if ((c < 0x20 && c != '\n' && c != '\r' && c != '\t') || c == 0x7F)
            fail(file, line, "",
                 fmt::format("control character {:#04x}; a scene is plain text", c));
        const Character character = first_character(text.substr(at));
        if (!character.valid)
            fail(file, line, "",
                 fmt::format("byte {:#04x} is not UTF-8; a scene is plain text", c));
        at += character.bytes.size();
    }
}

}  // namespace

const Value* entry(const Value& map, std::string_view key) {
    const auto found = std::ranges::find(map.keys, key);
    return found == map.keys.end() ? nullptr
                                   : &map.items[static_cast<std::size_t>(found - map.keys.begin())];
}

std::string place_in(const Value& list, std::size_t k) {
    const bool is_vector = list.items.size() == 3 && list.items[0].kind != Value::Kind::list;
    return is_vector ? std::string(1, "xyz"[k]) : std::to_string(k + 1);
}

Value parse_yaml(std::string_view text, const std::string& file, Syntax syntax) {
    if (text.size() > largest_text) fail(file, 0, "", "larger than 1 MiB, the limit for a scene");
    refuse_binary(text, file);
    TreeBuilder builder(file, syntax);
    try {
        std::istringstream stream{std::string(text)};
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) continue;
    } catch (const YAML::Exception& error) {
        fail(file, line_of(error.mark), "", "invalid YAML: " + error.msg);
    }
    return std::move(builder.root);
}

void fail(const std::string& file, int line, const std::string& field, const std::string& what) {
    const std::string where = line > 0 ? fmt::format("{}:{}", file, line) : file;
    throw SceneError(fmt::format("{}: {}{}{}", where, field, field.empty() ? "" : ": ", what));
}

}  // namespace elastocheck::reader
