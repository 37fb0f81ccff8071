#include "reports/gate/baseline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "reports/json/json.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using compare::Quantity;
using compare::ToleranceClass;
using json = nlohmann::ordered_json;

bool is_known(const std::string& unit) { return unit == "count" || compare::find_unit(unit); }

// The element of `kinds` with this name.
template <class Kinds>
auto named(const JsonCursor& field, const Kinds& kinds) {
    const std::string word = field.text();
    for (const auto kind : kinds)
        if (word == name(kind)) return kind;
    field.fail(fmt::format("'{}' is not known", word));
}

Provenance provenance_of(const JsonCursor& in) {
    in.only_keys({"elastocheck", "commit", "dirty", "compiler", "flags", "cpu", "libraries"});
    Provenance p;
    p.version = in["elastocheck"].text();
    p.commit = in["commit"].text();
    p.dirty = in["dirty"].truth();
    p.compiler = in["compiler"].text();
    p.flags = in["flags"].text();
    p.cpu = in["cpu"].text();
    for (const auto& [name, version] : in["libraries"].entries())
        p.libraries.push_back({name, version.text()});
    return p;
}

json tolerances_json(const compare::Tolerances& tolerances) {
    json result = json::object();
    for (const auto& [key, t] : tolerances) result[key] = {{"atol", t.atol}, {"rtol", t.rtol}};
    return result;
}

std::map<ToleranceClass, compare::Tolerances> tolerances_of(const JsonCursor& in) {
    std::map<ToleranceClass, compare::Tolerances> result;
    in.only_keys({name(ToleranceClass::same_build), name(ToleranceClass::cross_build),
                  name(ToleranceClass::physical)});
    for (const auto kind : compare::tolerance_classes) {
        compare::Tolerances& tolerances = result[kind];  // also if it has no entries
        for (const auto& [key, tolerance] : in[name(kind)].entries()) {
            tolerance.only_keys({"atol", "rtol"});
            tolerances[key] = {tolerance["atol"].number(), tolerance["rtol"].number()};
        }
    }
    return result;
}

compare::Series series_of(const JsonCursor& in) {
    in.only_keys({"branch", "of", "channel", "unit", "values"});
    compare::Series s{in["branch"].text(), named(in["of"], compare::quantities),
                      in["channel"].text(), in["unit"].text(), in["values"].numbers()};
    if (!is_known(s.unit)) in["unit"].fail(fmt::format("'{}' is not known", s.unit));
    return s;
}

compare::Limit limit_of(const JsonCursor& in) {
    in.only_keys({"of", "channel", "max"});
    constexpr std::array deviations{Quantity::deviation_at_equal_parameter,
                                    Quantity::deviation_at_equal_abscissa};
    return {named(in["of"], deviations), in["channel"].text(), in["max"].number()};
}

// ["points.tie_rod_inner.z", -0.055, "m"]
Number number_of(const JsonCursor& in) {
    const auto parts = in.items();
    if (parts.size() != 3) in.fail("is not [path, value, unit]");
    return {parts[0].text(), parts[1].number(), parts[2].text()};
}

// [\n  one,\n  two\n ]
std::string one_a_line(const std::vector<json>& entries) {
    std::string lines;
    for (const auto& entry : entries) lines += (lines.empty() ? "\n  " : ",\n  ") + entry.dump();
    return "[" + lines + (entries.empty() ? "]" : "\n ]");
}

BaselineFile parse(const JsonCursor& top) {
    if (!top.value->is_object() || !top.value->contains("schema"))
        top.fail("has no schema: it is not a baseline");
    if (const std::string schema = top["schema"].text(); schema != baseline_schema)
        top["schema"].fail(
            fmt::format("'{}' cannot be read by this version, which needs '{}'; accept anew",
                        schema, baseline_schema));
    top.only_keys(
        {"schema", "scene", "accepted", "provenance", "tolerances", "limits", "branches", "series"},
        "numbers");
    BaselineFile file;
    const JsonCursor scene = top["scene"];
    scene.only_keys({"file", "name", "input_hash"});
    file.scene_file = scene["file"].text();
    file.baseline.accepted.scene = scene["name"].text();
    file.input_hash = scene["input_hash"].text();
    if (top.value->contains("numbers")) {
        file.numbers.emplace();
        for (const auto& entry : top["numbers"].items()) file.numbers->push_back(number_of(entry));
    }
    top["accepted"].only_keys({"reason"});
    file.baseline.reason = top["accepted"]["reason"].lines();
    file.provenance = provenance_of(top["provenance"]);
    file.baseline.tolerances = tolerances_of(top["tolerances"]);
    for (const auto& limit : top["limits"].items()) file.baseline.limits.push_back(limit_of(limit));
    std::set<std::string> branches;
    for (const auto& branch : top["branches"].items()) {
        branch.only_keys({"name", "unit", "parameter"});
        file.baseline.accepted.branches.push_back(
            {branch["name"].text(), branch["unit"].text(), branch["parameter"].numbers()});
        if (!branches.insert(file.baseline.accepted.branches.back().name).second)
            branch.fail("the branch is given twice");
    }
    std::set<std::tuple<std::string, Quantity, std::string>> seen;
    for (const auto& entry : top["series"].items()) {
        file.baseline.accepted.series.push_back(series_of(entry));
        const compare::Series& s = file.baseline.accepted.series.back();
        if (!seen.emplace(s.branch, s.quantity, s.channel).second) entry.fail("is given twice");
    }
    return file;
}

