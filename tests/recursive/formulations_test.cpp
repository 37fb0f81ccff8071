// Laws, formulations and followers against an independent implementation of include/elastocheck/mechanism.hpp.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "models/laws.hpp"
#include "recursive/formula/elastic.hpp"
#include "recursive/stepping/knots.hpp"
#include "tests/recursive/elements.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;
using Long = long double;
using Matrix3L = Matrix3<Long>;
using Vector3L = Vector3<Long>;

// ---- Energy in long double.

Long f_of(const Curve& f, Long x) {
    std::size_t k = 0;
    while (k < f.knots.size() && static_cast<Long>(f.knots[k]) <= x) ++k;
    const Long t = x - static_cast<Long>(f.knots[k == 0 ? 0 : k - 1]);
    Long sum = 0, power = 1;
    for (const double c : f.pieces[k]) sum += static_cast<Long>(c) * power, power *= t;
    return sum;
}
// ∫₀ˣ f by Simpson's rule, which is exact for cubics, from knot to knot.
Long energy_of(const Curve& f, Long x) {
    std::vector<Long> at{0, x};
    for (const double knot : f.knots)
        if ((static_cast<Long>(knot) - 0) * (static_cast<Long>(knot) - x) < 0) at.push_back(knot);
    std::sort(at.begin(), at.end());
    Long sum = 0;
    for (std::size_t k = 1; k < at.size(); ++k) {
        const Long a = at[k - 1], b = at[k], inside = (b - a) * 1e-12L;
        sum += (b - a) / 6 * (f_of(f, a + inside) + 4 * f_of(f, (a + b) / 2) + f_of(f, b - inside));
    }
    return x < 0 ? -sum : sum;
}
Long energy_of(const ScalarLaw& law, Long x) {
    if (const auto* linear = std::get_if<LinearRate>(&law))
        return static_cast<Long>(linear->k) * x * x / 2;
    return energy_of(std::get<Curve>(law), x);
}
Long energy_of(const SpatialLaw& law, const Vector6<Long>& e) {
    if (const auto* linear = std::get_if<LinearStiffness>(&law))
        return e.dot(linear->K.cast<Long>() * e) / 2;
    Long sum = 0;
    for (int k = 0; k < 6; ++k)
        sum += energy_of(std::get<PerAxis>(law).axis[static_cast<std::size_t>(k)], e[k]);
    return sum;
}

Vector6<Long> measured(const Bushing& b, const State<Long>& q) {
    const auto axes = [&](const Marker& m) -> Matrix3L {
        return q[m.body].p.toRotationMatrix() * m.A_local.cast<Long>().toRotationMatrix();
    };
    const auto place = [&](const Marker& m) -> Vector3L {
        return q[m.body].r + q[m.body].p.toRotationMatrix() * m.s_local.cast<Long>();
    };
    const Matrix3L A_i = axes(b.i), B = A_i.transpose() * axes(b.j);
    const Eigen::AngleAxis<Long> turn(B);
    Vector3L d = A_i.transpose() * (place(b.j) - place(b.i)), theta = Vector3L::Zero();
    if (b.formulation.frame == Formulation::Frame::middle)
        d = Eigen::AngleAxis<Long>(-turn.angle() / 2, turn.axis()).toRotationMatrix() * d;
    switch (b.formulation.angles) {
        case Formulation::Angles::rotation_vector: theta = turn.angle() * turn.axis(); break;
        case Formulation::Angles::cardan:
            theta = {std::atan2(-B(1, 2), B(2, 2)), std::asin(B(0, 2)),
                     std::atan2(-B(0, 1), B(0, 0))};
            break;
        case Formulation::Angles::projected:
            theta = {std::atan2(-B(1, 2), B(2, 2)), std::atan2(B(0, 2), B(2, 2)),
                     std::atan2(B(1, 0), B(0, 0))};
            break;
    }
    Vector6<Long> e;
    e << d, theta;
    return e - b.undeformed.cast<Long>();
}
Long energy(const Bushing& b, const State<Long>& q) {
    const Vector6<Long> e = measured(b, q);
    return energy_of(b.law, e) + b.preload.cast<Long>().dot(e);
}
Long energy(const AxialSpring& s, const State<Long>& q) {
    const auto place = [&](const Point& p) -> Vector3L {
        return q[p.body].r + q[p.body].p.toRotationMatrix() * p.s_local.cast<Long>();
    };
    return energy_of(s.law, (place(s.j) - place(s.i)).norm() - static_cast<Long>(s.free_length));
}

// ---- Configurations.

