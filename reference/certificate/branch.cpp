// Verified continuation of a branch: polynomial pieces through its equilibria, each with a tube
// that contains exactly one equilibrium at every a. With s ∈ [-1, 1] along a piece from a₀ to a₁,
//
//   a(s) = ½(1-s) a₀ + ½(1+s) a₁
//   ȳ(s) = ½(1-s) y₀ + ½(1+s) y₁ + (1-s²)(q₀ + q₁ s + q₂ s² + q₃ s³)
//
// which is exactly y₀ and y₁ at its ends for any q. For every s (Krawczyk 1969, with
// Y(s) = Y₀ + Y₁ s),
//
//   |Y(s) F(ȳ(s); a(s))| + |I - Y(s) F'(ȳ(s) + [-r, r]; a(s))| r < r
//
// gives one zero y*(s) within r of ȳ(s), which is continuous in s: a curve. F and F' are
// represented along the piece by their Taylor coefficients about s = 0, the last one over all of
// [-1, 1]; Y₁ = -Y₀ J₁ Y₀ follows F' to first order.
//
// Gluing: a₀, a₁ are doubles and y₁ is the y₀ of the next piece, the border is one for the whole
// branch, and the gauge holds idle motions at gᵀ(z - z̄(s)) = 0, which is the same at the common
// end of two pieces. There a separate box, far smaller than the tubes and within both, contains one
// zero, which is that of both.
//
// Across a knot of a curve F has no second derivative. Pieces shrink towards the knot until one is
// short enough to use the slopes of both sides: F(ȳ(s)) ∈ F(ȳ(0)) + s [slopes], and F' is one
// interval matrix M ± R, which contracts at a corner of any stiffness because the law is separated
// (derivation.md, "Curves of laws"). r is then (I - |Y| R)⁻¹ times the part to be covered.
#include <fmt/format.h>

#include "models/parameter_unit.hpp"
#include "reference/certificate/certificate.hpp"
#include "reference/certificate/krawczyk.hpp"
#include "reference/certificate/state.hpp"

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int digits = 12;  // of the parameter in messages

// ---- Interpolation of the states: start of Newton's method, and position of idle motions

// Cubic Hermite interpolation of the states z(a), with slopes dz/da from their neighbours.
struct Interpolant {
    std::vector<double> a;
    std::vector<VectorXd> z, slope;
};
Interpolant interpolant(const std::vector<StateAt>& states) {
    Interpolant result;
    for (const StateAt& mapped : states) {
        VectorXd z = mapped.z;
        // The sign of the quaternion that continues the previous one.
        for (int b = 0; b < mapped.system.bodies && !result.z.empty(); ++b) {
            auto p = z.segment<4>(mapped.system.pose(b) + 3);
            if (p.dot(result.z.back().segment<4>(mapped.system.pose(b) + 3)) < 0) p = -p.eval();
        }
        result.a.push_back(mapped.state.load);
        result.z.push_back(std::move(z));
    }
    const std::size_t last = result.a.size() - 1;
    const auto between = [&](std::size_t k) -> VectorXd {
        return (result.z[k + 1] - result.z[k]) / (result.a[k + 1] - result.a[k]);
    };
    for (std::size_t k = 0; k <= last; ++k) {
        if (last < 2) {
            result.slope.push_back(between(0));
            continue;
        }
        // Slope of the parabola through three points.
        const std::size_t m = std::clamp<std::size_t>(k, 1, last - 1);
        const VectorXd left = between(m - 1), right = between(m);
        const VectorXd bend = (right - left) / (result.a[m + 1] - result.a[m - 1]);
        result.slope.push_back(left + bend * (2 * result.a[k] - result.a[m - 1] - result.a[m]));
    }
    return result;
}
struct Predicted {
    VectorXd z, slope;  // z and dz/da
};
Predicted predicted(const Interpolant& states, double a) {
    const bool rising = states.a.back() > states.a.front();
    std::size_t k = 0;
    while (k + 2 < states.a.size() && (rising ? a > states.a[k + 1] : a < states.a[k + 1])) ++k;
    const double h = states.a[k + 1] - states.a[k], t = (a - states.a[k]) / h;
    if (t == 0) return {states.z[k], states.slope[k]};
    if (t == 1) return {states.z[k + 1], states.slope[k + 1]};
    const double u = 1 - t;
    return {states.z[k] * (u * u * (1 + 2 * t)) + states.z[k + 1] * (t * t * (1 + 2 * u)) +
                (states.slope[k] * (t * u * u) - states.slope[k + 1] * (t * t * u)) * h,
            (states.z[k + 1] - states.z[k]) * (6 * t * u / h) +
                states.slope[k] * (u * (1 - 3 * t)) + states.slope[k + 1] * (t * (3 * t - 2))};
}

