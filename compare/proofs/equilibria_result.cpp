// Result tables of the search for all equilibria at one load.
#include <fmt/format.h>

#include "compare/proofs/multiple_equilibria.hpp"
#include "compare/result/result.hpp"

namespace elastocheck::compare {
namespace {

std::vector<ColumnOf<FoundEquilibrium>> equilibrium_columns() {
    using enum Digits;
    using Found = FoundEquilibrium;
    return {{"stability", words, [](const Found& f) { return f.stable ? "stable" : "unstable"; },
             "by the sign of the least stiffness"},
            {"distance", three, [](const Found& f) { return 1e3 * f.length; },
             "largest displacement of a body from the branch's own equilibrium; from the last one "
             "before "
             "its end; from the design position if no branch starts",
             "mm"},
            {"turned", three, [](const Found& f) { return in_unit(Unit::deg) * f.angle; },
             "largest rotation of a body from the same equilibrium", "deg"},
            {"proof", words, [](const Found& f) { return name(f.proof.state); }},
            {"within", size, [](const Found& f) { return 1e3 * f.proof.error.length; },
             "proved distance to the true equilibrium, at most", "mm"},
            {"alone within", size, [](const Found& f) { return 1e3 * f.proof.unique.length; },
             "proved: no other equilibrium within this distance", "mm"},
            {"what it means", words, &Found::meaning}};
}

// Pose of a body in one of the equilibria.
struct BodyPose {
    double number;  // number of the equilibrium, from 1
    std::string body;
    Pose pose;
};

Table pose_table(const Model& model, const AllEquilibria& equilibria) {
    std::vector<BodyPose> rows;
    for (std::size_t k = 0; k < equilibria.list.size(); ++k)
        for (std::size_t b = 0; b < model.bodies.size(); ++b)
            rows.push_back({static_cast<double>(k + 1), model.bodies[b].name,
                            equilibria.list[k].state.poses[b]});
    const auto column = [](const char* name, const char* unit, auto&& value) {
        return ColumnOf<BodyPose>{.name = name, .cell = value, .unit = unit};
    };
    return table<BodyPose>(
        {.id = "poses"},
        {column("number", "", &BodyPose::number), column("body", "", &BodyPose::body),
         column("x", "mm", [](const BodyPose& p) { return 1e3 * p.pose.r.x(); }),
         column("y", "mm", [](const BodyPose& p) { return 1e3 * p.pose.r.y(); }),
         column("z", "mm", [](const BodyPose& p) { return 1e3 * p.pose.r.z(); }),
         column("qw", "", [](const BodyPose& p) { return p.pose.p.w(); }),
         column("qx", "", [](const BodyPose& p) { return p.pose.p.x(); }),
         column("qy", "", [](const BodyPose& p) { return p.pose.p.y(); }),
         column("qz", "", [](const BodyPose& p) { return p.pose.p.z(); })},
        rows);
}

}  // namespace

Result result_of(const Model& model, const AllEquilibria& equilibria) {
    Result result{.analysis = "equilibria"};
    Table list = table({.id = "equilibria"}, equilibrium_columns(), equilibria.list);
    list.columns.insert(list.columns.begin(), {.name = "number", .digits = Digits::whole});
    for (std::size_t k = 0; k < list.rows.size(); ++k)
        list.rows[k].insert(list.rows[k].begin(), static_cast<double>(k + 1));
    list.caption = fmt::format(
        "branch '{}' at {:.8g} {}: {} {}, {} stable; {}\nthe branch up to there: {}{}{}",
        equilibria.branch, equilibria.a * in_unit(equilibria.unit), symbol(equilibria.unit),
        equilibria.list.size(), equilibria.list.size() == 1 ? "equilibrium" : "equilibria",
        equilibria.stable(),
        equilibria.list.empty() ? "none was found"
        : equilibria.proved     ? "each is proved, and all are distinct"
                                : "not all of this is proved",
        elastocheck::name(equilibria.outcome), equilibria.detail.empty() ? "" : ": ",
        equilibria.detail);
    for (const auto& entry : equilibria.list)
        if (entry.proof.state != reference::certificate::ProofState::proved)
            list.notes.push_back(
                fmt::format("{}: {}", name(entry.proof.state), entry.proof.detail));
    result.tables = {std::move(list), pose_table(model, equilibria)};
    result.notes.push_back(
        fmt::format("{} starts with deflation; completeness is not proved", equilibria.starts));
    if (equilibria.with_reversed_joint > 0)
        result.notes.push_back(fmt::format("left out: {} with a joint assembled in reverse",
                                           equilibria.with_reversed_joint));
    if (equilibria.with_overturned_body > 0)
        result.notes.push_back(
            fmt::format("left out: {} with a body turned over", equilibria.with_overturned_body));
    const bool reached = equilibria.outcome == Outcome::converged;
    result.verdict = {.grade = reached && equilibria.proved ? Grade::pass : Grade::not_judged,
                      .compared = static_cast<int>(equilibria.list.size())};
    if (!reached)
        result.verdict.reasons.push_back(fmt::format("branch '{}': {}: {}", equilibria.branch,
                                                     elastocheck::name(equilibria.outcome),
                                                     equilibria.detail));
    else if (!equilibria.proved)
        result.verdict.reasons.emplace_back("not every equilibrium is proved, or proved distinct");
    return result;
}

}  // namespace elastocheck::compare
