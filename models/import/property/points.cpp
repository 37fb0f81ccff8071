// Imports a table of named points (CSV) as kinematics programs and spreadsheets export it: columns of
// the name and of x, y, z. Bodies and joints are not in it, so the result is an incomplete scene.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "models/import/import.hpp"
#include "models/import/property/columns.hpp"
#include "models/import/property/named_points.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/tables/sheet.hpp"

namespace elastocheck::importer {
namespace {

constexpr std::size_t min_columns = 4;  // the name and three coordinates

bool is_one_of(const std::string& word, std::initializer_list<std::string_view> words) {
    return std::ranges::find(words, word) != words.end();
}

// "left_" or "right_" of a cell that says the side; empty for a point in the middle.
std::string side_in(std::string_view cell, const std::string& file, int line) {
    const std::string word = reader::small_letters(cell);
    if (is_one_of(word, {"l", "left", "lh", "li", "links"})) return "left_";
    if (is_one_of(word, {"r", "right", "rh", "re", "rechts"})) return "right_";
    if (is_one_of(word, {"", "-", "c", "centre", "center"})) return "";
    fail(file, line, "side",
         "{} is not a side; allowed: left, right, l, r, lh, rh, links, rechts; nothing, -, c or "
         "centre in the middle",
         reader::quote(cell));
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
        fail(file, std::max(comma->line, point->line), "",
             "decimal commas (line {}) and decimal points (line {}) in one "
             "file; allowed: one of them, no separators of thousands",
             comma->line, point->line);
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
    const Sheet sheet = reader::read_sheet(text, file, min_columns);
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
            if (name.empty()) fail(file, row.line, "name", "an empty cell");
            NamedPoint point{row.line, side + triple.prefix + name, {}};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t c = triple.at[k];
                const char axis = "xyz"[k];
                if (c >= row.cells.size())
                    fail(file, row.line, point.name, "{} cells, but {} is in column {}",
                         row.cells.size(), axis, letters_of(c));
                const auto value = coordinate(row.at(c), decimal_comma);
                if (!value)
                    fail(file, row.line, point.name, "{} is not a number: {} in column {}", axis,
                         reader::quote(row.at(c)), letters_of(c));
                point.at[k] = mm * *value;
            }
            points.push_back(std::move(point));
        }
        if (!any) draft.notes.leave_out("line without coordinates", {row.line, words_of(row)});
    }
    return points;
}

// Warns of names that occur twice, which a table of both sides often has: Names gives the second a number.
void warn_of_equal_names(const std::vector<NamedPoint>& points, Notes& notes) {
    std::map<std::string, int> line_of;
    for (const auto& point : points) {
        const auto [at, is_new] = line_of.emplace(point.name, point.line);
        if (!is_new)
            notes.warn({point.line, point.name},
                       fmt::format("a point of this name is in line {} too; this one has a number "
                                   "after its name (--columns side=COLUMN or left.x= ... right.z= "
                                   "tells sides)",
                                   at->second));
    }
}

// Warns of left and right points on the same side: some tables have y as the distance from the middle.
void warn_of_equal_sides(const std::vector<NamedPoint>& points, Notes& notes) {
    std::map<std::string, double> left;
    for (const auto& point : points)
        if (point.name.starts_with("left_")) left[point.name.substr(5)] = point.at[1];
    int pairs = 0, same = 0, line = 0;
    for (const auto& point : points)
        if (point.name.starts_with("right_"))
            if (const auto twin = left.find(point.name.substr(6)); twin != left.end()) {
                ++pairs;
                if (twin->second * point.at[1] > 0) {
                    ++same;
                    line = point.line;
                }
            }
    if (same > 0)
        notes.warn(
            {line, "y"},
            fmt::format("{} of {} pairs of points left and right are on the same side of the "
                        "vehicle",
                        same, pairs));
}

// Pairs of words in names of points that say a side, or an end, of the vehicle.
struct Opposites {
    std::array<std::string_view, 2> word;
    int axis;  // along which the first has the larger coordinate in the axes of a scene
};
constexpr std::array opposites{
    Opposites{{"lf", "rf"}, 1},      Opposites{{"lr", "rr"}, 1},     Opposites{{"fl", "fr"}, 1},
    Opposites{{"rl", "rr"}, 1},      Opposites{{"lh", "rh"}, 1},     Opposites{{"l", "r"}, 1},
    Opposites{{"left", "right"}, 1}, Opposites{{"lf", "lr"}, 0},     Opposites{{"rf", "rr"}, 0},
    Opposites{{"fl", "rl"}, 0},      Opposites{{"front", "rear"}, 0}};

