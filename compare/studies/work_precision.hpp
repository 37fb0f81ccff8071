// Work-precision comparison: error and cost of every method, and the cheapest one that
// meets a tolerance.
//
// Every configuration (a method with a step count or a tolerance of its own, or a reference leg)
// produces the same output points: `points` equal increments of the parameter of every branch. Its
// error is the worst over all branches, output points and main channels, at equal parameter,
// relative to the equilibrium leg. A recommended configuration must also have every joint force and
// moment within its tolerance. The price is the counted work, in units of one back-substitution.
// With N = 6nb + m unknowns, dense, a back-substitution takes 2N² operations, a factorisation
// 2N³/3, and an evaluation of the residuals is counted as one back-substitution:
//
//   price = N/3 · factorisations + solves + evaluations
//
// The price is reproducible, and so is the recommendation. Time relative to the equilibrium leg,
// measured interleaved (timing.hpp), is shown beside it.
//
// The accuracy of the comparison is limited by the reference uncertainty u, the distance of the
// two reference legs: an error e is at most e + u, and errors up to u are indistinguishable,
// hence not ranked.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/deviation/deviation.hpp"
#include "compare/deviation/tolerance.hpp"
#include "elastocheck/compare.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/recursive_method.hpp"

namespace elastocheck::compare {

// Largest ratio of an error in mm or deg to its tolerance: up to 1 it is met. NaN if either error is.
double share_of(const Tolerance& tolerance, const Accuracy& error);

struct Work {
    long solves = 0;  // back-substitutions
    long factorisations = 0;
    long evaluations = 0;  // evaluations of the residuals, or of energy and gradient
    double price = 0;      // in back-substitutions, as above
    double seconds = std::numeric_limits<double>::quiet_NaN();  // median over the rounds
};

struct TradePoint {
    Leg leg = Leg::recursive;
    std::string method = {};               // method of the recursion; else the name of the leg
    int steps = 0;                         // per branch; 0 for an adaptive method
    double own_tolerance = 0;              // tolerance of an adaptive method [m]; else 0
    bool again = false;                    // the A/A row: the equilibrium leg timed a second time
    Outcome outcome = Outcome::converged;  // first outcome of any branch that is not converged
    std::string detail = {};
    Work work = {};  // sum over all branches
    // Time relative to the equilibrium leg.
    double ratio = std::numeric_limits<double>::quiet_NaN();
    Accuracy error = {};  // NaN unless converged
    double share = 0;     // ratio of the error to the tolerance
    bool ranked = false;
    std::string not_ranked = {};  // reason why the point is not ranked; empty if it is
    // Pareto fronts: no other ranked point is as accurate for less work, in solves;
    // factorisations + evaluations; time.
    std::array<bool, 3> on_front{};
};

// The cheapest configuration by price; among equals the one with the loosest tolerance. Its own
// tolerance is at most the required one, every finer configuration of the same method meets the
// tolerance too, and its whole error band lies within the tolerance.
struct Recommendation {
    std::size_t point = 0;  // position in Trade::points
    // Band: from the misfit of the law error = C·steps^-p at this rung of the ladder, the error of
    // the confirming run, and the uncertainty.
    Accuracy expected, low, high;
    std::string band_from;      // rungs that the band is based on, as text
    Accuracy confirmed;         // error of the confirming run
    int confirmed_numbers = 0;  // numbers compared in the confirming run
};

struct TradeOptions {
    Tolerance tolerance = default_tolerance;
    std::vector<std::string> methods = {};  // of the recursion; empty: all
    int points = 10;  // output points per branch besides a = 0; also the smallest step count
    int max_steps = 2560;
    double work_budget = 5e8;  // limit for one configuration: steps · branches · (unknowns)³
    int rounds = 7;            // timing rounds; 0: no times
    int threads = 1;
    Progress progress = {};
};

struct Trade {
    Tolerance tolerance;  // without angles if the scene has none
    int points_per_branch = 0;
    int rounds = 0;
    bool angles = false;
    Accuracy uncertainty;  // NaN when a reference failed
    double noise = 0;      // noise of time ratios, from the A/A row
    std::vector<TradePoint> points;
    std::optional<Recommendation> recommendation;
    // cheaper configurations that failed the confirming run or whose band exceeds the tolerance
    std::vector<std::string> rejected;
    std::vector<std::string> inconclusive;  // reasons why nothing can be judged
};

Trade trade(const Model& model, const TradeOptions& options = {});
// The same comparison from shared solves, whose base is `points`.
struct Solves;
Trade trade(Solves& solves, const TradeOptions& options);

struct Result;
Result result_of(const Model& model, const Trade& trade);

// Error of a configuration point by point along a branch, at equal parameter, from the equilibrium
// leg: at the finest points of the solves, or at every step of the configuration if that is coarser.
Profile profile(Solves& solves, std::size_t branch, const TradePoint& configuration);

// "tangent, 40 steps", "adaptive at 1e-02 mm", "equilibrium leg"
std::string describe(const TradePoint& point);

// Pareto front of work against error: no other point is as good in both and better in one.
// Equal points are all on the front. Points that are not finite are neither on it nor do
// they exclude others.
struct WorkError {
    double work = 0, error = 0;
};
std::vector<bool> pareto_front(std::span<const WorkError> points);

}  // namespace elastocheck::compare
