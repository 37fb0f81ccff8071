#include "compare/studies/convergence.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

using Levels = std::span<const Level>;

void check_steps(Levels levels) {
    for (std::size_t k = 0; k < levels.size(); ++k)
        if (levels[k].steps <= 0 || (k > 0 && levels[k].steps <= levels[k - 1].steps))
            throw std::invalid_argument("step counts must be positive and strictly increasing");
}

bool all_finite(Levels levels) {
    return std::all_of(levels.begin(), levels.end(), [](const Level& level) {
        return std::isfinite(level.steps) && std::isfinite(level.value);
    });
}

double spread(Levels levels) {
    const auto [low, high] =
        std::minmax_element(levels.begin(), levels.end(),
                            [](const Level& a, const Level& b) { return a.value < b.value; });
    return high->value - low->value;
}

// ---- Fit
//
// With x = h / h_finest >= 1 and l = ln x the law value = L + C h^p is written
//
//     value = a + b φ,   φ = (x^p - 1) / p,   L = a - b/p,   C x^p = (b/p) x^p,
//
// which is regular at p = 0 (φ = l: logarithmic drift) and continues to p < 0 (divergence), so the
// order keeps its sign. For given p the fit is linear (variable projection), so only p is searched:
//
//     R(p) = Σ r²,   r = value - a - b φ,     dR/dp = -2 b Σ r ψ,   ψ = ∂φ/∂p = (l x^p - φ) / p,
//
// because Σ r = Σ r φ = 0. With ψ⊥ the part of ψ orthogonal to 1 and φ, the standard error of p is
// σ / (|b| |ψ⊥|). That of L: at given p, the one of a straight line at φ = -1/p, plus the part of p
// through dL/dp.
struct Line {
    double limit = 0, C = 0;                    // C: error of the finest level
    double R = 0, slope = 0;                    // slope: ½ dR/dp
    double p_variance = 0, limit_variance = 0;  // for σ = 1; limit_variance at given p
};

// φ less its mean, and ψ⊥ (`psi`), at one p; they depend only on the steps.
struct Shape {
    double p = 0, phi_mean = 0, phi_phi = 0;
    std::vector<double> phi, psi;
};

double dot(std::span<const double> a, std::span<const double> b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}
// Subtracts the mean of x from it and returns it.
double subtract_mean(std::vector<double>& x) {
    const double average = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    for (double& value : x) value -= average;
    return average;
}

std::vector<double> logarithms(Levels levels) {
    std::vector<double> l;
    for (const Level& level : levels) l.push_back(std::log(levels.back().steps / level.steps));
    return l;
}

void shape(const std::vector<double>& l, double p, Shape& result) {
    result.p = p;
    result.phi.resize(l.size());
    result.psi.resize(l.size());
    for (std::size_t k = 0; k < l.size(); ++k) {
        result.phi[k] = std::abs(p) < 1e-9 ? l[k] : std::expm1(p * l[k]) / p;
        result.psi[k] = std::abs(p) < 1e-4 ? l[k] * l[k] * (0.5 + p * l[k] / 3)
                                           : (l[k] * std::exp(p * l[k]) - result.phi[k]) / p;
    }
    result.phi_mean = subtract_mean(result.phi);
    result.phi_phi = dot(result.phi, result.phi);
    (void)subtract_mean(result.psi);
    const double along = dot(result.psi, result.phi) / result.phi_phi;
    for (std::size_t k = 0; k < l.size(); ++k) result.psi[k] -= along * result.phi[k];
}

// Values without their mean.
struct Values {
    std::vector<double> v, r;  // r: residuals of the last line
    double mean = 0;
};
Values values_of(Levels levels) {
    Values values;
    for (const Level& level : levels) values.v.push_back(level.value);
    values.mean = subtract_mean(values.v);
    values.r = values.v;
    return values;
}

