// Certifies a point. The tolerance fixes the claim before anything is computed; then
//
//   Newton's method in doubles    from the state to ỹ, and factors of F'(ỹ), for Y ≈ F'(ỹ)⁻¹
//   smallest box that passes      [y] = ỹ ± r, |Y F(ỹ)| + |I - Y F'([y])| r < r: contains one zero,
//                                 at a bounded distance from the state
//   large box that passes         contains no other zero
//   box of the tolerance          if the first box fails: y·F over all that is within the
//                                 tolerance, for each row y of Y; if one of these cannot be zero,
//                                 there is no zero
#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "reference/certificate/certificate.hpp"
#include "reference/certificate/krawczyk.hpp"
#include "reference/certificate/proved_box.hpp"
#include "reference/certificate/stability.hpp"
#include "reference/certificate/state.hpp"

namespace elastocheck::reference::certificate {

const char* name(ProofState state) {
    switch (state) {
        case ProofState::proved: return "proved";
        case ProofState::excluded: return "excluded";
        case ProofState::open: return "open";
    }
    return "unknown";
}

namespace {

using Eigen::Index;
using Eigen::VectorXd;

// ---- The smallest box

struct Box {
    bool proved = false;
    VectorXd r;
    SparseRows<Interval> J;  // Jacobian over the box, or one somewhat larger
    Eigen::MatrixXd Y;       // not of a large system
    Contraction rest;        // r -> bound of |I - Y J| r; not of a large system
    bool sampled = false;    // J is over poses within `sample`
    // of a large system: t of the large box without another equilibrium
    double uniqueness_size = 0;
};
// All origins within t L and all quaternions within t, or the radii r where these are larger.
VectorXd poses_within(const System& system, double t, VectorXd r) {
    for (int b = 0; b < system.bodies; ++b) {
        auto place = r.segment<3>(system.pose(b));
        auto turn = r.segment<4>(system.pose(b) + 3);
        place = place.cwiseMax(t * system.length);
        turn = turn.cwiseMax(t);
    }
    return r;
}
// Searches r with |Y F(ỹ)| + |I - Y F'(ỹ ± r)| r < r, from r = 1.5 |Y F(ỹ)| on (`defect`). First
// with F' over poses within `sample`, which shows how F' varies; rarely, near a knot, that is too
// far. If a box does not pass, the next one is larger, with Y the inverse of the middle of its
// Jacobian: across the knot of a stop that differs from the inverse at ỹ. `least` keeps
// r above 0, as the strict inequality needs.
constexpr double sample = 1e-10;
Box smallest_box(const Problem& problem, const Approximate& approximate, double a) {
    constexpr int trials = 8, iterations = 4;
    constexpr double least = 1e-20;
    const Values<Interval> F = residual(problem, thin(approximate.y), Interval(a));
    Box result;
    result.Y = inverse(approximate.J);
    VectorXd defect = defect_bound(result.Y, F);
    if (!defect.allFinite()) return result;
    result.r = (1.5 * defect).cwiseMax(least);
    for (int trial = -1; trial < trials && !result.proved; ++trial) {
        const VectorXd over = trial < 0 ? poses_within(problem.system, sample, result.r) : result.r;
        result.J = evaluate(problem, box(approximate.y, over), Interval(a), Slopes::yes).J;
        if (trial > 0) {
            result.Y = inverse(factors(middle(result.J)));
            defect = defect_bound(result.Y, F);
            if (!defect.allFinite()) return result;
        }
        const Contraction& rest = result.rest = contraction(result.Y, result.J);
        if (!rest.finite && trial < 0) continue;
        if (!rest.finite) return result;
        // First by fixed-point iteration, which suffices where F' hardly changes; then by
        // a linear solve.
        VectorXd r;
        if (trial <= 0) {
            VectorXd from = result.r;
            for (int k = 0; k < iterations && r.size() == 0; ++k) {
                const VectorXd to = (defect + rest(from)) * (1 + 1e-14);
                if (all_less(to, from)) r = from;
                from = (1.01 * to).cwiseMax(least);
            }
        } else {
            r = passing_radii(defect, rest);
        }
        if (r.size() > 0 && (r.array() <= result.r.array()).all()) {
            result.r = r;
            result.proved = true;
            result.sampled = trial < 0;
        } else if (trial >= 0) {
            result.r = r.size() > 0 ? (2 * r).cwiseMax(result.r).eval() : 4 * result.r;
            if (!result.r.allFinite()) return result;
        }
    }
    return result;
}

// ---- Large box for uniqueness

// No other zero has poses in a large box [p] where |I - Y S| v < v for some v > 0, S ∈ F'([p], R*)
// with the reactions of the small box (derivation.md, "Unique").
//
// Smallest max_i (|I - Y S| v)_i / v_i found by power iteration, which starts at v and leaves its
// last vector there: over a box of another size I - Y S is about a multiple of this one, so that v
// is a good start for it too. Below 1 the box contracts; below `enough` the search ends.
double contraction_ratio(const Contraction& rest, VectorXd& v, double enough = 0.9) {
    constexpr int iterations = 40, at_least = 5;
    const VectorXd start = v;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; rest.finite && k < iterations; ++k) {
        const VectorXd w = rest(v);
        if (!w.allFinite()) break;
        const double last = least;
        least = std::min(least, (w.array() / v.array()).maxCoeff() * (1 + 1e-14));
        if (least <= enough || (k > at_least && least > 0.98 * last)) break;
        // of the size of the start: a ratio of 1e-8 would underflow
        v = (w / (w.array() / start.array()).maxCoeff()).cwiseMax(1e-9 * start);
    }
    return least;
}

struct Sizes {
    const VectorXd& small;  // r of the small box
    double t;
};
// Jacobian over poses within t of ỹ (origins within t L), reactions and μ within the small box.
SparseRows<Interval> over_large_box(const Problem& problem, const VectorXd& centre, double a,
                                    const Sizes& sizes) {
    const System& system = problem.system;
    std::vector<Interval> y = box(centre, poses_within(system, sizes.t, sizes.small));
    if (!system.separated.empty()) {
        const auto x = deformations(system, {y.begin(), y.begin() + system.n()}, Interval(a));
        for (std::size_t k = 0; k < system.separated.size(); ++k)
            y[static_cast<std::size_t>(system.deformation(k))] =
                x[system.separated[k].element][system.separated[k].axis];
    }
    return evaluate(problem, y, Interval(a), Slopes::yes).J;
}

// Largest t found for which the box of origins within t L and quaternions within t of ỹ contracts;
// 0 if none does. Y is the inverse at ỹ, and where that fails the inverse at the middle of the
// Jacobian. contraction_ratio() grows about in proportion to t, from the sampled box on, so that t aims
// at a ratio of 0.99.
double uniqueness_size(const Problem& problem, const VectorXd& centre, double a,
                       const Box& smallest) {
    const VectorXd& small = smallest.r;
    constexpr int trials = 8;
    constexpr double largest = 0.05, enough = 0.85, aim = 0.99, corner = 0.2;
    double t = 2e-3, proved_t = 0, failed_t = std::numeric_limits<double>::infinity();
    VectorXd v = poses_within(problem.system, t, small);
    if (smallest.sampled)
        t = std::min(largest, aim * sample / contraction_ratio(smallest.rest, v, 0));
    for (int trial = 0; trial < trials; ++trial) {
        const SparseRows<Interval> J = over_large_box(problem, centre, a, {small, t});
        double ratio = contraction_ratio(contraction(smallest.Y, J), v);
        if (!(ratio < 1)) ratio = contraction_ratio(contraction(inverse(factors(middle(J))), J), v);
        if (ratio < 1) {
            proved_t = std::max(proved_t, t);
            t = std::min({largest, t * aim / std::max(ratio, 1e-3), 0.95 * failed_t});
            if (ratio > enough || t < 1.1 * proved_t) break;
        } else {
            // The new t is in proportion; not with a corner in the box, which must shrink until it
            // excludes the corner.
            const double longest = std::isfinite(failed_t) ? corner : aim,
                         shorter =
                             std::isfinite(ratio) ? std::clamp(aim / ratio, 0.01, longest) : 0.05;
            failed_t = std::min(failed_t, t);
            t *= shorter;
            if (t <= proved_t || t < 1e-13) break;
        }
    }
    return proved_t;
}

// ---- A system too large to keep its inverse

// Estimate of a radius that passes, from solutions with the factors alone, since |Y F| needs all
// rows of Y: the solution for the middle of F, and the root mean square of solutions for its radii
// with random signs.
VectorXd estimated_radius(const Factors& factors, const Values<Interval>& F) {
    constexpr int samples = 8;
    constexpr double safety_factor = 256;
    std::minstd_rand random;
    const auto sign = [&] { return random() % 2 == 0 ? 1. : -1.; };
    const Index n = factors.size();
    VectorXd f(n), squares = VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) f[i] = mid(F.E[static_cast<std::size_t>(i)]);
    for (int k = 0; k < samples; ++k) {
        VectorXd perturbation(n), rho = F.laws.rho;
        for (Index i = 0; i < n; ++i)
            perturbation[i] = sign() * rad(F.E[static_cast<std::size_t>(i)]);
        for (double& part : rho) part *= sign();
        for (const auto& [row, column, action] : F.laws.D)
            perturbation[row] += mid(action) * rho[column];
        squares += factors.solve(perturbation).cwiseAbs2();
    }
    return safety_factor * (factors.solve(f).cwiseAbs() + (squares / samples).cwiseSqrt());
}

