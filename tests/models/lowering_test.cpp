// Lowering of joints to constraints.
// For bodies with any poses the constraints hold at the design pose, remain satisfied along the
// joint's own motions of any size, and are linearly independent.
#include "models/lowering.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <random>

#include "tests/models/constraint_values.hpp"

namespace elastocheck {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double round_off = 1e-14;  // of a few rotations of points two metres out [m], [-]

struct Random {
    std::mt19937 engine{1788};
    std::uniform_real_distribution<double> uniform{-1, 1};
    double operator()() { return uniform(engine); }
    Vector3d vector() { return {(*this)(), (*this)(), (*this)()}; }
    Quaterniond orientation() {
        return Quaterniond((*this)(), (*this)(), (*this)(), (*this)()).normalized();
    }
};

// ---- Motions.

struct Turn {
    Vector3d centre, axis;
};
struct Shift {
    Vector3d along;
};
using Motion = std::variant<Turn, Shift>;

Pose moved(const Pose& pose, const Motion& motion, double amount) {
    if (const auto* shift = std::get_if<Shift>(&motion))
        return {pose.r + amount * shift->along, pose.p};
    const auto& [centre, axis] = std::get<Turn>(motion);
    const Quaterniond turn(Eigen::AngleAxisd(amount, axis.normalized()));
    return {centre + turn * (pose.r - centre), (turn * pose.p).normalized()};
}

// Φ_q of one body for infinitesimal displacements and rotations about its origin, by central
// differences [m × 6].
Eigen::MatrixXd jacobian(const std::vector<ConstraintKind>& constraints, const Poses& poses,
                         std::size_t body) {
    const double h = 1e-5;
    Eigen::MatrixXd J(Phi(constraints, poses).size(), 6);
    for (int column = 0; column < 6; ++column) {
        const Vector3d axis = Vector3d::Unit(column % 3);
        const Motion motion = column < 3 ? Motion(Shift{axis}) : Motion(Turn{poses[body].r, axis});
        Poses ahead = poses, behind = poses;
        ahead[body] = moved(poses[body], motion, h);
        behind[body] = moved(poses[body], motion, -h);
        J.col(column) = (Phi(constraints, ahead) - Phi(constraints, behind)) / (2 * h);
    }
    return J;
}

Eigen::Index rank(const Eigen::MatrixXd& J) {
    const Eigen::VectorXd singular_values = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
    return (singular_values.array() > 1e-6).count();
}

// ---- One joint of every kind at a place in ground axes, with the free motions of body i.

struct Place {
    BodyId i, j;
    const std::vector<Body>& bodies;
    Vector3d p, other;  // the joint's point, and a second one
    Vector3d u, v, w;   // perpendicular unit directions; u is the joint's axis