// An equilibrium at a, found by Newton's method, with its inverse and its tangent dy/da.
struct Node {
    double a = 0;
    VectorXd y, rate;
    MatrixXd Y;
    bool found = false;
    VectorXd box;  // radii of a box that contains the equilibrium, if computed
};

struct NodeSolver {
    const System& system;
    const Interpolant& states;
    Border border;

    // Interpolated between the states; x and f of curves from the poses.
    Predicted guess(double a) const {
        Predicted result = predicted(states, a);
        set_separated(system, result.z, a);
        return result;
    }
    Problem problem(const VectorXd& z_g) const { return {system, border, z_g, false, {}, {}}; }

    Node node(double a) const {
        const Predicted guess = this->guess(a);
        const Problem bordered = problem(guess.z);
        VectorXd y = VectorXd::Zero(bordered.size());
        y.head(bordered.n()) = guess.z;
        Node node;
        node.a = a;
        Approximate solution = newton(bordered, y, a);
        if (!solution.settled) return node;
        node.y = std::move(solution.y);
        const Values<double> values = evaluate(bordered, doubles(node.y), a, Slopes::yes);
        node.Y = inverse(factors(middle(values.J)));
        VectorXd right(bordered.size());
        right << -Eigen::Map<const VectorXd>(values.E_a.data(), bordered.n()),
            border.g.transpose() * guess.slope;
        node.rate = node.Y * right;
        node.found = node.y.allFinite() && node.rate.allFinite();
        return node;
    }
    bool is_sound(const Node& node) const {
        return check_border(problem(node.y.head(system.n())), node.y, node.a).sound;
    }
};

// ---- One piece

struct Piece {
    double a0 = 0, a1 = 0;
    VectorXd y0, y1;
    std::array<VectorXd, 4> q;
    VectorXd r;  // of the tube
};

// The values and the slopes h dy/da of the three nodes determine q(-1), q(0), q'(0) and q(1).
Piece quintic(const Node& from, const Node& middle, const Node& to) {
    const double h = to.a / 2 - from.a / 2;
    const VectorXd d = (to.y - from.y) / 2, q_from = (h * from.rate - d) / 2,
                   q_to = (d - h * to.rate) / 2;
    Piece piece{from.a, to.a, from.y, to.y, {}, {}};
    piece.q[0] = middle.y - (from.y + to.y) / 2;
    piece.q[1] = h * middle.rate - d;
    piece.q[2] = (q_to + q_from) / 2 - piece.q[0];
    piece.q[3] = (q_to - q_from) / 2 - piece.q[1];
    return piece;
}
Piece straight(const Node& from, const Node& to) {
    const VectorXd none = VectorXd::Zero(from.y.size());
    return {from.a, to.a, from.y, to.y, {none, none, none, none}, {}};
}

// Coefficients of component i of ȳ in powers of s: the terms of ȳ above, expanded.
std::array<Interval, 6> powers(const Piece& piece, Index i) {
    const Interval y0 = piece.y0[i], y1 = piece.y1[i], half = 0.5;
    const auto q = [&](std::size_t k) { return Interval(piece.q[k][i]); };
    return {
        (y0 + y1) * half + q(0), (y1 - y0) * half + q(1), q(2) - q(0), q(3) - q(1), -q(2), -q(3)};
}

