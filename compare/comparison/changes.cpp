#include "compare/comparison/changes.hpp"

#include <map>
#include <string_view>

namespace elastocheck::compare {
namespace {

bool same(const Number& a, const Number& b) {
    const bool both_nan = a.value != a.value && b.value != b.value;
    return a.unit == b.unit && (a.value == b.value || both_nan);
}

using ByPath = std::map<std::string_view, const Number*>;

ByPath by_path(std::span<const Number> numbers) {
    ByPath places;
    for (const auto& number : numbers) places.emplace(number.path, &number);
    return places;
}

}  // namespace

std::vector<Change> changes(std::span<const Number> was, std::span<const Number> is) {
    const ByPath before = by_path(was), now = by_path(is);
    std::vector<Change> list;
    for (const auto& number : is) {
        const auto old = before.find(number.path);
        if (old == before.end())
            list.push_back({.was = std::nullopt, .is = number});
        else if (!same(*old->second, number))
            list.push_back({.was = *old->second, .is = number});
    }
    for (const auto& number : was)
        if (!now.contains(number.path)) list.push_back({.was = number, .is = std::nullopt});
    return list;
}

Table table_of(const std::vector<Change>& changes, const char* was, const char* is) {
    using enum Digits;
    const auto value = [](const std::optional<Number>& number) {
        return number ? number->value : nan;
    };
    return table<Change>(
        {.id = "numbers"},
        {{"number", words, [](const Change& c) { return (c.is ? c.is : c.was)->path; }},
         {was, given, [=](const Change& c) { return value(c.was); }},
         {is, given, [=](const Change& c) { return value(c.is); }},
         {"unit", words, [](const Change& c) { return (c.is ? c.is : c.was)->unit; }}},
        changes);
}

}  // namespace elastocheck::compare
