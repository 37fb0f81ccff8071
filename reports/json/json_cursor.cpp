#include "reports/json/json_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "reports/text/escape.hpp"

namespace elastocheck::reports {

void JsonCursor::fail(const std::string& what) const {
    throw ResultError(fmt::format("{}: {}{}{}", *file, path, path.empty() ? "" : ": ", what));
}

void JsonCursor::only_keys(std::initializer_list<std::string_view> required,
                           std::string_view optional) const {
    for (const auto key : required) (void)(*this)[key];
    for (const auto& [key, entry] : value->items())
        if (key != optional && std::ranges::find(required, key) == required.end())
            fail(fmt::format("'{}' is not known", key));
}

std::optional<JsonCursor> JsonCursor::find(std::string_view key) const {
    if (!value->is_object()) fail(fmt::format("expected an object, found {}", value->type_name()));
    const auto found = value->find(std::string(key));
    if (found == value->end() || found->is_null()) return std::nullopt;
    return JsonCursor{&*found, path.empty() ? std::string(key) : fmt::format("{}.{}", path, key),
                      file};
}

JsonCursor JsonCursor::operator[](std::string_view key) const {
    if (!value->is_object()) fail(fmt::format("expected an object, found {}", value->type_name()));
    const auto found = value->find(std::string(key));
    const std::string place = path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
    if (found == value->end()) JsonCursor{value, place, file}.fail("missing");
    return {&*found, place, file};
}

std::vector<std::pair<std::string, JsonCursor>> JsonCursor::entries() const {
    if (!value->is_object()) fail(fmt::format("expected an object, found {}", value->type_name()));
    std::vector<std::pair<std::string, JsonCursor>> all;
    for (const auto& [key, entry] : value->items()) {
        if (const std::string wrong = flaw(key); !wrong.empty()) fail("a name in it: " + wrong);
        all.emplace_back(key, JsonCursor{&entry, fmt::format("{}.{}", path, key), file});
    }
    return all;
}

std::vector<JsonCursor> JsonCursor::items() const {
    if (!value->is_array()) fail(fmt::format("expected a list, found {}", value->type_name()));
    std::vector<JsonCursor> all;
    for (std::size_t k = 0; k < value->size(); ++k)
        all.push_back({&(*value)[k], fmt::format("{}[{}]", path, k), file});
    return all;
}

double JsonCursor::number() const {
    if (value->is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!value->is_number()) fail(fmt::format("expected a number, found {}", value->type_name()));
    return value->get<double>();
}

bool JsonCursor::truth() const {
    if (!value->is_boolean())
        fail(fmt::format("expected true or false, found {}", value->type_name()));
    return value->get<bool>();
}

std::string JsonCursor::text() const {
    std::string text = lines();
    if (text.find('\n') != text.npos) fail("expected one line of text: " + flaw(text));
    return text;
}

std::string JsonCursor::lines() const {
    if (!value->is_string()) fail(fmt::format("expected text, found {}", value->type_name()));
    auto text = value->get<std::string>();
    std::string one_line = text;
    std::ranges::replace(one_line, '\n', ' ');
    if (const std::string wrong = flaw(one_line); !wrong.empty())
        fail("expected one line of text: " + wrong);
    return text;
}

std::vector<double> JsonCursor::numbers() const {
    std::vector<double> all;
    for (const auto& item : items()) all.push_back(item.number());
    return all;
}

std::vector<std::string> JsonCursor::texts() const {
    std::vector<std::string> all;
    for (const auto& item : items()) all.push_back(item.text());
    return all;
}

}  // namespace elastocheck::reports
