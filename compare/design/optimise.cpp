#include "compare/design/optimise.hpp"

#include <fmt/format.h>
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <random>

#include "compare/design/least_squares.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double unbounded = std::numeric_limits<double>::infinity();

constexpr int max_evaluations = 200;       // in one run of SLSQP
constexpr int max_runs = 4;                // runs of SLSQP, each from the best point before
constexpr int max_repeats = 20;            // calls at one point, after which SLSQP would not end
constexpr double min_step = 1e-12;         // change of x at which a run of SLSQP ends
constexpr double active_tolerance = 1e-6;  // a bound is active where c ≥ -active_tolerance
// Residual |∇F + Σ λ ∇c| of the optimality conditions as a share of |∇F|: largest of an optimum, and largest
// at which a run of SLSQP ends. Where ∇F vanishes, the residual itself must be below min_residual.
constexpr double optimality_tolerance = 1e-4, run_tolerance = 1e-6, min_residual = 1e-7;
constexpr double multiplier_regularisation = 1e-7;  // makes the multipliers of parallel ∇c unique

// The problem in x, with the last evaluated point, and the best point within the bands.
struct Problem {
    const Figures& figures;
    const SearchRange& range;
    const VectorXd& scale;
    int minimised = -1;
    // Bounds of the figures that change with the numbers; bounds of the numbers.
    std::vector<Bound> bands = {}, limits = {};

    VectorXd current = {}, p = {},
             f = {};    // the last point x, its numbers p, and the figures there
    MatrixXd f_x = {};  // ∂f/∂x; empty until it is needed

    VectorXd best = {};  // x of least cost within the bands; empty: none yet
    double min_cost = unbounded;

    // State of a run of SLSQP: the optimiser, calls at the current point, exception of an evaluation.
    nlopt_opt run = nullptr;
    int repeats = 0;
    std::exception_ptr failed = {};

    double unit_of(const Bound& bound) const {
        return bound.of_number ? range.high[bound.index] - range.low[bound.index]
                               : scale[bound.index];
    }
    double cost() const {
        return minimised < 0 ? current.squaredNorm() / 2 : f[minimised] / scale[minimised];
    }
    VectorXd cost_gradient() const {
        if (minimised < 0) return current;
        return f_x.row(minimised).transpose() / scale[minimised];
    }
    // c of optimise.hpp, one entry per bound, and ∂c/∂x.
    VectorXd excess(const std::vector<Bound>& bounds) const {
        return VectorXd::NullaryExpr(std::ssize(bounds), [&](Index k) {
            const Bound& bound = bounds[static_cast<std::size_t>(k)];
            const double difference = (bound.of_number ? p : f)[bound.index] - bound.bound;
            return (bound.upper ? difference : -difference) / unit_of(bound);
        });
    }
    MatrixXd excess_gradient(const std::vector<Bound>& bounds) const {
        MatrixXd gradient = MatrixXd::Zero(std::ssize(bounds), current.size());
        for (Index k = 0; k < gradient.rows(); ++k) {
            const Bound& bound = bounds[static_cast<std::size_t>(k)];
            if (bound.of_number)
                gradient(k, bound.index) = 1;
            else
                gradient.row(k) = f_x.row(bound.index) / scale[bound.index];
            if (!bound.upper) gradient.row(k) *= -1;
        }
        return gradient;
    }
    bool has_value() const { return excess(bands).allFinite() && std::isfinite(cost()); }
    double largest_excess() const {
        const VectorXd c = excess(bands);
        return c.size() == 0 ? -unbounded : c.allFinite() ? c.maxCoeff() : unbounded;
    }

