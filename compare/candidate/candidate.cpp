#include "compare/candidate/candidate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/comparison/compare.hpp"
#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/readings.hpp"
#include "compare/studies/findings.hpp"

namespace elastocheck::compare {
namespace {

constexpr double same_load = 1e-14;  // of a branch's length: rounding of a unit conversion
constexpr double end_met = 1e-9;     // of a branch's length: tolerance of a point at the end
// of a branch's length: a larger missing part counts as not given
constexpr double part_left = 1e-6;

const Curve& truth_of(const BranchComparison& branch) { return branch.run(Leg::equilibrium).curve; }

// Limit of an output on any branch; infinite where the limit is a share of the output's extent on a
// branch.
double bound_of(const Channel& channel, const Tolerance& tolerance) {
    return limit_of(channel, std::numeric_limits<double>::infinity(), tolerance);
}

// ---- The equilibrium leg at the points of the candidate.

// Outputs at loads [SI] of a branch, continued over the branch's own grid; empty where the leg does
// not get there.
class Reference {
  public:
    Reference(const Model& model, const Branch& branch, int steps, std::vector<Channel> channels)
        : model_(model),
          sides_(sides_of(model, branch, steps)),
          sorted_(requested_parameters(sides_, 1)),
          channels_(std::move(channels)) {
        std::ranges::sort(sorted_);
    }

    const std::vector<double>* at(double load) const {
        if (std::isnan(load)) return nullptr;
        const auto found = known_.find(load);
        return found == known_.end() ? nullptr : &found->second;
    }

    // Load at which the reference is evaluated: that of a step if equal to rounding, the given load
    // within the branch side, its end up to `end_met` beyond; else NaN.
    double placed(double load) const {
        const double length = sorted_.back() - sorted_.front();
        const auto near = std::ranges::lower_bound(sorted_, load - same_load * length);
        if (near != sorted_.end() && *near - load <= same_load * length) return *near;
        for (const auto& side : sides_) {
            const double to = side.branch.to;
            if (load * to < 0) continue;
            if (std::abs(load) <= std::abs(to)) return load;
            if (std::abs(load) <= std::abs(to) * (1 + end_met)) return to;
        }
        return nan;
    }

    void visit(const std::vector<double>& loads) {
        Analyses analyses;
        for (const auto& side : sides_) {
            const double to = side.branch.to;
            std::vector<double> requested;
            for (const double load : loads)
                if (std::isfinite(load) && load * to >= 0 && std::abs(load) <= std::abs(to) &&
                    at(load) == nullptr)
                    requested.push_back(load);
            if (requested.empty()) continue;
            const auto nearer = [](double a, double b) { return std::abs(a) < std::abs(b); };
            std::ranges::sort(requested, nearer);
            std::vector<double> all = requested_parameters({side}, 1);
            std::erase_if(all, [&](double a) { return std::abs(a) > std::abs(requested.back()); });
            std::ranges::copy(requested, std::back_inserter(all));
            std::ranges::sort(all, nearer);
            all.erase(std::unique(all.begin(), all.end()), all.end());
            walk_through(side, Leg::equilibrium, all, [&](const Equilibrium& state) {
                if (!std::ranges::binary_search(requested, state.load, nearer)) return;
                known_[state.load] =
                    row_of(model_, channels_, side, {.leg = Leg::equilibrium}, state, analyses)
                        .values;
            });
        }
    }

