// Imports a list of named points as kinematics programs print and export them: a CSV table with
// columns of the name and of x, y, z, or a listing with a name and three numbers in a line. Bodies and
// joints are not in it, so the result is an incomplete scene.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "models/import/import.hpp"
#include "models/import/property/columns.hpp"
#include "models/import/property/spreadsheet.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"
#include "models/reader/tables/csv.hpp"

namespace elastocheck::importer {
namespace {

using Coordinates = std::array<double, 3>;

struct NamedPoint {
    int line = 0;
    std::string name;
    Coordinates at{};  // as in the file
};

// ---- Tables.

constexpr std::size_t narrowest = 4;  // columns: the name and three coordinates

// "left_" or "right_" of a cell that says the side; empty for a point in the middle.
std::string side_in(std::string_view cell, const std::string& file, int line) {
    const std::string word = reader::small_letters(cell);
    for (const char* left : {"l", "left", "lh", "li", "links"})
        if (word == left) return "left_";
    for (const char* right : {"r", "right", "rh", "re", "rechts"})
        if (word == right) return "right_";
    if (word.empty() || word == "-" || word == "c" || word == "centre" || word == "center")
        return "";
    reader::fail(file, line, "side",
                 fmt::format("{} is no side; allowed: left, right, l, r, lh, rh, links, rechts; "
                             "nothing, -, c or centre in the middle",
                             reader::quote(cell)));
}

// Whether the coordinates have decimal commas. A file with commas in some and points in others is
// refused: one of them separates thousands.
bool has_decimal_commas(const Sheet& sheet, const PointColumns& columns, const std::string& file) {
    if (sheet.separator == ',') return false;
    const SheetRow *comma = nullptr, *point = nullptr;
    for (std::size_t r = columns.first; r < sheet.rows.size(); ++r)
        for (const Triple& triple : columns.triples)
            for (const std::size_t c : triple.at) {
                const std::string_view cell = sheet.rows[r].at(c);
                if (coordinate(cell, true) && cell.find(',') != cell.npos && comma == nullptr)
                    comma = &sheet.rows[r];
                if (coordinate(cell, false) && cell.find('.') != cell.npos && point == nullptr)
                    point = &sheet.rows[r];
            }
    if (comma != nullptr && point != nullptr)
        reader::fail(file, std::max(comma->line, point->line), "",
                     fmt::format("decimal commas (line {}) and decimal points (line {}) in one "
                                 "file; allowed: one of them, no separators of thousands",
                                 comma->line, point->line));
    return comma != nullptr;
}

std::string words_of(const SheetRow& row) {
    std::string words;
    for (const auto& cell : row.cells)
        if (!cell.empty()) words += (words.empty() ? "" : " ") + cell;
    return words;
}

std::vector<NamedPoint> points_of_table(std::string_view text, const std::string& file,
                                        const Options& options, Draft& draft) {
    const Sheet sheet = read_sheet(text, file, narrowest);
    const PointColumns columns = point_columns(sheet, file, options.columns, options.unit);
    const bool decimal_comma = has_decimal_commas(sheet, columns, file);
    draft.remarks.push_back(fmt::format("Coordinates of the file in {}, {}{}.", columns.unit,
                                        columns.unit_from,
                                        decimal_comma ? ", with decimal commas" : ""));
    const double mm = millimetres(columns.unit);
    for (std::size_t r = 0; r < columns.first; ++r)
        draft.notes.leave_out("line above the points",
                              {sheet.rows[r].line, words_of(sheet.rows[r])});
    std::vector<NamedPoint> points;
    for (std::size_t r = columns.first; r < sheet.rows.size(); ++r) {
        const SheetRow& row = sheet.rows[r];
        const std::string name(row.at(columns.name));
        const std::string side =
            columns.side ? side_in(row.at(*columns.side), file, row.line) : std::string();
        bool any = false;
        for (const Triple& triple : columns.triples) {
            if (std::ranges::all_of(triple.at, [&](std::size_t c) { return row.at(c).empty(); }))
                continue;  // a title, or a point of the other side only
            any = true;
            if (name.empty()) reader::fail(file, row.line, "name", "an empty cell");
            NamedPoint point{row.line, side + triple.prefix + name, {}};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t c = triple.at[k];
                const char axis = "xyz"[k];
                if (c >= row.cells.size())
                    reader::fail(file, row.line, point.name,
                                 fmt::format("{} cells, but {} is in column {}", row.cells.size(),
                                             axis, letters_of(c)));
                const auto value = coordinate(row.at(c), decimal_comma);
                if (!value)
                    reader::fail(file, row.line, point.name,
                                 fmt::format("{} is no number: {} in column {}", axis,
                                             reader::quote(row.at(c)), letters_of(c)));
                point.at[k] = mm * *value;
            }
            points.push_back(std::move(point));
        }
        if (!any) draft.notes.leave_out("line without coordinates", {row.line, words_of(row)});
    }
    return points;
}

// ---- Listings.

// The words of a line; the last three are the coordinates, a number before the name is that of the
// line.
std::vector<NamedPoint> points_of_listing(std::string_view text, const Options& options,
                                          Draft& draft) {
    const std::string unit = options.unit.empty() ? "mm" : options.unit;
    draft.remarks.push_back(fmt::format(
        "Coordinates of the file in {}, {}.", unit,
        options.unit.empty() ? "as such listings have them (--unit says another)" : "by --unit"));
    const auto number = [](std::string_view word) { return coordinate(word, false); };
    std::vector<NamedPoint> points;
    reader::CsvLines lines(text);
    while (lines.next()) {
        std::vector<std::string_view> words;
        for (std::string_view rest = lines.whole(); !rest.empty();) {
            const auto begin = rest.find_first_not_of(" \t,;:");
            if (begin == rest.npos) break;
            rest.remove_prefix(begin);
            const auto end = std::min(rest.find_first_of(" \t,;:"), rest.size());
            words.push_back(rest.substr(0, end));
            rest.remove_prefix(end);
        }
        const std::size_t n = words.size();
        NamedPoint point{lines.number(), "", {}};
        const bool is_point =
            n >= 4 && number(words[n - 1]) && number(words[n - 2]) && number(words[n - 3]);
        if (is_point) {
            for (std::size_t k = 0; k < 3; ++k)
                point.at[k] = millimetres(unit) * *number(words[n - 3 + k]);
            for (std::size_t k = n > 4 && number(words[0]) ? 1 : 0; k + 3 < n; ++k)
                point.name += (point.name.empty() ? "" : " ") + std::string(words[k]);
        }
        if (is_point && !number(point.name))
            points.push_back(std::move(point));
        else
            draft.notes.leave_out("no name with three numbers",
                                  {lines.number(), std::string(lines.whole())});
    }
    return points;
}

// ---- Both.

// A name that occurs twice gets a number; a listing of both sides often has them so.
void warn_of_equal_names(const std::vector<NamedPoint>& points, Notes& notes) {
    std::map<std::string, int> line_of;
    for (const auto& point : points) {
        const auto [at, is_new] = line_of.emplace(point.name, point.line);
        if (!is_new)
            notes.warn({point.line, point.name},
                       fmt::format("a point of this name is in line {} too; this one has a number "
                                   "after its name (in a table, --columns side=COLUMN or left.x= "
                                   "... right.z= tells sides)",
                                   at->second));
    }
}

// Some lists give y of both sides as the distance from the middle.
void warn_of_equal_sides(const std::vector<NamedPoint>& points, Notes& notes) {
    std::map<std::string, double> left;
    for (const auto& point : points)
        if (point.name.starts_with("left_")) left[point.name.substr(5)] = point.at[1];
    int pairs = 0, same = 0, line = 0;
    for (const auto& point : points)
        if (point.name.starts_with("right_"))
            if (const auto twin = left.find(point.name.substr(6)); twin != left.end()) {
                ++pairs;
                if (twin->second * point.at[1] > 0) ++same, line = point.line;
            }
    if (same > 0)
        notes.warn(
            {line, "y"},
            fmt::format("{} of {} pairs of points left and right are on the same side of the "
                        "vehicle",
                        same, pairs));
}

}  // namespace