Line line(const Shape& shape_at_p, Values& values) {
    const double b = dot(values.v, shape_at_p.phi) / shape_at_p.phi_phi, p = shape_at_p.p;
    for (std::size_t k = 0; k < values.v.size(); ++k)
        values.r[k] = values.v[k] - b * shape_at_p.phi[k];
    return {.limit = values.mean - b * (shape_at_p.phi_mean + 1 / p),
            .C = b / p,
            .R = dot(values.r, values.r),
            .slope = -b * dot(values.r, shape_at_p.psi),
            .p_variance = 1 / (b * b * dot(shape_at_p.psi, shape_at_p.psi)),
            .limit_variance = 1 / static_cast<double>(values.v.size()) +
                              std::pow(shape_at_p.phi_mean + 1 / p, 2) / shape_at_p.phi_phi};
}

struct Fit {
    double p = nan, limit = nan, C = nan;                  // C: error of the finest level
    double sigma = nan, p_error = nan, limit_error = nan;  // standard errors; NaN with three levels
};
constexpr double lowest = -2, highest = 10;

// Orders between which the best one is searched.
constexpr int cells = 240;
double grid(int k) { return lowest + (highest - lowest) * k / cells; }

// The shapes at all orders of the grid, kept for the last 64 sets of steps: a study fits thousands
// of values with the same steps.
const std::vector<Shape>& shapes(const std::vector<double>& l) {
    struct KnownShapes {
        std::vector<double> l;
        std::vector<Shape> shapes;
    };
    constexpr std::size_t max_known = 64;
    thread_local std::deque<KnownShapes> cache;
    for (const KnownShapes& known : cache)
        if (known.l == l) return known.shapes;
    if (cache.size() == max_known) cache.pop_front();
    KnownShapes& added = cache.emplace_back(KnownShapes{l, std::vector<Shape>(cells + 1)});
    for (int k = 0; k <= cells; ++k) shape(l, grid(k), added.shapes[static_cast<std::size_t>(k)]);
    return added.shapes;
}

// Zero of a function that is negative below it and positive above; without one, the end nearer to it.
// Regula falsi with halved values at an end that stays (Illinois).
double zero_of(const auto& f, double low, double high) {
    double at_low = f(low), at_high = f(high);
    if (!(at_low < 0)) return low;
    if (at_high < 0) return high;
    double x = low;
    for (int side = 0, round = 0; round < 100; ++round) {
        const double before = x;
        x = high - at_high * (high - low) / (at_high - at_low);
        if (!(x > low && x < high)) x = (low + high) / 2;
        if (std::abs(x - before) <= std::numeric_limits<double>::epsilon() * std::abs(x)) break;
        const double at_x = f(x);
        if (at_x < 0) {
            low = x;
            at_low = at_x;
            if (side < 0) at_high /= 2;
            side = -1;
        } else {
            high = x;
            at_high = at_x;
            if (side > 0) at_low /= 2;
            side = 1;
        }
    }
    return x;
}

Fit fit(Levels levels) {
    const std::vector<double> l = logarithms(levels);
    Values values = values_of(levels);
    const auto& on_grid = shapes(l);
    int best_cell = 0;
    double least_R = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= cells; ++k)
        if (const double R = line(on_grid[static_cast<std::size_t>(k)], values).R; R < least_R) {
            best_cell = k;
            least_R = R;
        }
    Shape shape_at;
    const auto line_at = [&](double p) {
        shape(l, p, shape_at);
        return line(shape_at, values);
    };
    Fit result;
    result.p = zero_of([&](double p) { return line_at(p).slope; }, grid(std::max(best_cell - 1, 0)),
                       grid(std::min(best_cell + 1, cells)));
    const Line best_line = line_at(result.p);
    result.limit = best_line.limit;
    result.C = best_line.C;
    if (levels.size() < 4) return result;
    result.sigma = std::sqrt(best_line.R / static_cast<double>(levels.size() - 3));
    result.p_error = result.sigma * std::sqrt(best_line.p_variance);
    const double delta = 1e-3 * result.p;
    const double dL_dp =
        (line_at(result.p + delta).limit - line_at(result.p - delta).limit) / (2 * delta);
    result.limit_error =
        std::hypot(result.sigma * std::sqrt(best_line.limit_variance), dL_dp * result.p_error);
    return result;
}

// ---- Behaviour and window

