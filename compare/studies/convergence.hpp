// Step-size convergence of one output: behaviour, observed order, limit and its uncertainty.
//
// The limit is the method's own limit (Richardson extrapolation). Its error is limit minus
// reference. The behaviour is classified first; only a converging sequence gets an order.
#pragma once

#include <limits>
#include <span>

namespace elastocheck::compare {

// With d_k = v_k+1 - v_k the differences of successive levels; the first condition that
// holds, from below.
enum class Behaviour {
    converging,  // the last d_k have one sign and |d_k+1| < |d_k|: p > 0 in v = limit + C·h^p
    oscillating,  // d_k still changes its sign within the three finest levels (four, if often before)
    diverging,    // |d_k+1| ≥ |d_k| at the finest levels, or the fitted p ≤ 0
    reference_floor,  // max v - min v ≤ the reference's uncertainty
    round_off_floor,  // fewer than three levels with |d_k| above round-off
    too_few_levels,   // fewer than three
    not_finite,       // !isfinite(v_k) for some k
};
const char* name(Behaviour behaviour);  // "converging", "at the round-off floor", ...

struct Level {
    double steps = 0;  // h = 1 / steps
    double value = 0;  // value of one output with that many steps
};

// Differences up to these values are not significant. A few units in the last place of the largest
// value always count as round-off; zero or NaN adds nothing to that. A reference of zero or NaN
// means no reference.
struct Floors {
    double round_off = 0;
    double reference = 0;
};

// NaN where a number does not exist. A limit exists when converging and at either floor.
struct StepConvergence {
    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Behaviour behaviour = Behaviour::too_few_levels;
    double order = nan;  // p of value = limit + C·h^p, converging only; 10 reads "10 or more"
    // its standard error from the scatter; NaN with three levels and at order 10
    double order_error = nan;
    double limit = nan;         // value at h = 0
    double band = nan;          // half-width of the limit's uncertainty
    double finest_error = nan;  // estimate of |value of the finest level - limit|
    int first = 0, count = 0;   // window of levels used
    bool as_formal = false;     // the order agrees with the formal order
};

// Pre: steps strictly increasing, in any ratio, else std::invalid_argument. Formal order:
// NaN if unknown.
StepConvergence step_convergence(std::span<const Level> levels, double formal_order,
                                 const Floors& floors);

// Order p of errors against a known truth, |error| = C·steps^-p: slope of a straight line through
// the logarithms. The order is negative when the errors grow. NaN with fewer than two errors above
// the floor; its standard error is NaN with fewer than three.
struct OrderFit {
    double order = std::numeric_limits<double>::quiet_NaN();
    double order_error = std::numeric_limits<double>::quiet_NaN();
    int first = 0, count = 0;  // window used: the finest run of errors above the floor
};
OrderFit order_of(std::span<const Level> errors, double floor);

// The same without coarse levels that are not yet asymptotic: each excluded level at least halves
// the scatter about the straight line, and four levels remain.
OrderFit asymptotic_order_of(std::span<const Level> errors, double floor);

// Whether an observed order agrees with the formal one: within a tenth or two standard errors, at
// most a quarter of an order. False for a formal order of NaN.
bool agrees_with_formal(double order, double order_error, double formal_order);

}  // namespace elastocheck::compare
