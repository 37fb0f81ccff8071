#include "reports/given/headings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/files/csv_table.hpp"
#include "reports/given/wheels.hpp"
#include "reports/text/escape.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {
namespace {

using compare::Unit;

// ---- Units.

struct UnitSymbol {
    const char* symbol;
    Unit unit;      // base unit
    double factor;  // to the base unit
};
constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr std::array unit_symbols{UnitSymbol{"mm", Unit::mm, 1},
                                  UnitSymbol{"cm", Unit::mm, 10},
                                  UnitSymbol{"m", Unit::mm, 1e3},
                                  UnitSymbol{"in", Unit::mm, 25.4},
                                  UnitSymbol{"deg", Unit::deg, 1},
                                  UnitSymbol{"rad", Unit::deg, degrees_per_radian},
                                  UnitSymbol{"mrad", Unit::deg, 1e-3 * degrees_per_radian},
                                  UnitSymbol{"arcmin", Unit::deg, 1.0 / 60},
                                  UnitSymbol{"'", Unit::deg, 1.0 / 60},
                                  UnitSymbol{"′", Unit::deg, 1.0 / 60},
                                  UnitSymbol{"N", Unit::newton, 1},
                                  UnitSymbol{"kN", Unit::newton, 1e3},
                                  UnitSymbol{"N·m", Unit::newton_metre, 1},
                                  UnitSymbol{"Nm", Unit::newton_metre, 1},
                                  UnitSymbol{"Nmm", Unit::newton_metre, 1e-3},
                                  UnitSymbol{"kNm", Unit::newton_metre, 1e3},
                                  UnitSymbol{"percent", Unit::percent, 1}};

bool is_unit_symbol(std::string_view unit) {
    return std::ranges::find(unit_symbols, unit, &UnitSymbol::symbol) != unit_symbols.end();
}

// The symbol of this program for a unit as rigs write it.
std::string_view plain_unit(std::string_view unit) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 8> aliases{
        {{"degrees", "deg"},
         {"degree", "deg"},
         {"°", "deg"},
         {"min", "arcmin"},
         {"minutes", "arcmin"},
         {"arc-minutes", "arcmin"},
         {"arcminutes", "arcmin"},
         {"N.m", "Nm"}}};
    for (const auto& [theirs, ours] : aliases)
        if (unit == theirs) return ours;
    return unit;
}

// ---- Headings of K&C rigs.

// Whether a list such as "toe|toe angle" has these words as an entry.
bool has_entry(std::string_view list, std::string_view words) {
    return fmt::format("|{}|", list).find(fmt::format("|{}|", words)) != std::string::npos;
}

struct RigTest {
    std::string_view words;
    std::array<std::string_view, 2> moves;  // load cases that it may be
};
constexpr std::array rig_tests{
    RigTest{"bounce|ride|heave|bump", {"heave", "travel"}},
    RigTest{"roll", {"roll", ""}},
    RigTest{"steer|steering", {"steering", ""}},
    RigTest{"aligning", {"moment", ""}},
    RigTest{"braking|brake|traction|driving", {"longitudinal force", ""}},
    RigTest{"lateral", {"lateral force", ""}}};

// Headings of columns that are not outputs, without the side of the wheel. The headings of outputs
// are in the catalogue.
struct RigHeading {
    std::string_view column, words;
    std::string_view moves = {};  // load case of a parameter
};
constexpr std::array rig_headings{
    RigHeading{"parameter", "lateral force", "lateral force"},
    RigHeading{"parameter", "longitudinal force|braking force|traction force",
               "longitudinal force"},
    RigHeading{"parameter", "vertical force", "heave"},
    RigHeading{"parameter", "aligning torque|aligning moment", "moment"},
    RigHeading{"parameter", "rack travel|rack displacement|steering wheel angle", "steering"},
    RigHeading{"branch", "test|test name|load case"}};

}  // namespace

