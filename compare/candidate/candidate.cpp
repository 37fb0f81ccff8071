#include "compare/candidate/candidate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compare/comparison/compare.hpp"
#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/readings.hpp"
#include "compare/studies/findings.hpp"

namespace elastocheck::compare {
namespace {

// Largest missing part of a branch that still counts as given, as a share of its length.
constexpr double min_missing_part = 1e-6;

// Limit of an output on any branch; infinite where the limit is a share of the output's extent
// on a branch.
double bound_of(const Channel& channel, const Tolerance& tolerance) {
    return limit_of(channel, std::numeric_limits<double>::infinity(), tolerance);
}

// ---- Missing parts.

// Parts of an interval that points leave out: the ends, and gaps wider than a quarter of the
// interval. " from 0 to 1500 N", "" if none.
std::string omitted(std::vector<double> places, double low, double high, std::string_view unit) {
    constexpr double max_gap = 0.25;
    const double length = high - low;
    std::ranges::sort(places);
    std::string parts;
    const auto add = [&](double from, double to, double share) {
        if (to - from > share * length)
            parts += fmt::format("{} from {:.6g} to {:.6g} {}", parts.empty() ? "" : " and",
                                 from + 0.0, to + 0.0, unit);
    };
    add(low, places.empty() ? high : places.front(), min_missing_part);
    for (std::size_t k = 1; k < places.size(); ++k)
        add(places[k - 1], places[k], max_gap * (1 + min_missing_part));
    if (!places.empty()) add(places.back(), high, min_missing_part);
    return parts;
}

// Missing parts of the judged columns; a column that is complete in either reading has none.
// "branch 'jounce' from 1500 to 3000 N", "camber on branch 'jounce' from 1500 to 3000 N"
void add_missing_parts(const Branch& branch, const BranchComparison& compared_branch,
                       const CandidateBranch& given, const CandidateJudgement& judgement,
                       const std::vector<Channel>& channels, std::vector<std::string>& list) {
    const double unit = in_unit(compared_branch.unit);
    const auto missing = [&](std::size_t c) {
        std::optional<std::string> shortest;
        for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
            const auto& reading = given.reading(kind);
            if (reading.columns.empty()) continue;
            double low = unit * std::min(branch.from, branch.to),
                   high = unit * std::max(branch.from, branch.to);
            std::string_view unit_name = symbol(compared_branch.unit);
            if (kind == ReadingKind::equal_abscissa) {
                const auto abscissa = static_cast<std::size_t>(compared_branch.abscissa);
                const auto travel = truth_of(compared_branch).channel(abscissa);
                low = std::ranges::min(travel);
                high = std::ranges::max(travel);
                unit_name = symbol(channels[abscissa].unit);
                if (!(high - low >= min_travel)) continue;
            }
            std::vector<double> places;
            for (std::size_t k = 0; k < reading.at.size(); ++k)
                if (!std::isnan(reading.candidate[c][k])) places.push_back(reading.at[k]);
            const std::string parts = omitted(std::move(places), low, high, unit_name);
            if (!shortest || parts.empty()) shortest = parts;
        }
        return shortest;
    };
    std::vector<std::pair<std::string, std::string>> missing_parts;  // name, missing part
    for (std::size_t c = 0; c < judgement.columns.size(); ++c) {
        const std::size_t channel = judgement.columns[c].channel;
        if (!judgement.judged[c] || !compared_branch.determined[channel]) continue;
        if (auto parts = missing(c))
            missing_parts.emplace_back(channels[channel].name, std::move(*parts));
    }
    if (missing_parts.empty()) return;  // the reason for no comparison is already reported
    const bool all_equal = std::ranges::all_of(missing_parts, [&](const auto& column) {
        return column.second == missing_parts.front().second;
    });
    if (all_equal && !missing_parts.front().second.empty())
        list.push_back(
            fmt::format("branch '{}'{}", compared_branch.branch, missing_parts.front().second));
    for (const auto& [name, parts] : missing_parts)
        if (!all_equal && !parts.empty())
            list.push_back(fmt::format("{} on branch '{}'{}", name, compared_branch.branch, parts));
}

// Keeps the worst deviation of each unit, by its share of the limit; outputs whose limit is a share
// of their extent count as one unit.
void keep_worst(std::vector<CandidateWorst>& list, const CandidateWorst& worst) {
    const auto same = std::ranges::find_if(list, [&](const CandidateWorst& w) {
        return w.extent > 0 ? worst.extent > 0 : worst.extent == 0 && w.unit == worst.unit;
    });
    const auto share = [](const CandidateWorst& w) { return w.max / w.limit; };
    if (same == list.end())
        list.push_back(worst);
    else if (worse(share(worst), share(*same)) != share(*same) && !std::isnan(same->max))
        *same = worst;
}

// ---- The judgement.

// A reading (a comparison at equal parameter or at equal abscissa) in which something is compared.
struct ComparedReading {
    const CandidateBranch& branch;
    const BranchComparison& comparison;
    ReadingKind kind;
    const CandidateReading& reading;
};

std::vector<ComparedReading> readings_of(const CandidateJudgement& judgement,
                                         const Comparison& comparison) {
    std::vector<ComparedReading> list;
    for (const auto& branch : judgement.branches)
        for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa})
            if (const auto& reading = branch.reading(kind); !reading.columns.empty())
                list.push_back({branch, comparison.branch(branch.branch), kind, reading});
    return list;
}

