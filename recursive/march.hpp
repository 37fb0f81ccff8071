// What all methods march with: the state, the system, and the pieces of a step.
#pragma once

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "models/equilibrium_path.hpp"
#include "recursive/analysis.hpp"
#include "recursive/assembly.hpp"
#include "recursive/drive.hpp"
#include "recursive/knots.hpp"
#include "recursive/method.hpp"
#include "recursive/reactions.hpp"

namespace elastocheck::recursive {

// Where on the way: first what is held settles, t from 0 to 1, then a goes its way along the branch.
//
//   Φ(q, inputs(t, a)) = (1 - t) Φ_d        G(q, λ, inputs(t, a)) = -(1 - t) R_d
//
// Φ_d is what the joints are open by as drawn, R_d = f_ext - f_elast what is out of balance there: at t = 0
// the design position is an equilibrium by definition, and everything between is a smooth path.
template <class Real>
struct Place {
    Real t = 0, a = 0;
};

// When a step means nothing. The numbers are no tolerances of the answer: between what they let pass and what
// they refuse lie orders of magnitude.
namespace guard {
// A motion counts as idle while its strain, as a share of what it would be if only one end of each element
// moved, is less than this; a real mode has a share near one.
inline constexpr double idle_strain = 1e-3;
// What is idle or redundant where the constraints are met blurs with the constraint error: so much strain,
// and so much of a load's share, for each |Φ| / L.
inline constexpr double strain_per_error = 100, share_per_error = 10;
// ... and with rounding: in multiples of the unit round-off, since the share is a small difference of forces
// that the conditioning has blown up.
inline constexpr double rounding = 1e7;
// Joints that are open by less than this [m, rad] as drawn are closed: their points have been written down
// with nine digits.
inline constexpr double closed = 1e-9;
// Joints that say a thing twice are drawn to agree to nine digits of L, or of a direction; else they say two.
inline constexpr double agreeing = 1e-9;
// The linearisation of a rotation, eq. (6), is off by half at a radian.
inline constexpr double largest_turn = 1;
// One step that reverses the one before and outgrows it may be the path's own turn; two in a row are not.
inline constexpr int swings = 2;
// A step over a kink goes too far or not far enough, the next one makes up for it: neither is to be compared
// with the one before.
inline constexpr int kinked = 2;
}  // namespace guard

// An elastic element that an idle mode moves, and where among the mode's entries its two bodies are; -1 where they are
// not.
struct Moved {
    std::size_t element = 0;
    int at_i = -1, at_j = -1;
};
// Of every idle mode, in the order of the elements.
template <class Real>
std::vector<std::vector<Moved>> moved_elements(const Model& model, const Held<Real>& held) {
    std::vector<std::vector<std::size_t>> on_body(model.bodies.size());
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const auto [i, j] = bodies_of(model.elastics[k].kind);
        for (const BodyId b : {i, j})
            if (b != ground) on_body[static_cast<std::size_t>(b)].push_back(k);
    }
    std::vector<std::vector<Moved>> all(static_cast<std::size_t>(held.idle));
    for (int c = 0; c < held.idle; ++c) {
        auto& moved = all[static_cast<std::size_t>(c)];
        for (int e = held.begin(c); e < held.end(c); e += 6)
            for (const std::size_t k :
                 on_body[static_cast<std::size_t>(held.row[static_cast<std::size_t>(e)] / 6)]) {
                const auto [i, j] = bodies_of(model.elastics[k].kind);
                moved.push_back({k, held.at(c, i), held.at(c, j)});
            }
        std::ranges::sort(moved, {}, &Moved::element);
        moved.erase(std::ranges::unique(moved, {}, &Moved::element).begin(), moved.end());
    }
    return all;
}