  private:
    const Model& model_;
    std::vector<BranchSide> sides_;
    std::vector<double> sorted_;  // loads of its steps
    std::vector<Channel> channels_;
    std::map<double, std::vector<double>> known_;
};

// ---- One reading of one branch.

struct Requested {  // points of the candidate on one branch
    std::vector<std::size_t> points;
    std::vector<double> x;     // position given by the candidate: parameter [unit] or abscissa
    std::vector<double> load;  // load requested from the reference [SI]; NaN beyond its range
};

// Compares candidate and reference column by column. The reference's rows hold the columns, then
// `defined` other definitions.
CandidateReading compared(const Requested& requested, const std::vector<PointColumn>& columns,
                          std::size_t defined, Reference& reference,
                          const BranchComparison& branch) {
    CandidateReading reading;
    std::vector<const std::vector<double>*> rows;
    std::vector<std::size_t> points;
    for (std::size_t k = 0; k < requested.points.size(); ++k) {
        if (std::isnan(requested.x[k])) continue;  // the candidate gives no position
        const auto* row = std::isnan(requested.load[k]) ? nullptr : reference.at(requested.load[k]);
        if (row == nullptr) {
            ++reading.outside;
            continue;
        }
        rows.push_back(row);
        points.push_back(requested.points[k]);
        reading.at.push_back(requested.x[k]);
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
        std::vector<double> mine, truth, at, all_mine, all_truth;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const double value = columns[c].values[points[k]];
            const bool given = branch.determined[columns[c].channel] && !std::isnan(value);
            all_mine.push_back(given ? value : nan);
            all_truth.push_back(given ? (*rows[k])[c] : nan);
            if (!given) continue;
            mine.push_back(value), truth.push_back((*rows[k])[c]), at.push_back(reading.at[k]);
        }
        Deviation deviation = deviation_of(truth, mine, at);
        const auto whole = truth_of(branch).channel(columns[c].channel);
        const auto [low, high] = std::ranges::minmax(whole);
        deviation.range = high - low;
        reading.columns.push_back(deviation);
        reading.candidate.push_back(std::move(all_mine));
        reading.truth.push_back(std::move(all_truth));
    }
    for (std::size_t d = 0; d < defined; ++d) {
        auto& values = reading.defined.emplace_back();
        for (const auto* row : rows) values.push_back((*row)[columns.size() + d]);
    }
    return reading;
}

CandidateReading at_equal_parameter(const std::vector<std::size_t>& points,
                                    const Candidate& candidate,
                                    const std::vector<PointColumn>& columns, std::size_t defined,
                                    Reference& reference, const BranchComparison& branch) {
    CandidateReading none;
    if (candidate.points.a.empty()) {
        none.not_compared = fmt::format("it gives no {}", parameter_word(symbol(branch.unit)));
        return none;
    }
    Requested requested{points, {}, {}};
    for (const std::size_t k : points) {
        requested.x.push_back(candidate.points.a[k]);
        requested.load.push_back(reference.placed(candidate.points.a[k] / in_unit(branch.unit)));
    }
    reference.visit(requested.load);
    return compared(requested, columns, defined, reference, branch);
}

// Abscissa values of the candidate's points, or null.
const std::vector<double>* abscissa_of(const Candidate& candidate,
                                       const std::vector<PointColumn>& columns, int channel) {
    if (channel < 0) return nullptr;
    const auto c = static_cast<std::size_t>(channel);
    if (candidate.points.abscissa == c) return &candidate.points.at;
    const auto column = std::ranges::find(columns, c, &PointColumn::channel);
    return column == columns.end() ? nullptr : &column->values;
}

CandidateReading at_equal_abscissa(const std::vector<std::size_t>& points,
                                   const Candidate& candidate,
                                   const std::vector<PointColumn>& columns, std::size_t defined,
                                   const std::vector<Channel>& channels, Reference& reference,
                                   const BranchComparison& branch) {
    CandidateReading reading;
    const auto* placed = abscissa_of(candidate, columns, branch.abscissa);
    if (branch.abscissa < 0) {
        reading.not_compared = "the scene has no position to read by";
        return reading;
    }
    const auto c = static_cast<std::size_t>(branch.abscissa);
    const Curve& truth = truth_of(branch);
    if (placed == nullptr) {
        reading.not_compared = fmt::format("it gives no {}", channels[c].name);
        return reading;
    }
    if (const Abscissa by = abscissa(channels, branch.abscissa, truth, truth);
        !by.why_not.empty()) {
        reading.not_compared = by.why_not;
        return reading;
    }
    const auto t = truth.channel(c);
    const double length = std::abs(t.back() - t.front()), rounding = end_met * length;
    const double per_unit = 1 / in_unit(branch.unit);
    // The abscissa is the last requested channel.
    const auto travel = [&](double load) {
        const auto* row = reference.at(load);
        return row == nullptr ? nan : row->back();
    };
    Requested requested{points, {}, {}};
    std::vector<double> slope;  // Δa/Δt [SI per unit]
    for (const std::size_t k : points) {
        const double at = (*placed)[k];
        requested.x.push_back(at);
        double load = nan, rate = nan;
        if (at >= std::min(t.front(), t.back()) - rounding &&
            at <= std::max(t.front(), t.back()) + rounding) {
            std::size_t i = 1;
            while (i + 1 < t.size() && (t[i] - at) * (t.back() - t.front()) < 0) ++i;
            rate = (truth.a[i] - truth.a[i - 1]) / (t[i] - t[i - 1]) * per_unit;
            load = reference.placed(per_unit * truth.a[i - 1] + (at - t[i - 1]) * rate);
        }
        requested.load.push_back(load), slope.push_back(rate);
    }
    constexpr int passes = 12;
    reference.visit(requested.load);
    for (int pass = 0; pass < passes; ++pass) {
        std::vector<double> next(points.size(), nan);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const double off = requested.x[k] - travel(requested.load[k]);
            if (!(std::abs(off) > 1e-13 * std::max(length, std::abs(requested.x[k]))))
                continue;  // converged, or no load
            const double load = reference.placed(requested.load[k] + off * slope[k]);
            if (load != requested.load[k]) next[k] = load;
        }
        reference.visit(next);
        bool better = false;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const double now = travel(requested.load[k]), there = travel(next[k]);
            if (!(std::abs(requested.x[k] - there) < std::abs(requested.x[k] - now)))
                continue;  // no further improvement
            slope[k] = (next[k] - requested.load[k]) / (there - now);
            requested.load[k] = next[k];
            better = true;
        }
        if (!better) break;
    }
    // a knot of a curve, or a branch that ends early
    for (std::size_t k = 0; k < points.size(); ++k)
        if (!(std::abs(travel(requested.load[k]) - requested.x[k]) <= rounding))
            requested.load[k] = nan;
    return compared(requested, columns, defined, reference, branch);
}

