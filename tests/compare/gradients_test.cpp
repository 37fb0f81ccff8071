// Derivatives of outputs by the numbers of scene files, along branches, by all legs; with trims.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "compare/comparison/legs.hpp"
#include "compare/sensitivity/sensitivity.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "models/branch.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

std::string file_of(const std::string& scene) {
    return std::string(ELASTOCHECK_SCENES) + "/" + scene + ".yaml";
}

struct Asked {
    Model model;
    std::vector<Channel> outputs;
    std::vector<ModelRate> rates;
    std::vector<VariedNumber> numbers;
    std::optional<TrimRates> trim;
};
Asked asked(const std::string& file, const std::vector<Setting>& settings = {}) {
    Asked all;
    const Scene scene = read_scene(file, settings);
    const Trimmed trimmed = trim(scene);
    all.model = compile(trimmed.scene);
    all.outputs = channels(all.model);
    all.rates = all_model_rates(file, settings);
    for (const auto& rate : all.rates) all.numbers.push_back(varied_number(rate, scene.numbers));
    if (trimmed.record) {
        all.trim = trim_rates(scene, trimmed, all.rates);
        all.rates = all.trim->numbers;
    }
    return all;
}
Gradients gradients_of(const Asked& all, int points, std::vector<Leg> legs) {
    return gradients(
        all.model, all.outputs, all.numbers, all.rates,
        {.points = points, .legs = std::move(legs), .trim = all.trim ? &*all.trim : nullptr});
}

// The legs agree on every entry of a scene; returns the number of compared ones.
long agreed(const std::string& scene, int points, double& worst) {
    const Gradients all =
        gradients_of(asked(file_of(scene)), points, {Leg::equilibrium, Leg::energy, Leg::series});
    long compared = 0;
    for (const auto& side : all.sides) {
        for (const auto& leg : side.legs)
            EXPECT_TRUE(leg.failure.empty() || leg.not_applicable)
                << scene << ", " << side.name << ": " << name(leg.leg) << ": " << leg.failure;
        EXPECT_LE(side.worst.share, gradients_agree)
            << scene << ", " << side.name << ": " << side.worst.where;
        worst = std::max(worst, side.worst.share);
        compared += side.worst.compared;
    }
    return compared;
}

TEST(Gradients, TheLegsAgreeOnAllNumbersOfASample) {
    double worst = 0;
    long compared = 0;
    for (const auto& scene : {"mcpherson", "pinned_bar", "semi_trailing_arm", "four_bar"})
        compared += agreed(scene, 2, worst);
    EXPECT_GT(compared, 10000);
    RecordProperty("worst", fmt::format("{:.1e}", worst));
}

TEST(NightlyGradients, TheLegsAgreeOnAllNumbersOfEveryScene) {
    double worst = 0;
    long compared = 0;
    for (const auto& scene : support::scene_names()) compared += agreed(scene, 4, worst);
    EXPECT_GT(compared, 100000);
    RecordProperty("worst", fmt::format("{:.1e} of {}", worst, compared));
}

// Outputs at the end of the first branch with one number set, its trim solved again.
std::vector<double> outputs_with(const std::string& file, const Setting& set, double a) {
    const Model model = compile(trim(read_scene(file, {&set, 1})).scene);
    BranchSide side = sides_of(model, model.branches.front(), 1).front();
    side.branch.to = a;
    side.model.branches = {side.branch};
    const auto path = walk(side, {.leg = Leg::equilibrium});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    return evaluate(side.model, channels(model), path.points.back());
}

// Against extrapolated differences of whole solutions, trim included.
TEST(Gradients, AreTheDifferencesOfScenesWithANumberSet) {
    struct Case {
        const char *scene, *number;
        double step;
    };
    int compared = 0;
    double worst = 0;
    for (const auto& [scene, number, step] : {
             Case{"semi_trailing_arm", "points.spring_lower.z", 1e-3},
             {"double_wishbone", "points.tie_rod_inner.z", 1e-3},
             {"mcpherson", "points.tie_rod_inner.z", 5e-4},
         }) {
        const std::string file = file_of(scene);
        const Asked all = asked(file);
        const auto found = std::ranges::find(all.numbers, number, &VariedNumber::path);
        if (found == all.numbers.end()) {
            ADD_FAILURE() << scene << " has no number " << number;
            continue;
        }
        const auto k = found - all.numbers.begin();
        const Gradients by = gradients_of(all, 1, {Leg::equilibrium});
        const double a = by.sides.front().a.back();
        const double h = found->unit == "mm" ? 1e3 * step : step;
        const auto at = [&](double change) {
            return outputs_with(file, setting(number, found->value + change), a);
        };
        const auto up = at(h), down = at(-h), near_up = at(h / 2), near_down = at(-h / 2);
        const auto& table = by.sides.front().legs.front().at.back();
        const auto determined = by.sides.front().why_output;
        double size = 0, force = 0;
        for (std::size_t c = 0; c < all.outputs.size(); ++c)
            if (determined[c].empty())
                (all.outputs[c].kinematic() ? size : force) =
                    std::max(all.outputs[c].kinematic() ? size : force,
                             std::abs(table(static_cast<Eigen::Index>(c), k)));
        for (std::size_t c = 0; c < all.outputs.size(); ++c) {
            if (!determined[c].empty()) continue;
            const double difference =
                (8 * (near_up[c] - near_down[c]) - (up[c] - down[c])) / (6 * h);
            const double off = std::abs(table(static_cast<Eigen::Index>(c), k) - difference) /
                               (all.outputs[c].kinematic() ? size : force);
            EXPECT_LE(off, 1e-7) << scene << ": " << all.outputs[c].name << " by " << number << ": "
                                 << table(static_cast<Eigen::Index>(c), k) << ", " << difference;
            worst = std::max(worst, off);
            ++compared;
        }
    }
    EXPECT_GT(compared, 60);
    RecordProperty("worst", fmt::format("{:.1e}", worst));
}

