#include "reports/document/inspection.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <map>
#include <span>

#include "compare/comparison/legs.hpp"
#include "compare/warnings/plausibility.hpp"
#include "elastocheck/channels.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/diagnosis/motion.hpp"
#include "reports/document/document.hpp"
#include "reports/tables/elements.hpp"

namespace elastocheck::reports {
namespace {

std::string body_name(const Model& model, BodyId body) {
    return body == ground ? "ground" : model.bodies[static_cast<std::size_t>(body)].name;
}

std::string constraint_name(const ConstraintKind& kind) {
    return std::visit([]<class C>(const C&) { return Kind<C>::name; }, kind);
}

// Constraints of each joint.
std::vector<std::string> compositions(const Model& model) {
    std::vector<std::string> made_of(model.joints.size());
    for (const auto& c : model.constraints) {
        std::string& text = made_of[static_cast<std::size_t>(c.joint)];
        text += (text.empty() ? "" : " + ") + constraint_name(c.kind);
    }
    return made_of;
}

// Limit of listed entries: hand-written scenes are shown completely, of generated ones the
// beginning of every list.
constexpr std::size_t most_shown = 40;

// "body" for "body 'arm'".
std::string kind_of(const Omission& omission) {
    return omission.what.substr(0, omission.what.find(" '"));
}

std::string words(const Size& size) {
    return fmt::format(
        "{} bodies, {} joints, {} elements: {} coordinates, {} constraints, {} unknowns",
        size.bodies, size.joints, size.elastics, 6 * size.bodies, size.rows,
        6 * size.bodies + size.rows);
}

std::string trim_words(const compare::TrimRecord& trim) {
    std::string text = fmt::format(
        "\ntrim, found by the equilibrium leg in {} step{}, confirmed by {}; bushings are {}\n",
        trim.iterations, trim.iterations == 1 ? "" : "s",
        trim.confirmed_by == compare::Leg::energy ? "the energy leg" : "the series",
        trim.bushings == Trim::Bushings::balanced
            ? "balanced: the drawn position is the equilibrium"
            : "unloaded as drawn");
    for (const auto& a : trim.adjusted)
        text += fmt::format("  {:<30} {:+.6g} {}{}{}\n", a.name, a.by, symbol(a.unit),
                            a.makes.empty() ? "" : ": ", a.makes);
    for (const auto& c : trim.conditions)
        text +=
            fmt::format("  until {:<24} {:.6g} {}, met to {:.1e}; confirmed to {:.1e}\n", c.name,
                        c.target, symbol(c.unit), std::abs(c.missed), std::abs(c.confirmed));
    return text;
}

// The numbers of the scene, and of which sides each is.
std::string number_words(const std::vector<Number>& numbers) {
    std::string text = "\nnumbers, as --set and --vary name them\n";
    for (const Number& number : numbers) {
        std::string sides;
        for (const auto& [side, value] : number.sides)
            sides += fmt::format("{}@{} {:.10g}", sides.empty() ? "both sides; alone: " : ", ",
                                 side, value);
        text += fmt::format("  {:<36} {:>12.10g} {:<8} {}\n", number.path, number.value,
                            number.unit, sides);
    }
    return text;
}

// Cost of a step: the matrix with the border of idle modes and redundant rows, and its factors.
std::string cost_words(const Model& model) {
    const recursive::SaddlePoint<double> system = recursive::analyse(model).system;
    const recursive::Elimination& order = system.lu.order;
    const std::size_t entries = order.pattern.entries(), factors = order.nonzeros;
    return fmt::format(
        "  matrix            {:>6}   unknowns in eq. (24), {} with what is held; {} entries other "
        "than zero\n"
        "  factors           {:>6}   entries of L + U: {:.3g} times as many; order by least "
        "fill-in "
        "(Markowitz)\n",
        system.n + system.m, system.lu.size(), entries, factors,
        entries > 0 ? static_cast<double>(factors) / static_cast<double>(entries) : 1.0);
}

}  // namespace

std::string inspection(const Inspected& inspected) {
    const Model& model = inspected.model;
    const recursive::Diagnosis d = recursive::diagnose(model);
    std::string text;
    const recursive::Conditioning condition = recursive::conditioning(model, d);
    const auto line = [&](const char* format, const auto&... args) {
        fmt::vformat_to(std::back_inserter(text), format, fmt::make_format_args(args...));
        text += '\n';
    };
    // The beginning of a list, and the number of the other entries.
    const auto shown = [&](std::size_t size) {
        return inspected.verbose || size <= most_shown ? size : most_shown;
    };
    const auto rest = [&](std::size_t size, const std::string& what) {
        if (shown(size) < size)
            line("  ... and {} more {}; --verbose lists all", size - shown(size), what);
    };
    line("{}", model.name);
    line("");
    line("  coordinates         {:>4}   6 for each of {} bodies", d.coordinates,
         model.bodies.size());
    line("  constraints         {:>4}   of rank {}", d.rows, d.rank);
    line("  unknowns            {:>4}", d.coordinates + d.rows);
    line("  degrees of freedom  {:>4}   {} of them idle", d.degrees_of_freedom(), d.idle.size());
    line("  condition        {:>7.2g}   of eq. (24), equilibrated; {:.2g} as it stands",
         condition.equilibrated, condition.raw);
    if (inspected.verbose) text += cost_words(model);
    line("");
    line("bodies");
    for (const auto& body : std::span(model.bodies).first(shown(model.bodies.size())))
        line("  {:<20} origin ({:.6g}, {:.6g}, {:.6g}) mm", body.name, 1e3 * body.design.r.x(),
             1e3 * body.design.r.y(), 1e3 * body.design.r.z());
    rest(model.bodies.size(), "bodies");
    if (!model.joints.empty()) line("\njoints");
    const auto made_of = compositions(model);
    for (std::size_t k = 0; k < shown(model.joints.size()); ++k) {
        const auto& joint = model.joints[k];
        line("  {:<20} {} - {}: {}", joint.name, body_name(model, joint.i),
             body_name(model, joint.j), made_of[k]);
    }
    rest(model.joints.size(), "joints");
    if (!model.elastics.empty()) line("\nelastic elements");
    const auto element_lines = elements(inspected.scene, model);
    for (const auto& [name, between, what] :
         std::span(element_lines).first(shown(element_lines.size())))
        line("  {:<20} {}: {}", name, between, what);
    rest(element_lines.size(), "elements");
    if (inspected.trim) text += trim_words(*inspected.trim);
    line("\nbranches");
    for (const auto& branch : model.branches) {
        std::string moved, held;
        for (const auto& driver : branch.drivers)
            (driver.rate != 0 ? moved : held) +=
                ((driver.rate != 0 ? moved : held).empty() ? "" : " + ") +
                driven_name(model, driver.what);
        const compare::Unit unit = compare::unit_of(branch.unit);
        const std::string range =
            fmt::format("{:g} to {:g} {}", compare::in_unit(unit) * branch.from,
                        compare::in_unit(unit) * branch.to, symbol(unit));
        const std::string under = held.empty() ? "" : ", held: " + held;
        line("  {:<20} {}, {} in {} steps{}", branch.name, moved, range, branch.steps, under);
    }
    line("\noutputs");
    const auto channels = compare::channels(model);
    bool force = false, moment = false;
    for (const auto& channel : channels) {
        std::string name = channel.name;
        if (const bool reaction = std::holds_alternative<compare::Reaction>(channel.reads);
            reaction) {
            bool& listed = channel.unit == compare::Unit::newton ? force : moment;
            if (listed) continue;  // the same for every joint and axis
            listed = true;
            name = channel.unit == compare::Unit::newton ? "JOINT.force_x, _y, _z"
                                                         : "JOINT.moment_x, _y, _z";
        }
        const std::string head = fmt::format("{} [{}]", name, symbol(channel.unit));
        const bool example = name.starts_with("JOINT.");
        const std::string meaning = (example ? "such as: " : "") + channel.definition;
        line("  {:<30} {}", head, meaning);
    }
    line("\nredundant constraints");
    for (const auto& r : std::span(d.redundant).first(shown(d.redundant.size()))) {
        line("  joint '{}': {} of its rows repeat what the joints before it hold{}",
             model.joints[static_cast<std::size_t>(r.joint)].name, r.rows,
             r.contradicts ? ", and contradict it"
             : r.undecided ? ", or nearly: undecided"
                           : "");
        std::string among;
        for (const auto& [joint, share] : std::span(r.shares).first(shown(r.shares.size())))
            among += fmt::format("{}'{}' {:.0f} %", among.empty() ? "" : ", ",
                                 model.joints[static_cast<std::size_t>(joint)].name, 100 * share);
        line("    among {}{}", among, shown(r.shares.size()) < r.shares.size() ? ", ..." : "");
    }
    rest(d.redundant.size(), "joints");
    for (const auto& locked : recursive::locked_bodies(model, d)) line("  {}", locked);
    if (d.redundant.empty()) line("  none");
    line(
        "\nidle modes (as drawn no joint and no rate resists them; they are held, and reported "
        "here)");
    const auto idle = recursive::describe_idle_modes(d);
    for (const auto& mode : std::span(idle).first(shown(idle.size()))) line("  {}", mode);
    rest(idle.size(), "modes");
    if (d.idle.empty()) line("  none");
    if (const auto notes = compare::misplaced_points(inspected.scene); !notes.empty()) {
        line("\npoints that may belong to another body");
        for (const auto& note : std::span(notes).first(shown(notes.size()))) line("  {}", note);
        rest(notes.size(), "points");
    }
    line("\nleft out or condensed, because no output depends on it");
    std::map<std::string, std::size_t> omitted;
    for (const auto& o : model.omitted)
        if (const auto place = omitted[kind_of(o)]++; inspected.verbose || place < most_shown)
            line("  {}: {}", o.what, o.why);
    for (const auto& [kind, count] : omitted) rest(count, "of kind '" + kind + "'");
    if (model.omitted.empty()) line("  nothing");
    line("  the scene  {}", words(model.as_written));
    line("  as solved  {}", words(model.as_solved));
    line("\nbalance at the design position, parameter 0");
    if (d.imbalance <= 1e-6)
        line("  in equilibrium");
    else
        line("  out of balance by {:.4g} N: every branch begins where the scene settles",
             d.imbalance);
    for (const auto& branch : model.branches) {
        const compare::Settled settled = compare::settled(model, channels, branch);
        if (settled.outcome != Outcome::converged) {
            const char* outcome = name(settled.outcome);
            line("  branch '{}' does not settle: {}: {}", branch.name, outcome, settled.detail);
            continue;
        }
        std::string where;
        for (std::size_t c = 0; c < channels.size(); ++c)
            if (channels[c].main && channels[c].kinematic() &&
                std::abs(settled.displacement[c]) >= 1e-6)
                where += fmt::format("{}{} {:+.4g} {}", where.empty() ? "" : ", ", channels[c].name,
                                     settled.displacement[c], symbol(channels[c].unit));
        if (!where.empty()) line("  branch '{}' settles: {}", branch.name, where);
    }
    if (inspected.verbose) text += number_words(inspected.scene.numbers);
    return text;
}

}  // namespace elastocheck::reports