// Whether the element may push where its stiffness notices nothing: by its preload, where a curve has force and no
// rate, where its forces are of no energy. What K Δq alone makes of the others does no such work; with their true
// forces they may, once their two points have drifted apart.
inline bool may_push(const Branch& branch, const ElasticKind& element, int k) {
    const bool driven = std::ranges::any_of(branch.drivers, [k](const Driver& driver) {
        const auto* preload = std::get_if<Preload>(&driver.what);
        return preload != nullptr && preload->elastic == k;
    });
    return driven || std::visit(overloaded{
                                    [](const AxialSpring& e) { return std::holds_alternative<Curve>(e.law); },
                                    [](const Bushing& e) {
                                        return !e.preload.isZero(0) || !has_energy(e.formulation) ||
                                               std::holds_alternative<PerAxis>(e.law);
                                    },
                                },
                                element);
}

// Everything a step touches, allocated once.
template <class Real>
struct March {
    const Model& model;
    const Branch& branch;
    double length;  // L of the diagnosis [m]
    int free;       // motions that the joints allow and something resists
    Counts counts;
    bool consistent = false;  // whether the matrix is the consistent tangent, or K of (19)

    State<Real> q;             // qⁿ
    State<Real> before;        // qⁿ⁻¹
    Vector<Real> lambda;       // λⁿ⁻¹, total
    Vector<Real> lambda_half;  // halfway to λⁿ
    Real a = 0;                // parameter of qⁿ
    Place<Real> place;         // that `inputs` are of
    Inputs<Real> drawn, inputs;
    Vector<Real> R_d, Phi_d;  // out of balance and open as drawn [6nb], [m]
    SaddlePoint<Real> system;

    Vector<Real> applied;  // f_ext as far as the method lets it follow, at (qⁿ, aⁿ⁺¹)
    Vector<Real> stored;   // f_elast as far as the method lets it follow, at qⁿ
    std::vector<ElementForce<Real>>
        element;  // of each elastic element, where stored forces are kept by element

    Vector<Real> upper, lower, x, Phi, force, dq, last;  // last: W Δqⁿ⁻¹
    int orientation = 0;  // sign of the determinant of the consistent tangent where the branch began
    Real missed = 0;  // what qⁿ may be from equilibrium: what W Δqⁿ⁻¹ differed from the one before it by [m]
    bool begins_unstable = false;  // what has settled
    int swings = 0;                // steps in a row that reversed the one before and were larger

    std::vector<std::vector<Moved>> moved;  // of every idle mode
    // The elastic elements among these, and those of them that push even where K knows of nothing.
    std::vector<std::size_t> at_idle, pushing;

    std::vector<CurvePlace> curves;
    std::vector<int> sides, sides_ahead;  // of their kinks that q is on, that some other configuration is on
    std::vector<std::array<Real, 4>> along;  // deflections at four places of the way
    int kinked = 0;                          // steps to come that are not to be compared with the one before

    March(const Model& model_, const Branch& branch_, const Analysis& analysis)
        : model(model_),
          branch(branch_),
          length(analysis.diagnosis.length),
          free(analysis.diagnosis.degrees_of_freedom() - static_cast<int>(analysis.diagnosis.idle.size())),
          q(design_state<Real>(model)),
          before(q),
          drawn(inputs_as_drawn<Real>(model)),
          R_d(analysis.R_d.cast<Real>()),
          Phi_d(analysis.Phi_d.cast<Real>()),
          system(in_arithmetic<Real>(analysis.system)) {
        const int n = system.n, m = system.m;
        if (n != coordinates(model) || m != constraint_rows(model))
            throw std::invalid_argument("the analysis is of another model");
        for (auto* v : {&applied, &stored, &upper, &force, &dq, &last}) v->setZero(n);
        for (auto* v : {&lambda, &lambda_half, &lower, &Phi}) v->setZero(m);
        x.setZero(n + m);
        if (Phi_d.norm() <= Real(guard::closed)) Phi_d.setZero();
        set_inputs<Real>(model, branch, drawn, Real(0), Real(0), inputs);
        moved = moved_elements(model, system.held);
        for (const auto& elements : moved)
            for (const Moved& each : elements) at_idle.push_back(each.element);
        std::ranges::sort(at_idle);
        at_idle.erase(std::ranges::unique(at_idle).begin(), at_idle.end());
        std::ranges::copy_if(at_idle, std::back_inserter(pushing), [this](std::size_t k) {
            return may_push(branch, model.elastics[k].kind, static_cast<int>(k));
        });
        curves = curves_of(model);
        sides.assign(curves.size(), 0);
        sides_ahead = sides;
        along.resize(curves.size());
        check_followers(analysis.system.lu.order.pattern);
    }
    int n() const { return system.n; }
    int m() const { return system.m; }

