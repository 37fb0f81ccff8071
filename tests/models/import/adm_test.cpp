// Import of ADAMS datasets: lexical rules, conversion of statements, and hand-calculated statics.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <regex>
#include <utility>

#include "compare/comparison/legs.hpp"
#include "compare/studies/formulations.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "models/import/adm/expression.hpp"
#include "models/import/export/export_adm.hpp"
#include "models/import/import.hpp"
#include "models/kinds.hpp"
#include "models/laws.hpp"
#include "tests/models/import/imports.hpp"

namespace elastocheck {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using importer::Options;
using namespace tests;

// Two parts: a crank on ground, a bushing, a spring and a coupler bar.
const std::string linkage = mistakes("linkage.adm");

// With another statement.
std::string linkage_with(const std::string& statement) {
    return replaced(linkage, "ACCGRAV/", statement + "\nACCGRAV/");
}

// The entries of the scene without comments.
std::string entries(const std::string& yaml) {
    std::string result;
    for (std::size_t at = 0; at < yaml.size();) {
        const std::size_t end = yaml.find('\n', at);
        std::string line = yaml.substr(at, end - at);
        at = end + 1;
        line = line.substr(0, line.find('#'));
        while (line.ends_with(' ')) line.pop_back();
        if (!line.empty()) result += line + "\n";
    }
    return result;
}

// Adds END to a dataset without one.
std::string ended(const std::string& text) {
    return text.find("\nEND") == text.npos && text.find("\rEND") == text.npos ? text + "\nEND\n"
                                                                              : text;
}

std::string scene_of(const std::string& text, const Options& options = {}) {
    return importer::import_text(ended(text), "model.adm", options).yaml;
}

Scene imported_scene(const std::string& text) { return parse_scene(scene_of(text), "scene"); }

std::string refusal(const std::string& text, const Options& options = {},
                    const std::string& file = "model.adm") {
    return refusal_of(ended(text), file, options);
}

std::string everywhere(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

TEST(Adm, DatasetsInDifferentNotationGiveTheSameModel) {
    const std::string expected = entries(scene_of(linkage));
    const std::pair<const char*, std::string> others[] = {
        {"lines end in CRLF", everywhere(linkage, "\n", "\r\n")},
        {"lines end in CR", everywhere(linkage, "\n", "\r")},
        {"cut off words",
         everywhere(everywhere(everywhere(linkage, "REVOLUTE", "rev"), "SPRINGDAMPER", "SPR"),
                    "MARKER/", "mark/")},
        {"small letters",
         replaced(replaced(linkage, ", TRANSLATIONAL", ", translation"), "KGRAV", "kgrav")},
        {"commas at the ends of lines", replaced(linkage, ", I = 4\n, J = 5", ", I = 4,\n, J = 5")},
        {"all on one line", replaced(linkage, "\n, I = 3\n, J = 1", ", I=3,J=1")},
        {"a list over lines", replaced(linkage, "QG = 10, 20, 30", "QG = 10,\n, 20\n, 30")},
        {"a list that begins on its second line",
         replaced(linkage, "QG = 10, 20, 30", "QG = \n, 10, 20, 30")},
        {"the sign of continuation at the end",
         replaced(linkage, "SPRINGDAMPER/1\n, TRANSLATIONAL", "SPRINGDAMPER/1, &\n TRANSLATIONAL")},
        {"leading zeros",
         everywhere(everywhere(linkage, "PART = 1", "PART = 001"), "JOINT/1", "JOINT/0001")},
        {"radians",
         everywhere(linkage, "90D, 90D, 0D", "1.5707963267948966, 1.5707963267948966, 0")},
        {"exponents of old", replaced(linkage, "K = 12.5", "K = 1.25D+01")},
        {"bytes of Latin-1 in comments", linkage_with("! f\xFCr Gewicht")},
        {"comments within a statement",
         replaced(linkage, ", J = 5\n", "! between\n, J = 5   ! behind\n")},
        {"units last", replaced(linkage.substr(0, linkage.find("UNITS")) +
                                    linkage.substr(linkage.find("!    adams_view_name='ground'")),
                                "END\n",
                                linkage.substr(linkage.find("UNITS"),
                                               linkage.find("!    adams") - linkage.find("UNITS")) +
                                    "END\n")},
        {"text after the end", linkage + "nonsense\n"},
    };
    for (const auto& [what, text] : others) EXPECT_EQ(entries(scene_of(text)), expected) << what;
}

// Each quantity is converted by its own unit: the scene is the same for all units of the file.
TEST(Adm, EachUnitIsConvertedByItsOwnFactor) {
    struct Units {
        const char *force, *mass, *length;
        double newton, kilogram, metre;
    };
    const double pound = 0.45359237, g = 9.80665;
    const auto spring_of = [](const Scene& scene) {
        return std::get<AxialSpring>(scene.elastics.at(0).kind);
    };
    for (const Units& u :
         {Units{"NEWTON", "KILOGRAM", "MILLIMETER", 1, 1, 1e-3},
          Units{"KNEWTON", "KILOGRAM", "METER", 1e3, 1, 1},
          Units{"POUND_FORCE", "SLUG", "FOOT", pound * g, pound * g / 0.3048, 0.3048},
          Units{"POUND_FORCE", "POUND_MASS", "INCH", pound * g, pound, 0.0254},
          Units{"DYNE", "GRAM", "CENTIMETER", 1e-5, 1e-3, 1e-2}}) {
        std::string text = replaced(linkage, "NEWTON", u.force);
        text = replaced(replaced(text, "KILOGRAM", u.mass), "MILLIMETER", u.length);
        const Scene scene = imported_scene(text);
        EXPECT_NEAR(std::get<LinearRate>(spring_of(scene).law).k / (12.5 * u.newton / u.metre), 1,
                    1e-11)
            << u.force;
        EXPECT_NEAR(spring_of(scene).free_length / (210 * u.metre), 1, 1e-11) << u.length;
        EXPECT_NEAR(std::get<DeadForce>(scene.static_loads.at(0).kind).f.z() /
                        (-2 * u.kilogram * 9806.65 * u.metre),
                    1, 1e-11)
            << u.mass;
    }
    EXPECT_EQ(
        entries(scene_of(replaced(
            linkage, ", FORCE = NEWTON\n, MASS = KILOGRAM\n, LENGTH = MILLIMETER\n, TIME = SECOND",
            ", SYSTEM = MKS"))),
        entries(scene_of(replaced(linkage, "MILLIMETER", "METER"))));
}

// ZP and XP are points: REULER, two points, and a marker relative to a marker define
// the same frame.
TEST(Adm, FramesAreTheSameByAnglesByPointsAndInAnotherMarker) {
    const std::string bushing = linkage_with(
        "MARKER/6, PART = 2, QP = 1, 2, 3, REULER = 30D, 40D, 50D\n"
        "MARKER/7, PART = 1, QP = 11, 22, 33, REULER = 30D, 40D, 50D\n"
        "BUSHING/9, I = 6, J = 7, K = 1, 2, 3, KT = 4, 5, 6");
    const Matrix3d A = (Eigen::AngleAxisd(std::numbers::pi / 6, Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(std::numbers::pi * 2 / 9, Vector3d::UnitX()) *
                        Eigen::AngleAxisd(std::numbers::pi * 5 / 18, Vector3d::UnitZ()))
                           .toRotationMatrix();
    const Vector3d q(11, 22, 33), z = q + 7 * A.col(2), x = q + 3 * A.col(0) + 2 * A.col(2);
    const auto list = [](const Vector3d& v) {
        return fmt::format("{}, {}, {}", v.x(), v.y(), v.z());
    };
    const std::string at = "QP = 11, 22, 33, REULER = 30D, 40D, 50D";
    const std::string by_points =
        replaced(bushing, at, fmt::format("QP = 11, 22, 33, ZP = {}, XP = {}", list(z), list(x)));
    const std::string use_x =
        replaced(bushing, at,
                 fmt::format("QP = 11, 22, 33, ZP = {}, XP = {}, USEXP",
                             list(q + 7 * A.col(2) + A.col(0)), list(q + 5 * A.col(0))));
    const std::string nested =
        replaced(bushing, at,
                 "QP = 0, 0, 33, REULER = 0, 40D, 50D, RM = 8\nMARKER/8, PART = 1, QP "
                 "= 11, 22, 0, REULER = 30D, 0, 0");
    const auto frame = [](const std::string& text) {
        const Scene scene = imported_scene(text);
        for (const Elastic& elastic : scene.elastics)
            if (const auto* found = std::get_if<Bushing>(&elastic.kind)) return *found;
        throw std::runtime_error("no bushing");
    };
    const Bushing expected = frame(bushing);
    EXPECT_LE((expected.i.A_local.toRotationMatrix() - A).norm(), 1e-11);
    for (const std::string& text : {by_points, use_x}) {
        EXPECT_LE(expected.i.A_local.angularDistance(frame(text).i.A_local), 1e-7);
        EXPECT_LE((expected.undeformed - frame(text).undeformed).norm(), 1e-12);
    }
    // In marker 8, rotated by 30° about z, the offset rotates with it; z does not change.
    EXPECT_LE(expected.i.A_local.angularDistance(frame(nested).i.A_local), 1e-7);
    EXPECT_LE((expected.undeformed - frame(nested).undeformed).norm(), 1e-12);
}

// ---- Error messages.

TEST(Adm, SaysWhatIsWrongAndWhere) {
    expect_refusals("linkage", linkage, "model.adm",
                    [](const std::string& text) { return refusal(text); });
}

// Nothing is dropped silently: an error with its line, or with --allow-missing a note in the head.
TEST(Adm, StatementWithoutASceneElementIsAnErrorOrReportedInTheHead) {
    for (const auto& [line, text, message, is_part] :
         support::mistakes_in(import_folder / "mistakes/missing.mistakes", linkage)) {
        SCOPED_TRACE(line);
        const std::string said = refusal(text);
        EXPECT_TRUE(says(said, "model.adm:41: "));
        EXPECT_TRUE(says(said, message));
        EXPECT_TRUE(says(said, "--allow-missing"));
        const std::string yaml = scene_of(text, {"", false, true});
        EXPECT_TRUE(says(yaml, "# MISSING: line 41"));
        EXPECT_TRUE(says(yaml, "NOT equivalent to the file"));
        EXPECT_EQ(entries(yaml).substr(0, 100), entries(scene_of(linkage)).substr(0, 100));
    }
}

// ---- Expressions.

TEST(Adm, ExpressionsAreSumsOfConstantsDisplacementsAndCurves) {
    using namespace importer::adm;
    Context context;
    context.time = 2;
    const auto constant = [&](const char* text) {
        const Value value = static_value(text, context);
        EXPECT_TRUE(value.is_constant()) << text << ": " << value.unknown;
        return value.constant;
    };
    EXPECT_DOUBLE_EQ(constant("-2**2 + 3*(4-1)/2"), 0.5);
    EXPECT_DOUBLE_EQ(constant("90d * RTOD"), 90);
    EXPECT_DOUBLE_EQ(constant("30.0d * time"), std::numbers::pi / 3);
    EXPECT_DOUBLE_EQ(constant("STEP(TIME, 1, 10, 3, 20)"), 15);
    EXPECT_DOUBLE_EQ(constant("IF(TIME-2: 1, 5, 9) + IF(-1: 1, 5, 9) + IF(1: 1, 5, 9)"), 15);
    EXPECT_DOUBLE_EQ(constant("-0*USER(1, 2) - 7*VR(1, 2) + MAX(1, 3) + SIGN(2, -1)"), 1);
    const Value law = static_value(
        "-3*(DM(1,2) - 10) + 2*(5 - DM(1,2))/4 - AKISPL(2*DX(1,2,2)-1, 0, 7)", context);
    ASSERT_TRUE(law.is_known()) << law.unknown;
    EXPECT_DOUBLE_EQ(law.constant, 32.5);
    EXPECT_DOUBLE_EQ(law.linear.at({Measure::Kind::DM, 1, 2, 0}), -3.5);
    ASSERT_EQ(law.curves.size(), 1u);
    EXPECT_DOUBLE_EQ(law.curves[0].factor, -1);
    EXPECT_DOUBLE_EQ(law.curves[0].scale, 2);
    EXPECT_DOUBLE_EQ(law.curves[0].offset, -1);
    for (const char* text :
         {"", "1 +", "1 2", "(1", "SIN(DX(1,2))", "1/0", "1/DM(1,2)", "DX(1)*DX(2)", "nothing",
          "SQRT(-1)", "DX(1.5)", "IF(DX(1,2): 1, 2, 3)", "IMPACT(1, 2, 3)", "AKISPL(3, 0, 1)",
          "VARVAL(1)"})
        EXPECT_FALSE(static_value(text, context).is_known()) << text;
    EXPECT_FALSE(static_value(std::string(100'000, '('), context).is_known());
    EXPECT_FALSE(static_value(std::string(100'000, '-') + "1", context).linear.size());
}

// ---- Equilibrium at rest.

// A block on a bushing whose markers are a centimetre and 13° apart, under its own preload: at rest
// K δ = FORCE and KT θ = TORQUE, δ and θ of I in the axes of J, independent of the drawn position.
TEST(Adm, BushingRestsWhereItsLawBalancesTheLoadForAnyMarkers) {
    const std::string text = R"(t
UNITS/, FORCE = NEWTON, MASS = KILOGRAM, LENGTH = MILLIMETER, TIME = SECOND
PART/1, GROUND
PART/2, MASS = 1, QG = 5, 6, 7, REULER = 10D, 20D, 30D
MARKER/1, PART = 2, QP = 20, 10, 0, REULER = 24D, 5D, 0
MARKER/2, PART = 1, QP = 30, 20, 15, REULER = 10D, 20D, 66D
BUSHING/1, I = 1, J = 2, K = 1000, 2000, 500, KT = 3E5, 2E5, 1E5, FORCE = 300, -200, 100, TORQUE = 6000, 4000, -2000
)";
    const Scene scene = imported_scene(text);
    const Equilibrium rest = at_rest(scene, compare::Leg::equilibrium);
    // The markers as drawn, moved with the part.
    const Matrix3d A_part = euler(10, 20, 30), A_I = A_part * euler(24, 5, 0),
                   A_J = euler(10, 20, 66);
    const Vector3d I = Vector3d(5, 6, 7) + A_part * Vector3d(20, 10, 0), J(30, 20, 15);
    const Matrix3d turn = rest.poses.at(0).p.toRotationMatrix();
    const Vector3d now =
        1000 * rest.poses.at(0).r + turn * (I - 1000 * scene.bodies.at(0).design.r);
    const Vector3d delta = A_J.transpose() * (now - J);
    EXPECT_LE((delta - Vector3d(0.3, -0.1, 0.2)).norm(), 1e-6) << delta;
    const Matrix3d B = A_J.transpose() * turn * A_I;
    EXPECT_NEAR(std::atan2(-B(1, 2), B(2, 2)), 0.02, 1e-9);
    EXPECT_NEAR(std::atan2(B(0, 2), B(2, 2)), 0.02, 1e-9);
    EXPECT_NEAR(std::atan2(B(1, 0), B(0, 0)), -0.02, 1e-9);
}

// Joint samples, with gravity in the direction in which the part hangs straight as drawn: the
// reaction carries its weight.
TEST(Adm, JointsOfTheSamplesCarryTheWeightAtRest) {
    const double weight = 9.80665;  // of 1 kg
    for (const auto& [file, axis, g] :
         {std::tuple{"Revolute_Case01", "IGRAV", Vector3d(weight, 0, 0)},
          {"Spherical_Case01", "IGRAV", Vector3d(weight, 0, 0)},
          {"Universal_Case01", "JGRAV", Vector3d(0, weight, 0)},
          {"Distance_Case01", "JGRAV", Vector3d(0, weight, 0)},
          {"Prismatic_Case01", "IGRAV", Vector3d(weight, 0, 0)},
          {"Cylindrical_Case01", "IGRAV", Vector3d(weight, 0, 0)}}) {
        const std::string text = replaced(sample(fmt::format("chrono_{}.adm", file)),
                                          "KGRAV = -9.80665", fmt::format("{} = {}", axis, weight));
        const Scene scene = imported_scene(text);
        const Model model = compile(scene);
        ASSERT_EQ(model.joints.size(), 1u) << file;
        const Equilibrium rest = at_rest(scene, compare::Leg::equilibrium);
        const double on_part = model.joints[0].i == ground ? -1 : 1;
        EXPECT_LE((on_part * rest.reactions.at(0).force + g).norm(), 1e-8)
            << file << ": " << rest.reactions.at(0).force;
    }
}

// Pendulum on a torsion spring: 2 m g cos φ = k φ.
TEST(Adm, PendulumOnATorsionSpringRestsAtItsEquilibriumAngle) {
    const Scene scene = imported_scene(sample("chrono_RotSpring_Case01.adm"));
    const double k = 180 / std::numbers::pi, m_g = 9.80665;
    double phi = 0.3;
    for (int n = 0; n < 50; ++n)
        phi -= (2 * m_g * std::cos(phi) - k * phi) / (-2 * m_g * std::sin(phi) - k);
    const Equilibrium rest = at_rest(scene, compare::Leg::equilibrium);
    EXPECT_NEAR(rest.poses.at(0).r.x(), 2 * std::cos(phi), 1e-9);
    EXPECT_NEAR(rest.poses.at(0).r.z(), -2 * std::sin(phi), 1e-9);
}

// A vector force of displacements equals a bushing with the same numbers, and so does
// a diagonal FIELD.
TEST(Adm, AVectorForceOfDisplacementsIsABushing) {
    const std::string base = R"(t
UNITS/, FORCE = NEWTON, MASS = KILOGRAM, LENGTH = METER, TIME = SECOND
PART/1, GROUND
PART/2, MASS = 1
MARKER/1, PART = 2, QP = 0.1, 0.2, 0.3
MARKER/2, PART = 1, QP = 0.1, 0.2, 0.25
MARKER/3, PART = 1, FLOATING
)";
    const auto bushing_of = [&](const std::string& statement) {
        return std::get<Bushing>(imported_scene(base + statement).elastics.at(0).kind);
    };
    const Bushing expected =
        bushing_of("BUSHING/1, I=1, J=2, K=10,20,30, KT=4,5,6, FORCE=1,2,3, TORQUE=0,0,7\n");
    for (const char* statement : {"GFORCE/1, I=1, JFLOAT=3, RM=2\n, FX = 1-10*DX(1,2,2)\\\n, FY = "
                                  "2-20*DY(1,2,2) - 3*VY(1,2,2)\\\n, "
                                  "FZ = 3 - 15*DZ(1,2,2)\n, -15*DZ(1,2,2)\\\n"
                                  ", TX = -4*AX(1,2)\\ TY = -5*AY(1,2)\\ TZ = 7-6*AZ(1,2)\n",
                                  "FIELD/1, I=1, J=2, FORCE=1,2,3,0,0,7, KMATRIX=10,0,0,0,0,0\n, "
                                  "0,20,0,0,0,0, 0,0,30,0,0,0, "
                                  "0,0,0,4,0,0\n, 0,0,0,0,5,0,0,0,0,0,0,6\n"}) {
        const Bushing found = bushing_of(statement);
        EXPECT_EQ(std::get<LinearStiffness>(found.law).K, std::get<LinearStiffness>(expected.law).K)
            << statement;
        EXPECT_EQ(found.preload, expected.preload) << statement;
        EXPECT_LE((found.undeformed - expected.undeformed).norm(), 1e-15) << statement;
        EXPECT_EQ(found.formulation, expected.formulation);
    }
}

// The end of a straight BEAM deflects by F L³/3EI + F L/(G A/s) and rotates by F L²/2EI
// in each plane.
TEST(Adm, BeamHasTheDeflectionOfTimoshenkosTheory) {
    const std::string text = R"(t
UNITS/, FORCE = NEWTON, MASS = KILOGRAM, LENGTH = METER, TIME = SECOND
PART/1, GROUND
PART/2, MASS = 0.01, CM = 1
MARKER/1, PART = 2, QP = 2, 0, 0
MARKER/2, PART = 1
BEAM/1, I=1, J=2, LENGTH=2, AREA=1E-3, IXX=3E-8, IYY=4E-7, IZZ=5E-7, EMODULUS=2E11, GMODULUS=8E10, ASY=1.2, ASZ=1.5
ACCGRAV/, KGRAV = -10
)";
    struct Plane {
        const char* gravity;
        int down, about;
        double I, shear, turn;  // of the end, positive about the axis, where it goes down
    };
    for (const auto& [gravity, down, about, I, shear, turn] :
         {Plane{"KGRAV", 2, 1, 4e-7, 1.5, +1}, Plane{"JGRAV", 1, 2, 5e-7, 1.2, -1}}) {
        const Scene scene = imported_scene(replaced(text, "KGRAV", gravity));
        const Pose end = at_rest(scene, compare::Leg::equilibrium).poses.at(0);
        EXPECT_NEAR(end.r[down] / (-0.1 * (8 / (3 * 2e11 * I) + 2 * shear / (8e10 * 1e-3))), 1,
                    1e-6);
        EXPECT_NEAR(2 * end.p.vec()[about] / (turn * 0.1 * 4 / (2 * 2e11 * I)), 1, 1e-5) << gravity;
    }
}

// A spline over a penetration is a stop. A contact that pulls and a spline that does not begin at
// (0, 0) are errors.
TEST(Adm, ASplineOfAPenetrationIsAStopWithACurve) {
    const auto with = [](const std::string& function, const std::string& points) {
        return linkage_with("SPLINE/4, X = " + points +
                            "\nSFORCE/7, TRANS, I = 4, J = 5, FUNCTION = " + function);
    };
    const std::string rows = "0, 10, 20, Y = 0, 500, 2000";
    const Scene scene = imported_scene(with("2 * AKISPL(DIM(180, DM(4,5)), 0, 4)", rows));
    const auto& stop = std::get<AxialSpring>(scene.elastics.at(1).kind);
    EXPECT_NEAR(force(stop.law, 0.170 - stop.free_length), -1000, 1e-9);
    EXPECT_EQ(force(stop.law, 0.181 - stop.free_length), 0);
    EXPECT_FALSE(std::get<Curve>(stop.law).known_outside);
    EXPECT_TRUE(says(refusal(with("-AKISPL(DIM(180, DM(4,5)), 0, 4)", rows)),
                     "a contact with a tensile force"));
    EXPECT_TRUE(
        says(refusal(with("AKISPL(DIM(180, DM(4,5)), 0, 4)", "1, 10, 20, Y = 0, 500, 2000")),
             "SPLINE/4 of a penetration does not begin at 0, 0"));
    // DIM without a spline is a contact of rate 1.
    const Scene ramp = imported_scene(with("3 * DIM(180, DM(4,5))", rows));
    const auto& contact = std::get<AxialSpring>(ramp.elastics.at(1).kind);
    EXPECT_NEAR(force(contact.law, 0.170 - contact.free_length), -30, 1e-9);
}

TEST(Adm, SplineBecomesACurveAndItsDistanceFromAkimasSplineIsReported) {
    const std::string text = linkage_with(
        "SPLINE/4, X = -20, -10, 0, 10, 20, Y = -900, -300, 0, 100, 150\n"
        "SFORCE/7, TRANS, I = 4, J = 5, FUNCTION = -AKISPL(DM(4,5) - 195, 0, 4)");
    const std::string yaml = scene_of(text);
    const std::string notes = notes_of(importer::import_text(text, "model.adm", {}));
    for (const char* part : {" N (of 900), at ", "SPLINE/4 the file has Akima's curve"})
        EXPECT_TRUE(says(notes, part));
    const Scene scene = parse_scene(yaml, "scene");
    const auto& spring = std::get<AxialSpring>(scene.elastics.at(1).kind);
    const auto& curve = std::get<Curve>(spring.law);
    EXPECT_FALSE(curve.known_outside);
    EXPECT_NEAR(spring.free_length + curve.knots.at(3), 0.205, 1e-12);  // 10 mm longer than 195 mm
    EXPECT_NEAR(curve.pieces.at(4)[0], 100, 1e-9);
}

// IMPACT with exponent 1 is a bump stop, BISTOP a stop in each direction.
TEST(Adm, AContactAlongALineIsAStop) {
    const std::string text = linkage_with(
        "SFORCE/7, TRANS, I = 4, J = 5\n"
        ", FUNCTION = BISTOP(DM(4,5), VR(4,5), 180, 230, 1000, 1, 5, 0.1)");
    const Scene scene = imported_scene(text);
    ASSERT_EQ(scene.elastics.size(), 3u);
    const auto stop = [&](std::size_t k) {
        return std::get<AxialSpring>(scene.elastics.at(k).kind);
    };
    const auto touches = [&](std::size_t k) {
        return stop(k).free_length + std::get<Curve>(stop(k).law).knots.at(0);
    };
    EXPECT_NEAR(touches(1), 0.180, 1e-12);
    EXPECT_NEAR(touches(2), 0.230, 1e-12);
    EXPECT_NEAR(std::get<Curve>(stop(1).law).pieces.front()[1], 1e6, 1e-3);
    EXPECT_NEAR(std::get<Curve>(stop(2).law).pieces.back()[1], 1e6, 1e-3);
}

// A MOTION rotates a crank by 30° in a second; a COUPLER rotates another by half as much in the
// other direction.
TEST(Adm, AMotionDrivesAndACouplerDrivesInProportion) {
    const Scene generic = imported_scene(sample("adamspy_generic_model.adm"));
    ASSERT_EQ(generic.branches.size(), 1u);
    EXPECT_EQ(generic.branches[0].unit, ParameterUnit::radian);
    EXPECT_NEAR(generic.branches[0].to, std::numbers::pi / 6, 1e-12);
    const std::string text = linkage_with(
        "PART/3, MASS = 1\nMARKER/6, PART = 3\nMARKER/7, PART = 1\nJOINT/2, REV, I = 6, J = 7\n"
        "MOTION/1, ROT, JOINT = 1, FUNCTION = 30D*TIME\n"
        "COUPLER/1, JOINTS = 1, 2, TYPE = R:R, SCALES = 1, 2");
    const Scene coupled = imported_scene(text);
    const auto& drivers = coupled.branches.at(0).drivers;
    ASSERT_EQ(drivers.size(), 2u);
    EXPECT_NEAR(drivers[1].rate / drivers[0].rate, -0.5, 1e-12);
}

// ---- Unused arguments and truncated files.

// Each argument and flag of every statement with an effect in statics, misspelt in its first
// letter, is an error: a word in capitals, followed by "=", "," or the end of the line.
TEST(Adm, MisspeltArgumentIsReported) {
    const std::regex statement("^([A-Z_]+)/"), word("(^|[ ,])([A-Z_]+)(?=[ \t\r]*(=|,|$))"),
        without_effect("REQUEST|OUTPUT|GRAPHICS|RESULTS|INTEGRATOR|PREFERENCES|VARIABLE|END");
    int changed = 0;
    for (const auto& entry : std::filesystem::directory_iterator(import_folder / "samples")) {
        const std::string name = entry.path().filename().string(), text = sample(name);
        if (entry.path().extension() != ".adm" || !refusal(text).empty()) continue;
        std::string keyword;
        for (std::size_t at = text.find('\n') + 1, end = 0; at < text.size(); at = end + 1) {
            end = std::min(text.find('\n', at), text.size());
            const std::string line = text.substr(at, end - at);
            std::smatch found;
            if (std::regex_search(line, found, statement)) keyword = found[1];
            if (line.starts_with('!') || std::regex_match(keyword, without_effect)) continue;
            for (std::sregex_iterator k(line.begin(), line.end(), word), none; k != none; ++k) {
                const auto first = static_cast<std::size_t>(k->position(2));
                if (line.find('=') < first) continue;  // a value
                std::string other = text;
                other[at + first] = line[first] == 'Q' ? 'K' : 'Q';
                ++changed;
                EXPECT_NE(refusal(other), "") << name << ": " << line;
            }
        }
    }
    EXPECT_GT(changed, 200);
}

TEST(Adm, ADatasetThatWasCutOffIsRefused) {
    const std::string whole = sample("chrono_RotSpring_Case01.adm");
    EXPECT_EQ(refusal(whole), "");
    for (const double share : {0.5, 0.7, 0.9, 0.99}) {
        const auto length = static_cast<std::size_t>(share * whole.rfind("END"));
        EXPECT_NE(refusal_of(whole.substr(0, length), "model.adm"), "") << share;
    }
}

// ---- Functions of TIME: a branch over their whole range.

TEST(Adm, AProgrammeInTimeCoversItsWholeRange) {
    const double deg = std::numbers::pi / 180;
    const std::tuple<const char*, double, double> cases[] = {
        {"STEP(TIME,0,0,1,40D)+STEP(TIME,1,0,2,-70D)+STEP(TIME,2,0,3,30D)", -30, 40},  // and back
        {"STEP(TIME,0,0D,1,40D)+STEP(TIME,1,0D,2,-30D)", 0, 40},
        {"10D*SIN(2*PI*TIME)", -10, 10},
        {"-10D*SIN(1.3*TIME*5)", -10, 10},
        {"STEP(TIME,0.1,0D,0.1001,20D)+STEP(TIME,0.1001,0D,0.1002,-20D)+STEP(TIME,1,0,2,1D)", 0,
         20},  // a spike
        {"IF(TIME-0.3: 0, 0, IF(TIME-0.3001: 12D, 0, 0))+STEP(TIME,1,0,2,-3D)", -3, 12},
        {"30D*TIME", 0, 30},
        {"-30D*TIME", -30, 0},
    };
    for (const auto& [function, from, to] : cases) {
        const Scene scene = imported_scene(
            replaced(linkage, "ACCGRAV/",
                     fmt::format("MOTION/1, ROT, JOINT = 1, FUNCTION = {}\nACCGRAV/", function)));
        ASSERT_EQ(scene.branches.size(), 1u) << function;
        const Branch& branch = scene.branches[0];
        EXPECT_EQ(branch.name, "motion");
        EXPECT_NEAR(std::min({branch.from, branch.to, 0.0}) / deg, from, 1e-6) << function;
        EXPECT_NEAR(std::max({branch.from, branch.to, 0.0}) / deg, to, 1e-6) << function;
    }
}

TEST(Adm, MotionsThatDoNotGoInProportionHaveABranchEach) {
    const std::string two =
        "PART/3, MASS = 1\nMARKER/6, PART = 3\nMARKER/7, PART = 1\nJOINT/2, REV, I = 6, J = 7\n"
        "MOTION/1, ROT, JOINT = 1, FUNCTION = STEP(TIME,0,0D,1,10D)\nMOTION/2, ROT, JOINT = 2, "
        "FUNCTION = ";
    const auto scene = [&](const char* second) {
        return imported_scene(linkage_with(two + second));
    };
    const Scene together = scene("-2*STEP(TIME,0,0D,1,10D)"), apart = scene("10D*TIME");
    ASSERT_EQ(together.branches.size(), 1u);
    ASSERT_EQ(together.branches[0].drivers.size(), 2u);
    EXPECT_NEAR(together.branches[0].drivers[1].rate / together.branches[0].drivers[0].rate, -2,
                1e-9);
    ASSERT_EQ(apart.branches.size(), 2u);
    EXPECT_EQ(apart.branches[1].name, "motion_2");
}

// ---- Export and re-import.

TEST(Adm, ExportedAndImportedAgainHasTheSameEquilibrium) {
    const std::string with_all = R"(t
UNITS/, FORCE = NEWTON, MASS = KILOGRAM, LENGTH = MILLIMETER, TIME = SECOND
PART/1, GROUND
PART/2, MASS = 3, CM = 1, QG = 100, 200, 300, REULER = 10D, 20D, 30D
MARKER/1, PART = 2, QP = 1, 2, 3
MARKER/2, PART = 2, QP = 50, 0, 0, REULER = 5D, 6D, 7D
MARKER/3, PART = 1, QP = 150, 205, 300, REULER = 15D, 16D, 17D
BUSHING/1, I=2, J=3, K=100,200,300, KT=1E5,2E5,3E5, FORCE=5,6,7, TORQUE=800,900,1000
PART/3, MASS = 2, CM = 4
MARKER/4, PART = 3, QP = 200, 250, 300
MARKER/5, PART = 2, QP = 90, 10, 0
JOINT/1, SPHERICAL, I = 6, J = 7
MARKER/6, PART = 3, QP = 160, 210, 310
MARKER/7, PART = 2, QP = @
FIELD/1, I=4, J=8, KMATRIX = 300,20,0,0,0,0, 20,400,0,0,0,0, 0,0,500,0,0,0, 0,0,0,1E6,0,1E5, 0,0,0,0,2E6,0, 0,0,0,1E5,0,3E6
, LENGTH = 1, 2, 3, 0.05, 0, 0.02, FORCE = 10, 0, 0, 0, 0, 500
MARKER/8, PART = 1, QP = 201, 251, 301
SPRINGDAMPER/1, TRANS, I = 4, J = 3, K = 4, LENGTH = 90
ACCGRAV/, KGRAV = -9806.65
)";
    // Position of the ball on the rotated part.
    const Vector3d ball =
        euler(10, 20, 30).transpose() * (Vector3d(160, 210, 310) - Vector3d(100, 200, 300));
    const std::string met =
        replaced(with_all, "@", fmt::format("{}, {}, {}", ball.x(), ball.y(), ball.z()));
    const Scene first = imported_scene(met);
    const importer::Exported exported = importer::export_adm(first, false);
    const Scene second = imported_scene(exported.text);
    const Equilibrium a = at_rest(first, compare::Leg::equilibrium),
                      b = at_rest(second, compare::Leg::equilibrium);
    ASSERT_EQ(a.poses.size(), 2u);
    ASSERT_EQ(b.poses.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_LE((a.poses[k].r - b.poses[k].r).norm(), 1e-9);
        EXPECT_LE(a.poses[k].p.angularDistance(b.poses[k].p),
                  1e-7);  // of an arc cosine near 1: half the digits
    }
    // The part has moved, so the agreement is significant.
    EXPECT_GT((a.poses[0].r - first.bodies[0].design.r).norm(), 1e-4);

    // weights are masses and gravity, no forces
    EXPECT_TRUE(says(exported.text, "ACCGRAV/\n, IGRAV = 0\n, JGRAV = 0\n, KGRAV = -9.8066"));
    EXPECT_EQ(exported.text.find("GFORCE"), exported.text.npos);
    ASSERT_EQ(first.static_loads.size(), 2u);
    ASSERT_EQ(second.static_loads.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(second.static_loads[k].name, first.static_loads[k].name);
        EXPECT_LE(
            (load_vector(second.static_loads[k].kind) - load_vector(first.static_loads[k].kind))
                .norm(),
            1e-9);
    }
    EXPECT_EQ(exported.text.find("MASS = 0"), exported.text.npos);
}

TEST(Adm, SceneElementWithoutADatasetStatementIsRefusedOnExport) {
    const Scene scene = read_scene(std::filesystem::path(ELASTOCHECK_SCENES) / "mcpherson.yaml");
    EXPECT_THROW(importer::export_adm(scene, false), SceneError);
    const importer::Exported exported = importer::export_adm(scene, true);
    EXPECT_TRUE(says(exported.text, "MISSING: element"));
}

// Sum of the forces of the springs and stops whose names begin with `name`, at a length [m].
double force_between(const Scene& scene, const std::string& name, double length) {
    double sum = 0;
    for (const Elastic& elastic : scene.elastics)
        if (const auto* spring = std::get_if<AxialSpring>(&elastic.kind);
            spring != nullptr && (elastic.name == name || elastic.name.starts_with(name + ".")))
            sum += force(spring->law, length - spring->free_length);
    return sum;
}

TEST(Adm, SpringsAndStopsOfAnyLawAreExportedAndImportedAgainWithTheSameForces) {
    const auto scene_with = [](const std::string& fields) {
        return parse_scene(R"(elastocheck: 1
name: stops
units: {length: mm, angle: deg, force: N}
points: {o: [0, 0, 0], p: [50, 0, 0], t: [50, 0, 400]}
bodies: {arm: {origin: o}}
joints: {hinge: {type: revolute, bodies: [arm, ground], at: o, axis: y}}
springs: {coil: {bodies: [arm, ground], from: p, to: t, rate: 30, )" +
                               fields +
                               R"(}}
loads: {push: {on: arm, at: p, force: [0, 0, 1]}}
branches: {up: {load: push, to: 10, steps: 1}}
probes: {tip: {on: arm, at: p}}
)",
                           "scene");
    };
    const std::string table =
        "curve: {table: [[0, 0], [10, 250], [20, 800], [30, 2000], [45, 5000]]";
    for (const std::string& fields : std::vector<std::string>{
             "bump_stop: {clearance: 45, " + table + "}}",
             "rebound_stop: {clearance: 45, " + table + "}}",
             "bump_stop: {clearance: 20, rate: 300}, rebound_stop: {clearance: 30, " + table +
                 ", outside: unknown}}",
             "bump_stop: {clearance: -5, " + table +
                 ", outside: unknown}}, rebound_stop: {clearance: 30, rate: 70}"}) {
        const Scene first = scene_with(fields);
        const importer::Exported exported = importer::export_adm(first, false);
        const Scene second = imported_scene(exported.text);
        for (double length = 0.25; length < 0.55; length += 0.0037) {
            const double f = force_between(first, "coil", length);
            EXPECT_NEAR(force_between(second, "coil", length), f, 1e-9 * (1000 + std::abs(f)))
                << fields << " at " << length << " m\n"
                << exported.text;
        }
        EXPECT_NE(force_between(first, "coil", 0.25), force_between(first, "coil", 0.50));
    }
}

TEST(Adm, ATorsionSpringWithACurveIsExportedAndImportedAgainAsItWas) {
    const Scene first = imported_scene(linkage_with(
        "SPLINE/4, LINEAR_EXTRAPOLATE, X = -1, -0.5, 0, 0.5, 1, Y = -900, -300, 0, 100, 150\n"
        "SFORCE/7, ROT, I = 3, J = 1, FUNCTION = 25 - AKISPL(AZ(3,1), 0, 4)"));
    const Scene second = imported_scene(importer::export_adm(first, false).text);
    const auto torsion = [](const Scene& scene) {
        const auto found =
            std::ranges::find(scene.elastics, WrittenAs::torsion_spring, &Elastic::written_as);
        EXPECT_NE(found, scene.elastics.end());
        return std::get<Bushing>(found->kind);
    };
    const Bushing a = torsion(first), b = torsion(second);
    for (double angle = -1.5; angle < 1.5; angle += 0.03) {
        const auto moment = [&](const Bushing& spring) {
            return spring.preload[5] + force(std::get<PerAxis>(spring.law).axis[5], angle);
        };
        EXPECT_NEAR(moment(b), moment(a), 1e-12) << angle;
    }
}

// All built-in scenes, with their bushings converted to ADAMS' formulation. A bushing with its
// frame on j is exported with its markers swapped.
TEST(Adm, EveryBuiltInSceneIsExportedAndImportedAgainWithTheElementsItHad) {
    int scenes = 0, bushings = 0;
    for (const auto& file : std::filesystem::directory_iterator(ELASTOCHECK_SCENES)) {
        if (file.path().extension() != ".yaml") continue;
        SCOPED_TRACE(file.path().filename());
        ++scenes;
        const Scene first = compare::converted(compare::trim(read_scene(file.path())).scene,
                                               importer::adams_bushing)
                                .scene;
        const Scene second = imported_scene(importer::export_adm(first, false).text);
        for (const Hardpoint& point : second.hardpoints) {
            std::vector<std::string> names;
            for (const Hardpoint& of_first : first.hardpoints)
                if ((of_first.position - point.position).norm() < 1e-9)
                    names.push_back(of_first.name);
            EXPECT_TRUE(names.empty() || std::ranges::find(names, point.name) != names.end())
                << point.name << " was " << fmt::format("{}", fmt::join(names, ", "));
        }
        for (const Elastic& elastic : first.elastics) {
            if (elastic.active_only_where_driven) continue;
            if (const auto* spring = std::get_if<AxialSpring>(&elastic.kind)) {
                for (double x = -0.1; x <= 0.1; x += 0.01) {
                    const double length = spring->free_length + x,
                                 f = force_between(first, elastic.name, length);
                    // Lengths are imported with twelve digits.
                    const double largest =
                        std::abs(force_between(first, elastic.name, spring->free_length - 0.1));
                    EXPECT_NEAR(force_between(second, elastic.name, length), f,
                                1e-9 * (1 + largest))
                        << elastic.name << " " << x;
                }
                continue;
            }
            const auto same = std::ranges::find(second.elastics, elastic.name, &Elastic::name);
            ASSERT_NE(same, second.elastics.end()) << elastic.name;
            const auto &a = std::get<Bushing>(elastic.kind), &b = std::get<Bushing>(same->kind);
            const auto *K = std::get_if<LinearStiffness>(&a.law),
                       *L = std::get_if<LinearStiffness>(&b.law);
            if (elastic.written_as == WrittenAs::torsion_spring || K == nullptr) continue;
            ASSERT_NE(L, nullptr) << elastic.name;
            EXPECT_LE((K->K - L->K).norm(), 1e-9 * K->K.norm()) << elastic.name;
            EXPECT_LE((a.preload - b.preload).norm(), 1e-9 * (1 + a.preload.norm()))
                << elastic.name;
            ++bushings;
        }
    }
    EXPECT_GT(scenes, 20);
    EXPECT_GT(bushings, 50);
    Scene turned = read_scene(std::filesystem::path(ELASTOCHECK_SCENES) / "single_bushing.yaml");
    auto& mount = std::get<Bushing>(turned.elastics.at(0).kind);
    mount.formulation = importer::adams_bushing;
    mount.formulation.frame = Formulation::Frame::on_j;
    EXPECT_NO_THROW(importer::export_adm(turned, false));
}

}  // namespace
}  // namespace elastocheck
