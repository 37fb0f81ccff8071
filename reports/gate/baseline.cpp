#include "reports/gate/baseline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "reports/json/json.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using compare::Quantity;
using compare::Series;
using compare::ToleranceClass;
using json = nlohmann::ordered_json;

bool is_known(const std::string& unit) {
    return unit == "count" || compare::find_unit(unit);
}

// A field of the file with its path for messages.
struct Field {
    const json& value;
    std::string path;
};

[[noreturn]] void refuse(const Field& field, const std::string& what) {
    throw BaselineError(fmt::format("{}: {}", field.path.empty() ? "the file" : field.path, what));
}

// Requires exactly these fields of an object, and optionally `more`.
void expect_fields(const Field& in, std::initializer_list<const char*> names,
                   std::string_view more = "") {
    if (!in.value.is_object()) refuse(in, "is not an object");
    for (const char* name : names)
        if (!in.value.contains(name)) refuse(in, fmt::format("'{}' is missing", name));
    for (const auto& [name, unused] : in.value.items()) {
        if (name == more) continue;
        if (std::ranges::find(names, name) == names.end())
            refuse(in, fmt::format("'{}' is not known", name));
    }
}

Field at(const Field& in, const char* name) {
    return {in.value.at(name), in.path.empty() ? name : in.path + "." + name};
}

const json& array(const Field& field) {
    if (!field.value.is_array()) refuse(field, "is not a list");
    return field.value;
}

std::string text(const Field& field) {
    if (!field.value.is_string()) refuse(field, "is not a text");
    auto text = field.value.get<std::string>();
    if (const std::string wrong = flaw(text); !wrong.empty())
        refuse(field, "is not a line of text: " + wrong);
    return text;
}

// A text of several lines.
std::string paragraphs(const Field& field) {
    if (!field.value.is_string()) refuse(field, "is not a text");
    auto text = field.value.get<std::string>();
    std::string one_line = text;
    std::ranges::replace(one_line, '\n', ' ');
    if (const std::string wrong = flaw(one_line); !wrong.empty())
        refuse(field, "is not text: " + wrong);
    return text;
}

double number(const Field& field) {
    if (field.value.is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!field.value.is_number()) refuse(field, "is not a number");
    return field.value.get<double>();
}

std::vector<double> numbers(const Field& field) {
    std::vector<double> values;
    for (const auto& value : array(field)) values.push_back(number({value, field.path}));
    return values;
}

// The element of `kinds` with this name.
template <class Kinds>
auto named(const Field& field, const Kinds& kinds) {
    const std::string word = text(field);
    for (const auto kind : kinds)
        if (word == name(kind)) return kind;
    refuse(field, fmt::format("'{}' is not known", word));
}

Provenance provenance_of(const Field& field) {
    expect_fields(field,
                  {"elastocheck", "commit", "dirty", "compiler", "flags", "cpu", "libraries"});
    Provenance p;
    p.version = text(at(field, "elastocheck"));
    p.commit = text(at(field, "commit"));
    if (!field.value.at("dirty").is_boolean()) refuse(at(field, "dirty"), "is not true or false");
    p.dirty = field.value.at("dirty").get<bool>();
    p.compiler = text(at(field, "compiler"));
    p.flags = text(at(field, "flags"));
    p.cpu = text(at(field, "cpu"));
    const Field libraries = at(field, "libraries");
    if (!libraries.value.is_object()) refuse(libraries, "is not an object");
    for (const auto& [name, version] : libraries.value.items()) {
        if (const std::string wrong = flaw(name); !wrong.empty())
            refuse(libraries, "a name: " + wrong);
        p.libraries.push_back({name, text({version, libraries.path + "." + name})});
    }
    return p;
}

json tolerances_json(const compare::Tolerances& tolerances) {
    json result = json::object();
    for (const auto& [key, t] : tolerances) result[key] = {{"atol", t.atol}, {"rtol", t.rtol}};
    return result;
}

std::map<ToleranceClass, compare::Tolerances> tolerances_of(const Field& field) {
    std::map<ToleranceClass, compare::Tolerances> result;
    expect_fields(field, {name(ToleranceClass::same_build), name(ToleranceClass::cross_build),
                          name(ToleranceClass::physical)});
    for (const auto kind : compare::tolerance_classes) {
        const Field of_class = at(field, name(kind));
        if (!of_class.value.is_object()) refuse(of_class, "is not an object");
        compare::Tolerances& tolerances = result[kind];  // also if it has no entries
        for (const auto& [key, value] : of_class.value.items()) {
            const Field tolerance{value, of_class.path + "." + key};
            expect_fields(tolerance, {"atol", "rtol"});
            tolerances[key] = {number(at(tolerance, "atol")), number(at(tolerance, "rtol"))};
        }
    }
    return result;
}

