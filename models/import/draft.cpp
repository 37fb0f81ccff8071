#include "models/import/draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "models/reader/document/characters.hpp"

namespace elastocheck::importer {
namespace {

using Eigen::Vector3d;

constexpr std::size_t widest = 118;  // characters of a line
constexpr std::size_t longest_name = 64;
constexpr double same_place = 1e-9;  // of the model's size
// Hardpoints are sorted by their projection onto this direction, which is not normal to any plane in which
// models usually have many points.
const Vector3d sort_direction = Vector3d(0.6299, 0.5774, 0.5195).normalized();
constexpr std::size_t max_listed = 40;  // parts listed for one kind of note, in the head of a scene

std::string described(const SourceLocation& place) {
    const std::string file = place.file.empty() ? "" : printable(place.file) + ", ";
    return file + (place.line > 0 ? fmt::format("line {}, {}", place.line, printable(place.what))
                                  : printable(place.what));
}

// Writes an entry of a section, with line breaks at commas; its source goes at the end or above.
void write_entry(const Entry& entry, Text& text) {
    const std::string comment = entry.from.what.empty() ? "" : "# " + described(entry.from);
    std::string line = fmt::format("  {}: {}", entry.name, entry.fields);
    if (!comment.empty() && line.size() + 2 + comment.size() <= widest) {
        text.add_line(line + "  " + comment, entry.from);
        return;
    }
    if (!comment.empty()) text.add_line("  " + comment, entry.from);
    while (line.size() > widest) {
        std::size_t cut = line.rfind(", ", widest - 1);
        if (cut == std::string::npos || cut < 12) cut = line.find(", ", widest);
        if (cut == std::string::npos) break;
        text.add_line(line.substr(0, cut + 1), entry.from);
        line = "      " + line.substr(cut + 2);
    }
    text.add_line(line, entry.from);
}

void write_section(const char* name, const std::vector<Entry>& entries, Text& text) {
    if (entries.empty()) return;
    text.add_line("");
    text.add_line(fmt::format("{}:", name));
    for (const Entry& entry : entries) write_entry(entry, text);
}

std::string in_quotes(std::string_view title) {
    std::string result = "\"";
    for (const char c : printable(title)) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + "\"";
}

void comment(std::string_view what, Text& text, std::string_view indent = "") {
    std::string line = "# ", words(what);
    while (!words.empty()) {
        const std::size_t end = std::min(words.find(' '), words.size());
        if (line.size() + end > widest && line.size() > 2 + indent.size()) {
            line.pop_back();
            text.add_line(line);
            line = fmt::format("# {}  ", indent);
        }
        line += words.substr(0, end) + " ";
        words.erase(0, std::min(end + 1, words.size()));
    }
    line.pop_back();
    text.add_line(line);
}

}  // namespace

std::string printable(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c < 0x20 || c > 0x7E) c = '?';
    return result;
}

std::string replaced(std::string text, std::string_view word, std::string_view by) {
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + by.size()))
        text.replace(at, word.size(), by);
    return text;
}

std::vector<std::string> split(std::string_view text, std::string_view separator) {
    std::vector<std::string> parts;
    for (;;) {
        const auto end = std::min(text.find(separator), text.size());
        parts.emplace_back(reader::trimmed(text.substr(0, end)));
        if (end == text.size()) return parts;
        text.remove_prefix(end + separator.size());
    }
}

std::string number(double x) { return fmt::format("{}", x == 0 ? 0.0 : x); }

std::string computed(double x, double scale) {
    if (std::abs(x) <= 1e-12 * scale) return "0";
    const std::string digits = fmt::format("{:.12g}", x);
    double rounded = x;
    std::from_chars(digits.data(), digits.data() + digits.size(), rounded);  // in any locale
    return fmt::format("{}", rounded);
}

std::string triple(const Vector3d& v, double scale) {
    return fmt::format("[{}, {}, {}]", computed(v.x(), scale), computed(v.y(), scale),
                       computed(v.z(), scale));
}

