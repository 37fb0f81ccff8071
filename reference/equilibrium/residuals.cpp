// Residuals of a state from any leg.
#include <Eigen/QR>

#include "elastocheck/equilibrium.hpp"
#include "reference/equilibrium/statement/system.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Frames = std::vector<Frame<double>>;

// Sets `largest` to `size` if that is larger; NaN counts as largest.
void keep_largest(double& largest, double size) {
    if (std::isnan(largest)) return;
    if (!(size <= largest)) largest = size;
}
void keep_largest(double& largest, const Vector3d& components) {
    for (int k = 0; k < 3; ++k) keep_largest(largest, std::abs(components[k]));
}

struct Balance {
    Vector3d force = Vector3d::Zero();   // [N]
    Vector3d moment = Vector3d::Zero();  // about the body's origin [N·m]
};

// The state, and the sum of the forces on each body, to which apply() adds.
struct StateBalance {
    const System& system;
    const Equilibrium& state;
    Frames frames;
    std::vector<Balance> balances;
    std::vector<std::vector<std::size_t>> constraints;  // per Model::joints

    Frame<double> frame(BodyId body) const {
        return body == ground ? ground_frame(system) : frames[static_cast<std::size_t>(body)];
    }
    void apply(BodyId body, const Interaction<double>& action, double factor) {
        if (body == ground) return;
        auto& balance = balances[static_cast<std::size_t>(body)];
        const Vector3d lever = action.at - frame(body).r;
        balance.force += factor * action.force;
        balance.moment += factor * (action.moment + cross(lever, action.force));
    }
};

// Wrenches that the constraints of a joint can transmit, one column per row of Φ, as
// (force; moment about `centre` / L), each column scaled to size one [6 × rows].
MatrixXd transmitted_by(const StateBalance& check, std::size_t joint, const Vector3d& centre) {
    MatrixXd columns(6, 0);
    const auto& constraints = check.system.model->constraints;
    for (const std::size_t c : check.constraints[joint]) {
        const auto [i, j] = bodies_of(constraints[c].kind);
        for (int k = 0; k < rows(constraints[c].kind); ++k) {
            const Vector3d unit = Vector3d::Unit(k);
            const auto on_i = holding(check.system, c, check.state.load, 0.,
                                      {check.frame(i), check.frame(j)}, unit.data())
                                  .reaction;
            columns.conservativeResize(6, columns.cols() + 1);
            columns.rightCols<1>() << on_i.force,
                (on_i.moment + cross(Vector3d(on_i.at - centre), on_i.force)) / check.system.length;
            const double size = columns.rightCols<1>().norm();
            if (size > 0) columns.rightCols<1>() /= size;
        }
    }
    return columns;
}

}  // namespace

Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    if (state.poses.size() != model.bodies.size() || state.reactions.size() != model.joints.size())
        return {nan, nan, nan, nan};
    const double a = state.load;
    const System system = make_system(model, branch, {&a, 1});
    StateBalance check{system, state, {}, std::vector<Balance>(model.bodies.size()), {}};
    check.constraints.resize(model.joints.size());
    for (std::size_t c = 0; c < model.constraints.size(); ++c)
        check.constraints[static_cast<std::size_t>(model.constraints[c].joint)].push_back(c);
    Residuals worst;

    // A quaternion off the unit sphere is an error of direction; the other residuals use the
    // nearest rotation.
    for (const auto& pose : state.poses) {
        keep_largest(worst.direction, std::abs(pose.p.norm() - 1));
        check.frames.push_back({pose.r - system.centre, pose.p.normalized()});
    }

    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        const auto& kind = model.constraints[c].kind;
        const auto [i, j] = bodies_of(kind);
        const Vector3d none = Vector3d::Zero();
        const auto joint_rows =
            holding(system, c, a, 0., {check.frame(i), check.frame(j)}, none.data());
        for (int k = 0; k < rows(kind); ++k)
            keep_largest(is_direction(kind) ? worst.direction : worst.length,
                         std::abs(joint_rows.Phi[k]));
        if (const auto* angle = std::get_if<DirectionAtAngle>(&kind)) {
            // The row is also zero for the opposite direction.
            const double value = system.values[c].at(a);
            const Frame<double> frame_j = check.frame(j);
            const Vector3d expected_direction =
                std::cos(value) * direction(frame_j, angle->j.u_local) +
                std::sin(value) * direction(frame_j, angle->y_j.u_local);
            if (direction(check.frame(i), angle->i.u_local).dot(expected_direction) < 0)
                keep_largest(worst.direction, 1);
        }
    }

    for (std::size_t e = 0; e < model.elastics.size(); ++e) {
        const auto [i, j] = bodies_of(model.elastics[e].kind);
        const auto forces = interaction(system, e, a, 0.0, {}, {check.frame(i), check.frame(j)});
        check.apply(i, forces.i, 1);
        check.apply(j, forces.j, 1);
    }
    for (const auto& load : system.loads) {
        const BodyId body = body_of(load.kind);
        if (body == ground) continue;
        const auto force =
            std::visit([&](const auto& k) { return on_body(k, check.frame(acts_with(load.kind))); },
                       load.kind);
        check.apply(body, force, load.factor.at(a));
    }

    for (std::size_t n = 0; n < model.joints.size(); ++n) {
        const auto& joint = model.joints[n];
        Interaction<double> on_i;
        on_i.force = state.reactions[n].force;
        on_i.moment = state.reactions[n].moment;
        on_i.at = position(check.frame(joint.at.body), joint.at.s_local);
        check.apply(joint.i, on_i, +1);
        check.apply(joint.j, on_i, -1);

        // A frictionless joint cannot transmit every wrench: the part outside the span of its
        // constraints is a residual.
        const MatrixXd C = transmitted_by(check, n, on_i.at);
        Vector6 remainder;
        remainder << on_i.force, on_i.moment / system.length;
        if (C.cols() > 0 && C.allFinite()) {
            Eigen::ColPivHouseholderQR<MatrixXd> qr;
            qr.setThreshold(1e-9);  // for columns of size one: dependent rows
            const Eigen::VectorXd wrench = remainder, transmitted = qr.compute(C).solve(wrench);
            remainder -= C * transmitted;
        }
        keep_largest(worst.force, Vector3d(remainder.head<3>()));
        keep_largest(worst.moment, Vector3d(system.length * remainder.tail<3>()));
    }
    for (const auto& balance : check.balances) {
        keep_largest(worst.force, balance.force);
        keep_largest(worst.moment, balance.moment);
    }
    return worst;
}

}  // namespace elastocheck::reference::equilibrium
