// Numbers of a scene with which figures stay within bands, at the least cost.
//
//   x = (p - p_0) / (high - low)      c = ± (f_j - bound) / g ≤ 0
//
//   minimise  F = |x|² / 2  (the smallest change)  or  f_k / g   over  c ≤ 0,  low ≤ p ≤ high
//
// f_j are the figures, p the numbers, p_0 their start. g of a goal is the largest |∂f_j/∂x| of its
// figures at the start; c has one entry for each bound of a figure. From each start solve_for()
// goes to numbers within the bands, or to the nearest ones if there are none. If F is not at its
// minimum there, SLSQP of NLopt minimises it from there. Its status is no evidence: a result counts
// by its excess over the bands and by the conditions of Karush, Kuhn and Tucker,
//
//   ∇F + Σ λ_i ∇c_i = 0,   λ_i ≥ 0,   over the active bands and limits of numbers
//
// whose λ, by bounded least squares, are the prices of the bounds: dF = -λ_i / g per unit by which
// a band is relaxed.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compare/design/solve_for.hpp"
#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

struct Goals {
    Eigen::VectorXd low, high;  // band of each figure, in its unit; infinite: no bound
    std::vector<int> goal;      // goal 0, 1, ... of each figure; figures of one curve have one goal
    // Position of the minimised figure, alone in its goal; -1: the change of the numbers is minimised.
    int minimised = -1;
};

// Points to search from: the start, and `count - 1` within the limits, the same on every run.
std::vector<Eigen::VectorXd> starts_of(const SearchRange& range, int count);

// One side of a band of a figure, or of the range of a number.
struct Bound {
    bool of_number = false;  // true: bound of a number; false: bound of a figure
    Eigen::Index index = 0;  // position of the number or figure
    bool upper = false;
    double bound = 0;  // value, in the unit of the number or figure
    // λ_i / g: decrease of the cost per unit by which the bound is relaxed, to first order; the
    // ranges that scale the change x stay the same
    double price = 0;
};

// Result of the search from one start.
struct Search {
    Solution nearest = {};   // numbers at the least distance from the bands
    Eigen::VectorXd p = {};  // numbers at the end
    bool has_value = false;  // the figures have values at the start of the search
    // No figure is outside of its band by more than `within_bands` g.
    bool met = false;
    bool converged = false;  // the conditions of the optimum, or of the nearest numbers, hold
    double excess = 0;       // largest excess over a band, as a share of g; negative within all
    double cost = 0;         // |x|, or the minimised figure in its unit
    double optimality = 0;   // |∇F + Σ λ ∇c| / |∇F|
    std::vector<Bound> active = {};  // bounds that hold at the end
    int evaluations = 0;             // number of solutions of the scene
};
inline constexpr double within_bands = 1e-9;

// The best of the searches, and what they have in common.
struct Optimum : Search {
    SearchStart start = {};
    std::vector<bool> still = {};   // for each goal: no number changes its figures at the start
    Eigen::VectorXd scale = {};     // g of each figure, in its unit
    Eigen::VectorXd after = {};     // figures at p
    Eigen::VectorXd conflict = {};  // share of each figure; zero if the bands are met
    std::vector<Search> searches = {};
    int best =
        -1;  // position of the best search; -1: none, as no number changes a goal that counts
};

// Called with all numbers at which figures are found that are better than all before: within the bands
// at less cost, or nearer to them than at the start.
using BestSoFar = std::function<void(const Eigen::VectorXd& p, bool met)>;

// Searches from each start. Only `start` of the result is set if figures or rates are missing there. The
// figures of still goals are left out of the search; the caller refuses those that are outside of their bands,
// and a minimised figure that is still.
Optimum optimise(const Figures& figures, const Goals& goals, const SearchRange& range,
                 const std::vector<Eigen::VectorXd>& starts, const Progress& progress = {},
                 const BestSoFar& best_so_far = {});

}  // namespace elastocheck::compare