Heading split_heading(std::string_view text) {
    for (const auto& [open, close] : {std::pair{'[', ']'}, {'(', ')'}})
        if (const auto at = text.find(open); at != text.npos)
            if (const auto end = text.find(close, at); end != text.npos) {
                const std::string_view name = text.substr(0, at);
                return {std::string(name.substr(0, name.find_last_not_of(' ') + 1)),
                        std::string(plain_unit(text.substr(at + 1, end - at - 1)))};
            }
    const auto last = text.rfind('_');
    if (last == text.npos) return {std::string(text), ""};
    const std::string_view unit = text.substr(last + 1);
    if (!is_unit_symbol(unit) && !compare::find_unit(unit)) return {std::string(text), ""};
    return {std::string(text.substr(0, last)), std::string(unit)};
}

namespace {

// Whether the heading is a parameter, or an output, in the names of this program; fills `meaning`.
bool read_parameter(const Heading& heading, Meaning& meaning) {
    if (heading.name != "parameter" && heading.name != "load") return false;
    if (!heading.unit.empty() && !is_unit_symbol(heading.unit)) return false;
    meaning.kind = Meaning::Kind::parameter;
    meaning.unit = heading.unit;
    return true;
}
bool read_output(const Heading& heading, const std::vector<compare::Channel>& channels,
                 Meaning& meaning) {
    constexpr std::string_view change = "_change";
    std::string_view name = heading.name;
    int channel = compare::find_channel(channels, name);
    const bool is_change = channel < 0 && !heading.unit.empty() && name.ends_with(change);
    if (is_change)
        channel = compare::find_channel(channels, name.substr(0, name.size() - change.size()));
    if (channel < 0) return false;
    const auto c = static_cast<std::size_t>(channel);
    const auto factor = factor_of(heading.unit, channels[c].unit);
    if (!factor) return false;
    meaning.kind = Meaning::Kind::output;
    meaning.channel = c;
    meaning.change = is_change;
    meaning.factor = *factor;
    return true;
}

// The heading of a rig in the names of this program, and the load case of a parameter; empty where
// the heading is not known, or of a wheel that the scene does not have.
std::optional<std::pair<Heading, std::string>> heading_of_rig(const Heading& heading,
                                                              const Names& names) {
    auto words = lower_words(heading.name);
    std::string side;
    std::erase_if(words, [&](const std::string& word) {
        const bool left = word == "left" || word == "lh" || word == "l",
                   right = word == "right" || word == "rh" || word == "r";
        if (left || right) side = left ? "left" : "right";
        return left || right;
    });
    const std::string joined = fmt::format("{}", fmt::join(words, " "));
    const auto known = std::ranges::find_if(
        rig_headings, [&](const RigHeading& rig) { return has_entry(rig.words, joined); });
    const compare::Entry* entry = compare::find_by_heading(joined);
    if (known == rig_headings.end() && entry == nullptr) return std::nullopt;
    std::string name(entry != nullptr ? std::string_view(entry->name) : known->column);
    std::string_view moves = entry != nullptr ? "" : known->moves;
    if (moves == "heave" && std::ranges::none_of(names.tests, [&](const TestBranch& test) {
            return test.moves == moves && !test.by_travel;
        })) {
        name = compare::figure::wheel_load;
        moves = "";
    }
    if (name != "branch" && name != "parameter" && !side.empty()) {
        const auto exists = [&](const std::string& output) {
            return compare::find_channel(names.channels, output) >= 0;
        };
        if (exists(side + "." + name))
            name = side + "." + name;
        else if (!exists(name) || side == "right")
            return std::nullopt;  // this scene has no such wheel; its only wheel is drawn left
    }
    return std::pair{Heading{name, heading.unit}, std::string(moves)};
}

Meaning meaning_by_map(const ColumnMap::Entry& entry, const Names& names) {
    const auto fail = [&](const char* field, const std::string& what) {
        reader::fail(names.map.file, entry.line, fmt::format("columns.{}.{}", entry.theirs, field),
                     what);
    };
    Meaning meaning{.name = entry.theirs};
    const Heading ours{entry.output, entry.unit};
    const int channel = compare::find_channel(names.channels, entry.output);
    if (entry.output == "branch") {
        meaning.kind = Meaning::Kind::branch;
    } else if (!read_parameter(ours, meaning) && !read_output(ours, names.channels, meaning)) {
        const std::string unit = reader::quote(entry.unit);
        if (entry.output == "parameter" || entry.output == "load")
            fail("unit",
                 fmt::format("{} is not a unit; allowed: mm, m, deg, rad, N, kN, Nm, ...", unit));
        if (channel >= 0)
            fail(
                "unit",
                fmt::format("{} is not a unit of {}; allowed: {}", unit, entry.output,
                            allowed_units(names.channels[static_cast<std::size_t>(channel)].unit)));
        std::vector<std::string> outputs{"parameter", "branch"};
        for (const auto& c : names.channels) outputs.push_back(c.name);
        fail("output", fmt::format("there is no output {}{}", reader::quote(entry.output),
                                   reader::did_you_mean(entry.output, outputs, "outputs")));
    }
    meaning.factor *= entry.sign;
    meaning.offset = entry.offset;
    meaning.change = meaning.change || entry.change;
    return meaning;
}

}  // namespace

