#include "compare/design/optimise.hpp"

#include <fmt/format.h>
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "compare/design/least_squares.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double none = std::numeric_limits<double>::infinity();

constexpr int most_evaluations = 200;     // of one run of SLSQP
constexpr int most_runs = 4;              // each from the best point before
constexpr int calls_at_one_point = 20;    // the step of SLSQP has vanished: it would loop for ever
constexpr double least_step = 1e-12;      // of x
constexpr double active_within = 1e-6;    // of c
constexpr double optimal_within = 1e-4;   // of |∇F|
constexpr double least_residual = 1e-7;   // of the conditions of the optimum, where ∇F vanishes
constexpr double multiplier_pull = 1e-7;  // makes the multipliers of parallel ∇c unique

// The problem in x, with the last evaluated point, and the best point within the bands.
struct Problem {
    const Figures& figures;
    const Goals& goals;
    VectorXd range = {}, scale = {};
    // sides of the bands, c = per (f - bound): their figures, 1 / g or -1 / g, their bounds
    std::vector<Index> side = {};
    VectorXd per = {}, bound = {};
    Box box = {};

    VectorXd at = {}, f = {};
    VectorXd gradient_at = {};
    MatrixXd f_x = {};  // ∂f/∂x
    int evaluations = 0;

    VectorXd best = {};
    double least_cost = none;

    // of a run of SLSQP
    nlopt_opt run = nullptr;
    int repeats = 0;
    std::exception_ptr failed = {};

    VectorXd number_at(const VectorXd& x) const {
        return within({goals.least, goals.most}, goals.start + range.cwiseProduct(x));
    }
    double unit_of(const ActiveBound& one) const {
        return one.of_number ? range[one.which] : scale[one.which];
    }
    void add_side(Index figure, double sign, double value) {
        if (!std::isfinite(value)) return;
        side.push_back(figure);
        for (VectorXd* each : {&per, &bound}) each->conservativeResize(std::ssize(side));
        per[std::ssize(side) - 1] = sign / scale[figure], bound[std::ssize(side) - 1] = value;
    }
    double cost() const {
        return goals.minimised < 0 ? at.squaredNorm() / 2
                                   : f[goals.minimised] / scale[goals.minimised];
    }
    VectorXd cost_gradient() const {
        if (goals.minimised < 0) return at;
        return f_x.row(goals.minimised).transpose() / scale[goals.minimised];
    }
    VectorXd excess() const { return per.cwiseProduct(VectorXd(f(side)) - bound); }
    MatrixXd excess_gradient() const { return per.asDiagonal() * MatrixXd(f_x(side, Eigen::all)); }
    bool has_value() const { return excess().allFinite() && std::isfinite(cost()); }
    double largest_excess() const {
        const VectorXd c = excess();
        return c.size() == 0 ? -none : c.allFinite() ? c.maxCoeff() : none;
    }

    void move_to(const VectorXd& x) {
        if (at.size() > 0 && at == x) {
            if (++repeats >= calls_at_one_point && run) nlopt_force_stop(run);
            return;
        }
        at = x;
        repeats = 0;
        ++evaluations;
        f = figures.value(number_at(x));
        if (has_value() && largest_excess() <= within_bands && cost() < least_cost) {
            best = x;
            least_cost = cost();
        }
    }
    void differentiate() {
        if (gradient_at.size() > 0 && gradient_at == at) return;
        f_x = figures.gradient(number_at(at)).rate * range.asDiagonal();
        gradient_at = at;
    }
};

// Calls in the library of C, through which no exception may pass.
template <class Evaluate>
void guarded(Problem& problem, const Evaluate& evaluate) {
    try {
        evaluate();
    } catch (...) {
        problem.failed = std::current_exception();
        nlopt_force_stop(problem.run);
    }
}

