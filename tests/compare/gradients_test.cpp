// Derivatives of outputs by the numbers of scene files, along branches, by all legs; with trims.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/sensitivity/sensitivity.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

std::string file_of(const std::string& scene) {
    return std::string(ELASTOCHECK_SCENES) + "/" + scene + ".yaml";
}

std::vector<Channel> outputs_of(const Model& model) {
    auto all = channels(model);
    std::ranges::move(characteristics(model), std::back_inserter(all));
    std::ranges::move(element_channels(model), std::back_inserter(all));
    return all;
}

struct Asked {
    Scene scene;
    Trimmed trimmed;
    Model model;
    std::vector<Channel> outputs;
    VaryingScene varying;
};
Asked asked(const std::string& file, const std::vector<Setting>& settings = {},
            const std::string& number = "") {
    Asked all;
    all.scene = read_scene(file, settings);
    all.trimmed = trim(all.scene);
    all.model = compile(all.trimmed.scene);
    all.outputs = outputs_of(all.model);
    all.varying = varying(
        file, settings, [&](const std::string& path) { return number.empty() || path == number; });
    return all;
}
Gradients gradients_of(const Asked& all, GradientOptions options) {
    return gradients(all.scene, all.trimmed, all.model, all.varying, all.outputs, options);
}
Gradients gradients_of(const Asked& all, int points, std::vector<Leg> legs) {
    return gradients_of(all, {.points = points, .legs = std::move(legs)});
}
// Of a scene without a trim.
Gradients gradients_of(const std::string& text, std::span<const Channel> outputs,
                       const std::vector<std::string>& paths, const GradientOptions& options) {
    const Scene scene = parse_scene(text, "scene.yaml", {});
    VaryingScene varying;
    for (const std::string& path : paths)
        varying.numbers.push_back(
            varied_number(*std::ranges::find(scene.numbers, path, &Number::path)));
    varying.with = [&](std::size_t k, double by) {
        const VariedNumber& number = varying.numbers[k];
        return parse_scene(text, "scene.yaml",
                           std::vector{setting(number.path, number.value + by)});
    };
    return gradients(scene, {scene, {}}, compile(scene), varying, outputs, options);
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
        EXPECT_TRUE(side.worst.agrees()) << scene << ", " << side.name << ": " << side.worst.where;
        worst = std::max(worst, side.worst.share);
        compared += side.worst.compared;
    }
    return compared;
}

TEST(Gradients, LegsAgreeOnTheDerivativesByAllNumbersOfThreeScenes) {
    double worst = 0;
    long compared = 0;
    compared += agreed("mcpherson", 1, worst);
    for (const auto& scene : {"pinned_bar", "four_bar"}) compared += agreed(scene, 2, worst);
    EXPECT_GT(compared, 10000);
    RecordProperty("worst", fmt::format("{:.1e}", worst));
}

TEST(NightlyGradients, LegsAgreeOnTheDerivativesByAllNumbersOfEveryScene) {
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
    const auto path = solve_branch(side, {.leg = Leg::equilibrium});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    return row_of(side.model, outputs_of(model), side, {.leg = Leg::equilibrium},
                  path.points.back())
        .values;
}

// ---- Recorded values.

// Derivatives of 516 outputs by numbers that dual numbers through the reader, the model, the
// equilibrium leg and the outputs gave: with trims, an axle, bushings, stops, beams; positions,
// reactions, forces of elements, characteristics, the patches fixed to the carriers. `row`: the largest of the output's by its steps.
struct Recorded {
    std::string side, output, number;
    double parameter = 0, derivative = 0, step = 0, row = 0;
};
std::map<std::string, std::vector<Recorded>> recorded() {
    std::ifstream file(std::string(ELASTOCHECK_SCENES) +
                       "/../../tests/compare/exact_derivatives.csv");
    std::map<std::string, std::vector<Recorded>> all;
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::vector<std::string> words(1);
        bool quoted = false;
        for (const char c : line)
            if (c == '"')
                quoted = !quoted;
            else if (c == ',' && !quoted)
                words.emplace_back();
            else
                words.back() += c;
        all[words.at(0)].push_back({words.at(1), words.at(3), words.at(4), std::stod(words.at(2)),
                                    std::stod(words.at(5)), std::stod(words.at(6)),
                                    std::stod(words.at(7))});
    }
    return all;
}

