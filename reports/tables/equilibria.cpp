#include "reports/tables/equilibria.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "reports/tables/render.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::AllEquilibria;
using compare::finite_or_nan;

constexpr double deg = 57.29577951308232;

compare::Table equilibria_table(const AllEquilibria& all) {
    using enum Digits;
    compare::Table table{
        {{"number", "", "", false, whole},
         {"stability", "", "by the sign of the least stiffness", true, words},
         {"away", "mm", "from that of the branch, or from the end of the branch", false, three},
         {"turned", "deg", "likewise", false, three},
         {"proof", "", "", true, words},
         {"within", "mm", "proved distance to the true equilibrium, at most", false, size},
         {"alone within", "mm", "proved: no other equilibrium within this distance", false, size},
         {"what it means", "", "", true, words}},
        {}};
    double number = 0;
    for (const auto& one : all.list)
        table.rows.push_back({++number, one.stable ? "stable" : "unstable", 1e3 * one.length,
                              deg * one.angle, name(one.proof.answer),
                              finite_or_nan(1e3 * one.proof.error.length),
                              finite_or_nan(1e3 * one.proof.unique.length), one.meaning});
    return table;
}

}  // namespace

std::string equilibria_text(const AllEquilibria& all) {
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "branch '{}' at {:.8g} {}: {} {}, {} stable; {}\n", all.branch,
                   all.a * compare::in_unit(all.unit), compare::symbol(all.unit), all.list.size(),
                   all.list.size() == 1 ? "equilibrium" : "equilibria", all.stable(),
                   all.list.empty() ? "none was found"
                   : all.proved     ? "each is proved, and all are distinct"
                                    : "not all of this is proved");
    fmt::format_to(out, "the branch up to there: {}{}{}\n\n", elastocheck::name(all.outcome),
                   all.detail.empty() ? "" : ": ", all.detail);
    text += reports::text(equilibria_table(all));
    for (const auto& one : all.list)
        if (one.proof.answer != reference::certificate::Answer::proved)
            fmt::format_to(out, "{}: {}\n", name(one.proof.answer), one.proof.detail);
    fmt::format_to(out, "\n{} starts with deflation; completeness is not proved\n", all.starts);
    if (all.other_way_round > 0)
        fmt::format_to(out, "left out: {} with a joint assembled in reverse\n",
                       all.other_way_round);
    if (all.turned_over > 0)
        fmt::format_to(out, "left out: {} with a body turned over\n", all.turned_over);
    return text;
}

json equilibria_json(const Model& model, const AllEquilibria& all) {
    json poses = json::array();
    for (const auto& one : all.list) {
        json bodies = json::object();
        for (std::size_t b = 0; b < model.bodies.size(); ++b) {
            const Pose& pose = one.state.poses[b];
            bodies[model.bodies[b].name] = {
                {"r", {1e3 * pose.r.x(), 1e3 * pose.r.y(), 1e3 * pose.r.z()}},
                {"p", {pose.p.w(), pose.p.x(), pose.p.y(), pose.p.z()}}};
        }
        poses.push_back(bodies);
    }
    return {{"branch", all.branch},
            {"at", all.a * compare::in_unit(all.unit)},
            {"unit", compare::symbol(all.unit)},
            {"outcome", elastocheck::name(all.outcome)},
            {"detail", all.detail},
            {"proved", all.proved},
            {"starts", all.starts},
            {"other_way_round", all.other_way_round},
            {"turned_over", all.turned_over},
            {"equilibria", table_json(equilibria_table(all))},
            {"poses", poses}};
}

}  // namespace elastocheck::reports