Bushing bushing(Random& random, const Formulation& formulation, bool curves) {
    Bushing b{{0, random.vector(), random.rotation()}, {1, random.vector(), random.rotation()}, {}};
    if (curves)
        b.law = random_axes(random);
    else
        b.law = LinearStiffness{random.stiffness()};
    b.preload = Vector6<double>::NullaryExpr([&] { return random(-500, 500); });
    b.undeformed = Vector6<double>::NullaryExpr([&] { return random(-0.3, 0.3); });
    b.formulation = formulation;
    return b;
}
// Two random poses with the relative rotation B by the given angle about a random axis.
std::vector<Pose> somewhere(const Bushing& b, double angle, Random& random) {
    std::vector<Pose> poses{random.pose(), random.pose()};
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, random.unit()));
    poses[1].p = poses[0].p * b.i.A_local * turn * b.j.A_local.conjugate();
    return poses;
}
Model model_of(const ElasticKind& kind) {
    Model model;
    model.bodies.resize(2);
    model.elastics.push_back({"element", kind});
    return model;
}
template <class Real>
Vector<Real> force_of(const ElasticKind& kind, const State<Real>& q) {
    const Model model = model_of(kind);
    return elastic_force<Real>(model, inputs_as_drawn<Real>(model), q);
}
bool near_a_knot(const ElasticKind& kind, const State<double>& q) {
    const Model model = model_of(kind);
    const auto inputs = inputs_as_drawn<double>(model);
    for (const auto& at : curves_of(model))
        for (const double knot : at.curve->knots)
            if (std::abs(deflection<double>(model, inputs, q, at) - knot) < 1e-2) return true;
    return false;
}

// Largest difference between the force and finite differences (order h⁴) of the energy, relative to
// the force.
template <class Element>
double gradient_error(const Element& element, const std::vector<Pose>& poses) {
    const Vector<Long> f = force_of<Long>(element, state_of<Long>(poses));
    const Long h = 1e-3L;
    Long worst = 0;
    for (int c = 0; c < 12; ++c) {
        const auto at = [&](Long share) {
            State<Long> q = state_of<Long>(poses);
            advance(q, Vector<Long>(share * h * Vector<Long>::Unit(12, c)));
            return energy(element, q);
        };
        const Long slope =
            (45 * (at(1) - at(-1)) - 9 * (at(2) - at(-2)) + (at(3) - at(-3))) / (60 * h);
        worst = std::max(worst, std::abs(slope - f[c]));
    }
    return static_cast<double>(worst / f.cwiseAbs().maxCoeff());
}

TEST(Law, OfACurveIsItsPolynomialAndTheDerivativeOfIt) {
    Random random;
    const Curve f = random_curve(random, 1, 1e3);
    for (double x = -2; x < 2; x += 0.003) {
        const Long h = 1e-4L, at = x;
        EXPECT_NEAR(gradient<double>(f, x), static_cast<double>(f_of(f, at)), 1e-10);
        const bool whole =
            std::ranges::none_of(f.knots, [&](double knot) { return std::abs(knot - x) < 1e-3; });
        if (!whole) continue;
        EXPECT_NEAR(hessian<double>(f, [&] { return x; }),
                    static_cast<double>((8 * (f_of(f, at + h) - f_of(f, at - h)) -
                                         (f_of(f, at + 2 * h) - f_of(f, at - 2 * h))) /
                                        (12 * h)),
                    1e-8);
        EXPECT_NEAR(gradient<double>(f, x),
                    static_cast<double>((energy_of(f, at + h) - energy_of(f, at - h)) / (2 * h)),
                    1e-3);
    }
    for (std::size_t k = 0; k < f.knots.size(); ++k) {
        const auto piece = static_cast<Piece>(k);
        EXPECT_EQ(piece_at(f, f.knots[k]), piece + 1);  // a knot belongs to the piece behind it
        EXPECT_EQ(piece_at(f, std::nextafter(f.knots[k], -9.0)), piece);
        EXPECT_NEAR(gradient<double>(f, f.knots[k], piece),
                    gradient<double>(f, f.knots[k], piece + 1), 1e-10);
    }
}

TEST(Law, HasKinksWhereTheSlopeJumps) {
    EXPECT_EQ(kinks_of(stop(0.03, 3e5)), std::vector<double>{0.03});
    // x³ on one side of 0, zero on the other: C1, with continuous curvature. x² is C1 only.
    EXPECT_TRUE(kinks_of({{0, 1}, {{0, 0, 0, 0}, {0, 0, 1e5, 0}, {1e5, 2e5, 0, 0}}}).empty());
}