// ---- Missing parts.

// Parts of an interval that points leave out: the ends, and gaps wider than a quarter of the
// interval. " from 0 to 1500 N", "" if none.
std::string omitted(std::vector<double> at, double low, double high, std::string_view unit) {
    constexpr double widest = 0.25;
    const double length = high - low;
    std::ranges::sort(at);
    std::string parts;
    const auto add = [&](double from, double to, double share) {
        if (to - from > share * length)
            parts += fmt::format("{} from {:.6g} to {:.6g} {}", parts.empty() ? "" : " and",
                                 from + 0.0, to + 0.0, unit);
    };
    add(low, at.empty() ? high : at.front(), part_left);
    for (std::size_t k = 1; k < at.size(); ++k) add(at[k - 1], at[k], widest * (1 + part_left));
    if (!at.empty()) add(at.back(), high, part_left);
    return parts;
}

// Missing parts of the judged columns; a column that is complete in either reading has none.
// "branch 'jounce' from 1500 to 3000 N", "camber on branch 'jounce' from 1500 to 3000 N"
void add_missing_parts(const Branch& branch, const BranchComparison& of,
                       const CandidateBranch& given, const CandidateJudgement& judgement,
                       const std::vector<Channel>& channels, std::vector<std::string>& list) {
    const double unit = in_unit(of.unit);
    const auto missing = [&](std::size_t c) {
        std::optional<std::string> least;
        for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
            const auto& reading = given.reading(kind);
            if (reading.columns.empty()) continue;
            double low = unit * std::min(branch.from, branch.to),
                   high = unit * std::max(branch.from, branch.to);
            std::string_view in = symbol(of.unit);
            if (kind == ReadingKind::equal_abscissa) {
                const auto abscissa = static_cast<std::size_t>(of.abscissa);
                const auto travel = truth_of(of).channel(abscissa);
                low = std::ranges::min(travel), high = std::ranges::max(travel);
                in = symbol(channels[abscissa].unit);
                if (!(high - low >= least_travel)) continue;
            }
            std::vector<double> at;
            for (std::size_t k = 0; k < reading.at.size(); ++k)
                if (!std::isnan(reading.candidate[c][k])) at.push_back(reading.at[k]);
            const std::string parts = omitted(std::move(at), low, high, in);
            if (!least || parts.empty()) least = parts;
        }
        return least;
    };
    std::vector<std::pair<std::string, std::string>> of_columns;  // name, missing part
    for (std::size_t c = 0; c < judgement.columns.size(); ++c) {
        const std::size_t channel = judgement.columns[c].channel;
        if (!judgement.judged[c] || !of.determined[channel]) continue;
        if (auto parts = missing(c))
            of_columns.emplace_back(channels[channel].name, std::move(*parts));
    }
    if (of_columns.empty()) return;  // the reason for no comparison is already reported
    const bool alike = std::ranges::all_of(
        of_columns, [&](const auto& column) { return column.second == of_columns.front().second; });
    if (alike && !of_columns.front().second.empty())
        list.push_back(fmt::format("branch '{}'{}", of.branch, of_columns.front().second));
    for (const auto& [name, parts] : of_columns)
        if (!alike && !parts.empty())
            list.push_back(fmt::format("{} on branch '{}'{}", name, of.branch, parts));
}

