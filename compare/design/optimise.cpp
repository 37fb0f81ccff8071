#include "compare/design/optimise.hpp"

#include <fmt/format.h>
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <random>

#include "compare/design/least_squares.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double none = std::numeric_limits<double>::infinity();

constexpr int most_evaluations = 200;    // of one run of SLSQP
constexpr int most_runs = 4;             // each from the best point before
constexpr int calls_at_one_point = 20;   // the step of SLSQP has vanished: it would loop for ever
constexpr double least_step = 1e-12;     // of x
constexpr double active_within = 1e-6;   // of c
constexpr double optimal_within = 1e-4;  // of |∇F|
constexpr double least_residual = 1e-7;  // of the conditions of the optimum, where ∇F vanishes
// of a column of ∇c: makes the multipliers of parallel columns unique
constexpr double multiplier_ridge = 1e-7;

// c = sign (f - bound) / g ≤ 0 of a figure.
struct BandSide {
    Index figure;
    double sign, bound;
};

// The problem in x, with the last evaluated point, and the best point within the bands.
struct Problem {
    const Figures& figures;
    const Goals& goals;
    VectorXd range, scale;
    std::vector<BandSide> sides;
    Box box;

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
        // A number at its limit has exactly that value.
        return (goals.start + range.cwiseProduct(x)).cwiseMax(goals.least).cwiseMin(goals.most);
    }
    Index count() const { return static_cast<Index>(sides.size()); }

    double cost() const {
        return goals.minimised < 0 ? at.squaredNorm() / 2
                                   : f[goals.minimised] / scale[goals.minimised];
    }
    VectorXd cost_gradient() const {
        if (goals.minimised < 0) return at;
        return f_x.row(goals.minimised).transpose() / scale[goals.minimised];
    }
    VectorXd excess() const {
        VectorXd c(count());
        for (Index k = 0; k < c.size(); ++k) {
            const BandSide& side = sides[static_cast<std::size_t>(k)];
            c[k] = side.sign * (f[side.figure] - side.bound) / scale[side.figure];
        }
        return c;
    }
    MatrixXd excess_gradient() const {
        MatrixXd c_x(count(), range.size());
        for (Index k = 0; k < count(); ++k) {
            const BandSide& side = sides[static_cast<std::size_t>(k)];
            c_x.row(k) = side.sign / scale[side.figure] * f_x.row(side.figure);
        }
        return c_x;
    }
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
    const auto n = static_cast<unsigned>(x.size()), m = static_cast<unsigned>(problem.count());
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

// A bound that holds at a point, with ∇c.
struct Active {
    bool of_number;
    Index which;
    double sign, bound;
    VectorXd gradient;
    double multiplier = 0;  // λ
};

// Multipliers of the bounds that hold at the evaluated point.
struct Conditions {
    std::vector<Active> active;
    double residual = 0;  // |∇F + Σ λ ∇c|
    double size = 0;      // |∇F|
    bool fulfilled() const { return residual <= optimal_within * size + least_residual; }
};
Conditions conditions(const Problem& problem) {
    const VectorXd& x = problem.at;
    const Index n = x.size();
    Conditions all;
    const VectorXd c = problem.excess();
    const MatrixXd c_x = problem.excess_gradient();
    for (Index k = 0; k < c.size(); ++k) {
        const BandSide& side = problem.sides[static_cast<std::size_t>(k)];
        if (c[k] >= -active_within)
            all.active.push_back({false, side.figure, side.sign, side.bound, c_x.row(k)});
    }
    for (Index i = 0; i < n; ++i) {
        if (x[i] - problem.box.low[i] <= active_within)
            all.active.push_back({true, i, -1, problem.goals.least[i], -VectorXd::Unit(n, i)});
        if (problem.box.high[i] - x[i] <= active_within)
            all.active.push_back({true, i, 1, problem.goals.most[i], VectorXd::Unit(n, i)});
    }
    const VectorXd F_x = problem.cost_gradient();
    all.size = F_x.norm();
    VectorXd left = F_x;
    if (const auto m = static_cast<Index>(all.active.size()); m > 0) {
        // [∇c; ρ I] λ ≈ [-∇F; 0]
        MatrixXd A = MatrixXd::Zero(n + m, m);
        for (Index k = 0; k < m; ++k) {
            A.col(k).head(n) = all.active[static_cast<std::size_t>(k)].gradient;
            A(n + k, k) = multiplier_ridge;
        }
        VectorXd b = VectorXd::Zero(n + m);
        b.head(n) = -F_x;
        if (A.allFinite() && b.allFinite()) {
            const VectorXd lambda =
                bounded_least_squares(A, b, {VectorXd::Zero(m), VectorXd::Constant(m, none)});
            left += A.topRows(n) * lambda;
            for (Index k = 0; k < m; ++k)
                all.active[static_cast<std::size_t>(k)].multiplier = lambda[k];
        } else {
            left.setConstant(std::nan(""));
        }
    }
    all.residual = left.norm();
    return all;
}