// Smallest changes of the reference and of the candidate that are movements [unit of the output].
constexpr double min_reference_movement = 1e-6, min_candidate_movement = 1e-9;

// Whether every point of the candidate is at the start of its branch although the reference moves:
// then only the design position was compared.
bool only_start_is_given(const std::vector<ComparedReading>& readings,
                         const CandidateJudgement& judgement) {
    bool reference_moves = false;
    for (const auto& [branch, of_branch, kind, reading] : readings)
        for (std::size_t c = 0; c < reading.columns.size(); ++c) {
            const Curve& truth = truth_of(of_branch);
            const double begin = truth.values[truth.start][judgement.columns[c].channel];
            for (const double v : reading.truth[c])
                if (std::abs(v - begin) > min_candidate_movement) return false;
            reference_moves = reference_moves || reading.columns[c].range > min_reference_movement;
        }
    return reference_moves;
}

// Whether the candidate is constant on every branch and in every column where the reference moves.
bool is_constant(const std::vector<ComparedReading>& readings) {
    const auto extent = [](std::vector<double> values) {
        std::erase_if(values, [](double v) { return !std::isfinite(v); });
        if (values.empty()) return 0.;
        const auto [low, high] = std::ranges::minmax(values);
        return high - low;
    };
    bool reference_moves = false;
    for (const auto& [branch, of_branch, kind, reading] : readings)
        for (std::size_t c = 0; c < reading.columns.size(); ++c) {
            if (reading.columns[c].compared < 2) continue;
            if (extent(reading.candidate[c]) > min_candidate_movement) return false;
            reference_moves = reference_moves || extent(reading.truth[c]) > min_reference_movement;
        }
    return reference_moves;
}

// Names of the candidate's outputs if no branch compares any of them, "its 'ackermann'"; else empty.
std::string uncompared_names(const CandidateJudgement& judgement, const Comparison& comparison) {
    std::vector<std::string> names;
    for (const auto& column : judgement.columns) {
        for (const auto& branch : judgement.branches)
            if (comparison.branch(branch.branch).determined[column.channel]) return {};
        names.push_back(fmt::format("'{}'", comparison.channels[column.channel].name));
    }
    return names.empty() ? "" : fmt::format("its {}", fmt::join(names, ", "));
}