// Keeps the worst deviation of each unit, by its share of the limit; outputs whose limit is a share
// of their extent count as one unit.
void keep_worst(std::vector<CandidateWorst>& list, const CandidateWorst& worst) {
    const auto same = std::ranges::find_if(list, [&](const CandidateWorst& w) {
        return w.extent > 0 ? worst.extent > 0 : worst.extent == 0 && w.unit == worst.unit;
    });
    const auto taken = [](const CandidateWorst& w) { return w.max / w.limit; };
    if (same == list.end())
        list.push_back(worst);
    else if (worse(taken(worst), taken(*same)) != taken(*same) && !std::isnan(same->max))
        *same = worst;
}

// Whether every point of the candidate is at the start of its branch although the reference moves:
// then only the design position was compared.
bool none_has_moved(const CandidateJudgement& judgement, const Comparison& comparison) {
    bool moving_reference = false;
    for (const auto& branch : judgement.branches) {
        const Curve& truth = truth_of(comparison.branch(branch.branch));
        for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
            const auto& reading = branch.reading(kind);
            for (std::size_t c = 0; c < reading.columns.size(); ++c) {
                const double begin = truth.values[truth.start][judgement.columns[c].channel];
                for (const double v : reading.truth[c])
                    if (std::abs(v - begin) > 1e-9) return false;
                moving_reference = moving_reference || reading.columns[c].range > 1e-6;
            }
        }
    }
    return moving_reference;
}

// The outputs that no branch compares, "its 'ackermann'"; empty where one is compared.
std::string nowhere_compared(const CandidateJudgement& judgement, const Comparison& comparison) {
    std::string names;
    for (const auto& column : judgement.columns) {
        for (const auto& branch : judgement.branches)
            if (comparison.branch(branch.branch).determined[column.channel]) return {};
        names += fmt::format("{}'{}'", names.empty() ? "its " : ", ",
                             comparison.channels[column.channel].name);
    }
    return names;
}

// Whether the candidate is constant on every branch and in every column where the reference moves.
bool nothing_moves(const CandidateJudgement& judgement) {
    bool moving_reference = false;
    for (const auto& branch : judgement.branches)
        for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
            const auto& reading = branch.reading(kind);
            for (std::size_t c = 0; c < reading.columns.size(); ++c) {
                if (reading.columns[c].compared < 2) continue;
                double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
                for (std::size_t k = 0; k < reading.at.size(); ++k)
                    for (const int who : {0, 1}) {
                        const double v = (who == 0 ? reading.candidate : reading.truth)[c][k];
                        if (std::isfinite(v))
                            low[who] = std::min(low[who], v), high[who] = std::max(high[who], v);
                    }
                if (high[0] - low[0] > 1e-9) return false;
                moving_reference = moving_reference || high[1] - low[1] > 1e-6;
            }
        }
    return moving_reference;
}

// Concatenates all branches: at equal parameter where available, else at equal abscissa.
Beside beside(const CandidateJudgement& judgement, const Comparison& comparison, std::size_t c) {
    Beside b;
    b.column = c;
    b.channel = judgement.columns[c].channel;
    for (const auto& branch : judgement.branches) {
        const auto& reading =
            branch.equal_parameter.columns.empty() ? branch.equal_abscissa : branch.equal_parameter;
        if (reading.columns.empty()) continue;
        const auto& of = comparison.branch(branch.branch);
        const Curve& truth = truth_of(of);
        for (std::size_t k = 0; k < reading.at.size(); ++k) {
            if (!std::isfinite(reading.candidate[c][k]) || !std::isfinite(reading.truth[c][k]))
                continue;
            b.candidate.push_back(reading.candidate[c][k]);
            b.reference.push_back(reading.truth[c][k]);
            b.begin.push_back(truth.values[truth.start][b.channel]);
            b.at.push_back(reading.at[k]);
            b.branch.push_back(branch.branch);
        }
    }
    // Reference values at the same points.
    const auto concatenated = [&](const auto& values_of) {
        std::vector<double> values;
        for (const auto& branch : judgement.branches) {
            const auto& reading = branch.equal_parameter.columns.empty() ? branch.equal_abscissa
                                                                         : branch.equal_parameter;
            if (reading.columns.empty()) continue;
            for (std::size_t k = 0; k < reading.at.size(); ++k)
                if (std::isfinite(reading.candidate[c][k]) && std::isfinite(reading.truth[c][k]))
                    values.push_back(values_of(reading)[k]);
        }
        return values;
    };
    // Other outputs of this unit that the candidate gives too, since their reference values are
    // available.
    for (std::size_t d = 0; d < judgement.columns.size(); ++d) {
        const std::size_t channel = judgement.columns[d].channel;
        if (d == c || comparison.channels[channel].unit != comparison.channels[b.channel].unit)
            continue;
        b.others.push_back(
            concatenated([d](const auto& reading) -> const auto& { return reading.truth[d]; }));
        b.other_channels.push_back(channel);
    }
    const std::string& figure = comparison.channels[b.channel].name;
    for (std::size_t d = 0; d < judgement.defined.size(); ++d) {
        if (definitions_of(std::span(&judgement.defined[d], 1), figure).empty()) continue;
        b.definitions.push_back(
            concatenated([d](const auto& reading) -> const auto& { return reading.defined[d]; }));
        b.definition_names.push_back(judgement.defined[d].name);
    }
    return b;
}

}  // namespace