// Taylor coefficients about all s in S at once.
template <int n>
Jet<n> expanded(std::array<Interval, 6> p, const Interval& S) {
    Jet<n> jet;
    for (std::size_t k = 0; k < jet.c.size(); ++k) {
        if (k >= p.size()) break;
        // Horner's scheme: leaves p(S), and divides by s - S.
        for (std::size_t j = p.size() - 1; j-- > k;) p[j] = p[j] + p[j + 1] * S;
        jet.c[k] = p[k];
    }
    return jet;
}
template <int n>
std::vector<Jet<n>> along(const Piece& piece, const Interval& S, const VectorXd* r) {
    std::vector<Jet<n>> y;
    for (Index i = 0; i < piece.y0.size(); ++i) {
        y.push_back(expanded<n>(powers(piece, i), S));
        if (r != nullptr) y.back().c[0] += Interval(-(*r)[i], (*r)[i]);
    }
    return y;
}
template <int n>
Jet<n> parameter(const Piece& piece, const Interval& S) {
    const Interval a0 = piece.a0, a1 = piece.a1, half = 0.5;
    return expanded<n>({(a0 + a1) * half, (a1 - a0) * half, 0., 0., 0., 0.}, S);
}

// Coefficient k of each entry.
template <int n>
SparseRows<Interval> coefficient(const SparseRows<Jet<n>>& J, std::size_t k) {
    SparseRows<Interval> part{{}, J.start};
    for (const auto& [row, column, value] : J.entries)
        part.entries.push_back({row, column, value.c[k]});
    return part;
}
// Taylor coefficients of F about s = 0, the last one over all s; the first one also has the laws.
// The gauge is zero along the piece by definition.
template <int n>
std::vector<Values<Interval>> coefficients(const Problem& problem, const Piece& piece) {
    const Interval middle = 0, whole_piece{-1, 1};
    Values<Jet<n>> F_middle =
        residual(problem, along<n>(piece, middle, nullptr), parameter<n>(piece, middle));
    const auto F_piece = evaluate_without_slopes(problem, along<n>(piece, whole_piece, nullptr),
                                                 parameter<n>(piece, whole_piece));
    std::vector<Values<Interval>> F(static_cast<std::size_t>(n) + 1);
    for (std::size_t k = 0; k < F.size(); ++k) {
        for (const Jet<n>& entry : (k + 1 < F.size() ? F_middle : F_piece).E)
            F[k].E.push_back(entry.c[k]);
        std::fill(F[k].E.begin() + problem.n(), F[k].E.end(), Interval());
    }
    F.front().laws = std::move(F_middle.laws);
    return F;
}

// |Y(s) F| ≤ Σ |Y₀ F_k| + |Y₁ F_k|, as |s| ≤ 1.
VectorXd defect_bound(const std::vector<MatrixXd>& Y, const std::vector<Values<Interval>>& F) {
    VectorXd sum = VectorXd::Zero(Y.front().rows());
    for (const auto& part : F)
        for (const MatrixXd& factor : Y) sum += defect_bound(factor, part);
    return sum * (1 + 1e-14);
}

// |I - Y(s) F'| r from the coefficients Y_i of Y and J_j = M_j ± R_j of F':
//
//   |I - Y F'| ≤ Σ_k |[k = 0] I - Σ_{i+j=k} Y_i M_j| + Σ_i |Y_i| Σ_j (R_j + γ |M_j|),  γ: rounding
struct RestAlong {
    std::vector<MatrixXd> rest;  // per k, the first sum
    MatrixXd Y;                  // Σ |Y_i|
    std::vector<Split> J;        // |M_j|, R_j
    double gamma = 0;
    VectorXd operator()(const VectorXd& r) const {
        VectorXd sum = VectorXd::Zero(r.size()), remainder = sum;
        for (const MatrixXd& part : rest) sum += product_bound(part, r);
        for (const Split& part : J)
            remainder += product_bound(part.R, r) + gamma * product_bound(part.M, r);
        return (sum + product_bound(Y, remainder)) * (1 + 1e-13);
    }
};
RestAlong rest_along(const std::vector<MatrixXd>& Y, std::vector<Split> J) {
    const Index n = Y.front().rows();
    RestAlong result;
    result.Y = MatrixXd::Zero(n, n);
    for (const MatrixXd& factor : Y) result.Y += factor.cwiseAbs();
    for (std::size_t k = 0; k + 1 < Y.size() + J.size(); ++k) {
        MatrixXd sum = MatrixXd::Zero(n, n);
        if (k == 0) sum.setIdentity();
        for (std::size_t i = 0; i < Y.size(); ++i)
            if (k >= i && k - i < J.size()) sum -= product(Y[i], J[k - i].M);
        result.rest.push_back(sum.cwiseAbs());
    }
    for (Split& part : J) {
        // twice, since Σ_{i+j=k} Y_i M_j adds two products
        result.gamma = std::max(result.gamma, 2 * part.gamma);
        part.M = part.M.cwiseAbs();
    }
    result.J = std::move(J);
    return result;
}

