#include "recursive/singularity/error_bound.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include "recursive/stepping/settle.hpp"
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/step_check.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive {
namespace {

using Real = long double;

constexpr int corrections = 12;  // at most; the corrections fall quadratically
constexpr int multipliers = 3;   // initial solves for λ alone

// Largest displacement of an origin and largest rotation over all bodies.
struct Size {
    Real length = 0, angle = 0;
};
template <class Motion>
Size size_of(const Motion& dq) {
    Size size;
    for (Eigen::Index b = 0; b < dq.size() / 6; ++b) {
        size.length = std::max(size.length, dq.template segment<3>(6 * b).norm());
        size.angle = std::max(size.angle, dq.template segment<3>(6 * b + 3).norm());
    }
    return size;
}

struct ErrorEstimator {
    SteppingState<Real> s;
    bool turns_back;
    Vector<Real> lambda;
    int orientation = 0;  // of the first point
    double first_stiffness = 0;
    Matrix<Real> softest = {};
    bool begun = false;
    std::optional<Node<Real>> last_found = {};  // on the branch
    Real noise = 0;                             // rounding of the evaluated forces, as |W⁻¹ f|

    ErrorEstimator(const Model& model, const Branch& branch, const Analysis& analysis, bool back)
        : s(model, branch, analysis), turns_back(back), lambda(Vector<Real>::Zero(s.m())) {
        s.consistent = true;
    }

    // The Newton correction at (q, λ), left in s.x.
    Outcome correct(const State<Real>& q) {
        if (const Outcome outcome = factorise_at(s, q, lambda); outcome != Outcome::converged)
            return outcome;
        residual_at(s, q, lambda);
        back_substitute(s);
        return s.x.allFinite() ? Outcome::converged : Outcome::not_finite;
    }

    // R: effect of rounding on a correction with the factors in the system.
    Size rounding(const State<Real>& q) {
        const int n = s.n(), m = s.m();
        Vector<Real> c(n + m), e = Vector<Real>::Zero(n + m);
        for (BodyId b = 0; b < q.bodies(); ++b) {
            c.segment<3>(6 * b).setConstant(q[b].r.norm() + static_cast<Real>(s.length));
            c.segment<3>(6 * b + 3).setConstant(1);
        }
        c.tail(m) = lambda.cwiseAbs();
        for_each_entry(s.system.M, [&](int i, int j, int at) {
            e[i] += std::abs(s.system.M.values[static_cast<std::size_t>(at)]) * c[j];
        });
        external_force<Real>(s.model, s.branch, s.inputs, q, s.force);
        e.head(n) += s.force.cwiseAbs();
        e *= 4 * std::numeric_limits<Real>::epsilon();
        noise = e.head(n).cwiseQuotient(s.system.weight.head(n)).norm();
        Size worst;
        for (int probe = 0; probe < 3; ++probe) {
            Vector<Real> signed_e = e;
            for (Eigen::Index k = 0; k < n + m; ++k)
                if (scattered<Real>(k + probe * (n + m)) < 0) signed_e[k] = -signed_e[k];
            s.upper = signed_e.head(n);
            s.lower = signed_e.tail(m);
            back_substitute(s);
            const Size size = size_of(s.x.head(n));
            worst = {std::max(worst.length, size.length), std::max(worst.angle, size.angle)};
        }
        return worst;
    }

    // Newton's method from q to the nearby equilibrium, and the bound on that distance; λ is found
    // first by `solves` solves for λ alone.
    ErrorBound bound(State<Real>& q, int solves) {
        const ErrorBound none;
        for (int k = 0; k < solves; ++k) {
            if (correct(q) != Outcome::converged) return none;
            lambda += s.x.tail(s.m());
        }
        Size moved, last, rounded;
        Real before = std::numeric_limits<Real>::infinity();
        bool arrived = false;
        for (int k = 0; k < corrections && !arrived; ++k) {
            if (correct(q) != Outcome::converged) return none;
            const Real size = std::sqrt(size_of_solution(s));
            last = size_of(s.x.head(s.n()));
            if (!(last.angle <= Real(guard::largest_turn))) return none;
            s.dq = s.x.head(s.n());
            advance(q, s.dq);
            lambda += s.x.tail(s.m());
            moved = {moved.length + last.length, moved.angle + last.angle};
            rounded = rounding(q);
            arrived = size <= rounded.length + static_cast<Real>(s.length) * rounded.angle;
            if (!arrived && !(size <= before / 2)) return none;
            before = size;
        }
        if (!arrived) return none;
        if (orientation == 0) orientation = s.system.lu.orientation;
        if (!turns_back && s.system.lu.orientation != orientation) return none;
        // The border may carry what the equations do not satisfy: a load on an idle mode,
        // inconsistent joints.
        residual_at(s, q, lambda);
        const Real open = s.lower.norm(), left = size_of_force(s, s.upper);
        external_force<Real>(s.model, s.branch, s.inputs, q, s.applied);
        elastic_force<Real>(s.model, s.inputs, q, s.force);
        const Real acts = size_of_force(s, s.applied) + size_of_force(s, s.force);
        if (!(open <= std::max<Real>(1, static_cast<Real>(s.length)) * input_precision(s, q)) ||
            !(left <= 1e-9L * acts + noise))
            return none;
        // A pose is written down with the digits of a double.
        constexpr Real digits = std::numeric_limits<double>::epsilon();
        return {
            static_cast<double>(moved.length + last.length + 3 * rounded.length + open +
                                digits * reach(q)),
            static_cast<double>(moved.angle + last.angle + 3 * rounded.angle + open + 4 * digits)};
    }

    // Remaining stiffness over that at the first point; where forces have no energy, with the sign
    // of the determinant. A negative stiffness of an idle mode replaces it.
    double stiffness_left(const State<Real>& q) {
        if (s.free <= 0) return 1;
        const LeastStiffness least = least_stiffness(s, softest);
        const double sign = least.of_energy || s.system.lu.orientation == orientation ? 1 : -1;
        if (first_stiffness == 0) first_stiffness = least.value;
        const double idle = negative_idle_stiffness(s, q, lambda);
        return (idle < 0 ? idle : sign * least.value) / first_stiffness;
    }

    ContinuationSettings<Real> settings() const {
        constexpr Real near = 1e-4L;  // of L, or rad: tolerance of the corrector along the branch
        return {Drive::rate, near * static_cast<Real>(s.length), near};
    }
    // Continuation from the last equilibrium on the branch to a; q returns the result.
    bool follow(Real a, State<Real>& q) {
        constexpr int shortest = 4096;  // step, as a fraction of the interval
        Vector<Real> curvature = Vector<Real>::Zero(s.n()),
                     lambda_curvature = Vector<Real>::Zero(s.m());
        Node<Real> here = *last_found, next = here;
        const Real interval = a - here.p;
        for (Real h = interval; here.p != a;) {
            next.p = std::abs(h) < std::abs(a - here.p) ? here.p + h : a;
            const Real tried = next.p - here.p;
            if (try_step(s, settings(), here, curvature, lambda_curvature, next).verdict ==
                    Verdict::accepted &&
                is_straight(s, settings(), here, next)) {
                curvature = (next.dq - here.dq) / tried;
                lambda_curvature = (next.dlambda - here.dlambda) / tried;
                std::swap(here, next);
                h = 2 * tried;
            } else if (h = tried / 4; !(std::abs(h) * shortest >= std::abs(interval))) {
                return false;
            }
        }
        q = here.q;
        lambda = here.lambda;
        return true;
    }
    // Distance between two configurations, except of the bodies in `without` (empty: all bodies
    // count).
    static ErrorBound distance(const State<Real>& from, const State<Real>& to,
                               const std::vector<bool>& without) {
        Real length = 0, angle = 0;
        for (BodyId b = 0; b < to.bodies(); ++b) {
            if (!without.empty() && without[static_cast<std::size_t>(b)]) continue;
            length = std::max(length, (to[b].r - from[b].r).norm());
            const Eigen::Quaternion<Real> turn = to[b].p * from[b].p.conjugate();
            angle = std::max(angle, 2 * std::atan2(turn.vec().norm(), std::abs(turn.w())));
        }
        return {static_cast<double>(length), static_cast<double>(angle)};
    }
    // The bodies that an idle mode moves.
    std::vector<bool> idle_bodies() const {
        std::vector<bool> idle(static_cast<std::size_t>(s.n() / 6));
        const Held<Real>& held = s.system.held;
        for (int e = 0; held.idle > 0 && e < held.end(held.idle - 1); ++e) {
            const auto at = static_cast<std::size_t>(e);
            if (std::abs(held.value[at]) > Real(1e-6))
                idle[static_cast<std::size_t>(held.row[at] / 6)] = true;
        }
        // If every body is idle, all are compared.
        return std::ranges::find(idle, false) == idle.end() ? std::vector<bool>{} : idle;
    }
    // Settles to the start of the branch.
    void begin() {
        begun = true;
        if (turns_back || settle(s) != Outcome::converged) return;
        lambda = s.lambda;
        last_found = Node<Real>{s.q, lambda, {}, {}, 0, 0};
        differentiate(s, settings(), *last_found);
    }

    // Pre: q is near the equilibrium that the branch leads to. Returns q at that equilibrium.
    ErrorBound bound_on_branch(const Equilibrium& point, State<Real>& q) {
        const State<Real> from = state_of<Real>(point.poses);
        if (s.system.held.idle > 0) {
            // The bound does not cover idle modes, whose amplitude on the branch differs from the
            // point's. Newton's method therefore starts at the point, if it leads to the
            // equilibrium of the branch.
            State<Real> near = from;
            const Vector<Real> lambda_there = lambda;
            const ErrorBound bound_near = bound(near, 0), apart = distance(q, near, idle_bodies());
            if (std::isfinite(bound_near.length) &&
                apart.length <= static_cast<double>(settings().length_tolerance) &&
                apart.angle <= static_cast<double>(settings().angle_tolerance)) {
                q = near;
                return bound_near;
            }
            lambda = lambda_there;
        }
        const ErrorBound left = bound(q, 0), off = distance(from, q, {});
        return {off.length + left.length, off.angle + left.angle};
    }

    // Bounds the distance from the equilibrium of the branch: Newton's method from the point itself
    // may find another one. For a path that turns back the points are the only information.
    void operator()(Equilibrium& point) {
        if (!begun) begin();
        const auto a = static_cast<Real>(point.load);
        State<Real> q = state_of<Real>(point.poses);
        const bool led = last_found && !turns_back && follow(a, q);
        go_to(s, {1, a});
        if (led)
            point.bound = bound_on_branch(point, q);
        else
            point.bound = turns_back ? bound(q, multipliers) : ErrorBound{};
        if (std::isfinite(point.bound.length)) {
            point.stiffness_left = stiffness_left(q);
            last_found = Node<Real>{q, lambda, {}, {}, a, 0};
            differentiate(s, settings(), *last_found);
        } else if (orientation != 0) {
            q = state_of<Real>(point.poses);
            lambda.setZero();
            if (correct(q) == Outcome::converged) point.stiffness_left = stiffness_left(q);
        }
    }
};

}  // namespace

std::function<void(Equilibrium&)> error_estimator(const Model& model, const Branch& branch,
                                                  const Analysis& analysis, bool turns_back) {
    return [kept = std::make_shared<ErrorEstimator>(model, branch, analysis, turns_back)](
               Equilibrium& point) { (*kept)(point); };
}

}  // namespace elastocheck::recursive
