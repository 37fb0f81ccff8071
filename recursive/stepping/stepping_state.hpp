// State, linear system and step functions shared by all stepping methods.
#pragma once

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/recursive_method.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/formula/drive.hpp"
#include "recursive/formula/reactions.hpp"
#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/stepping/knots.hpp"

namespace elastocheck::recursive {

// Position on the path: t goes from 0 to 1 while the start is settled, then a changes along the
// branch.
//
//   Φ(q, inputs(t, a)) = (1 - t) Φ_d        G(q, λ, inputs(t, a)) = -(1 - t) R_d
//
// Φ_d is the constraint error and R_d = f_ext - f_elast the imbalance at the design position. At t
// = 0 the design position satisfies the equations by definition, and the path to t = 1 is smooth.
template <class Real>
struct Parameters {
    Real t = 0, a = 0;
};

// Limits beyond which a step is rejected as meaningless. They are not tolerances of the result:
// accepted and rejected values differ by orders of magnitude.
namespace guard {
// A mode counts as idle while its strain, as a fraction of the strain if only one end of each
// element moved, is less than this; a real mode has a fraction near one.
inline constexpr double idle_strain = 1e-3;
// The constraint error blurs which modes are idle and which constraints redundant: the strain and
// the load fraction allowed for each unit of |Φ| / L.
inline constexpr double strain_per_error = 100, share_per_error = 10;
// Rounding blurs it too: in multiples of the unit round-off, since the load fraction is a small
// difference of forces, amplified by the condition number.
inline constexpr double rounding = 1e7;
// Joints that are open by less than this [m, rad] at the design position count as closed: their
// points are given with nine digits.
inline constexpr double closed = 1e-9;
// Redundant joints agree at the design position within nine digits of L or of a direction; else
// they are inconsistent.
inline constexpr double agreeing = 1e-9;
// The linearisation of a rotation, eq. (6), is wrong by half at one radian.
inline constexpr double largest_turn = 1;
// One step that reverses and exceeds the step before may follow a turn of the path; two in a row do
// not.
inline constexpr int swings = 2;
// A step across a kink overshoots or undershoots and the next one corrects that: number of steps
// that are not compared with the step before.
inline constexpr int kinked = 2;
}  // namespace guard

// An elastic element that an idle mode moves, and the positions of its two bodies among the entries
// of the mode; -1 for a body that the mode does not move.
struct Moved {
    std::size_t element = 0;
    int at_i = -1, at_j = -1;
};
// For every idle mode, in the order of the elements.
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
        const auto same = [](const Moved& a, const Moved& b) { return a.element == b.element; };
        moved.erase(std::unique(moved.begin(), moved.end(), same), moved.end());
    }
    return all;
}

// Whether the element may exert a force along a motion that its stiffness does not see: by its
// preload, where a curve has force and no rate, or where its forces have no energy. For other
// elements K Δq does no such work. Their true forces may, once their two attachment points have
// drifted apart.
inline bool may_push(const Branch& branch, const ElasticKind& element, int k) {
    const bool driven = std::ranges::any_of(branch.drivers, [k](const Driver& driver) {
        return preload(driver.what) != nullptr && driven_element(driver.what) == k;
    });
    bool pushes = false;
    each_member(element,
                overloaded{[&](const ScalarLaw& law) { pushes |= curve_of(law) != nullptr; },
                           [&](const SpatialLaw& law) { pushes |= !matrix_of(law); },
                           [&](ForceAndMoment<const elastocheck::Vector6> preload) {
                               pushes |= !preload.value.isZero(0);
                           },
                           [&](const Formulation& f) { pushes |= !has_energy(f); }});
    return driven || pushes;
}

// State and workspace of a march; allocated once.
template <class Real>
struct SteppingState {
    const Model& model;
    const Branch& branch;
    double length;  // L of the diagnosis [m]
    double end;     // last parameter that is followed: branch.to, or before a driven length is zero
    int free;       // number of motions that the joints allow and something resists
    Counts counts;
    bool consistent = false;  // whether the matrix is the consistent tangent, else K of (19)

    State<Real> q;                // qⁿ
    State<Real> before;           // qⁿ⁻¹
    Vector<Real> lambda;          // λⁿ⁻¹, total
    Vector<Real> lambda_half;     // halfway to λⁿ
    Real a = 0;                   // parameter of qⁿ
    Parameters<Real> parameters;  // of `inputs`
    Inputs<Real> drawn, inputs;
    Vector<Real> R_d, Phi_d;  // imbalance and constraint error at the design position [6nb], [m]
    SaddlePoint<Real> system;

