// Reads points of Lotus SHARK; named_points.hpp describes the file.
#include "models/import/property/named_points.hpp"

#include <algorithm>
#include <optional>

#include "models/import/import.hpp"
#include "models/import/property/columns.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer {
namespace {

struct SharkLine {
    int number = 0;
    std::string_view text;
    std::vector<double> numbers = {};  // at its beginning
    std::string_view rest = {};        // behind them

    bool is_text() const { return numbers.empty(); }
    bool is_place() const { return numbers.size() == 3 && rest.empty(); }
};

std::vector<SharkLine> lines_of(std::string_view text) {
    std::vector<SharkLine> result;
    for (reader::Lines lines(text); lines.next();) {
        SharkLine line{lines.number(), reader::trimmed(lines.line())};
        if (line.text.empty()) continue;
        for (line.rest = line.text; !line.rest.empty();) {
            const auto cell = line.rest.substr(0, line.rest.find_first_of(" \t"));
            const auto value = coordinate(cell, false);
            if (!value) break;
            line.numbers.push_back(*value);
            line.rest = reader::trimmed(line.rest.substr(cell.size()));
        }
        result.push_back(line);
    }
    return result;
}

// The prefix of names "front_axle " or "rear_axle " after a line "FRONT SUSPENSION ..."; none for any other.
std::optional<std::string> prefix_in(const SharkLine& line) {
    const std::string text = reader::small_letters(line.text);
    for (const std::string end : {"front", "rear"})
        if (text.starts_with(end + " suspension")) return end + "_axle ";
    return std::nullopt;
}

struct SharkEnd {
    std::string prefix;
    std::vector<NamedPoint> points;
};

constexpr std::size_t words_of_point = 6;  // lines of words of a point: its name and five more

// The names under TEMP_SETTINGS, from line `at` to the next line "... SUSPENSION", where `at` stops.
std::vector<NamedPoint> names_of(const std::vector<SharkLine>& lines, std::size_t& at) {
    std::vector<NamedPoint> names;
    std::size_t words = 0;
    for (; at < lines.size() && !prefix_in(lines[at]); ++at) {
        if (lines[at].is_place() && words >= words_of_point) {
            const SharkLine& name = lines[at - words_of_point];
            names.push_back({name.number, std::string(name.text)});
        }
        words = lines[at].is_text() ? words + 1 : 0;
    }
    return names;
}

// The points under a line "... SUSPENSION": the coordinates in the order of the names, as many of each.
std::vector<NamedPoint> saved_points(const std::vector<SharkLine>& lines, std::size_t& next,
                                     std::vector<NamedPoint> names, const std::string& file) {
    const SharkLine& head = lines[next++];
    std::size_t count = 0;
    while (next < lines.size() && !lines[next].is_place() && lines[next].numbers.size() == 1)
        ++next;
    for (; next < lines.size() && lines[next].is_place(); ++next, ++count) {
        if (count == names.size())
            fail(file, lines[next].number, "",
                 "a point without a name: TEMP_SETTINGS has {} names for {}", names.size(),
                 reader::quote(head.text));
        names[count].line = lines[next].number;
        std::ranges::copy(lines[next].numbers, names[count].at.begin());
    }
    if (count < names.size())
        fail(file, head.number, "",
             "{} points for {} names of TEMP_SETTINGS, the first without "
             "one is {}",
             count, names.size(), reader::quote(names[count].name));
    return names;
}

// Ends of the car in a saved file.
std::vector<SharkEnd> saved_ends(const std::vector<SharkLine>& lines, const std::string& file,
                                 Draft& draft) {
    std::vector<SharkEnd> ends;
    std::vector<NamedPoint> names;
    for (std::size_t next = 0; next < lines.size();) {
        if (lines[next].text == "TEMP_SETTINGS") {
            if (const auto type = next + 2; type < lines.size() && lines[type].is_text()) {
                const std::string mechanism = mechanism_called(lines[type].text);
                draft.remarks.push_back(fmt::format(
                    "Type of suspension in the file: {}{}.", reader::shown(lines[type].text),
                    mechanism.empty()
                        ? ""
                        : fmt::format(" (import --as {} makes its mechanism)", mechanism)));
            }
            names = names_of(lines, ++next);
        } else if (const auto end = prefix_in(lines[next])) {
            if (names.empty())
                fail(file, lines[next].number, "",
                     "points without names: no TEMP_SETTINGS with names before this line");
            ends.push_back({*end, saved_points(lines, next, std::exchange(names, {}), file)});
        } else {
            ++next;
        }
    }
    return ends;
}

// Ends of the car in a listing; sets the unit that it declares.
std::vector<SharkEnd> listed_ends(const std::vector<SharkLine>& lines, const std::string& file,
                                  std::string& unit, Draft& draft) {
    std::vector<SharkEnd> ends;
    for (const SharkLine& line : lines) {
        const std::string word = reader::small_letters(line.text);
        for (const char* known : length_units)
            if (word.starts_with(fmt::format("({})", known)) && unit.empty()) unit = known;
        if (const auto end = prefix_in(line)) ends.push_back({*end, {}});
        constexpr std::string_view mark = "POINT:";
        if (!line.rest.starts_with(mark) || line.is_text()) {
            if (line.numbers.size() >= 3)
                fail(file, line.number, "",
                     "{} is neither a point of a listing (x y z POINT:1 name) nor of a saved file",
                     reader::quote(line.text));
            draft.notes.leave_out("line without coordinates",
                                  {line.number, std::string(line.text)});
            continue;
        }
        if (line.numbers.size() != 3)
            fail(file, line.number, "", "{} numbers before POINT:; expected x y z",
                 line.numbers.size());
        const auto blank = std::min(line.rest.find(' '), line.rest.size());
        const std::string name(reader::trimmed(line.rest.substr(blank)));
        if (name.empty()) fail(file, line.number, "name", "a point without a name");
        if (ends.empty()) ends.push_back({"", {}});
        NamedPoint point{line.number, name};
        std::ranges::copy(line.numbers, point.at.begin());
        ends.back().points.push_back(std::move(point));
    }
    return ends;
}

}  // namespace

std::vector<NamedPoint> points_of_shark(std::string_view text, const std::string& file,
                                        const std::string& option, Draft& draft) {
    const auto lines = lines_of(text);
    const bool is_saved = std::ranges::any_of(
        lines, [](const SharkLine& line) { return line.text == "TEMP_SETTINGS"; });
    std::string unit;
    auto ends = is_saved ? saved_ends(lines, file, draft) : listed_ends(lines, file, unit, draft);
    if (!option.empty() && !unit.empty() && option != unit)
        fail(file, 0, "--unit", "{}; the file has its points in {}", option, unit);
    if (unit.empty()) unit = option;
    draft.remarks.push_back(
        unit.empty() ? "Coordinates in mm, as the program saves them (--unit for others)."
                     : fmt::format("Coordinates of the file in {}.", unit));
    std::erase_if(ends, [](const SharkEnd& end) { return end.points.empty(); });
    std::vector<NamedPoint> points;
    for (SharkEnd& end : ends)
        for (NamedPoint& point : end.points) {
            if (ends.size() > 1) point.name = end.prefix + point.name;
            for (double& x : point.at) x *= millimetres(unit.empty() ? "mm" : unit);
            points.push_back(std::move(point));
        }
    return points;
}

}  // namespace elastocheck::importer
