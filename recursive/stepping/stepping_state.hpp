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

// Position on the path: t goes from 0 to 1 while the start is settled, then a changes
// along the branch.
//
//   Φ(q, inputs(t, a)) = (1 - t) Φ_d        G(q, λ, inputs(t, a)) = -(1 - t) R_d
//
// Φ_d is the constraint error and R_d = f_ext - f_elast the imbalance at the design position. At t
// = 0 the design position satisfies the equations by definition, and the path to t = 1 is smooth.
struct Parameters {
    double t = 0, a = 0;
};

// Limits beyond which a step is rejected as meaningless. They are not tolerances of the result:
// accepted and rejected values differ by orders of magnitude.
namespace guard {
// A mode counts as idle while its strain, as a fraction of the strain if only one end of each
// element moved, is less than this; a real mode has a fraction near one.
inline constexpr double idle_strain = 1e-3;
// The constraint error makes it uncertain which modes are idle and which constraints redundant: the
// strain and the load fraction allowed for each unit of |Φ| / L.
inline constexpr double strain_per_error = 100, share_per_error = 10;
// So does rounding: the allowance in multiples of the unit round-off, since the load fraction is a
// small difference of forces, amplified by the condition number.
inline constexpr double rounding = 1e7;
// Joints that are open by less than this [m, rad] at the design position count as closed: their
// points are given with nine digits.
inline constexpr double closed = 1e-9;
// Redundant joints agree at the design position within nine digits of L or of a direction; else
// they are inconsistent.
inline constexpr double agreeing = 1e-9;
// The linearisation of a rotation, eq. (6), is wrong by half at one radian.
inline constexpr double largest_turn = 1;
// One step that reverses and exceeds the step before may follow a turn of the path; two in a
// row do not.
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
std::vector<std::vector<Moved>> moved_elements(const Model& model, const Held<double>& held);

// Whether the element may exert a force along a motion in which it has no stiffness: by its
// preload, where a curve has force and no rate, or where its forces have no energy. The forces K Δq
// of other elements do no work in such a motion; their true forces may, once their two attachment
// points have drifted apart.
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

// State and workspace of the stepping along a branch; allocated once.
struct SteppingState {
    const Model& model;
    const Branch& branch;
    struct Setup {
        double length;  // L of the diagnosis [m]
        double
            end;   // last parameter that is followed: branch.to, or before a driven length is zero
        int free;  // number of motions that the joints allow and something resists
        bool consistent = false;  // whether the matrix is the consistent tangent, else K of (19)
    } setup;
    Counts counts;

    State<double> q;        // qⁿ
    Vector<double> lambda;  // λⁿ⁻¹, total
    double a = 0;           // parameter of qⁿ
    Parameters parameters;  // of `inputs`
    Inputs<double> inputs;
    SaddlePoint<double> system;

    // The design position, and the settled start of the branch.
    struct Start {
        Inputs<double> drawn;
        Vector<double> R_d, Phi_d;  // imbalance and constraint error as drawn [6nb], [m]
        int orientation = 0;        // sign of the consistent tangent's determinant
        // where it is unstable: the bodies that move in the motion of least stiffness
        std::string unstable = {};
    } start;

    // Forces of the step and workspace of its solution.
    struct Work {
        // f_ext at (qⁿ, aⁿ⁺¹), of the load configuration that the method uses
        Vector<double> applied;
        Vector<double> stored;  // f_elast at qⁿ, with levers and axes that the method uses
        // per elastic element, for methods that store forces by element
        std::vector<ElementForce<double>> element;
        Vector<double> upper, lower, x, Phi, force;
    } work;

    // The last step.
    struct Step {
        State<double> before;        // qⁿ⁻¹
        Vector<double> lambda_half;  // halfway to λⁿ
        Vector<double> dq, last;     // last: W Δqⁿ⁻¹
        // estimated distance of qⁿ from equilibrium: |W Δqⁿ⁻¹ - W Δqⁿ⁻²| [m]
        double equilibrium_distance = 0;
        int swings = 0;  // steps in a row that reversed the one before and were larger
    } step;

    struct Idle {
        std::vector<std::vector<Moved>> moved;  // for every idle mode
        // The elastic elements that idle modes move, and those of them that may exert a
        // force along one.
        std::vector<std::size_t> elements, pushing;
    } idle;

    struct Kinks {
        std::vector<CurvePlace> curves;
        std::vector<int> sides, sides_ahead;             // at q and at another configuration
        std::vector<std::array<double, 4>> deflections;  // at four points of a step
        int uncompared = 0;  // number of coming steps that are not compared with the step before
    } kinks;

