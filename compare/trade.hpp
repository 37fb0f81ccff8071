// The price of accuracy: what each method's error costs, and the cheapest one that is good enough.
//
// Every configuration (a method with a step count or a tolerance of its own, or a reference leg) produces the
// same output points: `points` equal increments of the parameter of every branch. Its error is the worst over
// all branches, output points and main channels, at equal parameter, from the equilibrium leg. Its price is
// counted, in the work of one back-substitution. With N = 6nb + m unknowns, dense, that takes 2N² operations
// and a factorisation 2N³/3, and an evaluation of the residuals is counted as one:
//
//   price = N/3 · factorisations + solves + evaluations
//
// It is the same in every run, so what is recommended is; time relative to the equilibrium leg, measured
// interleaved (timing.hpp), is shown beside it.
//
// What can be said ends at the reference uncertainty u, the distance of the two reference legs: an error e is
// at most e + u, and errors up to u cannot be told apart, hence not ranked.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/compare.hpp"
#include "models/equilibrium_path.hpp"
#include "models/model.hpp"
#include "recursive/method.hpp"

namespace elastocheck::compare {

// Infinite: not asked for.
struct Tolerance {
    double mm = std::numeric_limits<double>::infinity();
    double deg = std::numeric_limits<double>::infinity();
    // Of forces and moments, where somebody judges these.
    double newton = std::numeric_limits<double>::infinity();
    double newton_metre = std::numeric_limits<double>::infinity();
};

// "0.01mm,0.001deg": a length, an angle or both, in any order; where forces are judged as well a force (N) and a moment
// (Nm). Throws std::invalid_argument that says what is allowed.
enum class Asks { motion, forces_too };
Tolerance parse_tolerance(std::string_view text, Asks asks = Asks::motion);

// max(mm / tolerance, deg / tolerance): up to 1 is good enough. NaN if either is.
double share_of(const Tolerance& tolerance, const Accuracy& error);

struct Work {
    long solves = 0;  // back-substitutions
    long factorisations = 0;
    long evaluations = 0;                                       // of the residual, or of energy and gradient
    double price = 0;                                           // in back-substitutions, see above
    double seconds = std::numeric_limits<double>::quiet_NaN();  // median over the rounds
};

struct TradePoint {
    Leg leg = Leg::recursive;
    std::string method = {};               // of the recursion, else the name of the leg
    int steps = 0;                         // per branch; 0 where the method chooses
    double own_tolerance = 0;              // where it chooses: the tolerance it is told [m]; else 0
    bool again = false;                    // the A/A row: the equilibrium leg, timed a second time
    Outcome outcome = Outcome::converged;  // the first that is not converged, of any branch
    std::string detail = {};
    Work work = {};                                           // over all branches
    double ratio = std::numeric_limits<double>::quiet_NaN();  // of time, to the equilibrium leg
    Accuracy error = {};                                      // NaN unless converged
    double share = 0;                                         // of the tolerance that the error takes
    bool ranked = false;
    std::string not_ranked = {};  // why, empty when ranked
    // No other ranked point is as good for less: solves; factorisations + evaluations; time.
    std::array<bool, 3> on_front{};
};

// The cheapest by price, of equals the loosest: it is told no more than is asked for, everything finer of the
// same method is good enough too, and the whole band lies within the tolerance.
struct Recommendation {
    std::size_t point = 0;  // position in Trade::points
    // Band: how far the law error = C·steps^-p of the ladder misses this rung, what the confirming run found,
    // the uncertainty.
    Accuracy expected, low, high;
    std::string band_from;      // which rungs it rests on, in words
    Accuracy confirmed;         // error found when it was run again
    int confirmed_numbers = 0;  // compared then
};

struct TradeOptions {
    Tolerance tolerance{0.01, 0.001};
    std::vector<std::string> methods = {};  // of the recursion; empty: all
    int points = 10;  // output points per branch, beside a = 0; the ladder starts with as many steps
    int most_steps = 2560;
    double work_budget = 5e8;  // of one configuration: steps · branches · (unknowns)³
    int rounds = 7;            // of timing; 0: no times
    std::function<void(std::string_view)> progress = {};
};

struct Trade {
    Tolerance tolerance;  // angles are not asked for where there are none
    int points_per_branch = 0;
    int rounds = 0;
    bool angles = false;
    Accuracy uncertainty;  // NaN when a reference failed
    double noise = 0;      // of time ratios, from the A/A row
    std::vector<TradePoint> points;
    std::optional<Recommendation> recommendation;
    std::vector<std::string> rejected;      // cheaper, but the confirming run or its band said no
    std::vector<std::string> inconclusive;  // why nothing can be judged
};

Trade trade(const Model& model, const TradeOptions& options = {});

// How a configuration walks that records `points` equal increments of the parameter, a divisor of its steps.
Gait gait_of(const TradePoint& point, int points);

// "tangent, 40 steps", "adaptive at 1e-05 m", "equilibrium leg"
std::string describe(const TradePoint& point);

// Which points are on the front of work against error: no other is as good in both and better in one. Equals
// stand together. What is not finite is neither on it nor in the way of others.
struct WorkError {
    double work = 0, error = 0;
};
std::vector<bool> pareto_front(std::span<const WorkError> points);

}  // namespace elastocheck::compare
