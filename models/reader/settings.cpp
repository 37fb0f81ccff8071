#include "models/reader/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <vector>

#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/one_side.hpp"

namespace elastocheck {
namespace reader {
namespace {

constexpr std::size_t longest_value = 256;

// Names of the entries of a map or list in paths.
std::vector<std::string> names_in(const Value& value) {
    if (value.kind == Value::Kind::map) return value.keys;
    std::vector<std::string> names;
    for (std::size_t k = 0; k < value.items.size(); ++k) names.push_back(place_in(value, k));
    return names;
}

// Result of following a path. Names may contain dots, so every matching name is tried.
struct Reached {
    Value* value;
    std::string_view rest;  // unmatched part of the path; empty if the whole path matches
};

Reached follow(Value& value, std::string_view path) {
    Reached best{&value, path};
    const auto names = names_in(value);
    for (std::size_t k = 0; k < names.size() && !best.rest.empty(); ++k) {
        if (!path.starts_with(names[k])) continue;
        const std::string_view behind = path.substr(names[k].size());
        if (!behind.empty() && (behind.front() != '.' || behind.size() == 1)) continue;
        const Reached there =
            follow(value.items[k], behind.substr(std::min<std::size_t>(behind.size(), 1)));
        if (there.rest.size() < best.rest.size()) best = there;
    }
    return best;
}

}  // namespace

Value& apply(const Setting& setting, Value& tree, const std::string& file, Repeated repeated) {
    const auto [value, rest] = follow(tree, setting.path);
    const std::string shown_path = shown(setting.path);
    const auto names = names_in(*value);
    if (!rest.empty()) {
        const std::string head = setting.path.substr(0, setting.path.size() - rest.size());
        const std::string container =
            head.empty() ? "the file" : shown(head.substr(0, head.size() - 1));
        if (names.empty())
            fail(file, value->line, shown_path, fmt::format("{} is a single value", container));
        const bool ends_in_dot = rest.find('.') + 1 == rest.size();
        const std::string_view wrong = ends_in_dot ? rest : rest.substr(0, rest.find('.'));
        fail(file, 0, shown_path,
             fmt::format("{} has no {}{}", container, quote(wrong),
                         did_you_mean(wrong, names, "there")));
    }
    if (value->kind == Value::Kind::map || value->kind == Value::Kind::list)
        fail(file, value->line, shown_path,
             fmt::format("not a single value; it contains: {}",
                         names.empty() ? "nothing" : listed(names)));
    const std::string& text = setting.value;
    if (text.empty() || text.size() > longest_value || std::ranges::any_of(text, is_control) ||
        !is_utf8(text))
        fail(file, value->line, shown_path,
             fmt::format("{} cannot be set; allowed: one line of plain text, up to {} bytes",
                         quote(text), longest_value));
    if (value->is_set && repeated == Repeated::rejected)
        fail(file, value->line, shown_path, "set twice");
    *value = {.kind = Value::Kind::scalar, .text = text, .line = value->line, .is_set = true};
    return *value;
}

namespace {

// A value in a line of the file, and its replacement.
struct Edit {
    const Value* value;
    const Setting* setting;
};

// Removes the comment "  # PATH was VALUE, ..." that an earlier edited() left at the end of a line.
// Returns its entries for paths that are not edited now.
std::string earlier_comment(std::string& line, const std::vector<Edit>& edits) {
    const std::size_t comment = line.rfind("  # ");
    if (comment == line.npos || static_cast<std::size_t>(edits.front().value->column) > comment)
        return "";
    std::string kept;
    for (std::size_t from = comment + 4; from < line.size();) {
        const std::size_t end = std::min(line.find(", ", from), line.size());
        const std::string entry = line.substr(from, end - from);
        const std::size_t was = entry.find(" was ");
        if (was == entry.npos || entry.find(' ') != was || entry.find(' ', was + 5) != entry.npos)
            return "";
        if (std::ranges::none_of(edits, [&](const Edit& edit) {
                return edit.setting->path == entry.substr(0, was);
            }))
            kept += (kept.empty() ? "" : ", ") + entry;
        from = end + 2;
    }
    line.erase(comment);
    return kept;
}

// The line with the values replaced, the old ones in a comment at its end. `edits` from right to left.
std::string edited(std::string line, const std::vector<Edit>& edits, const std::string& file) {
    std::string end;
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) {
        end.insert(end.begin(), line.back());
        line.pop_back();
    }
    std::string comment = earlier_comment(line, edits);
    for (const auto& [value, setting] : edits) {
        const auto at = static_cast<std::size_t>(value->column);
        const bool is_quoted = at < line.size() && (line[at] == '"' || line[at] == '\'');
        const std::size_t length = value->text.size() + (is_quoted ? 2 : 0);
        if (at + length > line.size() ||
            line.substr(at + (is_quoted ? 1 : 0), value->text.size()) != value->text)
            fail(file, value->line, shown(setting->path),
                 "cannot be replaced where it is written; write it on one line, without escapes");
        line.replace(at, length, setting->value);
        comment.insert(
            0, fmt::format("{} was {}{}", setting->path, value->text, comment.empty() ? "" : ", "));
    }
    return line + "  # " + comment + end;
}

}  // namespace

}  // namespace reader

