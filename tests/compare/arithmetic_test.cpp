// Robustness against floating-point arithmetic: rounding modes, flush-to-zero, inputs changed by
// one ulp, and NaN in every input. A converged result must still be correct.
#include <gtest/gtest.h>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include <array>
#include <cfenv>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "compare/stress/stress.hpp"
#include "elastocheck/compile.hpp"
#include "models/kinds.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

enum class Arithmetic {
    nearest,  // the default
    up,
    down,
    towards_zero,
    flushed,  // to nearest; denormal operands and results are zero (DAZ, FTZ)
};
constexpr std::array others{Arithmetic::up, Arithmetic::down, Arithmetic::towards_zero,
#ifdef __SSE2__
                            Arithmetic::flushed
#endif
};

// Sets the arithmetic of this thread for the lifetime of the object.
class WithArithmetic {
  public:
    explicit WithArithmetic(Arithmetic arithmetic) {
        std::fegetenv(&before_);
        switch (arithmetic) {
            case Arithmetic::nearest: break;
            case Arithmetic::up: std::fesetround(FE_UPWARD); break;
            case Arithmetic::down: std::fesetround(FE_DOWNWARD); break;
            case Arithmetic::towards_zero: std::fesetround(FE_TOWARDZERO); break;
            case Arithmetic::flushed:
#ifdef __SSE2__
                _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
                break;
        }
    }
    ~WithArithmetic() { std::fesetenv(&before_); }
    WithArithmetic(const WithArithmetic&) = delete;
    WithArithmetic& operator=(const WithArithmetic&) = delete;

  private:
    std::fenv_t before_;
};

// The numbers of the members of kinds.
struct Numbers {
    const std::function<void(double&)>& visit;

    void all(std::span<double> numbers) const {
        for (double& x : numbers) visit(x);
    }
    void operator()(Vector3d& v) const { all({v.data(), 3}); }
    void operator()(Point& p) const { (*this)(p.s_local); }
    void operator()(Direction& u) const { (*this)(u.u_local); }
    void operator()(Quaterniond& q) const { all({q.coeffs().data(), 4}); }
    void operator()(Marker& m) const { (*this)(m.s_local), (*this)(m.A_local); }
    void operator()(Length<double> x) const { visit(x.value); }
    void operator()(PlaneAngle<double> x) const { visit(x.value); }
    void operator()(ForceAndMoment<Vector6> x) const { all({x.value.data(), 6}); }
    void operator()(Deformation<Vector6> x) const { all({x.value.data(), 6}); }
    void operator()(LoadVector<Vector3d> x) const { (*this)(x.value); }
    void operator()(ScalarLaw& law) const {
        std::visit(overloaded{[&](LinearRate& u) { visit(u.k); },
                              [&](elastocheck::Curve& u) {
                                  all(u.knots);
                                  for (auto& piece : u.pieces) all(piece);
                              }},
                   law);
    }
    void operator()(SpatialLaw& law) const {
        std::visit(overloaded{[&](LinearStiffness& u) {
                                  all({u.K.data(), 36});
                              },
                              [&](PerAxis& u) {
                                  for (ScalarLaw& axis : u.axis) (*this)(axis);
                              }},
                   law);
    }
    void driven(Driven& what) const {
        each_member(what, overloaded{[&](Load& load) { each_member(load.kind, *this); },
                                     [&](ForceAndMoment<Vector6> x) { (*this)(x); }});
    }
};

