// Random mechanisms: one to three bodies on random bushings, springs and joints, loaded until most
// are far from their start.
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Attachments are consistent in the design pose and given in ground axes.
struct Builder {
    Scene scene;

    Pose pose(BodyId b) const {
        return b == ground ? Pose{} : scene.bodies[static_cast<std::size_t>(b)].design;
    }
    Point point(BodyId b, const Vector3d& p) const {
        return {b, pose(b).p.conjugate() * (p - pose(b).r)};
    }
    Direction direction(BodyId b, const Vector3d& u) const {
        return {b, pose(b).p.conjugate() * u};
    }
    Marker marker(BodyId b, const Vector3d& p, const Quaterniond& A) const {
        return {b, point(b, p).s_local, pose(b).p.conjugate() * A};
    }
};

JointKind random_joint(const Builder& at, Random& random, int kind, BodyId i, BodyId j) {
    const Vector3d p = random.vector(0.5), q = random.vector(0.5), u = random.unit();
    switch (kind) {
        case 0: return Distance{at.point(i, p), at.point(j, q), (p - q).norm()};
        case 1: return InPlane{at.point(i, p), at.point(j, p), at.direction(j, u)};
        case 2: return Perpendicular{at.direction(i, u), at.direction(j, u.unitOrthogonal())};
        case 3: return Spherical{at.point(i, p), at.point(j, p)};
        case 4:
            return Cylindrical{at.point(i, p), at.point(j, p), at.direction(i, u),
                               at.direction(j, u)};
        default:
            return Universal{at.point(i, p), at.point(j, p), at.direction(i, u),
                             at.direction(j, u.unitOrthogonal())};
    }
}

Scene random_scene(int number, Random& random) {
    Builder at;
    const int nb = 1 + number % 3;
    for (int b = 0; b < nb; ++b)
        at.scene.bodies.push_back(
            {fmt::format("body{}", b), {random.vector(0.5), random.rotation()}});
    const double rate = std::pow(10, random(4, 7)), rotational_rate = std::pow(10, random(2, 4));
    for (int b = 0; b < nb; ++b) {
        for (const BodyId to : {ground, b + 1 < nb ? b + 1 : ground}) {
            const Vector3d p = random.vector(0.5);
            const Quaterniond A = random.rotation();
            Bushing bushing{at.marker(b, p, A), at.marker(to, p, A), LinearStiffness{},
                            Vector6::Zero()};
            for (int k = 0; k < 6; ++k)
                stiffness_of(bushing)(k, k) =
                    (k < 3 ? rate : rotational_rate) * std::pow(10, random(-1, 1));
            if (number % 5 == 0) bushing.preload = random.many(6, 50);
            at.scene.elastics.push_back({"bushing", bushing});
        }
    }
    const Vector3d p = random.vector(0.5), q = random.vector(0.5);
    if (number % 2 == 1)
        at.scene.elastics.push_back(
            {"spring", AxialSpring{at.point(0, p), at.point(ground, q), LinearRate{rate},
                                   (p - q).norm() * random(0.9, 1.1)}});
    for (int k = 0; k < number % 4; ++k) {
        const BodyId i = number % nb, j = nb > 1 && number / 7 % 2 == 1 ? (i + 1) % nb : ground;
        at.scene.joints.push_back(
            {fmt::format("joint{}", k), random_joint(at, random, (number / 3 + k) % 6, i, j)});
    }
    Branch branch = load_branch(
        "push", {{"force", DeadForce{{nb - 1, random.vector(0.3)}, random.unit()}}}, 5000, 20);
    if (number % 3 == 0)
        branch.drivers.push_back({Load{"moment", DeadMoment{0, random.vector(0.1)}}, 0, 1});
    at.scene.branches = {branch};
    at.scene.probes = {{"probe", {nb - 1, Vector3d::Zero()}}};
    return at.scene;
}

TEST(RandomMechanisms, AreSolvedAlikeInOneStepAndInTwentyOrDeclined) {
    Random random;
    int solved = 0;
    double worst = 0, worst_residual = 0;
    for (int number = 0; number < 300; ++number) {
        const Scene scene = random_scene(number, random);
        const Model model = compile(scene);
        const Branch& branch = model.branches[0];
        const auto fine = solve(model, branch, sweep(branch));
        ASSERT_EQ(fine.outcome == Outcome::converged, fine.points.size() == 21) << number;
        for (const auto& state : fine.points)
            worst_residual = std::max(worst_residual, largest(residuals(model, branch, state)));
        if (fine.outcome != Outcome::converged) continue;
        ++solved;
        const double once[] = {branch.to};
        const auto coarse = solve(model, branch, once);
        ASSERT_EQ(coarse.outcome, Outcome::converged) << number << ": " << coarse.detail;
        for (std::size_t b = 0; b < model.bodies.size(); ++b) {
            const double apart =
                (coarse.points[0].poses[b].r - fine.points.back().poses[b].r).norm();
            EXPECT_LE(apart, 1e-8) << number;
            worst = std::max(worst, apart);
        }
    }
    EXPECT_GE(solved, 270);
    EXPECT_LE(worst_residual, 1e-4);  // rounding of a position times rates up to 1e8 N/m
    RecordProperty("solved", solved);
    RecordProperty("worst", fmt::format("{:.1e} m", worst));
}

}  // namespace
}  // namespace elastocheck::reference::energy
