// Forces of springs and bushings in every law and formulation, against the energies stated in
// include/elastocheck/mechanism.hpp: at any poses the loads that balance the stated forces leave no
// residual in any leg.
#include <algorithm>

#include "elastocheck/compile.hpp"
#include "tests/legs/legs.hpp"

namespace elastocheck::legs {
namespace {

using Real = long double;
using Vector3L = Eigen::Matrix<Real, 3, 1>;
using Matrix3L = Eigen::Matrix<Real, 3, 3>;
using Vector6L = Eigen::Matrix<Real, 6, 1>;
using Wrenches = Eigen::Matrix<Real, 12, 1>;  // (force, moment about the origin) on i, then on j
using Angles = Formulation::Angles;
using Frame = Formulation::Frame;

// ---- The stated laws.

Real force(const ScalarLaw& law, Real x) {
    const auto* line = std::get_if<LinearRate>(&law);
    return line != nullptr ? static_cast<Real>(line->k) * x : stated_force(std::get<Curve>(law), x);
}
// ∫₀ˣ f by Simpson's rule from knot to knot, which is exact for cubics.
Real energy(const ScalarLaw& law, Real x) {
    std::vector<Real> ends{0, x};
    if (const auto* curve = std::get_if<Curve>(&law))
        for (const Real knot : curve->knots)
            if (knot * (knot - x) < 0) ends.push_back(knot);
    std::ranges::sort(ends);
    Real sum = 0;
    for (std::size_t k = 1; k < ends.size(); ++k) {
        const Real a = ends[k - 1], b = ends[k], inside = (b - a) * 1e-15L;
        sum += (b - a) / 6 *
               (force(law, a + inside) + 4 * force(law, (a + b) / 2) + force(law, b - inside));
    }
    return x < 0 ? -sum : sum;
}
Real energy(const SpatialLaw& law, const Vector6L& e) {
    if (const auto* linear = std::get_if<LinearStiffness>(&law))
        return e.dot(linear->K.cast<Real>() * e) / 2;
    Real sum = 0;
    for (int k = 0; k < 6; ++k)
        sum += energy(std::get<PerAxis>(law).axis[static_cast<std::size_t>(k)], e[k]);
    return sum;
}

// ---- The stated geometry.

struct Place {
    Vector3L r;
    Matrix3L A;
};
Place moved(Place p, int coordinate, Real by) {
    if (coordinate < 3)
        p.r[coordinate] += by;
    else
        p.A = Eigen::AngleAxis<Real>(by, Vector3L::Unit(coordinate - 3)).toRotationMatrix() * p.A;
    return p;
}
Place place(const Pose& p) {
    return {p.r.cast<Real>(), p.p.cast<Real>().normalized().toRotationMatrix()};
}
Vector3L at(const Place& p, const Vector3d& s) { return p.r + p.A * s.cast<Real>(); }
Matrix3L axes(const Place& p, const Marker& m) {
    return p.A * m.A_local.cast<Real>().normalized().toRotationMatrix();
}

// (d, θ) without `undeformed`, with the frame on i or in the middle.
Vector6L deformation(const Bushing& b, const Place& i, const Place& j) {
    const Matrix3L A_i = axes(i, b.i), B = A_i.transpose() * axes(j, b.j);
    const Eigen::AngleAxis<Real> turn(B);
    Vector3L d = A_i.transpose() * (at(j, b.j.s_local) - at(i, b.i.s_local)), theta;
    if (b.formulation.frame == Frame::middle)
        d = Eigen::AngleAxis<Real>(-turn.angle() / 2, turn.axis()) * d;
    if (b.formulation.angles == Angles::rotation_vector)
        theta = turn.angle() * turn.axis();
    else if (b.formulation.angles == Angles::cardan)
        theta << std::atan2(-B(1, 2), B(2, 2)), std::asin(B(0, 2)), std::atan2(-B(0, 1), B(0, 0));
    else
        theta << std::atan2(-B(1, 2), B(2, 2)), std::atan2(B(0, 2), B(2, 2)),
            std::atan2(B(1, 0), B(0, 0));
    Vector6L e;
    e << d, theta;
    return e;
}
// A frame on j is that of the bushing with exchanged markers and the opposite deformation.
Vector6L stated_deformation(Bushing b, const Place& i, const Place& j) {
    if (b.formulation.frame != Frame::on_j) return deformation(b, i, j);
    std::swap(b.i, b.j);
    b.formulation.frame = Frame::on_i;
    return -deformation(b, j, i);
}
Real energy(const Bushing& b, const Place& i, const Place& j) {
    const Vector6L e = stated_deformation(b, i, j);
    return energy(b.law, e - b.undeformed.cast<Real>()) + b.preload.cast<Real>().dot(e);
}
Real energy(const AxialSpring& s, const Place& i, const Place& j) {
    return energy(
        s.law, (at(j, s.j.s_local) - at(i, s.i.s_local)).norm() - static_cast<Real>(s.free_length));
}

// At zero, by central differences of sixth order.
template <class Function>
Real slope(const Function& U) {
    constexpr Real h = 1e-3L;
    return (45 * (U(h) - U(-h)) - 9 * (U(2 * h) - U(-2 * h)) + (U(3 * h) - U(-3 * h))) / (60 * h);
}
template <class Element>
Wrenches negative_gradient(const Element& element, const Place& i, const Place& j) {
    Wrenches w;
    for (int k = 0; k < 6; ++k) {
        w[k] = -slope([&](Real h) { return energy(element, moved(i, k, h), j); });
        w[6 + k] = -slope([&](Real h) { return energy(element, i, moved(j, k, h)); });
    }
    return w;
}
// Forces that are not conjugate: F = ∂u/∂e + preload along the axes of i, at p_j on both bodies with
// the moment of the offset, else at the own marker of each.
Wrenches stated_without_energy(const Bushing& b, const Place& i, const Place& j) {
    const Vector6L e = deformation(b, i, j) - b.undeformed.cast<Real>();
    Vector6L stress = b.preload.cast<Real>();
    if (const auto* linear = std::get_if<LinearStiffness>(&b.law))
        stress += linear->K.cast<Real>() * e;
    else
        for (int k = 0; k < 6; ++k)
            stress[k] += force(std::get<PerAxis>(b.law).axis[static_cast<std::size_t>(k)], e[k]);
    const Vector3L F = axes(i, b.i) * stress.head<3>(), M = axes(i, b.i) * stress.tail<3>(),
                   p_j = at(j, b.j.s_local),
                   acts_at = b.formulation.offset_moment ? p_j : at(i, b.i.s_local);
    Wrenches w;
    w << F, (acts_at - i.r).cross(F) + M, -F, -(p_j - j.r).cross(F) - M;
    return w;
}
// Conjugate forces without the moment of the offset: F acts at the own marker of each body, and the
// moment is -∂U/∂φ of j turning against i at constant d.
Wrenches stated_without_offset(Bushing b, const Place& i, const Place& j) {
    b.formulation.offset_moment = true;
    const Vector3L F = negative_gradient(b, i, j).segment<3>(6);
    const auto U = [&](const Place& turned) {
        Vector6L e = deformation(b, i, j);
        e.tail<3>() = deformation(b, i, turned).tail<3>();
        return energy(b.law, e - b.undeformed.cast<Real>()) + b.preload.cast<Real>().dot(e);
    };
    Vector3L M;
    for (int k = 0; k < 3; ++k) M[k] = -slope([&](Real h) { return U(moved(j, 3 + k, h)); });
    Wrenches w;
    w << -F, -(at(i, b.i.s_local) - i.r).cross(F) - M, F, (at(j, b.j.s_local) - j.r).cross(F) + M;
    return w;
}

// ---- The claim.

struct Elements : LegTest {
    // Two bodies at these poses under loads opposite to `stated`: the residual relative to them.
    double left_over(const ElasticKind& element, const std::vector<Pose>& poses,
                     const Wrenches& stated) const {
        Scene s;
        s.bodies = {{"i", {}}, {"j", {}}};
        s.elastics = {{"element", element}};
        for (const BodyId b : {0, 1}) {
            const Vector6 w = -stated.segment<6>(6 * b).cast<double>();
            s.static_loads.push_back({"f", DeadForce{{b}, w.head<3>()}});
            s.static_loads.push_back({"m", DeadMoment{b, w.tail<3>()}});
        }
        s.branches = {branch_of({}, 1)};
        s.probes = {{"i", {0}}, {"j", {1}}};
        const Residuals r =
            residuals(leg(), side_of(compile(s, Detail::everything)), {0, poses, {}, 0});
        return std::fmax(r.force, r.moment) / static_cast<double>(stated.cwiseAbs().maxCoeff());
    }
};
ELASTOCHECK_FOR(exact_legs, Elements);

// Rising cubics between knots at ±1.5 [m] or [rad] with other slopes outside, and a kink at 0.2.
Curve curve(Random& random, double rate) {
    const double a = rate * random(0.3, 1), b = 0.3 * rate * random(0.3, 1), c = rate * random(),
                 kink = rate * random(0.3, 1), t = 1.7;
    const auto f = [&](double h) { return -1.6 * a + h * (a + h * (b + h * c)); };
    const double at_kink = f(t), at_end = at_kink + 1.3 * kink;
    return {{-1.5, 0.2, 1.5},
            {{f(0), rate, 0, 0}, {f(0), a, b, c}, {at_kink, kink, 0, 0}, {at_end, rate, 0, 0}}};
}
Bushing random_bushing(Random& random, bool curves, const Formulation& formulation) {
    Bushing b{{0, random.vector(0.3), random.rotation()},
              {1, random.vector(0.3), random.rotation()},
              LinearStiffness{random.stiffness()}};
    if (curves) {
        PerAxis law;
        for (std::size_t k = 0; k < 6; ++k)
            law.axis[k] = k % 3 == 1 ? ScalarLaw{LinearRate{k < 3 ? 2e5 : 800.}}
                                     : ScalarLaw{curve(random, k < 3 ? 2e5 : 800.)};
        b.law = law;
    }
    b.preload = random.wrench(500, 20);
    b.undeformed << random.vector(0.01), random.vector(0.1);
    b.formulation = formulation;
    return b;
}
// The markers turned against each other by `angle`, with a small offset.
std::vector<Pose> poses_of(Random& random, const Bushing& b, double angle) {
    const Pose i{random.vector(0.3), random.rotation()};
    Pose j;
    j.p = (i.p * b.i.A_local * Eigen::AngleAxisd(angle, random.unit()) * b.j.A_local.conjugate())
              .normalized();
    j.r = i.r + i.p * b.i.s_local - j.p * b.j.s_local + random.vector(0.05);
    return {i, j};
}
// A difference must not reach over a kink.
bool near_a_kink(const Bushing& b, const Place& i, const Place& j) {
    if (!std::holds_alternative<PerAxis>(b.law)) return false;
    const Vector6L e = stated_deformation(b, i, j) - b.undeformed.cast<Real>();
    for (const double knot : {-1.5, 0.2, 1.5})
        if ((e.array() - static_cast<Real>(knot)).abs().minCoeff() < 0.02L) return true;
    return false;
}

TEST_P(Elements, ForceOfASpringIsTheNegativeGradientOfItsEnergy) {
    Random random;
    Worst worst;
    for (int trial = 0; trial < 100; ++trial) {
        AxialSpring spring{
            {0, random.vector(0.3)}, {1, random.vector(0.3)}, LinearRate{3e4}, random(0.4, 2)};
        if (trial % 2 == 1) spring.law = curve(random, 3e4);
        const std::vector<Pose> poses{{random.vector(0.3), random.rotation()},
                                      {random.vector(0.3) + 1.2 * X, random.rotation()}};
        const Place i = place(poses[0]), j = place(poses[1]);
        const Real x = (at(j, spring.j.s_local) - at(i, spring.i.s_local)).norm() -
                       static_cast<Real>(spring.free_length);
        if (std::abs(x - 0.2L) < 0.02L || std::abs(x) < 0.02L) continue;
        worst.add(left_over(spring, poses, negative_gradient(spring, i, j)), trial);
    }
    EXPECT_TRUE(within(worst, 1e-11));
}

// Full 6×6 rates and curves, preload, undeformed offset, any marker axes, from no rotation to
// beyond a right angle.
TEST_P(Elements, ForceOfABushingIsTheNegativeGradientOfItsEnergy) {
    Random random;
    for (const Frame frame : {Frame::on_i, Frame::on_j, Frame::middle})
        for (const Angles angles : {Angles::rotation_vector, Angles::cardan, Angles::projected})
            for (const bool curves : {false, true}) {
                Worst worst;
                for (const double angle :
                     {0., 1e-9, 1e-6, 1e-3, 0.03, 0.0999, 0.1001, 0.3, 1., 1.4, 2., 3.}) {
                    if (angle > 1.4 && angles != Angles::rotation_vector) continue;
                    for (int trial = 0; trial < 8; ++trial) {
                        const Bushing b = random_bushing(random, curves, {frame, angles});
                        const auto poses = poses_of(random, b, angle);
                        const Place i = place(poses[0]), j = place(poses[1]);
                        if (near_a_kink(b, i, j)) continue;
                        worst.add(left_over(b, poses, negative_gradient(b, i, j)), angle);
                    }
                }
                EXPECT_TRUE(within(worst, 1e-10))
                    << static_cast<int>(frame) << static_cast<int>(angles) << curves;
            }
}

TEST_P(Elements, ForceOfABushingWithoutEnergyEqualsItsDefinition) {
    if (leg().needs_energy()) GTEST_SKIP() << "no energy";
    Random random;
    for (const Angles angles : {Angles::rotation_vector, Angles::cardan, Angles::projected})
        for (const bool offset : {true, false}) {
            Worst worst;
            for (int trial = 0; trial < 20; ++trial) {
                const Bushing b =
                    random_bushing(random, trial % 2 == 1, {Frame::on_i, angles, false, offset});
                const auto poses = poses_of(random, b, 0.8);
                worst.add(
                    left_over(b, poses, stated_without_energy(b, place(poses[0]), place(poses[1]))),
                    trial);
            }
            EXPECT_TRUE(within(worst, 1e-12)) << static_cast<int>(angles) << offset;
        }
    for (const Frame frame : {Frame::on_i, Frame::middle})
        for (const Angles angles : {Angles::rotation_vector, Angles::cardan, Angles::projected}) {
            Worst worst;
            for (int trial = 0; trial < 20; ++trial) {
                const Bushing b =
                    random_bushing(random, trial % 2 == 1, {frame, angles, true, false});
                const auto poses = poses_of(random, b, 0.8);
                const Place i = place(poses[0]), j = place(poses[1]);
                if (near_a_kink(b, i, j)) continue;
                worst.add(left_over(b, poses, stated_without_offset(b, i, j)), trial);
            }
            EXPECT_TRUE(within(worst, 1e-10))
                << static_cast<int>(frame) << static_cast<int>(angles);
        }
}

// B = R_x(0.2) R_y(0.3) by hand: z of j in the axes of i is (sin 0.3, -sin 0.2 cos 0.3, cos 0.2
// cos 0.3), x of j is (cos 0.3, sin 0.2 sin 0.3, -cos 0.2 sin 0.3).
TEST_P(Elements, ProjectedAngleBushingEqualsItsFormula) {
    if (leg().needs_energy()) GTEST_SKIP() << "no energy";
    Bushing b = bushing({0, 0.1 * X}, {1}, {1e5, 2e5, 3e5}, {100, 200, 300});
    b.preload << 10, 20, 30, 1, 2, 3;
    const Pose j{{0.11, -0.02, 0.03}, Eigen::AngleAxisd(0.2, X) * Eigen::AngleAxisd(0.3, Y)};
    const Vector3d F(1e5 * 0.01 + 10, -2e5 * 0.02 + 20, 3e5 * 0.03 + 30),
        M(100 * 0.2 + 1, 200 * std::atan(std::tan(0.3) / std::cos(0.2)) + 2,
          300 * std::atan(std::sin(0.2) * std::tan(0.3)) + 3);
    for (const bool offset : {true, false}) {
        b.formulation = {Frame::on_i, Angles::projected, false, offset};
        Eigen::Matrix<double, 12, 1> by_hand;
        by_hand << F, M + (offset ? j.r : Vector3d(0.1, 0, 0)).cross(F), -F, -M;
        EXPECT_LE(left_over(b, {{}, j}, by_hand.cast<Real>()), 1e-14);
    }
}

// A bushing that is drawn deformed settles where its force is zero.
TEST_P(Elements, BushingSettlesToItsUndeformedOffset) {
    for (const Frame frame : {Frame::on_i, Frame::middle}) {
        Scene s;
        s.bodies = {{"body", {}}};
        Bushing b = bushing({ground}, {0}, {1e5, 2e5, 3e5}, {500, 600, 700});
        b.undeformed << 0.003, -0.002, 0.001, 0.02, 0.01, -0.03;
        b.formulation.frame = frame;
        s.elastics = {{"bushing", b}};
        s.branches = {load_branch(DeadForce{{0}, X}, 1)};
        s.probes = {{"body", {0}}};
        const Pose at_rest = solved(leg(), side_of(s), 1).points[0].poses[0];
        const Vector6L e = deformation(b, place({}), place(at_rest));
        EXPECT_LE((e.cast<double>() - b.undeformed).norm(), 1e-11);
    }
}

}  // namespace
}  // namespace elastocheck::legs