std::string direction(const Vector3d& u) {
    for (int k = 0; k < 3; ++k)
        for (const double sign : {1.0, -1.0})
            if ((u - sign * Vector3d::Unit(k)).norm() <= 1e-12)
                return fmt::format("{}{}", sign < 0 ? "-" : "", "xyz"[k]);
    return triple(u);
}

std::string curve_of_rows(const std::vector<std::pair<double, double>>& rows, bool known_outside,
                          bool linear) {
    std::string text;
    for (const auto& [x, f] : rows)
        text += fmt::format("{}[{}, {}]", text.empty() ? "" : ", ", number(x), number(f));
    return fmt::format("{{table: [{}]{}{}}}", text, linear ? ", interpolation: linear" : "",
                       known_outside ? "" : ", outside: unknown");
}

Fields& Fields::add(std::string_view key, std::string_view value) {
    text_ += fmt::format("{}{}: {}", text_.empty() ? "" : ", ", key, value);
    return *this;
}

Fields& Fields::add(const Fields& more) {
    if (!text_.empty() && !more.text_.empty()) text_ += ", ";
    text_ += more.text_;
    return *this;
}

std::string Names::take(std::string_view wanted) {
    std::string name;
    for (const char c : wanted.substr(0, longest_name - 8)) {
        const bool fits =
            reader::is_word(c) || (!name.empty() && (c == '-' || c == '+' || c == '.'));
        name += fits ? c : '_';
    }
    if (name.empty()) name = "unnamed";
    if (taken_.insert(name).second) return name;
    for (int& k = last_.try_emplace(name, 1).first->second;;) {
        const std::string other = fmt::format("{}_{}", name, ++k);
        if (taken_.insert(other).second) return other;
    }
}

void Hardpoints::add(const Vector3d& position, std::string_view wanted,
                     const SourceLocation& from) {
    by_projection_.emplace(position.dot(sort_direction), positions_.size());
    positions_.push_back(position);
    entries_.push_back({names_.take(wanted), triple(position, size_), from});
}

std::string Hardpoints::at(const Vector3d& position, std::string_view wanted,
                           const SourceLocation& from) {
    const double near = same_place * size_, key = position.dot(sort_direction);
    for (auto found = by_projection_.lower_bound(key - near);
         found != by_projection_.end() && found->first <= key + near; ++found)
        if ((positions_[found->second] - position).norm() <= near)
            return entries_[found->second].name;
    add(position, wanted, from);
    return entries_.back().name;
}

namespace {

using Warning = std::pair<SourceLocation, std::string>;
// Warnings that differ only in their numbers.
struct WarningGroup {
    const Warning* worst;  // the one with the largest first number
    double size;           // that number
    std::vector<const Warning*> all;
};

// The groups of warnings, in the order of their first occurrence.
std::vector<WarningGroup> grouped(const std::vector<Warning>& warnings) {
    std::vector<WarningGroup> result;
    std::map<std::string, std::size_t> by_text;
    for (const Warning& warning : warnings) {
        std::string text;
        double first = -1;
        const std::string& what = warning.second;
        for (std::size_t k = 0; k < what.size();) {
            if (!reader::is_digit(what[k])) {
                text += what[k++];
                continue;
            }
            double number = 0;
            const auto [end, error] =
                std::from_chars(what.data() + k, what.data() + what.size(), number);
            if (first < 0 && error == std::errc{}) first = number;
            k = static_cast<std::size_t>(end - what.data());
            if (error != std::errc{}) ++k;
            text += '#';
        }
        const auto [found, is_new] = by_text.try_emplace(text, result.size());
        if (is_new) result.push_back({&warning, first, {}});
        WarningGroup& group = result[found->second];
        group.all.push_back(&warning);
        if (first > group.size) {
            group.worst = &warning;
            group.size = first;
        }
    }
    return result;
}

}  // namespace

