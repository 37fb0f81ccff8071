// Closed-form and textbook solutions, from the text of a scene through every leg and the series.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/cantilever.hpp"
#include "tests/support/scene_text.hpp"

namespace elastocheck::compare {
namespace {

using namespace support;  // the leaf: E, G, L, width, thick, EI
using std::numbers::pi;

// [mm] [deg] distance of the references without a knot of a curve
constexpr double no_curve = 1e-8;
constexpr double expansions = 1e-9;  // [mm] [deg] distance of the series from the equilibrium leg

const std::string units = "\nunits: {length: m, angle: rad, force: N}\n";

// A scene, in metres, radians and newtons where its text has no head, solved by the series and both references,
// which must agree.
class Solved {
  public:
    // `told`: tolerance of the series [m]; smaller for chains of many bodies.
    Solved(const std::string& text, const std::string& what,
           double told = recursive::Series{}.tolerance)
        : model(compile(parse_scene(
              (text.find("elastocheck: 1") != text.npos ? ""
                                                        : "elastocheck: 1\nname: " + what + units) +
                  text,
              what))) {
        Options options;
        options.recursion.method = {"series", 0, recursive::Series{.tolerance = told}};
        all = compare(model, options);
        EXPECT_TRUE(all.conclusive()) << what;
        for (const auto& branch : all.branches) {
            for (const auto& why : branch.inconclusive.texts())
                ADD_FAILURE() << what << " " << branch.branch << ": " << why;
            for (const Pair* pair : {&branch.uncertainty, &branch.deviation}) {
                const auto& read = pair->equal_parameter.channels;
                if (read.size() != all.channels.size()) ADD_FAILURE() << what << ": not compared";
                for (std::size_t c = 0; c < read.size(); ++c)
                    if (all.channels[c].kinematic()) {
                        EXPECT_LE(read[c].max, pair == &branch.deviation ? expansions : no_curve)
                            << what << " " << branch.branch << " " << all.channels[c].name << " "
                            << name(pair->b);
                    }
            }
        }
    }

    // Output of a leg along a branch; Leg::recursive is the series. In mm, deg, N, N·m.
    std::vector<double> read(std::string_view branch, std::string_view channel,
                             Leg leg = Leg::equilibrium) const {
        return run(branch, leg)
            .curve.channel(static_cast<std::size_t>(find_channel(all.channels, channel)));
    }
    double at_end(std::string_view branch, std::string_view channel,
                  Leg leg = Leg::equilibrium) const {
        return read(branch, channel, leg).back();
    }
    const LegRun& run(std::string_view branch, Leg leg) const {
        for (const auto& b : all.branches)
            if (b.branch == branch) return b.runs.at(static_cast<std::size_t>(leg));
        throw std::logic_error("no branch " + std::string(branch));
    }

