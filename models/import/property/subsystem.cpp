// Hardpoints of an Adams/Car subsystem (.sub) as points of a scene. Joints and what they connect are in its template, which
// is another file: so this is a start, not a scene.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "models/import/import.hpp"
#include "models/reader/property_file.hpp"
#include "models/reader/words.hpp"
#include "models/reader/yaml.hpp"

namespace elastocheck::importer {
namespace {

double real(const reader::PropertyFile& file, int line, std::string_view text) {
    double value = 0;
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) ||
        std::abs(value) > 1e30)
        reader::fail(file.file, line, "HARDPOINT", fmt::format("{} is no number", reader::quote(text)));
    return value;
}

}  // namespace

// x rearward, y right, z up there; x forward, y left, z up here: turned about z by half a turn. 'left/right' stands for a
// pair and gives the left one.
Draft import_subsystem(std::string_view text, const std::string& name, const Options&) {
    const reader::PropertyFile file = reader::parse_property_file(text, name);
    Draft draft;
    draft.title = std::filesystem::path(name).stem().string();
    draft.source = name;
    draft.format = "hardpoints of an Adams/Car subsystem";
    draft.units = "{length: mm, angle: deg, force: N}";
    draft.remarks = {"Axes turned from x rearward, y right, z up to x forward, y left, z up.",
                     "Hardpoints alone: joints and bodies are in the subsystem's template, which is another "
                     "file. Put yours below."};
    draft.points = Hardpoints(1);
    bool any_pair = false;
    for (const auto& block : file.blocks) {
        if (block.name != "HARDPOINT") {
            if (block.name.ends_with("ASSEMBLY") && block.subblock.empty()) {
                std::string what = block.name;
                for (const auto& [key, value] : block.values)
                    if (key == "USAGE" || key == "PROPERTY_FILE") what += " " + value;
                draft.notes.warn({block.line, what},
                                 "not a part of this scene: what it connects is not in this file");
            }
            continue;
        }
        const auto column = [&](std::string_view wanted) -> std::size_t {
            for (std::size_t k = 0; k < block.table.columns.size(); ++k) {
                std::string title = block.table.columns[k];
                for (char& c : title)
                    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
                if (title == wanted || title == std::string(wanted) + "_value") return k;
            }
            reader::fail(file.file, block.line, "HARDPOINT", fmt::format("no column {}", wanted));
        };
        if (block.table.columns.empty()) continue;
        const std::size_t of_name = column("hardpoint_name"), of_side = column("symmetry"), x = column("x"),
                          y = column("y"), z = column("z");
        for (std::size_t n = 0; n < block.table.rows.size(); ++n) {
            const auto& row = block.table.rows[n];
            const int line = block.table.lines[n];
            const double mm = 1000 * file.length;
            const Eigen::Vector3d p(-mm * real(file, line, row[x]), -mm * real(file, line, row[y]),
                                    mm * real(file, line, row[z]));
            const std::string& side = row[of_side];
            const bool pair = side == "left/right" || side == "left" || side == "right";
            any_pair |= side == "left/right";
            const std::string called = row[of_name] + (pair ? side == "right" ? "_right" : "_left" : "");
            draft.points.at(p, called, {line, row[of_name]});
            draft.notes.count("HARDPOINT");
        }
    }
    if (draft.points.entries().empty()) reader::fail(file.file, 0, "HARDPOINT", "no hardpoint in this file");
    if (any_pair) draft.mirror = "left -> right";
    return draft;
}

}  // namespace elastocheck::importer