Series series_of(const Field& field) {
    expect_fields(field, {"branch", "of", "channel", "unit", "values"});
    Series s{text(at(field, "branch")), named(at(field, "of"), compare::quantities),
             text(at(field, "channel")), text(at(field, "unit")), numbers(at(field, "values"))};
    if (!is_known(s.unit)) refuse(at(field, "unit"), fmt::format("'{}' is not known", s.unit));
    return s;
}

compare::Limit limit_of(const Field& field) {
    expect_fields(field, {"of", "channel", "max"});
    constexpr std::array deviations{Quantity::deviation_at_equal_parameter,
                                    Quantity::deviation_at_equal_abscissa};
    return {named(at(field, "of"), deviations), text(at(field, "channel")),
            number(at(field, "max"))};
}

// ["points.tie_rod_inner.z", -0.055, "m"]
Number number_of(const Field& field) {
    if (array(field).size() != 3) refuse(field, "is not [path, value, unit]");
    const auto entry = [&](std::size_t k) { return Field{field.value[k], field.path}; };
    return {text(entry(0)), number(entry(1)), text(entry(2))};
}

// [\n  one,\n  two\n ]
std::string one_a_line(const std::vector<json>& entries) {
    std::string lines;
    for (const auto& entry : entries) lines += (lines.empty() ? "\n  " : ",\n  ") + entry.dump();
    return "[" + lines + (entries.empty() ? "]" : "\n ]");
}

BaselineFile parse(const json& whole) {
    const Field top{whole, ""};
    if (!whole.is_object() || !whole.contains("schema"))
        refuse(top, "has no schema: it is not a baseline");
    if (const std::string schema = text(at(top, "schema")); schema != baseline_schema)
        refuse(at(top, "schema"),
               fmt::format("'{}' cannot be read by this version, which needs '{}'; accept anew",
                           schema, baseline_schema));
    expect_fields(
        top,
        {"schema", "scene", "accepted", "provenance", "tolerances", "limits", "branches", "series"},
        "numbers");
    BaselineFile file;
    const Field scene = at(top, "scene");
    expect_fields(scene, {"file", "name", "input_hash"});
    file.scene_file = text(at(scene, "file"));
    file.baseline.accepted.scene = text(at(scene, "name"));
    file.input_hash = text(at(scene, "input_hash"));
    if (whole.contains("numbers")) {
        file.numbers.emplace();
        for (const auto& entry : array(at(top, "numbers")))
            file.numbers->push_back(
                number_of({entry, fmt::format("numbers[{}]", file.numbers->size())}));
    }
    expect_fields(at(top, "accepted"), {"reason"});
    file.baseline.reason = paragraphs(at(at(top, "accepted"), "reason"));
    file.provenance = provenance_of(at(top, "provenance"));
    file.baseline.tolerances = tolerances_of(at(top, "tolerances"));
    for (const auto& limit : array(at(top, "limits")))
        file.baseline.limits.push_back(limit_of({limit, "limits"}));
    std::set<std::string> branches;
    for (const auto& entry : array(at(top, "branches"))) {
        const Field branch{entry, "branches"};
        expect_fields(branch, {"name", "unit", "parameter"});
        file.baseline.accepted.branches.push_back(
            {text(at(branch, "name")), text(at(branch, "unit")), numbers(at(branch, "parameter"))});
        if (!branches.insert(file.baseline.accepted.branches.back().name).second)
            refuse(branch, "a branch is there twice");
    }
    std::set<std::tuple<std::string, Quantity, std::string>> seen;
    for (const auto& entry : array(at(top, "series"))) {
        const Field field{entry, fmt::format("series[{}]", seen.size())};
        file.baseline.accepted.series.push_back(series_of(field));
        const Series& s = file.baseline.accepted.series.back();
        if (!seen.emplace(s.branch, s.quantity, s.channel).second) refuse(field, "is there twice");
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
    try {
        if (text.empty()) throw BaselineError("the file is empty");
        return parse(parse_json(text));
    } catch (const BaselineError& error) {
        throw BaselineError(fmt::format("{}: {}", file_name, error.what()));
    } catch (const JsonError& error) {
        throw BaselineError(
            fmt::format("{}: is not the JSON of a baseline: {}", file_name, error.what()));
    } catch (const json::exception& error) {
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
