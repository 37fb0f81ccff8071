// Residuals of a state from any leg.
#include <Eigen/QR>

#include "elastocheck/equilibrium.hpp"
#include "reference/equilibrium/statement/system.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Frames = std::vector<Frame<double>>;

// Raises `size` to at least `to`; NaN counts as largest.
void raise(double& size, double to) {
    if (std::isnan(size)) return;
    if (!(to <= size)) size = to;
}
void raise(double& size, const Vector3d& to) {
    for (int k = 0; k < 3; ++k) raise(size, std::abs(to[k]));
}

struct Balance {
    Vector3d force = Vector3d::Zero();   // [N]
    Vector3d moment = Vector3d::Zero();  // about the body's origin [N·m]
};

struct Judge {
    const System& system;
    const Equilibrium& state;
    Frames frames;
    std::vector<Balance> balances;
    std::vector<std::vector<std::size_t>> constraints;  // per Model::joints

    Frame<double> frame(BodyId body) const {
        return body == ground ? ground_frame(system) : frames[static_cast<std::size_t>(body)];
    }
    void apply(BodyId body, const Interaction<double>& on, double factor) {
        if (body == ground) return;
        auto& balance = balances[static_cast<std::size_t>(body)];
        balance.force += factor * on.force;
        balance.moment += factor * (on.moment + cross(Vector3d(on.at - frame(body).r), on.force));
    }
};

// Wrenches that the constraints of a joint can transmit, one column per row and unit reaction, as
// (force; moment about `at` / L) [6 × rows].
MatrixXd transmitted_by(const Judge& judge, std::size_t joint, const Vector3d& centre) {
    MatrixXd columns(6, 0);
    const auto& constraints = judge.system.model->constraints;
    for (const std::size_t c : judge.constraints[joint]) {
        const auto [i, j] = bodies_of(constraints[c].kind);
        for (int k = 0; k < rows(constraints[c].kind); ++k) {
            const Vector3d unit = Vector3d::Unit(k);
            const auto on_i = holding(judge.system, c, judge.state.load, 0.,
                                      {judge.frame(i), judge.frame(j)}, unit.data())
                                  .reaction;
            columns.conservativeResize(6, columns.cols() + 1);
            columns.rightCols<1>() << on_i.force,
                (on_i.moment + cross(Vector3d(on_i.at - centre), on_i.force)) / judge.system.length;
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
    Judge judge{system, state, {}, std::vector<Balance>(model.bodies.size()), {}};
    judge.constraints.resize(model.joints.size());
    for (std::size_t c = 0; c < model.constraints.size(); ++c)
        judge.constraints[static_cast<std::size_t>(model.constraints[c].joint)].push_back(c);
    Residuals worst;

    // A quaternion off the unit sphere is an error of direction; the other residuals use the
    // nearest rotation.
    for (const auto& pose : state.poses) {
        raise(worst.direction, std::abs(pose.p.norm() - 1));
        judge.frames.push_back({pose.r - system.centre, pose.p.normalized()});
    }

    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        const auto& kind = model.constraints[c].kind;
        const auto [i, j] = bodies_of(kind);
        const Vector3d none = Vector3d::Zero();
        const auto h = holding(system, c, a, 0., {judge.frame(i), judge.frame(j)}, none.data());
        for (int k = 0; k < rows(kind); ++k)
            raise(is_direction(kind) ? worst.direction : worst.length, std::abs(h.Phi[k]));
        if (const auto* angle = std::get_if<DirectionAtAngle>(&kind)) {
            // The row is also zero for the opposite direction.
            const double value = system.values[c].at(a);
            const Frame<double> on_j = judge.frame(j);
            const Vector3d there = std::cos(value) * direction(on_j, angle->j.u_local) +
                                   std::sin(value) * direction(on_j, angle->y_j.u_local);
            if (direction(judge.frame(i), angle->i.u_local).dot(there) < 0)
                raise(worst.direction, 1);
        }
    }

    for (std::size_t e = 0; e < model.elastics.size(); ++e) {
        const auto [i, j] = bodies_of(model.elastics[e].kind);
        const auto on = interaction(system, e, a, 0.0, {}, {judge.frame(i), judge.frame(j)});
        judge.apply(i, on.i, 1);
        judge.apply(j, on.j, 1);
    }
    for (const auto& load : system.loads) {
        const BodyId body = body_of(load.kind);
        if (body == ground) continue;
        const auto on =
            std::visit([&](const auto& k) { return on_body(k, judge.frame(acts_with(load.kind))); },
                       load.kind);
        judge.apply(body, on, load.factor.at(a));
    }

    for (std::size_t n = 0; n < model.joints.size(); ++n) {
        const auto& joint = model.joints[n];
        Interaction<double> on_i;
        on_i.force = state.reactions[n].force;
        on_i.moment = state.reactions[n].moment;
        on_i.at = position(judge.frame(joint.at.body), joint.at.s_local);
        judge.apply(joint.i, on_i, +1);
        judge.apply(joint.j, on_i, -1);

        // A frictionless joint cannot transmit every wrench: the part outside the span of its
        // constraints is a residual.
        const MatrixXd C = transmitted_by(judge, n, on_i.at);
        Vector6 remainder;
        remainder << on_i.force, on_i.moment / system.length;
        if (C.cols() > 0 && C.allFinite()) {
            Eigen::ColPivHouseholderQR<MatrixXd> qr;
            qr.setThreshold(1e-9);  // for columns of size one: dependent rows
            const VectorXd whole = remainder, along = qr.compute(C).solve(whole);
            remainder -= C * along;
        }
        raise(worst.force, Vector3d(remainder.head<3>()));
        raise(worst.moment, Vector3d(system.length * remainder.tail<3>()));
    }
    for (const auto& balance : judge.balances) {
        raise(worst.force, balance.force);
        raise(worst.moment, balance.moment);
    }
    return worst;
}

}  // namespace elastocheck::reference::equilibrium