Draft import_points(std::string_view text, const std::string& name, const Options& options) {
    const bool table =
        reader::small_letters(std::filesystem::path(name).extension().string()) == ".csv";
    if (options.axes.empty())
        reader::fail(name, 0, "--axes",
                     fmt::format("a list of points does not say its axes; give them; allowed: {}",
                                 fmt::join(axes_of_tables, " ")));
    if (!options.unit.empty() &&
        std::ranges::find(length_units, options.unit) == std::end(length_units))
        reader::fail(name, 0, "--unit",
                     fmt::format("{} is no unit of a coordinate; allowed: {}",
                                 reader::quote(options.unit), fmt::join(length_units, ", ")));
    if (!options.columns.empty() && !table)
        reader::fail(name, 0, "--columns", "only for tables (.csv); a listing has no columns");
    const auto [along_x, along_y] = directions(options.axes, name);
    const double along_z = along_x * along_y;
    Draft draft;
    draft.title = std::filesystem::path(name).stem().string();
    draft.source = name;
    draft.format = table ? "table of points" : "listing of points";
    draft.units = "{length: mm, angle: deg, force: N}";
    draft.remarks = {
        fmt::format("Axes rotated from {}, z {} to x forward, y left, z up (ISO 8855).",
                    options.axes, along_z > 0 ? "up" : "down")};
    draft.points = Hardpoints(1);
    const auto points = table ? points_of_table(text, name, options, draft)
                              : points_of_listing(text, options, draft);
    draft.remarks.emplace_back(
        "Points only: bodies and joints are not in this file. Add yours below.");
    if (points.empty()) reader::fail(name, 0, "", "no point in this file");
    warn_of_equal_names(points, draft.notes);
    warn_of_equal_sides(points, draft.notes);
    for (const auto& point : points) {
        draft.points.add({along_x * point.at[0], along_y * point.at[1], along_z * point.at[2]},
                         point.name, {point.line, point.name});
        draft.notes.count("point");
    }
    return draft;
}

}  // namespace elastocheck::importer
