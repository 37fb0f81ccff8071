// Replaces joints of a mechanism by bushings, and adds springs, with the rates of a table by role.
#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "models/import/import.hpp"
#include "models/import/property/columns.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/text_file.hpp"

namespace elastocheck::importer {
namespace {

using Eigen::Vector3d;

constexpr const char* rate_axes[] = {"x", "y", "z", "rx", "ry", "rz"};

struct RateRow {
    int line = 0;
    std::array<double, 6> k{};  // [N/mm], [N·mm/deg]
    bool is_used = false;
};
using RateTable = std::map<std::string, RateRow>;  // by role

// The unit in a heading such as "x [N/mm]", "rz [Nm/deg]", in N/mm or N·mm/deg.
double unit_of_rate(const std::string& heading, bool is_rotational, const std::string& file,
                    int line) {
    std::string unit =
        reader::small_letters(heading.substr(std::min(heading.find('['), heading.size())));
    std::erase_if(unit, [](char c) { return !reader::is_letter(c) && c != '/'; });
    const std::map<std::string, double> known =
        is_rotational ? std::map<std::string, double>{{"nmm/deg", 1},
                                                      {"nm/deg", 1e3},
                                                      {"nmm/rad", std::numbers::pi / 180},
                                                      {"nm/rad", 1e3 * std::numbers::pi / 180}}
                      : std::map<std::string, double>{{"n/mm", 1}, {"n/m", 1e-3}, {"kn/mm", 1e3}};
    const auto found = known.find(unit);
    if (found == known.end())
        fail(file, line, heading, "no unit of a rate; allowed: {}",
             is_rotational ? "[Nmm/deg], [Nm/deg], [Nmm/rad], [Nm/rad]" : "[N/mm], [N/m], [kN/mm]");
    return found->second;
}

RateTable read_rate_table(const std::string& file) {
    const reader::TextFile read = reader::read_text(file, reader::Pipes::refused);
    if (!read.trouble.empty()) fail(file, 0, "", "{}", read.trouble);
    const Sheet sheet = reader::read_sheet(read.text, file, 4);
    if (sheet.rows.empty()) fail(file, 0, "", "an empty table; expected role, x, y, z, rx, ry, rz");
    const SheetRow& head = sheet.rows.front();
    std::size_t role = SheetRow::max_cells;
    std::map<std::size_t, std::pair<std::size_t, double>> axis_of;  // by column: axis, unit
    for (std::size_t c = 0; c < head.cells.size(); ++c) {
        const std::string word =
            reader::small_letters(head.cells[c].substr(0, head.cells[c].find_first_of(" [")));
        const auto axis = std::ranges::find(rate_axes, word) - std::begin(rate_axes);
        if (word == "role")
            role = c;
        else if (axis < 6)
            axis_of[c] = {static_cast<std::size_t>(axis),
                          unit_of_rate(head.cells[c], axis >= 3, file, head.line)};
        else
            fail(file, head.line, "", "{} is not a column of a table of rates; allowed: role, {}",
                 reader::quote(head.cells[c]), fmt::join(rate_axes, ", "));
    }
    if (role == SheetRow::max_cells) fail(file, head.line, "role", "missing");
    RateTable table;
    for (std::size_t r = 1; r < sheet.rows.size(); ++r) {
        const SheetRow& row = sheet.rows[r];
        RateRow rates{row.line};
        for (const auto& [c, axis] : axis_of) {
            if (row.at(c).empty()) continue;
            const auto k = coordinate(row.at(c), sheet.separator != ',');
            if (!k || *k < 0)
                fail(file, row.line, std::string(row.at(role)), "{} is not a rate",
                     reader::quote(row.at(c)));
            rates.k[axis.first] = axis.second * *k;
        }
        if (!table.emplace(std::string(row.at(role)), rates).second)
            fail(file, row.line, std::string(row.at(role)), "given twice");
    }
    return table;
}

struct RateInserter {
    RateTable& table;
    Draft& draft;
    std::vector<Entry> joints = {};
    std::vector<std::string> roles = {};  // that can have a bushing

    Vector3d place(const std::string& role) const {
        const auto& entries = draft.points.entries();
        const auto found = std::ranges::find(entries, role, &Entry::name);
        return draft.points.positions()[static_cast<std::size_t>(found - entries.begin())];
    }

    // Frame with z from one point to the other and x the radial direction closest to the vertical, for an
    // upright axis closest to x.
    std::string frame(const std::string& from, const std::string& to) const {
        const bool is_upright = std::abs((place(to) - place(from)).normalized().z()) > 0.9;
        return fmt::format(", frame: {{z: [{}, {}], x: {}}}", from, to, is_upright ? "x" : "z");
    }