TEST(Formulation, WithAnEnergyHasTheForcesOfIt) {
    Random random;
    for (const Formulation& formulation : every_formulation()) {
        double worst = 0;
        int compared = 0;
        for (const double angle : {0.0, 1e-9, 1e-3, 0.03, 0.3, 1.0, 1.4})
            for (const bool curves : {false, true})
                for (int trial = 0; trial < 4; ++trial) {
                    const Bushing b = bushing(random, formulation, curves);
                    const auto poses = somewhere(b, angle, random);
                    if (near_a_knot(b, state_of<double>(poses))) continue;
                    worst = std::max(worst, gradient_error(b, poses));
                    ++compared;
                }
        EXPECT_GT(compared, 30);
        if (has_energy(formulation))
            EXPECT_LE(worst, 1e-11) << name_of(formulation);
        else
            EXPECT_GT(worst, 1e-3) << name_of(formulation) << ": and it is not to have one";
    }
}

TEST(Formulation, OfASpringWithACurveHasTheForcesOfItsEnergy) {
    Random random;
    int compared = 0;
    for (int trial = 0; trial < 50; ++trial) {
        const AxialSpring s{{0, random.vector()},
                            {1, random.vector()},
                            random_curve(random, 1, 1e3),
                            random(0.1, 2)};
        const std::vector<Pose> poses{random.pose(), random.pose()};
        if (near_a_knot(s, state_of<double>(poses)) ||
            force_of<double>(s, state_of<double>(poses)).norm() < 10)
            continue;
        const auto q = state_of<double>(poses);
        if ((q[0].r + q[0].lever(s.i.s_local) - q[1].r - q[1].lever(s.j.s_local)).norm() < 0.3)
            continue;
        EXPECT_LE(gradient_error(s, poses), 1e-10);
        ++compared;
    }
    EXPECT_GT(compared, 20);
}

// (F on i, M on i, F on j, M on j) of non-conjugate forces, or without the moment of the offset, as
// stated.
TEST(Formulation, WithoutEnergyHasTheForcesAsStated) {
    Random random;
    for (const Formulation& formulation : every_formulation()) {
        if (formulation.conjugate || formulation.frame != Formulation::Frame::on_i) continue;
        const Bushing b = bushing(random, formulation, true);
        const State<double> q = state_of<double>(somewhere(b, 0.8, random));
        const Matrix3<double> A_i = q[0].A * b.i.A_local.toRotationMatrix();
        const Vector6<double> e =
            measured(b, state_of<Long>({{q[0].r, q[0].p}, {q[1].r, q[1].p}})).cast<double>();
        const Vector6<double> stress = gradient<double>(b.law, e) + b.preload;
        const Vector3d F = A_i * stress.head<3>(), M = A_i * stress.tail<3>();
        const Vector3d p_j = q[1].r + q[1].lever(b.j.s_local),
                       p_i = q[0].r + q[0].lever(b.i.s_local);
        Vector<double> stated(12);
        stated << -F, -((formulation.offset_moment ? p_j : p_i) - q[0].r).cross(F) - M, F,
            (p_j - q[1].r).cross(F) + M;
        EXPECT_LE((force_of<double>(b, q) - stated).norm(), 1e-12 * stated.norm())
            << name_of(formulation);
    }
}

TEST(Formulation, OfAnyKindTurnsWithTheBodiesAndBalancesButForTheOffset) {
    Random random;
    for (const Formulation& formulation : every_formulation())
        for (int trial = 0; trial < 10; ++trial) {
            const Bushing b = bushing(random, formulation, trial % 2 == 0);
            const auto poses = somewhere(b, 1.2, random);
            const State<double> q = state_of<double>(poses);
            const Vector<double> f = force_of<double>(b, q);
            const double size = f.cwiseAbs().maxCoeff();
            // Rigid motion of both bodies.
            const Eigen::Quaterniond R = random.rotation();
            const Vector3d t = random.vector();
            std::vector<Pose> moved = poses;
            for (auto& pose : moved) pose = {R * pose.r + t, R * pose.p};
            const Vector<double> turned = force_of<double>(b, state_of<double>(moved));
            for (int c = 0; c < 12; c += 3)
                EXPECT_LE((turned.segment<3>(c) - R * f.segment<3>(c)).norm(), 1e-11 * size)
                    << name_of(formulation);
            // Forces balance, and moments too, up to D × F where it is left out.
            const Vector3d F = f.segment<3>(6);
            const Vector3d D = q[1].r + q[1].lever(b.j.s_local) - q[0].r - q[0].lever(b.i.s_local);
            Vector3d left =
                f.segment<3>(3) + q[0].r.cross(f.segment<3>(0)) + f.segment<3>(9) + q[1].r.cross(F);
            if (!formulation.offset_moment) left -= D.cross(F);
            EXPECT_LE((f.segment<3>(0) + F).norm(), 1e-12 * size);
            EXPECT_LE(left.norm(), 1e-11 * size) << name_of(formulation);
        }
}

