#include "elastocheck/recursive.hpp"
#include "recursive/formula/reactions.hpp"
#include "recursive/linear_algebra/assembly.hpp"

namespace elastocheck::recursive {

// f_ext(q, a) - f_elast(q) + (wrenches of the joints) = 0 for every body, and Φ(q) = 0.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state) {
    check(model, branch);
    const State<double> q = state_of<double>(state.poses);
    const Inputs<double> inputs = inputs_at<double>(model, branch, state.load);
    Vector<double> f;
    external_force<double>(model, branch, inputs, q, f);
    f -= elastic_force<double>(model, inputs, q);
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
        const ModelJoint& joint = model.joints[k];
        const Wrench& wrench = state.reactions[k];
        const Vector3<double> p = q[joint.i].r + q[joint.i].lever(joint.at.s_local);
        const auto add = [&](BodyId b, double sign) {
            if (b == ground) return;
            f.segment<3>(6 * b) += sign * wrench.force;
            f.segment<3>(6 * b + 3) += sign * (wrench.moment + (p - q[b].r).cross(wrench.force));
        };
        add(joint.i, +1);
        add(joint.j, -1);
    }
    // std::max would drop a NaN; a NaN in `worst` is kept.
    const auto worse = [](double& worst, double value) {
        if (!std::isnan(worst) && !(std::abs(value) <= worst)) worst = std::abs(value);
    };
    Residuals result;
    for (BodyId b = 0; b < q.bodies(); ++b) {
        for (int c = 0; c < 3; ++c) {
            worse(result.force, f[6 * b + c]);
            worse(result.moment, f[6 * b + 3 + c]);
        }
    }
    for_each_row<double>(model, inputs, q, [&](int, const Row<double>& row) {
        worse(row.length ? result.length : result.direction, row.Phi);
    });
    // Two kinds of rows have a second solution: a negative length, and an angle plus half a turn.
    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        const ConstraintKind& kind = model.constraints[c].kind;
        const double length = inputs.offset[c];
        if (std::holds_alternative<DistanceBetween>(kind) && !(length > 0))
            worse(result.length, 2 * length);
        if (is_angle(kind) && !(slope<double>(kind, length, q) < 0)) worse(result.direction, 2);
    }
    return result;
}

}  // namespace elastocheck::recursive