// The judgement before any comparison: columns, which of them are judged, and other definitions.
CandidateJudgement outline_of(const Model& model, const Comparison& comparison,
                              const Candidate& candidate, const Tolerance& tolerance) {
    CandidateJudgement result;
    result.name = candidate.name;
    result.tolerance = tolerance;
    result.state_residuals = candidate.state_residuals;
    result.notes = candidate.notes;
    result.columns = as_absolute_values(model, comparison, candidate.points.columns);
    const auto& channels = comparison.channels;
    for (const auto& column : result.columns) {
        const Channel& channel = channels[column.channel];
        const bool named = !candidate.every_output || !channel.kinematic();
        result.judged.push_back((channel.main || named) &&
                                std::isfinite(limit_of(channel, 1, tolerance)));
        result.others += result.judged.back() && !is_motion(channel);
    }
    for (const Channel& defined : definition_channels(model))
        if (std::ranges::any_of(result.columns, [&](const PointColumn& column) {
                return !definitions_of(std::span(&defined, 1), channels[column.channel].name)
                            .empty();
            }))
            result.defined.push_back(defined);
    for (std::size_t c = 0; c < channels.size(); ++c)
        result.has_forces =
            result.has_forces || (!channels[c].joints().empty() &&
                                  std::ranges::any_of(comparison.branches, [&](const auto& b) {
                                      return b.determined.size() > c && b.determined[c];
                                  }));
    return result;
}

// The candidate's points on one branch, in both readings.
CandidateBranch read_branch(const Model& model, const Comparison& comparison, std::size_t b,
                            const Candidate& candidate, std::vector<std::size_t> points,
                            CandidateJudgement& result) {
    const Branch& branch = model.branches[b];
    const BranchComparison& compared = comparison.branches[b];
    const std::vector<Channel>& channels = comparison.channels;
    CandidateBranch given{compared.branch,
                          compared.unit,
                          static_cast<int>(points.size()),
                          nan,
                          nan,
                          compared.abscissa,
                          {},
                          {}};
    for (const std::size_t k : points) {
        if (candidate.points.a.empty() || std::isnan(candidate.points.a[k])) continue;
        const double a = candidate.points.a[k];
        given.from = std::isnan(given.from) ? a : std::min(given.from, a);
        given.to = std::isnan(given.to) ? a : std::max(given.to, a);
    }
    const auto objections =
        disagreements(model, channels, branch, compared, RequiredLegs::references);
    for (const auto& why : objections.texts())
        result.reasons.push_back(compared.branch + ": " + why);
    if (!objections.empty()) {
        given.equal_parameter.not_compared = given.equal_abscissa.not_compared =
            "there are no references";
        return given;
    }
    add_readings(model, branch, compared, channels,
                 {std::move(points), candidate.points, result.columns, result.defined}, given);
    add_missing_parts(branch, compared, given, result, channels, result.not_given);
    result.outside += std::max(given.equal_parameter.outside, given.equal_abscissa.outside);
    return given;
}

void read_branches(const Model& model, const Comparison& comparison, const Candidate& candidate,
                   CandidateJudgement& result) {
    const Points& places = candidate.points;
    const bool by_parameter = !places.a.empty();
    const auto branches =
        branches_of(model, comparison, places.branch, by_parameter ? places.a : places.at,
                    by_parameter ? std::nullopt : places.abscissa);
    if (const auto outside = std::ranges::count_if(branches, [](int b) { return b < 0; });
        outside > 0)
        result.notes.push_back(fmt::format("{} of its points lie on no branch", outside));
    for (std::size_t b = 0; b < comparison.branches.size(); ++b) {
        std::vector<std::size_t> points;
        for (std::size_t k = 0; k < branches.size(); ++k)
            if (branches[k] == static_cast<int>(b)) points.push_back(k);
        if (points.empty())
            result.not_given.push_back(fmt::format("branch '{}'", comparison.branches[b].branch));
        else
            result.branches.push_back(
                read_branch(model, comparison, b, candidate, std::move(points), result));
    }
}