// v > 0 for large boxes: 1 for each pose (L for its origin), and for the reactions and μ 1e-4 of
// the largest slope of a balance, so that no unknown dominates |I - Y S| v < v.
VectorXd balanced_scale(const System& system, const SparseMatrix& M, Index size) {
    const Index poses = 7 * system.bodies;
    double stiffest = 0;
    for (Index column = 0; column < poses; ++column)
        for (SparseMatrix::InnerIterator at(M, column); at; ++at)
            if (at.row() < 6 * system.bodies) stiffest = std::max(stiffest, std::abs(at.value()));
    VectorXd v = VectorXd::Constant(size, 1e-4 * std::max(stiffest, 1.));
    v.head(poses).setOnes();
    for (int b = 0; b < system.bodies; ++b) v.segment<3>(system.pose(b)).setConstant(system.length);
    return v;
}

// The smallest box and the large one in one pass over the rows of Y: the inequality for the first,
// and of many larger boxes the largest that contracts.
Box boxes_by_rows(const Problem& problem, const Approximate& approximate, double a) {
    constexpr int trials = 5, larger_boxes = 14;
    constexpr double least = 1e-20, largest = 2e-3, shorter = 0.25;
    const VectorXd& centre = approximate.y;
    const Values<Interval> F = residual(problem, thin(centre), Interval(a));
    Box result;
    result.r = estimated_radius(approximate.J, F).cwiseMax(least);
    for (int trial = 0; trial < trials && result.r.allFinite(); ++trial) {
        result.J = evaluate(problem, box(centre, result.r), Interval(a), Slopes::yes).J;
        std::vector<Split> J{split(result.J)};
        if (!J.front().finite) return result;
        std::vector<double> sizes;
        for (int k = 0; k < larger_boxes; ++k) {
            const double t = largest * std::pow(shorter, k);
            Split over = split(over_large_box(problem, centre, a, {result.r, t}));
            if (!over.finite) continue;
            J.push_back(recentred(over, J.front().M));
            sizes.push_back(t);
        }
        const VectorXd v = balanced_scale(problem.system, J.front().M, problem.size());
        Eigen::MatrixXd r = v.replicate(1, std::ssize(J));
        r.col(0) = result.r;
        const OverRows rows = over_rows(approximate.J, F, J, r);
        const VectorXd image = (rows.defect + rows.rest.col(0)) * (1 + 1e-14);
        if (!image.allFinite()) return result;
        if (!all_less(image, result.r)) {
            result.r = (1.5 * image).cwiseMax(result.r);
            continue;
        }
        for (std::size_t k = sizes.size(); k-- > 0;)
            if (all_less(rows.rest.col(static_cast<Index>(k) + 1), v))
                result.uniqueness_size = sizes[k];
        result.r = image.cwiseMax(least);
        result.proved = true;
        return result;
    }
    return result;
}

