#include "recursive/series/events.hpp"

#include "recursive/series/polynomial.hpp"
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/step_check.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive::series {

void move_to(Continuation& w, const State<double>& from, double tau) {
    horner(w.c.x, tau, w.x);
    displace(from, w.x, w.s.q);
    w.s.lambda = w.x.tail(w.s.m());
    w.go_to(polynomial(w.c.load, tau));
}

int determinant_sign(const Continuation& w, double parameter_rate) {
    const int sign = w.s.system.lu.orientation;
    return w.by_arc() && parameter_rate < 0 ? -sign : sign;
}

double parameter_rate_ahead(const Continuation& w) {
    const auto W2 = w.s.system.weight.head(w.s.n()).array().square();
    return (w.ahead.head(w.s.n()).array() * W2 * w.c.unit.head(w.s.n()).array()).sum();
}

bool is_past(Continuation& w, double parameter_rate) {
    if (determinant_sign(w, parameter_rate) != w.sign_at_start) return true;
    if (!w.stable) return false;
    const LeastStiffness least = min_stiffness(w.s, w.softest);
    return (least.of_energy && least.value < 0) ||
           negative_idle_stiffness(w.s, w.s.q, w.s.lambda) < 0;
}

double determinant(const Continuation& w) {
    const double size = std::exp2(log_determinant(w.s.system) - w.log_begin);
    return determinant_sign(w, w.to) == w.sign_at_start ? size : -size;
}

void record_limit_points(Continuation& w, double reach) {
    constexpr int pieces = 64;
    const auto rate = [&](double t) { return slope(w.c.load, t); };
    if (w.path.expansions.empty()) w.heading = rate(0);
    for (int k = 1; k <= pieces; ++k) {
        const double from = reach * (k - 1) / pieces, to = reach * k / pieces;
        if (rate(to) * w.heading >= 0) continue;
        const double turn = rate(from) * w.heading > 0 ? bisect(rate, from, to) : from;
        w.path.limits.push_back(polynomial(w.c.load, turn));
        w.heading = rate(to);
    }
}

double locate_bifurcation(Continuation& w, const State<double>& from, double reach) {
    constexpr int halvings = 40;
    double before = 0, past = reach;
    for (int k = 0; k < halvings && !w.by_arc(); ++k) {
        const double middle = before + (past - before) / 2;
        move_to(w, from, middle);
        const bool regular = factorise_at(w.s, w.s.q, w.s.lambda) == Outcome::converged;
        (regular && !is_past(w, w.to) ? before : past) = middle;
    }
    move_to(w, from, past);
    return before;
}

std::optional<double> find_instability(Continuation& w, const State<double>& from, double reach) {
    if (!w.stable) return std::nullopt;
    if (w.at_middle < 0) return reach / 2;
    const double a = w.parameter_now(), here = determinant(w);
    const State<double> end = w.s.q;
    const Vector<double> lambda_end = w.s.lambda;
    bool moved = false;
    const Dip lowest = lowest_determinant({1, w.at_middle, here}, [&](double t) {
        moved = true;
        move_to(w, from, t * reach);
        return factorise_at(w.s, w.s.q, w.s.lambda) != Outcome::converged || is_past(w, w.to)
                   ? -1
                   : determinant(w);
    });
    if (lowest.value < 0) return lowest.t * reach;
    if (moved) {
        w.go_to(a);
        w.s.q = end;
        w.s.lambda = lambda_end;
        (void)factorise_at(w.s, w.s.q, w.s.lambda);
    }
    return std::nullopt;
}

std::optional<double> find_reversal(Continuation& w, const State<double>& from, double reach) {
    constexpr int pieces = 32, halvings = 40;
    const Model& model = w.s.model;
    if (!any_reversed(model, from, w.s.q)) return std::nullopt;
    const State<double> end = w.s.q;
    const Vector<double> lambda_end = w.s.lambda;
    const double a = w.parameter_now();
    State<double> before = from;
    for (int k = 1; k <= pieces; ++k) {
        double low = reach * (k - 1) / pieces, high = reach * k / pieces;
        move_to(w, from, high);
        if (!any_reversed(model, before, w.s.q)) {
            before = w.s.q;
            continue;
        }
        for (int n = 0; n < halvings; ++n) {
            const double middle = (low + high) / 2;
            move_to(w, from, middle);
            (any_reversed(model, before, w.s.q) ? high : low) = middle;
        }
        move_to(w, from, low);
        return low;
    }
    w.go_to(a);  // no element reverses: one has only rotated far
    w.s.q = end;
    w.s.lambda = lambda_end;
    return std::nullopt;
}

}  // namespace elastocheck::recursive::series