// The tube may use half of the tolerance; the rest is for the states themselves.
bool is_within(const System& system, const VectorXd& r, const Tolerance& tolerance) {
    for (int b = 0; b < system.bodies; ++b)
        if (!(r.segment<3>(system.pose(b)).norm() < 0.5 * tolerance.length &&
              2 * r.segment<4>(system.pose(b) + 3).norm() < 0.5 * tolerance.angle))
            return false;
    return true;
}

// r with `correction` + rest(r) < r, by fixed-point iteration; empty if none is found. The factors
// 1.01 and 1.02 give the iteration some room above the fixed point; 1 + 1e-14 covers the rounding of
// the sum.
VectorXd tube_radii(const VectorXd& correction, const RestAlong& rest) {
    constexpr double min_radius = 1e-20;
    constexpr int max_iterations = 30;
    VectorXd r = correction.cwiseMax(min_radius) * 1.01;
    for (int k = 0; k < max_iterations; ++k) {
        const VectorXd next = ((correction + rest(r)) * 1.02).cwiseMax(min_radius);
        if (!next.allFinite()) return {};
        if (all_less((correction + rest(next)) * (1 + 1e-14), next)) return next;
        r = next.cwiseMax(r);
    }
    return {};
}

// Computes the box at the common end of two pieces, which is also its gauge.
void enclose(const NodeSolver& solver, Node& node) {
    if (node.box.size() > 0) return;
    const Problem problem = solver.problem(node.y.head(solver.system.n()));
    const Interval a = node.a;
    const Values<Interval> F = residual(problem, thin(node.y), a);
    MatrixXd Y = node.Y;
    VectorXd trial_radii = (3 * defect_bound(Y, F)).cwiseMax(1e-19);
    for (int trial = 0; trial < 4 && node.box.size() == 0 && trial_radii.allFinite(); ++trial) {
        const auto J = evaluate(problem, box(node.y, trial_radii), a, Slopes::yes).J;
        const Contraction rest = contraction(Y, J);
        if (!rest.finite) return;
        VectorXd r = passing_radii(defect_bound(Y, F), rest);
        if (r.size() == 0)
            // at a corner, where the inverse at ỹ belongs to one side
            Y = inverse(factors(middle(J)));
        else if ((r.array() <= trial_radii.array()).all())
            node.box = std::move(r);
        else
            trial_radii = 2 * r;
    }
}

// Sets the tube of a piece, with radii r > `min_radii`; false if it is not proved.
bool prove(const NodeSolver& solver, Piece& piece, const MatrixXd& Y0, const VectorXd& min_radii,
           const Tolerance& tolerance) {
    const Problem problem = solver.problem(VectorXd::Zero(solver.system.n()));
    constexpr int J_order = order<SlopesAlong>;
    const auto F = coefficients<order<Along>>(problem, piece);
    const VectorXd correction = defect_bound({Y0}, F);
    if (!correction.allFinite() || !is_within(solver.system, correction, tolerance)) return false;
    // Radii over which F' is evaluated; at least those of the tube to be proved.
    VectorXd trial_radii = (4 * correction).cwiseMax(min_radii).cwiseMax(1e-18);
    const auto slopes = [&](const Interval& S) {
        return evaluate(problem, along<J_order>(piece, S, &trial_radii),
                        parameter<J_order>(piece, S), Slopes::yes)
            .J;
    };
    for (int trial = 0; trial < 2; ++trial) {
        const auto J_middle = slopes(Interval(0)), J_piece = slopes(Interval(-1, 1));
        std::vector<Split> J;
        for (std::size_t k = 0; k <= J_order; ++k) {
            J.push_back(split(coefficient(k < J_order ? J_middle : J_piece, k)));
            if (!J.back().finite) return false;
        }
        const std::vector<MatrixXd> Y{Y0, -product(Y0, J[1].M) * Y0};
        piece.r = tube_radii(defect_bound(Y, F).cwiseMax(min_radii), rest_along(Y, std::move(J)));
        if (piece.r.size() == 0 || !is_within(solver.system, piece.r, tolerance)) return false;
        const auto R = piece.r.segment(7 * solver.system.bodies, solver.system.rows).array();
        if (!(R < 0.5 * std::min(tolerance.force, tolerance.moment)).all()) return false;
        if ((piece.r.array() <= trial_radii.array()).all()) return true;
        trial_radii = 2 * piece.r;
    }
    return false;
}

