// Step-size convergence of one output: how it behaves, at what order, towards which limit, and how surely.
//
// The limit is the method's own one (Richardson). Whether it is the truth is another question, answered by
// limit minus reference. Behaviour is judged first; only a converging sequence gets an order.
#pragma once

#include <limits>
#include <span>

namespace elastocheck::compare {

enum class Behaviour {
    converging,       // differences fall with refinement, at the finest levels all in one direction
    oscillating,      // they still change sign at the finest levels
    diverging,        // they grow with refinement
    round_off_floor,  // they mean nothing: too few of them are above round-off for an order
    reference_floor,  // all levels lie within the reference's uncertainty: refinement has nothing to show
    not_finite,       // a NaN or infinity somewhere
    too_few_levels,   // fewer than three
};
const char* name(Behaviour behaviour);  // "converging", "at the round-off floor", ...

struct Level {
    double steps = 0;  // h = 1 / steps
    double value = 0;  // of one output with that many steps
};

// Differences up to these mean nothing. A few units in the last place of the largest value always count as
// round-off; zero or NaN adds nothing to that, and means that there is no reference.
struct Floors {
    double round_off = 0;
    double reference = 0;
};

// NaN where there is no such number. A limit exists when converging and at either floor.
struct StepConvergence {
    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Behaviour behaviour = Behaviour::too_few_levels;
    double order = nan;         // p of value = limit + C·h^p, converging only; 10 reads "10 or more"
    double order_error = nan;   // its standard error from the scatter; NaN with three levels and at order 10
    double limit = nan;         // value at h = 0
    double band = nan;          // half-width of the limit's uncertainty
    double finest_error = nan;  // estimate of |value of the finest level - limit|
    int first = 0, count = 0;   // window of levels this rests on
    bool as_formal = false;     // the order agrees with the formal one
};

// Levels: strictly increasing steps in any ratio, else std::invalid_argument. Formal order: NaN if unknown.
StepConvergence step_convergence(std::span<const Level> levels, double formal_order, const Floors& floors);

// Steps for a step error of this size (> 0) by the fitted law; not rounded, at least 1; else NaN.
double steps_for(const StepConvergence& convergence, std::span<const Level> levels, double error);

// Order p of errors against a known truth, |error| = C·steps^-p: slope of a straight line through the
// logarithms. It keeps its sign: negative when the errors grow. NaN with fewer than two errors above the
// floor, its standard error with fewer than three.
struct OrderFit {
    double order = std::numeric_limits<double>::quiet_NaN();
    double order_error = std::numeric_limits<double>::quiet_NaN();
    int first = 0, count = 0;  // window used: the finest run of errors above the floor
};
OrderFit order_of(std::span<const Level> errors, double floor);

}  // namespace elastocheck::compare
