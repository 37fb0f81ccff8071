#include "models/reader/tables/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "models/decimal.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/limits.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/text_file.hpp"
#include "models/reader/tables/property_file.hpp"
#include "models/reader/tables/sheet.hpp"

namespace elastocheck::reader {
namespace {

namespace fs = std::filesystem;

std::vector<TablePoint> read_rows(const Cursor& field, const LawUnits& units) {
    const auto rows = field.items();
    if (!field.is_list() || rows.size() < 2)
        field.fail(
            fmt::format("expected at least two rows [deflection, force], found {}", field.found()));
    if (rows.size() > max_rows)
        field.fail(fmt::format("{} rows; allowed: at most {}", rows.size(), max_rows));
    std::vector<TablePoint> points;
    for (std::size_t n = 0; n < rows.size(); ++n) {
        const auto cells = rows[n].items();
        if (!rows[n].is_list() || cells.size() != 2)
            rows[n].fail(fmt::format("row {}: expected two numbers, deflection and force, found {}",
                                     n + 1, rows[n].found()));
        const TablePoint point{units.deflection.si(cells[0].number(units.deflection.name)),
                               units.force.si(cells[1].number(units.force.name))};
        if (n > 0 && !(point.x > points.back().x))
            cells[0].fail(
                fmt::format("row {}: deflection {} is not larger than that of the row before",
                            n + 1, cells[0].found()));
        if (n > 0 && point.f < points.back().f)
            cells[1].fail(fmt::format(
                "row {}: force {} is smaller than that of the row before; it must not decrease",
                n + 1, cells[1].found()));
        points.push_back(point);
    }
    return points;
}

// ---- CSV: two numbers per line. Empty lines and lines that start with # are ignored; the first other
// line may be a header.

bool begins_with_number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double ignored = 0;
    return read_decimal(text.data(), text.data() + text.size(), ignored).ec !=
           std::errc::invalid_argument;
}

// Parses CSV to a list as in a scene, with the line numbers of the CSV file.
Value rows_of(std::string_view text, const std::string& file) {
    Value table{.kind = Value::Kind::list};
    bool is_first = true;
    for (SheetRow& read : read_sheet(text, file, 2).rows) {
        if (read.cells.front().starts_with('#')) continue;
        Value row{.kind = Value::Kind::list, .line = read.line};
        for (std::string& cell : read.cells)
            row.items.push_back(
                {.kind = Value::Kind::scalar, .text = std::move(cell), .line = read.line});
        const auto is_number = [](const Value& cell) { return begins_with_number(cell.text); };
        if (!std::exchange(is_first, false) || std::ranges::any_of(row.items, is_number))
            table.items.push_back(std::move(row));
    }
    return table;
}

struct FileBeside {
    std::string name, text;
};

// Reads a file in the scene's folder.
FileBeside read_beside(const Cursor& field, const Definitions& defs) {
    const fs::path name = field.text("the name of a file");
    if (name.is_absolute() || std::ranges::find(name, fs::path("..")) != name.end())
        field.fail(fmt::format(
            "{} is outside the scene's folder; allowed: a file in it, or in a folder below",
            field.found()));
    if (!defs.folder)
        field.fail("relative to the scene's file, but this scene is not a file; give a table");
    const fs::path path = *defs.folder / name;
    if (leads_out_of(*defs.folder, path))
        field.fail(
            fmt::format("{} is a symbolic link that leads out of the scene's folder; allowed: a "
                        "file in it, or in a "
                        "folder below",
                        field.found()));
    const TextFile file = read_text(path, Pipes::refused);
    if (!file.trouble.empty()) field.fail(fmt::format("{}: {}", field.found(), file.trouble));
    if (file.text.size() > largest_text)
        field.fail(fmt::format("{}: larger than 1 MiB, the limit for a table", field.found()));
    return {path.string(), file.text};
}

// Whether the name is that of an Adams/Car property file: spring, bump stop, rebound stop.
bool is_property_file(const std::string& name) {
    return name.ends_with(".spr") || name.ends_with(".bum") || name.ends_with(".reb");
}

std::vector<TablePoint> read_file(const Cursor& field, const LawUnits& units,
                                  const Definitions& defs) {
    const auto [file_name, text] = read_beside(field, defs);
    if (is_property_file(file_name)) {  // with its own units
        if (units.deflection.name != defs.units.length.name)
            field.fail(fmt::format(
                "{} is a curve over a length, but a curve over an angle is needed", field.found()));
        const PropertyFile file = parse_property_file(text, file_name);
        const PropertyBlock* curve = file.find("CURVE");
        if (!curve) fail(file_name, 0, "CURVE", "missing: the file has no curve");
        auto rows = curve_rows(file, *curve, file.length, file.force);
        // Adams/Car: pushing force over ℓ₀ - ℓ; here: force over ℓ - ℓ₀, both positive in tension.
        if (units.of_spring && file_name.ends_with(".spr")) {
            for (auto& row : rows) row = {-row.x, -row.f};
            std::ranges::reverse(rows);
        }
        return rows;
    }
    if (!is_utf8(text)) field.fail(fmt::format("{}: not plain text (UTF-8)", field.found()));
    const Value table = rows_of(text, file_name);
    std::vector<Number> ignored;  // numbers of a file are not numbers of the scene
    return read_rows({&table, field.path, &file_name, &ignored}, units);
}

}  // namespace