  private:
    // What is not in the pattern would silently be no part of the matrix.
    void check_followers(const Pattern& pattern) const {
        for (const auto& driver : branch.drivers) {
            const auto* load = std::get_if<Load>(&driver.what);
            const auto* follower = load ? std::get_if<FollowerForce>(&load->kind) : nullptr;
            if (follower && !has_entry(pattern, 6 * follower->at.body, 6 * follower->at.body + 3))
                throw std::invalid_argument("the analysis is of a model without the branch's load '" +
                                            load->name + "'");
        }
    }
};

// Whether the step that has just led to q went over a kink; the next ones are judged accordingly.
template <class Real>
bool pass_kinks(March<Real>& s) {
    if (!find_sides<Real>(s.model, s.inputs, s.q, s.curves, s.sides)) return false;
    s.kinked = guard::kinked;
    return true;
}
// Whether there is a kink between where the step began and q.
template <class Real>
bool beyond_a_kink(March<Real>& s, const State<Real>& q) {
    s.sides_ahead = s.sides;
    return find_sides<Real>(s.model, s.inputs, q, s.curves, s.sides_ahead);
}

// The inputs become those of (t, a).
template <class Real>
void go_to(March<Real>& s, Place<Real> place) {
    s.place = place;
    set_inputs<Real>(s.model, s.branch, s.drawn, place.t, place.a, s.inputs);
}

// The part of the external force that works on the idle modes now held, as a share of the whole.
template <class Real>
Real load_on_idle_modes(const March<Real>& s, const Vector<Real>& force, Real whole) {
    const Held<Real>& held = s.system.held;
    Real worst = 0;
    for (int c = 0; c < held.idle; ++c) {
        Real work = 0;
        for (int e = held.begin(c); e < held.end(c); e += 6) {
            const auto at = static_cast<std::size_t>(e);
            work += Eigen::Map<const Vector6<Real>>(held.value.data() + e)
                        .dot(force.template segment<6>(held.row[at]));
        }
        if (whole > 0) worst = std::max(worst, std::abs(work) / whole);
    }
    return worst;
}
template <class Real>
Real size_of_force(const March<Real>& s, const Vector<Real>& force) {
    return force.cwiseQuotient(s.system.weight.head(s.n())).norm();
}

