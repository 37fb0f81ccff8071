#include "recursive/solve.hpp"

#include <fmt/format.h>

#include "recursive/assembly.hpp"
#include "recursive/diagnosis.hpp"
#include "recursive/reactions.hpp"

namespace elastocheck::recursive {
namespace {

// Everything the stepping loop touches, allocated once.
template <class Real>
struct Recursion {
    State<Real> q;         // qⁿ
    SaddlePoint<Real> system;
    Vector<Real> f;        // f_ext(qⁿ⁻¹, aⁿ)
    Vector<Real> f_next;   // f_ext(qⁿ, aⁿ⁺¹)
    Vector<Real> carried;  // Φ_q(qⁿ⁻¹)ᵀ λⁿ⁻¹
    Vector<Real> upper, lower, x, Phi, lambda;
    Vector<Real> last;     // W Δqⁿ⁻¹
    int swings = 0;        // steps in a row that reversed the one before and were larger

    Recursion(const Model& model, const Diagnosis& diagnosis) : q(design_state<Real>(model)) {
        const int n = system.n = coordinates(model), m = system.m = constraint_rows(model);
        system.M.setZero(n + m, n + m);
        system.weight.setOnes(n + m);
        for (int b = 0; b < n / 6; ++b)
            system.weight.segment(6 * b + 3, 3).setConstant(static_cast<Real>(diagnosis.length));
        for (auto* v : {&f, &f_next, &carried, &upper, &last}) v->setZero(n);
        for (auto* v : {&lower, &Phi, &lambda}) v->setZero(m);
        x.setZero(n + m);
        assemble<Real>(model, q, system.M);
        prepare(system, static_cast<int>(diagnosis.idle.size()), diagnosis.null_space);
    }
};

void record(const Model& model, const State<double>& before, const Recursion<double>& r, double load, Equilibrium& point) {
    point.load = load;
    for (std::size_t b = 0; b < point.poses.size(); ++b) {
        point.poses[b].r = r.q[static_cast<BodyId>(b)].r;
        point.poses[b].p = r.q[static_cast<BodyId>(b)].p;
    }
    joint_wrenches<double>(model, before, r.lambda, point.reactions);
    double sum = 0;
    for_each_row<double>(model, r.q, [&](int, const Row<double>& row) { sum += row.Phi * row.Phi; });
    point.constraint_error = std::sqrt(sum);  // (31)
}

// The part of the external force that works on the idle modes now held, as a share of the whole.
template <class Real>
Real load_on_idle_modes(const Recursion<Real>& r) {
    const int n = r.system.n;
    const auto weighted = [&](const auto& v) { return v.cwiseQuotient(r.system.weight.head(n)); };
    const Real whole = weighted(r.f_next).norm();
    Real worst = 0;
    for (int c = 0; c < r.system.idle; ++c)
        if (whole > 0) worst = std::max(worst, std::abs(r.system.held.col(c).head(n).dot(r.f_next)) / whole);
    return worst;
}

// Stored forces are turned with one step's delay, so a body on which the stored force has a stiffness k_g and the elements
// k answers Δqⁿ = -(k_g / k) Δqⁿ⁻¹ + ...: where k_g > k every step reverses the last and outgrows it, and more steps only
// give it more room. The linearisation itself, eq. (6), means nothing for a rotation of a radian in one step.
template <class Real>
bool has_diverged(Recursion<Real>& r) {
    const int n = r.system.n;
    const auto weight = r.system.weight.head(n).array();
    const auto dq = r.x.head(n).array() * weight;
    const bool swung = (dq * r.last.array()).sum() < 0 && dq.matrix().squaredNorm() > r.last.squaredNorm();
    r.swings = swung ? r.swings + 1 : 0;
    r.last = dq;
    Real turn = 0;
    for (int b = 0; b < n / 6; ++b) turn = std::max(turn, r.x.template segment<3>(6 * b + 3).norm());
    return r.swings >= 2 || !(turn <= 1);
}

}  // namespace

EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options) {
    using Real = double;
    const int N = options.steps > 0 ? options.steps : branch.steps;
    const int n = coordinates(model), m = constraint_rows(model);
    const Diagnosis diagnosis = diagnose(model);
    EquilibriumPath path;
    const auto fail = [&](Outcome outcome, std::string detail) {
        path.outcome = outcome;
        path.detail = fmt::format("branch '{}': {}", branch.name, detail);
        return path;
    };
    if (!(diagnosis.constraint_error <= 1e-9))
        return fail(Outcome::inconsistent_constraints,
                    fmt::format("the joints are not closed at the design position, |Φ| = {:.3g}", diagnosis.constraint_error));

    Recursion<Real> r(model, diagnosis);
    path.points.reserve(static_cast<std::size_t>(N) + 1);
    const Equilibrium blank{0, std::vector<Pose>(model.bodies.size()), std::vector<Wrench>(model.joints.size()), 0};

    // One solve of (24) with `upper` at qⁿ; q, λ and the carried reaction move on to n+1.
    State<Real> before = r.q;
    const auto step = [&]() -> Outcome {
        assemble<Real>(model, r.q, r.system.M, &r.Phi);
        const auto report = solve(r.system, r.upper, r.lower, r.x);
        ++path.counts.factorisations;
        ++path.counts.evaluations;
        if (!r.x.allFinite()) return Outcome::not_finite;
        if (!(report.pivot_ratio > std::numeric_limits<Real>::epsilon() * Real(n + m))) return Outcome::singular;
        // What is idle where the constraints are met blurs with the constraint error: a load's share on it grows like |Φ|,
        // its stiffness like |Φ|². More than that is real, and holding the motion would be a quiet wrong number.
        const Real blur = r.Phi.norm() / static_cast<Real>(std::min(1.0, diagnosis.length));
        if (!(report.held_stiffness <= 1e-6 + 1e6 * blur * blur)) return Outcome::singular;
        if (!(load_on_idle_modes(r) <= 1e-9 + 10 * blur)) return Outcome::loaded_idle_mode;
        if (has_diverged(r)) return Outcome::diverged;
        before = r.q;
        r.lambda = r.x.tail(m);
        r.carried.noalias() = r.system.M.topRightCorner(n, m) * r.lambda;
        advance(r.q, r.x.head(n));
        ++path.counts.iterations;
        return Outcome::converged;
    };
    const auto words = [&](Outcome outcome, double load) {
        std::string detail = fmt::format("at load factor {:.6g}", load);
        if (outcome == Outcome::loaded_idle_mode) {
            detail += ": the load pushes what nothing resists:";
            for (const auto& mode : diagnosis.idle) detail += " " + mode.description + ";";
            detail.pop_back();
        } else if (outcome == Outcome::singular && r.system.borders() > 0) {
            detail += ": the matrix lost rank, or what was idle or redundant at the design position no longer is";
        } else if (outcome == Outcome::diverged) {
            detail += ": the stored forces turn stiffer than the elements are, the recursion is unstable from here on";
        }
        return detail;
    };

    // Load factor 0. Where nothing is stored and nothing weighs, λ⁻¹ = 0 and q⁰ is the design position. Otherwise (25)
    // with the imbalance f_ext - f_elast gives λ⁻¹, and Δq ≠ 0 only if the design position is not in equilibrium.
    external_force<Real>(model, branch, 0, r.q, r.f_next);
    r.upper = r.f_next - elastic_force<Real>(model, r.q);
    if (!r.upper.isZero(0))
        if (const Outcome outcome = step(); outcome != Outcome::converged) return fail(outcome, words(outcome, 0));
    r.f = r.f_next;
    path.points.push_back(blank);
    record(model, before, r, 0, path.points.back());

    for (int k = 0; k < N; ++k) {
        // ⎡ K(qⁿ)    Φ_q(qⁿ)ᵀ ⎤ ⎧ Δq ⎫ⁿ   ⎧ Δf_ext ⎫   ⎧ Φ_q(qⁿ⁻¹)ᵀ λⁿ⁻¹ ⎫
        // ⎣ Φ_q(qⁿ)     0     ⎦ ⎩ λ  ⎭  = ⎩   0    ⎭ + ⎩        0        ⎭      (29)
        //
        // Δf_ext = f_ext(qⁿ, aⁿ⁺¹) - f_ext(qⁿ⁻¹, aⁿ). While levers stand still this is the paper's constant; where a lever
        // moves it is what makes (29) equal to (28): the upper row of step n-1 reads
        // f_ext(qⁿ⁻¹, aⁿ) - K(q⁰)Δq⁰ - ... - K(qⁿ⁻¹)Δqⁿ⁻¹ = Φ_q(qⁿ⁻¹)ᵀ λⁿ⁻¹.
        const double load = branch.to * (k + 1) / N;
        external_force<Real>(model, branch, static_cast<Real>(load), r.q, r.f_next);
        r.upper = r.f_next - r.f + r.carried;
        if (const Outcome outcome = step(); outcome != Outcome::converged) return fail(outcome, words(outcome, load));
        std::swap(r.f, r.f_next);
        path.points.push_back(blank);
        record(model, before, r, load, path.points.back());
    }
    return path;
}

}  // namespace elastocheck::recursive