// ---- Closed forms.

// The derivative of an output by a number at every station of a side, by every leg: values, legs.
template <class Check>
void each_derivative(const std::string& scene, const char* output, const char* number,
                     const std::string& branch, const Check& check) {
    const Asked all = asked(file_of(scene));
    const Gradients by = gradients_of(all, 4, {Leg::equilibrium, Leg::energy, Leg::series});
    const auto c = find_channel(all.outputs, output);
    const auto k =
        std::ranges::find(all.numbers, number, &VariedNumber::path) - all.numbers.begin();
    ASSERT_GE(c, 0);
    ASSERT_LT(k, std::ssize(all.numbers));
    int checked = 0;
    for (const auto& side : by.sides) {
        if (side.branch != branch) continue;
        for (const auto& leg : side.legs)
            for (std::size_t s = 0; s < leg.at.size(); ++s, ++checked)
                check(
                    side.a[s], leg.at[s](c, k),
                    fmt::format("{} by {} at {:g}, {}", output, number, side.a[s], name(leg.leg)));
    }
    EXPECT_EQ(checked, 15);
}

// z = L sin θ, tan θ = F / kL: lengths in mm, k in N/mm.
TEST(GradientsClosedForm, ThePinnedBarByItsLength) {
    const double k = 20, L = 500;
    each_derivative("pinned_bar", "tip_z", "points.tip.x", "up",
                    [&](double F, double value, const std::string& where) {
                        const double t = F / (k * L);
                        EXPECT_NEAR(value, F / k * t * t / L / std::pow(1 + t * t, 1.5), 1e-11)
                            << where;
                    });
}

// F(z) = 2 k (ℓ - ℓ₀) z / ℓ of the arch, ℓ = √(b² + z²), ℓ₀ = √(b² + h²): at equal F
// dz/dh = -(∂F/∂h) / (∂F/∂z), which grows without bound towards the limit load.
TEST(GradientsClosedForm, TheArchByItsHeight) {
    const double b = 300, h = 80, k = 100, l_0 = std::hypot(b, h);
    each_derivative("two_spring_arch", "apex_z", "points.apex.z", "down",
                    [&](double F, double value, const std::string& where) {
                        double z = h;
                        const auto force = [&](double at) {
                            const double l = std::hypot(b, at);
                            return 2 * k * (l - l_0) * at / l;
                        };
                        const auto slope = [&](double at) {
                            const double l = std::hypot(b, at);
                            return 2 * k * (1 - l_0 * b * b / (l * l * l));
                        };
                        for (int n = 0; n < 50; ++n) z -= (force(z) - F) / slope(z);
                        const double l = std::hypot(b, z), by_h = -2 * k * z / l * h / l_0;
                        const double exact = -by_h / slope(z);
                        EXPECT_NEAR(value, exact, 1e-9 * std::abs(exact)) << where;
                    });
}

// The four-bar's rocker by the length of its crank: the closed form in the head of the scene,
// differentiated by extrapolated differences of itself.
TEST(GradientsClosedForm, TheFourBarByItsCrank) {
    const auto C_x = [](double a, double phi) {
        const double c = 80, b = std::hypot(100, 80 - a);  // as drawn
        const double Bx = a * std::sin(phi), Bz = a * std::cos(phi);
        const double fx = 100 - Bx, fz = -Bz, d = std::hypot(fx, fz);
        const double u = (b * b - c * c + d * d) / (2 * d);
        return Bx + u * fx / d + std::sqrt(b * b - u * u) * -fz / d;
    };
    each_derivative("four_bar", "C_x", "points.B.z", "turn",
                    [&](double phi, double value, const std::string& where) {
                        const auto difference = [&](double h) {
                            return (C_x(40 + h, phi) - C_x(40 - h, phi)) / (2 * h);
                        };
                        const double exact = (4 * difference(5e-4) - difference(1e-3)) / 3;
                        EXPECT_NEAR(value, exact, 1e-8) << where;
                    });
}

// At the corner of a law a stiffness has two values, and an entry says so.
TEST(Gradients, AnEntryAtACornerSaysWhyThereIsNone) {
    const std::string file =
        std::string(ELASTOCHECK_SCENES) + "/../extremes/stop_that_touches.yaml";
    const Gradients by = gradients_of(asked(file, {setting("branches.lift.to", 20)}), 2,
                                      {Leg::equilibrium, Leg::series});
    int at_a_corner = 0;
    for (const auto& side : by.sides)
        for (std::size_t s = 0; s < side.a.size(); ++s)
            for (std::size_t k = 0; k < by.numbers.size(); ++k) {
                const bool corner =
                    side.why_number[s][k].find("corner of its law") != std::string::npos;
                at_a_corner += corner;
                if (corner) {
                    const auto column = static_cast<Eigen::Index>(k);
                    EXPECT_TRUE(side.legs.front().at[s].col(column).array().isNaN().all());
                }
            }
    EXPECT_GT(at_a_corner, 0);
}

}  // namespace
}  // namespace elastocheck::compare
