#include "reports/document/inspection.hpp"

#include <fmt/format.h>

#include <cmath>

#include "compare/comparison/legs.hpp"
#include "compare/warnings/plausibility.hpp"
#include "elastocheck/channels.hpp"
#include "models/kinds.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "reports/document/document.hpp"
#include "reports/tables/elements.hpp"

namespace elastocheck::reports {
namespace {

using compare::Column;
using compare::Digits;
using compare::Result;
using compare::Table;
using Rows = std::vector<std::vector<compare::Cell>>;

Column words(const char* name) { return {.name = name, .words = true, .digits = Digits::words}; }
Column number(const char* name, const char* unit = "", Digits digits = Digits::whole) {
    return {.name = name, .unit = unit, .digits = digits};
}

// Adds a table; one without rows gets the note `none`, or is left out if that is empty.
void add(Result& result, Table table, const std::string& none = {}) {
    if (table.rows.empty() && none.empty()) return;
    if (table.rows.empty()) table.notes.push_back(none);
    result.tables.push_back(std::move(table));
}

const std::string& joint_name(const Model& model, int joint) {
    return model.joints[static_cast<std::size_t>(joint)].name;
}

void append(std::string& list, const std::string& word, const char* between = ", ") {
    list += (list.empty() ? "" : between) + word;
}

std::vector<compare::Cell> row_of(const char* what, const Size& size) {
    const double coordinates = 6.0 * size.bodies, rows = size.rows;
    return {what, 1.0 * size.bodies, 1.0 * size.joints, 1.0 * size.elastics, coordinates,
            rows, coordinates + rows};
}

void add_size(Result& result, const Model& model, const recursive::Diagnosis& d) {
    const recursive::Conditioning condition = recursive::conditioning(model, d);
    result.about = {model.name};
    add(result,
        {.columns = {words("size"), number("bodies"), number("joints"), number("elements"),
                     number("coordinates"), number("constraints"), number("unknowns")},
         .rows = {row_of("as written", model.as_written), row_of("as solved", model.as_solved)},
         .id = "size",
         .caption = "size"});
    add(result, {.columns = {number("degrees of freedom"), number("idle"), number("rank"),
                             number("condition", "", Digits::size),
                             number("condition as it stands", "", Digits::size),
                             number("imbalance", "N", Digits::given)},
                 .rows = {{1.0 * d.degrees_of_freedom(), 1.0 * std::ssize(d.idle), 1.0 * d.rank,
                           condition.equilibrated, condition.raw, d.imbalance}},
                 .id = "diagnosis",
                 .caption = "as drawn; condition of eq. (24), equilibrated"});
}

// The matrix of a step, bordered by the idle modes and redundant rows, and its factors.
void add_cost(Result& result, const Model& model) {
    const recursive::SaddlePoint<double> system = recursive::analyse(model).system;
    const recursive::Elimination& order = *system.lu.order;
    const auto entries = static_cast<double>(order.pattern.entries()),
               factors = static_cast<double>(order.nonzeros);
    add(result, {.columns = {number("unknowns"), number("with what is held"), number("entries"),
                             number("entries of L + U"), number("fill-in", "", Digits::three)},
                 .rows = {{1.0 * (system.n + system.m), 1.0 * system.lu.size(), entries, factors,
                           entries > 0 ? factors / entries : 1.0}},
                 .id = "matrix",
                 .caption = "matrix of eq. (24), in the order of least fill-in (Markowitz)",
                 .detail = true});
}

void add_parts(Result& result, const Scene& scene, const Model& model) {
    Rows bodies, joints, rows;
    for (const auto& body : model.bodies) {
        const Eigen::Vector3d mm = 1e3 * body.design.r;
        bodies.push_back({body.name, mm.x(), mm.y(), mm.z()});
    }
    const auto coordinate = [](const char* axis) { return number(axis, "mm", Digits::given); };
    add(result, {.columns = {words("body"), coordinate("x"), coordinate("y"), coordinate("z")},
                 .rows = bodies,
                 .id = "bodies",
                 .caption = "bodies, with their origins"});
    std::vector<std::string> made_of(model.joints.size());
    for (const auto& c : model.constraints)
        append(made_of[static_cast<std::size_t>(c.joint)],
               std::visit([]<class C>(const C&) { return Kind<C>::name; }, c.kind), " + ");
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
        const auto& joint = model.joints[k];
        joints.push_back(
            {joint.name,
             fmt::format("{} - {}", body_name(model, joint.i), body_name(model, joint.j)),
             made_of[k]});
    }
    add(result, {.columns = {words("joint"), words("between"), words("constraints")},
                 .rows = joints,
                 .id = "joints",
                 .caption = "joints"});
    for (const auto& [name, between, what] : elements(scene, model))
        rows.push_back({name, between, what});
    add(result, {.columns = {words("element"), words("between"), words("law")},
                 .rows = rows,
                 .id = "elements",
                 .caption = "elastic elements"});
}

// The branches, and where each begins: the settled displacements of the main outputs.
void add_branches(Result& result, const Model& model,
                  const std::vector<compare::Channel>& channels) {
    Rows branches;
    Table settled_table{
        .columns = {words("output"), words("unit")},
        .id = "settled",
        .caption = "displacements where the branches begin, from the drawn position"};
    std::vector<compare::Settled> settled_branches;
    for (const auto& branch : model.branches) {
        std::string moved, held;
        for (const auto& driver : branch.drivers)
            append(driver.rate != 0 ? moved : held, driven_name(model, driver.what), " + ");
        const compare::Unit unit = compare::unit_of(branch.unit);
        const compare::Settled& settled =
            settled_branches.emplace_back(compare::settled(model, channels, branch));
        branches.push_back({branch.name, moved, compare::in_unit(unit) * branch.from,
                            compare::in_unit(unit) * branch.to, symbol(unit), 1.0 * branch.steps,
                            held, name(settled.outcome)});
        settled_table.columns.push_back(number(branch.name.c_str(), "", Digits::deviation));
        if (settled.outcome != Outcome::converged)
            result.notes.push_back(fmt::format("branch '{}' does not settle: {}: {}", branch.name,
                                               name(settled.outcome), settled.detail));
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
        std::vector<compare::Cell> row{channels[c].name, symbol(channels[c].unit)};
        for (const auto& settled : settled_branches)
            row.emplace_back(settled.outcome == Outcome::converged ? settled.displacement[c] : NAN);
        const bool moves = std::any_of(row.begin() + 2, row.end(), [](const compare::Cell& cell) {
            return std::abs(std::get<double>(cell)) >= 1e-6;
        });
        if (channels[c].main && channels[c].kinematic() && moves) settled_table.rows.push_back(row);
    }
    add(result, {.columns = {words("branch"), words("moves"), number("from", "", Digits::given),
                             number("to", "", Digits::given), words("unit"), number("steps"),
                             words("holds"), words("settles")},
                 .rows = branches,
                 .id = "branches",
                 .caption = "branches"});
    add(result, std::move(settled_table));
}

// Reactions are the same for every joint and axis: one row of each unit.
void add_outputs(Result& result, const std::vector<compare::Channel>& channels) {
    Rows rows;
    bool force = false, moment = false;
    for (const auto& channel : channels) {
        std::string name = channel.name, prefix;
        if (std::holds_alternative<compare::Reaction>(channel.reads)) {
            const bool is_force = channel.unit == compare::Unit::newton;
            if (std::exchange(is_force ? force : moment, true)) continue;
            name = is_force ? "JOINT.force_x, _y, _z" : "JOINT.moment_x, _y, _z";
            prefix = "such as: ";
        }
        rows.push_back({name, symbol(channel.unit), prefix + channel.definition});
    }
    add(result, {.columns = {words("output"), words("unit"), words("definition")},
                 .rows = rows,
                 .id = "outputs",
                 .caption = "outputs"});
}

void add_redundant(Result& result, const Model& model, const recursive::Diagnosis& d) {
    Rows rows;
    for (const auto& r : d.redundant) {
        std::string among;
        for (const auto& [joint, share] : r.shares)
            append(among, fmt::format("'{}' {:.0f} %", joint_name(model, joint), 100 * share));
        rows.push_back({joint_name(model, r.joint), 1.0 * r.rows,
                        r.contradicts ? "contradict what the joints before it hold"
                        : r.undecided ? "repeat it or nearly: undecided"
                                      : "repeat what the joints before it hold",
                        among});
    }
    Table redundant{.columns = {words("joint"), number("rows"), words("which"), words("among")},
                    .rows = rows,
                    .id = "redundant",
                    .caption = "redundant constraints",
                    .notes = recursive::locked_bodies(model, d)};
    add(result, std::move(redundant), "none");
}

Table one_column(const char* id, const char* heading, const char* caption,
                 const std::vector<std::string>& texts) {
    Table table{.columns = {words(heading)}, .id = id, .caption = caption};
    for (const auto& text : texts) table.rows.push_back({text});
    return table;
}

void add_trim(Result& result, const compare::TrimRecord& trim) {
    Rows adjusted, conditions;
    for (const auto& a : trim.adjusted)
        adjusted.push_back({a.name, a.change, symbol(a.unit), a.resulting});
    for (const auto& c : trim.conditions)
        conditions.push_back({c.name, c.target, symbol(c.unit), std::abs(c.residual),
                              std::abs(c.confirming_residual)});
    add(result,
        {.columns = {words("number"),
                     number("by", "", Digits::four),
                     words("unit"),
                     {.name = "makes", .words = true, .digits = Digits::note}},
         .rows = adjusted,
         .id = "trim",
         .caption = fmt::format(
             "trim, found by the equilibrium leg in {} step{}, confirmed by {}; bushings are {}",
             trim.iterations, trim.iterations == 1 ? "" : "s",
             trim.confirmed_by == compare::Leg::energy ? "the energy leg" : "the series",
             trim.bushings == Trim::Bushings::balanced
                 ? "balanced: the drawn position is the equilibrium"
                 : "unloaded as drawn")});
    add(result,
        {.columns = {words("until"), number("is", "", Digits::given), words("unit"),
                     number("met to", "", Digits::size), number("confirmed to", "", Digits::size)},
         .rows = conditions,
         .id = "conditions",
         .caption = "conditions that the trim meets"});
}

void add_numbers(Result& result, const Scene& scene) {
    Rows rows;
    for (const Number& n : scene.numbers) {
        std::string sides;
        for (const auto& [side, value] : n.sides)
            append(sides, fmt::format("@{} {:.10g}", side, value));
        rows.push_back({n.path, n.value, n.unit, sides});
    }
    add(result, {.columns = {words("number"), number("value", "", Digits::given), words("unit"),
                             words("sides")},
                 .rows = rows,
                 .id = "numbers",
                 .caption = "numbers, as --set and --vary name them",
                 .detail = true});
}

}  // namespace