TEST(Gradients, DerivativesEqualTheRecordedExactValues) {
    int compared = 0;
    std::map<Leg, double> worst;
    const support::Folder folder;
    for (const auto& [scene, entries] : recorded()) {
        const std::string file = folder.write(
            "scene.yaml", support::replaced(support::text_of(file_of(scene)), "spin_axis: y,",
                                            "spin_axis: y, contact: carrier,"));
        Asked all = asked(file, {}, "none");
        for (auto& channel : definition_channels(all.model))
            if (channel.kind() == ChannelKind::characteristic)
                all.outputs.push_back(std::move(channel));
        std::set<std::string> outputs, numbers, branches;
        for (const Recorded& entry : entries) {
            outputs.insert(entry.output);
            for (const auto& path : paths_in(entry.number)) numbers.insert(path);
            branches.insert(entry.side.substr(0, entry.side.find(" to ")));
        }
        std::erase_if(all.outputs, [&](const Channel& c) { return !outputs.contains(c.name); });
        all.varying =
            varying(file, {}, [&](const std::string& path) { return numbers.contains(path); });
        const Gradients by =
            gradients_of(all, {.points = 1, .branches = {branches.begin(), branches.end()}});
        EXPECT_TRUE(by.conclusive());
        for (const Recorded& entry : entries) {
            const auto side = std::ranges::find(by.sides, entry.side, &SideGradients::name);
            const auto k = std::ranges::find(by.numbers, entry.number, &VariedNumber::path) -
                           by.numbers.begin();
            const int c = find_channel(by.outputs, entry.output);
            ASSERT_TRUE(side != by.sides.end() && k < std::ssize(by.numbers) && c >= 0)
                << scene << ": " << entry.output << " by " << entry.number;
            for (const LegGradients& leg : side->legs)
                for (std::size_t s = 0; s < leg.at.size(); ++s) {
                    if (std::abs(in_unit(side->unit) * side->a[s] - entry.parameter) > 1e-9)
                        continue;
                    const double found = leg.at[s](c, k),
                                 off = std::abs(found - entry.derivative) * entry.step / entry.row;
                    EXPECT_LE(off, 1e-7)
                        << scene << ", " << entry.side << " at " << entry.parameter << ": "
                        << entry.output << " by " << entry.number << ", " << name(leg.leg) << ": "
                        << found << ", exact " << entry.derivative;
                    worst[leg.leg] = std::max(worst[leg.leg], off);
                    ++compared;
                }
        }
    }
    EXPECT_GE(compared, 1032);  // by two legs at least
    for (const auto& [leg, off] : worst) RecordProperty(name(leg), fmt::format("{:.1e}", off));
}

// Outputs of a group have the derivatives that they have alone, to the last bit; trim included.
TEST(Gradients, DerivativesOfSeveralGroupsEqualThoseOfEachGroupAlone) {
    Asked all = asked(file_of("chrono_mcpherson_preload"));
    all.varying.numbers.resize(12);
    const std::string branch = all.model.branches.front().name;
    const std::vector<GradientGroup> groups{
        {{all.outputs.begin(), all.outputs.begin() + 4},
         {.stations = {{branch, {0}}}, .branches = {branch}}},
        {{all.outputs.begin() + 2, all.outputs.begin() + 9}, {.points = 1}}};
    const auto together = gradients(all.scene, all.trimmed, all.model, all.varying, groups);
    ASSERT_EQ(together.size(), groups.size());
    const auto same = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
        return a.rows() == b.rows() &&
               ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
    };
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto alone = gradients(all.scene, all.trimmed, all.model, all.varying,
                                     groups[g].outputs, groups[g].options);
        ASSERT_EQ(together[g].sides.size(), alone.sides.size());
        EXPECT_EQ(together[g].outputs.size(), groups[g].outputs.size());
        for (std::size_t s = 0; s < alone.sides.size(); ++s) {
            const SideGradients &one = together[g].sides[s], &other = alone.sides[s];
            EXPECT_EQ(one.name, other.name);
            EXPECT_EQ(one.a, other.a);
            EXPECT_GT(one.worst.compared, 0);
            EXPECT_EQ(one.worst.compared, other.worst.compared);
            ASSERT_EQ(one.legs.size(), other.legs.size());
            for (std::size_t l = 0; l < one.legs.size(); ++l) {
                ASSERT_EQ(one.legs[l].at.size(), other.legs[l].at.size());
                for (std::size_t k = 0; k < one.legs[l].at.size(); ++k)
                    EXPECT_TRUE(same(one.legs[l].at[k], other.legs[l].at[k])) << one.name;
            }
        }
    }
}

