// Places where elements that only push lift off, against closed forms.
#include "compare/warnings/lift_off.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"

namespace elastocheck::compare {
namespace {

std::filesystem::path path_of(const char* file) {
    return std::filesystem::path(ELASTOCHECK_SCENES) / "../../tests" / file;
}

// On the first branch.
void expect_one(const Model& model, Leg leg, const std::string& what, double at) {
    const auto events = lift_offs(model, model.branches[0], leg);
    ASSERT_EQ(events.size(), 1u) << name(leg);
    EXPECT_EQ(events[0].what, what);
    EXPECT_NEAR(events[0].at, at, 1e-6) << name(leg);
}

// The arm hangs at a sin θ, k θ = -M; the tyre reaches P/k_t further down.
TEST(LiftOff, TyreLiftsOffAtTheHeightOfItsHangingWheel) {
    const Model model = compile(read_scene(path_of("reference/energy/trailing_arm_rolling.yaml")));
    const double k = 70.6858347058 * 180 / std::numbers::pi,
                 hangs = 0.45 * std::sin(-1575 / k) - 3500 / 200e3;
    for (const Leg leg : {Leg::equilibrium, Leg::energy, Leg::series})
        expect_one(model, leg, "the wheel leaves the road", 1e3 * hangs);
}

// A block on two springs of 20 and 5 N/mm; the first presses it down by 600 N and leaves its seat
// where it is 30 mm longer, under (20 + 5) · 30 N. By its table, and by a rate.
TEST(LiftOff, SpringWithLooseSeatsLiftsOffAtItsFreeLength) {
    std::ifstream file(path_of("compare/scenes/loose_seats.yaml"));
    const std::string by_rate(std::istreambuf_iterator<char>(file), {});
    std::string by_table = by_rate;
    const std::string rate = "rate: 20e3";
    by_table.replace(by_table.find(rate), rate.size(),
                     "curve: {table: [[-0.1, -2000], [0.05, 1000], [0.1, 2000]]}");
    for (const std::string& text : {by_rate, by_table})
        for (const Leg leg : {Leg::equilibrium, Leg::energy, Leg::series}) {
            const Model model = compile(parse_scene(text, "loose_seats"));
            expect_one(model, leg, "'coil' leaves its seat", 750);
            // beyond, the other spring alone holds the load, less the 600 N
            const BranchSide side = sides_of(model, model.branches[0]).front();
            const double end = 900;
            double z = NAN;
            solve_at(side, leg, std::span(&end, 1),
                     [&](const Equilibrium& state) { z = state.poses[0].r.z(); });
            EXPECT_NEAR(z, (900 - 600) / 5e3, 1e-9);
        }
}

}  // namespace
}  // namespace elastocheck::compare