// Values of component i of ȳ along the piece.
Interval range_along(const Piece& piece, Index i) {
    return expanded<0>(powers(piece, i), Interval(-1, 1)).c[0];
}

// Whether the piece crosses a knot of a separated curve.
bool crosses_a_knot(const System& system, const Piece& piece) {
    for (std::size_t k = 0; k < system.separated.size(); ++k)
        if (spans_knot(std::get<Curve>(law_of(system, system.separated[k])),
                       range_along(piece, system.deformation(k))))
            return true;
    return false;
}

// prove() for a short piece across a knot of a law, with the slopes of both sides.
bool prove_over_knot(const NodeSolver& solver, Piece& piece, const VectorXd& min_radii,
                     const Tolerance& tolerance) {
    const Problem problem = solver.problem(VectorXd::Zero(solver.system.n()));
    const auto F = coefficients<1>(problem, piece);
    const auto slopes = [&](const VectorXd& trial_radii) {
        std::vector<Interval> y;
        for (const auto& jet : along<1>(piece, Interval(-1, 1), &trial_radii))
            y.push_back(jet.c[0]);
        return evaluate(problem, y, parameter<1>(piece, Interval(-1, 1)).c[0], Slopes::yes).J;
    };
    VectorXd trial_radii = min_radii;
    for (int trial = 0; trial < 4; ++trial) {
        const auto J = slopes(trial_radii);
        const MatrixXd Y = inverse(factors(middle(J)));
        if (!Y.allFinite()) return false;
        const VectorXd correction = defect_bound({Y}, F).cwiseMax(min_radii);
        if (!correction.allFinite() || !is_within(solver.system, correction, tolerance))
            return false;
        const Contraction rest = contraction(Y, J);
        if (!rest.finite) return false;
        const VectorXd r = passing_radii(correction, rest);
        if (r.size() == 0 || !is_within(solver.system, r, tolerance)) return false;
        if ((r.array() <= trial_radii.array()).all()) {
            piece.r = r;
            return true;
        }
        trial_radii = (2 * r).cwiseMax(trial_radii);
    }
    return false;
}

// ---- Statements about the curve

void keep_largest(Extent& largest, const Extent& extent) {
    largest.length = std::max(largest.length, extent.length);
    largest.angle = std::max(largest.angle, extent.angle);
    largest.force = std::max(largest.force, extent.force);
    largest.moment = std::max(largest.moment, extent.moment);
}

// Distance of the tube from the state at its a.
Extent distance(const Piece& piece, const StateAt& mapped) {
    const Interval a0 = piece.a0, a1 = piece.a1,
                   s = (Interval(2) * Interval(mapped.state.load) - a0 - a1) / (a1 - a0);
    std::vector<Interval> z;
    for (const auto& jet : along<0>(piece, intersection(s, Interval(-1, 1)), &piece.r))
        z.push_back(jet.c[0]);
    z.resize(static_cast<std::size_t>(mapped.system.n()));
    return distance(mapped, z);
}

// Upper bounds of U μ over the piece.
Held held_over(const NodeSolver& solver, const Piece& piece) {
    const Index k = solver.border.count(), n = solver.system.n();
    VectorXd mu = piece.r.tail(k);
    for (Index i = 0; i < k; ++i) mu[i] += mag(range_along(piece, n + i));
    return held_by(solver.system, solver.border, mu);
}