    Model model;
    Comparison all;
};

// ---- Beams.

// Under a moment M at its tip the beam has the constant curvature M/EI. A chain of n segments turns
// at each by θ = M L/(n EI) and lies on a circle as well, smaller by
// (θ/2)/tan(θ/2) = 1 - θ²/12 - ...: order 2 in n. In the plane a dead moment and a follower moment
// are equal; the latter has no energy.
TEST(Cantilever, EndMomentBendsItIntoACircle) {
    const double turn = 2 * pi;
    for (const bool follows : {false, true}) {
        std::vector<double> errors;
        for (const int n : {4, 8, 16}) {
            const Solved s(
                leaf(n) +
                    fmt::format(R"(loads: {{roll: {{on: tip, moment: [0, 0, 1], follows: {}}}}}
branches: {{roll: {{load: roll, to: {}, steps: 8}}}}
)",
                                follows, turn * EI / L),
                fmt::format("leaf of {} segments, {}", n, follows ? "follower" : "dead"), 1e-13);
            EXPECT_EQ(s.all.branches[0].second, follows ? Leg::series : Leg::energy);
            const auto x = s.read("roll", "tip_x"), y = s.read("roll", "tip_y"),
                       z = s.read("roll", "tip_z");
            ASSERT_EQ(x.size(), 9u) << n;
            double error = 0;
            for (std::size_t k = 1; k < x.size(); ++k) {
                const double phi = turn * static_cast<double>(k) / 8, theta = phi / n,
                             R = 1e3 * L / phi;
                const double chain = R * (theta / 2) / std::tan(theta / 2);
                EXPECT_NEAR(x[k], chain * std::sin(phi), 1e-8) << n << " " << phi;
                EXPECT_NEAR(y[k], chain * (1 - std::cos(phi)), 1e-8) << n << " " << phi;
                EXPECT_NEAR(z[k], 0, 1e-8) << n << " " << phi;
                error = std::max(
                    error, std::hypot(x[k] - R * std::sin(phi), y[k] - R * (1 - std::cos(phi))));
            }
            errors.push_back(error);
        }
        for (std::size_t k = 1; k < errors.size(); ++k)
            EXPECT_NEAR(order(errors[k - 1], errors[k]), 2, 0.05)
                << errors[k - 1] << " to " << errors[k];
    }
}

// A round rod has equal bending stiffness in and across the plane of its circle. A dead moment has
// no potential for finite rotations: its stiffness is unsymmetric, and the symmetric part becomes
// indefinite before half a turn, although no other equilibrium branches off: the tangent stays
// regular. The energy leg, which finds only minima, ends there with an outcome; the equilibrium leg
// and the series continue round.
TEST(Cantilever, RoundRodUnderADeadMomentEndsOnlyInTheEnergyLeg) {
    const int n = 8, steps = 16;
    const double diameter = 0.022, EI_rod = E * pi * std::pow(diameter, 4) / 64;
    const auto number = [](double x) { return fmt::format("{}", x); };
    const Model model =
        compile(support::filled_scene("compare/scenes/rod", {{"L", number(L)},
                                                             {"N", number(n)},
                                                             {"E", number(E)},
                                                             {"G", number(G)},
                                                             {"DIAMETER", number(diameter)},
                                                             {"TO", number(2 * pi * EI_rod / L)},
                                                             {"STEPS", number(steps)}}));
    const auto ways = sides_of(model, model.branches[0]);
    for (const Leg leg : {Leg::equilibrium, Leg::series, Leg::energy}) {
        const auto path = solve_branch(ways, {.leg = leg});
        if (leg == Leg::energy) {
            EXPECT_EQ(path.outcome, Outcome::branch_lost) << path.detail;
            EXPECT_NE(path.detail.find("stops being a minimum"), std::string::npos) << path.detail;
            EXPECT_GT(path.points.size(), 4u);
            EXPECT_LT(path.points.size(), 10u) << "by half a turn";
        } else {
            EXPECT_EQ(path.outcome, Outcome::converged) << name(leg) << path.detail;
            ASSERT_EQ(path.points.size(), 17u) << name(leg);
        }
        for (const auto& point : path.points) {
            const double phi = point.load * L / EI_rod, theta = phi / n;
            if (phi == 0) continue;
            const double R = L / phi * (theta / 2) / std::tan(theta / 2);
            const Eigen::Vector3d tip(R * std::sin(phi), R * (1 - std::cos(phi)), 0);
            const auto body = static_cast<std::size_t>(model.probes[0].at.body);
            const double off = (point.poses[body].r - tip).norm();
            EXPECT_LE(1e3 * off, 1e-8) << name(leg) << " " << phi;
        }
    }
}

// ---- Torsion, bending, and both.

// A rod of 22 mm.
constexpr double D = 0.022, EI_rod = E * pi * D * D * D * D / 64,
                 GJ_rod = G * pi * D * D * D * D / 32;
const std::string steel_rod = fmt::format("E: {}, G: {}, diameter: {}", E, G, D);

// T = G J φ / L: a rod of any number of segments, and the torsion spring of the same rate. A lever
// at its end shows the angle.
TEST(TorsionBar, TwistsByItsTorqueTimesLengthOverGJ) {
    const double turn = 2.5;  // [rad]
    const std::string end = fmt::format(
        R"(loads: {{torque: {{on: tip, moment: [1, 0, 0]}}}}
probes: {{lever: {{on: tip, at: lever}}}}
branches: {{twist: {{load: torque, from: {}, to: {}, steps: 10}}}}
)",
        -turn * GJ_rod / L, turn * GJ_rod / L);
    const std::string points = fmt::format(
        R"(points: {{root: [0, 0, 0], tip: [{}, 0, 0], lever: [{}, 0.1, 0]}}
bodies: {{tip: {{origin: tip}}}}
)",
        L, L);
    std::vector<std::string> bars{fmt::format(
        R"(joints: {{hinge: {{type: revolute, bodies: [tip, ground], at: tip, axis: x}}}}
torsion_springs: {{bar: {{bodies: [tip, ground], at: tip, axis: x, rate: {}}}}}
)",
        GJ_rod / L)};
    for (const int n : {1, 3, 12})
        bars.push_back(fmt::format(
            "beams: {{bar: {{bodies: [ground, tip], through: [root, tip], segments: {}, {}}}}}\n",
            n, steel_rod));
    for (const auto& bar : bars) {
        const Solved s(points + bar + end, "torsion bar");
        for (const Leg leg : legs) {
            const LegRun& run = s.run("twist", leg);
            const auto x = s.read("twist", "lever_x", leg), y = s.read("twist", "lever_y", leg),
                       z = s.read("twist", "lever_z", leg);
            ASSERT_EQ(run.curve.a.size(), 11u) << bar;
            for (std::size_t k = 0; k < x.size(); ++k) {
                const double phi = run.curve.a[k] * L / GJ_rod;
                EXPECT_NEAR(x[k], 1e3 * L, 1e-8) << bar << name(leg);
                EXPECT_NEAR(y[k], 100 * std::cos(phi), 1e-8) << bar << name(leg);
                EXPECT_NEAR(z[k], 100 * std::sin(phi), 1e-8) << bar << name(leg);
            }
        }
    }
}