double slsqp_cost(unsigned n, const double* x, double* gradient, void* data) {
    Problem& problem = *static_cast<Problem*>(data);
    double cost = HUGE_VAL;  // SLSQP then shortens its step
    guarded(problem, [&] {
        problem.move_to(Eigen::Map<const VectorXd>(x, n));
        if (problem.has_value()) cost = problem.cost();
        if (!gradient) return;
        problem.differentiate();
        Eigen::Map<VectorXd>(gradient, n) = problem.cost_gradient();
    });
    return cost;
}

void slsqp_excess(unsigned m, double* result, unsigned n, const double* x, double* gradient,
                  void* data) {
    Problem& problem = *static_cast<Problem*>(data);
    Eigen::Map<VectorXd> c(result, m);
    c.setZero();
    guarded(problem, [&] {
        problem.move_to(Eigen::Map<const VectorXd>(x, n));
        if (problem.has_value()) c = problem.excess();
        if (!gradient) return;
        problem.differentiate();
        // row-major [m × n] is column-major [n × m]
        Eigen::Map<MatrixXd>(gradient, n, m) = problem.excess_gradient().transpose();
    });
}

void run_slsqp(Problem& problem, VectorXd x) {
    const auto n = static_cast<unsigned>(x.size()), m = static_cast<unsigned>(problem.side.size());
    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> run(nlopt_create(NLOPT_LD_SLSQP, n),
                                                                nlopt_destroy);
    problem.run = run.get();
    problem.repeats = 0;
    nlopt_set_lower_bounds(run.get(), problem.box.low.data());
    nlopt_set_upper_bounds(run.get(), problem.box.high.data());
    nlopt_set_min_objective(run.get(), slsqp_cost, &problem);
    const std::vector<double> within(m, within_bands / 10);
    if (m > 0)
        nlopt_add_inequality_mconstraint(run.get(), m, slsqp_excess, &problem, within.data());
    nlopt_set_xtol_abs1(run.get(), least_step);
    nlopt_set_maxeval(run.get(), most_evaluations);
    double cost = 0;
    nlopt_optimize(run.get(), x.data(), &cost);
    problem.run = nullptr;
    if (problem.failed) std::rethrow_exception(problem.failed);
}

// The bounds that hold at the evaluated point with their prices, and what they leave of ∇F.
struct Conditions {
    std::vector<ActiveBound> active = {};
    double left = 0, size = 0;  // |∇F + Σ λ ∇c|, |∇F|
    bool fulfilled() const { return left <= optimal_within * size + least_residual; }
};
Conditions conditions(const Problem& problem) {
    const VectorXd &x = problem.at, c = problem.excess(), F_x = problem.cost_gradient();
    const MatrixXd c_x = problem.excess_gradient();
    const Goals& goals = problem.goals;
    const Index n = x.size();
    Conditions all{.size = F_x.norm()};
    MatrixXd A(n, 0);  // ∇c
    const auto add = [&](double by, const ActiveBound& bound, const VectorXd& gradient) {
        if (!(by >= -active_within)) return;
        all.active.push_back(bound);
        A.conservativeResize(n, A.cols() + 1);
        A.rightCols(1) = gradient;
    };
    for (Index k = 0; k < c.size(); ++k)
        add(c[k],
            {false, problem.side[static_cast<std::size_t>(k)], problem.per[k] > 0,
             problem.bound[k]},
            c_x.row(k));
    for (Index i = 0; i < n; ++i) {
        add(problem.box.low[i] - x[i], {true, i, false, goals.least[i]}, -VectorXd::Unit(n, i));
        add(x[i] - problem.box.high[i], {true, i, true, goals.most[i]}, VectorXd::Unit(n, i));
    }
    const VectorXd zero = VectorXd::Zero(A.cols());
    const Minimum multipliers =
        minimise({[&](const VectorXd& lambda) -> VectorXd { return A * lambda + F_x; },
                  [&](const VectorXd&) { return A; },
                  {zero, VectorXd::Constant(A.cols(), none)},
                  zero,
                  multiplier_pull},
                 zero);
    all.left = multipliers.residual.norm();
    // dF per unit of the shown cost
    const double unit = goals.minimised < 0 ? x.norm() : 1 / problem.scale[goals.minimised];
    for (std::size_t k = 0; k < all.active.size(); ++k) {
        ActiveBound& one = all.active[k];
        const double lambda = multipliers.x[static_cast<Index>(k)];
        one.price = unit > 0 ? lambda / problem.unit_of(one) / unit : 0;
    }
    std::ranges::stable_sort(all.active, std::ranges::greater{}, [&](const ActiveBound& one) {
        return one.price * problem.unit_of(one);
    });
    return all;
}