// The part around the state of the large box of size t about y; empty for t = 0.
Extent unique_around(const StateAt& mapped, const VectorXd& y, double t) {
    const System& system = mapped.system;
    Extent unique;
    if (t == 0) return {0, 0, 0, 0};
    const VectorXd off = (y.head(system.n()) - mapped.z).cwiseAbs();
    for (int b = 0; b < system.bodies; ++b) {
        const double length = t * system.length - off.segment<3>(system.pose(b)).maxCoeff(),
                     half = t - off.segment<4>(system.pose(b) + 3).maxCoeff();
        unique.length = std::min(unique.length, std::max(0., 0.999 * length));
        unique.angle = std::min(unique.angle, std::max(0., 0.999 * 2 * half));
    }
    return unique;
}

// ---- Exclusion: no equilibrium within the tolerance

// Every equilibrium within the tolerance has its z in z_s ± δ, with 0 = E(z_s) + E'([z]) (z - z_s)
// + ε. ε bounds the effect of the rounding of stored numbers: it moves the points of a strut off
// its axis, for example, and must not exclude an equilibrium. So for any y
//
//   |y E(z_s)| ≤ |y E'| δ + |y| |ε|
//
// and a y that violates this proves that there is none. The rows of Y are used for y: each isolates
// one unknown, the last ones the load on an idle motion or the gap of redundant rows.
bool is_excluded(const StateAt& mapped, const Tolerance& tolerance) {
    const System& system = mapped.system;
    const double load = mapped.state.load;
    const Index n = system.n();
    // The inequality holds for any y, so a large system needs no border.
    Border border = n > max_unknowns_of_curves
                        ? Border{Eigen::MatrixXd(n, 0), Eigen::MatrixXd(n, 0)}
                        : border_at(system, mapped.z, load, loose_zero_tolerance);
    const Problem problem{system, std::move(border), mapped.z, false, {}, {}};
    const Index k = problem.border.count();
    const VectorXd delta = radii(mapped, tolerance);
    if (!delta.head(7 * system.bodies).allFinite()) return false;
    const auto around_state = box(mapped.z, delta);
    if (delta.allFinite() && has_wrench_apart(mapped, around_state, tolerance)) return true;

    VectorXd y = VectorXd::Zero(n + k);
    y.head(n) = mapped.z;
    const Interval a = load;
    const Factors jacobian = factors(middle(evaluate(problem, doubles(y), load, Slopes::yes).J));
    const auto E = evaluate(system, thin(mapped.z), a, Slopes::no).E;
    const auto J = evaluate(system, around_state, a, Slopes::yes).J;
    const SparseMatrix slopes_of_E = middle(J);
    const VectorXd finite_delta = delta.cwiseMin(1e300);
    const VectorXd epsilon = rounding_of_equations(system, mapped.z, load);
    VectorXd middle_of_E(n);
    for (Index i = 0; i < n; ++i) middle_of_E[i] = mid(E[static_cast<std::size_t>(i)]);
    // Whether y violates the inequality, in intervals.
    const auto violates = [&](const auto& weights) {
        Interval left, right;
        std::vector<Interval> slopes(static_cast<std::size_t>(n));
        for (Index i = 0; i < n; ++i) {
            const Interval weight = weights[i];
            if (is_zero(weight)) continue;
            left += weight * (E[static_cast<std::size_t>(i)] + Interval(-epsilon[i], epsilon[i]));
            for (const auto& [row, column, slope] : J.row(i))
                slopes[static_cast<std::size_t>(column)] += weight * slope;
        }
        for (Index j = 0; j < n; ++j)
            right += Interval(mag(slopes[static_cast<std::size_t>(j)])) * Interval(delta[j]);
        return mig(left) > right.hi;
    };
    constexpr Index at_a_time = 64;
    for (Index from = 0; from < n + k; from += at_a_time) {
        const Eigen::MatrixXd Y =
            jacobian.rows_of_inverse(from, std::min(at_a_time, n + k - from)).leftCols(n);
        if (!Y.allFinite()) return false;
        // The inequality in doubles selects the rows for which it is evaluated in intervals.
        const VectorXd left = (Y * middle_of_E).cwiseAbs(),
                       right = product(Y, slopes_of_E).cwiseAbs() * finite_delta;
        for (Index row = 0; row < Y.rows(); ++row)
            if (left[row] > 0.5 * right[row] && violates(Y.row(row))) return true;
    }
    return false;
}

