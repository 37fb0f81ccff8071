#include "models/reader/tables/property_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <system_error>

#include "models/decimal.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/limits.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::reader {
namespace {

constexpr std::size_t max_property_rows = 100'000;

// Splits at blanks; text in single quotes is one word, without its padding.
std::vector<std::string> words(std::string_view line) {
    std::vector<std::string> result;
    for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
        if (line.front() == '\'') {
            const std::size_t end = std::min(line.find('\'', 1), line.size());
            result.emplace_back(trimmed(line.substr(1, end - 1)));
            line.remove_prefix(std::min(end + 1, line.size()));
            continue;
        }
        std::size_t n = 0;
        while (n < line.size() && !is_blank(line[n])) ++n;
        result.emplace_back(line.substr(0, n));
        line.remove_prefix(n);
    }
    return result;
}

// Removes a comment; a $ in quotes does not start one.
std::string_view without_comment(std::string_view line) {
    bool quoted = false;
    for (std::size_t n = 0; n < line.size(); ++n) {
        if (line[n] == '\'') quoted = !quoted;
        if (line[n] == '$' && !quoted) return line.substr(0, n);
    }
    return line;
}

struct NamedUnit {
    std::string_view name;
    double si;
};
constexpr double inch = 0.0254, pound = 0.45359237 * 9.80665;
constexpr NamedUnit lengths[] = {
    {"MM", 1e-3},      {"MILLIMETER", 1e-3}, {"METER", 1},          {"METERS", 1},
    {"M", 1},          {"CM", 1e-2},         {"CENTIMETER", 1e-2},  {"INCH", inch},
    {"IN", inch},      {"FOOT", 12 * inch},  {"MILLIMETERS", 1e-3}, {"KM", 1e3},
    {"KILOMETER", 1e3}};
constexpr NamedUnit angles[] = {{"DEGREES", std::numbers::pi / 180},
                                {"DEGREE", std::numbers::pi / 180},
                                {"DEG", std::numbers::pi / 180},
                                {"RADIANS", 1},
                                {"RADIAN", 1},
                                {"RAD", 1}};
constexpr NamedUnit forces[] = {{"NEWTON", 1},
                                {"NEWTONS", 1},
                                {"N", 1},
                                {"KNEWTON", 1e3},
                                {"KN", 1e3},
                                {"POUND_FORCE", pound},
                                {"LBF", pound},
                                {"KPOUND_FORCE", 1e3 * pound},
                                {"KILOGRAM_FORCE", 9.80665},
                                {"KGF", 9.80665},
                                {"DYNE", 1e-5}};

template <std::size_t n>
double unit(const PropertyFile& file, const PropertyBlock& block, std::size_t k,
            const NamedUnit (&table)[n]) {
    const std::string word = capitals(block.values[k].second);
    std::vector<std::string> names;
    for (const NamedUnit& entry : table) {
        if (entry.name == word) return entry.si;
        names.emplace_back(entry.name);
    }
    fail(file.file, block.lines[k], "UNITS." + block.values[k].first,
         fmt::format("{} is not a known unit{}", quote(block.values[k].second),
                     did_you_mean(word, names, "known")));
}

void read_units(PropertyFile& file) {
    const PropertyBlock* units = file.find("UNITS");
    if (!units) fail(file.file, 0, "UNITS", "missing: the units of the file are unknown");
    bool has_length = false, has_force = false;
    for (std::size_t k = 0; k < units->values.size(); ++k) {
        const std::string& name = units->values[k].first;
        if (name == "LENGTH") {
            file.length = unit(file, *units, k, lengths);
            has_length = true;
        }
        if (name == "ANGLE") file.angle = unit(file, *units, k, angles);
        if (name == "FORCE") {
            file.force = unit(file, *units, k, forces);
            has_force = true;
        }
    }
    if (!has_length) fail(file.file, units->line, "UNITS.LENGTH", "missing");
    if (!has_force) fail(file.file, units->line, "UNITS.FORCE", "missing");
}

}  // namespace

const PropertyBlock* PropertyFile::find(std::string_view block) const {
    const auto found = std::ranges::find_if(
        blocks, [&](const PropertyBlock& b) { return b.name == block && b.subblock.empty(); });
    return found == blocks.end() ? nullptr : &*found;
}