double positive_part(double c) { return c > 0 ? c : c <= 0 ? 0 : std::nan(""); }

// The numbers nearest to the bands.
Minimum nearest_to_bands(Problem& problem, const VectorXd& start) {
    const LeastSquares excess{[&](const VectorXd& x) -> VectorXd {
                                  problem.move_to(x);
                                  return problem.excess().unaryExpr(&positive_part);
                              },
                              [&](const VectorXd& x) -> MatrixXd {
                                  problem.move_to(x);
                                  problem.differentiate();
                                  MatrixXd J = problem.excess_gradient();
                                  const VectorXd c = problem.excess();
                                  for (Index k = 0; k < c.size(); ++k)
                                      if (c[k] <= 0) J.row(k).setZero();
                                  return J;
                              }};
    return minimise(excess, start, problem.box);
}

// A search, and what is at its end if the bands cannot be met.
struct Found {
    Search search;
    VectorXd x;
    Minimum nearest;  // with the excess as residual
    Conditions at_end = {};
};
Found search_from(Problem& problem, const VectorXd& p) {
    Found found;
    Search& search = found.search;
    search.from = p;
    problem.evaluations = 0;
    problem.best = {};
    problem.least_cost = none;
    const VectorXd start = (p - problem.goals.start)
                               .cwiseQuotient(problem.range)
                               .cwiseMax(problem.box.low)
                               .cwiseMin(problem.box.high);
    problem.move_to(start);
    search.has_value = problem.has_value();
    found.x = start;
    search.excess = search.cost = none;
    if (search.has_value) {
        found.nearest = nearest_to_bands(problem, start);
        found.x = found.nearest.x;
        search.met = problem.best.size() > 0;
        search.converged = !search.met && found.nearest.converged;
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
        search.cost =
            problem.goals.minimised < 0 ? found.x.norm() : problem.f[problem.goals.minimised];
    }
    search.to = problem.number_at(found.x);
    search.evaluations = problem.evaluations;
    return found;
}

// Within the bands and of less cost, or nearer to them; by more than rounding, so that the first
// of equal ones is taken.
bool is_better(const Found& a, const Found& b) {
    if (a.search.met != b.search.met) return a.search.met;
    const double of_a = a.search.met ? a.search.cost : a.nearest.residual.norm(),
                 of_b = b.search.met ? b.search.cost : b.nearest.residual.norm();
    return of_a < of_b - 1e-6 * std::abs(of_b);
}

void set_conflict(const Problem& problem, const Found& found, Optimum& optimum) {
    const VectorXd& r = found.nearest.residual;
    for (Index k = 0; k < r.size(); ++k)
        optimum.conflict[problem.sides[static_cast<std::size_t>(k)].figure] += r[k] / r.norm();
    const VectorXd descent = -found.nearest.jacobian.transpose() * r;
    for (Index i = 0; i < found.x.size(); ++i) {
        const bool outwards = std::abs(descent[i]) > 1e-6 * r.norm();
        if (outwards && found.x[i] <= problem.box.low[i] && descent[i] < 0)
            optimum.at_limit[static_cast<std::size_t>(i)] = -1;
        if (outwards && found.x[i] >= problem.box.high[i] && descent[i] > 0)
            optimum.at_limit[static_cast<std::size_t>(i)] = 1;
    }
}