// First line of the output of a command, "" when it fails.
std::string first_line(const std::string& command) {
    FILE* pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
    if (pipe == nullptr) return "";
    char buffer[256];
    std::string line;
    while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) line += buffer;
    return ::pclose(pipe) == 0 ? line.substr(0, line.find('\n')) : "";
}

}  // namespace

std::string baseline_text(const BaselineFile& file) {
    const compare::Baseline& b = file.baseline;
    std::vector<json> limits, numbers, branches, series;
    if (file.numbers)
        for (const auto& n : *file.numbers)
            numbers.push_back(json::array({n.path, n.value, n.unit}));
    for (const auto& limit : b.limits)
        limits.push_back(
            {{"of", name(limit.deviation)}, {"channel", limit.channel}, {"max", limit.max}});
    for (const auto& branch : b.accepted.branches)
        branches.push_back({{"name", branch.name}, {"unit", branch.unit}, {"parameter", branch.a}});
    for (const auto& s : b.accepted.series)
        series.push_back({{"branch", s.branch},
                          {"of", name(s.quantity)},
                          {"channel", s.channel},
                          {"unit", s.unit},
                          {"values", s.values}});
    const auto line = [](const char* key, const json& value) {
        return fmt::format(" \"{}\": {},\n", key, value.dump());
    };
    std::string text = "{\n" + line("schema", baseline_schema);
    text += line(
        "scene",
        {{"file", file.scene_file}, {"name", b.accepted.scene}, {"input_hash", file.input_hash}});
    text += line("accepted", {{"reason", b.reason}});
    text += line("provenance", provenance_json(file.provenance));
    text += " \"tolerances\": {";
    for (const char* separator = "\n"; const auto& [kind, tolerances] : b.tolerances) {
        text += fmt::format("{}  \"{}\": {}", separator, name(kind),
                            tolerances_json(tolerances).dump());
        separator = ",\n";
    }
    text += "\n },\n \"limits\": " + one_a_line(limits);
    if (file.numbers) text += ",\n \"numbers\": " + one_a_line(numbers);
    text += ",\n \"branches\": " + one_a_line(branches) + ",\n \"series\": " + one_a_line(series) +
            "\n}\n";
    return text;
}

BaselineFile parse_baseline(std::string_view text, const std::string& file_name) {
    if (text.empty()) throw BaselineError(file_name + ": the file is empty");
    try {
        const json whole = parse_json(text);
        return parse({&whole, "", &file_name});
    } catch (const ResultError& error) {
        throw BaselineError(error.what());
    } catch (const JsonError& error) {
        throw BaselineError(
            fmt::format("{}: is not the JSON of a baseline: {}", file_name, error.what()));
    }
}

BuildDistance distance(const Provenance& was, const Provenance& is) {
    std::string differs;
    const auto look_at = [&](const std::string& what, const std::string& a, const std::string& b) {
        if (a != b)
            differs += fmt::format("{}{}: {}, now {}", differs.empty() ? "" : "; ", what, a, b);
    };
    look_at("compiler", was.compiler, is.compiler);
    look_at("flags", was.flags, is.flags);
    look_at("CPU", was.cpu, is.cpu);
    const auto listed = [](const Provenance& p) {
        std::string list;
        for (const auto& library : p.libraries)
            list += (list.empty() ? "" : " ") + library.name + " " + library.version;
        return list;
    };
    look_at("libraries", listed(was), listed(is));
    return {differs.empty() ? ToleranceClass::same_build : ToleranceClass::cross_build, differs};
}

std::string not_committed(const std::filesystem::path& file) {
    // A container's checkout often belongs to another user, which git rejects; only blobs are
    // compared.
    const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
    const std::string git = "git -c safe.directory='*' -C " + for_shell(folder) + " ";
    const std::string leaf = file.filename().string();
    const std::string committed =
        first_line(git + "rev-parse --verify -q " + for_shell("HEAD:./" + leaf));
    if (committed.empty()) return "it is not committed to a git repository";
    if (committed != first_line(git + "hash-object -- " + for_shell(leaf)))
        return "it differs from what is committed";
    return "";
}

}  // namespace elastocheck::reports