TEST(Formulation, OfAnyKindIsTheSameLawAtSmallDeformations) {
    Random random;
    Bushing b = bushing(random, {}, false);
    b.preload.setZero();
    b.undeformed.setZero();
    const double size = 1e-6;
    std::vector<Pose> poses = somewhere(b, size, random);
    const State<double> q = state_of<double>(poses);
    poses[1].r +=
        q[0].r + q[0].lever(b.i.s_local) - q[1].r - q[1].lever(b.j.s_local) + size * random.unit();
    const Vector<double> f = force_of<double>(b, state_of<double>(poses));
    for (const Formulation& formulation : every_formulation()) {
        b.formulation = formulation;
        const Vector<double> other = force_of<double>(b, state_of<double>(poses));
        EXPECT_LE((other - f).norm(), 10 * size * f.norm()) << name_of(formulation);
        EXPECT_EQ((other - f).norm() > 0, !(formulation == Formulation{})) << name_of(formulation);
    }
}

TEST(Formulation, OnJIsTheBushingTurnedRound) {
    // The energy stated directly: d in the axes of j, the same rotation vector.
    Random random;
    for (const bool curves : {false, true})
        for (int trial = 0; trial < 10; ++trial) {
            Bushing b = bushing(random, {Formulation::Frame::on_j}, curves);
            const auto poses = somewhere(b, 0.9, random);
            const Bushing turned = markers_swapped(b);
            ASSERT_EQ(turned.formulation.frame, Formulation::Frame::on_i);
            if (near_a_knot(turned, state_of<double>(poses))) continue;
            const auto straight = [&](const State<Long>& q) {
                const auto axes = [&](const Marker& m) -> Matrix3L {
                    return q[m.body].p.toRotationMatrix() *
                           m.A_local.cast<Long>().toRotationMatrix();
                };
                const Vector3L D = q[1].r + q[1].p * b.j.s_local.cast<Long>() - q[0].r -
                                   q[0].p * b.i.s_local.cast<Long>();
                const Eigen::AngleAxis<Long> turn(Matrix3L(axes(b.i).transpose() * axes(b.j)));
                Vector6<Long> e;
                e << axes(b.j).transpose() * D, turn.angle() * turn.axis();
                e -= b.undeformed.cast<Long>();
                return energy_of(b.law, e) + b.preload.cast<Long>().dot(e);
            };
            const Vector<Long> f = force_of<Long>(turned, state_of<Long>(poses));
            const Long h = 1e-3L;
            for (int c = 0; c < 12; ++c) {
                const auto at = [&](Long share) {
                    State<Long> q = state_of<Long>(poses);
                    advance(q, Vector<Long>(share * h * Vector<Long>::Unit(12, c)));
                    return straight(q);
                };
                const Long slope =
                    (45 * (at(1) - at(-1)) - 9 * (at(2) - at(-2)) + (at(3) - at(-3))) / (60 * h);
                EXPECT_LE(static_cast<double>(std::abs(slope - f[c])),
                          1e-10 * static_cast<double>(f.norm()));
            }
        }
}

TEST(Formulation, CardanAnglesMakeTheRotation) {
    Random random;
    for (int trial = 0; trial < 20; ++trial) {
        const Matrix3<double> B = random.rotation(1.4).toRotationMatrix();
        const Vector3d theta = cardan<double>(B);
        const Matrix3<double> made = (Eigen::AngleAxisd(theta.x(), Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(theta.y(), Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(theta.z(), Vector3d::UnitZ()))
                                         .toRotationMatrix();
        EXPECT_LE((made - B).cwiseAbs().maxCoeff(), 1e-14);
        const Middle<double> half = middle<double>(B);
        EXPECT_LE((half.S * half.S - B).cwiseAbs().maxCoeff(), 1e-14);
        EXPECT_LE(
            (jacobian(half) * (half.S + B) - Matrix3<double>::Identity()).cwiseAbs().maxCoeff(),
            1e-14);
    }
}

TEST(Stiffness, OfEveryLawAndFormulationIsSymmetricAndHasTheFormOfThePaper) {
    Random random;
    for (const Formulation& formulation : every_formulation()) {
        const Bushing b = bushing(random, formulation, true);
        const State<double> q = state_of<double>(somewhere(b, 0.5, random));
        const Model model = model_of(b);
        const Matrix<double> K = stiffness<double>(model, inputs_as_drawn<double>(model), q);
        EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());
        Vector<double> dq(
            12);  // the two attachment points moved as one body with both levers: together they strain nothing
        const Vector3d v = random.vector(), w = random.vector();
        dq << v + q[0].lever(b.i.s_local).cross(w), w, v + q[1].lever(b.j.s_local).cross(w), w;
        EXPECT_LE((K * dq).norm(), 1e-13 * K.cwiseAbs().maxCoeff()) << name_of(formulation);
    }
}

}  // namespace
}  // namespace elastocheck::recursive