// How far the held motions are from idle, and the held
// combinations from redundant, at q: 0 for exactly so, up to 1.
//   motion z        √(strain energy of the elements / what it would be if only one end of each moved)
//   combination y   |Φ_qᵀ y| / Σ |y_k| |row k|
template <class Real>
Real strain_of_held(March<Real>& s, const State<Real>& q) {
    const Held<Real>& held = s.system.held;
    Real worst = 0;
    for (int c = 0; c < held.idle; ++c) {
        Real energy = 0, single = 0;
        for (const auto& [k, at_i, at_j] : s.moved[static_cast<std::size_t>(c)]) {
            const auto e = element_stiffness<Real>(s.model.elastics[k].kind, s.inputs.rest[k], q);
            const Vector6<Real> rates = e.K.diagonal().cwiseAbs();  // a curve may fall
            const Real k_T = rates.template head<3>().sum(), k_R = rates.template tail<3>().sum();
            Vector6<Real> de = Vector6<Real>::Zero();
            const auto end = [&](int at, const Vector3<Real>& lever, Real sign) {
                if (at < 0) return;
                const Eigen::Map<const Vector6<Real>> z(held.value.data() + at);
                const Vector3<Real> v = z.template head<3>(), w = z.template tail<3>();
                de.template head<3>() += sign * (v - lever.cross(w));
                de.template tail<3>() += sign * w;
                single += k_T * (v.squaredNorm() + static_cast<Real>(s.length * s.length) * w.squaredNorm()) +
                          k_R * w.squaredNorm();
            };
            end(at_i, e.s_i, -1);
            end(at_j, e.s_j, +1);
            energy += de.dot(e.K * de);
        }
        if (single > 0) worst = std::max(worst, std::sqrt(std::abs(energy) / single));
    }
    for (int c = held.idle; c < held.size(); ++c) {
        const SaddleMatrix<Real>& M = s.system.M;
        // What y puts on the bodies of its rows, each of them once.
        const auto each_end = [&](auto&& visit) {
            for (int e = held.begin(c); e < held.end(c); ++e) {
                const int row = held.row[static_cast<std::size_t>(e)] - M.n;
                for (int end = 0; end < 2; ++end)
                    if (const BodyId b = M.ends[static_cast<std::size_t>(row)][static_cast<std::size_t>(end)];
                        b != ground)
                        visit(row, end, s.force.template segment<6>(6 * b),
                              held.value[static_cast<std::size_t>(e)]);
            }
        };
        Real left = 0, whole = 0;
        each_end([](int, int, auto&& f, Real) { f.setZero(); });
        each_end([&](int row, int end, auto&& f, Real y) { f += y * M.part(row, end); });
        each_end([&](int, int, auto&& f, Real) {
            left += f.squaredNorm();
            f.setZero();
        });
        for (int e = held.begin(c); e < held.end(c); ++e) {
            const int row = held.row[static_cast<std::size_t>(e)] - M.n;
            whole += std::abs(held.value[static_cast<std::size_t>(e)]) *
                     std::sqrt(M.part(row, 0).squaredNorm() + M.part(row, 1).squaredNorm());
        }
        if (whole > 0) worst = std::max(worst, std::sqrt(left) / whole);
    }
    return worst;
}

// Whether two answers to the same question, or to two neighbouring ones, differ by more than half the larger
// of them, and by more than rounding. All three are |W Δq|² [m²].
template <class Real>
bool disagree(const March<Real>& s, Real change, Real one, Real other) {
    const Real rounding = 100 * std::numeric_limits<Real>::epsilon() * static_cast<Real>(s.length);
    return !(4 * change <= std::max({one, other, rounding * rounding}));
}

// |W Δq|² of the solution now in s.x.
template <class Real>
Real size_of_solution(const March<Real>& s) {
    return s.x.head(s.n()).cwiseProduct(s.system.weight.head(s.n())).squaredNorm();
}

// A step that means nothing is not an answer.
//
// Stored forces that do not follow are turned with one step's delay: where their stiffness k_g exceeds the
// elements' k a step answers Δqⁿ = -(k_g / k) Δqⁿ⁻¹ + ..., reverses the last one and outgrows it, and more
// steps only give it more room. A method with the consistent tangent corrects in each step what the last one
// missed; where that is more than half a step, the steps are too long. And the linearisation itself, eq. (6),
// means nothing for a rotation of a radian in one step.
template <class Real>
bool has_diverged(March<Real>& s) {
    const auto weighted = s.dq.array() * s.system.weight.head(s.n()).array();
    const Real size = weighted.matrix().squaredNorm(), size_before = s.last.squaredNorm();
    if (s.consistent) s.missed = (weighted - s.last.array()).matrix().norm();
    const bool comparable = s.kinked == 0;
    if (!comparable) --s.kinked;
    const bool swung = comparable && (weighted * s.last.array()).sum() < 0 && size > size_before;
    const bool too_long = comparable && s.consistent && size_before > 0 &&
                          disagree(s, (weighted - s.last.array()).matrix().squaredNorm(), size, size_before);
    s.swings = swung ? s.swings + 1 : 0;
    s.last = weighted;
    Real turn = 0;
    for (int b = 0; b < s.n() / 6; ++b) turn = std::max(turn, s.dq.template segment<3>(6 * b + 3).norm());
    return s.swings >= guard::swings || too_long || !(turn <= Real(guard::largest_turn));
}