// Whether the difference per unit of ln h grows from levels k, k+1 to k+1, k+2 by more than the floor
// explains. Under a law L + C h^p it falls exactly if p > 0, whatever the ratios of the steps.
bool grows(Levels levels, std::size_t k, double floor) {
    const auto difference = [&](std::size_t j) {
        return std::abs(levels[j + 1].value - levels[j].value);
    };
    const auto stretch = [&](std::size_t j) {
        return std::log(levels[j + 1].steps / levels[j].steps);
    };
    return (difference(k + 1) - floor) / stretch(k + 1) > (difference(k) + floor) / stretch(k);
}

// First level of the monotonic stretch that ends at the finest level, and the number of turns
// before it.
struct Monotone {
    std::size_t first = 0;
    int turns = 0;
};

Monotone monotone_end(Levels levels, double floor) {
    Monotone result;
    double last = 0;
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
        const double difference = levels[k + 1].value - levels[k].value;
        if (std::abs(difference) <= floor) continue;
        if (last * difference < 0) result = {k, result.turns + 1};
        last = std::copysign(1.0, difference);
    }
    return result;
}

// Excludes coarse levels that are not yet asymptotic, as long as each excluded level at least
// halves the scatter about the law, four levels remain (three always fit) and the floor does not
// explain the scatter.
std::size_t asymptotic_start(Levels levels, double floor) {
    if (levels.size() <= 4) return 0;
    std::size_t first = 0;
    double least = fit(levels).sigma;
    for (std::size_t k = 1; k + 4 <= levels.size() && least > floor / 2; ++k) {
        const double sigma = fit(levels.subspan(k)).sigma;
        if (sigma <= std::ldexp(least, static_cast<int>(first) - static_cast<int>(k))) {
            first = k;
            least = sigma;
        }
    }
    return first;
}

StepConvergence at_floor(Behaviour behaviour, Levels levels, std::size_t first, double floor) {
    const double error = std::max(floor, spread(levels.subspan(first)));
    return {.behaviour = behaviour,
            .limit = levels.back().value,
            .band = error,
            .finest_error = error,
            .first = static_cast<int>(first),
            .count = static_cast<int>(levels.size() - first)};
}

}  // namespace

const char* name(Behaviour behaviour) {
    switch (behaviour) {
        case Behaviour::converging: return "converging";
        case Behaviour::oscillating: return "oscillating";
        case Behaviour::diverging: return "diverging";
        case Behaviour::round_off_floor: return "at the round-off floor";
        case Behaviour::reference_floor: return "at the reference floor";
        case Behaviour::not_finite: return "not finite";
        case Behaviour::too_few_levels: return "too few levels";
    }
    return "?";
}

StepConvergence step_convergence(Levels levels, double formal_order, const Floors& floors) {
    if (!all_finite(levels)) return {.behaviour = Behaviour::not_finite};
    check_steps(levels);
    if (levels.size() < 3) return {.behaviour = Behaviour::too_few_levels};

    double largest = 0;
    for (const Level& level : levels) largest = std::max(largest, std::abs(level.value));
    const double floor =
        std::max(4 * std::numeric_limits<double>::epsilon() * largest, floors.round_off);

    // Excludes the finest levels while they differ by round-off only. Three such levels give a
    // limit, even if the levels before do not converge.
    std::size_t used = levels.size();
    while (used > 1 && std::abs(levels[used - 1].value - levels[used - 2].value) <= floor) --used;
    const auto at_round_off = [&] {
        return at_floor(Behaviour::round_off_floor, levels, used - 1, floor);
    };
    const auto without_order = [&](Behaviour behaviour) {
        return levels.size() - used >= 2 ? at_round_off() : StepConvergence{.behaviour = behaviour};
    };
    if (used < 3) return at_round_off();
    if (spread(levels) <= floors.reference)
        return at_floor(Behaviour::reference_floor, levels, 0, floors.reference);

    // One turn is common where coarse errors cancel; after several turns a longer monotonic stretch
    // is required.
    const auto [turn, turns] = monotone_end(levels.first(used), floor);
    if (used - turn < (turns > 1 ? 4u : 3u)) return without_order(Behaviour::oscillating);
    std::size_t first = turn;
    while (used - first > 3 && grows(levels, first, floor)) ++first;
    if (grows(levels, used - 3, floor)) return without_order(Behaviour::diverging);
    first += asymptotic_start(levels.subspan(first, used - first), floor);
    const Fit law = fit(levels.subspan(first, used - first));
    if (!(law.p > 0)) return without_order(Behaviour::diverging);

    StepConvergence result;
    result.behaviour = Behaviour::converging;
    result.order = law.p;
    result.order_error = law.p < highest - 1e-6 ? law.p_error : nan;
    result.first = static_cast<int>(first);
    result.count = static_cast<int>(used - first);

    result.as_formal = agrees_with_formal(law.p, result.order_error, formal_order);

    // Error of the law at the finest level. The finest value may lie on the fitted limit by chance,
    // so the larger of both counts. Where levels lie at round-off, the finest value is the limit,
    // better than an extrapolation.
    const bool extrapolated = used == levels.size();
    const double law_error =
        std::abs(law.C) * std::pow(levels[used - 1].steps / levels.back().steps, law.p);
    result.limit = extrapolated ? law.limit : levels.back().value;
    result.finest_error =
        std::max({law_error, std::abs(levels.back().value - result.limit), floor});

    // Band: the grid convergence index (Roache 1994), and the scatter about the law. An order above
    // the formal one may mean that higher-order terms still dominate the leading one; then the
    // finest three levels are also evaluated at the formal order.
    const double safety = result.as_formal && result.count >= 4 ? 1.25 : 3;
    const double scatter = std::isfinite(law.limit_error) ? 2 * law.limit_error : 0;
    double hidden = 0;
    if (law.p > formal_order && !result.as_formal && extrapolated)
        hidden = spread(levels.subspan(used - 3, 3)) /
                 (std::pow(levels[used - 1].steps / levels[used - 3].steps, formal_order) - 1);
    result.band = std::max({safety * result.finest_error, safety * hidden, scatter});
    return result;
}

