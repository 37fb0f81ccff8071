// The same scenes with other arithmetic underneath: rounded up, down, to zero, with what is denormal taken for zero, every
// input an ulp off. Whoever still says "converged" is still right.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <array>
#include <cfenv>
#include <cmath>
#include <functional>
#include <limits>

#include "compare/agreement.hpp"
#include "compare/stress.hpp"
#include "models/branch.hpp"
#include "models/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

constexpr std::array scene_list{"mcpherson", "pendulum", "arch_driven", "parallel_springs"};

Way first_way(const Scene& scene) {
    const Model model = compile(scene);
    return ways_of(model, model.branches.front(), 20).back();
}

// The end of the way by every solver.
struct End {
    Outcome outcome = Outcome::converged;
    Equilibrium state;
};
std::vector<End> ends(const Way& way) {
    std::vector<End> all;
    for (const auto& solver : solvers()) {
        End& end = all.emplace_back();
        Gait gait = solver.gait;
        gait.every = way.branch.steps;
        end.outcome = walk(way, gait, [&](const Equilibrium& state) { end.state = state; }).outcome;
    }
    return all;
}

double apart(const Equilibrium& a, const Equilibrium& b) {
    double worst = 0;
    for (std::size_t k = 0; k < a.poses.size(); ++k) {
        const double length = (a.poses[k].r - b.poses[k].r).norm();
        if (!(length <= worst)) worst = length;
    }
    return worst;
}

// What another arithmetic may make of a state [m]: of who claims to be exact what it claims, of who claims a tolerance
// that, of the others, whose steps amplify a rounding, a millionth of the size.
double allowed(const Solver& solver, double size) {
    if (solver.gait.leg != Leg::recursive || solver.name == "series") return 1e-9 * size;
    if (solver.name == "adaptive") return recursive::Adaptive{}.length_tolerance;
    return 1e-6 * size;
}

void holds_under(const std::string& what, const std::function<std::vector<End>(const Way&)>& under) {
    const auto who = solvers();
    for (const auto& name : scene_list) {
        const Way way = first_way(support::scene(name));
        const auto before = ends(way), now = under(way);
        const double size = scale_of(way.model, way.branch, {}).length;
        double lost = 0;
        for (std::size_t s = 0; s < who.size(); ++s) {
            if (now[s].outcome != Outcome::converged || before[s].outcome != Outcome::converged) continue;
            const double off = apart(now[s].state, before[s].state);
            EXPECT_TRUE(std::isfinite(off) && off <= allowed(who[s], size))
                << name << " " << who[s].name << ", " << what << ": " << off << " m";
            lost = std::max(lost, off / size);
        }
        testing::Test::RecordProperty(fmt::format("{} {}", name, what),
                                      fmt::format("{:.1e} of the size", lost));
        // The references do not give up for a rounding.
        for (std::size_t s = 0; s < who.size(); ++s)
            if (who[s].gait.leg == Leg::equilibrium && before[s].outcome == Outcome::converged) {
                EXPECT_EQ(now[s].outcome, Outcome::converged) << name << " " << what;
            }
    }
}

struct RoundingMode {
    explicit RoundingMode(int mode) { std::fesetround(mode); }
    ~RoundingMode() { std::fesetround(FE_TONEAREST); }
};

TEST(Arithmetic, RoundedUpDownOrToZeroWhoConvergesIsStillRight) {
    for (const auto& [mode, what] : {std::pair{FE_UPWARD, "rounded up"},
                                     {FE_DOWNWARD, "rounded down"},
                                     {FE_TOWARDZERO, "rounded to zero"}})
        holds_under(what, [&](const Way& way) {
            const RoundingMode rounded(mode);
            return ends(way);
        });
}

TEST(Arithmetic, WithDenormalsTakenForZeroWhoConvergesIsStillRight) {
    constexpr unsigned flush_and_zero = 0x8040;
    holds_under("denormals are zero", [&](const Way& way) {
        const unsigned before = _mm_getcsr();
        _mm_setcsr(before | flush_and_zero);
        auto found = ends(way);
        _mm_setcsr(before);
        return found;
    });
}

// Every number of the model that a leg reads, one ulp up or down.
Way jittered(Way way) {
    unsigned k = 12345;
    const auto jitter = [&](double& x) {
        k = 1664525 * k + 1013904223;
        if (x != 0) x = std::nextafter(x, (k >> 16) % 2 == 0 ? INFINITY : -INFINITY);
    };
    const auto all = [&](auto&& vector) {
        for (int n = 0; n < vector.size(); ++n) jitter(vector(n));
    };
    for (auto& body : way.model.bodies) all(body.design.r);
    for (auto& constraint : way.model.constraints)
        std::visit(
            [&](auto& kind) {
                if constexpr (requires { kind.i.s_local; }) all(kind.i.s_local), all(kind.j.s_local);
                if constexpr (requires { kind.length; }) jitter(kind.length);
            },
            constraint.kind);
    for (auto& elastic : way.model.elastics)
        std::visit(
            [&](auto& kind) {
                all(kind.i.s_local), all(kind.j.s_local);
                if constexpr (requires { kind.free_length; }) jitter(kind.free_length);
            },
            elastic.kind);
    return way;
}

TEST(Arithmetic, WithEveryInputAnUlpOffWhoConvergesIsStillRight) {
    holds_under("an ulp off", [](const Way& way) { return ends(jittered(way)); });
}

}  // namespace
}  // namespace elastocheck::compare
