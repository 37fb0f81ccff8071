#include "compare/candidate/candidate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

    // Outputs at a load that was visited; null if the leg does not get there.
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

    // Solves the branch at these loads, besides the grid, and keeps the outputs there for at().
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
            std::vector<double> grid = requested_parameters({side}, 1);
            std::erase_if(grid, [&](double a) { return std::abs(a) > std::abs(requested.back()); });
            std::ranges::copy(requested, std::back_inserter(grid));
            std::ranges::sort(grid, nearer);
            grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
            solve_at(side, Leg::equilibrium, grid, [&](const Equilibrium& state) {
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

struct PointsOnBranch {
    std::vector<std::size_t> on_branch;  // points of the candidate
    const Points& points;
    const std::vector<PointColumn>& columns;
    // number of other definitions, which the reference's rows hold after the columns
    std::size_t defined = 0;
};

// Compares candidate and reference column by column, at the places `x` that the candidate gives
// (parameter [unit] or abscissa; NaN: none) and at the loads [SI] where the reference is there; NaN
// beyond its range.
CandidateReading compared(const PointsOnBranch& given, const std::vector<double>& x,
                          const std::vector<double>& loads, const Reference& reference,
                          const BranchComparison& branch) {
    CandidateReading reading;
    std::vector<const std::vector<double>*> rows;
    for (std::size_t k = 0; k < x.size(); ++k) {
        if (std::isnan(x[k])) continue;
        const auto* row = reference.at(loads[k]);
        if (row == nullptr) {
            ++reading.outside;
            continue;
        }
        rows.push_back(row);
        reading.points.push_back(given.on_branch[k]);
        reading.at.push_back(x[k]);
    }
    for (std::size_t c = 0; c < given.columns.size(); ++c) {
        const auto& [channel, change, values] = given.columns[c];
        std::vector<double> given_values, truth, places;
        auto &given_row = reading.candidate.emplace_back(rows.size(), nan),
             &truth_row = reading.truth.emplace_back(rows.size(), nan);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const double value = values[reading.points[k]];
            if (!branch.determined[channel] || std::isnan(value)) continue;
            given_values.push_back(given_row[k] = value);
            truth.push_back(truth_row[k] = (*rows[k])[c]);
            places.push_back(reading.at[k]);
        }
        const auto truth_on_branch = truth_of(branch).channel(channel);
        const auto [low, high] = std::ranges::minmax(truth_on_branch);
        reading.columns.push_back(deviation_of(truth, given_values, places));
        reading.columns.back().range = high - low;
    }
    for (std::size_t d = 0; d < given.defined; ++d) {
        auto& values = reading.defined.emplace_back();
        for (const auto* row : rows) values.push_back((*row)[given.columns.size() + d]);
    }
    return reading;
}

CandidateReading not_compared(std::string why) {
    CandidateReading none;
    none.not_compared = std::move(why);
    return none;
}

CandidateReading at_equal_parameter(const PointsOnBranch& given, Reference& reference,
                                    const BranchComparison& branch) {
    if (given.points.a.empty())
        return not_compared(fmt::format("it gives no {}", parameter_word(symbol(branch.unit))));
    std::vector<double> x, loads;
    for (const std::size_t k : given.on_branch) {
        x.push_back(given.points.a[k]);
        loads.push_back(reference.placed(given.points.a[k] / in_unit(branch.unit)));
    }
    reference.visit(loads);
    return compared(given, x, loads, reference, branch);
}

// Loads [SI] at which the reference is at the places `x` of the abscissa, which is its last output,
// by the secant method; NaN where it is not.
std::vector<double> loads_at(const std::vector<double>& x, Reference& reference,
                             const BranchComparison& branch) {
    const Curve& truth = truth_of(branch);
    const auto t = truth.channel(static_cast<std::size_t>(branch.abscissa));
    const double length = std::abs(t.back() - t.front()), rounding = end_met * length;
    const double per_unit = 1 / in_unit(branch.unit);
    const auto travel = [&](double load) {
        const auto* row = reference.at(load);
        return row == nullptr ? nan : row->back();
    };
    std::vector<double> loads(x.size(), nan), slope(x.size(), nan);  // Δa/Δt [SI per unit]
    for (std::size_t k = 0; k < x.size(); ++k) {
        if (!(x[k] >= std::min(t.front(), t.back()) - rounding) ||
            !(x[k] <= std::max(t.front(), t.back()) + rounding))
            continue;
        std::size_t i = 1;
        while (i + 1 < t.size() && (t[i] - x[k]) * (t.back() - t.front()) < 0) ++i;
        slope[k] = (truth.a[i] - truth.a[i - 1]) / (t[i] - t[i - 1]) * per_unit;
        loads[k] = reference.placed(per_unit * truth.a[i - 1] + (x[k] - t[i - 1]) * slope[k]);
    }
    constexpr int passes = 12;
    reference.visit(loads);
    bool better = true;
    for (int pass = 0; pass < passes && better; ++pass) {
        std::vector<double> next(x.size(), nan);
        for (std::size_t k = 0; k < x.size(); ++k) {
            const double miss = x[k] - travel(loads[k]);
            if (!(std::abs(miss) > 1e-13 * std::max(length, std::abs(x[k]))))
                continue;  // converged, or no load
            const double load = reference.placed(loads[k] + miss * slope[k]);
            if (load != loads[k]) next[k] = load;
        }
        reference.visit(next);
        better = false;
        for (std::size_t k = 0; k < x.size(); ++k) {
            const double travel_before = travel(loads[k]), travel_next = travel(next[k]);
            if (!(std::abs(x[k] - travel_next) < std::abs(x[k] - travel_before))) continue;
            slope[k] = (next[k] - loads[k]) / (travel_next - travel_before);
            loads[k] = next[k];
            better = true;
        }
    }
    // a knot of a curve, or a branch that ends early
    for (std::size_t k = 0; k < x.size(); ++k)
        if (!(std::abs(travel(loads[k]) - x[k]) <= rounding)) loads[k] = nan;
    return loads;
}

CandidateReading at_equal_abscissa(const PointsOnBranch& given,
                                   const std::vector<Channel>& channels, Reference& reference,
                                   const BranchComparison& branch) {
    if (branch.abscissa < 0) return not_compared("the scene has no position to read by");
    const auto c = static_cast<std::size_t>(branch.abscissa);
    const auto column = std::ranges::find(given.columns, c, &PointColumn::channel);
    if (given.points.abscissa != c && column == given.columns.end())
        return not_compared(fmt::format("it gives no {}", channels[c].name));
    const auto& places = given.points.abscissa == c ? given.points.at : column->values;
    const Curve& truth = truth_of(branch);
    if (auto by = abscissa(channels, branch.abscissa, truth, truth); !by.why_not.empty())
        return not_compared(std::move(by.why_not));
    std::vector<double> x;
    for (const std::size_t k : given.on_branch) x.push_back(places[k]);
    return compared(given, x, loads_at(x, reference, branch), reference, branch);
}

// ---- Missing parts.

// Parts of an interval that points leave out: the ends, and gaps wider than a quarter of the
// interval. " from 0 to 1500 N", "" if none.
std::string omitted(std::vector<double> places, double low, double high, std::string_view unit) {
    constexpr double widest = 0.25;
    const double length = high - low;
    std::ranges::sort(places);
    std::string parts;
    const auto add = [&](double from, double to, double share) {
        if (to - from > share * length)
            parts += fmt::format("{} from {:.6g} to {:.6g} {}", parts.empty() ? "" : " and",
                                 from + 0.0, to + 0.0, unit);
    };
    add(low, places.empty() ? high : places.front(), part_left);
    for (std::size_t k = 1; k < places.size(); ++k)
        add(places[k - 1], places[k], widest * (1 + part_left));
    if (!places.empty()) add(places.back(), high, part_left);
    return parts;
}

// Missing parts of the judged columns; a column that is complete in either reading has none.
// "branch 'jounce' from 1500 to 3000 N", "camber on branch 'jounce' from 1500 to 3000 N"
void add_missing_parts(const Branch& branch, const BranchComparison& compared_branch,
                       const CandidateBranch& given, const CandidateJudgement& judgement,
                       const std::vector<Channel>& channels, std::vector<std::string>& list) {
    const double unit = in_unit(compared_branch.unit);
    const auto missing = [&](std::size_t c) {
        std::optional<std::string> least;
        for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
            const auto& reading = given.reading(kind);
            if (reading.columns.empty()) continue;
            double low = unit * std::min(branch.from, branch.to),
                   high = unit * std::max(branch.from, branch.to);
            std::string_view unit_name = symbol(compared_branch.unit);
            if (kind == ReadingKind::equal_abscissa) {
                const auto abscissa = static_cast<std::size_t>(compared_branch.abscissa);
                const auto travel = truth_of(compared_branch).channel(abscissa);
                low = std::ranges::min(travel), high = std::ranges::max(travel);
                unit_name = symbol(channels[abscissa].unit);
                if (!(high - low >= min_travel)) continue;
            }
            std::vector<double> places;
            for (std::size_t k = 0; k < reading.at.size(); ++k)
                if (!std::isnan(reading.candidate[c][k])) places.push_back(reading.at[k]);
            const std::string parts = omitted(std::move(places), low, high, unit_name);
            if (!least || parts.empty()) least = parts;
        }
        return least;
    };
    std::vector<std::pair<std::string, std::string>> of_columns;  // name, missing part
    for (std::size_t c = 0; c < judgement.columns.size(); ++c) {
        const std::size_t channel = judgement.columns[c].channel;
        if (!judgement.judged[c] || !compared_branch.determined[channel]) continue;
        if (auto parts = missing(c))
            of_columns.emplace_back(channels[channel].name, std::move(*parts));
    }
    if (of_columns.empty()) return;  // the reason for no comparison is already reported
    const bool alike = std::ranges::all_of(
        of_columns, [&](const auto& column) { return column.second == of_columns.front().second; });
    if (alike && !of_columns.front().second.empty())
        list.push_back(
            fmt::format("branch '{}'{}", compared_branch.branch, of_columns.front().second));
    for (const auto& [name, parts] : of_columns)
        if (!alike && !parts.empty())
            list.push_back(fmt::format("{} on branch '{}'{}", name, compared_branch.branch, parts));
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

// ---- The judgement.

// A reading in which something is compared.
struct Compared {
    const CandidateBranch& branch;
    const BranchComparison& of;
    ReadingKind kind;
    const CandidateReading& reading;
};

std::vector<Compared> readings_of(const CandidateJudgement& judgement,
                                  const Comparison& comparison) {
    std::vector<Compared> list;
    for (const auto& branch : judgement.branches)
        for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa})
            if (const auto& reading = branch.reading(kind); !reading.columns.empty())
                list.push_back({branch, comparison.branch(branch.branch), kind, reading});
    return list;
}