    void move_to(const VectorXd& x) {
        if (current.size() > 0 && current == x) {
            if (++repeats >= max_repeats && run) nlopt_force_stop(run);
            return;
        }
        current = x;
        p = range.point(x);
        f = figures.value(p);
        f_x = {};
        repeats = 0;
        if (has_value() && largest_excess() <= within_bands && cost() < min_cost) {
            best = x;
            min_cost = cost();
        }
    }
    void differentiate() {
        if (f_x.size() == 0) f_x = figures.gradient(p) * (range.high - range.low).asDiagonal();
    }
    // Evaluates for NLopt, a C library, through which no exception may pass.
    template <class Read>
    void evaluate_for_nlopt(unsigned n, const double* x, bool gradient, const Read& read) {
        try {
            move_to(Eigen::Map<const VectorXd>(x, n));
            if (gradient) differentiate();
            read();
        } catch (...) {
            failed = std::current_exception();
            nlopt_force_stop(run);
        }
    }
};

// Sets the bounds that are active at the evaluated point, with their prices λ, and the optimality: the residual
// |∇F + Σ λ ∇c| with the λ ≥ 0 that minimise it.
void set_optimality(Problem& problem, Search& search) {
    problem.differentiate();
    const VectorXd F_x = problem.cost_gradient();
    MatrixXd A(F_x.size(), 0);  // ∇c
    search.active.clear();
    for (const auto* bounds : {&problem.bands, &problem.limits}) {
        const VectorXd c = problem.excess(*bounds);
        const MatrixXd c_x = problem.excess_gradient(*bounds);
        for (Index k = 0; k < c.size(); ++k) {
            if (!(c[k] >= -active_tolerance)) continue;
            search.active.push_back((*bounds)[static_cast<std::size_t>(k)]);
            A.conservativeResize(Eigen::NoChange, A.cols() + 1);
            A.rightCols(1) = c_x.row(k).transpose();
        }
    }
    const VectorXd zero = VectorXd::Zero(A.cols());
    const Minimum multipliers =
        minimise({[&](const VectorXd& lambda) -> VectorXd { return A * lambda + F_x; },
                  [&](const VectorXd&) { return A; },
                  {zero, VectorXd::Constant(A.cols(), unbounded)},
                  zero,
                  multiplier_regularisation},
                 zero);
    const double residual = multipliers.residual.norm(), size = F_x.norm();
    search.converged = residual <= optimality_tolerance * size + min_residual;
    search.optimality = size > 0 ? residual / size : 0;
    // dF per unit of the shown cost
    const double unit =
        problem.minimised < 0 ? problem.current.norm() : 1 / problem.scale[problem.minimised];
    for (std::size_t k = 0; k < search.active.size(); ++k)
        if (Bound& bound = search.active[k]; unit > 0)
            bound.price = multipliers.x[static_cast<Index>(k)] / problem.unit_of(bound) / unit;
    std::ranges::stable_sort(search.active, std::ranges::greater{}, [&](const Bound& bound) {
        return bound.price * problem.unit_of(bound);
    });
}

double slsqp_cost(unsigned n, const double* x, double* gradient, void* data) {
    Problem& problem = *static_cast<Problem*>(data);
    double cost = HUGE_VAL;  // SLSQP then shortens its step
    problem.evaluate_for_nlopt(n, x, gradient != nullptr, [&] {
        if (problem.has_value()) cost = problem.cost();
        if (!gradient) return;
        Eigen::Map<VectorXd>(gradient, n) = problem.cost_gradient();
        if (problem.best.size() == 0 || problem.current != problem.best) return;
        Search search;
        set_optimality(problem, search);
        if (search.optimality <= run_tolerance) nlopt_force_stop(problem.run);
    });
    return cost;
}

void slsqp_excess(unsigned m, double* result, unsigned n, const double* x, double* gradient,
                  void* data) {
    Problem& problem = *static_cast<Problem*>(data);
    Eigen::Map<VectorXd> c(result, m);
    c.setZero();
    problem.evaluate_for_nlopt(n, x, gradient != nullptr, [&] {
        if (problem.has_value()) c = problem.excess(problem.bands);
        // row-major [m × n] is column-major [n × m]
        if (gradient)
            Eigen::Map<MatrixXd>(gradient, n, m) =
                problem.excess_gradient(problem.bands).transpose();
    });
}

