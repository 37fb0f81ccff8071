#include "reports/given/state_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "compare/outputs/not_a_number.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/tables/sheet.hpp"
#include "reports/files/csv_table.hpp"
#include "reports/files/limits.hpp"
#include "reports/json/json.hpp"
#include "reports/json/json_cursor.hpp"

namespace elastocheck::reports {
namespace {

using compare::CandidateState;
using json = nlohmann::ordered_json;

constexpr double length_tolerance = 1e-6;  // allowed deviation of a quaternion's length from one

// Nodes within a beam: bodies connected only to beam segments. Their poses may be omitted.
std::vector<bool> nodes_of(const Model& model) {
    std::vector<bool> beam(model.bodies.size(), false), other(model.bodies.size(), false);
    const auto mark = [](std::vector<bool>& list, BodyId body) {
        if (body != ground) list[static_cast<std::size_t>(body)] = true;
    };
    for (const auto& elastic : model.elastics)
        std::visit(
            [&](const auto& e) {
                for (const BodyId b : {e.i.body, e.j.body})
                    mark(elastic.written_as == WrittenAs::beam ? beam : other, b);
            },
            elastic.kind);
    for (const auto& joint : model.joints)
        for (const BodyId body : {joint.i, joint.j}) mark(other, body);
    for (const auto& wheel : model.wheels) mark(other, wheel.body);
    for (std::size_t b = 0; b < beam.size(); ++b) beam[b] = beam[b] && !other[b];
    return beam;
}

// Collects the states of a file, whose poses come one after the other.
struct States {
    const std::string& file;
    const Scene& scene;
    const Model& model;
    const Names& names;
    std::vector<CandidateState> list{};
    std::vector<int> lines{};
    std::set<std::string> passed_over{};

    void begin(std::string_view branch, double load, int line) {
        if (list.size() == max_measured_points)
            fail_at(
                file, line,
                fmt::format("more states than {}, the most that are read", max_measured_points));
        Pose missing;
        missing.r.setConstant(compare::nan);
        missing.p.coeffs().setConstant(compare::nan);
        list.push_back({branch_of_cell(branch, names, file, line, "branch"), load,
                        std::vector<Pose>(model.bodies.size(), missing)});
        lines.push_back(line);
    }

    // x, y, z [m], and a quaternion w, x, y, z; a value that is not finite makes the pose infinite.
    void add(CandidateState& state, const std::string& body, const std::array<double, 7>& values,
             const std::string& what, int line) {
        Pose pose{{values[0], values[1], values[2]},
                  Eigen::Quaterniond(values[3], values[4], values[5], values[6])};
        if (!std::ranges::all_of(values, [](double v) { return std::isfinite(v); })) {
            pose.r.setConstant(INFINITY);
            pose.p = Eigen::Quaterniond::Identity();
        } else if (const double length = pose.p.norm();
                   !(std::abs(length - 1) <= length_tolerance)) {
            fail_at(file, line,
                    fmt::format("{}: its length is {:.9g}; allowed: a unit quaternion w, x, y, z, "
                                "to 1e-6",
                                what, length));
        } else {
            pose.p.normalize();
        }
        const auto modelled = std::ranges::find(model.bodies, body, &Body::name);
        if (modelled == model.bodies.end()) {
            std::vector<std::string> known;
            for (const auto& of_scene : scene.bodies) known.push_back(of_scene.name);
            if (std::ranges::find(known, body) == known.end() && body != "ground")
                fail_at(file, line,
                        fmt::format("bodies: the scene has no body {}{}", reader::quote(body),
                                    reader::did_you_mean(body, known, "bodies")));
            passed_over.insert(body);
            return;
        }
        Pose& place = state.poses[static_cast<std::size_t>(modelled - model.bodies.begin())];
        if (!std::isnan(place.r.x()))
            fail_at(file, line, fmt::format("body '{}' is there already at this load", body));
        place = pose;
    }