struct Section {  // two neighbouring nodes of the path, and the one halfway between them
    Node from, middle, to;
};
// Result of prove_section(): whether there is exactly one curve in the tube of the piece.
struct ProvedPiece {
    Piece piece;
    bool proved = false, over_knot = false;
    Held held = {};
    bool is_excessive = false;  // `held` or its gap exceeds the tolerance
};

// Proves one curve of equilibria from `from` to `to`, whose ends lie within the tube of the piece.
// `over_knots`: the piece is short enough to be straight across the knot of a law.
ProvedPiece prove_section(const NodeSolver& solver, Section& s, bool over_knots,
                          const Tolerance& tolerance) {
    ProvedPiece result;
    Piece& piece = result.piece;
    const auto ends_are_inside = [&] {
        return all_less(s.from.box, piece.r) && all_less(s.to.box, piece.r);
    };
    const auto attempt = [&](const VectorXd& min_radii) {
        if (s.to.found && s.middle.found) {
            piece = quintic(s.from, s.middle, s.to);
            result.proved = !crosses_a_knot(solver.system, piece) &&
                            prove(solver, piece, s.middle.Y, min_radii, tolerance);
        }
        result.over_knot = false;
        if (!result.proved && s.to.found && over_knots) {
            piece = straight(s.from, s.to);
            result.proved = result.over_knot = prove_over_knot(solver, piece, min_radii, tolerance);
        }
    };
    attempt(VectorXd::Zero(s.from.y.size()));
    if (result.proved) enclose(solver, s.to);
    if (result.proved && s.to.box.size() > 0 && !ends_are_inside())
        attempt(1.1 * s.from.box.cwiseMax(s.to.box));
    result.proved = result.proved && solver.is_sound(s.to);
    if (!result.proved) return result;
    result.held = held_over(solver, piece);
    result.is_excessive = result.held.held > tolerance.held || result.held.gap > tolerance.gap;
    result.proved = !result.is_excessive && s.to.box.size() > 0 && ends_are_inside();
    return result;
}

// Why no piece is proved past `place`.
std::string why_it_ends(const NodeSolver& solver, const Held& excess, const Tolerance& tolerance,
                        const std::string& place) {
    if (excess.held > tolerance.held)
        return fmt::format("past {} the idle motion of {} is loaded by up to {:.2g} N or N·m",
                           place, idle_bodies(solver.system, solver.border), excess.held);
    if (excess.gap > tolerance.gap)
        return fmt::format("past {} joints {} have a gap of up to {:.2g} m or rad", place,
                           redundant_joints(solver.system, solver.border), excess.gap);
    return fmt::format(
        "no piece is proved past {}: the branch turns back or bifurcates, or a law ends", place);
}

// Why the states are not a path; empty if they are.
std::string why_not_a_path(const std::vector<StateAt>& mapped, std::span<const Equilibrium> states,
                           const Branch& branch) {
    const double range = states.back().load - states.front().load;
    for (std::size_t k = 0; k < mapped.size(); ++k) {
        if (!mapped[k].z.allFinite() || !std::isfinite(states[k].load))
            return "a state is not finite";
        if (k > 0 && !((states[k].load - states[k - 1].load) * range > 0))
            return fmt::format("the states turn back at {}",
                               parameter_text(branch.unit, states[k].load, digits));
    }
    return {};
}

// Adds the width of a piece: its radius, and its distance from the states along it.
void widen(Tube& tube, const System& system, const Piece& piece, std::span<const StateAt> states) {
    Extent width{0, 0, 0, 0};
    for (const StateAt& state : states) keep_largest(width, distance(piece, state));
    for (int b = 0; b < system.bodies; ++b) {
        width.length = std::max(width.length, piece.r.segment<3>(system.pose(b)).norm());
        width.angle = std::max(width.angle, 2 * piece.r.segment<4>(system.pose(b) + 3).norm());
    }
    keep_largest(tube.width, width);
}

}  // namespace