// max(0, c), zero also where a band is met as far as it counts; NaN of NaN.
double outside_of_band(double c) { return c <= within_bands / 10 ? 0 : c; }

// |max(0, c)|²
LeastSquares excess_from(Problem& problem, const VectorXd& start) {
    return {[&](const VectorXd& x) -> VectorXd {
                problem.move_to(x);
                return problem.excess().unaryExpr(&outside_of_band);
            },
            [&](const VectorXd& x) -> MatrixXd {
                problem.move_to(x);
                problem.differentiate();
                MatrixXd J = problem.excess_gradient();
                const VectorXd c = problem.excess();
                for (Index k = 0; k < c.size(); ++k)
                    if (outside_of_band(c[k]) == 0) J.row(k).setZero();
                return J;
            },
            problem.box, start};
}

// A search, and what is at its end.
struct Found {
    Search search = {};
    VectorXd x = {}, outside = {};   // the positive excess over each side of a band
    std::vector<int> at_limit = {};  // as in Optimum
    Conditions at_end = {};

    // Within the bands and of less cost, or nearer to them; by more than rounding, so that the first
    // of equal ones is taken.
    bool is_better_than(const Found& other) const {
        if (search.met != other.search.met) return search.met;
        const auto size = [&](const Found& one) {
            return search.met ? one.search.cost : one.outside.norm();
        };
        return size(*this) < size(other) - 1e-6 * std::abs(size(other));
    }
};

Found search_from(Problem& problem, const VectorXd& p) {
    Found found{.search = {.to = p, .excess = none, .cost = none}};
    Search& search = found.search;
    problem.evaluations = 0;
    problem.best = {};
    problem.least_cost = none;
    found.x = within(problem.box, (p - problem.goals.start).cwiseQuotient(problem.range));
    problem.move_to(found.x);
    search.has_value = problem.has_value();
    search.evaluations = problem.evaluations;
    if (!search.has_value) return found;
    const LeastSquares excess = excess_from(problem, found.x);
    const Minimum nearest = minimise(excess, found.x);
    found.x = nearest.x, found.outside = nearest.residual;
    search.met = problem.best.size() > 0;
    search.converged = !search.met && nearest.converged;
    if (!search.met) found.at_limit = limits_reached(excess, nearest);
    for (int run = 0; search.met && run < most_runs && !search.converged; ++run) {
        run_slsqp(problem, problem.best);
        found.x = problem.best;
        problem.move_to(found.x);
        problem.differentiate();
        found.at_end = conditions(problem);
        search.converged = found.at_end.fulfilled();
    }
    problem.move_to(found.x);
    search.excess = problem.largest_excess();
    search.cost = problem.goals.minimised < 0 ? found.x.norm() : problem.f[problem.goals.minimised];
    search.to = problem.number_at(found.x);
    search.evaluations = problem.evaluations;
    return found;
}