// The words of a name in small letters.
std::vector<std::string> words_in(std::string_view name) {
    std::vector<std::string> words(1);
    for (const char c : reader::small_letters(name))
        if (reader::is_letter(c) || reader::is_digit(c))
            words.back() += c;
        else if (!words.back().empty())
            words.emplace_back();
    return words;
}

// Rejects axes in which two points whose names differ in a pair of opposites do not lie as the words say.
// Left and right must not be exchanged (both on one side is a warning only, see above). Of "front" and
// "rear" the majority of pairs decides, since the outer ends of two links may lie the other way.
void check_opposites(const std::vector<NamedPoint>& points, const std::array<double, 3>& along,
                     const std::string& file) {
    const auto refuse = [&](const NamedPoint& first, const char* lies, const NamedPoint& second) {
        fail(file, first.line, first.name,
             "lies {} {} (line {}) in the axes of --axes; choose the axes in which it does not, or "
             "rename the points",
             lies, second.name, second.line);
    };
    std::map<std::vector<std::string>, const NamedPoint*> by_words;
    for (const auto& point : points) by_words[words_in(point.name)] = &point;
    const NamedPoint *front = nullptr, *rear = nullptr;  // the first wrong pair of front and rear
    int wrong = 0;                                       // number of wrong pairs less right ones
    for (const auto& [words, first] : by_words)
        for (std::size_t k = 0; k < words.size(); ++k)
            for (const auto& [word, axis] : opposites) {
                if (words[k] != word[0]) continue;
                auto other = words;
                other[k] = word[1];
                const auto second = by_words.find(other);
                if (second == by_words.end()) continue;
                const auto at = static_cast<std::size_t>(axis);
                const double a = along[at] * first->at[at], b = along[at] * second->second->at[at];
                const bool is_front_rear = word[0] == "front";
                if (is_front_rear) wrong += a < b ? 1 : -1;
                if (is_front_rear && a < b && front == nullptr) {
                    front = first;
                    rear = second->second;
                }
                if (!is_front_rear && (axis == 1 ? a < 0 && b > 0 : a < b))
                    refuse(*first, axis == 1 ? "to the right of" : "behind", *second->second);
            }
    if (front != nullptr && wrong >= 0) refuse(*front, "behind", *rear);
}

}  // namespace

Draft import_points(std::string_view text, const std::string& name, const Options& options) {
    if (options.axes.empty())
        fail(name, 0, "--axes", "a table of points does not say its axes; give them; allowed: {}",
             fmt::join(axes_of_tables, " "));
    if (!options.unit.empty() &&
        std::ranges::find(length_units, options.unit) == std::end(length_units))
        fail(name, 0, "--unit", "{} is not a unit of a coordinate; allowed: {}",
             reader::quote(options.unit), fmt::join(length_units, ", "));
    const auto along = directions(options.axes, name);
    const std::string ending = reader::small_letters(name.substr(name.rfind('.') + 1));
    const bool shark = ending == "shk", view = ending == "cmd";
    Draft draft = draft_of_points(name, shark  ? "points of Lotus SHARK"
                                        : view ? "commands of ADAMS/View"
                                               : "table of points");
    draft.remarks = {remark_on_axes(options.axes, along)};
    const auto points = shark  ? points_of_shark(text, name, options.unit, draft)
                        : view ? points_of_view(text, name, options.unit, draft)
                               : points_of_table(text, name, options, draft);
    remark_on_points(
        options, "Points only: bodies and joints are not in this file. Add yours below.", draft);
    if (points.empty()) fail(name, 0, "", "no point in this file");
    warn_of_equal_names(points, draft.notes);
    warn_of_equal_sides(points, draft.notes);
    check_opposites(points, along, name);
    for (const auto& point : points) {
        draft.points.add({along[0] * point.at[0], along[1] * point.at[1], along[2] * point.at[2]},
                         point.name, {point.line, point.name});
        draft.notes.count("point");
    }
    return draft;
}

}  // namespace elastocheck::importer