Tube certify_branch(const Model& model, const Branch& branch, std::span<const Equilibrium> states,
                    const Tolerance& tolerance) {
    Tube tube;
    tube.width = {0, 0, 0, 0};
    const auto place = [&](double a) { return parameter_text(branch.unit, a, digits); };
    const auto open = [&](const std::string& why) {
        tube.state = ProofState::open;
        tube.detail = why;
        return tube;
    };
    if (states.size() < 2) return open("a path between states needs two of them");
    const System system = make_system(model, branch, Curves::separated);
    if (const auto why = why_not_tried(system, max_unknowns_of_curves); !why.empty()) {
        tube.tried = false;
        return open(why);
    }
    std::vector<StateAt> mapped;
    for (const auto& state : states) mapped.push_back(state_at(system, state));
    tube.from = tube.to = states.front().load;
    const double end = states.back().load, range = end - tube.from;
    if (const auto why = why_not_a_path(mapped, states, branch); !why.empty()) return open(why);
    const StateAt& middle = mapped[mapped.size() / 2];
    const Interpolant path = interpolant(mapped);
    const NodeSolver solver{system, path,
                            equilibrium_near(system, middle.z, middle.state.load).problem.border};

    // Step-size control: halved after a failure, enlarged by three fifths after a success. Shares of
    // the range; a piece shorter than `knot_step` may be straight across a knot.
    constexpr double min_step = 1e-13, first_step = 0.02, knot_step = 1e-6;
    constexpr int max_knot_pieces = 40;  // consecutive
    double h = first_step * range;
    Held held, excess;
    Section section{solver.node(tube.from), {}, {}};
    if (!section.from.found)
        return open(fmt::format("Newton's method does not converge near the state at {}",
                                place(tube.from)));
    enclose(solver, section.from);
    if (section.from.box.size() == 0 || !solver.is_sound(section.from))
        return open(fmt::format("nothing is proved at {}", place(tube.from)));
    std::size_t next_state = 0;
    bool halved = false;
    int knot_pieces = 0;  // consecutive pieces across knots up to here
    while (tube.to != end) {
        if (knot_pieces == max_knot_pieces)
            return open(
                fmt::format("past {} the path stays on a knot, or close to one", place(tube.to)));
        const bool is_last = std::abs(end - tube.to) <= 1.01 * std::abs(h);
        const double a1 = is_last ? end : tube.to + h;
        if (a1 == tube.to || std::abs(h) < min_step * std::abs(range))
            return open(why_it_ends(solver, excess, tolerance, place(tube.to)));
        section.to = halved && section.middle.a == a1 ? section.middle : solver.node(a1);
        section.middle = solver.node(tube.to / 2 + a1 / 2);
        const ProvedPiece proved_piece =
            prove_section(solver, section, std::abs(h) < knot_step * std::abs(range), tolerance);
        if (proved_piece.is_excessive) excess = proved_piece.held;
        if (!proved_piece.proved) {
            h /= 2;
            halved = true;
            continue;
        }
        halved = false;
        const std::size_t first_state = next_state;
        while (next_state < mapped.size() &&
               std::abs(states[next_state].load - tube.from) <= std::abs(a1 - tube.from))
            ++next_state;
        widen(tube, system, proved_piece.piece,
              std::span(mapped).subspan(first_state, next_state - first_state));
        held.held = std::max(held.held, proved_piece.held.held);
        held.gap = std::max(held.gap, proved_piece.held.gap);
        excess = {};
        ++tube.pieces;
        tube.knots += crosses_a_knot(system, proved_piece.piece) ? 1 : 0;
        tube.to = a1;
        section.from = section.to;
        h *= 1.6;
        // the knot is passed
        if (proved_piece.over_knot && std::abs(h) < std::abs(first_step * range))
            h = first_step * range;
        knot_pieces = proved_piece.over_knot ? knot_pieces + 1 : 0;
        if (std::abs(h) > std::abs(range)) h = range;
    }
    if (!is_within(tube.width, tolerance))
        return open(fmt::format(
            "a curve of equilibria is proved, but up to {} from the states, beyond the tolerance",
            as_text(tube.width)));
    tube.state = ProofState::proved;
    tube.detail = statement(system, solver.border, held, "states");
    return tube;
}

}  // namespace elastocheck::reference::certificate