constexpr double reference_moves_by = 1e-6;  // [mm], [deg], ...: of the reference
constexpr double candidate_moves = 1e-9;     // of the candidate

// Whether every point of the candidate is at the start of its branch although the reference moves:
// then only the design position was compared.
bool none_has_moved(const std::vector<Compared>& readings, const CandidateJudgement& judgement) {
    bool reference_moves = false;
    for (const auto& [branch, of, kind, reading] : readings)
        for (std::size_t c = 0; c < reading.columns.size(); ++c) {
            const Curve& truth = truth_of(of);
            const double begin = truth.values[truth.start][judgement.columns[c].channel];
            for (const double v : reading.truth[c])
                if (std::abs(v - begin) > candidate_moves) return false;
            reference_moves = reference_moves || reading.columns[c].range > reference_moves_by;
        }
    return reference_moves;
}

// Whether the candidate is constant on every branch and in every column where the reference moves.
bool nothing_moves(const std::vector<Compared>& readings) {
    const auto extent = [](std::vector<double> values) {
        std::erase_if(values, [](double v) { return !std::isfinite(v); });
        if (values.empty()) return 0.;
        const auto [low, high] = std::ranges::minmax(values);
        return high - low;
    };
    bool reference_moves = false;
    for (const auto& [branch, of, kind, reading] : readings)
        for (std::size_t c = 0; c < reading.columns.size(); ++c) {
            if (reading.columns[c].compared < 2) continue;
            if (extent(reading.candidate[c]) > candidate_moves) return false;
            reference_moves = reference_moves || extent(reading.truth[c]) > reference_moves_by;
        }
    return reference_moves;
}