// The factors now in the system, of its matrix at q.
template <class Real>
Outcome judge(March<Real>& s, const State<Real>& q, Real pivot_ratio) {
    if (!std::isfinite(pivot_ratio)) return Outcome::not_finite;
    if (!(pivot_ratio > std::numeric_limits<Real>::epsilon() * Real(s.n() + s.m()))) return Outcome::singular;
    // More than what blurs is real, and holding it would be a quiet wrong number.
    const Real rounding = Real(guard::rounding) * std::numeric_limits<Real>::epsilon();
    const Real blur = s.Phi.norm() / static_cast<Real>(std::min(1.0, s.length));
    if (!(strain_of_held(s, q) <= rounding + Real(guard::idle_strain) + Real(guard::strain_per_error) * blur))
        return Outcome::singular;
    return Outcome::converged;
}

// Whether s.applied and the elements at q push an idle mode. The border of (24) would take up what they do, as a joint
// does: an equilibrium that is none. `missed` is how far q may be from equilibrium [m], which blurs as |Φ| does.
template <class Real>
Outcome judge_push(March<Real>& s, const State<Real>& q, Real missed) {
    if (s.system.held.idle == 0) return Outcome::converged;
    Real blur = s.Phi.norm(), whole = size_of_force(s, s.applied), share = 0;
    if (s.consistent ? s.at_idle.empty() : s.pushing.empty()) {
        share = load_on_idle_modes(s, s.applied, whole);
    } else {
        s.force.setZero();
        for (const std::size_t k : s.consistent ? s.at_idle : s.pushing) {
            const ElasticKind& element = s.model.elastics[k].kind;
            const auto [i, j] = bodies_of(element);
            add_element_force<Real>(i, j, element_force<Real>(element, s.inputs.rest[k], q), s.force);
        }
        whole += size_of_force(s, s.force);
        s.force = s.applied - s.force;
        share = load_on_idle_modes(s, s.force, whole);
        blur += missed;
    }
    const Real rounding = Real(guard::rounding) * std::numeric_limits<Real>::epsilon();
    blur /= static_cast<Real>(std::min(1.0, s.length));
    return share <= rounding + Real(guard::share_per_error) * blur ? Outcome::converged
                                                                   : Outcome::loaded_idle_mode;
}

// Assembles and factorises the method's matrix at (q, λ) with the present inputs, and judges it.
template <class Real>
Outcome factorise_at(March<Real>& s, const State<Real>& q, const Vector<Real>& lambda) {
    if (s.consistent)
        assemble_consistent<Real>(s.model, s.branch, s.inputs, q, lambda, s.system.M, s.Phi);
    else
        assemble<Real>(s.model, s.inputs, q, s.system.M, s.Phi);
    const Real pivot_ratio = factorise(s.system);
    ++s.counts.factorisations;
    return judge(s, q, pivot_ratio);
}

// G = f_elast + Φ_qᵀ λ - f_ext at (q, λ) and the present inputs, and Φ, less what is still held of them: the
// right-hand side (-G, -Φ) of a correction.
template <class Real>
void residual_at(March<Real>& s, const State<Real>& q, const Vector<Real>& lambda) {
    external_force<Real>(s.model, s.branch, s.inputs, q, s.upper);
    elastic_force<Real>(s.model, s.inputs, q, s.force);
    s.upper -= s.force;
    constraint_force<Real>(s.model, s.inputs, q, lambda, s.force, s.lower);
    s.upper -= s.force;
    s.lower = -s.lower;
    if (const Real held = 1 - s.place.t; held != Real(0)) {
        s.upper -= held * s.R_d;
        s.lower += held * s.Phi_d;
    }
    ++s.counts.evaluations;
}

