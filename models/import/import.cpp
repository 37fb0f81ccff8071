#include "models/import/import.hpp"

#include <fmt/format.h>

#include <charconv>

#include "elastocheck/read_scene.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/text_file.hpp"

namespace elastocheck::importer {
namespace {

constexpr std::size_t largest_file = 16 << 20;  // [bytes]
constexpr std::size_t max_errors = 20;
// File name that the reader writes at the start of its messages on the scene of an import.
constexpr std::string_view scene_text_name = "scene";

std::string where(const SourceLocation& place) {
    return place.line > 0 ? fmt::format(":{}", place.line) : std::string();
}

// Throws one error with all missing parts, one a line.
[[noreturn]] void throw_missing_parts(const std::string& file, const Notes& notes) {
    std::string message;
    for (std::size_t k = 0; k < std::min(notes.missing.size(), max_errors); ++k) {
        const auto& [place, what] = notes.missing[k];
        message +=
            fmt::format("{}{}{}: {}: {}", k ? "\n" : "", place.file.empty() ? file : place.file,
                        where(place), reader::shown(place.what), what);
    }
    if (notes.missing.size() > max_errors)
        message += fmt::format("\n... and {} more of this kind", notes.missing.size() - max_errors);
    message += fmt::format(
        "\n{} a scene cannot represent; --allow-missing imports the rest and lists the missing "
        "entries in the head",
        notes.missing.size() == 1 ? "This" : fmt::format("These {}", notes.missing.size()));
    throw SceneError(message);
}

// Throws the reader's error on the draft with the place in the imported file in front.
[[noreturn]] void throw_scene_error(const std::string& file, const Text& text,
                                    std::string_view message) {
    int line = 0;
    if (message.starts_with(scene_text_name)) {
        message.remove_prefix(scene_text_name.size() + 1);
        const auto [end, error] =
            std::from_chars(message.data(), message.data() + message.size(), line);
        if (error == std::errc{})
            message.remove_prefix(std::min<std::size_t>(end - message.data() + 2, message.size()));
    }
    const SourceLocation from = line > 0 && line <= static_cast<int>(text.line_of.size())
                                    ? text.line_of[line - 1]
                                    : SourceLocation{};
    throw SceneError(fmt::format("{}{}: {}{}", from.file.empty() ? file : from.file, where(from),
                                 from.what.empty() ? "" : reader::shown(from.what) + ": ",
                                 fmt::format("the resulting scene is refused: {}", message)));
}

struct Format {
    std::string_view ending;  // extension of the file
    const char* what;
    Draft (*read)(std::string_view text, const std::string& file, Options& options);
    bool has_bodies;           // else points only
    std::string_view options;  // that apply to it
};
// An importer that does not change the options.
template <auto read>
Draft read_by(std::string_view text, const std::string& file, Options& options) {
    return read(text, file, options);
}
constexpr Format formats[] = {
    {".adm", "ADAMS datasets", read_by<import_adm>, true, ""},
    {".json", "Chrono::Vehicle suspensions and vehicles", read_by<import_chrono>, true, "--axle"},
    {".sub", "hardpoints of Adams/Car", read_by<import_subsystem>, false, "--axes --as --axle"},
    {".csv", "tables of points", read_by<import_points>, false,
     "--axes --as --axle --columns --unit"},
    {".xlsx", "workbooks of points", read_by<import_points>, false,
     "--axes --as --axle --columns --unit --sheet"},
    {".shk", "points of Lotus SHARK", read_by<import_points>, false, "--axes --as --axle --unit"},
    {".cmd", "points of ADAMS/View", read_by<import_points>, false, "--axes --as --axle --unit"},
    {".ini", "suspensions.ini of Assetto Corsa", import_assetto, false, "--as --axle"},
};

// "tables of points (.csv), points of Lotus SHARK (.shk)": the formats that take the option; all
// formats if it is empty.
std::string formats_with(std::string_view option) {
    std::string list;
    for (const Format& format : formats)
        if (format.options.find(option) != format.options.npos)
            list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", format.what, format.ending);
    return list;
}

void check_options(const Format& format, const Options& options, const std::string& file) {
    for (const auto& [given, option] : {std::pair{&options.axes, "--axes"},
                                        {&options.columns, "--columns"},
                                        {&options.unit, "--unit"},
                                        {&options.sheet, "--sheet"},
                                        {&options.axle, "--axle"},
                                        {&options.as, "--as"}})
        if (!given->empty() && format.options.find(option) == format.options.npos)
            fail(file, 0, option, "only for {}", formats_with(option));
    const bool makes_mechanism = !options.as.empty() || format.read == import_assetto;
    const bool has_mechanism_options = !options.pushrod.empty() || !options.damper.empty() ||
                                       !options.roles.empty() || !options.rates.empty() ||
                                       options.both_wheels || options.rocker;
    if (!makes_mechanism && has_mechanism_options)
        fail(file, 0, "--as",
             "missing; --pushrod, --rocker, --damper, --role, --rates and --both-wheels are of a "
             "mechanism: --as {}",
             fmt::join(mechanisms(), ", "));
    if (!makes_mechanism && !options.axle.empty() && !format.has_bodies)
        fail(file, 0, "--axle", "of points only with --as: {}", fmt::join(mechanisms(), ", "));
}

}  // namespace

Imported import_text(std::string_view text, const std::string& file, const Options& given) {
    const std::string ending =
        reader::small_letters(std::filesystem::path(file).extension().string());
    const auto format = std::ranges::find(formats, ending, &Format::ending);
    if (format == std::end(formats))
        fail(file, 0, "", "{} is not a supported file extension; allowed: {}",
             reader::quote(ending), formats_with(""));
    check_options(*format, given, file);
    Options options = given;
    Draft draft = format->read(text, file, options);  // may set options.as
    const bool makes_mechanism = !options.as.empty(),
               points_only = !format->has_bodies && !makes_mechanism;
    if (!draft.notes.missing.empty() && !options.allow_missing)
        throw_missing_parts(file, draft.notes);
    if (makes_mechanism) make_mechanism(file, options, draft);
    if (draft.bodies.empty() && !points_only)
        fail(file, 0, "",
             "the model has no moving part: no part has a joint or element that a scene "
             "can represent");
    const Text written = write(draft);
    Imported result{.yaml = written.yaml, .notes = draft.notes};
    if (points_only) return result;
    try {
        const Scene scene = parse_scene(written.yaml, std::string(scene_text_name));
        result.bodies = static_cast<int>(scene.bodies.size());
        result.joints = static_cast<int>(scene.joints.size());
        result.elements = static_cast<int>(scene.elastics.size());
    } catch (const SceneError& error) {
        throw_scene_error(file, written, error.what());
    }
    return result;
}

Imported import_file(const std::filesystem::path& file, const Options& options) {
    const std::string name = file.string();
    const reader::TextFile read = reader::read_text(file, reader::Pipes::refused, largest_file);
    if (!read.trouble.empty()) fail(name, 0, "", "{}", read.trouble);
    if (read.text.size() > largest_file)
        fail(name, 0, "", "larger than 16 MiB, the limit for a model");
    const bool is_workbook = reader::small_letters(file.extension().string()) == ".xlsx";
    return import_text(is_workbook ? csv_of_workbook(file, options.sheet) : read.text, name,
                       options);
}

}  // namespace elastocheck::importer
