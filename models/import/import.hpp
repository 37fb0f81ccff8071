// Imports models of other programs: converts a file to the text of a scene for the ordinary reader.
// README.md describes each format and what a scene can represent of it.
#pragma once

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/import/draft.hpp"

namespace elastocheck::importer {

struct Options {
    // wheel carrier, or a marker on it; empty: the default of the format
    std::string wheel = {};
    // leave out all that acts only against motion: dampers, friction, masses without gravity
    bool drop_dynamics = false;
    bool allow_missing = false;  // a part that cannot be represented is a warning, not an error
    // of a table of hardpoints: "x-rearward,y-right"; empty: the default of the format
    std::string axes = {};
    // of a table of points: "name=Punkt,x=X_mm,y=3,z=D"; empty: by headings that are known
    std::string columns = {};
    std::string sheet = {};  // of a workbook; empty: the only one with numbers
    // of the coordinates of a table of points: "mm", "cm", "m", "in"; empty: as the file says
    std::string unit = {};
    // of a vehicle of Chrono: "front" (its first), "rear" (its last), "1", "2", ...; of points of two
    // axles, which become a mechanism: "front", "rear"; empty: the only one
    std::string axle = {};
    // of points: the mechanism to make of them, "double_wishbone"; empty: points alone
    std::string as = {};
    std::string pushrod = {}, damper = {};  // on which of its parts: "upright", "lower", "upper"
    bool rocker = false;  // a pushrod to a rocker, from the damper's part if none is given
    std::vector<std::string> roles = {};  // "tie_rod_inner=NAME"
    bool both_wheels = false;             // the other one as the mirror image
    std::string rates = {};               // file of a table of rates by role; empty: rigid
};

// Allowed values of `axes`. z may be left out where z up makes the axes right-handed.
inline constexpr const char* axes_of_tables[] = {
    "x-forward,y-left",         "x-rearward,y-right",     "x-forward,y-right,z-down",
    "x-rearward,y-left,z-down", "x-forward,y-right,z-up", "x-rearward,y-left,z-up"};

// Throws SceneError "file:line: field: what"; line 0 or an empty field are omitted.
template <class... A>
[[noreturn]] void fail(const std::string& file, int line, const std::string& field,
                       fmt::format_string<A...> what, A&&... a) {
    reader::fail(file, line, field, fmt::format(what, std::forward<A>(a)...));
}

struct Imported {
    std::string yaml;
    Notes notes;
    int bodies = 0, elements = 0, joints = 0;
};

// Selects the format by extension: .adm, .json, .sub, .csv, .xlsx, .shk, .cmd, .ini. Throws SceneError
// "file:line: ..." for errors in the file and, unless allowed, for parts that a scene cannot represent.
Imported import_file(const std::filesystem::path& file, const Options& options);

// The same from text; for a workbook the text is the CSV of its sheet. `file` gives the format by its
// extension, and the name in messages and in the head of the scene.
Imported import_text(std::string_view text, const std::string& file, const Options& options);

// ---- Importers. import_points reads tables (.csv, sheets of .xlsx) and the points of .shk and .cmd files.
Draft import_adm(std::string_view text, const std::string& file, const Options& options);
Draft import_chrono(std::string_view text, const std::string& file, const Options& options);
Draft import_subsystem(std::string_view text, const std::string& file, const Options& options);
Draft import_points(std::string_view text, const std::string& file, const Options& options);
// One sheet of a workbook (.xlsx) as CSV with one line per row, so that line numbers of errors are rows:
// the sheet called `sheet`, or the only visible one with numbers. Formulas have their saved values.
// Throws SceneError for files that are not workbooks, and where several sheets have numbers.
std::string csv_of_workbook(const std::filesystem::path& file, const std::string& sheet);
// The same from the parts of the workbook, such as "xl/workbook.xml"; a missing part is empty.
using WorkbookParts = std::function<std::string(const std::string& name)>;
std::string csv_of_workbook(const WorkbookParts& parts, const std::string& file,
                            const std::string& sheet);
// Sets the mechanism and its roles in `options`, and clears the axle, which it has read.
Draft import_assetto(std::string_view text, const std::string& file, Options& options);

// ---- Mechanisms made of named points by templates of roles (mechanism/mechanisms.yaml).

// Assigns the points of a draft, by their names in the file (Entry::from), to the roles of the template
// options.as, and adds its bodies, joints, wheels and branches: rigid, or with options.rates. Points of
// line 0 stay as they are. Notes the point of each role and points without one. Throws SceneError for
// roles without a point, or with several.
void make_mechanism(const std::string& file, const Options& options, Draft& draft);

// Replaces joints at roles by bushings with the rates of a table, and adds springs beside dampers.
void add_rates(const std::string& file, Draft& draft);

// A section of mechanisms.yaml.
const reader::Value& mechanism_table(std::string_view name);

// Names of the templates; and the template that a description in a file means, such as "Double Wishbone,
// damper to lower wishbone"; empty if none.
const std::vector<std::string>& mechanisms();
std::string mechanism_called(std::string_view words);

// A draft without points, in mm, deg and N.
Draft draft_of_points(const std::string& file, const char* format);

// Factors ±1 from the axes of a table of hardpoints to x, y, z of a scene. Throws SceneError for axes that
// are not among axes_of_tables.
std::array<double, 3> directions(const std::string& axes, const std::string& file);
// Adds a remark to the head of a scene of points alone; a mechanism does not get it.
void remark_on_points(const Options& options, const char* remark, Draft& draft);
std::string remark_on_axes(const std::string& axes, const std::array<double, 3>& along);

}  // namespace elastocheck::importer
