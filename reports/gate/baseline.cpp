#include "reports/gate/baseline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "reports/files/subprocess.hpp"
#include "reports/json/json.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;
using compare::Quantity;
using compare::ToleranceClass;
using json = nlohmann::ordered_json;

bool is_known(const std::string& unit) {
    return unit == "count" || unit == compare::per_metre || compare::find_unit(unit);
}

Quantity quantity_of(const std::string& name, const JsonCursor& place) {
    const auto found = std::ranges::find(compare::quantities, name, &compare::QuantityKind::name);
    if (found == compare::quantities.end()) place.fail(fmt::format("'{}' is not known", name));
    return static_cast<Quantity>(found - compare::quantities.begin());
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

compare::Limit limit_of(const JsonCursor& in) {
    if (!in.find("figure")) {
        in.only_keys({"of", "channel", "max"});
        const Quantity of = quantity_of(in["of"].text(), in["of"]);
        if (of != Quantity::deviation_at_equal_parameter &&
            of != Quantity::deviation_at_equal_abscissa)
            in["of"].fail(fmt::format("'{}' is not a deviation", name(of)));
        return {.of = of, .channel = in["channel"].text(), .max = in["max"].number()};
    }
    compare::Limit limit{
        .of = Quantity::equilibrium, .channel = in["figure"].text(), .unit = in["unit"].text()};
    for (const auto& [key, value] : in.entries()) {
        if (key == "max")
            limit.max = value.number();
        else if (key == "min")
            limit.min = value.number();
        else if (key == "over")
            limit.over = value.text();
        else if (key != "figure" && key != "unit")
            in.fail(fmt::format("'{}' is not known", key));
    }
    if (!in.value->contains("min") && !in.value->contains("max")) in.fail("needs min or max");
    if (!is_known(limit.unit)) in["unit"].fail(fmt::format("'{}' is not known", limit.unit));
    return limit;
}

json limit_json(const compare::Limit& limit) {
    if (limit.of != Quantity::equilibrium)
        return {{"of", name(limit.of)}, {"channel", limit.channel}, {"max", limit.max}};
    json out = {{"figure", limit.channel}, {"unit", limit.unit}};
    if (!limit.over.empty()) out["over"] = limit.over;
    if (!std::isinf(limit.min)) out["min"] = limit.min;
    if (!std::isinf(limit.max)) out["max"] = limit.max;
    return out;
}

// ["points.tie_rod_inner.z", -0.055, "m"]
Number number_of(const JsonCursor& in) {
    const auto parts = in.items();
    if (parts.size() != 3) in.fail("is not [path, value, unit]");
    return {parts[0].text(), parts[1].number(), parts[2].text()};
}

// "toe [deg]"
std::string heading(const compare::Series& s) { return fmt::format("{} [{}]", s.channel, s.unit); }

std::pair<std::string, std::string> channel_and_unit(const std::string& key,
                                                     const JsonCursor& field) {
    const auto at = key.rfind(" [");
    if (at == key.npos || !key.ends_with("]")) field.fail("is not a name with its [unit]");
    const std::string unit = key.substr(at + 2, key.size() - at - 3);
    if (!is_known(unit)) field.fail(fmt::format("the unit '{}' is not known", unit));
    return {key.substr(0, at), unit};
}

// ---- The figures to review.

// To the digits that an engineer notices.
double shown(double value, const std::string& unit) {
    static const std::map<std::string_view, int> decimals{
        {"mm", 2}, {"deg", 3}, {"N", 0}, {"N·m", 1}, {"%", 1}};
    if (!std::isfinite(value)) return value;
    const auto own = decimals.find(unit);
    const std::string text = own != decimals.end()    ? fmt::format("{:.{}f}", value, own->second)
                             : std::abs(value) < 1e-6 ? "0"
                                                      : fmt::format("{:.4g}", value);
    return parsed_number(text) + 0.0;  // + 0.0: no negative zero
}

// Figures with equal values of several wheels or springs, on one line: "left, right: toe [deg]". A
// name of a scene has neither comma nor colon.
struct FigureLine {
    std::vector<std::string> channels;
    std::string unit;
    json values;
};

// "left" and "toe" of "left.toe"; no owner without a point.
std::pair<std::string, std::string> owner_and_output(const std::string& channel) {
    const auto point = channel.rfind('.');
    if (point == channel.npos) return {"", channel};
    return {channel.substr(0, point), channel.substr(point + 1)};
}

std::string figure_key(const FigureLine& line) {
    std::string owners;
    for (const auto& channel : line.channels)
        owners += (owners.empty() ? "" : ", ") + owner_and_output(channel).first;
    return fmt::format("{} [{}]",
                       line.channels.size() == 1
                           ? line.channels.front()
                           : owners + ": " + owner_and_output(line.channels.front()).second,
                       line.unit);
}

json figures_json(const compare::Measurement& measurement) {
    json curves = json::object();
    for (const auto& branch : measurement.branches) {
        const auto stations = compare::stations(branch.a);
        std::vector<FigureLine> lines;
        for (const auto& s : measurement.series) {
            if (!s.main || s.branch != branch.name) continue;
            json values = json::array();
            for (std::size_t k = 0; k < stations.size(); ++k) {
                const std::size_t place = s.values.size() == stations.size() ? k : stations[k];
                if (place < s.values.size()) values.push_back(shown(s.values[place], s.unit));
            }
            const auto [owner, output] = owner_and_output(s.channel);
            const auto same = std::ranges::find_if(
                lines, [&, &owner = owner, &output = output](const FigureLine& line) {
                    const auto [line_owner, line_output] = owner_and_output(line.channels.front());
                    return !owner.empty() && !line_owner.empty() && output == line_output &&
                           s.unit == line.unit && values == line.values;
                });
            if (same == lines.end())
                lines.push_back({{s.channel}, s.unit, values});
            else
                same->channels.push_back(s.channel);
        }
        if (lines.empty()) continue;
        json parameters = json::array(), figures = json::object();
        for (const std::size_t k : stations) parameters.push_back(branch.a[k]);
        for (const auto& line : lines) figures[figure_key(line)] = line.values;
        curves[branch.name] = {{"at", parameters}, {"unit", branch.unit}, {"figures", figures}};
    }
    return curves;
}

// ---- Text.

// "KEY": [\n  one,\n  two\n ]
std::string list_text(const char* key, const std::vector<json>& entries) {
    std::string lines;
    for (const auto& entry : entries) lines += (lines.empty() ? "\n  " : ",\n  ") + entry.dump();
    return fmt::format(" \"{}\": [{}{}]", key, lines, entries.empty() ? "" : "\n ");
}

// An object as text; its entries, and those of objects within it down to `depth`, a line each.
std::string object_text(const json& object, int depth, int indent = 1) {
    if (depth == 0 || object.empty()) return object.dump();
    std::string lines;
    for (const auto& [key, value] : object.items())
        lines += fmt::format(
            "{}\n{:{}}{}: {}", lines.empty() ? "" : ",", "", indent + 1, json(key).dump(),
            value.is_object() ? object_text(value, depth - 1, indent + 1) : value.dump());
    return fmt::format("{{{}\n{:{}}}}", lines, "", indent);
}

std::string curves_text(const BaselineFile& file) {
    const compare::Measurement& m = file.baseline.accepted;
    json branches = json::object();
    for (const auto& branch : m.branches) {
        json& of_branch = branches[branch.name] = {
            {"unit", branch.unit}, {"parameter", branch.a}, {"main", json::array()}};
        for (const auto& s : m.series) {
            if (s.branch != branch.name) continue;
            of_branch[name(s.quantity)][heading(s)] = s.values;
            if (s.main) of_branch["main"].push_back(s.channel);
        }
    }
    std::vector<json> numbers;
    for (const auto& n : file.numbers) numbers.push_back(json::array({n.path, n.value, n.unit}));
    return fmt::format("{{\n \"schema\": \"{}\",\n{},\n \"branches\": {}\n}}\n",
                       baseline_curves_schema, list_text("numbers", numbers),
                       object_text(branches, 3));
}

void check_schema(const JsonCursor& top, const char* wanted) {
    if (!top.value->is_object() || !top.value->contains("schema"))
        top.fail("has no schema: it is not a baseline");
    if (const std::string schema = top["schema"].text(); schema != wanted)
        top["schema"].fail(fmt::format(
            "'{}' cannot be read by this version, which needs '{}'; accept anew", schema, wanted));
}

void parse_curves(const JsonCursor& top, BaselineFile& file) {
    check_schema(top, baseline_curves_schema);
    top.only_keys({"schema", "numbers", "branches"});
    for (const auto& entry : top["numbers"].items()) file.numbers.push_back(number_of(entry));
    compare::Measurement& m = file.baseline.accepted;
    for (const auto& [branch, of_branch] : top["branches"].entries()) {
        m.branches.push_back({branch, of_branch["unit"].text(), of_branch["parameter"].numbers()});
        const auto main = of_branch["main"].texts();
        for (const auto& [key, list] : of_branch.entries()) {
            if (key == "unit" || key == "parameter" || key == "main") continue;
            const Quantity quantity = quantity_of(key, of_branch);
            const bool is_figure = quantity == Quantity::equilibrium ||
                                   quantity == Quantity::characteristic_equilibrium;
            for (const auto& [title, values] : list.entries()) {
                const auto [channel, unit] = channel_and_unit(title, values);
                m.series.push_back({branch, quantity, channel, unit, values.numbers(),
                                    is_figure && std::ranges::find(main, channel) != main.end()});
            }
        }
    }
    std::ranges::sort(m.series, {}, [](const compare::Series& s) {
        return std::tie(s.branch, s.quantity, s.channel);
    });
}

BaselineFile parse_review(const JsonCursor& top, const JsonCursor& curves) {
    check_schema(top, baseline_schema);
    top.only_keys(
        {"schema", "scene", "accepted", "provenance", "curves", "tolerances", "limits", "figures"});
    BaselineFile file;
    const JsonCursor scene = top["scene"];
    scene.only_keys({"file", "name", "input_hash"});
    file.scene_file = scene["file"].text();
    file.baseline.accepted.scene = scene["name"].text();
    file.input_hash = scene["input_hash"].text();
    top["accepted"].only_keys({"reason"});
    file.baseline.reason = top["accepted"]["reason"].lines();
    file.provenance = provenance_of(top["provenance"]);
    top["curves"].only_keys({"hash"});
    file.baseline.tolerances = tolerances_of(top["tolerances"]);
    for (const auto& limit : top["limits"].items()) file.baseline.limits.push_back(limit_of(limit));
    parse_curves(curves, file);
    return file;
}

// Throws LimitError for a limit with min above max. Limits contain no objects: the k-th brace after
// "limits" begins the k-th limit.
void check_limits(const std::vector<compare::Limit>& limits, std::string_view review,
                  const std::string& file) {
    std::size_t at = review.find("\"limits\"");
    for (std::size_t k = 0; k < limits.size(); ++k) {
        at = review.find('{', at + 1);
        if (!(limits[k].min > limits[k].max)) continue;
        throw LimitError(fmt::format("{}:{}: limits.{}: min {:g} is above max {:g}", file,
                                     1 + std::ranges::count(review.substr(0, at), '\n'), k + 1,
                                     limits[k].min, limits[k].max));
    }
}

// Parses both files and returns the result of `use`. Throws BaselineError.
template <class Use>
auto with_json(const BaselineText& text, const std::string& file_name, Use use) {
    const std::string curves_name = curves_of(file_name).string();
    const auto parse = [](const std::string& content, const std::string& name) {
        if (content.empty()) throw BaselineError(name + ": the file is empty");
        try {
            return parse_json(content);
        } catch (const JsonError& error) {
            throw BaselineError(
                fmt::format("{}: is not the JSON of a baseline: {}", name, error.what()));
        }
    };
    const json review = parse(text.review, file_name), curves = parse(text.curves, curves_name);
    try {
        return use(JsonCursor{&review, "", &file_name}, JsonCursor{&curves, "", &curves_name});
    } catch (const ResultError& error) {
        throw BaselineError(error.what());
    }
}

// First line of the output of git in a folder, "" when it fails. Git rejects the checkout of another
// user, which is usual in a container, unless it is declared safe; only hashes of files are read.
std::string git(const std::string& folder, std::vector<std::string> words) {
    words.insert(words.begin(), {"git", "-c", "safe.directory=*", "-C", folder});
    constexpr double limit = 60;  // [s]
    const ProcessResult result = run(words, limit);
    return result.succeeded() ? result.output_text.substr(0, result.output_text.find('\n')) : "";
}

}  // namespace