Result inspection(const InspectionInput& input) {
    const auto& [scene, model, trim] = input;
    const recursive::Diagnosis d = recursive::diagnose(model);
    const auto channels = compare::channels(model);
    Result result{.analysis = "inspect",
                  .verdict = {.grade = compare::Grade::pass, .requested = false}};
    add_size(result, model, d);
    add_cost(result, model);
    add_parts(result, scene, model);
    if (trim) add_trim(result, *trim);
    add_branches(result, model, channels);
    add_outputs(result, channels);
    add_redundant(result, model, d);
    add(result,
        one_column("idle", "motion",
                   "idle modes (as drawn no joint and no rate resists them; they are held, and "
                   "reported here)",
                   recursive::describe_idle_modes(d)),
        "none");
    add(result, one_column("misplaced", "point", "points that may belong to another body",
                           compare::misplaced_points(scene)));
    Table omitted{.columns = {words("part"), words("reason")},
                  .id = "left_out",
                  .caption = "left out or condensed, because no output depends on it"};
    for (const auto& o : model.omitted) omitted.rows.push_back({o.what, o.why});
    add(result, std::move(omitted), "nothing");
    add_numbers(result, scene);
    result.notes.insert(
        result.notes.begin(),
        d.imbalance <= 1e-6
            ? "balance at the design position, parameter 0: in equilibrium"
            : fmt::format(
                  "balance at the design position, parameter 0: out of balance by {:.4g} N: "
                  "every branch begins where the scene settles",
                  d.imbalance));
    return result;
}

Result shortened(Result result) {
    constexpr std::size_t max_listed = 40;
    for (Table& table : result.tables) {
        if (table.rows.size() <= max_listed || table.id == "outputs") continue;
        table.notes.push_back(fmt::format("... and {} more; inspect --verbose lists all",
                                          table.rows.size() - max_listed));
        table.rows.resize(max_listed);
    }
    return result;
}

Result verbose(Result result) {
    for (Table& table : result.tables) table.detail = false;
    return result;
}

}  // namespace elastocheck::reports
