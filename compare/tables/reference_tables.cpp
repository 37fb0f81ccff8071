// Tables of the agreement of the references, of residuals, and of proofs.
#include <cmath>
#include <numbers>

#include "compare/tables/compare_result.hpp"

namespace elastocheck::compare {
namespace {

// Largest distance of the references in outputs of a unit, NaN if there are none; and the number of the
// compared numbers.
std::pair<double, int> distance_in(Unit unit, const Comparison& all,
                                   const BranchComparison& branch) {
    const auto& apart = branch.uncertainty.equal_parameter.channels;
    double largest = -1;
    int compared = 0;
    for (std::size_t c = 0; c < apart.size() && !std::isnan(largest); ++c) {
        // A length that is not a position, such as a swing arm length near infinity, has
        // its own scale.
        const bool place = unit == Unit::mm || unit == Unit::deg;
        if (all.channels[c].unit != unit || !branch.determined[c] ||
            (place && !all.channels[c].kinematic()))
            continue;
        compared += apart[c].compared;
        largest = worse(apart[c].max, largest);
    }
    return {largest < 0 ? nan : largest, compared};
}

// States of a run, and a leg that judges them.
struct Judged {
    const BranchComparison* branch;
    const LegRun* run;
    Leg by = Leg::recursive;

    const Residuals& left() const { return run->judged[static_cast<std::size_t>(by)]; }
    // of the proofs: `value` where a point is proved
    double proved(double value) const {
        return run->proved.proved > 0 ? finite_or_nan(value) : nan;
    }
};

}  // namespace

Table agreement_table(const Comparison& comparison) {
    using B = BranchComparison;
    std::vector<ColumnOf<B>> columns{{"branch", Digits::words, &B::branch}};
    const std::pair<Unit, const char*> of[]{{Unit::mm, "positions"},
                                            {Unit::deg, "angles"},
                                            {Unit::newton, "forces"},
                                            {Unit::newton_metre, "moments"}};
    for (const auto& [unit, what] : of)
        columns.push_back(
            {what, Digits::size,
             [&comparison, unit](const B& b) { return distance_in(unit, comparison, b).first; },
             "largest distance of the references over the branch", symbol(unit)});
    columns.push_back({"numbers compared", Digits::whole, [&](const B& b) {
                           int compared = 0;
                           for (const auto& [unit, what] : of)
                               compared += distance_in(unit, comparison, b).second;
                           return compared;
                       }});
    return table({.id = "agreement"}, columns, comparison.branches);
}

Table residual_table(const Comparison& comparison) {
    using enum Digits;
    std::vector<Judged> rows;
    for (const auto& branch : comparison.branches)
        for (const auto& run : branch.runs)
            for (const Leg by : legs)
                if (by != run.leg && !run.curve.a.empty()) rows.push_back({&branch, &run, by});
    Table made = table<Judged>(
        {.id = "residuals",
         .caption =
             "Residuals of each solution in the equations of the others, worst over the points",
         .detail = true},
        {{"branch", words, [](const Judged& j) { return j.branch->branch; }},
         {"states of", words, [](const Judged& j) { return name(j.run->leg); }},
         {"judged by", words, [](const Judged& j) { return name(j.by); },
          "in whose equations they are"},
         {"force", size, [](const Judged& j) { return j.left().force; }, "", "N"},
         {"moment", size, [](const Judged& j) { return j.left().moment; }, "", "N·m"},
         {"constraint", size, [](const Judged& j) { return 1e3 * j.left().length; }, "", "mm"},
         {"direction", hidden, [](const Judged& j) { return j.left().direction; }}},
        rows);
    return made;
}

Table proof_table(const Comparison& comparison) {
    using enum Digits;
    using J = Judged;
    constexpr double degrees = 180 / std::numbers::pi;
    std::vector<J> rows;
    for (const auto& branch : comparison.branches)
        for (const auto& run : branch.runs)
            if (run.proved.points > 0) rows.push_back({&branch, &run});
    Table made = table<J>(
        {.id = "proofs", .caption = "Proofs by interval arithmetic", .detail = true},
        {{"branch", words, [](const J& j) { return j.branch->branch; }},
         {"points of", words, [](const J& j) { return name(j.run->leg); }},
         {"points", whole, [](const J& j) { return j.run->proved.points; }},
         {"proved", whole, [](const J& j) { return j.run->proved.proved; }},
         {"excluded", hidden, [](const J& j) { return j.run->proved.excluded; },
          "provably off by more than 1e-6 mm or deg"},
         {"off", size, [](const J& j) { return j.proved(1e3 * j.run->proved.error.length); },
          "from an equilibrium, the largest of the proved points", "mm", "off at most"},
         {"angle off", size,
          [](const J& j) { return j.proved(degrees * j.run->proved.error.angle); }, "likewise",
          "deg", "at most"},
         {"force off", size, [](const J& j) { return j.proved(j.run->proved.error.force); },
          "likewise", "N", "at most"},
         {"moment off", hidden, [](const J& j) { return j.proved(j.run->proved.error.moment); },
          "likewise", "N·m"},
         {"alone within", size,
          [](const J& j) { return j.proved(1e3 * j.run->proved.unique.length); },
          "no other equilibrium is nearer", "mm"},
         {"stable", whole, [](const J& j) { return j.run->proved.stable; }, "of the proved points"},
         {"not proved", note, [](const J& j) { return j.run->proved.not_proved; },
          "of the first point without a proof: place and reason"},
         {"theorem", hidden, [](const J& j) { return j.run->proved.theorem; },
          "what the certificate states besides"}},
        rows);
    return made;
}

}  // namespace elastocheck::compare