    SteppingState(const Model& model_, const Branch& branch_, const Analysis& analysis)
        : model(model_),
          branch(branch_),
          setup{.length = analysis.diagnosis.length,
                .end = last_parameter(model_, branch_),
                .free = analysis.diagnosis.degrees_of_freedom() -
                        static_cast<int>(analysis.diagnosis.idle.size())},
          q(design_state<double>(model)),
          system(analysis.system),
          start{.drawn = inputs_as_drawn<double>(model),
                .R_d = analysis.R_d,
                .Phi_d = analysis.Phi_d} {
        const int n = system.n, m = system.m;
        if (n != coordinates(model) || m != constraint_rows(model))
            throw std::invalid_argument("the analysis belongs to another model");
        step.before = q;
        for (auto* v :
             {&work.applied, &work.stored, &work.upper, &work.force, &step.dq, &step.last})
            v->setZero(n);
        for (auto* v : {&lambda, &step.lambda_half, &work.lower, &work.Phi}) v->setZero(m);
        work.x.setZero(n + m);
        if (start.Phi_d.norm() <= guard::closed) start.Phi_d.setZero();
        set_inputs<double>(model, branch, start.drawn, 0, 0, inputs);
        idle.moved = moved_elements(model, system.held);
        for (const auto& elements : idle.moved)
            for (const Moved& each : elements) idle.elements.push_back(each.element);
        std::ranges::sort(idle.elements);
        idle.elements.erase(std::unique(idle.elements.begin(), idle.elements.end()),
                            idle.elements.end());
        std::ranges::copy_if(
            idle.elements, std::back_inserter(idle.pushing), [this](std::size_t k) {
                return may_push(branch, model.elastics[k].kind, static_cast<int>(k));
            });
        kinks.curves = curves_of(model);
        kinks.sides.assign(kinks.curves.size(), 0);
        kinks.sides_ahead = kinks.sides;
        kinks.deflections.resize(kinks.curves.size());
        check_followers(analysis.system.lu.order->pattern);
    }
    int n() const { return system.n; }
    int m() const { return system.m; }

