// The interval proofs of a scene's points for readers.
#include <fmt/format.h>

#include <algorithm>

#include "compare/proofs/certify.hpp"
#include "compare/result/result.hpp"

namespace elastocheck::compare {
namespace {

std::string claim_of(const Tolerance& tolerance) {
    return fmt::format("{:g} mm and {:g} deg", tolerance.mm, tolerance.deg);
}

std::string sentence(const CertifyStudy& study) {
    const int points = study.points(), proved = study.proved();
    const std::string claim = claim_of(study.tolerance);
    if (study.excluded()) {
        int excluded = 0;
        for (const auto& side : study.sides) excluded += side.tally.excluded;
        return fmt::format(
            "Wrong: {} of {} points are provably no equilibrium to {}; {} are proved to be.",
            excluded, points, claim, proved);
    }
    if (study.conclusive())
        return fmt::format("Proved: all {} points are equilibria to {}.", points, claim);
    if (points == 0) return "Not proved: no point was found.";
    if (proved == points)
        return fmt::format(
            "Not all is proved: {} that were found {} to {}, but some were not found or not "
            "judged, or the curve through them is open.",
            points == 1 ? "the one point" : fmt::format("all {} points", points),
            points == 1 ? "is an equilibrium" : "are equilibria", claim);
    return fmt::format(
        "Not all is proved: {} of {} points are equilibria to {}, the others are open.", proved,
        points, claim);
}

// A bound of the proved points; none where no point is proved.
double bound(const CertifiedSide& side, double value) {
    return side.tally.proved > 0 ? value : nan;
}

std::vector<ColumnOf<CertifiedSide>> certified_columns() {
    using enum Digits;
    using Side = CertifiedSide;
    return {
        {"branch", hidden, &Side::branch, "a side of a branch, from a = 0"},
        {"solver", words, &Side::solver, "whose points are tested"},
        {"outcome", words, [](const Side& s) { return name(s.outcome); }, "how the solver ended"},
        {"points", whole, [](const Side& s) { return s.tally.points; }, "looked at"},
        {"proved", whole, [](const Side& s) { return s.tally.proved; },
         "a true equilibrium is within the tolerance, and no other near it"},
        {"excluded", whole, [](const Side& s) { return s.tally.excluded; },
         "there is provably none within the tolerance"},
        {"open", whole, [](const Side& s) { return s.tally.open; }, "neither could be shown"},
        {"stable", whole, [](const Side& s) { return s.tally.stable; },
         "of the proved points: all stiffnesses positive in the whole box"},
        {"error", size, [](const Side& s) { return bound(s, 1e3 * s.tally.error.length); },
         "of the proved points: bound of the error of a body's origin", "mm", "off at most"},
        {"angle error", size,
         [](const Side& s) { return bound(s, in_unit(Unit::deg) * s.tally.error.angle); },
         "likewise of its orientation", "deg", "at most"},
        {"force error", size, [](const Side& s) { return bound(s, s.tally.error.force); },
         "likewise of a joint's reaction force", "N", "at most"},
        {"moment error", hidden, [](const Side& s) { return bound(s, s.tally.error.moment); },
         "likewise of its moment, about the joint", "N·m"},
        {"alone", size, [](const Side& s) { return bound(s, 1e3 * s.tally.unique.length); },
         "no other equilibrium is within this distance of a proved one", "mm", "alone within"},
        {"held", hidden, [](const Side& s) { return bound(s, s.tally.held); },
         "bound of the wrench that holds idle modes in the proved equilibria", "N, N·m"},
        {"gap", hidden, [](const Side& s) { return bound(s, 1e3 * s.tally.gap); },
         "bound of the gap of redundant constraints in them", "mm, rad"},
        {"curve", words,
         [](const Side& s) {
             return !s.curve ? "" : s.curve->tried ? name(s.curve->state) : "not tried";
         },
         "whether one connected curve of equilibria from start to end is proved"},
        {"curve pieces", whole, [](const Side& s) { return s.curve ? s.curve->pieces : nan; },
         "of the tube around the path", "", "pieces"},
        {"tube", size, [](const Side& s) { return s.curve ? 1e3 * s.curve->width.length : nan; },
         "the curve is within this of the path", "mm"},
        {"limit", words, [](const Side& s) { return s.limit ? name(s.limit->state) : ""; },
         "whether the limit point that ends the path is proved"},
        {"limit from", hidden,
         [](const Side& s) { return s.limit ? in_unit(s.unit) * s.limit->from : nan; },
         "it lies between this value of the branch's parameter ..."},
        {"limit to", hidden,
         [](const Side& s) { return s.limit ? in_unit(s.unit) * s.limit->to : nan; },
         "... and this"}};
}

// Notes on a side: its proved curve and limit point, theorems, and reasons why there is no proof.
void add_notes(std::vector<std::string>& notes, const CertifiedSide& side) {
    const char* unit = symbol(side.unit);
    const auto add = [&](const std::string& what) {
        if (!what.empty()) notes.push_back(fmt::format("{}: {}", side.solver, what));
    };
    if (side.curve && side.curve->state == ProofState::proved)
        notes.push_back(fmt::format(
            "one curve of equilibria is proved from {:.10g} to {:.10g} {}{}",
            in_unit(side.unit) * side.curve->from + 0.0, in_unit(side.unit) * side.curve->to + 0.0,
            unit, side.curve->knots > 0 ? ", over knots of laws" : ""));
    if (side.limit && side.limit->state == ProofState::proved)
        notes.push_back(fmt::format("a limit point is proved, between {:.16g} and {:.16g} {}",
                                    in_unit(side.unit) * side.limit->from,
                                    in_unit(side.unit) * side.limit->to, unit));
    add(side.detail);
    add(side.tally.not_proved);
    if (side.curve && side.curve->state != ProofState::proved)
        add("the curve: " + side.curve->detail);
    if (side.limit && side.limit->state != ProofState::proved)
        add("the limit point: " + side.limit->detail);
    // The solvers of a side mostly share one theorem, on the same idle motions.
    if (!side.tally.theorem.empty() && std::ranges::find(notes, side.tally.theorem) == notes.end())
        notes.push_back(side.tally.theorem);
}

}  // namespace

Result result_of(const CertifyStudy& study) {
    Result result{.analysis = "certify"};
    for (const auto& branch : distinct(study.sides, &CertifiedSide::branch)) {
        const auto sides = where(study.sides, &CertifiedSide::branch, branch);
        Table& part = result.tables.emplace_back(
            table({.id = "sides", .caption = fmt::format("branch '{}'", branch)},
                  certified_columns(), sides));
        for (const auto& side : sides) add_notes(part.notes, side);
    }
    result.notes.push_back(fmt::format(
        "Proved: interval arithmetic shows that the model's equations of balance and constraint, "
        "with its stored numbers taken as exact, have a solution within {} of the solver's point, "
        "and no other within the distance \"alone within\" for the same positions of idle motions "
        "and the same load sharing of redundant joints. Excluded: they have no solution there. A "
        "proved curve is continuous between the points. Not proved: that the equations describe "
        "the suspension, or that its numbers are right.",
        claim_of(study.tolerance)));
    result.verdict = {.grade = study.excluded()     ? Grade::fail
                               : study.conclusive() ? Grade::pass
                                                    : Grade::not_judged,
                      .sentence = sentence(study),
                      .compared = study.points()};
    return result;
}

}  // namespace elastocheck::compare