void for_each_number(Scene& scene, const std::function<void(double&)>& visit) {
    const Numbers numbers{visit};
    for (auto& point : scene.hardpoints) numbers(point.position);
    for (auto& body : scene.bodies) numbers(body.design.r), numbers(body.design.p);
    for (auto& joint : scene.joints) each_member(joint.kind, numbers);
    for (auto& elastic : scene.elastics) each_member(elastic.kind, numbers);
    for (auto& load : scene.static_loads) each_member(load.kind, numbers);
    for (auto& branch : scene.branches) {
        visit(branch.from), visit(branch.to);
        for (auto& driver : branch.drivers)
            numbers.driven(driver.what), visit(driver.start), visit(driver.rate);
    }
    for (auto& wheel : scene.wheels) {
        numbers(wheel.centre_local), numbers(wheel.contact);
        numbers(wheel.spin_axis_local), visit(wheel.tyre_rate);
        if (auto& axis = wheel.steering_axis) numbers(axis->lower), numbers(axis->upper);
    }
    for (auto& probe : scene.probes) numbers(probe.at);
    for (auto& damper : scene.dampers) numbers(damper.i), numbers(damper.j);
    if (auto& car = scene.vehicle)
        for (double* x : {&car->wheelbase, &car->cg_height, &car->brake_share, &car->drive_share})
            visit(*x);
    if (scene.trim) {
        for (auto& adjustment : scene.trim->adjust)
            numbers.driven(adjustment.what), visit(adjustment.per_unit);
        for (auto& condition : scene.trim->until)
            if (condition.value) visit(*condition.value);
    }
    for (auto& elastic : scene.elastics)  // one number for both entries of a symmetric matrix
        each_member(elastic.kind, [](SpatialLaw& law) {
            if (auto* u = std::get_if<LinearStiffness>(&law))
                u->K = Matrix6(u->K.selfadjointView<Eigen::Lower>());
        });
}

// Every nonzero number replaced by the next double above or below, in a reproducible way.
Scene an_ulp_off(Scene scene) {
    constexpr double end = std::numeric_limits<double>::infinity();
    for_each_number(scene, [bits = std::uint32_t{12345}](double& x) mutable {
        bits = 1664525 * bits + 1013904223;
        if (x != 0) x = std::nextafter(x, (bits >> 16) % 2 == 0 ? end : -end);
    });
    return scene;
}

Scene small(const std::string& name) {
    Scene scene = support::scene(name);
    scene.branches.resize(1);
    scene.branches.front().steps = 20;
    return scene;
}

// Over all sides of the first branch: the first outcome that is not converged, and the end of the
// last side.
struct Answer {
    Outcome outcome = Outcome::converged;
    std::vector<Pose> poses;
};

std::vector<Answer> answers(const Scene& scene, Arithmetic how = Arithmetic::nearest) {
    std::vector<Answer> all;
    const Model model = compile(scene);
    for (const auto& solver : solvers()) {
        Answer& answer = all.emplace_back();
        SolverSettings settings = solver.settings;
        settings.every = 4;
        for (const auto& side : sides_of(model, model.branches.front(), 4)) {
            const WithArithmetic in_force(how);
            const auto path = solve_branch(
                side, settings, [&](const Equilibrium& state) { answer.poses = state.poses; });
            if (answer.outcome == Outcome::converged) answer.outcome = path.outcome;
        }
    }
    return all;
}

// Largest distance of a body; NaN where one is not finite.
double distance(const Answer& a, const Answer& b) {
    double most = 0;
    for (std::size_t k = 0; k < a.poses.size(); ++k)
        if (const double off = (a.poses[k].r - b.poses[k].r).norm(); !(off <= most)) most = off;
    return most;
}

// 1/3 computed at run time.
double third() {
    const volatile double one = 1, three = 3;
    return one / three;
}
double half_of_the_least() {
    const volatile double least = std::numeric_limits<double>::min(), half = 0.5;
    const volatile double product = least * half;
    return product;
}

TEST(Arithmetic, RoundingModeIsSetOnlyWithinItsScope) {
    const double nearest = third();
    for (const Arithmetic how : others) {
        try {
            const WithArithmetic in_force(how);
            EXPECT_EQ(third() > nearest, how == Arithmetic::up);
            EXPECT_EQ(half_of_the_least() == 0, how == Arithmetic::flushed);
            throw std::runtime_error("whoever solves may throw");
        } catch (const std::runtime_error&) {
        }
        EXPECT_EQ(third(), nearest);
        EXPECT_GT(half_of_the_least(), 0);
    }
    // 1/3 lies above its nearest double: -1/3 distinguishes rounding down from
    // rounding towards zero.
    const auto minus_third = [](Arithmetic how) {
        const WithArithmetic in_force(how);
        const volatile double minus = -1, three = 3;
        const volatile double quotient = minus / three;
        return quotient;
    };
    EXPECT_LT(minus_third(Arithmetic::down), minus_third(Arithmetic::towards_zero));
    EXPECT_EQ(minus_third(Arithmetic::up), minus_third(Arithmetic::towards_zero));
}

