#include "recursive/diagnosis/analysis.hpp"

#include <cmath>

#include "recursive/diagnosis/loops.hpp"
#include "recursive/formula/recentre.hpp"
#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/linear_algebra/pattern.hpp"
#include "recursive/stepping/stability.hpp"

namespace elastocheck::recursive {

Analysis analyse(const Model& model, const EliminationOrder& reused_order) {
    if (const auto c = far_centre(model)) return analyse(centred(model, *c), reused_order);
    Analysis result;
    result.diagnosis = diagnose(model);
    if (std::isnan(result.diagnosis.constraint_error)) return result;
    SaddlePoint<double>& system = result.system;
    const int n = system.n = coordinates(model), m = system.m = constraint_rows(model);
    const double L = result.diagnosis.length;
    const State<double> q = design_state<double>(model);
    const Branch undriven;  // no driver
    const Inputs<double> design_inputs = inputs_as_drawn<double>(model);
    constexpr double t = 0, a = 0;
    Inputs<double> inputs;
    set_inputs<double>(model, undriven, design_inputs, t, a, inputs);

    // The matrix (24) with K, for the scaling, the borders and the elimination order.
    Vector<double> Phi(m);
    system.M = saddle_matrix(model);
    system.weight.setOnes(n + m);
    for (int b = 0; b < n / 6; ++b) system.weight.segment(6 * b + 3, 3).setConstant(L);
    assemble<double>(model, inputs, q, system.M, Phi);
    analyse(system, static_cast<int>(result.diagnosis.idle.size()), result.diagnosis.null_space,
            pattern(model), loops(model), reused_order);

    // The consistent tangent in the same pattern, whose factors the start of a branch uses.
    assemble_constraints<double>(model, inputs, q, system.M, Phi);
    add_consistent_tangent<double>(model, undriven, inputs, q, Vector<double>::Zero(m), system.M);
    result.pivot_ratio = factorise(system);
    external_force<double>(model, undriven, inputs, q, result.R_d);
    result.R_d -= elastic_force<double>(model, inputs, q);
    result.Phi_d = Phi;
    result.at_rest = is_at_rest(system, result.R_d, Phi, L);
    if (result.at_rest && curves_of(model).empty() && result.pivot_ratio > 0) {
        SteppingState s(model, undriven, result);
        s.setup.consistent = true;
        go_to(s, {1, 0});
        result.start = start_stability(s);
    }
    return result;
}

}  // namespace elastocheck::recursive
