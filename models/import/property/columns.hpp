// Finds the columns of a table that are the name and the coordinates of points, and the unit of these.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "models/reader/tables/sheet.hpp"

namespace elastocheck::importer {

using reader::letters_of;
using reader::Sheet;
using reader::SheetRow;

struct Triple {
    std::string prefix;               // of the names of its points: "left_", "right_", or empty
    std::array<std::size_t, 3> at{};  // columns of x, y, z
};

struct PointColumns {
    std::size_t name = 0;
    std::optional<std::size_t> side;  // whose cells say left or right
    std::vector<Triple> triples;      // one, or left and right
    std::size_t first = 0;            // row of the first point
    std::string unit;                 // "mm", ...
    std::string unit_from;            // "by the heading 'X_mm' in line 1", "by --unit"
};

inline constexpr const char* length_units[] = {"mm", "cm", "m", "in"};
double millimetres(const std::string& unit);  // of one such unit

// `choice` is "name=Punkt,x=X_mm,y=3,z=D", each column by its heading, its number from 1 or its
// letters; instead of x, y, z also left.x, ..., right.z; or with side=COLUMN. Without a choice the
// columns are found by the headings name, point or hardpoint, x, y, z.
// `unit` is that of --unit; empty: headings or the lines below them say it.
// Throws SceneError with the headings of the table and the option that chooses among them.
PointColumns point_columns(const Sheet& sheet, const std::string& file, const std::string& choice,
                           const std::string& unit);

// A number in a table of points; the sign may be + or the minus sign U+2212. None for other text.
std::optional<double> coordinate(std::string_view cell, bool decimal_comma);

}  // namespace elastocheck::importer