bool agrees_with_formal(double order, double order_error, double formal_order) {
    const double two_errors = std::isfinite(order_error) ? 2 * order_error : 0;
    return std::abs(order - formal_order) <=
           std::min(0.25, std::max(0.1 * formal_order, two_errors));
}

namespace {

// Straight line through ln |error| over ln h: p is the slope, `scatter` the sum of squares about it.
struct Slope {
    double p = 0, scatter = 0, stretch = 0;
};
Slope slope_of(Levels errors) {
    std::vector<double> x, y;
    for (const Level& error : errors) {
        x.push_back(-std::log(error.steps));
        y.push_back(std::log(std::abs(error.value)));
    }
    (void)subtract_mean(x);
    (void)subtract_mean(y);
    const double stretch = dot(x, x), p = dot(x, y) / stretch;
    for (std::size_t k = 0; k < x.size(); ++k) y[k] -= p * x[k];
    return {p, dot(y, y), stretch};
}

}  // namespace

OrderFit order_of(Levels errors, double floor) {
    OrderFit result;
    if (!all_finite(errors)) return result;
    check_steps(errors);
    const auto above = [&](std::size_t k) { return std::abs(errors[k].value) > floor; };
    std::size_t end = errors.size();
    while (end > 0 && !above(end - 1)) --end;
    std::size_t first = end;
    while (first > 0 && above(first - 1)) --first;
    result.first = static_cast<int>(first);
    result.count = static_cast<int>(end - first);
    if (result.count < 2) return result;
    const Slope slope = slope_of(errors.subspan(first, end - first));
    result.order = slope.p;
    if (result.count > 2)
        result.order_error = std::sqrt(slope.scatter / (result.count - 2) / slope.stretch);
    return result;
}

OrderFit asymptotic_order_of(Levels errors, double floor) {
    OrderFit best = order_of(errors, floor);
    const auto end = static_cast<std::size_t>(best.first + best.count);
    const auto scatter = [&](const OrderFit& fit) {
        const auto first = static_cast<std::size_t>(fit.first);
        return std::sqrt(slope_of(errors.subspan(first, end - first)).scatter / (fit.count - 2));
    };
    for (auto first = static_cast<std::size_t>(best.first) + 1; first + 4 <= end; ++first) {
        OrderFit fit = order_of(errors.subspan(first), floor);
        fit.first = static_cast<int>(first);
        if (scatter(fit) <= std::ldexp(scatter(best), best.first - fit.first)) best = fit;
    }
    return best;
}

}  // namespace elastocheck::compare
