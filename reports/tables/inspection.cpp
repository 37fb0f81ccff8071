#include "reports/tables/inspection.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "compare/channels.hpp"
#include "compare/legs.hpp"
#include "models/overloaded.hpp"
#include "reports/document/document.hpp"
#include "reports/tables/elements.hpp"

namespace elastocheck::reports {
namespace {

std::string body_name(const Model& model, BodyId body) {
    return body == ground ? "ground" : model.bodies[static_cast<std::size_t>(body)].name;
}

std::string constraint_name(const ConstraintKind& kind) {
    return std::visit(overloaded{[](const CoincidentPoints&) { return "coincident points"; },
                                 [](const PointInPlane&) { return "point in plane"; },
                                 [](const PerpendicularDirections&) { return "perpendicular directions"; },
                                 [](const DistanceBetween&) { return "distance between points"; },
                                 [](const DirectionAtAngle&) { return "direction at an angle"; }},
                      kind);
}

std::string words(const Size& size) {
    return fmt::format("{} bodies, {} joints, {} elements: {} coordinates, {} constraints, {} unknowns",
                       size.bodies, size.joints, size.elastics, 6 * size.bodies, size.rows,
                       6 * size.bodies + size.rows);
}

std::string trim_words(const compare::TrimRecord& trim) {
    std::string text =
        fmt::format("\ntrim, found by the equilibrium leg in {} step{}, confirmed by {}\n", trim.iterations,
                    trim.iterations == 1 ? "" : "s",
                    trim.confirmed_by == compare::Leg::energy ? "the energy leg" : "the series");
    for (const auto& a : trim.adjusted)
        text += fmt::format("  {:<30} {:+.6g} {}{}{}\n", a.name, a.by, symbol(a.unit),
                            a.makes.empty() ? "" : ": ", a.makes);
    for (const auto& c : trim.conditions)
        text += fmt::format("  until {:<24} {:.6g} {}, met to {:.1e}; confirmed to {:.1e}\n", c.name, c.asked,
                            symbol(c.unit), std::abs(c.missed), std::abs(c.confirmed));
    return text;
}

}  // namespace

std::string inspection(const Inspected& inspected) {
    const Model& model = inspected.model;
    const recursive::Diagnosis& d = inspected.diagnosis;
    std::string text;
    const recursive::Conditioning condition = recursive::conditioning(model, d);
    const auto line = [&](const char* format, const auto&... args) {
        fmt::vformat_to(std::back_inserter(text), format, fmt::make_format_args(args...));
        text += '\n';
    };
    line("{}", model.name);
    line("");
    line("  coordinates         {:>4}   6 for each of {} bodies", d.coordinates, model.bodies.size());
    line("  constraints         {:>4}   of rank {}", d.rows, d.rank);
    line("  unknowns            {:>4}", d.coordinates + d.rows);
    line("  degrees of freedom  {:>4}   {} of them idle", d.degrees_of_freedom(), d.idle.size());
    line("  condition        {:>7.2g}   of eq. (24), equilibrated; {:.2g} as it stands",
         condition.equilibrated, condition.raw);
    line("");
    line("bodies");
    for (const auto& body : model.bodies)
        line("  {:<20} origin ({:.6g}, {:.6g}, {:.6g}) m", body.name, body.design.r.x(), body.design.r.y(),
             body.design.r.z());
    if (!model.joints.empty()) line("\njoints");
    for (int k = 0; k < static_cast<int>(model.joints.size()); ++k) {
        const auto& joint = model.joints[static_cast<std::size_t>(k)];
        std::string made_of;
        for (const auto& c : model.constraints)
            if (c.joint == k) made_of += (made_of.empty() ? "" : " + ") + constraint_name(c.kind);
        line("  {:<20} {} - {}: {}", joint.name, body_name(model, joint.i), body_name(model, joint.j),
             made_of);
    }
    if (!model.elastics.empty()) line("\nelastic elements");
    for (const auto& [name, between, what] : elements(inspected.scene, model))
        line("  {:<20} {}: {}", name, between, what);
    if (inspected.trim) text += trim_words(*inspected.trim);
    line("\nbranches");
    for (const auto& branch : model.branches) {
        std::string moved, held;
        for (const auto& driver : branch.drivers)
            (driver.rate != 0 ? moved : held) +=
                ((driver.rate != 0 ? moved : held).empty() ? "" : " + ") + driven_name(model, driver.what);
        const compare::Unit unit = compare::unit_of(branch.unit);
        const std::string range = fmt::format("{:g} to {:g} {}", compare::in_unit(unit) * branch.from,
                                              compare::in_unit(unit) * branch.to, symbol(unit));
        const std::string under = held.empty() ? "" : ", held: " + held;
        line("  {:<20} {}, {} in {} steps{}", branch.name, moved, range, branch.steps, under);
    }
    line("\noutputs");
    const auto channels = compare::channels(model);
    bool force = false, moment = false;
    for (const auto& channel : channels) {
        std::string name = channel.name;
        if (const bool reaction = std::holds_alternative<compare::Reaction>(channel.reads); reaction) {
            bool& said = channel.unit == compare::Unit::newton ? force : moment;
            if (said) continue;  // the same for every joint and axis
            said = true;
            name = channel.unit == compare::Unit::newton ? "JOINT.force_x, _y, _z" : "JOINT.moment_x, _y, _z";
        }
        const std::string head = fmt::format("{} [{}]", name, symbol(channel.unit));
        const bool example = name.starts_with("JOINT.");
        const std::string meaning = (example ? "such as: " : "") + channel.definition;
        line("  {:<30} {}", head, meaning);
    }
    line("\nredundant constraints");
    for (const auto& r : d.redundant)
        line("  joint '{}': {} of its rows repeat what the joints before it hold{}",
             model.joints[static_cast<std::size_t>(r.joint)].name, r.rows,
             r.contradicts ? ", and contradict it" : "");
    if (d.redundant.empty()) line("  none");
    line("\nidle modes (nothing resists them; they are held, and reported here)");
    for (const auto& mode : d.idle) line("  {}", mode.description);
    if (d.idle.empty()) line("  none");
    line("\nleft out or condensed, because no output depends on it");
    for (const auto& o : model.left_out) line("  {}: {}", o.what, o.why);
    if (model.left_out.empty()) line("  nothing");
    line("  the scene  {}", words(model.as_written));
    line("  as solved  {}", words(model.as_solved));
    line("\nbalance at the design position, parameter 0");
    if (d.imbalance <= 1e-6)
        line("  in equilibrium");
    else
        line("  out of balance by {:.4g} N: every branch begins where the scene settles", d.imbalance);
    for (const auto& branch : model.branches) {
        const compare::Settled settled = compare::settled(model, channels, branch);
        if (settled.outcome != Outcome::converged) {
            const char* outcome = name(settled.outcome);
            line("  branch '{}' does not settle: {}: {}", branch.name, outcome, settled.detail);
            continue;
        }
        std::string where;
        for (std::size_t c = 0; c < channels.size(); ++c)
            if (channels[c].main && channels[c].kinematic() && std::abs(settled.displacement[c]) >= 1e-6)
                where += fmt::format("{}{} {:+.4g} {}", where.empty() ? "" : ", ", channels[c].name,
                                     settled.displacement[c], symbol(channels[c].unit));
        if (!where.empty()) line("  branch '{}' settles: {}", branch.name, where);
    }
    return text;
}

}  // namespace elastocheck::reports