void run_slsqp(Problem& problem, VectorXd x) {
    const auto m = static_cast<unsigned>(problem.bands.size());
    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> run(
        nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(x.size())), nlopt_destroy);
    problem.run = run.get();
    problem.repeats = 0;
    const VectorXd low = problem.range.shares(problem.range.low),
                   high = problem.range.shares(problem.range.high);
    nlopt_set_lower_bounds(run.get(), low.data());
    nlopt_set_upper_bounds(run.get(), high.data());
    nlopt_set_min_objective(run.get(), slsqp_cost, &problem);
    const std::vector<double> within(m, within_bands / 10);
    if (m > 0)
        nlopt_add_inequality_mconstraint(run.get(), m, slsqp_excess, &problem, within.data());
    nlopt_set_xtol_abs1(run.get(), min_step);
    nlopt_set_maxeval(run.get(), max_evaluations);
    double cost = 0;
    nlopt_optimize(run.get(), x.data(), &cost);
    problem.run = nullptr;
    if (problem.failed) std::rethrow_exception(problem.failed);
}

// Whether `search` meets the bands at less cost than `other`, or is nearer to them, by more than rounding: of
// equal searches the first counts.
bool is_better(const Search& search, const Search& other) {
    if (search.met != other.met) return search.met;
    const auto size = [&](const Search& s) { return search.met ? s.cost : s.nearest.off.norm(); };
    return size(search) < size(other) - 1e-6 * std::abs(size(other));
}

// Best of the points x so far: `met` if it is within the bands; `size` is its cost if it is, else its distance
// from them.
struct BestPoint {
    const Bands& bands;
    int minimised;
    bool met = false;
    double size = unbounded;

    // Takes the point x with the figures f if it is better; returns whether it was.
    bool take(const VectorXd& x, const VectorXd& f) {
        const VectorXd off =
            (f - f.cwiseMax(bands.low).cwiseMin(bands.high)).cwiseQuotient(bands.scale);
        const bool is_within = off.cwiseAbs().maxCoeff() <= within_bands;
        const double new_size = !is_within      ? off.norm()
                                : minimised < 0 ? x.norm()
                                                : f[minimised] / bands.scale[minimised];
        if (!f.allFinite() || (met && !is_within) || (met == is_within && !(new_size < size)))
            return false;
        met = is_within;
        size = new_size;
        return true;
    }
};

Search search_from(Problem& problem, const Bands& bands, const VectorXd& start) {
    Search search{.p = start, .excess = unbounded, .cost = unbounded};
    problem.best = {};
    problem.min_cost = unbounded;
    const SearchRange& range = problem.range;
    problem.move_to(range.shares(start));
    search.has_value = problem.has_value();
    if (!search.has_value) return search;
    search.nearest = solve_for(problem.figures, bands, range, start);
    problem.move_to(range.shares(search.nearest.p));
    search.met = problem.best.size() > 0;
    if (search.met) {
        problem.move_to(problem.best);
        set_optimality(problem, search);
        for (int run = 0; run < max_runs && !search.converged; ++run) {
            run_slsqp(problem, problem.best);
            problem.move_to(problem.best);
            set_optimality(problem, search);
        }
    } else {
        search.converged = search.nearest.converged;
    }
    search.excess = problem.largest_excess();
    search.cost = problem.minimised < 0 ? problem.current.norm() : problem.f[problem.minimised];
    search.p = problem.p;
    return search;
}

