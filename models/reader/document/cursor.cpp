#include "models/reader/document/cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "models/decimal.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/limits.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::reader {
namespace {

// Size of non-zero numbers: no conversion, product or quotient of them then leaves the range of double.
constexpr double min_size = 1e-30, largest_size = 1e30;

// Letters of any language, digits, _ and, not first, - + . and inner spaces: safe in file names,
// column heads and command lines.
bool is_name(std::string_view name) {
    const auto may_begin = [](char c) {
        return is_word(c) || static_cast<unsigned char>(c) >= 0x80;
    };
    const auto is_allowed = [&](char c) {
        return may_begin(c) || c == '-' || c == '+' || c == '.' || c == ' ';
    };
    return !name.empty() && name.size() <= longest_name && may_begin(name.front()) &&
           name.back() != ' ' && std::all_of(name.begin(), name.end(), is_allowed);
}

}  // namespace

void Cursor::fail(const std::string& what) const {
    reader::fail(*file, value->line, path, value->is_set ? what + " (as set)" : what);
}

Cursor Cursor::at(const Value& other, const std::string& its_path) const {
    return {&other, its_path, file, numbers, {}, accesses, first_reading};
}

std::string Cursor::path_of(std::string_view key) const {
    return first_reading ? child_path(path, key) : std::string();
}

std::string Cursor::found() const {
    switch (value->kind) {
        case Value::Kind::empty: return "nothing";
        case Value::Kind::scalar: return quote(value->text);
        case Value::Kind::list: return fmt::format("a list of {}", value->items.size());
        case Value::Kind::map: return "a map";
    }
    return "";
}

namespace {
// ": the file is a study, ..." if an unknown field at the top is the mark of another kind of file.
std::string kind_of_file(const std::string& field) {
    for (const auto& [mark, kind] : {std::pair{"elastocheck", "a scene"},
                                     {"elastocheck_study", "a study, for `elastocheck study`"},
                                     {"vary", "goals, for `elastocheck optimise`"},
                                     {"columns", "a map, for --map"}})
        if (field == mark) return fmt::format(": the file is {}", kind);
    return {};
}
}  // namespace

void Cursor::only_keys(Words allowed) const {
    if (first_reading) only_keys(std::vector<std::string>(allowed.begin(), allowed.end()));
}

void Cursor::only_keys(const std::vector<std::string>& allowed) const {
    if (value->kind != Value::Kind::map)
        fail(fmt::format("expected a map with the fields {}, found {}", listed(allowed), found()));
    for (std::size_t k = 0; k < value->keys.size(); ++k) {
        const std::string& key = value->keys[k];
        if (std::find(allowed.begin(), allowed.end(), key) != allowed.end()) continue;
        at(value->items[k], path)
            .fail(fmt::format("unknown field {}{}{}", quote(key),
                              path.empty() ? kind_of_file(key) : "",
                              did_you_mean(key, allowed, "allowed")));
    }
}

std::optional<Cursor> Cursor::optional(std::string_view key) const {
    if (accesses) accesses->looked_for[value].emplace(key);
    const Value* field = entry(*value, key);
    return field == nullptr ? std::nullopt : std::optional(at(*field, path_of(key)));
}

Cursor Cursor::require(std::string_view key) const {
    if (auto field = optional(key)) return *field;
    reader::fail(*file, value->line, child_path(path, key), "missing; this field is required");
}

std::vector<Cursor::Named> Cursor::entries(Keys keys) const {
    if (value->kind != Value::Kind::map && value->kind != Value::Kind::empty)
        fail(fmt::format("expected a map of names, found {}", found()));
    std::vector<Named> entries;
    entries.reserve(value->keys.size());
    for (std::size_t k = 0; k < value->keys.size(); ++k) {
        const std::string& name = value->keys[k];
        const auto side = keys == Keys::numbers ? name.rfind('@') : name.npos;
        if (first_reading && !is_name(std::string_view(name).substr(0, side)))
            at(value->items[k], path)
                .fail(fmt::format("{} cannot be a name; allowed: up to {} letters, digits, _ and, "
                                  "not first, - + . "
                                  "and spaces",
                                  quote(name), longest_name));
        entries.push_back({name, at(value->items[k], path_of(name))});
    }
    return entries;
}