// The outputs that no branch compares, "its 'ackermann'"; empty where one is compared.
std::string nowhere_compared(const CandidateJudgement& judgement, const Comparison& comparison) {
    std::vector<std::string> names;
    for (const auto& column : judgement.columns) {
        for (const auto& branch : judgement.branches)
            if (comparison.branch(branch.branch).determined[column.channel]) return {};
        names.push_back(fmt::format("'{}'", comparison.channels[column.channel].name));
    }
    return names.empty() ? "" : fmt::format("its {}", fmt::join(names, ", "));
}

// What the candidate gives and what is judged of it.
CandidateJudgement outline_of(const Model& model, const Comparison& comparison,
                              const Candidate& candidate, const Tolerance& tolerance) {
    CandidateJudgement result;
    result.name = candidate.name;
    result.tolerance = tolerance;
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
    return result;
}

// The candidate's points on one branch, in both readings.
CandidateBranch read_branch(const Model& model, const Comparison& comparison, std::size_t b,
                            const Candidate& candidate, std::vector<std::size_t> points,
                            CandidateJudgement& result) {
    const Branch& branch = model.branches[b];
    const BranchComparison& of = comparison.branches[b];
    const std::vector<Channel>& channels = comparison.channels;
    CandidateBranch given{
        of.branch, of.unit, static_cast<int>(points.size()), nan, nan, of.abscissa, {}, {}};
    for (const std::size_t k : points) {
        if (candidate.points.a.empty() || std::isnan(candidate.points.a[k])) continue;
        const double a = candidate.points.a[k];
        given.from = std::isnan(given.from) ? a : std::min(given.from, a);
        given.to = std::isnan(given.to) ? a : std::max(given.to, a);
    }
    const auto objections = disagreements(model, channels, branch, of, Of::references);
    for (const auto& why : objections.texts()) result.reasons.push_back(of.branch + ": " + why);
    if (!objections.empty()) {
        given.equal_parameter.not_compared = given.equal_abscissa.not_compared =
            "there are no references";
        return given;
    }
    std::vector<Channel> outputs;
    for (const auto& column : result.columns) outputs.push_back(channels[column.channel]);
    outputs.insert(outputs.end(), result.defined.begin(), result.defined.end());
    if (of.abscissa >= 0) outputs.push_back(channels[static_cast<std::size_t>(of.abscissa)]);
    Reference reference(model, branch, of.steps, outputs);
    const PointsOnBranch all{std::move(points), candidate.points, result.columns,
                             result.defined.size()};
    given.equal_parameter = at_equal_parameter(all, reference, of);
    given.equal_abscissa = at_equal_abscissa(all, channels, reference, of);
    add_missing_parts(branch, of, given, result, channels, result.not_given);
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
    if (const auto nowhere = std::ranges::count_if(branches, [](int b) { return b < 0; });
        nowhere > 0)
        result.notes.push_back(fmt::format("{} of its points lie on no branch", nowhere));
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
int judge_columns(const std::vector<Compared>& readings, const std::vector<Channel>& channels,
                  CandidateJudgement& result, bool& within) {
    int judged = 0;
    for (const auto& [branch, of, kind, reading] : readings) {
        const bool by_abscissa = kind == ReadingKind::equal_abscissa;
        if (by_abscissa) {
            const auto t = truth_of(of).channel(static_cast<std::size_t>(branch.abscissa));
            const auto [low, high] = std::ranges::minmax(t);
            if (!(high - low >= min_travel)) continue;  // range too short for a reading
        }
        for (std::size_t c = 0; c < reading.columns.size(); ++c) {
            const Deviation& d = reading.columns[c];
            const Channel& channel = channels[result.columns[c].channel];
            result.compared += d.compared;
            if (!result.judged[c] || d.compared == 0) continue;
            judged += d.compared;
            const double extent = of.extents[result.columns[c].channel];
            CandidateWorst worst;
            worst.branch = branch.branch, worst.channel = channel.name, worst.unit = channel.unit;
            worst.max = d.max, worst.end = d.end, worst.range = d.range;
            worst.kind = kind, worst.at = d.at;
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

// Whether its states meet the constraints.
void judge_states(CandidateJudgement& result, bool& within) {
    for (const auto& left : result.leftovers) {
        double missed = 0;  // [mm]; NaN is largest
        for (const auto& r : left.truth) missed = worse(1e3 * r.length, missed);
        if (!left.why_not.empty() || missed <= result.tolerance.mm) continue;
        within = false;
        result.hints.push_back(fmt::format(
            "its states miss the constraints of branch '{}' by {:.2g} mm", left.branch, missed));
    }
}

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

// Tries the columns that are off.
void explain_columns(const std::vector<Compared>& readings, const Comparison& comparison,
                     const Candidate& candidate, CandidateJudgement& result) {
    // Of all branches: at equal parameter where available, else at equal abscissa.
    std::vector<ReadBranch> branches;
    for (const auto& branch : result.branches)
        branches.push_back({&comparison.branch(branch.branch),
                            branch.equal_parameter.columns.empty() ? &branch.equal_abscissa
                                                                   : &branch.equal_parameter});
    for (std::size_t c = 0; c < result.columns.size(); ++c) {
        const double bound =
            bound_of(comparison.channels[result.columns[c].channel], result.tolerance);
        const bool off = std::ranges::any_of(readings, [&](const Compared& of) {
            const Deviation& d = of.reading.columns[c];
            return d.compared > 0 &&
                   !(d.max <= (std::isfinite(bound) ? bound : 1e-3 * std::max(d.range, 1e-9)));
        });
        if (!off || (candidate.every_output && !result.judged[c])) continue;
        Beside b = beside(comparison, result.columns, result.defined, branches, c);
        b.tolerance = bound;
        if (auto found = explain(b)) result.explanations.push_back(*found);
    }
    const auto exchanged = [&](const Explanation& one, const Explanation& other) {
        return one.kind == Explanation::Kind::other_output && one.kind == other.kind &&
               one.other == result.columns[other.column].channel &&
               other.other == result.columns[one.column].channel;
    };
    Points standing = candidate.points;
    standing.columns = result.columns;
    for (auto& one : result.explanations) {
        bool included = false;  // in the words about the column that it is exchanged with
        for (const auto& other : result.explanations)
            if (exchanged(one, other)) one.mutual = true, included = included || &other < &one;
        if (!included) result.hints.push_back(describe(one, comparison, standing));
    }
}

}  // namespace

Beside beside(const Comparison& comparison, std::span<const PointColumn> columns,
              std::span<const Channel> defined, std::span<const ReadBranch> branches,
              std::size_t c) {
    Beside b;
    b.column = c;
    b.channel = columns[c].channel;
    const Channel& channel = comparison.channels[b.channel];
    std::vector<std::size_t> others, definitions;
    for (std::size_t d = 0; d < columns.size(); ++d)
        if (d != c && comparison.channels[columns[d].channel].unit == channel.unit)
            others.push_back(d), b.other_channels.push_back(columns[d].channel);
    for (std::size_t d = 0; d < defined.size(); ++d)
        if (!definitions_of(defined.subspan(d, 1), channel.name).empty())
            definitions.push_back(d), b.definition_names.push_back(defined[d].name);
    b.others.resize(others.size()), b.definitions.resize(definitions.size());
    for (const auto& [branch, reading] : branches)
        for (std::size_t k = 0; k < reading->at.size(); ++k) {
            const double theirs = reading->candidate[c][k], ours = reading->truth[c][k];
            if (!std::isfinite(theirs) || !std::isfinite(ours)) continue;
            const Curve& truth = truth_of(*branch);
            b.candidate.push_back(theirs), b.reference.push_back(ours);
            b.begin.push_back(truth.values[truth.start][b.channel]);
            b.at.push_back(reading->at[k]), b.branch.push_back(branch->branch);
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
    if (nothing_moves(readings)) result.reasons.emplace_back("nothing moves in it");
    if (within && none_has_moved(readings, result)) {
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
    explain_columns(readings, comparison, candidate, result);
    if (result.reasons.empty()) result.verdict = within ? Grade::pass : Grade::fail;
    return result;
}

}  // namespace elastocheck::compare
