// Elements with other than linear rates, their twins, names and drivers.
// Stops, torsion springs, bushings with curves and formulations, followers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elastocheck/compile.hpp"
#include "models/laws.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

Curve curve_of(const Scene& scene, const std::string& name) {
    return std::get<Curve>(element<AxialSpring>(scene, name).law);
}
double force_as_drawn(const AxialSpring& spring) {
    return force(spring.law, 0.4 - spring.free_length);
}

// ---- Stops: a force over ℓ - 400 mm, the length at the design position.

TEST(Stops, ActOnlyBeyondTheirClearance) {
    const Scene scene = laws(
        spring_with("rate: 30, preload: 3000, bump_stop: {clearance: 30, rate: 300}, rebound_stop: "
                    "{clearance: 50, rate: 200}"));
    ASSERT_EQ(scene.elastics.size(), 3U);
    EXPECT_EQ(scene.elastics[0].name, "coil");
    EXPECT_EQ(scene.elastics[1].name, "coil.bump_stop");
    EXPECT_EQ(scene.elastics[2].name, "coil.rebound_stop");
    for (const char* stop : {"coil.bump_stop", "coil.rebound_stop"})
        EXPECT_DOUBLE_EQ(element<AxialSpring>(scene, stop).free_length, 0.4)
            << "whatever the spring's is";
    for (int mm = -100; mm <= 100; ++mm) {
        const double x = mm * 1e-3;
        EXPECT_NEAR(force(curve_of(scene, "coil.bump_stop"), x), 300e3 * std::min(0.0, x + 0.03),
                    1e-10)
            << mm;
        EXPECT_NEAR(force(curve_of(scene, "coil.rebound_stop"), x), 200e3 * std::max(0.0, x - 0.05),
                    1e-10)
            << mm;
    }
}

TEST(Stops, CanActBetweenAnyTwoPoints) {
    const Scene inside = laws(spring_with(
        "rate: 30, bump_stop: {clearance: 30, rate: 300}, rebound_stop: {clearance: 50, "
        "curve: {table: [[0, 0], [5, 70]]}}"));
    const Scene alone = laws(
        "stops:\n  axle: {bodies: [arm, ground], from: p, to: t, bump: {clearance: 30, rate: 300}, "
        "rebound: {clearance: 50, curve: {table: [[0, 0], [5, 70]]}}}");
    ASSERT_EQ(alone.elastics.size(), 2U);
    for (const auto& [a, b] :
         {std::pair{"coil.bump_stop", "axle.bump"}, {"coil.rebound_stop", "axle.rebound"}}) {
        const auto x = element<AxialSpring>(inside, a), y = element<AxialSpring>(alone, b);
        EXPECT_EQ(x.i.s_local, y.i.s_local);
        EXPECT_EQ(x.j.s_local, y.j.s_local);
        EXPECT_EQ(x.free_length, y.free_length);
        EXPECT_EQ(curve_of(inside, a).knots, curve_of(alone, b).knots);
        EXPECT_EQ(curve_of(inside, a).pieces, curve_of(alone, b).pieces);
    }
}

// The law equals a spring's with the same table over the penetration.
TEST(Stops, CurveIsAFunctionOfThePenetration) {
    const std::string table =
        "curve: {table: [[0, 0], [10, 900], [20, 4000], [25, 9000]], scale: 1.5}";
    const auto g = curve_of(laws(spring_with(table)), "coil");
    const Scene scene = laws(spring_with("rate: 30, bump_stop: {clearance: 8, " + table +
                                         "}, rebound_stop: {clearance: 4, " + table + "}"));
    for (int tenths = -500; tenths <= 500; ++tenths) {
        const double x = tenths * 1e-4, s = -x - 0.008, t = x - 0.004;
        EXPECT_NEAR(force(curve_of(scene, "coil.bump_stop"), x), s > 0 ? -force(g, s) : 0, 1e-10)
            << tenths;
        EXPECT_NEAR(force(curve_of(scene, "coil.rebound_stop"), x), t > 0 ? force(g, t) : 0, 1e-10)
            << tenths;
    }
}

TEST(Stops, MayBeClosedAtTheDesignPosition) {
    const Scene scene = laws(spring_with(
        "rate: 30, bump_stop: {clearance: -5, rate: 300}, rebound_stop: {clearance: 0, rate: 1}"));
    EXPECT_DOUBLE_EQ(force_as_drawn(element<AxialSpring>(scene, "coil.bump_stop")), -1500);
    EXPECT_EQ(force_as_drawn(element<AxialSpring>(scene, "coil.rebound_stop")), 0);
}