CandidateJudgement judge_candidate(const Model& model, const Comparison& comparison,
                                   const Candidate& candidate, const Tolerance& tolerance,
                                   bool tolerance_given) {
    CandidateJudgement result;
    result.name = candidate.name;
    result.tolerance = tolerance;
    result.tolerance_given = tolerance_given;
    result.leftovers = candidate.leftovers;
    result.notes = candidate.notes;
    result.columns = as_they_stand(model, comparison, candidate.points.columns);
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

    const auto& places = candidate.points;
    const bool by_parameter = !places.a.empty();
    const auto branches =
        branches_of(model, comparison, places.branch, by_parameter ? places.a : places.at,
                    by_parameter ? std::nullopt : places.abscissa);
    int nowhere = 0;
    for (const int b : branches) nowhere += b < 0;
    if (nowhere > 0)
        result.notes.push_back(fmt::format("{} of its points lie on no branch", nowhere));

    for (std::size_t b = 0; b < comparison.branches.size(); ++b) {
        const BranchComparison& of = comparison.branches[b];
        CandidateBranch given{of.branch, of.unit, 0, nan, nan, of.abscissa, {}, {}};
        std::vector<std::size_t> points;
        for (std::size_t k = 0; k < branches.size(); ++k)
            if (branches[k] == static_cast<int>(b)) points.push_back(k);
        if (points.empty()) {
            result.not_given.push_back(fmt::format("branch '{}'", of.branch));
            continue;
        }
        given.points = static_cast<int>(points.size());
        if (by_parameter)
            for (const std::size_t k : points) {
                if (std::isnan(places.a[k])) continue;
                given.from =
                    std::isnan(given.from) ? places.a[k] : std::min(given.from, places.a[k]);
                given.to = std::isnan(given.to) ? places.a[k] : std::max(given.to, places.a[k]);
            }
        const auto objections =
            disagreements(model, channels, model.branches[b], of, Of::references);
        for (const auto& why : objections.texts()) result.reasons.push_back(of.branch + ": " + why);
        if (!objections.empty()) {
            given.equal_parameter.not_compared = given.equal_abscissa.not_compared =
                "the references are none";
            result.branches.push_back(std::move(given));
            continue;
        }
        std::vector<Channel> outputs;
        for (const auto& column : result.columns) outputs.push_back(channels[column.channel]);
        outputs.insert(outputs.end(), result.defined.begin(), result.defined.end());
        if (of.abscissa >= 0) outputs.push_back(channels[static_cast<std::size_t>(of.abscissa)]);
        Reference reference(model, model.branches[b], of.steps, outputs);
        given.equal_parameter = at_equal_parameter(points, candidate, result.columns,
                                                   result.defined.size(), reference, of);
        given.equal_abscissa = at_equal_abscissa(points, candidate, result.columns,
                                                 result.defined.size(), channels, reference, of);
        add_missing_parts(model.branches[b], of, given, result, channels, result.not_given);
        result.outside += std::max(given.equal_parameter.outside, given.equal_abscissa.outside);
        result.branches.push_back(std::move(given));
    }

    bool within = true;
    int judged = 0;
    for (const auto& branch : result.branches)
        for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
            const auto& reading = branch.reading(kind);
            const bool by_abscissa = kind == ReadingKind::equal_abscissa;
            if (by_abscissa && branch.abscissa >= 0 && !reading.columns.empty()) {
                const auto t = truth_of(comparison.branch(branch.branch))
                                   .channel(static_cast<std::size_t>(branch.abscissa));
                const auto [low, high] = std::ranges::minmax(t);
                if (!(high - low >= least_travel)) continue;  // range too short for a reading
            }
            for (std::size_t c = 0; c < reading.columns.size(); ++c) {
                const Deviation& d = reading.columns[c];
                const Channel& channel = channels[result.columns[c].channel];
                result.compared += d.compared;
                if (!result.judged[c] || d.compared == 0) continue;
                judged += d.compared;
                const BranchComparison& of = comparison.branch(branch.branch);
                const double extent = of.extents[result.columns[c].channel],
                             limit = limit_of(channel, extent, tolerance);
                CandidateWorst worst;
                worst.branch = branch.branch, worst.channel = channel.name,
                worst.unit = channel.unit;
                worst.max = d.max, worst.end = d.end, worst.range = d.range;
                worst.kind = kind, worst.at = d.at, worst.limit = limit;
                worst.extent = std::isinf(bound_of(channel, tolerance)) ? extent : 0;
                keep_worst(result.worst, worst);
                within = within && std::isfinite(d.max) && d.max <= limit;
                if (!std::isfinite(d.max))
                    result.reasons.push_back(fmt::format(
                        "its {} is no number at {:.6g} {} of branch '{}'", channel.name, d.at,
                        by_abscissa
                            ? symbol(channels[static_cast<std::size_t>(branch.abscissa)].unit)
                            : symbol(branch.unit),
                        branch.branch));
            }
        }
    for (std::size_t k = 0; k < places.a.size(); ++k)
        if (std::isinf(places.a[k])) {
            result.reasons.emplace_back("where its points are is no number");
            break;
        }
    // constraint residual [mm]; NaN is largest
    const auto state_error = [&](const Leftover& left) {
        double worst = 0;
        for (const auto& r : left.truth) worst = worse(1e3 * r.length, worst);
        return worst;
    };
    for (const auto& left : result.leftovers)
        if (const double missed = state_error(left);
            left.why_not.empty() && !(missed <= tolerance.mm)) {
            within = false;
            result.hints.push_back(
                fmt::format("its states miss the constraints of branch '{}' by {:.2g} mm",
                            left.branch, missed));
        }

    std::string shared, why_shared;
    for (const auto& column : result.columns) {
        const Channel& channel = channels[column.channel];
        if (channel.joints().empty() ||
            std::ranges::none_of(comparison.branches, [&](const BranchComparison& b) {
                return is_undefined_somewhere(column.channel, truth_of(b));
            }))
            continue;
        shared += (shared.empty() ? "" : ", ") + channel.name;
        why_shared = why_undefined(channel);
    }
    if (!shared.empty())
        result.notes.push_back(fmt::format("not compared: {}: {}", shared, why_shared));
    if (nothing_moves(result)) result.reasons.emplace_back("nothing moves in it");
    if (within && none_has_moved(result, comparison)) {
        const std::string names = nowhere_compared(result, comparison);
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

    for (std::size_t c = 0; c < result.columns.size(); ++c) {
        const double bound = bound_of(channels[result.columns[c].channel], tolerance);
        bool off = false;
        for (const auto& branch : result.branches)
            for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
                const auto& reading = branch.reading(kind);
                if (reading.columns.empty() || reading.columns[c].compared == 0) continue;
                const Deviation& d = reading.columns[c];
                off = off ||
                      !(d.max <= (std::isfinite(bound) ? bound : 1e-3 * std::max(d.range, 1e-9)));
            }
        if (!off || (candidate.every_output && !result.judged[c])) continue;
        Beside b = beside(result, comparison, c);
        b.tolerance = bound;
        if (auto found = explain(b)) result.explanations.push_back(*found);
    }
    for (auto& one : result.explanations)
        for (const auto& other : result.explanations)
            one.mutual = one.mutual ||
                         (one.kind == Explanation::Kind::other_output && one.kind == other.kind &&
                          one.other == result.columns[other.column].channel &&
                          other.other == result.columns[one.column].channel);
    Points standing = candidate.points;
    standing.columns = result.columns;
    for (const auto& one : result.explanations) {
        const bool included =
            std::ranges::any_of(result.explanations, [&](const Explanation& other) {
                return &other < &one && one.mutual && other.mutual &&
                       one.other == result.columns[other.column].channel;
            });
        if (!included) result.hints.push_back(describe(one, comparison, standing));
    }
    if (result.reasons.empty()) result.verdict = within ? Grade::pass : Grade::fail;
    return result;
}

}  // namespace elastocheck::compare