void set_prices(const Problem& problem, const Found& found, Optimum& optimum) {
    // dF of the minimised F per unit of the shown cost
    const double unit = problem.goals.minimised < 0 ? found.search.cost
                                                    : 1 / problem.scale[problem.goals.minimised];
    for (const Active& one : found.at_end.active) {
        const double per = one.of_number ? problem.range[one.which] : problem.scale[one.which];
        optimum.active.push_back({.of_number = one.of_number,
                                  .which = one.which,
                                  .upper = one.sign > 0,
                                  .bound = one.bound,
                                  .price = unit > 0 ? one.multiplier / per / unit : 0});
    }
    std::ranges::stable_sort(optimum.active, std::ranges::greater{}, [&](const ActiveBound& one) {
        return one.price * (one.of_number ? problem.range[one.which] : problem.scale[one.which]);
    });
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
                 const Progress& progress) {
    const Index n = goals.start.size(), m = goals.low.size();
    Optimum optimum;
    optimum.p = goals.start;
    optimum.before = optimum.after = figures.value(goals.start);
    if (!optimum.before.allFinite()) return optimum;
    optimum.gradient = figures.gradient(goals.start);
    if (!optimum.gradient.rate.allFinite()) return optimum;

    Problem problem{.figures = figures,
                    .goals = goals,
                    .range = goals.most - goals.least,
                    .scale = VectorXd(m),
                    .sides = {},
                    .box = {}};
    problem.box = {(goals.least - goals.start).cwiseQuotient(problem.range),
                   (goals.most - goals.start).cwiseQuotient(problem.range)};
    const VectorXd movement = (optimum.gradient.rate * problem.range.asDiagonal()).rowwise().norm();
    const auto count = static_cast<std::size_t>(
        goals.goal.empty() ? 0 : *std::ranges::max_element(goals.goal) + 1);
    std::vector<double> largest(count, 0);
    optimum.still.assign(count, true);
    for (Index j = 0; j < m; ++j) {
        const auto goal = static_cast<std::size_t>(goals.goal[static_cast<std::size_t>(j)]);
        const double rounding = 1e-10 * (1 + std::abs(optimum.before[j]));
        if (movement[j] > rounding) optimum.still[goal] = false;
        largest[goal] = std::max(largest[goal], movement[j]);
    }
    for (Index j = 0; j < m; ++j) {
        const auto goal = static_cast<std::size_t>(goals.goal[static_cast<std::size_t>(j)]);
        problem.scale[j] = largest[goal] > 0 ? largest[goal] : 1;
        if (optimum.still[goal]) continue;
        if (std::isfinite(goals.low[j])) problem.sides.push_back({j, -1, goals.low[j]});
        if (std::isfinite(goals.high[j])) problem.sides.push_back({j, 1, goals.high[j]});
    }
    optimum.scale = problem.scale;
    if (goals.minimised >= 0 &&
        optimum
            .still[static_cast<std::size_t>(goals.goal[static_cast<std::size_t>(goals.minimised)])])
        return optimum;

    std::vector<Found> all;
    for (std::size_t k = 0; k < starts.size(); ++k) {
        if (progress)
            progress(fmt::format("start {} of {}{}", k + 1, starts.size(),
                                 optimum.best < 0 ? ""
                                 : all[static_cast<std::size_t>(optimum.best)].search.met
                                     ? ", bands met"
                                     : ", bands not met yet"),
                     static_cast<double>(k) / static_cast<double>(starts.size()));
        all.push_back(search_from(problem, starts[k]));
        optimum.searches.push_back(all.back().search);
        if (all.back().search.has_value &&
            (optimum.best < 0 ||
             is_better(all.back(), all[static_cast<std::size_t>(optimum.best)])))
            optimum.best = static_cast<int>(k);
    }
    if (optimum.best < 0) return optimum;
    const Found& found = all[static_cast<std::size_t>(optimum.best)];
    optimum.p = found.search.to;
    optimum.after = figures.value(optimum.p);
    optimum.met = found.search.met && optimum.after.allFinite();
    optimum.converged = found.search.converged;
    optimum.cost = found.search.cost;
    optimum.conflict = VectorXd::Zero(m);
    optimum.at_limit.assign(static_cast<std::size_t>(n), 0);
    if (optimum.met) {
        optimum.optimality = found.at_end.size > 0 ? found.at_end.residual / found.at_end.size : 0;
        set_prices(problem, found, optimum);
    } else {
        set_conflict(problem, found, optimum);
    }
    return optimum;
}

}  // namespace elastocheck::compare