BaselineText baseline_text(const BaselineFile& file) {
    const compare::Baseline& b = file.baseline;
    const std::string curves = curves_text(file);
    std::vector<json> limits;
    for (const auto& limit : b.limits) limits.push_back(limit_json(limit));
    json tolerances = json::object();
    for (const auto& [kind, of_kind] : b.tolerances)
        tolerances[name(kind)] = tolerances_json(of_kind);
    const auto line = [](const char* key, const json& value) {
        return fmt::format(" \"{}\": {},\n", key, value.dump());
    };
    std::string text = "{\n" + line("schema", baseline_schema);
    text += line("accepted", {{"reason", b.reason}});
    text += fmt::format(" \"figures\": {},\n", object_text(figures_json(b.accepted), 3));
    text += list_text("limits", limits) + ",\n";
    text += fmt::format(" \"tolerances\": {},\n", object_text(tolerances, 1));
    text += line(
        "scene",
        {{"file", file.scene_file}, {"name", b.accepted.scene}, {"input_hash", file.input_hash}});
    text += line("provenance", provenance_json(file.provenance));
    text +=
        fmt::format(" \"curves\": {}\n}}\n", json::object({{"hash", input_hash(curves)}}).dump());
    return {text, curves};
}

BaselineFile parse_baseline(const BaselineText& text, const std::string& file_name) {
    return with_json(text, file_name, parse_review);
}

