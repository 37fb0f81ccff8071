// The paper's loop as printed, for reading beside eq. (29).
// `published` runs by the sweep (sweep.hpp) and not by this loop, since it also settles the start,
// checks each step and allocates nothing; tests/recursive/paper_test.cpp asserts that both are equal.
#pragma once

#include <vector>

#include "recursive/diagnosis/analysis.hpp"
#include "recursive/formula/drive.hpp"
#include "recursive/linear_algebra/assembly.hpp"

namespace elastocheck::recursive {

template <class Real>
struct PaperStep {
    State<Real> q;        // qⁿ
    Vector<Real> lambda;  // λⁿ⁻¹, solved with Φ_q(qⁿ⁻¹); zero at the start
};

// q⁰ ... q^N along a branch whose design position is in equilibrium at a = 0, in N equal steps.
//
// ⎡ K(qⁿ)    Φ_q(qⁿ)ᵀ ⎤ ⎧ Δq ⎫ⁿ   ⎧ Δf_ext - ∂f_elast/∂a Δa + Φ_q(qⁿ⁻¹)ᵀ λⁿ⁻¹ ⎫
// ⎣ Φ_q(qⁿ)     0     ⎦ ⎩ λ  ⎭  = ⎩                -∂Φ/∂a Δa                    ⎭      (29)
//
// with Δf_ext = f_ext(qⁿ, aⁿ⁺¹) - f_ext(qⁿ⁻¹, aⁿ), so that it is (28) also where the lever of a
// load moves.
template <class Real>
std::vector<PaperStep<Real>> paper(const Model& model, const Branch& branch, int N) {
    const Real da = static_cast<Real>(branch.to) / static_cast<Real>(N);
    SaddlePoint<Real> system = in_arithmetic<Real>(analyse(model).system);
    State<Real> q = design_state<Real>(model);
    Inputs<Real> inputs = inputs_at<Real>(model, branch, 0);
    Vector<Real> f_ext, f_before, stored(system.n), driven(system.m), Phi(system.m),
        x(system.n + system.m);
    external_force<Real>(model, branch, inputs, q, f_before);
    Vector<Real> carried = f_before - elastic_force<Real>(model, inputs, q);  // at rest: Φ_qᵀ λ⁻¹
    std::vector<PaperStep<Real>> path{{q, Vector<Real>::Zero(system.m)}};

    for (int k = 1; k <= N; ++k) {
        const Inputs<Real> next = inputs_at<Real>(model, branch, static_cast<Real>(k) * da);
        external_force<Real>(model, branch, next, q, f_ext);
        add_stored_rate<Real>({model, branch, inputs, Drive::rate, da, q}, stored.setZero());
        add_constraint_rate<Real>({model, branch, inputs, Drive::rate, -da, q}, driven.setZero());

        assemble<Real>(model, inputs, q, system.M, Phi);
        factorise(system);
        back_substitute<Real>(system, f_ext - f_before - stored + carried, driven, x);
        constraint_force(system.M, x.tail(system.m), carried);
        advance(q, x.head(system.n));

        path.push_back({q, x.tail(system.m)});
        f_before = f_ext;
        inputs = next;
    }
    return path;
}

}  // namespace elastocheck::recursive
