#include "models/reader/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck {
namespace reader {
namespace {

constexpr std::size_t longest_value = 256;

// Path names of the entries of a map or list.
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

void apply(const Setting& setting, Value& tree, const std::string& file) {
    const auto [value, rest] = follow(tree, setting.path);
    const std::string shown_path = shown(setting.path);
    const auto names = names_in(*value);
    if (!rest.empty()) {
        const std::string head = setting.path.substr(0, setting.path.size() - rest.size());
        const std::string in = head.empty() ? "the file" : shown(head.substr(0, head.size() - 1));
        if (names.empty())
            fail(file, value->line, shown_path, fmt::format("{} is a single value", in));
        const bool ends_in_dot = rest.find('.') + 1 == rest.size();
        const std::string_view wrong = ends_in_dot ? rest : rest.substr(0, rest.find('.'));
        fail(file, 0, shown_path,
             fmt::format("{} has no {}{}", in, quote(wrong), did_you_mean(wrong, names, "there")));
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
    if (value->is_set) fail(file, value->line, shown_path, "set twice");
    *value = {.kind = Value::Kind::scalar, .text = text, .line = value->line, .is_set = true};
}

}  // namespace

void apply(std::span<const Setting> settings, Value& tree, const std::string& file) {
    for (const Setting& setting : settings) apply(setting, tree, file);
}

}  // namespace reader

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