// The law of fixed seats where that pushes, else none. Tables that cross zero between their rows, at
// a row, on a flat part, outside the rows, or never.
TEST(LooseSeats, ForceIsNeverTensile) {
    for (const char* law : {"rate: 30", "rate: 0", "curve: {table: [[-50, -900], [30, 400]]}",
                            "curve: {table: [[-50, -900], [0, 0], [50, 1400]]}",
                            "curve: {table: [[-50, -900], [-9, 0], [9, 0], [50, 1400]]}",
                            "curve: {table: [[-50, -900], [-9, -100]]}",
                            "curve: {table: [[-50, -900], [-9, -100], [0, -100]]}",
                            "curve: {table: [[20, 100], [50, 1400]]}"})
        for (const char* bounded : {"", ", outside: unknown"}) {
            std::string text = law;
            if (text.back() == '}') text.insert(text.size() - 1, bounded);
            if (*bounded != 0 && text.find("[50, 1400]") == text.npos) continue;
            if (*bounded != 0 && text.find("[20, 100]") != text.npos) continue;
            const auto spring = [&](const char* seats) {
                return element<AxialSpring>(
                    laws(spring_with(text + ", free_length: 400, seats: " + seats)), "coil");
            };
            const AxialSpring fixed = spring("fixed"), free = spring("free");
            for (int mm = -100; mm <= 100; ++mm)
                EXPECT_NEAR(force(free.law, 1e-3 * mm), std::min(0., force(fixed.law, 1e-3 * mm)),
                            1e-10)
                    << text << " at " << mm;
            if (*bounded != 0) {
                EXPECT_GT(std::get<Curve>(free.law).knots.back(), 1e3);
            }
        }
}

// The open range of a stop is unbounded even if its closed range is bounded.
TEST(Stops, OpenRangeIsKnown) {
    const std::string curve =
        ", curve: {table: [[0, 0], [10, 900], [20, 4000]], outside: unknown}}";
    const Scene scene = laws(spring_with("rate: 30, bump_stop: {clearance: 8" + curve +
                                         ", rebound_stop: {clearance: 4" + curve));
    const Curve bump = curve_of(scene, "coil.bump_stop"),
                rebound = curve_of(scene, "coil.rebound_stop");
    EXPECT_FALSE(bump.known_outside || rebound.known_outside);
    EXPECT_DOUBLE_EQ(bump.knots.front(), -0.028);
    EXPECT_GT(bump.knots.back(), 1e5);
    EXPECT_LT(rebound.knots.front(), -1e5);
    EXPECT_DOUBLE_EQ(rebound.knots.back(), 0.024);
    EXPECT_EQ(force(bump, 0.3), 0);
    EXPECT_DOUBLE_EQ(force(bump, -0.018), -900);
    EXPECT_EQ(force(rebound, -0.3), 0);
    EXPECT_DOUBLE_EQ(force(rebound, 0.014), 900);
}

// ---- Torsion springs.