// w = F L³/(48 E I) for small forces, for any number of segments; the remainder grows as F³.
TEST(LeafSpring, MidpointDeflectionIsFLCubedOver48EI) {
    const double length = 1.2, b = 0.060, t = 0.012, EI_leaf = E * b * t * t * t / 12;
    const double rate = 48 * EI_leaf / (length * length * length);  // 49 kN/m
    for (const int n : {2, 4, 10}) {
        const auto text = [&](double force) {
            return fmt::format(
                R"(points: {{eye_front: [{0}, 0, 0], seat: [0, 0, 0], eye_rear: [-{0}, 0, 0]}}
bodies: {{front: {{origin: eye_front}}, rear: {{origin: eye_rear}}}}
joints:
  front: {{type: revolute, bodies: [front, ground], at: eye_front, axis: y}}
  shackle: {{type: in_plane, bodies: [rear, ground], at: eye_rear, normal: z}}
beams: {{leaf: {{bodies: [front, rear], through: [eye_front, seat, eye_rear], segments: {1}, up: z, E: {2}, G: {3},
  A: {4}, I_y: {5}, I_z: {6}, J: {7}}}}}
loads: {{push: {{on: leaf.seat, at: seat, force: [0, 0, 1]}}}}
probes: {{seat: {{on: leaf.seat, at: seat}}}}
branches: {{push: {{load: push, to: {8}, steps: 4}}}}
)",
                length / 2, n, E, G, b * t, b * t * t * t / 12, t * b * b * b / 12,
                b * t * t * t / 3, force);
        };
        std::vector<double> more;
        for (const double F : {5., 50., 500.}) {
            const Solved s(text(F), fmt::format("leaf of {} under {} N", n, F));
            for (const Leg leg : legs) {
                const double w = s.at_end("push", "seat_z", leg) / (1e3 * F / rate);
                if (F == 5) {
                    EXPECT_NEAR(w, 1, 1e-7) << n << " " << name(leg);
                }
                if (leg == Leg::equilibrium) more.push_back(w - 1);
            }
        }
        EXPECT_NEAR(more[2] / more[1], 100, 2) << n << ": " << more[1] << " to " << more[2];
    }
}

