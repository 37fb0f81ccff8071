// Elastic laws: the energy of a curve is the integral of its force, to the last digits.
#include "reference/energy/potential/laws.hpp"

#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

double force(const Curve& curve, double x) { return support::stated_force(curve, x); }

// ∫ f from a to b by Simpson's rule between knots, where it is exact; at jumps the one-sided values
// are used.
double quadrature(const Curve& curve, double a, double b) {
    if (b < a) return -quadrature(curve, b, a);
    std::vector<double> ends{a, b};
    for (const double x : curve.knots)
        if (x > a && x < b) ends.push_back(x);
    std::ranges::sort(ends);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double h = ends[i + 1] - ends[i];
        sum +=
            h / 6 *
            (force(curve, ends[i]) + 4 * force(curve, ends[i] + h / 2) + force(curve, ends[i + 1]));
    }
    return sum;
}

LawValues<1> ask(const Curve& curve, double x_c, double delta) {
    return values(ScalarLaw(curve), Vector1(x_c), Vector1(delta));
}

TEST(Curves, EnergyIsTheIntegralOfTheForceAcrossAnyKnots) {
    Random random;
    double worst = 0;
    for (int repeat = 0; repeat < 3000; ++repeat) {
        const Curve curve = random.kinked_curve(1 + repeat % 7);
        double x_c = random(-2, 2), x = random(-2, 2);
        if (repeat % 5 == 1) x_c = curve.knots[0];
        if (repeat % 5 == 2) x = curve.knots.back();
        const auto u = ask(curve, x_c, x - x_c);
        worst = std::max(worst, std::abs(u.change - quadrature(curve, x_c, x)));
        worst = std::max(worst, std::abs(u.stress[0] - force(curve, x)));
        worst = std::max(worst, std::abs(u.stress_c[0] - force(curve, x_c)));
    }
    EXPECT_LE(worst, 1e-13);
}

TEST(Curves, StiffnessIsTheSlopeOfTheForce) {
    Random random;
    double worst = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const Curve curve = random.kinked_curve(1 + repeat % 7);
        const double x_c = random(-2, 2), delta = random(-2, 2), h = 1e-4;
        const bool near_a_knot = std::ranges::any_of(
            curve.knots, [&](double x) { return std::abs(x - x_c - delta) <= h; });
        if (near_a_knot) continue;
        const double slope =
            (force(curve, x_c + delta + h) - force(curve, x_c + delta - h)) / (2 * h);
        worst = std::max(worst, std::abs(ask(curve, x_c, delta).stiffness(0, 0) - slope));
    }
    EXPECT_LE(worst, 1e-5);  // c_3 h²
}

// Changes of 1e-12 at a level of 1 keep their relative accuracy, also across a knot: ½ (f_c + f)
// δ + O(δ²) at a kink.
TEST(Curves, ChangesKeepTheirRelativeAccuracy) {
    Random random;
    double worst = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const Curve curve = random.kinked_curve(1 + repeat % 7);
        const double delta = 1e-12 * random(-1, 1);
        const double x_c = repeat % 2 ? random(-2, 2) : curve.knots.back() - 0.5 * delta;
        const auto u = ask(curve, x_c, delta);
        worst = std::max(worst, std::abs(u.change - 0.5 * (u.stress_c[0] + u.stress[0]) * delta) /
                                    (std::abs(delta) * (1 + std::abs(u.stress[0]))));
    }
    EXPECT_LE(worst, 1e-11);
}

// Termination of the integration from knot to knot for every critical start and end.
TEST(Curves, IntegrationAcrossKnotsTerminatesForAnyEnds) {
    Random random;
    const Curve curve = random.kinked_curve(5);
    std::vector<double> places{-inf, -3, 3, inf, NAN};
    for (const double x : curve.knots)
        for (const double off : {0.0, 1e-16, -1e-16, 1e-300, -1e-300}) places.push_back(x + off);
    for (const double x_c : places) {
        for (const double x : places) {
            for (const double delta : {x - x_c, 1e-300, -1e-300, 1e-17, -1e-17, 0.0}) {
                const auto u = ask(curve, x_c, delta);
                if (!std::isfinite(x_c) || !std::isfinite(delta)) {
                    EXPECT_FALSE(std::isfinite(u.change) && std::isfinite(u.stress[0]))
                        << x_c << " " << delta;
                } else {
                    EXPECT_NEAR(u.change, quadrature(curve, x_c, x_c + delta), 1e-13)
                        << x_c << " " << delta;
                }
            }
        }
    }
}

TEST(Laws, PerAxisLawEqualsTheDiagonalStiffness) {
    Random random;
    for (int repeat = 0; repeat < 100; ++repeat) {
        const Vector6 k = random.many(6).cwiseAbs(), x_c = random.many(6), delta = random.many(6);
        PerAxis axes;
        for (int i = 0; i < 6; ++i) {
            auto& axis = axes.axis[static_cast<std::size_t>(i)];
            axis = LinearRate{k[i]};
            if (i % 2)
                // the same line
                axis = Curve{{0.1}, {{{0.1 * k[i], k[i], 0, 0}, {0.1 * k[i], k[i], 0, 0}}}};
        }
        const auto a = values(SpatialLaw(axes), x_c, delta),
                   b = values(SpatialLaw(LinearStiffness{k.asDiagonal()}), x_c, delta);
        EXPECT_NEAR(a.change, b.change, 1e-14);
        EXPECT_LE((a.stress - b.stress).norm() + (a.stress_c - b.stress_c).norm(), 1e-14);
        EXPECT_LE((a.stiffness - b.stiffness).norm(), 1e-15);
    }
}

TEST(Laws, LawWithoutForceDoesNotResist) {
    const Curve nothing{{0.0, 1.0}, std::vector<std::array<double, 4>>(3)};
    PerAxis axes;
    axes.axis.fill(nothing);
    EXPECT_FALSE(resists(axes));
    axes.axis[2] = stop(0.1, 1e5);
    EXPECT_TRUE(resists(axes));
    EXPECT_FALSE(resists_rotation(axes));
    axes.axis[5] = LinearRate{3};
    EXPECT_TRUE(resists_rotation(axes));
}

}  // namespace
}  // namespace elastocheck::reference::energy