// Whether every judged number of the columns is within its limit. Returns how many there are.
int judge_columns(const std::vector<ComparedReading>& readings,
                  const std::vector<Channel>& channels, CandidateJudgement& result, bool& within) {
    int judged = 0;
    for (const auto& [branch, of_branch, kind, reading] : readings) {
        const bool by_abscissa = kind == ReadingKind::equal_abscissa;
        if (by_abscissa) {
            const auto t = truth_of(of_branch).channel(static_cast<std::size_t>(branch.abscissa));
            const auto [low, high] = std::ranges::minmax(t);
            if (!(high - low >= min_travel)) continue;  // range too short for a reading
        }
        for (std::size_t c = 0; c < reading.columns.size(); ++c) {
            const Deviation& d = reading.columns[c];
            const Channel& channel = channels[result.columns[c].channel];
            result.compared += d.compared;
            if (!result.judged[c] || d.compared == 0) continue;
            judged += d.compared;
            const double extent = of_branch.extents[result.columns[c].channel];
            CandidateWorst worst;
            worst.branch = branch.branch;
            worst.channel = channel.name;
            worst.unit = channel.unit;
            worst.max = d.max;
            worst.end = d.end;
            worst.range = d.range;
            worst.kind = kind;
            worst.at = d.at;
            worst.limit = limit_of(channel, extent, result.tolerance);
            worst.extent = std::isinf(bound_of(channel, result.tolerance)) ? extent : 0;
            keep_worst(result.worst, worst);
            within = within && std::isfinite(d.max) && d.max <= worst.limit;
            if (!std::isfinite(d.max))
                result.reasons.push_back(fmt::format(
                    "its {} is not a number at {:.6g} {} of branch '{}'", channel.name, d.at,
                    by_abscissa ? symbol(channels[static_cast<std::size_t>(branch.abscissa)].unit)
                                : symbol(branch.unit),
                    branch.branch));
        }
    }
    return judged;
}

// Judges the states of the candidate by their constraint residuals in the equilibrium leg.
void judge_states(CandidateJudgement& result, bool& within) {
    for (const auto& side : result.state_residuals) {
        double residual = 0;  // largest of the states [mm]; NaN counts as larger than all numbers
        for (const auto& r : side.truth) residual = worse(1e3 * r.length, residual);
        if (!side.why_not.empty() || residual <= result.tolerance.mm) continue;
        within = false;
        result.hints.push_back(fmt::format(
            "its states miss the constraints of branch '{}' by {:.2g} mm", side.branch, residual));
    }
}

// Notes which of its reactions are not compared, since redundant joints share them.
void note_shared(const Comparison& comparison, CandidateJudgement& result) {
    std::vector<std::string> shared;
    std::string why;
    for (const auto& column : result.columns) {
        const Channel& channel = comparison.channels[column.channel];
        if (channel.joints().empty() ||
            std::ranges::none_of(comparison.branches, [&](const BranchComparison& b) {
                return is_undefined_somewhere(column.channel, truth_of(b));
            }))
            continue;
        shared.push_back(channel.name);
        why = why_undefined(channel);
    }
    if (!shared.empty())
        result.notes.push_back(fmt::format("not compared: {}: {}", fmt::join(shared, ", "), why));
}

// Explains the columns beyond their limits, by a wrong sign, unit or the like where one fits.
void explain_columns(const std::vector<ComparedReading>& readings, const Comparison& comparison,
                     const Candidate& candidate, CandidateJudgement& result) {
    // One reading for each branch: at equal parameter where available, else at equal abscissa.
    std::vector<BranchReading> branches;
    for (const auto& branch : result.branches)
        branches.push_back({&comparison.branch(branch.branch),
                            branch.equal_parameter.columns.empty() ? &branch.equal_abscissa
                                                                   : &branch.equal_parameter});
    for (std::size_t c = 0; c < result.columns.size(); ++c) {
        const double bound =
            bound_of(comparison.channels[result.columns[c].channel], result.tolerance);
        const bool off = std::ranges::any_of(readings, [&](const ComparedReading& compared) {
            const Deviation& d = compared.reading.columns[c];
            return d.compared > 0 &&
                   !(d.max <= (std::isfinite(bound) ? bound : 1e-3 * std::max(d.range, 1e-9)));
        });
        if (!off || (candidate.every_output && !result.judged[c])) continue;
        ColumnWithReference b =
            column_with_reference(comparison, result.columns, result.defined, branches, c);
        b.tolerance = bound;
        if (auto found = explain(b)) result.explanations.push_back(*found);
    }
    const auto exchanged = [&](const Explanation& explanation, const Explanation& other) {
        return explanation.kind == Explanation::Kind::other_output &&
               explanation.kind == other.kind &&
               explanation.other == result.columns[other.column].channel &&
               other.other == result.columns[explanation.column].channel;
    };
    Points with_absolute_values = candidate.points;
    with_absolute_values.columns = result.columns;
    for (auto& explanation : result.explanations) {
        bool included = false;  // in the hint on the column with which it is exchanged
        for (const auto& other : result.explanations)
            if (exchanged(explanation, other)) {
                explanation.mutual = true;
                included = included || &other < &explanation;
            }
        if (!included)
            result.hints.push_back(describe(explanation, comparison, with_absolute_values));
    }
}

}  // namespace