PropertyFile parse_property_file(std::string_view text, const std::string& name) {
    PropertyFile file;
    file.file = name;
    std::size_t rows = 0;
    Lines lines(text);
    const auto fail_here = [&](const std::string& what) { fail(name, lines.number(), "", what); };
    while (lines.next()) {
        const std::string_view line = trimmed(without_comment(lines.line()));
        if (line.empty()) continue;
        const auto in_brackets = [&](char closing) {
            const std::size_t end = line.find(closing);
            if (end == line.npos) fail_here(fmt::format("{} is not closed", quote(line)));
            return trimmed(line.substr(1, end - 1));
        };
        if (line.front() == '[') {
            file.blocks.push_back({.name = capitals(in_brackets(']')), .line = lines.number()});
            continue;
        }
        if (file.blocks.empty())
            fail_here(fmt::format("expected a block [NAME], found {}", quote(line)));
        if (line.front() == '(') {
            file.blocks.push_back({.name = file.blocks.back().name,
                                   .subblock = capitals(in_brackets(')')),
                                   .line = lines.number()});
            continue;
        }
        PropertyBlock& block = file.blocks.back();
        if (line.front() == '{') {
            block.table = {};
            block.table.columns = words(in_brackets('}'));
            if (block.table.columns.empty()) fail_here("a table without columns");
            continue;
        }
        // A value, or a row of the table: a row has "=" only in quotes.
        const std::size_t equals = line.find('='), quoted = line.find('\'');
        if (equals != line.npos && equals < quoted) {
            const auto given = words(line.substr(equals + 1));
            block.values.emplace_back(capitals(trimmed(line.substr(0, equals))),
                                      given.empty() ? "" : given.front());
            block.lines.push_back(lines.number());
            continue;
        }
        if (block.table.columns.empty())
            fail_here(
                fmt::format("expected NAME = value, or columns {{...}}, found {}", quote(line)));
        auto row = words(line);
        if (row.size() != block.table.columns.size())
            fail_here(fmt::format("{} values in a table of {} columns", row.size(),
                                  block.table.columns.size()));
        if (++rows > max_property_rows)
            fail_here(fmt::format("more than {} rows", max_property_rows));
        block.table.rows.push_back(std::move(row));
        block.table.lines.push_back(lines.number());
    }
    if (file.blocks.empty())
        fail(name, lines.number(), "", "no block: this is not a property file");
    read_units(file);
    return file;
}

double real(const PropertyFile& file, int line, const std::string& block, std::string_view text,
            double largest) {
    double value = 0;
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = read_decimal(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) ||
        std::abs(value) > largest)
        fail(file.file, line, block, fmt::format("{} is not a number", quote(text)));
    return value;
}

std::vector<TablePoint> curve_rows(const PropertyFile& file, const PropertyBlock& block,
                                   double x_unit, double f_unit) {
    if (block.table.columns.size() != 2)
        fail(file.file, block.line, block.name,
             fmt::format("{} columns; a curve has two", block.table.columns.size()));
    std::vector<TablePoint> points;
    for (std::size_t n = 0; n < block.table.rows.size(); ++n) {
        double value[2] = {0, 0};
        for (std::size_t k = 0; k < 2; ++k) {
            value[k] = real(file, block.table.lines[n], block.name, block.table.rows[n][k]);
        }
        if (n > 0 && !(value[0] * x_unit > points.back().x))
            fail(file.file, block.table.lines[n], block.name,
                 fmt::format("{} is not larger than the value before", value[0]));
        if (n > 0 && value[1] * f_unit < points.back().f)
            fail(file.file, block.table.lines[n], block.name,
                 fmt::format("force {} is smaller than the one before; it must not decrease",
                             value[1]));
        points.push_back({value[0] * x_unit, value[1] * f_unit});
    }
    if (points.size() < 2)
        fail(file.file, block.line, block.name, "fewer than two rows; a curve has two or more");
    if (points.size() > max_rows)
        fail(file.file, block.line, block.name, fmt::format("more than {} rows", max_rows));
    return points;
}

}  // namespace elastocheck::reader
