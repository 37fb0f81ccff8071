#include "reports/json/json_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reports/text/escape.hpp"

namespace elastocheck::reports {

void Field::fail(const std::string& what) const {
    throw ResultError(fmt::format("{}: {}{}{}", *file, path, path.empty() ? "" : ": ", what));
}

void Field::only_keys(std::initializer_list<std::string_view> required,
                      std::string_view optional) const {
    for (const auto key : required) (void)(*this)[key];
    for (const auto& [key, entry] : value->items())
        if (key != optional && std::ranges::find(required, key) == required.end())
            fail(fmt::format("'{}' is not known", key));
}

std::optional<Field> Field::find(std::string_view key) const {
    if (!value->is_object()) fail(fmt::format("expected an object, found {}", value->type_name()));
    const auto found = value->find(std::string(key));
    if (found == value->end() || found->is_null()) return std::nullopt;
    return Field{&*found, path.empty() ? std::string(key) : fmt::format("{}.{}", path, key), file};
}

Field Field::operator[](std::string_view key) const {
    if (!value->is_object()) fail(fmt::format("expected an object, found {}", value->type_name()));
    const auto found = value->find(std::string(key));
    const std::string place = path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
    if (found == value->end()) Field{value, place, file}.fail("missing");
    return {&*found, place, file};
}

std::vector<std::pair<std::string, Field>> Field::entries() const {
    if (!value->is_object()) fail(fmt::format("expected an object, found {}", value->type_name()));
    std::vector<std::pair<std::string, Field>> all;
    for (const auto& [key, entry] : value->items()) {
        if (const std::string wrong = flaw(key); !wrong.empty()) fail("a name in it: " + wrong);
        all.emplace_back(key, Field{&entry, fmt::format("{}.{}", path, key), file});
    }
    return all;
}

std::vector<Field> Field::items() const {
    if (!value->is_array()) fail(fmt::format("expected a list, found {}", value->type_name()));
    std::vector<Field> all;
    for (std::size_t k = 0; k < value->size(); ++k)
        all.push_back({&(*value)[k], fmt::format("{}[{}]", path, k), file});
    return all;
}

double Field::number() const {
    if (value->is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!value->is_number()) fail(fmt::format("expected a number, found {}", value->type_name()));
    return value->get<double>();
}

int Field::whole() const {
    const double x = number();
    if (!(std::abs(x) <= std::numeric_limits<int>::max()) || x != std::floor(x))
        fail("expected a whole number");
    return static_cast<int>(x);
}

bool Field::truth() const {
    if (!value->is_boolean())
        fail(fmt::format("expected true or false, found {}", value->type_name()));
    return value->get<bool>();
}

std::string Field::text() const {
    std::string text = lines();
    if (text.find('\n') != text.npos) fail("expected one line of text: " + flaw(text));
    return text;
}

std::string Field::lines() const {
    if (!value->is_string()) fail(fmt::format("expected text, found {}", value->type_name()));
    auto text = value->get<std::string>();
    std::string one_line = text;
    std::ranges::replace(one_line, '\n', ' ');
    if (const std::string wrong = flaw(one_line); !wrong.empty())
        fail("expected one line of text: " + wrong);
    return text;
}

std::vector<double> Field::numbers() const {
    std::vector<double> all;
    for (const auto& item : items()) all.push_back(item.number());
    return all;
}

std::vector<std::string> Field::texts() const {
    std::vector<std::string> all;
    for (const auto& item : items()) all.push_back(item.text());
    return all;
}

}  // namespace elastocheck::reports
