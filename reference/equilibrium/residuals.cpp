// Judging a state, whoever found it.
#include <Eigen/QR>
#include <algorithm>

#include "reference/equilibrium/solve.hpp"
#include "reference/equilibrium/system.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Frames = std::vector<Frame<double>>;

// The larger of two sizes; a NaN is larger than anything.
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

    Frame<double> frame(BodyId body) const {
        return body == ground ? ground_frame(system) : frames[static_cast<std::size_t>(body)];
    }
    void apply(BodyId body, const Interaction<double>& on, double factor) {
        if (body == ground) return;
        auto& balance = balances[static_cast<std::size_t>(body)];
        balance.force += factor * on.force;
        balance.moment += factor * (on.moment + cross(Vector3d(on.at - frame(body).r), on.force));
    }
    void apply(const Load& load, double factor) {
        const BodyId body = body_of(load.kind);
        if (body != ground)
            apply(body, std::visit([&](const auto& k) { return on_body(k, frame(body)); }, load.kind),
                  factor);
    }
};

// What a joint's constraints push with, one column a row and unit
// reaction, as (force; moment about `at` / L) [6 × rows].
MatrixXd transmitted_by(const Judge& judge, int joint, const Vector3d& at) {
    MatrixXd columns(6, 0);
    for (const auto& constraint : judge.system.model->constraints) {
        if (constraint.joint != joint) continue;
        const auto [i, j] = bodies_of(constraint.kind);
        for (int k = 0; k < rows(constraint.kind); ++k) {
            const Vector3d unit = Vector3d::Unit(k);
            const auto on_i = std::visit(
                [&, i = i, j = j](const auto& c) {
                    return holding(c, judge.frame(i), judge.frame(j), unit.data()).reaction;
                },
                constraint.kind);
            columns.conservativeResize(6, columns.cols() + 1);
            columns.rightCols<1>() << on_i.force,
                (on_i.moment + cross(Vector3d(on_i.at - at), on_i.force)) / judge.system.length;
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
    const double load = state.load;
    const System system = make_system(model, branch, {&load, 1});
    Judge judge{system, state, {}, std::vector<Balance>(model.bodies.size())};
    Residuals worst;

    // A quaternion off the unit sphere is an error of direction;
    // what follows is judged for the nearest rotation.
    for (const auto& pose : state.poses) {
        raise(worst.direction, std::abs(pose.p.norm() - 1));
        judge.frames.push_back({pose.r - system.centre, pose.p.normalized()});
    }

    for (const auto& constraint : model.constraints) {
        const auto [i, j] = bodies_of(constraint.kind);
        const Vector3d none = Vector3d::Zero();
        const auto h =
            std::visit([&, i = i, j = j](
                           const auto& c) { return holding(c, judge.frame(i), judge.frame(j), none.data()); },
                       constraint.kind);
        for (int k = 0; k < rows(constraint.kind); ++k)
            raise(is_direction(constraint.kind) ? worst.direction : worst.length, std::abs(h.Phi[k]));
    }

    for (const auto& elastic : model.elastics) {
        const auto [i, j] = bodies_of(elastic.kind);
        const auto on_i = std::visit(
            [&, i = i, j = j](const auto& k) { return interaction(k, judge.frame(i), judge.frame(j)); },
            elastic.kind);
        judge.apply(i, on_i, +1);
        judge.apply(j, on_i, -1);
    }
    for (const auto& l : model.static_loads) judge.apply(l, 1);
    for (const auto& l : branch.loads) judge.apply(l, load);

    for (std::size_t n = 0; n < model.joints.size(); ++n) {
        const auto& joint = model.joints[n];
        Interaction<double> on_i;
        on_i.force = state.reactions[n].force;
        on_i.moment = state.reactions[n].moment;
        on_i.at = position(judge.frame(joint.at.body), joint.at.s_local);
        judge.apply(joint.i, on_i, +1);
        judge.apply(joint.j, on_i, -1);

        // A joint without friction cannot transmit everything:
        // what lies outside the span of its constraints counts too.
        const MatrixXd C = transmitted_by(judge, static_cast<int>(n), on_i.at);
        Vector6 left_over;
        left_over << on_i.force, on_i.moment / system.length;
        if (C.cols() > 0 && C.allFinite()) {
            Eigen::ColPivHouseholderQR<MatrixXd> qr;
            qr.setThreshold(1e-9);
            left_over -= C * qr.compute(C).solve(left_over).eval();
        }
        raise(worst.force, Vector3d(left_over.head<3>()));
        raise(worst.moment, Vector3d(system.length * left_over.tail<3>()));
    }
    for (const auto& balance : judge.balances) {
        raise(worst.force, balance.force);
        raise(worst.moment, balance.moment);
    }
    return worst;
}

}  // namespace elastocheck::reference::equilibrium