// The problem in x. Sets the goals that no number changes (optimum.still) and the scales; only the other goals
// have bounds.
Problem problem_of(const Figures& figures, const Goals& goals, const SearchRange& range,
                   Optimum& optimum) {
    const auto goal_of = [&](Index j) {
        return static_cast<std::size_t>(goals.goal[static_cast<std::size_t>(j)]);
    };
    const Index m = goals.low.size();
    VectorXd largest = VectorXd::Zero(1 + *std::ranges::max_element(goals.goal));
    optimum.still.assign(static_cast<std::size_t>(largest.size()), true);
    for (Index j = 0; j < m; ++j) {
        double& goal_movement = largest[static_cast<Index>(goal_of(j))];
        goal_movement = std::max(goal_movement, optimum.start.movement[j]);
        if (!optimum.start.still[static_cast<std::size_t>(j)]) optimum.still[goal_of(j)] = false;
    }
    optimum.scale = largest(goals.goal);
    optimum.scale = (optimum.scale.array() > 0).select(optimum.scale, 1);
    Problem problem{figures, range, optimum.scale, goals.minimised};
    const auto add = [](std::vector<Bound>& to, bool of_number, Index index, double low,
                        double high) {
        if (std::isfinite(low)) to.push_back({of_number, index, false, low});
        if (std::isfinite(high)) to.push_back({of_number, index, true, high});
    };
    for (Index j = 0; j < m; ++j)
        if (!optimum.still[goal_of(j)]) add(problem.bands, false, j, goals.low[j], goals.high[j]);
    for (Index i = 0; i < range.start.size(); ++i)
        add(problem.limits, true, i, range.low[i], range.high[i]);
    return problem;
}

}  // namespace

std::vector<VectorXd> starts_of(const SearchRange& range, int count) {
    std::vector<VectorXd> starts{range.start};
    std::mt19937_64 random(1);
    while (static_cast<int>(starts.size()) < count)
        starts.push_back(VectorXd::NullaryExpr(range.start.size(), [&](Index i) {
            const double share = static_cast<double>(random() >> 11) * 0x1p-53;
            return range.low[i] + share * (range.high[i] - range.low[i]);
        }));
    return starts;
}

Optimum optimise(const Figures& figures, const Goals& goals, const SearchRange& range,
                 const std::vector<VectorXd>& starts, const Progress& progress,
                 const BestSoFar& best_so_far) {
    Optimum optimum;
    optimum.p = range.start;
    optimum.start = start_of(figures, range);
    optimum.after = optimum.start.value;
    if (!optimum.start.complete()) return optimum;
    int evaluations = 0;
    std::optional<BestPoint> seen;
    const Figures counted{
        [&](const std::vector<VectorXd>& points) {
            evaluations += static_cast<int>(points.size());
            auto values = figures.values(points);
            if (seen && seen->take(range.shares(points[0]), values[0]) && best_so_far)
                best_so_far(points[0], seen->met);
            return values;
        },
        figures.step};
    Problem problem = problem_of(counted, goals, range, optimum);
    Bands bands{VectorXd::Constant(goals.low.size(), -unbounded),
                VectorXd::Constant(goals.low.size(), unbounded), optimum.scale};
    for (const Bound& bound : problem.bands)
        (bound.upper ? bands.high : bands.low)[bound.index] = bound.bound;
    if (goals.minimised >= 0 &&
        optimum
            .still[static_cast<std::size_t>(goals.goal[static_cast<std::size_t>(goals.minimised)])])
        return optimum;
    seen.emplace(bands, goals.minimised);
    (void)seen->take(range.shares(range.start), optimum.start.value);

    Search& best = optimum;
    for (std::size_t k = 0; k < starts.size(); ++k) {
        if (progress)
            progress(fmt::format("start {} of {}{}", k + 1, starts.size(),
                                 optimum.best < 0 ? ""
                                 : best.met       ? ", bands met"
                                                  : ", bands not met yet"),
                     static_cast<double>(k) / static_cast<double>(starts.size()));
        evaluations = 0;
        Search& found = optimum.searches.emplace_back(search_from(problem, bands, starts[k]));
        found.evaluations = evaluations;
        if (!found.has_value || (optimum.best >= 0 && !is_better(found, best))) continue;
        optimum.best = static_cast<int>(k);
        best = found;
    }
    if (optimum.best < 0) return optimum;
    optimum.after = figures.value(optimum.p);
    optimum.met = best.met && optimum.after.allFinite();
    optimum.conflict = optimum.met ? VectorXd::Zero(goals.low.size()) : best.nearest.conflict();
    return optimum;
}

}  // namespace elastocheck::compare
