// Imports a list of named points as kinematics programs print and export them: a CSV table with the
// columns name, x, y, z, or a listing with a name and three numbers in a line. Bodies and joints are
// not in it, so the result is an incomplete scene.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "models/import/import.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"
#include "models/reader/tables/csv.hpp"

namespace elastocheck::importer {
namespace {

std::optional<double> number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) ||
        std::abs(value) > 1e30)
        return std::nullopt;
    return value;
}

struct Columns {
    std::array<std::size_t, 4> at{};  // name, x, y, z
    double millimetres = 1;           // per unit of the coordinates
};

// "X [mm]", "x_m", "Point Name": the word, and the unit of a coordinate.
Columns columns_of(const std::vector<std::string_view>& cells, const std::string& file, int line) {
    Columns columns;
    std::array<bool, 4> found{};
    std::optional<double> unit;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const std::string title = reader::small_letters(cells[c]);
        const std::string word = title.substr(0, title.find_first_of(" [(_"));
        const std::size_t k = word == "name" || word == "point" || word == "hardpoint" ? 0
                              : word == "x"                                            ? 1
                              : word == "y"                                            ? 2
                              : word == "z"                                            ? 3
                                                                                       : 4;
        if (k == 4) continue;
        if (found[k])
            reader::fail(file, line, "", fmt::format("two columns of {}", k == 0 ? "names" : word));
        found[k] = true, columns.at[k] = c;
        if (k == 0) continue;
        std::string symbol = title.substr(word.size());
        std::erase_if(symbol, [](char ch) {
            return std::string_view(" [](_)").find(ch) != std::string_view::npos;
        });
        if (symbol.empty()) continue;
        const double mm = symbol == "mm" ? 1 : symbol == "m" ? 1000 : symbol == "in" ? 25.4 : 0;
        if (mm == 0)
            reader::fail(file, line, word,
                         fmt::format("{} is no unit of a coordinate; allowed: mm, m, in",
                                     reader::quote(symbol)));
        if (unit && *unit != mm)
            reader::fail(file, line, word, "the coordinates have different units");
        unit = mm;
    }
    for (std::size_t k = 0; k < 4; ++k)
        if (!found[k])
            reader::fail(file, line, "",
                         fmt::format("no column {}; a table of points has name, x, y, z",
                                     std::array{"name", "x", "y", "z"}[k]));
    columns.millimetres = unit.value_or(1);
    return columns;
}

}  // namespace

Draft import_points(std::string_view text, const std::string& name, const Options& options) {
    const bool table =
        reader::small_letters(std::filesystem::path(name).extension().string()) == ".csv";
    if (options.axes.empty())
        reader::fail(name, 0, "--axes",
                     fmt::format("a list of points does not say its axes; give them; allowed: {}",
                                 fmt::join(axes_of_tables, " ")));
    const auto [along_x, along_y] = directions(options.axes, name);
    const double along_z = along_x * along_y;
    Draft draft;
    draft.title = std::filesystem::path(name).stem().string();
    draft.source = name;
    draft.format = table ? "table of points" : "listing of points";
    draft.units = "{length: mm, angle: deg, force: N}";
    draft.remarks = {
        fmt::format("Axes rotated from {}, z {} to x forward, y left, z up (ISO 8855).",
                    options.axes, along_z > 0 ? "up" : "down"),
        "Points only: bodies and joints are not in this file. Add yours below."};
    draft.points = Hardpoints(1);
    std::optional<Columns> columns;
    if (!table) columns = Columns{};
    reader::CsvLines lines(text);
    while (lines.next()) {
        const int line = lines.number();
        std::string called;
        std::array<std::optional<double>, 3> p;
        if (table) {
            const auto cells = lines.cells();
            if (!columns) {
                columns = columns_of(cells, name, line);
                continue;
            }
            if (cells.size() <= std::ranges::max(columns->at))
                reader::fail(name, line, "",
                             fmt::format("{} cells; the head has more columns", cells.size()));
            called = cells[columns->at[0]];
            for (std::size_t k = 0; k < 3; ++k) p[k] = number(cells[columns->at[1 + k]]);
        } else {
            // the words of the line; the last three are the coordinates, a number before the name
            // is that of the line
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
            const bool is_point =
                n >= 4 && number(words[n - 1]) && number(words[n - 2]) && number(words[n - 3]);
            if (is_point) {
                for (std::size_t k = 0; k < 3; ++k) p[k] = number(words[n - 3 + k]);
                for (std::size_t k = n > 4 && number(words[0]) ? 1 : 0; k + 3 < n; ++k)
                    called += (called.empty() ? "" : " ") + std::string(words[k]);
            }
            if (!is_point || number(called)) {
                draft.notes.leave_out("no name with three numbers",
                                      {line, std::string(lines.whole())});
                continue;
            }
        }
        if (called.empty()) reader::fail(name, line, "name", "an empty cell");
        for (std::size_t k = 0; k < 3; ++k)
            if (!p[k])
                reader::fail(name, line, called,
                             fmt::format("{} is no number", std::array{"x", "y", "z"}[k]));
        const double mm = columns->millimetres;
        draft.points.add({along_x * mm * *p[0], along_y * mm * *p[1], along_z * mm * *p[2]}, called,
                         {line, called});
        draft.notes.count("point");
    }
    if (draft.points.entries().empty()) reader::fail(name, 0, "", "no point in this file");
    return draft;
}

}  // namespace elastocheck::importer