std::vector<Cursor> Cursor::items() const {
    if (accesses) accesses->read.insert(value);
    std::vector<Cursor> items;
    items.reserve(value->items.size());
    for (std::size_t k = 0; k < value->items.size(); ++k) {
        items.push_back(at(value->items[k], path));
        if (first_reading) items.back().item = item + '.' + place_in(*value, k);
    }
    return items;
}

std::vector<Cursor> Cursor::list(std::size_t size, std::string_view what) const {
    if (!is_list() || value->items.size() != size)
        fail(fmt::format("expected a list of {} {}, found {}", size, what, found()));
    return items();
}

const std::string& Cursor::text(std::string_view what, std::string_view kind) const {
    if (accesses) accesses->read.insert(value);
    if (value->kind != Value::Kind::scalar || value->text.empty())
        fail(fmt::format("expected {}{}, found {}", what, kind, found()));
    if (first_reading && std::any_of(value->text.begin(), value->text.end(), is_control))
        fail(fmt::format("{} is not one line of plain text", found()));
    return value->text;
}

double Cursor::number(const std::string& unit) const {
    if (accesses) accesses->read.insert(value);
    double x = 0;
    const char *const end = value->text.data() + value->text.size(), *stop = end;
    std::errc error{};
    if (value->number) {
        x = *value->number;
    } else {
        std::string_view digits = value->text;
        if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
        const auto read = read_decimal(digits.data(), end, x);
        stop = read.ptr;
        error = read.ec;
    }
    if (value->kind != Value::Kind::scalar || stop != end || error == std::errc::invalid_argument ||
        std::isnan(x))
        fail(fmt::format("expected a number, found {}", found()));
    if (value->is_string)
        fail(fmt::format("expected a number, found the string \"{}\"", value->text));
    const double size = std::abs(x);
    if (error != std::errc() || (size != 0 && !(size >= min_size && size <= largest_size)))
        fail(fmt::format("{} is out of range; allowed: 0, or {:g} to {:g} in size", found(),
                         min_size, largest_size));
    if (first_reading) numbers->push_back({path + item, x, unit});
    return x;
}

bool Cursor::yes_or_no() const { return one_of("a truth value", {"true", "false"}) == 0; }

int Cursor::whole_number(int min, int max) const {
    if (accesses) accesses->read.insert(value);
    const std::string& digits = value->text;
    int n = 0;
    const char* const end = digits.data() + digits.size();
    auto [stop, error] = std::from_chars(digits.data(), end, n);
    if (value->number) {
        n = static_cast<int>(*value->number);
        stop = n == *value->number ? end : nullptr;
    }
    if (value->kind != Value::Kind::scalar || stop != end || error != std::errc() || n < min ||
        n > max)
        fail(fmt::format("expected a whole number from {} to {}, found {}", min, max, found()));
    if (first_reading) numbers->push_back({path + item, static_cast<double>(n), ""});
    return n;
}

std::size_t Cursor::one_of(std::string_view what, Words allowed) const {
    const std::string& word = text(what);
    const auto found = std::find(allowed.begin(), allowed.end(), word);
    if (found == allowed.end())
        return one_of(what, std::vector<std::string>(allowed.begin(), allowed.end()));
    return static_cast<std::size_t>(found - allowed.begin());
}

std::size_t Cursor::one_of(std::string_view what, const std::vector<std::string>& allowed) const {
    const std::string& word = text(what);
    const auto found = std::find(allowed.begin(), allowed.end(), word);
    if (found == allowed.end())
        fail(fmt::format("{} is not {}{}", quote(word), what,
                         did_you_mean(word, allowed, "allowed")));
    return static_cast<std::size_t>(found - allowed.begin());
}

}  // namespace elastocheck::reader
