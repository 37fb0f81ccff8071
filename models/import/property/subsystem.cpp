// Imports the hardpoints of an Adams/Car subsystem (.sub).
// Joints and connections are in its template, another file, so the result is an incomplete scene.
#include <fmt/format.h>

#include <algorithm>

#include "models/import/import.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/tables/property_file.hpp"

namespace elastocheck::importer {

Draft draft_of_points(const std::string& file, const char* format) {
    Draft draft;
    draft.title = std::filesystem::path(file).stem().string();
    draft.source = file;
    draft.format = format;
    draft.units = "{length: mm, angle: deg, force: N}";
    return draft;
}

std::array<double, 3> directions(const std::string& axes, const std::string& file) {
    if (axes == "x-forward,y-right" || axes == "x-rearward,y-left")
        fail(file, 0, "--axes",
             "{0} needs its z: {0},z-down is right-handed, {0},z-up is "
             "left-handed",
             axes);
    if (std::ranges::find(axes_of_tables, axes) == std::end(axes_of_tables))
        fail(file, 0, "--axes", "{} is not a set of axes; allowed: {}", reader::quote(axes),
             fmt::join(axes_of_tables, " "));
    return {axes.starts_with("x-forward") ? 1. : -1., axes.find("y-left") != axes.npos ? 1. : -1.,
            axes.ends_with("z-down") ? -1. : 1.};
}

std::string remark_on_axes(const std::string& axes, const std::array<double, 3>& along) {
    return fmt::format(
        "Axes turned from {}{} to x forward, y left, z up (ISO 8855){}.", axes,
        axes.find("z-") == axes.npos ? ", z up" : "",
        along[0] * along[1] * along[2] > 0 ? "" : "; those of the file are left-handed");
}

void remark_on_points(const Options& options, const char* remark, Draft& draft) {
    if (options.as.empty()) draft.remarks.emplace_back(remark);
}

// The file has x rearward, y right, z up unless options.axes is set; the scene has x forward, y
// left, z up. A 'left/right' hardpoint is a pair, of which the left one is written.
Draft import_subsystem(std::string_view text, const std::string& name, const Options& options) {
    const std::string axes = options.axes.empty() ? "x-rearward,y-right" : options.axes;
    const auto along = directions(axes, name);
    const reader::PropertyFile file = reader::parse_property_file(text, name);
    Draft draft = draft_of_points(name, "hardpoints of an Adams/Car subsystem");
    draft.remarks = {remark_on_axes(axes, along)};
    remark_on_points(options,
                     "Hardpoints only: joints and bodies are in the subsystem's template, which is "
                     "another file. Add yours below.",
                     draft);
    bool any_pair = false;
    for (const auto& block : file.blocks) {
        if (block.name != "HARDPOINT") {
            if (block.name.ends_with("ASSEMBLY") && block.subblock.empty()) {
                std::string what = block.name;
                for (const auto& [key, value] : block.values)
                    if (key == "USAGE" || key == "PROPERTY_FILE") what += " " + value;
                draft.notes.warn(
                    {block.line, what},
                    "not part of this scene: the bodies that it connects are not in this file");
            } else if (block.name != "UNITS") {
                draft.notes.leave_out(
                    "without hardpoints",
                    {block.line,
                     block.name + (block.subblock.empty() ? "" : " " + block.subblock)});
            }
            continue;
        }
        const auto column = [&](std::string_view wanted) -> std::size_t {
            for (std::size_t k = 0; k < block.table.columns.size(); ++k) {
                const std::string title = reader::small_letters(block.table.columns[k]);
                if (title == wanted || title == std::string(wanted) + "_value") return k;
            }
            fail(file.file, block.line, "HARDPOINT", "no column {}", wanted);
        };
        if (block.table.columns.empty()) continue;
        const std::size_t name_column = column("hardpoint_name"), side_column = column("symmetry"),
                          xyz[] = {column("x"), column("y"), column("z")};
        for (std::size_t n = 0; n < block.table.rows.size(); ++n) {
            const auto& row = block.table.rows[n];
            const int line = block.table.lines[n];
            Eigen::Vector3d p;
            for (const std::size_t k : {0, 1, 2})
                p[static_cast<Eigen::Index>(k)] =
                    along[k] * (1000 * file.length) *
                    reader::real(file, line, "HARDPOINT", row[xyz[k]], 1e30);
            const std::string& side = row[side_column];
            const bool pair = side == "left/right" || side == "left" || side == "right";
            any_pair |= side == "left/right";
            const std::string point =
                row[name_column] + (pair ? side == "right" ? "_right" : "_left" : "");
            draft.points.add(p, point, {line, row[name_column]});
            draft.notes.count("HARDPOINT");
        }
    }
    if (draft.points.entries().empty())
        fail(file.file, 0, "HARDPOINT", "no hardpoint in this file");
    if (any_pair) draft.mirror = "left -> right";
    return draft;
}

}  // namespace elastocheck::importer