std::optional<double> factor_of(std::string_view symbol, Unit unit) {
    if (symbol.empty() || symbol == compare::symbol(unit)) return 1;
    for (const auto& w : unit_symbols)
        if (w.unit == unit && symbol == w.symbol) return w.factor;
    return std::nullopt;
}

std::string allowed_units(Unit unit) {
    std::vector<std::string> list;
    for (const auto& w : unit_symbols)
        if (w.unit == unit) list.emplace_back(w.symbol);
    if (list.empty()) list.emplace_back(compare::symbol(unit));
    return reader::listed(list);
}

Names names_of(const Model& model, const std::vector<compare::Channel>& channels,
               const ColumnMap& map) {
    Names names{channels, map, {}};
    for (const Branch& branch : model.branches) {
        const Unit unit = compare::unit_of(branch.unit);
        names.tests.push_back({branch.name, load_case(model, branch), unit == Unit::mm, unit});
    }
    return names;
}

std::vector<std::string> Names::branches() const {
    std::vector<std::string> list;
    for (const auto& test : tests) list.push_back(test.branch);
    return list;
}

Meaning meaning_of(const std::string& heading, const Names& names) {
    using Kind = Meaning::Kind;
    const auto entry = std::ranges::find(names.map.columns, heading, &ColumnMap::Entry::theirs);
    if (entry != names.map.columns.end()) return meaning_by_map(*entry, names);
    for (const auto& [word, kind] :
         {std::pair{"branch", Kind::branch}, {"leg", Kind::leg}, {"unit", Kind::parameter_unit}})
        if (heading == word) return {.kind = kind, .name = heading};
    Meaning meaning{.name = heading};
    Heading ours = split_heading(heading);
    if (read_parameter(ours, meaning) || read_output(ours, names.channels, meaning)) return meaning;
    // The only wheel of a scene may be called the left one.
    if (ours.name.starts_with("left.") &&
        read_output({ours.name.substr(5), ours.unit}, names.channels, meaning))
        return meaning;
    if (const auto rig = heading_of_rig(ours, names)) {
        if (rig->first.name == "branch")
            meaning.kind = Kind::branch;
        else if (read_parameter(rig->first, meaning) ||
                 read_output(rig->first, names.channels, meaning))
            meaning.moves = rig->second;
    }
    return meaning;
}

std::vector<std::string> known_headings(const Names& names) {
    std::vector<std::string> list{"branch", "parameter", "load_N"};
    for (const auto& channel : names.channels)
        list.push_back(fmt::format("{} [{}]", channel.name, compare::symbol(channel.unit)));
    return list;
}

std::string left_out_heading(const std::string& heading, const Names& names) {
    std::vector<std::string> list;
    for (const auto& channel : names.channels) {
        const std::string unit = compare::symbol(channel.unit);
        list.push_back(channel.name + (heading.ends_with("]") ? " [" + unit + "]" : "_" + unit));
    }
    // ", did you mean 'X'? allowed: ..." where a name is near, else "; allowed: ..."
    const std::string help = reader::did_you_mean(heading, list, "allowed");
    return for_terminal(heading) +
           (help.starts_with(", ") ? " (" + help.substr(2, help.find('?') - 1) + ")" : "");
}