// The goals that do not move, the scales, and the sides of the bands that move.
Problem problem_of(const Figures& figures, const Goals& goals, Optimum& optimum) {
    Problem problem{.figures = figures, .goals = goals, .range = goals.most - goals.least};
    problem.box = {(goals.least - goals.start).cwiseQuotient(problem.range),
                   (goals.most - goals.start).cwiseQuotient(problem.range)};
    const VectorXd movement = (optimum.gradient.rate * problem.range.asDiagonal()).rowwise().norm();
    const auto goal_of = [&](Index j) {
        return static_cast<std::size_t>(goals.goal[static_cast<std::size_t>(j)]);
    };
    std::vector<double> largest(1 +
                                static_cast<std::size_t>(*std::ranges::max_element(goals.goal)));
    optimum.still.assign(largest.size(), true);
    for (Index j = 0; j < movement.size(); ++j) {
        if (movement[j] > least_movement(optimum.before[j])) optimum.still[goal_of(j)] = false;
        largest[goal_of(j)] = std::max(largest[goal_of(j)], movement[j]);
    }
    problem.scale.resize(movement.size());
    for (Index j = 0; j < movement.size(); ++j) {
        problem.scale[j] = largest[goal_of(j)] > 0 ? largest[goal_of(j)] : 1;
        if (optimum.still[goal_of(j)]) continue;
        problem.add_side(j, -1, goals.low[j]);
        problem.add_side(j, 1, goals.high[j]);
    }
    optimum.scale = problem.scale;
    return problem;
}

}  // namespace

std::vector<VectorXd> starts_of(const Goals& goals, int count) {
    std::vector<VectorXd> all{goals.start};
    std::mt19937_64 random(1);
    while (static_cast<int>(all.size()) < count)
        all.push_back(VectorXd::NullaryExpr(goals.start.size(), [&](Index i) {
            const double share = static_cast<double>(random() >> 11) * 0x1p-53;
            return goals.least[i] + share * (goals.most[i] - goals.least[i]);
        }));
    return all;
}

Optimum optimise(const Figures& figures, const Goals& goals, const std::vector<VectorXd>& starts,
                 const Progress& progress, const BestSoFar& best_so_far) {
    Optimum optimum{.p = goals.start, .before = figures.value(goals.start)};
    optimum.after = optimum.before;
    if (!optimum.before.allFinite()) return optimum;
    optimum.gradient = figures.gradient(goals.start);
    if (!optimum.gradient.rate.allFinite()) return optimum;
    Problem problem = problem_of(figures, goals, optimum);
    if (goals.minimised >= 0 &&
        optimum
            .still[static_cast<std::size_t>(goals.goal[static_cast<std::size_t>(goals.minimised)])])
        return optimum;

    Found best;
    for (std::size_t k = 0; k < starts.size(); ++k) {
        if (progress)
            progress(fmt::format("start {} of {}{}", k + 1, starts.size(),
                                 optimum.best < 0  ? ""
                                 : best.search.met ? ", bands met"
                                                   : ", bands not met yet"),
                     static_cast<double>(k) / static_cast<double>(starts.size()));
        Found found = search_from(problem, starts[k]);
        optimum.searches.push_back(found.search);
        if (!found.search.has_value || (optimum.best >= 0 && !found.is_better_than(best))) continue;
        optimum.best = static_cast<int>(k);
        best = std::move(found);
        if (best_so_far) best_so_far(best.search.to, best.search.met);
    }
    if (optimum.best < 0) return optimum;
    optimum.p = best.search.to;
    optimum.after = figures.value(optimum.p);
    optimum.met = best.search.met && optimum.after.allFinite();
    optimum.converged = best.search.converged;
    optimum.cost = best.search.cost;
    optimum.optimality = best.at_end.size > 0 ? best.at_end.left / best.at_end.size : 0;
    optimum.active = best.at_end.active;
    optimum.conflict = VectorXd::Zero(goals.low.size());
    for (Index k = 0; !optimum.met && k < best.outside.size(); ++k)
        optimum.conflict[problem.side[static_cast<std::size_t>(k)]] +=
            best.outside[k] / best.outside.norm();
    optimum.at_limit = best.at_limit;
    optimum.at_limit.resize(static_cast<std::size_t>(goals.start.size()));
    return optimum;
}

}  // namespace elastocheck::compare