    Vector<Real> applied;  // f_ext at (qⁿ, aⁿ⁺¹), of the load configuration that the method uses
    Vector<Real> stored;  // f_elast at qⁿ, with levers and axes that the method uses
    // per elastic element, for methods that store forces by element
    std::vector<ElementForce<Real>> element;

    Vector<Real> upper, lower, x, Phi, force, dq, last;  // last: W Δqⁿ⁻¹
    int orientation = 0;  // sign of the consistent tangent's determinant at the start of the branch
    Real missed = 0;  // estimate of the distance of qⁿ from equilibrium: |W Δqⁿ⁻¹ - W Δqⁿ⁻²| [m]
    // where the settled start is unstable: the bodies that move in the motion of least stiffness
    std::string unstable_start = {};
    int swings = 0;  // steps in a row that reversed the one before and were larger

    std::vector<std::vector<Moved>> moved;  // for every idle mode
    // The elastic elements that idle modes move, and those of them that may exert a force along
    // one.
    std::vector<std::size_t> at_idle, pushing;

    std::vector<CurvePlace> curves;
    std::vector<int> sides, sides_ahead;     // of the kinks, at q and at another configuration
    std::vector<std::array<Real, 4>> along;  // deflections at four points of a step
    // number of coming steps that are not compared with the step before
    int kinked = 0;

