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
#include "tests/support/scene_text.hpp"

namespace elastocheck {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using importer::Options;
using namespace tests;
using namespace std::string_literals;

// Two parts: a crank on ground, a bushing, a spring and a coupler bar.
const std::string linkage = mistakes("linkage.adm");

std::string scene_of(const std::string& text, const Options& options = {}) {
    return importer::import_text(text, "model.adm", options).yaml;
}
Scene imported_scene(const std::string& text) { return parse_scene(scene_of(text), "scene"); }
Scene imported_fixture(const std::string& name, const std::string& from = "",
                       const std::string& to = "") {
    const std::string text = support::text_of(import_folder / "fixtures" / (name + ".adm"));
    return imported_scene(from.empty() ? text : replaced(text, from, to));
}

// ---- Error messages.

TEST(Adm, RefusalOfAnInvalidDatasetHasLineAndReason) {
    expect_refusals("linkage", linkage, "model.adm",
                    [](const std::string& text) { return refusal_of(text, "model.adm"); });
}

// Nothing is dropped silently: an error with its line, or with --allow-missing a note in the head.
TEST(Adm, StatementWithoutASceneElementIsAnErrorOrReportedInTheHead) {
    for (const auto& [line, text, message, is_part] :
         support::mistakes_in(import_folder / "mistakes/missing.mistakes", linkage)) {
        SCOPED_TRACE(line);
        const std::string said = refusal_of(text, "model.adm");
        for (const std::string& part : {std::string("model.adm:41: "), message, "--allow-missing"s})
            EXPECT_TRUE(has_text(said, part));
        const std::string yaml = scene_of(text, {.allow_missing = true});
        for (const char* part :
             {"# MISSING: line 41", "NOT equivalent to the file", "\n  crank: {"})
            EXPECT_TRUE(has_text(yaml, part));
    }
}

// ---- Expressions.

TEST(Adm, ExpressionIsReadAsASumOfAConstantDisplacementsAndCurves) {
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

// A block on a preloaded bushing whose markers are a centimetre and 13° apart: at rest
// K δ = FORCE and KT θ = TORQUE, δ and θ of I in the axes of J, independent of the drawn position.
TEST(Adm, BushingRestsWhereItsLawBalancesTheLoadForAnyMarkers) {
    const Scene scene = imported_fixture("bushing_at_rest");
    const Equilibrium rest = at_rest(scene);
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
        const Equilibrium rest = at_rest(scene);
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
    const Equilibrium rest = at_rest(scene);
    EXPECT_NEAR(rest.poses.at(0).r.x(), 2 * std::cos(phi), 1e-9);
    EXPECT_NEAR(rest.poses.at(0).r.z(), -2 * std::sin(phi), 1e-9);
}

// The end of a straight BEAM deflects by F L³/3EI + F L/(G A/s) and rotates by F L²/2EI
// in each plane.
TEST(Adm, BeamHasTheDeflectionOfTimoshenkosTheory) {
    struct Plane {
        const char* gravity;
        int down, about;
        double I, shear, turn;  // of the end, positive about the axis, where it goes down
    };
    for (const auto& [gravity, down, about, I, shear, turn] :
         {Plane{"KGRAV", 2, 1, 4e-7, 1.5, +1}, Plane{"JGRAV", 1, 2, 5e-7, 1.2, -1}}) {
        const Scene scene = imported_fixture("beam", "KGRAV", gravity);
        const Pose end = at_rest(scene).poses.at(0);
        EXPECT_NEAR(end.r[down] / (-0.1 * (8 / (3 * 2e11 * I) + 2 * shear / (8e10 * 1e-3))), 1,
                    1e-6);
        EXPECT_NEAR(2 * end.p.vec()[about] / (turn * 0.1 * 4 / (2 * 2e11 * I)), 1, 1e-5) << gravity;
    }
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
        if (entry.path().extension() != ".adm" || !refusal_of(text, "model.adm").empty()) continue;
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
                EXPECT_NE(refusal_of(other, "model.adm"), "") << name << ": " << line;
            }
        }
    }
    EXPECT_GT(changed, 200);
}

// ---- Functions of TIME: a branch over their whole range.

// ---- Export and re-import.

TEST(Adm, SceneExportedAndImportedAgainHasTheSameEquilibrium) {
    const Scene first = imported_fixture("two_parts");
    const importer::Exported exported = importer::export_adm(first, false);
    const Scene second = imported_scene(exported.text);
    const Equilibrium a = at_rest(first), b = at_rest(second);
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
    EXPECT_TRUE(has_text(exported.text, "ACCGRAV/\n, IGRAV = 0\n, JGRAV = 0\n, KGRAV = -9.8066"));
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
    EXPECT_TRUE(has_text(importer::export_adm(scene, true).text, "MISSING: element"));
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
    const std::string arm = support::scene_text("models/fixtures/laws");
    const std::string table =
        "curve: {table: [[0, 0], [10, 250], [20, 800], [30, 2000], [45, 5000]]";
    for (const std::string& fields : std::vector<std::string>{
             "bump_stop: {clearance: 45, " + table + "}}",
             "rebound_stop: {clearance: 45, " + table + "}}",
             "bump_stop: {clearance: 20, rate: 300}, rebound_stop: {clearance: 30, " + table +
                 ", outside: unknown}}",
             "bump_stop: {clearance: -5, " + table +
                 ", outside: unknown}}, rebound_stop: {clearance: 30, rate: 70}"}) {
        const Scene first = parse_scene(
            replaced(arm, "# elements",
                     "springs: {coil: {bodies: [arm, ground], from: p, to: t, rate: 30, " + fields +
                         "}}"),
            "scene");
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
    const Scene first = imported_scene(replaced(
        linkage, "ACCGRAV/",
        "SPLINE/4, LINEAR_EXTRAPOLATE, X = -1, -0.5, 0, 0.5, 1, Y = -900, -300, 0, 100, 150\n"
        "SFORCE/7, ROT, I = 3, J = 1, FUNCTION = 25 - AKISPL(AZ(3,1), 0, 4)\nACCGRAV/"));
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