// Middle of the box as a state.
Equilibrium centre_of(const StateAt& mapped, const VectorXd& z) {
    const System& system = mapped.system;
    Equilibrium centre;
    centre.load = mapped.state.load;
    for (BodyId body = 0; body < system.bodies; ++body) {
        const int k = system.pose(body);
        centre.poses.push_back(
            {z.segment<3>(k) + system.c,
             Eigen::Quaterniond(z[k + 3], z[k + 4], z[k + 5], z[k + 6]).normalized()});
    }
    const auto vector = [](const Vec<double>& v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
    for (const auto& wrench : wrenches(system, doubles(z), mapped.state.load))
        centre.reactions.push_back({vector(wrench.force), vector(wrench.moment)});
    return centre;
}

// ---- Messages

// Names of the elements with a deformation whose enclosure contains a knot of its curve.
std::string on_knots(const System& system, const std::vector<Interval>& z, const Interval& a) {
    std::string names;
    const auto x = deformations(system, z, a);
    for (std::size_t e = 0; e < x.size(); ++e) {
        bool is_on_knot = false;
        each_curve(system.model->elastics[e].kind, [&](std::size_t k, const Curve& curve) {
            is_on_knot |= is_bounded(x[e][k]) && spans_knot(curve, x[e][k]);
        });
        if (is_on_knot)
            names +=
                fmt::format("{}'{}'", names.empty() ? "" : ", ", system.model->elastics[e].name);
    }
    return names;
}

void say(std::string& detail, const std::string& more) {
    if (more.empty()) return;
    if (!detail.empty()) detail += "; ";
    detail += more;
}

// ---- A state near a known box

// The known box at a; null where there is none.
const ProvedBox* box_at(const std::vector<ProvedBox>& known, const System& system, double a) {
    const auto at = std::ranges::find_if(known, [&](const ProvedBox& one) {
        return one.a == a && one.separated == !system.separated.empty();
    });
    return at == known.end() ? nullptr : &*at;
}

// The certificate of a state from a known box; none where the box does not decide about the state.
std::optional<Certificate> by_known_box(const ProvedBox& known, const StateAt& mapped,
                                        const Tolerance& tolerance) {
    const auto y = box(known.y, known.r);
    Certificate certificate = known.certificate;
    certificate.error = distance(mapped, {y.begin(), y.begin() + mapped.system.n()});
    if (is_within(certificate.error, tolerance)) {
        certificate.unique = unique_around(mapped, known.y, known.uniqueness_size);
        return certificate;
    }
    if (!is_excluded(mapped, tolerance)) return {};
    return Certificate{.state = ProofState::excluded,
                       .detail = fmt::format("the nearest equilibrium found is {} away",
                                             as_text(certificate.error)),
                       .error = certificate.error,
                       .unique = {0, 0, 0, 0},
                       .centre = certificate.centre};
}

Certificate certify(const System& system, const Equilibrium& state, const Tolerance& tolerance,
                    std::vector<ProvedBox>& known) {
    const StateAt mapped = state_at(system, state);
    Certificate certificate;
    certificate.unique = {0, 0, 0, 0};
    const auto open = [&](const std::string& why) {
        certificate.detail = why;
        return certificate;
    };
    if (!mapped.z.allFinite() || !std::isfinite(state.load)) return open("the state is not finite");
    if (const auto why = why_not_tried(system, tolerance.max_unknowns); !why.empty())
        return open(why);
    if (const ProvedBox* near = box_at(known, system, state.load))
        if (auto decided = by_known_box(*near, mapped, tolerance)) return *std::move(decided);

    auto [problem, approximate, border_check] = equilibrium_near(system, mapped.z, state.load);
    const Interval a = state.load;
    if (problem.border.too_large)
        return open(
            fmt::format("not tried: {} unknowns, with idle motions, redundant joints or a "
                        "stiffness close to singular",
                        system.n()));

    if (approximate.settled && approximate.y.allFinite()) {
        const bool large = problem.size() > max_unknowns_of_curves;
        const Box small_box = large ? boxes_by_rows(problem, approximate, state.load)
                                    : smallest_box(problem, approximate, state.load);
        if (small_box.proved) {
            const VectorXd& r = small_box.r;
            const auto enclosure = box(approximate.y, r);
            const std::vector<Interval> z(enclosure.begin(), enclosure.begin() + system.n());
            certificate.error = distance(mapped, z);
            certificate.centre = centre_of(mapped, approximate.y.head(system.n()));
            const VectorXd mu = (approximate.y.tail(problem.border.count()).cwiseAbs() +
                                 r.tail(problem.border.count()));
            const Held held = held_by(system, problem.border, mu);
            certificate.held = held.held;
            certificate.gap = held.gap;
            const bool balanced = border_check.sound && certificate.held <= tolerance.held &&
                                  certificate.gap <= tolerance.gap;
            if (is_within(certificate.error, tolerance) && balanced) {
                certificate.state = ProofState::proved;
                const double t =
                    large ? small_box.uniqueness_size
                          : uniqueness_size(problem, approximate.y, state.load, small_box);
                certificate.unique = unique_around(mapped, approximate.y, t);
                certificate.stable =
                    is_stable(problem, z, small_box.J) ||
                    (small_box.sampled &&
                     is_stable(problem, z, evaluate(problem, enclosure, a, Slopes::yes).J));
                certificate.detail = statement(system, problem.border, held, "state");
                if (const auto knots = on_knots(system, z, a); !knots.empty())
                    say(certificate.detail,
                        fmt::format(
                            "{} on a knot of its curve, whose pieces are assumed to meet there",
                            knots));
                if (problem.border.count() == 0)
                    known.push_back(
                        {state.load, !system.separated.empty(), approximate.y, r, t, certificate});
                return certificate;
            }
        }
    }
    if (is_excluded(mapped, tolerance)) {
        certificate.state = ProofState::excluded;
        if (std::isfinite(certificate.error.length))
            certificate.detail = fmt::format(
                "the nearest equilibrium found{} is {} away",
                problem.border.count() > problem.border.redundant
                    ? fmt::format(", with the idle motion of {} at its position in the state,",
                                  idle_bodies(system, problem.border))
                    : "",
                as_text(certificate.error));
        else
            certificate.detail = "no equilibrium is found near the state either";
        if (border_check.idle_motion_loaded)
            say(certificate.detail,
                fmt::format("the idle motion of {} is loaded by {:.2g} N or N·m",
                            idle_bodies(system, problem.border), certificate.held));
        if (border_check.redundant_row_gap)
            say(certificate.detail,
                fmt::format("joints {} have a gap of {:.2g} m or rad",
                            redundant_joints(system, problem.border), certificate.gap));
        return certificate;
    }
    if (!approximate.settled) return open("Newton's method does not converge near the state");
    if (!std::isfinite(certificate.error.length))
        return open(
            "Krawczyk's operator contracts in no box: the stiffness is too close to singular for "
            "double precision, or a law ends here");
    if (is_within(certificate.error, tolerance))
        return open(fmt::format(
            "a state is proved within {} that needs {:.2g} N or N·m on an idle motion and "
            "a gap of {:.2g} m or rad in redundant joints; allowed: {:.2g}, {:.2g}",
            as_text(certificate.error), certificate.held, certificate.gap, tolerance.held,
            tolerance.gap));
    return open(fmt::format(
        "an equilibrium is proved within {}, beyond the tolerance; that none is within the "
        "tolerance could not be proved",
        as_text(certificate.error)));
}

}  // namespace

Certificate certify(const Model& model, const Branch& branch, const Equilibrium& state,
                    const Tolerance& tolerance) {
    std::vector<ProvedBox> none;
    return certify(model, branch, state, tolerance, none);
}

Certificate certify(const Model& model, const Branch& branch, const Equilibrium& state,
                    const Tolerance& tolerance, std::vector<ProvedBox>& known) {
    Certificate certificate = certify(make_system(model, branch), state, tolerance, known);
    if (certificate.state == ProofState::excluded || certificate.stable) return certificate;
    // At the corner of a stiff stop, intervals lose that the slopes of an element vary together
    // (derivation.md, "Curves of laws").
    const System system = make_system(model, branch, Curves::separated);
    if (system.separated.empty()) return certificate;
    Certificate separated = certify(system, state, tolerance, known);
    return separated.state == ProofState::open ? certificate : separated;
}

}  // namespace elastocheck::reference::certificate