// An anti-roll bar: a rod b long in two bearings, its arms a long, one end held by its link, a
// force F at the other. Both arms bend like cantilevers, the rod between them twists under F a:
//
//   w = F (2 a³/(3 E I) + a² b/(G J))
TEST(AntiRollBar, RateIsTheInverseOfBendingPlusTorsionCompliance) {
    const double a = 0.2, b = 0.9;
    const double rate = 1 / (2 * a * a * a / (3 * EI_rod) + a * a * b / GJ_rod);  // 45 kN/m
    for (const int n : {3, 7, 21}) {
        const auto text = [&](double force) {
            return support::filled_text("compare/scenes/anti_roll_bar",
                                        {{"SEGMENTS", fmt::format("{}", n)},
                                         {"ROD", steel_rod},
                                         {"FORCE", fmt::format("{}", force)}});
        };
        std::vector<double> more;
        for (const double F : {5., 50., 500.}) {
            const Solved s(text(F), fmt::format("bar of {} under {} N", n, F));
            for (const Leg leg : legs) {
                const double w = s.at_end("lift", "end_z", leg) / (1e3 * F / rate);
                if (F == 5) {
                    EXPECT_NEAR(w, 1, 1e-6) << n << " " << name(leg);
                }
                if (leg == Leg::equilibrium) more.push_back(w - 1);
            }
        }
        EXPECT_NEAR(more[2] / more[1], 100, 5) << n << ": " << more[1] << " to " << more[2];
    }
}

// ---- Stops.

// A block on a spring of 20 kN/m, with a bump stop at 30 mm below and a rebound stop at
// 50 mm above.
struct Block {
    double k = 20e3, c = 0.03, s = 300e3, d = 0.05, r = 120e3;

    std::string text(double to) const {
        return support::filled_text(
            "compare/scenes/block_between_stops",
            {{"FROM", fmt::format("{}", -to)}, {"TO", fmt::format("{}", to)}});
    }
    // Displacement under a force F.
    double down(double F) const {
        return F > k * c ? (F + s * c) / (k + s) : F < -k * d ? (F - r * d) / (k + r) : F / k;
    }
};

// The step that closes the stop uses the stiffness before contact. Methods that sum stiffness times
// step keep that error: the part of the step beyond the knot times the difference in flexibility,
// of first order in the step. Methods that start each step from the true force recover it in the
// next step.
TEST(Stop, MethodsThatSumStepsKeepTheErrorOfTheStepThatClosesIt) {
    const Block block;
    const double to = 3100;
    const Model model = compile(parse_scene(block.text(to), "block"));
    for (const auto& method : recursive::methods)
        for (const int steps : {20, 40, 80, 160}) {
            const LegRun done =
                run(model, model.branches[0], Leg::recursive, {.method = method, .steps = steps});
            ASSERT_EQ(done.outcome, Outcome::converged) << method.name << ": " << done.detail;
            const double step = 2 * to / steps;
            // the load at contact, the stop's rate
            const auto kept = [&](double contact, double stop) {
                const double behind = std::ceil(contact / step) * step - contact;
                return behind * (1 / block.k - 1 / (block.k + stop));
            };
            const auto* linear = std::get_if<recursive::Linear>(&method.kind);
            const bool sums = linear && !(linear->stored == recursive::all_follow);
            const auto error = [&](const Equilibrium& point) {
                return 0.4 - point.poses[0].r.z() - block.down(point.load);
            };
            EXPECT_NEAR(error(*done.landmarks.back), sums ? kept(block.k * block.c, block.s) : 0,
                        1e-12)
                << method.name << " " << steps;
            EXPECT_NEAR(error(*done.landmarks.front), sums ? -kept(block.k * block.d, block.r) : 0,
                        1e-12)
                << method.name << " " << steps;
        }
}

}  // namespace
}  // namespace elastocheck::compare