    // Adds a bushing at the point of a role with rates, else a spherical joint.
    void put(const std::string& role, const std::string& bodies, const std::string& axes) {
        const auto rates = table.find(role);
        if (rates == table.end()) {
            joints.push_back(
                {role, fmt::format("{{type: spherical, bodies: {}, at: {}}}", bodies, role), {}});
            return;
        }
        RateRow& row = rates->second;
        row.is_used = true;
        const auto three = [&](std::size_t k) {
            return triple({row.k[k], row.k[k + 1], row.k[k + 2]});
        };
        draft.bushings.push_back({role,
                                  fmt::format("{{bodies: {}, at: {}{}, rates: {}, "
                                              "rotational_rates: {}}}",
                                              bodies, role, axes, three(0), three(3)),
                                  {row.line, role}});
    }

    // The frame along the damper that ends at a point; empty if there is none.
    std::string frame_of_damper(const std::string& role) const {
        for (const Entry& damper : draft.dampers) {
            const reader::Value fields = reader::parse_yaml(damper.fields, damper.name);
            const std::string from = entry(fields, "from")->text, to = entry(fields, "to")->text;
            if (role == from || role == to) return frame(from, to);
        }
        return "";
    }

    // Replaces a joint by bushings or spherical joints at its ends if one of them has rates.
    void insert(const Entry& joint) {
        const reader::Value fields = reader::parse_yaml(joint.fields, joint.name);
        const auto text = [&](const char* key) { return entry(fields, key)->text; };
        const auto& pair = entry(fields, "bodies")->items;
        const std::string type = text("type"),
                          bodies = fmt::format("[{}, {}]", pair[0].text, pair[1].text);
        std::vector<std::string> ends;
        if (type == "distance")
            ends = {text("from"), text("to")};
        else if (type == "revolute" && entry(fields, "axis")->items.size() == 2)
            ends = {entry(fields, "axis")->items[0].text, text("at")};
        else if (type == "spherical" || type == "universal")
            ends = {text("at")};
        roles.insert(roles.end(), ends.begin(), ends.end());
        if (std::ranges::none_of(ends, [&](const auto& role) { return table.contains(role); })) {
            joints.push_back(joint);
        } else if (ends.size() == 1) {
            put(ends[0], bodies, frame_of_damper(ends[0]));
        } else if (type == "revolute") {
            for (const std::string& end : ends) put(end, bodies, frame(ends[0], ends[1]));
        } else {  // a distance becomes a body between its ends
            draft.bodies.push_back({joint.name, fmt::format("{{origin: {}}}", ends[0]), {}});
            put(ends[0], fmt::format("[{}, {}]", joint.name, pair[0].text),
                frame(ends[1], ends[0]));
            put(ends[1], fmt::format("[{}, {}]", joint.name, pair[1].text),
                frame(ends[0], ends[1]));
        }
    }

    // Adds a spring with the rate `spring` beside each damper.
    void add_springs() {
        const auto rates = table.find("spring");
        if (rates == table.end() || draft.dampers.empty()) return;
        rates->second.is_used = true;
        for (const Entry& damper : draft.dampers)
            draft.springs.push_back(
                {damper.name + "_spring",
                 fmt::format("{}, rate: {}}}", damper.fields.substr(0, damper.fields.size() - 1),
                             computed(rates->second.k[2])),
                 {rates->second.line, "spring"}});
    }
};

}  // namespace

void add_rates(const std::string& file, Draft& draft) {
    RateTable table = read_rate_table(file);
    RateInserter inserter{table, draft};
    for (const Entry& joint : draft.joints) inserter.insert(joint);
    inserter.add_springs();
    if (const auto spring = table.find("spring");
        spring != table.end() && !(spring->second.k[2] > 0))
        fail(file, spring->second.line, "spring", "no rate; expected it in the column z");
    draft.joints = std::move(inserter.joints);
    if (!draft.dampers.empty()) inserter.roles.emplace_back("spring");
    for (const auto& [role, row] : table)
        if (!row.is_used)
            fail(file, row.line, role, "is not a role here that can have rates{}",
                 reader::did_you_mean(role, inserter.roles, "allowed"));
    draft.remarks.push_back(fmt::format(
        "Rates by role of {}: z along the joint's axis, x the radial direction next to the "
        "vertical (of an upright axis next to the vehicle's x); of balls in the vehicle's axes.",
        file));
}

}  // namespace elastocheck::importer