LawUnits of_lengths(const Units& units) { return {units.length, units.force, units.rate}; }
LawUnits of_springs(const Units& units) { return {units.length, units.force, units.rate, true}; }
LawUnits of_angles(const Units& units) {
    return {units.angle, units.moment, units.rotational_rate};
}

std::array<std::vector<TablePoint>, 6> read_bushing_file(const Cursor& field,
                                                         const Definitions& defs) {
    const auto [file_name, text] = read_beside(field, defs);
    const PropertyFile file = parse_property_file(text, file_name);
    constexpr const char* blocks[] = {"FX_CURVE", "FY_CURVE", "FZ_CURVE",
                                      "TX_CURVE", "TY_CURVE", "TZ_CURVE"};
    std::array<std::vector<TablePoint>, 6> curves;
    for (std::size_t k = 0; k < 6; ++k) {
        const PropertyBlock* block = file.find(blocks[k]);
        if (!block) fail(file_name, 0, blocks[k], "missing: a bushing has six curves");
        curves[k] = curve_rows(file, *block, k < 3 ? file.length : file.angle,
                               k < 3 ? file.force : file.force * file.length);
    }
    return curves;
}

std::optional<double> free_length_of_file(const Cursor& curve, const Definitions& defs) {
    const auto named = curve.optional("file");
    if (!named || !named->text("the name of a file").ends_with(".spr")) return std::nullopt;
    const auto [file_name, text] = read_beside(*named, defs);
    const PropertyFile file = parse_property_file(text, file_name);
    for (const auto& block : file.blocks)
        for (std::size_t k = 0; k < block.values.size(); ++k) {
            const auto& [key, value] = block.values[k];
            if (key != "FREE_LENGTH") continue;
            const double length =
                file.length * real(file, block.lines[k], block.name + ".FREE_LENGTH", value);
            if (!(length > 0))
                fail(file_name, block.lines[k], block.name + ".FREE_LENGTH",
                     fmt::format("{} is not a length; allowed: more than zero", value));
            return length;
        }
    return std::nullopt;
}

std::vector<TablePoint> read_table(const Cursor& curve, const LawUnits& units,
                                   const Definitions& defs) {
    const auto table = curve.optional("table"), file = curve.optional("file");
    if (table && file) file->fail("given together with table; allowed: one of the two");
    if (!table && !file) curve.fail("no points; required: table or file");
    return table ? read_rows(*table, units) : read_file(*file, units, defs);
}

}  // namespace elastocheck::reader