    void check_complete() const {
        const auto node = nodes_of(model);
        for (std::size_t k = 0; k < list.size(); ++k)
            for (std::size_t b = 0; b < node.size(); ++b)
                if (!node[b] && std::isnan(list[k].poses[b].r.x()))
                    fail_at(file, lines[k],
                            fmt::format("bodies: body '{}' is missing", model.bodies[b].name));
    }
};

void read_state(const JsonCursor& object, int line, States& states) {
    object.only_keys({"branch", "load", "bodies"});
    const std::string branch = object["branch"].text();
    const double load = object["load"].number();  // NaN for null
    states.begin(branch, std::isfinite(load) ? load : INFINITY, line);
    for (const auto& [name, pose] : object["bodies"].entries()) {
        std::array<double, 7> values{};
        auto next = values.begin();
        for (const auto& [key, count, what] :
             {std::tuple{"position", 3u, "expected a list of 3 numbers [m]"},
              {"orientation", 4u, "expected a list of 4 numbers, w, x, y, z"}}) {
            const auto numbers = pose[key].numbers();
            if (numbers.size() != count) pose[key].fail(what);
            next = std::ranges::copy(numbers, next).out;
        }
        states.add(states.list.back(), name, values, pose["orientation"].path, line);
    }
}

void read_lines(std::string_view text, States& states) {
    int line = 0;
    while (!text.empty()) {
        ++line;
        const auto end = text.find('\n');
        const std::string_view content = text.substr(0, end);
        text = end == text.npos ? std::string_view{} : text.substr(end + 1);
        if (content.find_first_not_of(" \t\r") == content.npos) continue;
        try {
            const json object = parse_json(content);
            const std::string place = fmt::format("{}:{}", states.file, line);
            read_state({&object, "", &place}, line, states);
        } catch (const JsonError& error) {
            fail_at(states.file, line, error.what());
        } catch (const ResultError& error) {
            throw SheetError(error.what());
        }
    }
    if (states.list.empty()) fail_at(states.file, 0, "no state in it");
}

void read_rows(std::string_view csv, States& states) {
    static const std::vector<std::string> headings{"branch", "load", "body", "x",  "y",
                                                   "z",      "qw",   "qx",   "qy", "qz"};
    const std::string& file = states.file;
    std::vector<std::size_t> place;                                     // column of each heading
    std::map<std::pair<std::string, double>, std::size_t> state_index;  // by branch and load
    const auto head = [&](const Cells& cells, int line) {
        for (const auto& name : headings) {
            const auto found = std::ranges::find(cells, name);
            if (found == cells.end())
                fail_at(
                    file, line,
                    fmt::format("no column '{}'; states have {}", name, reader::listed(headings)));
            place.push_back(static_cast<std::size_t>(found - cells.begin()));
        }
        if (cells.size() != headings.size())
            fail_at(file, line, "a column too many; states have " + reader::listed(headings));
    };
    read_csv_table(csv, file, max_measured_points * 10, head, [&](const Cells& cells, int line) {
        const auto number = [&](std::size_t k) {
            const double value = number_or_infinity(cells[place[k]], file, line, headings[k]);
            if (std::isnan(value)) fail_at(file, line, headings[k] + ": an empty cell");
            return value;
        };
        const double load = number(1);
        const auto [entry, is_new] =
            state_index.try_emplace({std::string(cells[place[0]]), load}, states.list.size());
        if (is_new) states.begin(cells[place[0]], load, line);
        std::array<double, 7> values{};
        for (std::size_t k = 0; k < values.size(); ++k) values[k] = number(3 + k);
        states.add(states.list[entry->second], std::string(cells[place[2]]), values, "orientation",
                   line);
    });
}

bool begins_as_json(std::string_view content) {
    const auto first = content.find_first_not_of(" \t\r\n");
    return first != content.npos && content[first] == '{';
}

}  // namespace

bool holds_states(std::string_view content) {
    if (begins_as_json(content)) return true;
    const auto heading =
        content.substr(0, content.find_first_of("\r\n", content.find_first_not_of("\r\n")));
    const reader::Sheet sheet = reader::read_sheet(heading, "", 2);
    return !sheet.rows.empty() && std::ranges::count(sheet.rows.front().cells, "body") > 0 &&
           std::ranges::count(sheet.rows.front().cells, "qw") > 0;
}

std::vector<CandidateState> read_states(std::string_view content, const std::string& file,
                                        const Scene& scene, const Model& model, const Names& names,
                                        std::string& passed_over) {
    States states{file, scene, model, names};
    (begins_as_json(content) ? read_lines : read_rows)(content, states);
    states.check_complete();
    passed_over = reader::listed({states.passed_over.begin(), states.passed_over.end()});
    return std::move(states.list);
}

std::string state_line(const Model& model, const std::string& branch, const Equilibrium& state) {
    json bodies = json::object();
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const auto& [r, p] = state.poses[b];
        bodies[model.bodies[b].name] = {{"position", {r.x(), r.y(), r.z()}},
                                        {"orientation", {p.w(), p.x(), p.y(), p.z()}}};
    }
    return json{{"branch", branch}, {"load", state.load}, {"bodies", bodies}}.dump() + "\n";
}

}  // namespace elastocheck::reports
