#include "recursive/paper.hpp"

#include "recursive/diagnosis/analysis.hpp"
#include "recursive/formula/drive.hpp"
#include "recursive/linear_algebra/assembly.hpp"

namespace elastocheck::recursive {

// ⎡ K(qⁿ)    Φ_q(qⁿ)ᵀ ⎤ ⎧ Δq ⎫ⁿ   ⎧ Δf_ext - ∂f_elast/∂a Δa + Φ_q(qⁿ⁻¹)ᵀ λⁿ⁻¹ ⎫
// ⎣ Φ_q(qⁿ)     0     ⎦ ⎩ λ  ⎭  = ⎩                -∂Φ/∂a Δa                    ⎭      (29)
//
// with Δf_ext = f_ext(qⁿ, aⁿ⁺¹) - f_ext(qⁿ⁻¹, aⁿ), so that it is (28) also where the lever of a load moves.
std::vector<PaperStep> paper(const Model& model, const Branch& branch, int N) {
    const double da = branch.to / N;
    SaddlePoint<double> system = analyse(model).system;
    State<double> q = design_state<double>(model);
    Inputs<double> inputs = inputs_at<double>(model, branch, 0);
    Vector<double> f_ext, f_before, stored(system.n), driven(system.m), Phi(system.m),
        x(system.n + system.m);
    external_force<double>(model, branch, inputs, q, f_before);
    Vector<double> carried =
        f_before - elastic_force<double>(model, inputs, q);  // at rest: Φ_qᵀ λ⁻¹
    std::vector<PaperStep> path{{q, Vector<double>::Zero(system.m)}};

    for (int k = 1; k <= N; ++k) {
        const Inputs<double> next = inputs_at<double>(model, branch, k * da);
        external_force<double>(model, branch, next, q, f_ext);
        add_stored_rate<double>(model, branch, inputs, Drive::rate, da, q, stored.setZero());
        add_constraint_rate<double>(model, branch, inputs, Drive::rate, -da, q, driven.setZero());

        assemble<double>(model, inputs, q, system.M, Phi);
        factorise(system);
        back_substitute<double>(system, f_ext - f_before - stored + carried, driven, x);
        constraint_force(system.M, x.tail(system.m), carried);
        advance(q, x.head(system.n));

        path.push_back({q, x.tail(system.m)});
        f_before = f_ext;
        inputs = next;
    }
    return path;
}

}  // namespace elastocheck::recursive