ColumnWithReference column_with_reference(const Comparison& comparison,
                                          std::span<const PointColumn> columns,
                                          std::span<const Channel> defined,
                                          std::span<const BranchReading> branches, std::size_t c) {
    ColumnWithReference b;
    b.column = c;
    b.channel = columns[c].channel;
    const Channel& channel = comparison.channels[b.channel];
    std::vector<std::size_t> others, definitions;
    for (std::size_t d = 0; d < columns.size(); ++d)
        if (d != c && comparison.channels[columns[d].channel].unit == channel.unit) {
            others.push_back(d);
            b.other_channels.push_back(columns[d].channel);
        }
    for (std::size_t d = 0; d < defined.size(); ++d)
        if (!definitions_of(defined.subspan(d, 1), channel.name).empty()) {
            definitions.push_back(d);
            b.definition_names.push_back(defined[d].name);
        }
    b.others.resize(others.size());
    b.definitions.resize(definitions.size());
    for (const auto& [branch, reading] : branches)
        for (std::size_t k = 0; k < reading->at.size(); ++k) {
            const double theirs = reading->candidate[c][k], ours = reading->truth[c][k];
            if (!std::isfinite(theirs) || !std::isfinite(ours)) continue;
            const Curve& truth = truth_of(*branch);
            b.candidate.push_back(theirs);
            b.reference.push_back(ours);
            b.begin.push_back(truth.values[truth.start][b.channel]);
            b.at.push_back(reading->at[k]);
            b.branch.push_back(branch->branch);
            for (std::size_t o = 0; o < others.size(); ++o)
                b.others[o].push_back(reading->truth[others[o]][k]);
            for (std::size_t d = 0; d < definitions.size(); ++d)
                b.definitions[d].push_back(reading->defined[definitions[d]][k]);
        }
    return b;
}

CandidateJudgement judge_candidate(const Model& model, const Comparison& comparison,
                                   const Candidate& candidate, const Tolerance& tolerance,
                                   bool tolerance_given) {
    CandidateJudgement result = outline_of(model, comparison, candidate, tolerance);
    result.tolerance_given = tolerance_given;
    read_branches(model, comparison, candidate, result);
    const auto readings = readings_of(result, comparison);
    bool within = true;
    const int judged = judge_columns(readings, comparison.channels, result, within);
    if (std::ranges::any_of(candidate.points.a, [](double a) { return std::isinf(a); }))
        result.reasons.emplace_back("the parameter of a point is not a number");
    judge_states(result, within);
    note_shared(comparison, result);
    if (is_constant(readings)) result.reasons.emplace_back("nothing moves in it");
    if (within && only_start_is_given(readings, result)) {
        const std::string names = uncompared_names(result, comparison);
        result.reasons.push_back(
            names.empty()
                ? "its points are all where the branches begin: nothing has moved there"
                : fmt::format("{} is not compared: an output that is not determined or has "
                              "no value somewhere on a branch is not compared on it",
                              names));
    }
    if (judged == 0)
        result.reasons.emplace_back(result.compared == 0
                                        ? "nothing was compared"
                                        : "nothing that was compared has a tolerance");
    if (candidate.complete)
        for (const auto& missing : result.not_given)
            result.reasons.push_back("it does not give " + missing);
    explain_columns(readings, comparison, candidate, result);
    if (result.reasons.empty()) result.verdict = within ? Grade::pass : Grade::fail;
    return result;
}

}  // namespace elastocheck::compare
