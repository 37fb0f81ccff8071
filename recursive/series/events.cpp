#include "recursive/series/events.hpp"

#include "recursive/series/polynomial.hpp"
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/step_check.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive::series {

void move_to(Continuation& run, const State<double>& from, double tau) {
    horner(run.c.polynomial(), tau, run.x);
    displace(from, run.x, run.s.q);
    run.s.lambda = run.x.tail(run.s.m());
    run.go_to(polynomial(run.c.load, tau));
}

int determinant_sign(const Continuation& run, double parameter_rate) {
    const int sign = run.s.system.lu.orientation;
    return run.by_arc() && parameter_rate < 0 ? -sign : sign;
}

double parameter_rate_ahead(const Continuation& run) {
    const auto W2 = run.s.system.weight.head(run.s.n()).array().square();
    return (run.previous_direction.head(run.s.n()).array() * W2 *
            run.c.unit.head(run.s.n()).array())
        .sum();
}

bool is_past(Continuation& run, double parameter_rate) {
    if (determinant_sign(run, parameter_rate) != run.sign_at_start) return true;
    if (!run.stable) return false;
    const LeastStiffness least = min_stiffness(run.s, run.softest_modes);
    return (least.of_energy && least.value < 0) ||
           negative_idle_stiffness(run.s, run.s.q, run.s.lambda) < 0;
}

double determinant(const Continuation& run) {
    const double size = std::exp2(log_determinant(run.s.system) - run.start_log_determinant);
    return determinant_sign(run, run.branch_end) == run.sign_at_start ? size : -size;
}

void record_limit_points(Continuation& run, double reach) {
    constexpr int pieces = 64;
    const auto rate = [&](double t) { return slope(run.c.load, t); };
    if (run.path.expansions.empty()) run.parameter_rate = rate(0);
    for (int k = 1; k <= pieces; ++k) {
        const double from = reach * (k - 1) / pieces, to = reach * k / pieces;
        if (rate(to) * run.parameter_rate >= 0) continue;
        const double turn = rate(from) * run.parameter_rate > 0 ? bisect(rate, from, to) : from;
        run.path.limits.push_back(polynomial(run.c.load, turn));
        run.parameter_rate = rate(to);
    }
}

double locate_bifurcation(Continuation& run, const State<double>& from, double reach) {
    constexpr int halvings = 40;
    double before = 0, past = reach;
    for (int k = 0; k < halvings && !run.by_arc(); ++k) {
        const double middle = before + (past - before) / 2;
        move_to(run, from, middle);
        const bool regular = factorise_at(run.s, run.s.q, run.s.lambda) == Outcome::converged;
        (regular && !is_past(run, run.branch_end) ? before : past) = middle;
    }
    move_to(run, from, past);
    return before;
}

std::optional<double> find_instability(Continuation& run, const State<double>& from, double reach) {
    if (!run.stable) return std::nullopt;
    if (run.middle_determinant < 0) return reach / 2;
    const double a = run.parameter_now(), here = determinant(run);
    const State<double> end = run.s.q;
    const Vector<double> lambda_end = run.s.lambda;
    bool moved = false;
    const Dip lowest = lowest_determinant({1, run.middle_determinant, here}, [&](double t) {
        moved = true;
        move_to(run, from, t * reach);
        return factorise_at(run.s, run.s.q, run.s.lambda) != Outcome::converged ||
                       is_past(run, run.branch_end)
                   ? -1
                   : determinant(run);
    });
    if (lowest.value < 0) return lowest.t * reach;
    if (moved) {
        run.go_to(a);
        run.s.q = end;
        run.s.lambda = lambda_end;
        (void)factorise_at(run.s, run.s.q, run.s.lambda);
    }
    return std::nullopt;
}

std::optional<double> find_reversal(Continuation& run, const State<double>& from, double reach) {
    constexpr int pieces = 32, halvings = 40;
    const Model& model = run.s.model;
    if (!any_reversed(model, from, run.s.q)) return std::nullopt;
    const State<double> end = run.s.q;
    const Vector<double> lambda_end = run.s.lambda;
    const double a = run.parameter_now();
    State<double> before = from;
    for (int k = 1; k <= pieces; ++k) {
        double low = reach * (k - 1) / pieces, high = reach * k / pieces;
        move_to(run, from, high);
        if (!any_reversed(model, before, run.s.q)) {
            before = run.s.q;
            continue;
        }
        for (int n = 0; n < halvings; ++n) {
            const double middle = (low + high) / 2;
            move_to(run, from, middle);
            (any_reversed(model, before, run.s.q) ? high : low) = middle;
        }
        move_to(run, from, low);
        return low;
    }
    run.go_to(a);  // no element reverses: one has only rotated far
    run.s.q = end;
    run.s.lambda = lambda_end;
    return std::nullopt;
}

}  // namespace elastocheck::recursive::series