// Against extrapolated differences of whole solutions, trim included.
TEST(Gradients, DerivativesEqualDifferencesOfScenesWithTheNumberChanged) {
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
        const Asked all = asked(file, {}, number);
        const auto found = all.varying.numbers.begin();
        constexpr Eigen::Index k = 0;
        const Gradients by = gradients_of(all, 1, {Leg::equilibrium});
        const double a = by.sides.front().a.back();
        const double h = found->unit == "mm" ? 1e3 * step : step;
        const auto at = [&](double change) {
            return outputs_with(file, setting(number, found->value + change), a);
        };
        const auto up = at(h), down = at(-h), near_up = at(h / 2), near_down = at(-h / 2);
        const auto& table = by.sides.front().legs.front().at.back();
        const auto determined = by.sides.front().why_output;
        // the largest entry of the outputs of a unit and kind
        std::map<std::pair<ChannelKind, Unit>, double> sizes;
        const auto size = [&](std::size_t c) -> double& {
            const Unit unit = all.outputs[c].unit;  // forces and moments together
            return sizes[{all.outputs[c].kind(), unit == Unit::newton_metre ? Unit::newton : unit}];
        };
        const auto entry = [&](std::size_t c) { return table(static_cast<Eigen::Index>(c), k); };
        for (std::size_t c = 0; c < all.outputs.size(); ++c)
            if (determined[c].empty() && std::isfinite(entry(c)))
                size(c) = std::max(size(c), std::abs(entry(c)));
        for (std::size_t c = 0; c < all.outputs.size(); ++c) {
            if (!determined[c].empty()) continue;
            if (!std::isfinite(up[c]) || !std::isfinite(down[c])) {
                EXPECT_TRUE(std::isnan(entry(c))) << scene << ": " << all.outputs[c].name;
                continue;
            }
            // an arm by its reciprocal
            const bool arm = is_swing_arm(all.outputs[c]);
            const auto of = [&](double y) { return arm ? 1 / y : y; };
            const double y = by.sides.front().values.back()[c],
                         exact = arm ? -entry(c) / (y * y) : entry(c);
            const double difference =
                (8 * (of(near_up[c]) - of(near_down[c])) - (of(up[c]) - of(down[c]))) / (6 * h);
            const double off = std::abs(exact - difference) / (arm ? std::abs(exact) : size(c));
            EXPECT_LE(off, 1e-7) << scene << ": " << all.outputs[c].name << " by " << number << ": "
                                 << exact << ", " << difference;
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
    const auto k = std::ranges::find(by.numbers, number, &VariedNumber::path) - by.numbers.begin();
    ASSERT_GE(c, 0);
    ASSERT_LT(k, std::ssize(by.numbers));
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
TEST(ClosedFormGradients, EqualThatOfTheHeightOfAPinnedBarByItsLength) {
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
TEST(ClosedFormGradients, EqualThatOfTheDeflectionOfAnArchByItsHeight) {
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
TEST(ClosedFormGradients, EqualThatOfTheRockerOfAFourBarByTheLengthOfItsCrank) {
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

// ---- Closed forms of characteristics, scenes in m: the derivatives are those of second order.

constexpr double in_deg = 180 / std::numbers::pi;

// By every leg: f(leg, derivative of an output by a number) at one station of the only branch.
template <class Check>
void each_leg(const std::string& text, const std::vector<std::string>& names,
              const std::vector<std::string>& paths, double at, const Check& check) {
    const Model model = compile(parse_scene(text, "closed.yaml", {}));
    const auto every = outputs_of(model);
    std::vector<Channel> outputs;
    for (const auto& output : names)
        outputs.push_back(every.at(static_cast<std::size_t>(find_channel(every, output))));
    const Gradients by = gradients_of(text, outputs, paths,
                                      {.stations = {{model.branches.front().name, {at}}},
                                       .legs = {Leg::equilibrium, Leg::energy, Leg::series}});
    ASSERT_EQ(by.sides.size(), 1u);
    for (const auto& leg : by.sides.front().legs) {
        ASSERT_EQ(leg.at.size(), 1u) << leg.failure;
        SCOPED_TRACE(name(leg.leg));
        check(leg.at.front());
    }
    EXPECT_TRUE(by.conclusive()) << by.sides.front().worst.where;
}

// A semi-trailing arm about the axis d = b - a: with W(q) = d_x (q_y - a_y) - d_y (q_x - a_x), the
// vertical velocity of q,
//
//   bump steer -d_z / W(c)          wheel rate k (u·v(low))² / (W(p) W(c)),  u along the spring
TEST(ClosedFormGradients, EqualThoseOfBumpSteerAndWheelRateOfASemiTrailingArm) {
    const double ax = 0.5, ay = 0.9, az = 0.02, dx = -0.08, dy = -0.4, dz = -0.07, k = 50e3;
    const auto W = [&](double x, double y) { return dx * (y - ay) - dy * (x - ax); };
    const double W_c = W(0, 1.1), W_p = W(0.03, 1.12), W_low = W(0.1, 1.0);
    const double v_x = dy * (0 - az) - dz * (1.0 - ay);  // of `low`
    const double rate = k * W_low * W_low / (W_p * W_c);
    each_leg(support::filled_text("compare/scenes/wheel_on_an_arm", {{"A", "[0.5, 0.9, 0.02]"},
                                                                     {"B", "[0.42, 0.5, -0.05]"},
                                                                     {"C", "[0, 1.1, 0]"},
                                                                     {"P", "[0.03, 1.12, -0.3]"},
                                                                     {"MORE", ""}}),
             {"bump_steer", "wheel_rate"},
             {"points.b.z", "points.a.x", "springs.coil.rate", "points.low.x"}, 0,
             [&](const Eigen::MatrixXd& by) {
                 EXPECT_NEAR(by(0, 0), in_deg * -1 / W_c, 1e-9);
                 // d_x falls by one, and a_x grows: dW = -(c_y - a_y) + d_y
                 EXPECT_NEAR(by(0, 1), in_deg * dz * (dy - (1.1 - ay)) / (W_c * W_c), 1e-8);
                 EXPECT_NEAR(by(0, 2), 0, 1e-12);
                 EXPECT_NEAR(by(1, 2), 1e-3 * rate / k, 1e-12);
                 EXPECT_NEAR(by(1, 3), 1e-3 * 2 * rate / W_low * (-dy - v_x / 0.4), 1e-7);
             });
}

std::string equal_arms(const std::string& branch) {
    const std::string text =
        support::filled_text("compare/scenes/arms_in_a_plane", {{"UI", "[0, 0.3, 0.45]"},
                                                                {"UO", "[0, 0.7, 0.45]"},
                                                                {"LI", "[0, 0.3, 0.15]"},
                                                                {"LO", "[0, 0.7, 0.15]"}});
    return support::replaced(text, "up: {load: up, to: 100, steps: 2}", branch);
}

// The upper inner joint raised by t: the lines of the arms meet at y - 0.3 = 0.4 (0.3 + t) / t, and
// the camber changes by 1 / (y - 0.8) = t / (0.12 - 0.1 t).
TEST(ClosedFormGradients, EqualThatOfCamberGainWhenParallelArmsLoseTheirParallelism) {
    each_leg(equal_arms("up: {load: up, to: 100, steps: 2}"), {"bump_camber"}, {"points.ui.z"}, 0,
             [](const Eigen::MatrixXd& by) { EXPECT_NEAR(by(0, 0), in_deg / 10 / 0.12, 1e-8); });
}

// Arms of length L, level as drawn, with the wheel raised by z on a jack: the patch moves inwards by
// z / √(L² - z²) of the rise. Both outer joints outwards make both arms longer.
TEST(ClosedFormGradients, EqualThoseOfTrackAndCamberGainByTheLengthOfEqualArms) {
    const double z = 0.1, L = 0.4;
    each_leg(equal_arms("lift: {drive: travel, to: 0.1, steps: 2}"),
             {"track_gradient", "bump_camber"}, {"points.uo.y", "points.lo.y"}, z,
             [&](const Eigen::MatrixXd& by) {
                 EXPECT_NEAR(by(0, 0) + by(0, 1), 100 * z * L / std::pow(L * L - z * z, 1.5), 1e-8);
                 EXPECT_NEAR(by(1, 0) + by(1, 1), 0, 1e-9);
             });
}

// At the corner of a law a stiffness has two values.
TEST(Gradients, DerivativeAtTheCornerOfALawIsNaNWithItsReason) {
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

// A spring of 20 N/mm that a stop of 80 N/mm joins at 10 mm: z = F / 20 below the knot and
// 10 + (F - 200) / 100 above. At F = 200 N the force itself, a number of the scene, has two rates.
TEST(Gradients, OneSidedDerivativesAtACornerAreThoseOfTheLawOnEitherSide) {
    const std::string text = support::scene_text("compare/scenes/block_on_a_stop");
    const auto every = outputs_of(compile(parse_scene(text, "stop.yaml", {})));
    const int z = find_channel(every, "tip_z");
    ASSERT_GE(z, 0);
    const Gradients by = gradients_of(text, {&every[static_cast<std::size_t>(z)], 1},
                                      {"springs.coil.rate", "springs.coil.rebound_stop.clearance"},
                                      {.stations = {{"up", {200}}}, .legs = {Leg::equilibrium}});
    const SideGradients& side = by.sides.front();
    ASSERT_EQ(side.one_sided.size(), 1u);
    EXPECT_NE(side.why_number[0][0].find("corner of its law"), std::string::npos);
    const OneSided& both = side.one_sided.front();
    ASSERT_FALSE(both.empty());
    // A stiffer spring, z falls: below the knot, -F / k². A softer one: above, -10 / 100.
    EXPECT_NEAR(both.growing(0, 0), -200. / 20 / 20, 1e-9);
    EXPECT_NEAR(both.falling(0, 0), -10. / 100, 1e-9);
    // More clearance: the spring alone, 0. Less: 80 / 100 of it.
    EXPECT_NEAR(both.growing(0, 1), 0, 1e-9);
    EXPECT_NEAR(both.falling(0, 1), 0.8, 1e-9);
}

}  // namespace
}  // namespace elastocheck::compare