// Whether any joint says what others say already.
template <class Real>
bool says_twice(const March<Real>& s) {
    return s.system.borders() > s.system.held.idle;
}

// What a number of the model is worth as a share of L, or of a direction: a double, of the largest coordinate.
template <class Real>
Real written(const March<Real>& s, const State<Real>& q) {
    Real reach = 0;
    for (BodyId b = 0; b < q.bodies(); ++b) reach = std::max(reach, q[b].r.norm());
    const Real digit = std::max(std::numeric_limits<Real>::epsilon(),
                                static_cast<Real>(std::numeric_limits<double>::epsilon()));
    return 64 * digit * (1 + reach / static_cast<Real>(s.length));
}

// The largest |Φ_k| in `Phi`, as a share of L where it is a length.
template <class Real>
Real largest_gap(const March<Real>& s, const Vector<Real>& Phi) {
    Real worst = 0;
    for (std::size_t c = 0; c < s.model.constraints.size(); ++c) {
        const ConstraintKind& kind = s.model.constraints[c].kind;
        const bool direction = std::holds_alternative<PerpendicularDirections>(kind) ||
                               std::holds_alternative<DirectionAtAngle>(kind);
        const Real open = Phi.segment(s.inputs.row[c], static_cast<Eigen::Index>(rows(kind))).norm();
        const Real share = direction ? open : open / static_cast<Real>(s.length);
        if (!(share <= worst)) worst = share;
    }
    return worst;
}

// Whether joints that say a thing twice say two at q, by what residual_at has left in s.lower where corrections have come to
// rest: the border has taken up what they cannot both meet.
template <class Real>
bool contradict(const March<Real>& s, const State<Real>& q) {
    return says_twice(s) && !(largest_gap(s, s.lower) <= static_cast<Real>(guard::agreeing) + written(s, q));
}

// amount · ∂/∂t or ∂/∂a of the same right-hand side, at the present inputs.
template <class Real>
void drive_at(March<Real>& s, Drive drive, Real amount, const State<Real>& q) {
    s.upper.setZero();
    s.force.setZero();
    s.lower.setZero();
    add_load_rate<Real>(s.branch, drive, amount, q, s.upper);
    add_stored_rate<Real>(s.model, s.branch, s.inputs, drive, amount, q, s.force);
    s.upper -= s.force;
    add_constraint_rate<Real>(s.model, s.branch, s.inputs, drive, -amount, q, s.lower);
    if (drive == Drive::start) {
        s.upper += amount * s.R_d;
        s.lower -= amount * s.Phi_d;
    }
}

template <class Real>
void back_substitute(March<Real>& s) {
    back_substitute(s.system, s.upper, s.lower, s.x);
    ++s.counts.iterations;
}

// λ acts where it was solved: for the published sums one step before q.
template <class Real>
void record(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
            const State<Real>& where_lambda_acts, const Vector<Real>& lambda, double load,
            Equilibrium& point) {
    point.load = load;
    for (std::size_t b = 0; b < point.poses.size(); ++b) {
        point.poses[b].r = q[static_cast<BodyId>(b)].r.template cast<double>();
        point.poses[b].p = q[static_cast<BodyId>(b)].p.template cast<double>();
    }
    Real sum = joint_wrenches<Real>(model, inputs, where_lambda_acts, lambda, point.reactions);
    if (&q != &where_lambda_acts) {
        sum = 0;
        for_each_row<Real>(model, inputs, q, [&](int, const Row<Real>& row) { sum += row.Phi * row.Phi; });
    }
    point.constraint_error = static_cast<double>(std::sqrt(sum));  // (31)
}

}  // namespace elastocheck::recursive