namespace {

// Settings of one side alone are entries of the section `one_side`. Returns the text with the entries
// that it lacks added to that section, or in a new section at the end, and removes them from `settings`;
// the settings that are left replace values of the text.
std::string with_one_side(std::string text, const std::string& name,
                          std::vector<Setting>& settings) {
    reader::Value tree = reader::parse_yaml(text, name);
    std::string added;
    std::erase_if(settings, [&](Setting& setting) {
        if (setting.path.find('@') == std::string::npos) return false;
        const std::string entry = "one_side." + setting.path;
        if (reader::follow(tree, entry).rest.empty()) {
            setting.path = entry;
            return false;
        }
        added += fmt::format("  {}: {}\n", setting.path, setting.value);
        return true;
    });
    if (added.empty()) return text;
    const std::string head = "\none_side:\n";
    if (const auto section = text.find(head); section != std::string::npos)
        return text.insert(section + head.size(), added);
    if (!text.ends_with('\n')) text += '\n';
    return text + head.substr(1) + added;
}

}  // namespace

std::string rewrite_scene(std::string_view original, const std::string& name,
                          std::span<const Setting> wanted) {
    (void)reader::with_settings(reader::parse_yaml(original, name), wanted, name);  // throws
    std::vector<Setting> settings(wanted.begin(), wanted.end());
    const std::string text = with_one_side(std::string(original), name, settings);
    reader::Value tree = reader::parse_yaml(text, name);
    std::map<int, std::vector<reader::Edit>> edits;  // by row
    for (const Setting& setting : settings) {
        const reader::Value* value = reader::follow(tree, setting.path).value;
        edits[value->row].push_back({value, &setting});
    }
    std::string result;
    int row = 0;
    for (std::size_t from = 0; from < text.size(); ++row) {
        const std::size_t end = std::min(text.find('\n', from), text.size() - 1) + 1;
        std::string line(text.substr(from, end - from));
        if (const auto line_edits = edits.find(row); line_edits != edits.end()) {
            std::ranges::sort(line_edits->second, std::ranges::greater{},
                              [](const reader::Edit& edit) { return edit.value->column; });
            line = reader::edited(std::move(line), line_edits->second, name);
        }
        result += line;
        from = end;
    }
    reader::Value again = reader::parse_yaml(result, name);
    for (const Setting& setting : settings)
        if (reader::follow(again, setting.path).value->text != setting.value)
            reader::fail(name, 0, reader::shown(setting.path),
                         "cannot be replaced where it is written; write the value as one word");
    return result;
}

Setting parse_setting(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
        throw SceneError(fmt::format(
            "{} is not a setting; expected path=value, such as points.ball_joint.z=-0.17",
            reader::quote(text)));
    return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

Setting setting(std::string path, double value) {
    char digits[32];
    const auto [end, error] = std::to_chars(std::begin(digits), std::end(digits), value);
    return {std::move(path), error == std::errc() ? std::string(digits, end) : ""};
}

}  // namespace elastocheck
