// Reads points and markers of command files of ADAMS/View (.cmd):
//
//   command := words (key "=" value)*      continued on the next line by "&"; "!" begins a comment
//
// A place is given in the frame of `relative_to`, else in the default coordinate system of the commands before: the
// model or ground (both at the origin), a part or a marker.
#include <Eigen/Geometry>
#include <map>
#include <numbers>
#include <optional>

#include "models/import/adm/statements.hpp"
#include "models/import/import.hpp"
#include "models/import/property/columns.hpp"
#include "models/import/property/named_points.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer {
namespace {

struct ViewCommand {
    int line = 0;
    std::string verb;                           // "marker create"
    std::map<std::string, std::string> fields;  // "location": "1, 2, 3"
};

// "part create part_name=.car.arm location=1, 2, 3": a key is the last word before a sign.
ViewCommand command_of(const std::string& text, int line) {
    ViewCommand command{line, "", {}};
    const auto pieces = split(text, "=");
    std::string key;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const bool is_last = k + 1 == pieces.size();
        const auto blank = pieces[k].find_last_of(" \t");
        const std::size_t end = is_last ? pieces[k].size() : blank == std::string::npos ? 0 : blank;
        const std::string value(reader::trimmed(pieces[k].substr(0, end)));
        (k == 0 ? command.verb : command.fields[key]) = value;
        key = reader::trimmed(std::string_view(pieces[k]).substr(end));
    }
    return command;
}

std::vector<ViewCommand> commands_of(std::string_view text) {
    std::vector<ViewCommand> commands;
    std::string open;
    int begin = 0;
    for (reader::Lines lines(text); lines.next();) {
        std::string_view line = lines.line();
        line = reader::trimmed(line.substr(0, line.find('!')));
        if (open.empty()) begin = lines.number();
        const bool goes_on = line.ends_with('&');
        if (goes_on) line.remove_suffix(1);
        open.append(line).append(" ");
        if (goes_on) continue;
        commands.push_back(command_of(std::string(reader::trimmed(open)), begin));
        open.clear();
    }
    if (!open.empty()) commands.push_back(command_of(open, begin));
    return commands;
}

struct ViewReader {
    const std::string& file;
    Notes& notes;
    std::map<std::string, Eigen::Isometry3d> frames = {};  // of parts and markers
    std::string system = {};                               // the default coordinate system
    std::string unit = {};
    double angle = std::numbers::pi / 180;  // [rad] per unit of angles without a suffix
    std::vector<NamedPoint> points = {};

    // The three numbers of a field, those with the suffix D in degrees; zeros without the field, none for an
    // expression.
    std::optional<Eigen::Vector3d> three_numbers(const ViewCommand& command, const char* key,
                                                 double unit_of_number) const {
        Eigen::Vector3d v = Eigen::Vector3d::Zero();
        const auto found = command.fields.find(key);
        if (found == command.fields.end()) return v;
        const auto cells = split(found->second, ",");
        if (cells.size() != 3) return std::nullopt;
        for (std::size_t k = 0; k < 3; ++k) {
            double x = 0;
            bool degrees = false;
            if (cells[k].empty() || adm::number_at(cells[k], x, degrees) != cells[k].size() ||
                !(std::abs(x) < 1e30))
                return std::nullopt;
            v[static_cast<Eigen::Index>(k)] =
                x * (degrees ? std::numbers::pi / 180 : unit_of_number);
        }
        return v;
    }

    // The frame that a command creates, with body-fixed angles 3-1-3; none if its place is an expression.
    std::optional<Eigen::Isometry3d> frame(const ViewCommand& command) const {
        const auto given = command.fields.find("relative_to");
        const std::string& parent = given == command.fields.end() ? system : given->second;
        const auto known = frames.find(parent);
        if (known == frames.end() && !parent.empty() && !parent.ends_with("ground"))
            fail(file, command.line, "relative_to", "no command before creates {}",
                 reader::quote(parent));
        Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
        if (known != frames.end()) result = known->second;
        const auto at = three_numbers(command, "location", 1),
                   angles = three_numbers(command, "orientation", angle);
        if (!at || !angles) return std::nullopt;
        result.translate(*at);
        for (const auto& [k, axis] : {std::pair{0, 2}, {1, 0}, {2, 2}})
            result.rotate(Eigen::AngleAxisd((*angles)[k], Eigen::Vector3d::Unit(axis)));
        return result;
    }

    void read(const ViewCommand& command) {
        const auto field = [&](const std::string& key) {
            const auto found = command.fields.find(key);
            return found == command.fields.end() ? std::string() : found->second;
        };
        const std::string kind = command.verb.substr(0, command.verb.find(' '));
        if (command.verb == "defaults units") {
            const std::string length = reader::small_letters(field("length"));
            for (const char* known : length_units)
                if (length == known || length == (known == std::string("m") ? "meter" : "inch"))
                    unit = known;
            if (!length.empty() && unit.empty())
                fail(file, command.line, "length", "{} is not a unit of a coordinate; allowed: {}",
                     reader::quote(length), fmt::join(length_units, ", "));
            if (field("angle").starts_with("rad")) angle = 1;
        } else if (command.verb == "defaults coordinate_system") {
            system = field("default_coordinate_system");
        } else if (command.verb == "model create") {
            frames[field("model_name")] = Eigen::Isometry3d::Identity();
        } else if (command.verb.starts_with(kind + " create") &&
                   (kind == "part" || kind == "point" || kind == "marker") &&
                   command.fields.contains("location")) {
            const std::string name = field(kind + "_name");
            const auto at = frame(command);
            if (!at)
                return notes.leave_out("with a place that is an expression", {command.line, name});
            frames.emplace(name, *at);
            if (kind == "part") return;
            const Eigen::Vector3d p = at->translation();
            points.push_back(
                {command.line, name.substr(name.rfind('.') + 1), {p.x(), p.y(), p.z()}});
        }
    }
};

}  // namespace

std::vector<NamedPoint> points_of_view(std::string_view text, const std::string& file,
                                       const std::string& option, Draft& draft) {
    ViewReader reading{file, draft.notes};
    for (const ViewCommand& command : commands_of(text)) reading.read(command);
    const std::string& unit = reading.unit.empty() ? option : reading.unit;
    if (unit.empty())
        fail(file, 0, "--unit", "the file does not say its unit of length; allowed: {}",
             fmt::join(length_units, ", "));
    if (!option.empty() && option != unit)
        fail(file, 0, "--unit", "{}; the file has its points in {}", option, unit);
    draft.remarks.push_back(fmt::format("Coordinates of the file in {}.", unit));
    for (NamedPoint& point : reading.points)
        for (double& x : point.at) x *= millimetres(unit);
    return std::move(reading.points);
}

}  // namespace elastocheck::importer