std::string counted(int n, const std::string& kind) {
    if (n == 1 || reader::small_letters(kind) != kind) return fmt::format("{} {}", n, kind);
    return kind.ends_with('y') ? fmt::format("{} {}ies", n, kind.substr(0, kind.size() - 1))
                               : fmt::format("{} {}s", n, kind);
}

std::vector<std::string> described(const Notes& notes) {
    std::vector<std::string> lines;
    std::string understood;
    for (const auto& [kind, n] : notes.understood)
        understood += (understood.empty() ? "" : ", ") + counted(n, kind);
    lines.push_back("Understood: " + (understood.empty() ? "nothing" : understood) + ".");
    for (const auto& [role, point] : notes.roles)
        lines.push_back(fmt::format("Point {}: {}.", role, described(point)));
    for (const auto& [why, what] : notes.omitted) {
        std::string list;
        for (std::size_t k = 0; k < std::min(what.size(), max_listed); ++k)
            list += (list.empty() ? "" : "; ") + described(what[k]);
        if (what.size() > max_listed)
            list += fmt::format("; and {} more", what.size() - max_listed);
        lines.push_back(fmt::format("Left out, {}: {}.", why, list));
    }
    for (const WarningGroup& group : grouped(notes.warnings)) {
        const auto& [place, what] = *group.worst;
        std::string line = fmt::format("Warning: {}: {}", described(place), what);
        if (group.all.size() > 1) {
            line += fmt::format(" ({} of this kind, this is the largest; also ", group.all.size());
            std::string others;
            std::size_t shown = 0;
            for (const auto* warning : group.all)
                if (warning != group.worst && ++shown <= max_listed)
                    others += (others.empty() ? "" : "; ") + described(warning->first);
            if (shown > max_listed) others += fmt::format("; and {} more", shown - max_listed);
            line += others + ")";
        }
        lines.push_back(line + ".");
    }
    for (const auto& [place, what] : notes.missing)
        lines.push_back(fmt::format("MISSING: {}: {}.", described(place), printable(what)));
    if (!notes.missing.empty())
        lines.emplace_back("This scene is NOT equivalent to the file: it lacks the entries above.");
    return lines;
}

std::string commented(std::string_view what) {
    Text text;
    comment(what, text);
    return text.yaml;
}

std::vector<std::pair<const char*, std::vector<Entry>*>> Draft::sections() {
    return {{"bodies", &bodies},
            {"joints", &joints},
            {"bushings", &bushings},
            {"springs", &springs},
            {"stops", &stops},
            {"torsion_springs", &torsion_springs},
            {"static_loads", &static_loads},
            {"loads", &loads},
            {"branches", &branches},
            {"wheels", &wheels},
            {"probes", &probes},
            {"dampers", &dampers}};
}

Text write(Draft& draft) {
    Text text;
    comment(fmt::format("Imported from {} ({}).", printable(draft.source), draft.format), text);
    for (const std::string& remark : draft.remarks)  // a remark may quote the file
        comment(reader::is_utf8(remark) ? remark : printable(remark), text);
    for (const std::string& line : described(draft.notes)) comment(line, text);
    text.add_line("");
    text.add_line("elastocheck: 1");
    text.add_line("name: " + in_quotes(draft.title));
    text.add_line("units: " + draft.units);
    if (draft.mirror) text.add_line("mirror: " + *draft.mirror);
    if (draft.gravity) text.add_line("gravity: " + triple(*draft.gravity));
    write_section("points", draft.points.entries(), text);
    for (const auto& [name, entries] : draft.sections()) {
        if (entries != &draft.wheels || draft.wheels.size() != 1 ||
            draft.wheels[0].name != "wheel") {
            write_section(name, *entries, text);
            continue;
        }
        const Entry& wheel = draft.wheels[0];  // the short form for one
        text.add_line("");
        text.add_line(fmt::format("wheel: {}{}", wheel.fields,
                                  wheel.from.what.empty() ? "" : "  # " + described(wheel.from)));
    }
    return text;
}

}  // namespace elastocheck::importer
