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
constexpr std::size_t most_errors = 20;
constexpr std::string_view name_of_text = "scene";

std::string where(const SourceLocation& place) {
    return place.line > 0 ? fmt::format(":{}", place.line) : std::string();
}

// Throws one error with all missing parts, one a line.
[[noreturn]] void refuse(const std::string& file, const Notes& notes) {
    std::string message;
    for (std::size_t k = 0; k < std::min(notes.missing.size(), most_errors); ++k) {
        const auto& [place, what] = notes.missing[k];
        message +=
            fmt::format("{}{}{}: {}: {}", k ? "\n" : "", place.file.empty() ? file : place.file,
                        where(place), reader::shown(place.what), what);
    }
    if (notes.missing.size() > most_errors)
        message +=
            fmt::format("\n... and {} more of this kind", notes.missing.size() - most_errors);
    message += fmt::format(
        "\n{} a scene cannot represent; --allow-missing imports the rest and lists the missing "
        "entries in the head",
        notes.missing.size() == 1 ? "This" : fmt::format("These {}", notes.missing.size()));
    throw SceneError(message);
}

// Throws the reader's error with the source line of the scene's line.
[[noreturn]] void explain(const std::string& file, const Text& text, std::string_view message) {
    int line = 0;
    if (message.starts_with(name_of_text)) {
        message.remove_prefix(name_of_text.size() + 1);
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

}  // namespace

Imported import_text(std::string_view text, const std::string& file, const Options& options) {
    const std::string ending =
        reader::small_letters(std::filesystem::path(file).extension().string());
    const bool list = ending == ".csv", points_only = list || ending == ".sub";
    if (ending == ".shk")
        fail(file, 1, "",
             "files of SHARK are not read; export the points as a table (.csv) with "
             "columns name, x, y, z");
    if (ending != ".adm" && ending != ".json" && !points_only)
        fail(file, 0, "",
             "{} is not a supported file extension; allowed: .adm (ADAMS datasets), .json "
             "(Chrono::Vehicle suspensions and vehicles), .sub (hardpoints of Adams/Car), .csv "
             "(tables of points)",
             reader::quote(ending));
    if (!options.axes.empty() && !points_only)
        fail(
            file, 0, "--axes",
            "only for hardpoints of Adams/Car (.sub) and tables of points; the axes of a model are "
            "those of its file");
    for (const auto& [given, option] :
         {std::pair{&options.columns, "--columns"}, {&options.unit, "--unit"}})
        if (!given->empty() && !list) fail(file, 0, option, "only for tables of points (.csv)");
    if (!options.axle.empty() && ending != ".json")
        fail(file, 0, "--axle", "only for a vehicle of Chrono::Vehicle (.json)");
    const Draft draft = ending == ".adm"    ? import_adm(text, file, options)
                        : ending == ".json" ? import_chrono(text, file, options)
                        : list              ? import_points(text, file, options)
                                            : import_subsystem(text, file, options);
    if (!draft.notes.missing.empty() && !options.allow_missing) refuse(file, draft.notes);
    if (draft.bodies.empty() && !points_only)
        fail(file, 0, "",
             "the model has no moving part: no part has a joint or element that a scene "
             "can represent");
    const Text written = write(draft);
    Imported result{.yaml = written.yaml, .notes = draft.notes};
    if (points_only) return result;
    try {
        const Scene scene = parse_scene(written.yaml, std::string(name_of_text));
        result.bodies = static_cast<int>(scene.bodies.size());
        result.joints = static_cast<int>(scene.joints.size());
        result.elements = static_cast<int>(scene.elastics.size());
    } catch (const SceneError& error) {
        explain(file, written, error.what());
    }
    return result;
}

Imported import_file(const std::filesystem::path& file, const Options& options) {
    const std::string name = file.string();
    const reader::TextFile read = reader::read_text(file, reader::Pipes::refused, largest_file);
    if (!read.trouble.empty()) fail(name, 0, "", "{}", read.trouble);
    if (read.text.size() > largest_file)
        fail(name, 0, "", "larger than 16 MiB, the limit for a model");
    return import_text(read.text, name, options);
}

}  // namespace elastocheck::importer