    Pose design(BodyId body) const {
        return body == ground ? Pose{} : bodies[static_cast<std::size_t>(body)].design;
    }
    Point point(BodyId body, const Vector3d& x) const {
        return {body, design(body).p.conjugate() * (x - design(body).r)};
    }
    Direction direction(BodyId body, const Vector3d& x) const {
        return {body, (design(body).p.conjugate() * x).normalized()};
    }
};

struct Lowered {
    const char* name;
    JointKind kind;
    int rows;
    std::vector<Motion> freedoms;  // of body i, in an order in which they can be combined
};

std::vector<Lowered> all_joints(const Place& at) {
    const Point p_i = at.point(at.i, at.p), p_j = at.point(at.j, at.p),
                far_j = at.point(at.j, at.other);
    const Direction u_i = at.direction(at.i, at.u), u_j = at.direction(at.j, at.u);
    const Direction v_i = at.direction(at.i, at.v), v_j = at.direction(at.j, at.v);
    const Turn about_u{at.p, at.u}, about_v{at.p, at.v}, about_w{at.p, at.w};
    const Shift along_u{at.u}, along_v{at.v}, along_w{at.w};
    const Vector3d rod = at.other - at.p;
    // The rotation about the rod is the same for both of its ends.
    const Turn about_a{at.p, rod.unitOrthogonal()}, about_b{at.p, rod.cross(rod.unitOrthogonal())},
        about_rod{at.p, rod};
    const Turn around_a{at.other, about_a.axis}, around_b{at.other, about_b.axis};
    const double angle = 2.3;
    const Vector3d leaning = std::cos(angle) * at.v + std::sin(angle) * at.w;
    const Turn about_leaning{at.p, leaning}, about_across{at.p, leaning.cross(at.u)};
    return {
        {"spherical", Spherical{p_i, p_j}, 3, {about_u, about_v, about_w}},
        {"revolute", Revolute{p_i, p_j, u_i, u_j}, 5, {about_u}},
        {"universal", Universal{p_i, p_j, u_i, v_j}, 4, {about_u, about_v}},
        {"cylindrical", Cylindrical{p_i, p_j, u_i, u_j}, 4, {about_u, along_u}},
        {"translational", Translational{p_i, p_j, u_i, u_j}, 5, {along_u}},
        {"planar", Planar{p_i, p_j, u_i, u_j}, 3, {about_u, along_v, along_w}},
        {"fixed", Fixed{p_i, p_j, u_i, v_i, u_j, v_j}, 6, {}},
        {"distance",
         Distance{p_i, far_j, rod.norm()},
         1,
         {about_a, about_b, about_rod, around_a, around_b}},
        {"in_plane",
         InPlane{p_i, far_j, u_j, -at.u.dot(rod)},
         1,
         {about_u, about_v, about_w, along_v, along_w}},
        {"in_line", InLine{p_i, p_j, u_j}, 2, {about_u, about_v, about_w, along_u}},
        {"perpendicular",
         Perpendicular{u_i, v_j},
         1,
         {about_u, about_v, along_u, along_v, along_w}},
        {"parallel", Parallel{u_i, u_j}, 2, {about_u, along_u, along_v, along_w}},
        {"angle",
         Angle{at.direction(at.i, leaning), v_j, at.direction(at.j, at.w), angle},
         1,
         {about_leaning, about_across, along_u, along_v, along_w}},
    };
}

// Calls check(place, joint) for every joint between two bodies, body and ground, and ground and
// body, at many random places.
template <class Check>
void sweep(Check check) {
    Random random;
    for (int n = 0; n < 40; ++n) {
        const std::vector<Body> bodies{{"one", {random.vector(), random.orientation()}},
                                       {"two", {random.vector(), random.orientation()}}};
        const Quaterniond frame = random.orientation();
        for (const auto& [i, j] :
             {std::pair<BodyId, BodyId>{0, 1}, {1, 0}, {0, ground}, {ground, 1}}) {
            const Place place{i,
                              j,
                              bodies,
                              random.vector(),
                              random.vector(),
                              frame * Vector3d::UnitX(),
                              frame * Vector3d::UnitY(),
                              frame * Vector3d::UnitZ()};
            for (const Lowered& joint : all_joints(place)) {
                SCOPED_TRACE(fmt::format("{} between {} and {}, place {}", joint.name, i, j, n));
                check(place, joint, lower(joint.kind, bodies),
                      Poses{bodies[0].design, bodies[1].design});
            }
        }
    }
}

TEST(Lowering, RowsOfEachJointAreIndependentAndSatisfiedAtDesign) {
    std::vector<bool> seen(std::variant_size_v<JointKind>, false);
    sweep([&](const Place& place, const Lowered& joint, const auto& constraints,
              const Poses& design) {
        seen[joint.kind.index()] = true;
        int count = 0;
        for (const auto& constraint : constraints) {
            count += rows(constraint);
            std::visit(
                [&](const auto& c) {  // between the joint's bodies in their order, unit directions
                    EXPECT_EQ(c.i.body, place.i);
                    EXPECT_EQ(c.j.body, place.j);
                    const auto unit = [&](const Direction& u, BodyId body) {
                        EXPECT_EQ(u.body, body);
                        EXPECT_NEAR(u.u_local.norm(), 1, 1e-15);
                    };
                    if constexpr (requires { c.i.u_local; }) unit(c.i, place.i), unit(c.j, place.j);
                    if constexpr (requires { c.normal_j; }) unit(c.normal_j, place.j);
                    if constexpr (requires { c.y_j; }) unit(c.y_j, place.j);
                },
                constraint);
        }
        EXPECT_EQ(count, joint.rows);
        EXPECT_EQ(joint.rows + static_cast<int>(joint.freedoms.size()), 6);
        const Eigen::VectorXd gap = Phi(constraints, design);
        EXPECT_EQ(gap.size(), joint.rows);
        const double worst = gap.cwiseAbs().maxCoeff();
        EXPECT_TRUE(std::isfinite(worst) && worst <= round_off) << worst;
        for (const BodyId body : {place.i, place.j})
            if (body != ground) {
                EXPECT_EQ(rank(jacobian(constraints, design, static_cast<std::size_t>(body))),
                          joint.rows);
            }
    });
    EXPECT_EQ(seen, std::vector<bool>(seen.size(), true)) << "every kind of joint";
}

TEST(Lowering, RowsVanishUnderLargeMotionsThatTheJointAllows) {
    Random random;
    sweep([&](const Place& place, const Lowered& joint, const auto& constraints,
              const Poses& design) {
        if (place.i == ground) return;
        Poses poses = design;
        Pose& pose = poses[static_cast<std::size_t>(place.i)];
        for (const Motion& motion : joint.freedoms) pose = moved(pose, motion, 3 * random());
        const double worst = Phi(constraints, poses).cwiseAbs().maxCoeff();
        EXPECT_TRUE(std::isfinite(worst) && worst <= round_off) << worst;
    });
}

TEST(Lowering,
     FreeMotionsOfAJointAreLinearlyIndependent) {  // checks that the table above lists all freedoms
    sweep([&](const Place& place, const Lowered& joint, const auto&, const Poses& design) {
        if (place.i == ground || joint.freedoms.empty()) return;
        const Pose& pose = design[static_cast<std::size_t>(place.i)];
        Eigen::MatrixXd twists(6, static_cast<Eigen::Index>(joint.freedoms.size()));
        for (std::size_t k = 0; k < joint.freedoms.size(); ++k) {
            const auto column = static_cast<Eigen::Index>(k);
            if (const auto* shift = std::get_if<Shift>(&joint.freedoms[k])) {
                twists.col(column) << shift->along, Vector3d::Zero();
            } else {
                const auto& [centre, axis] = std::get<Turn>(joint.freedoms[k]);
                twists.col(column) << axis.normalized().cross(pose.r - centre), axis.normalized();
            }
        }
        EXPECT_EQ(rank(twists), twists.cols());
    });
}

}  // namespace
}  // namespace elastocheck