// No solver fails or is wrong because of rounding; and some digit differs for every solver:
// otherwise the arithmetic was not active during the solve.
void expect_the_same(const char* name) {
    const Scene scene = small(name);
    const auto usual = answers(scene);
    std::vector<std::vector<Answer>> changed{answers(an_ulp_off(scene))};
    for (const Arithmetic how : others) changed.push_back(answers(scene, how));
    for (std::size_t s = 0; s < usual.size(); ++s) {
        if (usual[s].outcome != Outcome::converged) continue;
        const std::string solver = solvers()[s].name;
        const bool exact = solver == "equilibrium" || solver == "energy" || solver == "series";
        double most = 0;
        for (std::size_t k = 0; k < changed.size(); ++k) {
            EXPECT_EQ(changed[k][s].outcome, Outcome::converged) << name << ", " << solver;
            const double off = distance(changed[k][s], usual[s]);
            EXPECT_LE(off, exact                  ? 1e-9
                           : solver == "adaptive" ? 1e-5
                                                  : 1e-7)
                << name << ", " << solver << ", change " << k;
            most = std::max(most, off);
        }
        EXPECT_GT(most, 0) << name << ", " << solver;
    }
}

TEST(Arithmetic, RoundingModeDoesNotChangeTheSolutionsOfAStrut) { expect_the_same("mcpherson"); }

// The points of single_bushing coincide: a rounding difference between them must not be taken for a length.
TEST(NightlyArithmetic, RoundingModeDoesNotChangeTheSolutionsOfFourSmallScenes) {
    for (const char* name : {"pendulum", "arch_driven", "parallel_springs", "single_bushing"})
        expect_the_same(name);
}

TEST(Arithmetic, PerturbedSceneDiffersByOneUlpPerNumber) {
    Scene before = support::scene("double_wishbone"), after = an_ulp_off(before);
    std::vector<double> a, b;
    for_each_number(before, [&](double& x) { a.push_back(x); });
    for_each_number(after, [&](double& x) { b.push_back(x); });
    ASSERT_EQ(a.size(), b.size());
    EXPECT_GT(a.size(), 400u);
    int up = 0, down = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (a[k] == 0) {
            EXPECT_EQ(b[k], 0);
            continue;
        }
        ++(b[k] > a[k] ? up : down);
        EXPECT_EQ(b[k], std::nextafter(a[k], b[k])) << k;
        EXPECT_NE(b[k], a[k]) << k;
    }
    EXPECT_GT(up, 50);
    EXPECT_GT(down, 50);
}

// Each number in turn, those of the geometry too, is NaN or infinite: a solver that converges has its usual result.
TEST(NightlyArithmetic, NonFiniteNumberInASceneChangesNoResultOrIsReported) {
    for (const char* name : {"mcpherson", "tyre_on_road"}) {
        const Scene scene = small(name);
        const auto expected = answers(scene);
        int count = 0;
        Scene counted = scene;
        for_each_number(counted, [&](double&) { ++count; });
        for (const double none :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
            for (int at = 0; at < count; ++at) {
                Scene poisoned = scene;
                for_each_number(poisoned, [&, k = 0](double& x) mutable {
                    if (k++ == at) x = none;
                });
                const auto now = answers(poisoned);
                for (std::size_t s = 0; s < now.size(); ++s) {
                    if (now[s].outcome != Outcome::converged) continue;
                    ASSERT_EQ(now[s].poses.size(), expected[s].poses.size());
                    EXPECT_LE(distance(now[s], expected[s]), 1e-12)
                        << name << ", number " << at << " of " << count << ", "
                        << solvers()[s].name;
                }
            }
    }
}

}  // namespace
}  // namespace elastocheck::compare
