// Constraint functions Φ and their Jacobian Φ_q, eqs. (1), (6)-(7).
#include "recursive/formula/constraints.hpp"

#include <gtest/gtest.h>

#include "models/lowering.hpp"
#include "tests/recursive/random.hpp"

namespace elastocheck::recursive {
namespace {

Direction direction(BodyId body, Random& random) { return {body, random.unit()}; }
Point point(BodyId body, Random& random) { return {body, random.vector()}; }

std::vector<JointKind> every_joint(BodyId i, BodyId j, Random& r) {
    const auto p = [&](BodyId b) { return point(b, r); };
    const auto u = [&](BodyId b) { return direction(b, r); };
    return {Spherical{p(i), p(j)},
            Revolute{p(i), p(j), u(i), u(j)},
            Universal{p(i), p(j), u(i), u(j)},
            Cylindrical{p(i), p(j), u(i), u(j)},
            Translational{p(i), p(j), u(i), u(j)},
            Planar{p(i), p(j), u(i), u(j)},
            Fixed{p(i), p(j), u(i), u(i), u(j), u(j)},
            Distance{p(i), p(j), r(0.5, 2)},
            InPlane{p(i), p(j), u(j), r(-1, 1)},
            InLine{p(i), p(j), u(j)},
            Perpendicular{u(i), u(j)},
            Parallel{u(i), u(j)},
            Angle{u(i), u(j), u(j), r(-4, 4)}};
}

Model model_with(const JointKind& joint, int bodies) {
    Model model;
    model.bodies.resize(static_cast<std::size_t>(bodies));
    for (const auto& kind : lower(joint, model.bodies)) model.constraints.push_back({0, kind});
    return model;
}

TEST(Constraints, JacobianIsTheDerivativeForEveryJointAtRandomPoses) {
    Random random;
    for (const auto& [i, j] : {std::pair<BodyId, BodyId>{0, 1}, {1, 0}, {0, ground}, {ground, 0}}) {
        for (int trial = 0; trial < 20; ++trial) {
            for (const auto& joint : every_joint(i, j, random)) {
                const Model model = model_with(joint, 2);
                const State<double> q = random.state(2);
                const auto Phi_q =
                    constraint_jacobian<double>(model, inputs_as_drawn<double>(model), q);
                double worst = 0;
                for (int c = 0; c < 12; ++c) {
                    constexpr double h = 1e-5;
                    Vector<double> dq = Vector<double>::Zero(12);
                    State<double> plus = q, minus = q;
                    dq[c] = h;
                    advance(plus, dq);
                    advance(minus, (-dq).eval());
                    const Vector<double> difference =
                        (constraint_values<double>(model, inputs_as_drawn<double>(model), plus) -
                         constraint_values<double>(model, inputs_as_drawn<double>(model), minus)) /
                        (2 * h);
                    worst = std::max(worst, (difference - Phi_q.col(c)).cwiseAbs().maxCoeff());
                }
                EXPECT_LE(worst, 2e-9)
                    << "joint kind " << joint.index() << ", bodies " << i << " " << j;
            }
        }
    }
}

TEST(Constraints, RigidMotionOfAllBodiesKeepsValuesAndJacobian) {
    Random random;
    for (int trial = 0; trial < 20; ++trial) {
        for (const auto& joint : every_joint(0, 1, random)) {
            const Model model = model_with(joint, 2);
            std::vector<Pose> poses{random.pose(), random.pose()};
            const Vector<double> before = constraint_values<double>(
                model, inputs_as_drawn<double>(model), state_of<double>(poses));
            const Pose move = random.pose();
            for (auto& pose : poses) pose = {move.r + move.p * pose.r, move.p * pose.p};
            const Vector<double> after = constraint_values<double>(
                model, inputs_as_drawn<double>(model), state_of<double>(poses));
            // Coincidence is written in ground axes: its three rows rotate, their
            // norm is unchanged.
            if (std::holds_alternative<CoincidentPoints>(model.constraints.front().kind))
                EXPECT_NEAR(before.head<3>().norm(), after.head<3>().norm(), 1e-13);
            else
                EXPECT_LE((before - after).cwiseAbs().maxCoeff(), 1e-13)
                    << "joint kind " << joint.index();
        }
    }
}

TEST(StateUpdate, RotationIncrementIsTheExponentialMapInGroundAxes) {
    Random random;
    for (const double angle : {0.0, 1e-300, 1e-12, 1e-3, 1.0, 3.0}) {
        State<double> q = random.state(1);
        const Pose before{q[0].r, q[0].p};
        Vector<double> dq(6);
        dq << random.vector(), angle * random.unit();
        advance(q, dq);
        const Eigen::Vector3d dpi = dq.tail<3>();
        const Eigen::Matrix3d expected =
            (angle > 0 ? Eigen::Matrix3d(Eigen::AngleAxisd(dpi.norm(), dpi.normalized()))
                       : Eigen::Matrix3d::Identity()) *
            before.p.toRotationMatrix();
        EXPECT_LE((q[0].A - expected).cwiseAbs().maxCoeff(), 1e-15) << angle;
        EXPECT_EQ(q[0].r, before.r + dq.head<3>());
    }
}

}  // namespace
}  // namespace elastocheck::recursive
