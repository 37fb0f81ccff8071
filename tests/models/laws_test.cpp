// Laws of stops, loose seats and bushings, their twins and the names of their numbers; what else the
// reader makes of elements is in fixtures/laws.facts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "models/laws.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

Curve curve_of(const Scene& scene, const std::string& name) {
    return std::get<Curve>(element<AxialSpring>(scene, name).law);
}

// ---- Stops: a force over ℓ - 400 mm, the length at the design position.

// The law equals a spring's with the same table over the penetration.
TEST(Stops, ForceIsTheCurveAtThePenetration) {
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

// The force is that with fixed seats where it is compressive, else zero. The tables cross zero between their rows, at a
// row, on a flat part, outside the rows, or never.
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

// ---- Bushings.

std::string bushing_with(const std::string& fields) {
    return "bushings:\n  mount: {bodies: [arm, ground], at: p, " + fields + "}";
}

TEST(BushingFormulation, OmittedFieldsTakeTheDefaultAndEveryCombinationIsRead) {
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

TEST(MirroredLaws, SpringsAndBushingsEqualThoseOfTheTwinWrittenByHand) {
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

}  // namespace
}  // namespace elastocheck
