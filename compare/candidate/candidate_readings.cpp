// Readings of a candidate's points on a branch: at equal parameter and at equal abscissa.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/compliance.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/readings.hpp"

namespace elastocheck::compare {
namespace {

// Shares of the length of a branch: rounding of a unit conversion, and tolerance of a point at the end.
constexpr double conversion_rounding = 1e-14, end_tolerance = 1e-9;

// ---- The equilibrium leg at the points of the candidate.

// Outputs of the equilibrium leg (one of the solvers) at any loads [SI] of a branch. It reaches a load over the
// steps of the branch.
class Reference {
  public:
    Reference(const Model& model, const Branch& branch, int steps, std::vector<Channel> channels)
        : model_(model),
          sides_(sides_of(model, branch, steps)),
          sorted_(requested_parameters(sides_, 1)),
          channels_(std::move(channels)) {
        std::ranges::sort(sorted_);
    }

    // Outputs at a load given to visit(); null if the leg does not reach it.
    const std::vector<double>* at(double load) const {
        if (std::isnan(load)) return nullptr;
        const auto found = known_.find(load);
        return found == known_.end() ? nullptr : &found->second;
    }

    // Load at which the reference is evaluated for a given one: the load of a step equal to it up to
    // rounding, else itself within the branch, its end up to `end_tolerance` beyond, NaN farther away.
    double reference_load(double load) const {
        const double length = sorted_.back() - sorted_.front();
        const auto near = std::ranges::lower_bound(sorted_, load - conversion_rounding * length);
        if (near != sorted_.end() && *near - load <= conversion_rounding * length) return *near;
        for (const auto& side : sides_) {
            const double to = side.branch.to;
            if (load * to < 0) continue;
            if (std::abs(load) <= std::abs(to)) return load;
            if (std::abs(load) <= std::abs(to) * (1 + end_tolerance)) return to;
        }
        return nan;
    }

    // Solves the branch at these loads, each of reference_load(), and its steps before them; at() then has
    // the outputs. The last step may lie beyond the branch by its rounding.
    void visit(const std::vector<double>& loads) {
        Analyses analyses;
        for (const auto& side : sides_) {
            const double to = side.branch.to;
            std::vector<double> requested;
            for (const double load : loads)
                if (std::isfinite(load) && load * to >= 0 && at(load) == nullptr)
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
    std::vector<double> sorted_;  // loads of the steps, ascending
    std::vector<Channel> channels_;
    std::map<double, std::vector<double>> known_;
};

// ---- One reading of one branch.

// Compares candidate and reference column by column, at the places `x` that the candidate gives
// (parameter [unit] or abscissa; NaN: none) and at the loads [SI] where the reference is there; NaN
// beyond its range.
CandidateReading compare_columns(const PointsOnBranch& given, const std::vector<double>& x,
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
    for (std::size_t d = 0; d < given.defined.size(); ++d) {
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
        loads.push_back(reference.reference_load(given.points.a[k] / in_unit(branch.unit)));
    }
    reference.visit(loads);
    return compare_columns(given, x, loads, reference, branch);
}

// Loads [SI] at which the reference is at the places `x` of the abscissa, which is its last output,
// by the secant method; NaN where it is not.
std::vector<double> loads_at(const std::vector<double>& x, Reference& reference,
                             const BranchComparison& branch) {
    const Curve& truth = truth_of(branch);
    const auto t = truth.channel(static_cast<std::size_t>(branch.abscissa));
    const double length = std::abs(t.back() - t.front()), rounding = end_tolerance * length;
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
        loads[k] =
            reference.reference_load(per_unit * truth.a[i - 1] + (x[k] - t[i - 1]) * slope[k]);
    }
    constexpr int max_passes = 12;
    reference.visit(loads);
    bool improves = true;
    for (int pass = 0; pass < max_passes && improves; ++pass) {
        std::vector<double> next(x.size(), nan);
        for (std::size_t k = 0; k < x.size(); ++k) {
            const double difference = x[k] - travel(loads[k]);
            if (!(std::abs(difference) > 1e-13 * std::max(length, std::abs(x[k]))))
                continue;  // converged, or no load
            const double load = reference.reference_load(loads[k] + difference * slope[k]);
            if (load != loads[k]) next[k] = load;
        }
        reference.visit(next);
        improves = false;
        for (std::size_t k = 0; k < x.size(); ++k) {
            const double travel_before = travel(loads[k]), travel_next = travel(next[k]);
            if (!(std::abs(x[k] - travel_next) < std::abs(x[k] - travel_before))) continue;
            slope[k] = (next[k] - loads[k]) / (travel_next - travel_before);
            loads[k] = next[k];
            improves = true;
        }
    }
    // not solved: at a knot of a curve, or on a branch that ends early
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
    return compare_columns(given, x, loads_at(x, reference, branch), reference, branch);
}

}  // namespace

void add_readings(const Model& model, const Branch& branch, const BranchComparison& compared,
                  const std::vector<Channel>& channels, const PointsOnBranch& points,
                  CandidateBranch& given) {
    std::vector<Channel> outputs;
    for (const auto& column : points.columns) outputs.push_back(channels[column.channel]);
    outputs.insert(outputs.end(), points.defined.begin(), points.defined.end());
    if (compared.abscissa >= 0)
        outputs.push_back(channels[static_cast<std::size_t>(compared.abscissa)]);
    Reference reference(model, branch, compared.steps, std::move(outputs));
    given.equal_parameter = at_equal_parameter(points, reference, compared);
    given.equal_abscissa = at_equal_abscissa(points, channels, reference, compared);
}

}  // namespace elastocheck::compare