std::vector<std::string> branches_of_test(std::string_view test,
                                          const std::vector<TestBranch>& branches) {
    const auto words = lower_words(test);
    const auto known = std::ranges::find_if(rig_tests, [&](const RigTest& rig_test) {
        return std::ranges::any_of(
            words, [&](const std::string& word) { return has_entry(rig_test.words, word); });
    });
    if (known == rig_tests.end()) return {};
    std::vector<std::string> names;
    for (const auto& moves : known->moves)
        if (names.empty() && !moves.empty())
            for (const auto& branch : branches)
                if (branch.moves == moves) names.push_back(branch.branch);
    if (names.size() < 2) return names;
    for (const auto& word : words) {
        std::vector<std::string> with_word;
        for (const auto& name : names)
            if (std::ranges::count(lower_words(name), word) > 0) with_word.push_back(name);
        if (!with_word.empty()) names = std::move(with_word);
    }
    if (names.size() > 1) {
        std::vector<std::string> by_travel;
        for (const auto& branch : branches)
            if (branch.by_travel && std::ranges::find(names, branch.branch) != names.end())
                by_travel.push_back(branch.branch);
        if (by_travel.size() == 1) names = std::move(by_travel);
    }
    return names;
}

std::string no_branch(const std::string& name, const std::vector<std::string>& branches) {
    return fmt::format("the scene has no branch {}{}", reader::quote(name),
                       reader::did_you_mean(name, branches, "branches"));
}

std::string branch_of_cell(std::string_view cell, const Names& names, const std::string& file,
                           int line, const std::string& column) {
    const auto renamed =
        std::ranges::find(names.map.branches, cell, &std::pair<std::string, std::string>::first);
    const std::string name =
        renamed == names.map.branches.end() ? std::string(cell) : renamed->second;
    if (std::ranges::find(names.tests, name, &TestBranch::branch) != names.tests.end()) return name;
    const auto meant = branches_of_test(name, names.tests);
    if (meant.size() == 1) return meant.front();
    fail_at(file, line,
            fmt::format("{}: {}", column,
                        meant.empty()
                            ? no_branch(name, names.branches())
                            : fmt::format("{} may be any of the branches {}; give one of them in a "
                                          "map",
                                          reader::quote(name), reader::listed(meant))));
}

ColumnMap read_column_map(std::string_view yaml, const std::string& file) {
    ColumnMap map;
    map.file = file;
    const reader::Value tree = reader::parse_yaml(yaml, file);
    std::vector<Number> numbers;
    const reader::Cursor top{&tree, "", &file, &numbers};
    top.only_keys({"columns", "branches"});
    // Not by Cursor's own entries, since names of another tool may contain brackets.
    const auto entries = [](const reader::Cursor& section) {
        if (section.value->kind != reader::Value::Kind::map)
            section.fail("expected a map of their names, found " + section.found());
        std::vector<std::pair<std::string, reader::Cursor>> list;
        for (std::size_t k = 0; k < section.value->items.size(); ++k)
            list.emplace_back(
                section.value->keys[k],
                section.at(section.value->items[k],
                           section.path + "." + reader::shown(section.value->keys[k])));
        return list;
    };
    const auto columns = top.optional("columns");
    if (!columns && !top.optional("branches")) top.fail("no names; required: columns or branches");
    for (const auto& [name, field] : columns ? entries(*columns) : decltype(entries(*columns)){}) {
        field.only_keys({"output", "unit", "sign", "offset", "change"});
        ColumnMap::Entry entry{.theirs = name, .line = field.value->line};
        entry.output =
            field.require("output").text("an output of the scene, 'parameter' or 'branch'");
        if (const auto unit = field.optional("unit")) entry.unit = unit->text("a unit");
        if (const auto sign = field.optional("sign")) {
            entry.sign = sign->number();
            if (entry.sign != 1 && entry.sign != -1) sign->fail("expected 1 or -1");
        }
        if (const auto offset = field.optional("offset")) entry.offset = offset->number();
        if (const auto change = field.optional("change")) entry.change = change->yes_or_no();
        map.columns.push_back(std::move(entry));
    }
    if (const auto branches = top.optional("branches"))
        for (const auto& [name, field] : entries(*branches))
            map.branches.emplace_back(name, field.text("a branch of the scene"));
    return map;
}

}  // namespace elastocheck::reports
