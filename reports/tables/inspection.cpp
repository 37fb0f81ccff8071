#include "reports/tables/inspection.hpp"

#include <fmt/format.h>

#include <iterator>

#include "compare/channels.hpp"
#include "reports/document/definitions.hpp"

namespace elastocheck::reports {
namespace {

std::string body_name(const Model& model, BodyId body) {
    return body == ground ? "ground" : model.bodies[static_cast<std::size_t>(body)].name;
}

std::string constraint_name(const ConstraintKind& kind) {
    constexpr const char* names[] = {"coincident points", "point in plane", "perpendicular directions",
                                     "distance between points"};
    return names[kind.index()];
}

}  // namespace

std::string inspection(const Model& model, const recursive::Diagnosis& d) {
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
    for (const auto& elastic : model.elastics) {
        const auto [i, j] = std::visit(
            [](const auto& e) {
                return std::pair{e.i.body, e.j.body};
            },
            elastic.kind);
        const bool spring = std::holds_alternative<AxialSpring>(elastic.kind);
        line("  {:<20} {} - {}: {}", elastic.name, body_name(model, i), body_name(model, j),
             spring ? "axial spring" : "bushing");
    }
    line("\nbranches");
    for (const auto& branch : model.branches) {
        std::string loads;
        for (const auto& load : branch.loads) loads += (loads.empty() ? "" : " + ") + load.name;
        line("  {:<20} {} to {:g} in {} steps", branch.name, loads, branch.to, branch.steps);
    }
    line("\noutputs");
    for (const auto& channel : compare::channels(model))
        if (channel.main)
            line("  {:<20} {}", fmt::format("{} [{}]", channel.name, symbol(channel.unit)),
                 definition(channel));
    for (const auto unit : {compare::Unit::newton, compare::Unit::newton_metre})
        if (!model.joints.empty())
            line("  {:<20} {}",
                 fmt::format("JOINT.{}_x, _y, _z [{}]", unit == compare::Unit::newton ? "force" : "moment",
                             symbol(unit)),
                 definition({.name = "", .unit = unit, .main = false, .joint = 0}));
    line("  {:<20} {}", "travel [mm]", travel_definition);
    line("\nredundant constraints");
    for (const auto& r : d.redundant)
        line("  joint '{}': {} of its rows repeat what the joints before it hold{}",
             model.joints[static_cast<std::size_t>(r.joint)].name, r.rows,
             r.contradicts ? ", and contradict it" : "");
    if (d.redundant.empty()) line("  none");
    line("\nidle modes (nothing resists them; they are held, and reported here)");
    for (const auto& mode : d.idle) line("  {}", mode.description);
    if (d.idle.empty()) line("  none");
    line("\nleft out, because no output depends on it");
    for (const auto& o : model.left_out) line("  {}: {}", o.what, o.why);
    if (model.left_out.empty()) line("  nothing");
    line("\nbalance at the design position, load factor 0");
    if (d.imbalance <= 1e-6)
        line("  in equilibrium");
    else
        line("  out of balance by {:.4g} N: the first point of every branch is the settled position",
             d.imbalance);
    return text;
}

}  // namespace elastocheck::reports