TEST(TorsionSpring, ResistsOnlyRotationAboutItsAxis) {
    const Scene scene = laws(
        R"(torsion_springs:
  bar: {bodies: [arm, ground], at: p, axis: [1, 2, -2], rate: 40, preload_moment: 3000}
  rubber: {bodies: [ground, arm], at: t, axis: [p, t], curve: {table: [[0, 0], [10, 700], [20, 3000]], symmetric: true}})");
    const auto bar = element<Bushing>(scene, "bar"), rubber = element<Bushing>(scene, "rubber");
    EXPECT_LE((bar.i.A_local * Vector3d::UnitZ() - Vector3d(1, 2, -2) / 3).norm(), 1e-15);
    EXPECT_NEAR(bar.i.A_local.norm(), 1, 1e-15);
    Matrix6 K = Matrix6::Zero();
    K(5, 5) = 40e-3 * 180 / M_PI;  // N·mm/deg
    EXPECT_LE((std::get<LinearStiffness>(bar.law).K - K).norm(), 1e-15);
    EXPECT_EQ(bar.preload, Vector6(3 * Vector6::Unit(5)));
    EXPECT_EQ(bar.i.s_local, Vector3d(0.05, 0, 0));

    const auto& axes = std::get<PerAxis>(rubber.law).axis;
    for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(force(axes[k], 0.1), 0);
    EXPECT_NEAR(force(axes[5], 20 * M_PI / 180), 3, 1e-14);
    EXPECT_NEAR(force(axes[5], -10 * M_PI / 180), -0.7, 1e-15);
    EXPECT_LE((rubber.j.A_local * Vector3d::UnitZ() - Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(TorsionSpring, IsDrivenByItsPreloadMoment) {
    const Scene scene = parse_scene(
        laws_scene("torsion_springs:\n  bar: {bodies: [arm, ground], at: p, axis: y, rate: 40}",
                   "length: mm, angle: deg, force: N",
                   "drive: torsion_springs.bar.preload_moment, to: 3000, steps: 1"),
        "laws.yaml");
    const Branch& branch = scene.branches.at(0);
    EXPECT_EQ(branch.unit, ParameterUnit::newton_metre);
    EXPECT_EQ(branch.to, 3);
    EXPECT_EQ(std::get<Preload>(branch.drivers.at(0).what).direction, Vector6(Vector6::Unit(5)));
}

// ---- Bushings.

std::string bushing_with(const std::string& fields) {
    return "bushings:\n  mount: {bodies: [arm, ground], at: p, " + fields + "}";
}

TEST(BushingCurves, ReplaceTheRatesOfTheirAxes) {
    const Scene scene = laws(bushing_with(
        "rates: [1, 2, 3], rotational_rates: [4, 5, 6], curves: {x: {table: [[-1, -70], "
        "[2, 90]], outside: unknown}, "
        "rz: {table: [[0, 0], [10, 700]], symmetric: true}}"));
    const auto law = std::get<PerAxis>(element<Bushing>(scene, "mount").law).axis;
    EXPECT_DOUBLE_EQ(force(law[0], 0.002), 90);
    EXPECT_FALSE(std::get<Curve>(law[0]).known_outside);
    EXPECT_EQ(std::get<LinearRate>(law[1]).k, 2e3);
    EXPECT_EQ(std::get<LinearRate>(law[2]).k, 3e3);
    EXPECT_DOUBLE_EQ(std::get<LinearRate>(law[3]).k, 4e-3 * 180 / M_PI);
    EXPECT_NEAR(force(law[5], -10 * M_PI / 180), -0.7, 1e-15);
}

TEST(BushingCurves, NeedNoRates) {
    const Scene scene = laws(bushing_with("curves: {y: {table: [[-1, -70], [2, 90]]}}"));
    const auto law = std::get<PerAxis>(element<Bushing>(scene, "mount").law).axis;
    EXPECT_TRUE(std::holds_alternative<Curve>(law[1]));
    for (const std::size_t k : {0, 2, 3, 4, 5}) EXPECT_EQ(std::get<LinearRate>(law[k]).k, 0);
}

TEST(BushingFormulation, DefaultIsThatOfThePaper) {
    using Frame = Formulation::Frame;
    using Angles = Formulation::Angles;
    const auto read = [](const std::string& fields) {
        return element<Bushing>(laws(bushing_with("rates: [1, 1, 1]" + fields)), "mount")
            .formulation;
    };
    EXPECT_EQ(read(""), Formulation());
    EXPECT_EQ(read(", formulation: {}"), Formulation());
    for (const auto& [frame, f] :
         {std::pair{"i", Frame::on_i}, {"j", Frame::on_j}, {"middle", Frame::middle}})
        for (const auto& [angles, a] : {std::pair{"rotation_vector", Angles::rotation_vector},
                                        {"cardan", Angles::cardan},
                                        {"projected", Angles::projected}})
            for (const bool conjugate : {true, false})
                for (const bool moment : {true, false}) {
                    if (f == Frame::middle && !conjugate) continue;
                    EXPECT_EQ(read(fmt::format(", formulation: {{frame: {}, angles: {}, conjugate: "
                                               "{}, offset_moment: {}}}",
                                               frame, angles, conjugate, moment)),
                              (Formulation{f, a, conjugate, moment}));
                }
}

TEST(BushingUndeformed, IsAnOffsetOfThreeLengthsAndThreeAngles) {
    const auto mount = element<Bushing>(
        laws(
            bushing_with("rates: [1, 1, 1], undeformed: [1, 2, 3], undeformed_angles: [0, 0, 90]")),
        "mount");
    const Vector6 expected = (Vector6() << 0.001, 0.002, 0.003, 0, 0, M_PI / 2).finished();
    EXPECT_LE((mount.undeformed - expected).norm(), 1e-16);
}

// One axis of the frame suffices if the law is symmetric about it.
TEST(BushingFrame, FrameOfOneAxisAcceptsCurvesAlongIt) {
    EXPECT_NO_THROW(laws(bushing_with(
        "frame: {z: [1, 2, 3]}, rates: [7, 7, 0], rotational_rates: [2, 2, 0], curves: {z: {table: "
        "[[-1, -70], [2, 90]]}, rz: {table: [[-1, -70], [2, 90]]}}, undeformed: [0, 0, 4]")));
}

// ---- Followers.

TEST(Followers, ComponentsAreThoseInTheDesignPosition) {
    const Scene scene =
        parse_scene(laws_scene(R"(static_loads:
  drag: {on: arm, at: p, force: [1, 2, 3], follows: true}
  twist: {on: arm, moment: [1000, 0, 2000], follows: true}
  dead: {on: arm, at: p, force: [1, 2, 3], follows: false})",
                               "length: mm, angle: deg, force: N",
                               "load: {push: 1}, static_loads: [push], to: 10, steps: 1"),
                    "laws.yaml");
    const auto drag = std::get<FollowerForce>(scene.static_loads.at(0).kind);
    EXPECT_EQ(drag.at.s_local, Vector3d(0.05, 0, 0));
    EXPECT_EQ(drag.f_local, Vector3d(1, 2, 3));
    EXPECT_EQ(std::get<FollowerMoment>(scene.static_loads.at(1).kind).m_local, Vector3d(1, 0, 2));
    EXPECT_EQ(std::get<DeadForce>(scene.static_loads.at(2).kind).f, Vector3d(1, 2, 3));
}

TEST(Followers, DriveBranchesAsOtherLoadsDo) {
    std::string text =
        laws_scene("", "length: mm, angle: deg, force: N", "load: [push, twist], to: 10, steps: 1");
    const std::string loads =
        "loads: {push: {on: arm, at: p, force: [0, 0, 1], follows: true}, twist: {on: arm, moment: "
        "[0, 5, "
        "0], follows: true}}";
    text.replace(text.find("loads: {push"), text.find("\nbranches") - text.find("loads: {push"),
                 loads);
    const Scene scene = parse_scene(text, "laws.yaml");
    const auto load = [&](std::size_t k) {
        return std::get<Load>(scene.branches.at(0).drivers.at(k).what).kind;
    };
    EXPECT_EQ(std::get<FollowerForce>(load(0)).f_local, Vector3d(0, 0, 1));
    EXPECT_EQ(std::get<FollowerMoment>(load(1)).m_local, Vector3d(0, 0.005, 0)) << "N·mm per N";
}

// ---- Twins.

Scene mirrored_axle() { return parse_scene(fixture("laws_axle"), "axle.yaml"); }
Scene axle_by_hand() { return parse_scene(fixture("laws_axle_by_hand"), "axle.yaml"); }

// Generalised force of a bushing's law and preload for the deformation e given in ground axes.
Vector6 force_in_ground(const Bushing& b, const Vector6& ground_e) {
    const Eigen::Matrix3d A = b.i.A_local.toRotationMatrix();
    Vector6 e;
    e << A.transpose() * ground_e.head<3>(), A.transpose() * ground_e.tail<3>();
    Vector6 F = b.preload;
    if (const auto* linear = std::get_if<LinearStiffness>(&b.law))
        F += linear->K * (e - b.undeformed);
    if (const auto* axes = std::get_if<PerAxis>(&b.law))
        for (int k = 0; k < 6; ++k)
            F[k] += force(axes->axis[static_cast<std::size_t>(k)], e[k] - b.undeformed[k]);
    Vector6 result;
    result << A * F.head<3>(), A * F.tail<3>();
    return result;
}

TEST(MirroredLaws, EqualTheTwinWrittenByHand) {
    const Scene mirrored = mirrored_axle(), by_hand = axle_by_hand();
    for (const char* name : {"coil_right", "coil_right.bump_stop", "axle_right.rebound"}) {
        const auto a = element<AxialSpring>(mirrored, name),
                   b = element<AxialSpring>(by_hand, name);
        EXPECT_EQ(a.free_length, b.free_length) << name;
        EXPECT_EQ(a.i.s_local, b.i.s_local) << name;
        EXPECT_EQ(a.j.s_local, b.j.s_local) << name;
        EXPECT_EQ(std::get<Curve>(a.law).knots, std::get<Curve>(b.law).knots) << name;
        EXPECT_EQ(std::get<Curve>(a.law).pieces, std::get<Curve>(b.law).pieces) << name;
    }
    for (const char* name : {"bar_right", "rod_right", "mount_right"}) {
        const auto a = element<Bushing>(mirrored, name), b = element<Bushing>(by_hand, name);
        EXPECT_EQ(a.formulation, b.formulation);
        double worst = 0;
        for (int n = 0; n < 2000; ++n) {
            const Vector6 e = 0.2 * Vector6::Random();
            const Vector6 gap = force_in_ground(a, e) - force_in_ground(b, e);
            worst = std::max(worst, gap.cwiseAbs().maxCoeff() /
                                        (1 + force_in_ground(b, e).cwiseAbs().maxCoeff()));
        }
        EXPECT_LE(worst, 1e-13) << name;
    }
    const auto load = [](const Scene& scene, const std::string& name) {
        return std::ranges::find(scene.static_loads, name, &Load::name)->kind;
    };
    EXPECT_EQ(std::get<FollowerForce>(load(mirrored, "drag_right")).f_local,
              std::get<FollowerForce>(load(by_hand, "drag_right")).f_local);
    EXPECT_EQ(std::get<FollowerForce>(load(mirrored, "drag_right")).at.s_local,
              std::get<FollowerForce>(load(by_hand, "drag_right")).at.s_local);
    EXPECT_EQ(std::get<FollowerMoment>(load(mirrored, "curl_right")).m_local,
              std::get<FollowerMoment>(load(by_hand, "curl_right")).m_local);
}

// Equal driver values are a symmetric motion, so they preload the twin like an entry with a
// mirrored axis.
TEST(MirroredLaws, DriversEqualThoseOfTheTwinWrittenByHand) {
    const auto moment = [](const Scene& scene) -> Vector3d {
        const Driver& driver = scene.branches.at(0).drivers.back();
        const auto bar = element<Bushing>(scene, "bar_right");
        return bar.i.A_local * (driver.rate * std::get<Preload>(driver.what).direction.tail<3>());
    };
    EXPECT_LE((moment(mirrored_axle()) - moment(axle_by_hand())).norm(), 1e-15);
    EXPECT_NEAR(moment(axle_by_hand()).norm(), 1, 1e-15);
}

// ---- Names and numbers.

TEST(LawNumbers, TableEntriesHaveTheirPlaces) {
    const std::string three = laws_scene(
        spring_with("curve: {table: [[-50, -900], [0, 0], [50, 1400]], offset: 2, scale: 3}, "
                    "bump_stop: {clearance: 9, curve: {table: [[0, 0], [5, 70]]}}") +
        R"(
torsion_springs: {bar: {bodies: [arm, ground], at: p, axis: x, rate: 4, preload_moment: 6}}
)" + bushing_with("undeformed_angles: [1, 2, 3], curves: {rx: {table: [[0, 0], [5, 70]]}}"));
    const Scene scene = parse_scene(three, "laws.yaml");
    const auto number = [&](const std::string& path) {
        const auto found = std::ranges::find(scene.numbers, path, &Number::path);
        return found == scene.numbers.end() ? "none"
                                            : fmt::format("{} {}", found->value, found->unit);
    };
    EXPECT_EQ(number("springs.coil.curve.table.3.2"), "1400 N");
    EXPECT_EQ(number("springs.coil.curve.table.1.1"), "-50 mm");
    EXPECT_EQ(number("springs.coil.curve.offset"), "2 mm");
    EXPECT_EQ(number("springs.coil.curve.scale"), "3 ");
    EXPECT_EQ(number("springs.coil.bump_stop.clearance"), "9 mm");
    EXPECT_EQ(number("springs.coil.bump_stop.curve.table.2.2"), "70 N");
    EXPECT_EQ(number("torsion_springs.bar.rate"), "4 N·mm/deg");
    EXPECT_EQ(number("torsion_springs.bar.preload_moment"), "6 N·mm");
    EXPECT_EQ(number("bushings.mount.undeformed_angles.z"), "3 deg");
    EXPECT_EQ(number("bushings.mount.curves.rx.table.2.1"), "5 deg");
    EXPECT_EQ(number("bushings.mount.curves.rx.table.2.2"), "70 N·mm");
    for (const Number& n : scene.numbers) {
        const Setting same = setting(n.path, n.value);
        EXPECT_NO_THROW(parse_scene(three, "laws.yaml", {&same, 1})) << n.path;
    }
    const Setting set{"springs.coil.curve.table.3.2", "1500"};
    EXPECT_DOUBLE_EQ(
        force(std::get<Curve>(
                  element<AxialSpring>(parse_scene(three, "laws.yaml", {&set, 1}), "coil").law),
              0.052),
        4500);
}

TEST(SpringCurve, IsDrivenByItsFreeLength) {
    const Scene scene =
        parse_scene(laws_scene(spring_with("curve: {table: [[-50, -900], [0, 0], [50, 1400]]}"),
                               "length: mm, angle: deg, force: N",
                               "drive: springs.coil.free_length, to: 10, steps: 1"),
                    "laws.yaml");
    EXPECT_EQ(std::get<FreeLength>(scene.branches.at(0).drivers.at(0).what).elastic, 0);
    EXPECT_EQ(scene.branches[0].to, 0.01);
}

// ---- Reduction by compile(): a body attached to one other is removed unless it has
// a loaded element.

std::size_t bodies_kept(const std::string& elements) {
    std::string text = laws_scene(
        elements +
        "\n  hold: {bodies: [loose, arm], at: t, rates: [5, 5, 5], rotational_rates: [5, 5, 5]}");
    const std::string bodies = "bodies: {arm: {origin: o}}";
    text.replace(text.find(bodies), bodies.size(),
                 "bodies: {arm: {origin: o}, loose: {origin: t}}");
    return compile(parse_scene(text, "laws.yaml")).bodies.size();
}

TEST(CompileLaws, BodyLoadedByACurveAtDesignIsKept) {
    const auto spring = [](const std::string& fields) {
        return "springs:\n  coil: {bodies: [loose, arm], from: p, to: t, " + fields +
               "}\nbushings:";
    };
    const auto bushing = [](const std::string& fields) {
        return "bushings:\n  mount: {bodies: [loose, arm], at: p, " + fields + "}";
    };
    EXPECT_EQ(bodies_kept(spring("rate: 5")), 1U);
    EXPECT_EQ(bodies_kept(spring("rate: 5, preload: 1")), 2U);
    EXPECT_EQ(bodies_kept(spring("curve: {table: [[-50, -900], [0, 0], [50, 1400]]}")), 1U);
    EXPECT_EQ(bodies_kept(spring("curve: {table: [[-50, -900], [0, 1], [50, 1400]]}")), 2U);
    EXPECT_EQ(bodies_kept(spring("curve: {table: [[-50, -900], [0, 0], [50, 1400]], offset: 0.1}")),
              2U);
    EXPECT_EQ(bodies_kept(spring(
                  "curve: {table: [[-50, -900], [-5, 0], [5, 0], [50, 1400]]}, free_length: 402")),
              1U);
    EXPECT_EQ(bodies_kept(spring("rate: 5, bump_stop: {clearance: 3, rate: 7}")), 1U);
    EXPECT_EQ(bodies_kept(spring("rate: 5, bump_stop: {clearance: 0, rate: 7}")), 1U);
    EXPECT_EQ(bodies_kept(spring("rate: 5, bump_stop: {clearance: -0.1, rate: 7}")), 2U);
    EXPECT_EQ(bodies_kept(bushing("rates: [1, 1, 0]")), 1U);
    EXPECT_EQ(bodies_kept(bushing("rates: [1, 1, 0], undeformed: [0, 0.1, 0]")), 2U);
    EXPECT_EQ(bodies_kept(bushing("rates: [1, 1, 0], undeformed: [0, 0, 0.1]")), 1U)
        << "nothing along z";
    EXPECT_EQ(bodies_kept(bushing("curves: {ry: {table: [[-1, -2], [0, 0], [1, 7]]}}")), 1U);
    EXPECT_EQ(bodies_kept(bushing("curves: {ry: {table: [[-1, -2], [0, 0.1], [1, 7]]}}")), 2U);
    EXPECT_EQ(
        bodies_kept(bushing(
            "curves: {ry: {table: [[-1, -2], [0, 0.1], [1, 7]]}}, undeformed_angles: [0, 1, 0]")),
        2U);
    EXPECT_EQ(
        bodies_kept(
            "torsion_springs: {bar: {bodies: [loose, arm], at: p, axis: x, rate: 5}}\nbushings:"),
        1U);
    EXPECT_EQ(bodies_kept("torsion_springs: {bar: {bodies: [loose, arm], at: p, axis: x, rate: 5, "
                          "preload_moment: 1}}\nbushings:"),
              2U);
}

}  // namespace
}  // namespace elastocheck