fs::path curves_of(const fs::path& baseline) {
    return baseline.parent_path() / "curves" / baseline.filename();
}

BaselineFile read_baseline(const fs::path& file) {
    const BaselineText text{read_whole(file, largest_baseline),
                            read_whole(curves_of(file), largest_baseline)};
    return with_json(text, file.string(), [&](const JsonCursor& top, const JsonCursor& curves) {
        BaselineFile parsed = parse_review(top, curves);
        check_limits(parsed.baseline.limits, text.review, file.string());
        if (top["curves"]["hash"].text() != input_hash(text.curves))
            top["curves"]["hash"].fail(
                fmt::format("{} is of another acceptance", curves_of(file).string()));
        if (top["figures"].value->dump() != figures_json(parsed.baseline.accepted).dump())
            top["figures"].fail("are not those of the accepted curves; figures are not edited");
        return parsed;
    });
}

void write_baseline(const fs::path& file, const BaselineFile& baseline) {
    const BaselineText text = baseline_text(baseline);
    check_may_write(file, baseline_file);
    write_whole(curves_of(file), text.curves, baseline_curves_file);
    write_whole(file, text.review, baseline_file);
}

BuildDistance distance(const Provenance& was, const Provenance& is) {
    std::string differs;
    const auto check = [&](const std::string& what, const std::string& a, const std::string& b) {
        if (a != b)
            differs += fmt::format("{}{}: {}, now {}", differs.empty() ? "" : "; ", what, a, b);
    };
    check("compiler", was.compiler, is.compiler);
    check("flags", was.flags, is.flags);
    check("CPU", was.cpu, is.cpu);
    const auto listed = [](const Provenance& p) {
        std::string list;
        for (const auto& library : p.libraries)
            list += (list.empty() ? "" : " ") + library.name + " " + library.version;
        return list;
    };
    check("libraries", listed(was), listed(is));
    return {differs.empty() ? ToleranceClass::same_build : ToleranceClass::cross_build, differs};
}

std::string not_committed(const fs::path& file) {
    const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".",
                      leaf = file.filename().string(),
                      committed = git(folder, {"rev-parse", "--verify", "-q", "HEAD:./" + leaf});
    if (committed.empty()) return "it is not committed to a git repository";
    if (committed != git(folder, {"hash-object", "--", leaf}))
        return "it differs from what is committed";
    return "";
}

}  // namespace elastocheck::reports