    SteppingState(const Model& model_, const Branch& branch_, const Analysis& analysis)
        : model(model_),
          branch(branch_),
          length(analysis.diagnosis.length),
          end(last_parameter(model_, branch_)),
          free(analysis.diagnosis.degrees_of_freedom() -
               static_cast<int>(analysis.diagnosis.idle.size())),
          q(design_state<Real>(model)),
          before(q),
          drawn(inputs_as_drawn<Real>(model)),
          R_d(analysis.R_d.cast<Real>()),
          Phi_d(analysis.Phi_d.cast<Real>()),
          system(in_arithmetic<Real>(analysis.system)) {
        const int n = system.n, m = system.m;
        if (n != coordinates(model) || m != constraint_rows(model))
            throw std::invalid_argument("the analysis belongs to another model");
        for (auto* v : {&applied, &stored, &upper, &force, &dq, &last}) v->setZero(n);
        for (auto* v : {&lambda, &lambda_half, &lower, &Phi}) v->setZero(m);
        x.setZero(n + m);
        if (Phi_d.norm() <= Real(guard::closed)) Phi_d.setZero();
        set_inputs<Real>(model, branch, drawn, Real(0), Real(0), inputs);
        moved = moved_elements(model, system.held);
        for (const auto& elements : moved)
            for (const Moved& each : elements) at_idle.push_back(each.element);
        std::ranges::sort(at_idle);
        at_idle.erase(std::unique(at_idle.begin(), at_idle.end()), at_idle.end());
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
    // Throws for a follower load without entries in the pattern: the matrix would silently omit its
    // tangent.
    void check_followers(const Pattern& pattern) const {
        for (const auto& driver : branch.drivers) {
            const Load* load = driven_load(driver.what);
            if (!load || !is_follower(load->kind) || is_moment(load->kind)) continue;
            const BodyId body = body_of(load->kind);
            if (!has_entry(pattern, 6 * body, 6 * body + 3))
                throw std::invalid_argument(
                    "the analysis belongs to a model without the branch's load '" + load->name +
                    "'");
        }
    }
};

// Whether the last step, which led to q, crossed a kink; sets how many next steps are not compared.
template <class Real>
bool pass_kinks(SteppingState<Real>& s) {
    if (!find_sides<Real>(s.model, s.inputs, s.q, s.curves, s.sides)) return false;
    s.kinked = guard::kinked;
    return true;
}
// Whether a kink lies between the start of the step and q.
template <class Real>
bool beyond_a_kink(SteppingState<Real>& s, const State<Real>& q) {
    s.sides_ahead = s.sides;
    return find_sides<Real>(s.model, s.inputs, q, s.curves, s.sides_ahead);
}

// Sets the inputs to those of (t, a).
template <class Real>
void go_to(SteppingState<Real>& s, Parameters<Real> parameters) {
    s.parameters = parameters;
    set_inputs<Real>(s.model, s.branch, s.drawn, parameters.t, parameters.a, s.inputs);
}

// Largest work of the force on a held idle mode, as a fraction of `whole`.
template <class Real>
Real load_on_idle_modes(const SteppingState<Real>& s, const Vector<Real>& force, Real whole) {
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
Real size_of_force(const SteppingState<Real>& s, const Vector<Real>& force) {
    return force.cwiseQuotient(s.system.weight.head(s.n())).norm();
}

// How far the held motions are from idle and the held combinations from redundant at q (0 to 1):
//   motion z        √(strain energy of the elements / the same if only one end of each moved)
//   combination y   |Φ_qᵀ y| / Σ |y_k| |row k|
template <class Real>
Real strain_of_held(SteppingState<Real>& s, const State<Real>& q) {
    const Held<Real>& held = s.system.held;
    Real worst = 0;
    for (int c = 0; c < held.idle; ++c) {
        Real energy = 0, single = 0;
        for (const auto& [k, at_i, at_j] : s.moved[static_cast<std::size_t>(c)]) {
            const auto e = element_stiffness<Real>(s.model.elastics[k].kind, s.inputs.rest[k], q);
            // a curve may have a negative slope
            const Vector6<Real> rates = e.K.diagonal().cwiseAbs();
            const Real k_T = rates.template head<3>().sum(), k_R = rates.template tail<3>().sum();
            Vector6<Real> de = Vector6<Real>::Zero();
            const auto end = [&](int at, const Vector3<Real>& lever, Real sign) {
                if (at < 0) return;
                const Eigen::Map<const Vector6<Real>> z(held.value.data() + at);
                const Vector3<Real> v = z.template head<3>(), w = z.template tail<3>();
                de.template head<3>() += sign * (v - lever.cross(w));
                de.template tail<3>() += sign * w;
                single += k_T * (v.squaredNorm() +
                                 static_cast<Real>(s.length * s.length) * w.squaredNorm()) +
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
        // Adds the generalised forces of y on the bodies of its rows, each body once.
        const auto each_end = [&](auto&& visit) {
            for (int e = held.begin(c); e < held.end(c); ++e) {
                const int row = held.row[static_cast<std::size_t>(e)] - M.n;
                for (int end = 0; end < 2; ++end)
                    if (const BodyId b =
                            M.ends[static_cast<std::size_t>(row)][static_cast<std::size_t>(end)];
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

// Whether two increments that should agree differ by more than half the larger one and by more than
// rounding. All three arguments are |W Δq|² [m²].
template <class Real>
bool disagree(const SteppingState<Real>& s, Real change, Real one, Real other) {
    const Real rounding = 100 * std::numeric_limits<Real>::epsilon() * static_cast<Real>(s.length);
    return !(4 * change <= std::max({one, other, rounding * rounding}));
}

// |W Δq|² of the solution now in s.x.
template <class Real>
Real size_of_solution(const SteppingState<Real>& s) {
    return s.x.head(s.n()).cwiseProduct(s.system.weight.head(s.n())).squaredNorm();
}

// Whether the last step has diverged.
//
// Stored forces that do not follow the bodies are rotated with a delay of one step. Where their
// geometric stiffness k_g exceeds the elastic stiffness k, a step gives
// Δqⁿ = -(k_g / k) Δqⁿ⁻¹ + ..., which reverses and exceeds the step before; more steps only amplify
// this (stability_limit.hpp). A method with the consistent tangent corrects in each step the error
// of the last one; where that exceeds half a step, the steps are too long. The linearisation of eq.
// (6) is invalid for a rotation of a radian in one step.
template <class Real>
bool has_diverged(SteppingState<Real>& s) {
    const auto weighted = s.dq.array() * s.system.weight.head(s.n()).array();
    const Real size = weighted.matrix().squaredNorm(), size_before = s.last.squaredNorm();
    if (s.consistent) s.missed = (weighted - s.last.array()).matrix().norm();
    const bool comparable = s.kinked == 0;
    if (!comparable) --s.kinked;
    const bool swung = comparable && (weighted * s.last.array()).sum() < 0 && size > size_before;
    const bool too_long =
        comparable && s.consistent && size_before > 0 &&
        disagree(s, (weighted - s.last.array()).matrix().squaredNorm(), size, size_before);
    s.swings = swung ? s.swings + 1 : 0;
    s.last = weighted;
    Real turn = 0;
    for (int b = 0; b < s.n() / 6; ++b)
        turn = std::max(turn, s.dq.template segment<3>(6 * b + 3).norm());
    return s.swings >= guard::swings || too_long || !(turn <= Real(guard::largest_turn));
}

// Whether the smallest pivot is above rounding, relative to the largest. False for NaN. It holds of a
// matrix scaled to entries near one: factorise_at() scales anew before it reports a singular one.
template <class Real>
bool is_regular(const SteppingState<Real>& s, Real pivot_ratio) {
    return pivot_ratio > std::numeric_limits<Real>::epsilon() * Real(s.n() + s.m());
}

// Checks the factors in the system, of its matrix at q: finite, regular, and held modes still idle.
template <class Real>
Outcome check_factors(SteppingState<Real>& s, const State<Real>& q, Real pivot_ratio) {
    if (!std::isfinite(pivot_ratio)) return Outcome::not_finite;
    if (!is_regular(s, pivot_ratio)) return Outcome::singular;
    // A strain above the blur is a real stiffness; holding that mode would give a wrong result
    // silently.
    const Real rounding = Real(guard::rounding) * std::numeric_limits<Real>::epsilon();
    const Real blur = s.Phi.norm() / static_cast<Real>(std::min(1.0, s.length));
    if (!(strain_of_held(s, q) <=
          rounding + Real(guard::idle_strain) + Real(guard::strain_per_error) * blur))
        return Outcome::singular;
    return Outcome::converged;
}

// Whether s.applied and the elements at q load an idle mode. The border of (24) would carry that
// load like a joint, and the result would be a false equilibrium. `missed` is the distance of q
// from equilibrium [m], which blurs the decision as |Φ| does.
template <class Real>
Outcome check_idle_load(SteppingState<Real>& s, const State<Real>& q, Real missed) {
    if (s.system.held.idle == 0) return Outcome::converged;
    Real blur = s.Phi.norm(), whole = size_of_force(s, s.applied), share = 0;
    if (s.consistent ? s.at_idle.empty() : s.pushing.empty()) {
        share = load_on_idle_modes(s, s.applied, whole);
    } else {
        s.force.setZero();
        for (const std::size_t k : s.consistent ? s.at_idle : s.pushing) {
            const ElasticKind& element = s.model.elastics[k].kind;
            const auto [i, j] = bodies_of(element);
            add_element_force<Real>(i, j, element_force<Real>(element, s.inputs.rest[k], q),
                                    s.force);
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

// Assembles and factorises the method's matrix at (q, λ) with the present inputs, and checks it.
template <class Real>
Outcome factorise_at(SteppingState<Real>& s, const State<Real>& q, const Vector<Real>& lambda) {
    if (s.consistent)
        assemble_consistent<Real>(s.model, s.branch, s.inputs, q, lambda, s.system.M, s.Phi);
    else
        assemble<Real>(s.model, s.inputs, q, s.system.M, s.Phi);
    Real pivot_ratio = factorise(s.system);
    ++s.counts.factorisations;
    if constexpr (std::is_same_v<Real, double>)
        if (pivot_ratio >= 0 && !is_regular(s, pivot_ratio)) {
            rescale(s.system);
            pivot_ratio = factorise(s.system);
            ++s.counts.factorisations;
        }
    return check_factors(s, q, pivot_ratio);
}

// Right-hand side (-G, -Φ) of a Newton correction at (q, λ) and the present inputs, with
// G = f_elast + Φ_qᵀ λ - f_ext. The held parts (1 - t) of R_d and Φ_d are subtracted.
template <class Real>
void residual_at(SteppingState<Real>& s, const State<Real>& q, const Vector<Real>& lambda) {
    external_force<Real>(s.model, s.branch, s.inputs, q, s.upper);
    elastic_force<Real>(s.model, s.inputs, q, s.force);
    s.upper -= s.force;
    constraint_force<Real>(s.model, s.inputs, q, lambda, s.force, s.lower);
    s.upper -= s.force;
    s.lower = -s.lower;
    if (const Real held = 1 - s.parameters.t; held != Real(0)) {
        s.upper -= held * s.R_d;
        s.lower += held * s.Phi_d;
    }
    ++s.counts.evaluations;
}

// Whether the model has redundant constraints.
template <class Real>
bool has_redundancy(const SteppingState<Real>& s) {
    return s.system.borders() > s.system.held.idle;
}

// The largest distance of a body from the origin [m].
template <class Real>
Real reach(const State<Real>& q) {
    Real farthest = 0;
    for (BodyId b = 0; b < q.bodies(); ++b) farthest = std::max(farthest, q[b].r.norm());
    return farthest;
}
// Relative precision of the input coordinates at q: 64 units of round-off of a double (or of Real,
// if that is coarser), of the largest coordinate, as a fraction of L or of a unit direction.
template <class Real>
Real input_precision(const SteppingState<Real>& s, const State<Real>& q) {
    const Real digit = std::max(std::numeric_limits<Real>::epsilon(),
                                static_cast<Real>(std::numeric_limits<double>::epsilon()));
    return 64 * digit * (1 + reach(q) / static_cast<Real>(s.length));
}

// The largest |Φ_k| in `Phi`, as a fraction of L where it is a length.
template <class Real>
Real largest_gap(const SteppingState<Real>& s, const Vector<Real>& Phi) {
    Real worst = 0;
    for (std::size_t c = 0; c < s.model.constraints.size(); ++c) {
        const ConstraintKind& kind = s.model.constraints[c].kind;
        const bool direction = member<Point>(kind) == nullptr;
        const Real open =
            Phi.segment(s.inputs.row[c], static_cast<Eigen::Index>(rows(kind))).norm();
        const Real share = direction ? open : open / static_cast<Real>(s.length);
        if (!(share <= worst)) worst = share;
    }
    return worst;
}

// Whether redundant joints are inconsistent at q. Pre: the corrections have converged and
// residual_at has set s.lower, which holds the gap that the border has absorbed.
template <class Real>
bool is_inconsistent(const SteppingState<Real>& s, const State<Real>& q) {
    return has_redundancy(s) &&
           !(largest_gap(s, s.lower) <= static_cast<Real>(guard::agreeing) + input_precision(s, q));
}

// amount · ∂/∂t or ∂/∂a of the same right-hand side, at (q, λ) and the present inputs.
template <class Real>
void drive_at(SteppingState<Real>& s, Drive drive, Real amount, const State<Real>& q,
              const Vector<Real>& lambda) {
    s.upper.setZero();
    s.force.setZero();
    s.lower.setZero();
    add_load_rate<Real>(s.branch, drive, amount, q, s.upper);
    add_stored_rate<Real>(s.model, s.branch, s.inputs, drive, amount, q, s.force);
    add_reaction_rate<Real>(s.model, s.branch, s.inputs, drive, amount, q, lambda, s.force);
    s.upper -= s.force;
    add_constraint_rate<Real>(s.model, s.branch, s.inputs, drive, -amount, q, s.lower);
    if (drive == Drive::start) {
        s.upper += amount * s.R_d;
        s.lower -= amount * s.Phi_d;
    }
}

template <class Real>
void back_substitute(SteppingState<Real>& s) {
    back_substitute(s.system, s.upper, s.lower, s.x);
    ++s.counts.iterations;
}

// λ acts at the configuration of its solve: for the published sums one step before q.
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
        for_each_row<Real>(model, inputs, q,
                           [&](int, const Row<Real>& row) { sum += row.Phi * row.Phi; });
    }
    point.constraint_error = static_cast<double>(std::sqrt(sum));  // (31)
}

// Instantiated in stepping/sweep_double.cpp.
extern template struct SteppingState<double>;
extern template void go_to<double>(SteppingState<double>&, Parameters<double>);
extern template Outcome check_factors<double>(SteppingState<double>&, const State<double>&, double);
extern template Outcome check_idle_load<double>(SteppingState<double>&, const State<double>&,
                                                double);
extern template Outcome factorise_at<double>(SteppingState<double>&, const State<double>&,
                                             const Vector<double>&);
extern template void residual_at<double>(SteppingState<double>&, const State<double>&,
                                         const Vector<double>&);
extern template bool is_inconsistent<double>(const SteppingState<double>&, const State<double>&);
extern template void drive_at<double>(SteppingState<double>&, Drive, double, const State<double>&,
                                      const Vector<double>&);
extern template void record<double>(const Model&, const Inputs<double>&, const State<double>&,
                                    const State<double>&, const Vector<double>&, double,
                                    Equilibrium&);

}  // namespace elastocheck::recursive