  private:
    // Throws for a load that moves others and is without entries in the pattern: the matrix would
    // silently omit its tangent.
    void check_followers(const Pattern& pattern) const {
        for (const auto& driver : branch.drivers) {
            const Load* load = driven_load(driver.what);
            if (!load || has_potential(load->kind) || is_moment(load->kind)) continue;
            const BodyId body = body_of(load->kind);
            if (!has_entry(pattern, 6 * body, 6 * body + 3))
                throw std::invalid_argument(
                    "the analysis belongs to a model without the branch's load '" + load->name +
                    "'");
        }
    }
};

// Whether the last step, which led to q, crossed a kink; sets how many next steps are not compared.
inline bool pass_kinks(SteppingState& s) {
    if (!find_sides(s.model, s.inputs, s.q, s.kinks.curves, s.kinks.sides)) return false;
    s.kinks.uncompared = guard::kinked;
    return true;
}
// Whether a kink lies between the start of the step and q.
inline bool beyond_a_kink(SteppingState& s, const State<double>& q) {
    s.kinks.sides_ahead = s.kinks.sides;
    return find_sides(s.model, s.inputs, q, s.kinks.curves, s.kinks.sides_ahead);
}

// Sets the inputs to those of (t, a).
inline void go_to(SteppingState& s, Parameters parameters) {
    s.parameters = parameters;
    set_inputs<double>(s.model, s.branch, s.start.drawn, parameters.t, parameters.a, s.inputs);
}

// Largest work of the force on a held idle mode, as a fraction of `whole`.
double load_on_idle_modes(const SteppingState& s, const Vector<double>& force, double whole);
inline double size_of_force(const SteppingState& s, const Vector<double>& force) {
    return force.cwiseQuotient(s.system.weight.head(s.n())).norm();
}

// How far the held motions are from idle and the held combinations from redundant at q (0 to 1):
//   motion z        √(strain energy of the elements / the same if only one end of each moved)
//   combination y   |Φ_qᵀ y| / Σ |y_k| |row k|
double strain_of_held(SteppingState& s, const State<double>& q);

// Whether two increments that should agree differ by more than half the larger one and by more than
// rounding. All three arguments are |W Δq|² [m²].
inline bool disagree(const SteppingState& s, double change, double first, double second) {
    const double rounding = 100 * std::numeric_limits<double>::epsilon() * s.setup.length;
    return !(4 * change <= std::max({first, second, rounding * rounding}));
}

// |W Δq|² of the solution now in s.work.x.
inline double size_of_solution(const SteppingState& s) {
    return s.work.x.head(s.n()).cwiseProduct(s.system.weight.head(s.n())).squaredNorm();
}

// Whether the last step has diverged.
//
// Stored forces that do not follow the bodies are rotated with a delay of one step. Where their
// geometric stiffness k_g exceeds the elastic stiffness k, a step gives
// Δqⁿ = -(k_g / k) Δqⁿ⁻¹ + ..., which reverses and exceeds the step before; more steps only amplify
// this (stability_limit.hpp). A method with the consistent tangent corrects in each step the error
// of the last one; where that exceeds half a step, the steps are too long. The linearisation of eq.
// (6) is invalid for a rotation of a radian in one step.
bool has_diverged(SteppingState& s);

// Whether the smallest pivot is above rounding, relative to the largest. False for NaN. It holds of
// a matrix scaled to entries near one: factorise_at() scales anew before it reports a singular one.
inline bool is_regular(const SteppingState& s, double pivot_ratio) {
    return pivot_ratio > std::numeric_limits<double>::epsilon() * (s.n() + s.m());
}

// Checks the factors in the system, of its matrix at q: finite, regular, and held modes still idle.
Outcome check_factors(SteppingState& s, const State<double>& q, double pivot_ratio);

// Whether s.work.applied and the elements at q load an idle mode. The border of (24) would carry
// that load like a joint, and the result would be a false equilibrium. `equilibrium_distance` is the
// distance of q from equilibrium [m], which adds to the uncertainty as |Φ| does.
Outcome check_idle_load(SteppingState& s, const State<double>& q, double equilibrium_distance);

// The same for the forces at the present configuration.
Outcome check_idle_load_here(SteppingState& s, double equilibrium_distance);

// Assembles and factorises the method's matrix at (q, λ) with the present inputs, and checks it.
Outcome factorise_at(SteppingState& s, const State<double>& q, const Vector<double>& lambda);

// Right-hand side (-G, -Φ) of a Newton correction at (q, λ) and the present inputs, with
// G = f_elast + Φ_qᵀ λ - f_ext. The held parts (1 - t) of R_d and Φ_d are subtracted.
void residual_at(SteppingState& s, const State<double>& q, const Vector<double>& lambda);

// Whether the model has redundant constraints.
inline bool has_redundancy(const SteppingState& s) {
    return s.system.borders() > s.system.held.idle;
}

// The largest distance of a body from the origin [m].
inline double reach(const State<double>& q) {
    double farthest = 0;
    for (BodyId b = 0; b < q.bodies(); ++b) farthest = std::max(farthest, q[b].r.norm());
    return farthest;
}
// Relative precision of the input coordinates at q: 64 units of round-off of the largest
// coordinate, as a fraction of L or of a unit direction.
inline double input_precision(const SteppingState& s, const State<double>& q) {
    return 64 * std::numeric_limits<double>::epsilon() * (1 + reach(q) / s.setup.length);
}

// The largest |Φ_k| in `Phi`, as a fraction of L where it is a length.
double largest_gap(const SteppingState& s, const Vector<double>& Phi);

// Whether redundant joints are inconsistent at q. Pre: the corrections have converged and
// residual_at has set s.work.lower, which holds the gap that the border has absorbed.
inline bool is_inconsistent(const SteppingState& s, const State<double>& q) {
    return has_redundancy(s) &&
           !(largest_gap(s, s.work.lower) <= guard::agreeing + input_precision(s, q));
}

// amount · ∂/∂t or ∂/∂a of the same right-hand side, at (q, λ) and the present inputs.
void drive_at(SteppingState& s, Drive drive, double amount, const State<double>& q,
              const Vector<double>& lambda);

inline void back_substitute(SteppingState& s) {
    back_substitute(s.system, s.work.upper, s.work.lower, s.work.x);
    ++s.counts.iterations;
}

// λ and the configuration of its solve, where it acts: for the published sums one step before q.
struct Acting {
    const Vector<double>& lambda;
    const State<double>& where;
};
// Fills the poses, wrenches and |Φ| of a point.
void record(const Model& model, const Inputs<double>& inputs, const State<double>& q,
            const Acting& reactions, Equilibrium& point);

}  // namespace elastocheck::recursive
