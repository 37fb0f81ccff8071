#include "compare/gate/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "compare/comparison/compliance.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::compare {
namespace {

constexpr int points_per_branch = 11;

// Rounds to nine decimals, so that round-off of a build does not change the text of a baseline.
// Adding zero turns -0 into 0.
double rounded(double value) {
    constexpr double decimals = 1e9;  // mm, deg, N, N·m
    return std::round(value * decimals) / decimals + 0.0;
}

auto key(const Series& s) { return std::tie(s.branch, s.quantity, s.channel); }

std::string described(const std::string& branch, Quantity quantity, const std::string& channel) {
    return fmt::format("branch '{}', {}: {}", branch, name(quantity), channel);
}
std::string described(const Series& s) { return described(s.branch, s.quantity, s.channel); }

const Series* find(const Measurement& in, const std::string& branch, Quantity quantity,
                   const std::string& channel) {
    for (const auto& s : in.series)
        if (s.branch == branch && s.quantity == quantity && s.channel == channel) return &s;
    return nullptr;
}

const GatedBranch* find(const Measurement& in, const std::string& branch) {
    const auto found = std::ranges::find(in.branches, branch, &GatedBranch::name);
    return found == in.branches.end() ? nullptr : &*found;
}

// Parameters of the numbers of a quantity; empty where they have none.
std::vector<double> places_of(Quantity quantity, const std::vector<double>& a) {
    if (kind_of(quantity).places == Places::points) return a;
    std::vector<double> places;
    if (kind_of(quantity).places == Places::stations)
        for (const std::size_t k : stations(a)) places.push_back(a[k]);
    return places;
}

bool is_deviation(Quantity q) {
    return q == Quantity::deviation_at_equal_parameter ||
           q == Quantity::deviation_at_equal_abscissa;
}

double range(const Series& s) {
    const auto [low, high] = std::ranges::minmax(s.values);
    return high - low;
}

// The scale of which Allowance::rtol is a share (gate.hpp).
double scale(const Measurement& accepted, const Series& s) {
    if (*kind_of(s.quantity).tolerance != 0)
        return std::abs(
            *std::ranges::max_element(s.values, {}, [](double v) { return std::abs(v); }));
    if (kind_of(s.quantity).places != Places::elsewhere) return range(s);
    if (!is_deviation(s.quantity)) return std::abs(s.values.front());
    const Series* curve = find(accepted, s.branch, Quantity::equilibrium, s.channel);
    return curve != nullptr && !curve->values.empty() ? range(*curve) : 0;
}

bool all_finite(const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

const Allowance* tolerance_of(const Tolerances& tolerances, const Series& s) {
    for (const std::string& key : {s.channel, std::string(kind_of(s.quantity).tolerance), s.unit})
        if (const auto found = tolerances.find(key); found != tolerances.end())
            return &found->second;
    return nullptr;
}

bool sane(double bound) { return std::isfinite(bound) && bound >= 0; }
bool sane(const Allowance* t) { return t != nullptr && sane(t->atol) && sane(t->rtol); }

// Smallest change of a number of the series that an engineer notices: from the baseline,
// else the default.
double noticeable(const Baseline& baseline, const Series& s) {
    static const Tolerances usual = default_tolerances(ToleranceClass::physical);
    const auto own = baseline.tolerances.find(ToleranceClass::physical);
    const Allowance* t = own == baseline.tolerances.end() ? nullptr : tolerance_of(own->second, s);
    if (!sane(t)) t = tolerance_of(usual, s);
    return t == nullptr ? 0 : t->atol + t->rtol * scale(baseline.accepted, s);
}

// Forces within the suspension and counters of the solver, in contrast to wheel outputs.
bool is_inner(const Offence& o) { return o.unit == "N" || o.unit == "N·m" || o.unit == "count"; }

// Rank in the order of comes_before(), 0 first.
int rank(const Offence& o) {
    if (o.of_limit) return 0;
    const bool at_design = o.a && *o.a == 0,
               of_reference = o.quantity == Quantity::equilibrium ||
                              o.quantity == Quantity::characteristic_equilibrium;
    return (o.noticed() > 1 ? 1 : 5) + (is_inner(o) ? 3 : !at_design ? 2 : of_reference ? 0 : 1);
}

// Judges one accepted series against its measurement.
void judge_series(const Baseline& baseline, const Tolerances& tolerances, const Series& was,
                  const Measurement& measurement, GateVerdict& verdict) {
    const auto cannot = [&](const std::string& why) {
        verdict.reasons.push_back(described(was) + " " + why);
    };
    const Series* is = find(measurement, was.branch, was.quantity, was.channel);
    if (is == nullptr) return cannot("is in the baseline and was not measured");
    if (is->unit != was.unit)
        return cannot(fmt::format("was in {} and is in {}", was.unit, is->unit));
    if (was.values.empty()) return cannot("has no numbers in the baseline");
    if (is->values.size() != was.values.size())
        return cannot(fmt::format("has {} numbers in the baseline, {} were measured",
                                  was.values.size(), is->values.size()));
    if (!all_finite(was.values)) return cannot("is not a finite number in the baseline");
    if (!all_finite(is->values))
        return cannot("was measured as something that is not a finite number");
    const GatedBranch* branch = find(baseline.accepted, was.branch);
    const std::vector<double> places =
        branch == nullptr ? std::vector<double>{} : places_of(was.quantity, branch->a);
    const Places kind_of_places = kind_of(was.quantity).places;
    const bool is_placed = kind_of_places == Places::points || kind_of_places == Places::stations;
    if (is_placed && places.size() != was.values.size())
        return cannot(fmt::format("has not as many numbers as its branch has {}",
                                  kind_of_places == Places::points ? "points" : "stations"));
    const Allowance* tolerance = tolerance_of(tolerances, was);
    if (!sane(tolerance))
        return cannot(fmt::format("has no usable tolerance in class {}", name(verdict.kind)));

    const double allowed = tolerance->atol + tolerance->rtol * scale(baseline.accepted, was);
    for (std::size_t k = 0; k < was.values.size(); ++k) {
        ++verdict.compared;
        const double difference = is->values[k] - was.values[k];
        if (std::isfinite(difference) && std::abs(difference) <= allowed) continue;
        Offence offence{.branch = was.branch,
                        .quantity = was.quantity,
                        .channel = was.channel,
                        .unit = was.unit,
                        .was = was.values[k],
                        .is = is->values[k],
                        .tolerance = allowed,
                        .noticeable = noticeable(baseline, was)};
        if (is_placed) {
            offence.a = places[k];
            offence.a_unit = branch->unit;
        }
        verdict.offences.push_back(offence);
    }
}

// Whether the limit is on this series.
bool is_of(const Limit& limit, const Series& s) {
    if (is_deviation(limit.of)) return s.quantity == limit.of && s.channel == limit.channel;
    const bool kept = limit.over.empty()
                          ? s.quantity == Quantity::equilibrium ||
                                s.quantity == Quantity::characteristic_equilibrium
                          : kind_of(s.quantity).places == Places::range && s.branch == limit.over;
    return kept && (s.channel == limit.channel || s.channel.ends_with("." + limit.channel));
}

// Reason why a limit is on nothing that was measured, with the nearest names.
std::string nothing_to_limit(const Limit& limit, const Measurement& measurement) {
    std::vector<std::string> names;
    if (!limit.over.empty() && find(measurement, limit.over) == nullptr) {
        for (const auto& branch : measurement.branches) names.push_back(branch.name);
        return fmt::format("there is no branch {}{}", reader::quote(limit.over),
                           reader::did_you_mean(limit.over, names, "branches"));
    }
    Limit any = limit;
    for (const auto& series : measurement.series) {
        any.channel = series.channel;
        if (!is_of(any, series)) continue;
        for (const std::string& name :
             {series.channel, series.channel.substr(series.channel.find('.') + 1)})
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    return "nothing of that name was measured" +
           reader::did_you_mean(limit.channel, names, "allowed");
}

void judge_limit(const Limit& limit, const Measurement& measurement, GateVerdict& verdict) {
    const bool of_figure = !is_deviation(limit.of);
    const auto cannot = [&](const std::string& why) {
        verdict.reasons.push_back(fmt::format(
            "limit on {}{}{}: {}", of_figure ? "" : fmt::format("{}: ", name(limit.of)),
            limit.channel, limit.over.empty() ? "" : fmt::format(" over branch '{}'", limit.over),
            why));
    };
    const bool usable =
        of_figure ? limit.min <= limit.max && (std::isfinite(limit.min) || std::isfinite(limit.max))
                  : sane(limit.max);
    if (!usable) return cannot("has nothing finite to compare");
    const int before = verdict.compared;
    for (const auto& s : measurement.series) {
        if (!is_of(limit, s)) continue;
        if (of_figure && s.unit != limit.unit)
            return cannot(fmt::format("is in {}, and {} is in {}", limit.unit, s.channel, s.unit));
        const GatedBranch* branch = find(measurement, s.branch);
        const std::vector<double> places =
            branch == nullptr ? std::vector<double>{} : places_of(s.quantity, branch->a);
        for (std::size_t k = 0; k < s.values.size(); ++k) {
            const bool everywhere = !of_figure || !limit.over.empty();
            if (!everywhere && (k >= places.size() || places[k] != 0)) continue;
            if (!std::isfinite(s.values[k])) return cannot("has nothing finite to compare");
            ++verdict.compared;
            if (s.values[k] >= limit.min && s.values[k] <= limit.max) continue;
            const double bound = s.values[k] > limit.max ? limit.max : limit.min;
            Offence offence{.branch = s.branch,
                            .quantity = s.quantity,
                            .channel = s.channel,
                            .unit = s.unit,
                            .of_limit = true,
                            .was = bound,
                            .is = s.values[k],
                            .tolerance = std::abs(bound)};
            if (!everywhere) {
                offence.a = 0;
                offence.a_unit = branch->unit;
            }
            verdict.offences.push_back(offence);
        }
    }
    if (verdict.compared == before) cannot(nothing_to_limit(limit, measurement));
}

std::string described(const GatedBranch& branch) {
    if (branch.a.empty()) return "nowhere";
    return fmt::format("{} points, {:g} to {:g} {}", branch.a.size(), branch.a.front(),
                       branch.a.back(), branch.unit);
}

// Branches present on both sides at the same parameters. Series of the other branches are not
// compared, since numbers at other parameters are not comparable.
std::vector<std::string> common_branches(const Baseline& baseline, const Measurement& measurement,
                                         GateVerdict& verdict) {
    std::vector<std::string> common;
    const auto cannot = [&](const std::string& branch, const std::string& why) {
        verdict.reasons.push_back(fmt::format("branch '{}' {}", branch, why));
    };
    for (const auto& was : baseline.accepted.branches) {
        const GatedBranch* is = find(measurement, was.name);
        if (is == nullptr)
            cannot(was.name, "is in the baseline and was not measured");
        else if (is->unit != was.unit)
            cannot(was.name, fmt::format("is driven in {} and was in {}", is->unit, was.unit));
        else if (is->a != was.a)
            cannot(was.name,
                   fmt::format("is measured elsewhere than the accepted one ({} instead of {})",
                               described(*is), described(was)));
        else
            common.push_back(was.name);
    }
    for (const auto& is : measurement.branches)
        if (find(baseline.accepted, is.name) == nullptr)
            cannot(is.name, "is new: the baseline does not have it");
    return common;
}

// A channel by both legs at the `points` that are kept, a characteristic at the stations among
// them; and the range of the equilibrium leg.
void add_curves(const BranchComparison& branch, std::size_t c, const Channel& channel,
                const GatedBranch& kept, const std::vector<std::size_t>& points,
                Measurement& result) {
    const bool is_rate = channel.kind() == ChannelKind::characteristic,
               is_arm = is_swing_arm(channel);
    const std::string unit = is_arm ? per_metre : symbol(channel.unit);
    const auto value = [&](const Curve& curve, std::size_t point) {
        const double v = curve.values[point][c];
        return rounded(is_arm ? 1e3 / v : v);
    };
    const auto add = [&](Quantity quantity, std::vector<double> values, bool main) {
        result.series.push_back(
            {branch.branch, quantity, channel.name, unit, std::move(values), main});
    };
    const Curve& of_r = branch.run(Leg::recursive).curve;
    const Curve& of_e = branch.run(Leg::equilibrium).curve;
    const std::size_t before = std::min(of_r.start, of_e.start);
    const auto kept_of = [&](const Curve& curve) {
        std::vector<double> values;
        for (const std::size_t k : points) values.push_back(value(curve, curve.start - before + k));
        if (!is_rate) return values;
        std::vector<double> at_stations;
        for (const std::size_t k : stations(kept.a)) at_stations.push_back(values[k]);
        return at_stations;
    };
    add(is_rate ? Quantity::characteristic_recursive : Quantity::recursive, kept_of(of_r), false);
    add(is_rate ? Quantity::characteristic_equilibrium : Quantity::equilibrium, kept_of(of_e),
        is_rate || reads_steering_axis(channel) ? result.branches.empty() : channel.main);
    if (!is_rate && !channel.kinematic()) return;
    std::vector<double> along_branch;
    for (std::size_t k = 0; k < of_e.values.size(); ++k) along_branch.push_back(value(of_e, k));
    if (along_branch.empty() || !all_finite(along_branch)) along_branch = {nan};
    add(is_rate ? Quantity::range_characteristic_equilibrium : Quantity::range_equilibrium,
        {*std::ranges::min_element(along_branch), *std::ranges::max_element(along_branch)}, false);
}

// Compliance matrices at the start of the first branch, one series per row.
void add_compliance(const Model& model, const Comparison& comparison, std::vector<Series>& series) {
    if (comparison.branches.empty()) return;
    const auto& branch = comparison.branches.front();
    for (const auto& [quantity, leg] : {std::pair{Quantity::compliance_recursive, Leg::recursive},
                                        {Quantity::compliance_equilibrium, Leg::equilibrium}})
        for (const auto& at : branch.run(leg).compliance) {
            if (at.a != 0) continue;
            for (const auto& [point, C] :
                 {std::pair{"wheel centre", &at.centre}, {"contact patch", &at.patch}})
                for (Eigen::Index r = 0; r < C->rows(); ++r) {
                    Series row{branch.branch,
                               quantity,
                               compliance_row_name(model, point, r),
                               r % 6 < 3 ? "mm" : "deg",
                               {}};
                    for (Eigen::Index c = 0; c < C->cols(); ++c)
                        row.values.push_back(rounded(in_table_units(*C, r, c)));
                    series.push_back(std::move(row));
                }
        }
}

void add_counters(const std::string& branch, Quantity quantity, const LegRun& run,
                  std::vector<Series>& series) {
    const auto add = [&](const char* counter, double value) {
        series.push_back({branch, quantity, counter, "count", {value}});
    };
    add("steps", static_cast<double>(run.curve.a.size()) - 1);
    add("factorisations", static_cast<double>(run.counts.factorisations));
    add("iterations", static_cast<double>(run.counts.iterations));
    add("evaluations", static_cast<double>(run.counts.evaluations));
}

}  // namespace

const char* name(ToleranceClass kind) {
    constexpr std::array names{"same-build", "cross-build", "physical"};
    return names.at(static_cast<std::size_t>(kind));
}

double Offence::share() const {
    return tolerance > 0 ? (of_limit ? 1 : 0) + std::abs(difference()) / tolerance
                         : std::numeric_limits<double>::infinity();
}

double Offence::noticed() const {
    if (of_limit) return share();
    return noticeable > 0 ? std::abs(difference()) / noticeable
                          : std::numeric_limits<double>::infinity();
}

bool comes_before(const Offence& a, const Offence& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.noticed() > b.noticed();
}

Grade GateVerdict::grade() const {
    if (!offences.empty()) return Grade::fail;
    return reasons.empty() && compared > 0 ? Grade::pass : Grade::not_judged;
}

Tolerances default_tolerances(ToleranceClass kind) {
    struct OfKey {
        const char* key;
        // same-build: the last digit of the file; cross-build: five times the worst of
        // tests/gate/README.md
        std::array<Allowance, tolerance_classes.size()> of_class;
    };
    static const std::array usual{
        OfKey{"mm", {{{2e-9, 0}, {5e-9, 0}, {0.01, 1e-3}}}},
        OfKey{"deg", {{{2e-9, 0}, {5e-9, 0}, {0.001, 1e-3}}}},
        OfKey{"N", {{{2e-9, 0}, {7e-8, 0}, {1, 1e-3}}}},
        OfKey{"N·m", {{{2e-9, 0}, {5e-9, 0}, {0.1, 1e-3}}}},
        // Ackermann: at 2 deg the cotangent of a steer angle changes by 1/sin² = 821 per rad, so that
        // 5e-9 deg change it by 7e-6 %, times l/j for each wheel
        OfKey{"%", {{{2e-9, 0}, {2e-5, 0}, {0.5, 1e-3}}}},
        OfKey{"count", {{{0, 0}, {1, 0.012}, {2, 0.5}}}},
        OfKey{"characteristic", {{{2e-9, 1e-12}, {1e-8, 1e-8}, {1e-3, 5e-3}}}},
        OfKey{"compliance", {{{2e-9, 1e-12}, {1e-8, 1e-8}, {1e-3, 5e-3}}}}};
    Tolerances tolerances;
    for (const auto& [key, of_class] : usual)
        tolerances[key] = of_class.at(static_cast<std::size_t>(kind));
    return tolerances;
}

std::vector<std::size_t> stations(const std::vector<double>& a) {
    std::vector<std::size_t> positions;
    const std::size_t last = a.empty() ? 0 : a.size() - 1, quarter = (last + 2) / 4;
    for (std::size_t k = 0; k < a.size(); ++k)
        if (a[k] == 0 || k == 0 || k == quarter || k == last / 2 || k == last - quarter ||
            k == last)
            positions.push_back(k);
    return positions;
}

Measurement measure(const Model& model, const Comparison& comparison) {
    Measurement result;
    result.scene = model.name;
    for (const auto& branch : comparison.branches) {
        for (const auto& reason : branch.inconclusive.texts())
            result.inconclusive.push_back(fmt::format("branch '{}': {}", branch.branch, reason));
        const LegRun& recursive = branch.run(Leg::recursive);
        const LegRun& equilibrium = branch.run(Leg::equilibrium);
        const LegRun& energy = branch.run(Leg::energy);

        // Range that both runs reached, around their start.
        const Curve &of_r = recursive.curve, &of_e = equilibrium.curve;
        const std::size_t before = std::min(of_r.start, of_e.start);
        const std::size_t points =
            before + std::min(of_r.a.size() - of_r.start, of_e.a.size() - of_e.start);
        GatedBranch kept{branch.branch, symbol(branch.unit), {}};
        std::vector<std::size_t> kept_points;
        const std::size_t count = std::min<std::size_t>(points, points_per_branch);
        for (std::size_t k = 0; k < count; ++k)
            kept_points.push_back(count == 1 ? 0
                                             : (k * (points - 1) + (count - 1) / 2) / (count - 1));
        if (before < points && !std::ranges::binary_search(kept_points, before))
            kept_points.insert(std::ranges::upper_bound(kept_points, before), before);
        for (const std::size_t k : kept_points)
            kept.a.push_back(rounded(of_e.a[of_e.start - before + k]));

        for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
            const auto& channel = comparison.channels[c];
            if (branch.determined[c] || is_swing_arm(channel))
                add_curves(branch, c, channel, kept, kept_points, result);
            if (!branch.determined[c] || channel.kind() == ChannelKind::characteristic) continue;
            for (const auto& [quantity, reading] :
                 {std::pair{Quantity::deviation_at_equal_parameter,
                            &branch.deviation.equal_parameter},
                  {Quantity::deviation_at_equal_abscissa, &branch.deviation.equal_abscissa}})
                if (c < reading->channels.size())
                    result.series.push_back({branch.branch,
                                             quantity,
                                             channel.name,
                                             symbol(channel.unit),
                                             {rounded(reading->channels[c].max)}});
        }
        add_counters(branch.branch, Quantity::work_recursive, recursive, result.series);
        add_counters(branch.branch, Quantity::work_equilibrium, equilibrium, result.series);
        add_counters(branch.branch, Quantity::work_energy, energy, result.series);
        result.branches.push_back(std::move(kept));
    }
    add_compliance(model, comparison, result.series);
    std::ranges::sort(result.series, {}, key);
    return result;
}

GateVerdict judge(const Baseline& baseline, const Measurement& measurement, ToleranceClass kind) {
    GateVerdict verdict;
    verdict.kind = kind;
    verdict.reasons = measurement.inconclusive;
    if (baseline.reason.find_first_not_of(" \t\r\n") == std::string::npos)
        verdict.reasons.push_back("the baseline gives no reason for its acceptance");
    if (baseline.accepted.scene != measurement.scene)
        verdict.reasons.push_back(fmt::format("the baseline is of scene '{}', this is '{}'",
                                              baseline.accepted.scene, measurement.scene));
    const auto common = common_branches(baseline, measurement, verdict);
    // A series of a branch that neither side lists is compared too, so that none
    // is skipped silently.
    const auto is_compared = [&](const std::string& branch) {
        return std::ranges::find(common, branch) != common.end() ||
               (find(baseline.accepted, branch) == nullptr && find(measurement, branch) == nullptr);
    };

    const auto tolerances = baseline.tolerances.find(kind);
    static const Tolerances none;
    for (const auto& was : baseline.accepted.series)
        if (is_compared(was.branch))
            judge_series(baseline,
                         tolerances == baseline.tolerances.end() ? none : tolerances->second, was,
                         measurement, verdict);
    for (const auto& is : measurement.series)
        if (is_compared(is.branch) &&
            find(baseline.accepted, is.branch, is.quantity, is.channel) == nullptr)
            verdict.reasons.push_back(described(is) + " is new: the baseline does not have it");
    for (const auto& limit : baseline.limits) judge_limit(limit, measurement, verdict);
    if (verdict.compared == 0) verdict.reasons.emplace_back("nothing was compared");

    std::ranges::stable_sort(verdict.offences, comes_before);
    return verdict;
}

std::vector<std::string> widened(const Baseline& baseline, ToleranceClass kind) {
    std::set<std::string> wider;
    const Tolerances usual = default_tolerances(kind);
    const auto own = baseline.tolerances.find(kind);
    if (own == baseline.tolerances.end()) return {};
    for (const auto& series : baseline.accepted.series) {
        const Allowance *is = tolerance_of(own->second, series), *was = tolerance_of(usual, series);
        if (is == nullptr || was == nullptr) continue;
        const auto entry = std::ranges::find_if(
            own->second, [&](const auto& key_and_value) { return &key_and_value.second == is; });
        if (!(is->atol <= was->atol))
            wider.insert(fmt::format("{}: atol {:g}", entry->first, is->atol));
        if (!(is->rtol <= was->rtol))
            wider.insert(fmt::format("{}: rtol {:g}", entry->first, is->rtol));
    }
    return {wider.begin(), wider.end()};
}

}  // namespace elastocheck::compare
