// Import of Chrono::Vehicle suspensions and Adams/Car property files.
// For all formats also the recorded outcomes of the samples, and fuzz tests with damaged samples.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <regex>

#include "compare/comparison/legs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/import/export/export_chrono.hpp"
#include "models/import/import.hpp"
#include "models/laws.hpp"
#include "tests/models/import/imports.hpp"
#include "tests/support/pipe.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using importer::Options;
using namespace tests;

const fs::path folder = import_folder;

std::string chrono_scene(const std::string& text) {
    return importer::import_text(text, "model.json", {}).yaml;
}

Scene chrono(const std::string& text) { return parse_scene(chrono_scene(text), "scene"); }

std::string head_of(const std::string& text) {
    return notes_of(importer::import_text(text, "model.json", {}));
}

// ---- Chrono

// The published hardpoints are also in a built-in scene, written by hand.
TEST(Chrono, TheMacPhersonStrutIsWhereItsHardpointsAre) {
    const Scene scene = chrono(sample("generic__MacPhersonStrut.json"));
    ASSERT_EQ(scene.wheels.size(), 2u);
    EXPECT_LE((scene.bodies.at(static_cast<std::size_t>(scene.wheels[0].body)).design.r -
               Vector3d(-0.04000403, 1.09999965, -0.02602507))
                  .norm(),
              1e-12);
    EXPECT_EQ(scene.wheels[0].side, 1);
    EXPECT_EQ(scene.wheels[1].side, -1);
    const auto& spring = std::get<AxialSpring>(scene.elastics.at(0).kind);
    EXPECT_EQ(std::get<LinearRate>(spring.law).k, 369149);
    EXPECT_EQ(spring.free_length, 0.306);
}

// Toe and camber rotate the spindle with the sign convention of the outputs: positive
// toe-in, top out.
TEST(Chrono, ToeAndCamberAreThoseOfTheWheel) {
    std::string text = sample("generic__DoubleWishbone.json");
    text = replaced(
        replaced(text, "\"Toe Angle (deg)\":                  0", "\"Toe Angle (deg)\": 0.5"),
        "\"Camber Angle (deg)\":               0", "\"Camber Angle (deg)\": -1");
    const Scene scene = chrono(text);
    const Vector3d e = scene.wheels.at(0).spin_axis_local, f = scene.wheels.at(1).spin_axis_local;
    EXPECT_NEAR(std::atan2(e.x(), e.y()) * 180 / M_PI, 0.5, 1e-9);
    EXPECT_NEAR(-std::asin(e.z()) * 180 / M_PI, -1, 1e-4);
    EXPECT_LE((Vector3d(f.x(), -f.y(), f.z()) - e).norm(), 1e-12);
}

// All legs agree over ±60 mm of travel within the uncertainty of the references; the command covers
// the other samples.
TEST(Chrono, TheLegsAgreeOverTheTravelOfASample) {
    for (const char* file : {"generic__DoubleWishbone.json", "generic__ThreeLinkIRS.json"}) {
        const Scene scene = chrono(sample(file));
        const Model model = compile(scene);
        const auto ways = compare::sides_of(model, model.branches.front(), 6);
        const auto a = compare::solve_branch(ways, {.leg = compare::Leg::equilibrium}),
                   b = compare::solve_branch(ways, {.leg = compare::Leg::series});
        ASSERT_EQ(a.outcome, Outcome::converged) << file << a.detail;
        ASSERT_EQ(b.outcome, Outcome::converged) << file << b.detail;
        ASSERT_EQ(a.points.size(), b.points.size());
        EXPECT_NEAR(a.points.front().load, -0.06, 1e-12);
        EXPECT_NEAR(a.points.back().load, 0.06, 1e-12);
        for (std::size_t n = 0; n < a.points.size(); ++n)
            for (std::size_t k = 0; k < a.points[n].poses.size(); ++k)
                EXPECT_LE((a.points[n].poses[k].r - b.points[n].poses[k].r).norm(), 1e-9) << file;
    }
}

// A bushing in place of a revolute is free about its axis; other bushings have K_rot; the
// force is isotropic.
TEST(Chrono, BushingsStandWhereChronoPutsThem) {
    const std::string yaml = chrono_scene(sample("hmmwv__HMMWV_DoubleWishboneFront_bushings.json"));
    const Scene scene = parse_scene(yaml, "scene");
    int bushings = 0;
    for (const auto& elastic : scene.elastics)
        if (const auto* bushing = std::get_if<Bushing>(&elastic.kind)) {
            ++bushings;
            EXPECT_FALSE(bushing->formulation.conjugate);
        }
    EXPECT_EQ(bushings, 4);
}

// A template and the generic suspension with the same numbers are the same mechanism.
TEST(Chrono, TheReplicaMovesAsItsTemplate) {
    const Scene a = chrono(sample("hmmwv__HMMWV_DoubleWishboneFront.json")),
                b = chrono(sample("hmmwv__HMMWV_DoubleWishboneFront_replica.json"));
    const auto travelled = [](const Scene& scene) {
        const Model model = compile(scene);
        Branch branch = model.branches.front();
        branch.from = 0;
        return compare::solve_branch(compare::sides_of(model, branch, 2),
                                     {.leg = compare::Leg::equilibrium});
    };
    const auto p = travelled(a), q = travelled(b);
    ASSERT_EQ(p.points.size(), q.points.size());
    ASSERT_FALSE(p.points.empty());
    const Model m = compile(a), n = compile(b);
    for (std::size_t k = 0; k < p.points.size(); ++k) {
        const auto wheel = [](const Model& model, const Equilibrium& point) -> Vector3d {
            const Wheel& w = model.wheels.at(0);
            const Pose& pose = point.poses.at(static_cast<std::size_t>(w.body));
            return pose.r + pose.p * w.centre_local;
        };
        // The replica's joints are given with six digits.
        EXPECT_LE((wheel(m, p.points[k]) - wheel(n, q.points[k])).norm(), 1e-6);
    }
}

// Every step of every template is known and finds its fields: bodies, joints and elements of each, of
// one file that has the fields of all.
TEST(Chrono, EveryTemplateHasItsBodiesJointsAndElements) {
    const std::string all = support::text_of(folder / "fixtures/every_template.json");
    for (const auto& [name, bodies, joints, elements] : {std::tuple{"DoubleWishbone", 10, 12, 10},
                                                         {"DoubleWishboneReduced", 6, 16, 6},
                                                         {"MacPhersonStrut", 10, 16, 6},
                                                         {"MultiLink", 12, 20, 6},
                                                         {"SemiTrailingArm", 4, 6, 6},
                                                         {"ThreeLinkIRS", 8, 8, 12},
                                                         {"SingleWishbone", 8, 12, 6},
                                                         {"SolidAxle", 13, 21, 6},
                                                         {"SolidThreeLinkAxle", 6, 10, 6},
                                                         {"SolidBellcrankThreeLinkAxle", 12, 19, 6},
                                                         {"DeDionAxle", 6, 10, 6},
                                                         {"ToeBarDeDionAxle", 10, 16, 6},
                                                         {"LeafspringAxle", 3, 7, 6},
                                                         {"ToeBarLeafspringAxle", 7, 13, 6},
                                                         {"PushPipeAxle", 4, 7, 6},
                                                         {"ToeBarPushPipeAxle", 8, 13, 6},
                                                         {"RigidPanhardAxle", 6, 11, 7},
                                                         {"ToeBarRigidPanhardAxle", 10, 17, 7},
                                                         {"SAELeafspringAxle", 13, 18, 14},
                                                         {"SAEToeBarLeafspringAxle", 17, 24, 14},
                                                         {"HendricksonPRIMAXX", 12, 19, 2},
                                                         {"GenericWheeledSuspension", 8, 14, 6}}) {
        const auto imported = importer::import_text(replaced(all, "DoubleWishbone", name),
                                                    "model.json", {.allow_missing = true});
        EXPECT_EQ(std::tuple(imported.bodies, imported.joints, imported.elements),
                  std::tuple(bodies, joints, elements))
            << name;
    }
}

// Each key of every sample, misspelt in its last letter, is an error. Comments and "Visualization",
// which is left out as a whole, have no keys.
TEST(Chrono, MisspeltKeyIsReported) {
    const std::regex pattern(
        "//[^\n]*|\"Visualization\"\\s*:\\s*\\{[^{}]*(\\{[^{}]*\\}[^{}]*)*\\}|\"([^\"\n]+)\"[ "
        "\t]*:");
    int changed = 0;
    for (const auto& entry : fs::directory_iterator(folder / "samples")) {
        const std::string name = entry.path().filename().string(), text = sample(name);
        if (entry.path().extension() != ".json" || !refusal_of(text, name).empty()) continue;
        for (std::sregex_iterator found(text.begin(), text.end(), pattern), none; found != none;
             ++found) {
            if (!(*found)[2].matched) continue;
            const auto last = static_cast<std::size_t>(found->position(2) + found->length(2) - 1);
            std::string other = text;
            other[last] = other[last] == 'q' ? 'z' : 'q';
            ++changed;
            EXPECT_NE(refusal_of(other, "model.json"), "") << name << ": " << (*found)[2];
        }
    }
    EXPECT_GT(changed, 1000);
}

// A // comment ends at the end of its line for all line endings, and messages count those lines.
TEST(Chrono, LinesMayEndInCarriageReturnsAlone) {
    std::string text = sample("hmmwv__HMMWV_DoubleWishboneFront_bushings.json");
    const auto entries = [](const std::string& yaml) {
        return yaml.substr(yaml.find("\nelastocheck:"));
    };
    const std::string expected = entries(chrono_scene(text));
    std::erase(text, '\r');
    std::ranges::replace(text, '\n', '\r');
    EXPECT_EQ(entries(chrono_scene(text)), expected);
}

// A sample with the text `at` replaced by `instead`, to add or change a field.
std::string double_wishbone(const std::string& at, const std::string& instead) {
    return replaced(sample("generic__DoubleWishbone.json"), at, instead);
}

// Order of fields as in Chrono's ReadTSDAFunctorJSON: a map before a table before a coefficient,
// and a damper table before a coefficient. Stops exist if both lengths are given; the deformation
// of a map is the length itself; a tie rod without inertia is a distance.
TEST(Chrono, OfSynonymousFieldsTheOneThatChronoReadsIsRead) {
    const std::string coefficient = "\"Spring Coefficient\":";
    const auto law = [](const std::string& yaml) {
        const Scene scene = parse_scene(yaml, "scene");
        for (const auto& elastic : scene.elastics)
            if (const auto* spring = std::get_if<AxialSpring>(&elastic.kind)) return *spring;
        return AxialSpring{};
    };
    const auto with = [&](const std::string& fields) {
        return double_wishbone(coefficient, fields + ", " + coefficient);
    };
    const auto notes = [](const std::string& text, const char* what) {
        EXPECT_TRUE(says(head_of(text), what));
    };
    const std::string both = with("\"Spring Curve Data\": [[-0.1, -500], [0.1, 500]]");
    EXPECT_EQ(std::get<Curve>(law(chrono_scene(both)).law).pieces.at(1)[1], 5000);
    notes(both, "Spring Coefficient: not used: Chrono uses the Spring Curve Data instead");

    const std::string damper = with("\"Damping Curve Data\": [[-1, -5], [1, 5]]");
    const auto elastics = chrono(damper).elastics;
    EXPECT_EQ(elastics.size(), 0u);
    notes(damper, "Chrono uses the Damping Curve Data instead: there is no spring");

    const std::string one_stop = with("\"Minimum Length\": 0.2");
    EXPECT_EQ(chrono_scene(one_stop).find("bump_stop"), std::string::npos);
    notes(one_stop, "Minimum Length: not used: Chrono has stops only if both");

    // At speed zero -30 N at 0.25 m and 70 N at 0.35 m.
    const std::string map =
        with("\"Map Data\": [[-1, -40, 60], [3, 0, 100]], \"Deformation\": [0.25, 0.35]");
    const AxialSpring of_map = law(chrono_scene(map));
    const auto& curve = std::get<Curve>(of_map.law);
    EXPECT_NEAR(of_map.free_length + curve.knots.at(0), 0.25, 1e-9);
    EXPECT_NEAR(curve.pieces.at(1)[0], -30, 1e-9);
    EXPECT_NEAR(curve.pieces.at(1)[1], 1000, 1e-9);
    EXPECT_TRUE(curve.known_outside);
    notes(map, "Free Length: not used: Chrono counts the deformation of a map from length zero");

    notes(double_wishbone("\"Tierod\":\n  {",
                          "\"Tierod\":\n  {\"Bushing Data\": {\"Stiffness Linear\": 7e7, "
                          "\"Stiffness Rotational\": 1},"),
          "Tierod.Bushing Data: not used: a tie rod without Mass");
}

// Each point of the file is a hardpoint with its own source line.
TEST(Chrono, HardpointsOfTheFileStayWithTheirLines) {
    const std::string text = sample("hmmwv__HMMWV_DoubleWishboneFront.json"),
                      yaml = chrono_scene(text);
    const auto line_of = [&](const char* part, const char* key) {
        const auto at = text.find(key, text.find(part));
        return std::ranges::count(std::string_view(text).substr(0, at), '\n') + 1;
    };
    for (const auto& [name, part, key] :
         {std::tuple{"upper_arm.axis.front_left", "Upper Control Arm", "Location Chassis Front"},
          {"upper_arm.axis.rear_left", "Upper Control Arm", "Location Chassis Back"},
          {"tierod_left.inner", "Tierod", "Location Chassis"},
          {"tierod_left.outer", "Tierod", "Location Upright"}}) {
        const auto at = yaml.find(fmt::format("  {}: [", name));
        ASSERT_NE(at, yaml.npos) << name;
        const std::string line = yaml.substr(at, yaml.find('\n', at) - at);
        EXPECT_TRUE(
            says(line, fmt::format("# line {}, {}/{}",
                                   line_of(fmt::format("\"{}\"", part).c_str(), key), part, key)));
    }
}

// A wheel directly over its spring, whose table has a row every 10 mm. At branch points on
// a row the wheel rate is undefined, since rounding would select the side; the legs agree
// on these points.
TEST(Chrono, WheelRateAtARowOfATableIsUndefined) {
    const Scene scene = chrono(sample("ultra_tow__UT_LeafspringAxle.json"));
    const Model model = compile(scene);
    const auto channels = compare::characteristics(model);
    const auto ways = compare::sides_of(model, model.branches.front(), 12);  // 10 mm each
    const auto rate = static_cast<std::size_t>(
        std::ranges::find(channels, "left.wheel_rate", &compare::Channel::name) - channels.begin());
    ASSERT_LT(rate, channels.size());
    int without = 0;
    for (const auto leg : {compare::Leg::equilibrium, compare::Leg::series}) {
        const auto walked =
            compare::solve_branch(model, channels, model.branches.front(), ways, {.leg = leg});
        for (const auto& values : walked.curve.values)
            without += values.at(rate) == compare::undefined ? 1 : 0;
    }
    EXPECT_GT(without, 2);
    EXPECT_EQ(without % 2, 0);
}

// Chrono interpolates linearly between the rows; the scene does the same to the last digit.
TEST(Chrono, ATableIsStraightBetweenItsRows) {
    const Scene scene = chrono(sample("hmmwv__HMMWV_DoubleWishboneFront.json"));
    const auto& curve = std::get<Curve>(std::get<AxialSpring>(scene.elastics.at(0).kind).law);
    ASSERT_GT(curve.knots.size(), 10u);
    for (std::size_t k = 0; k + 1 < curve.knots.size(); ++k) {
        const double h = curve.knots[k + 1] - curve.knots[k];
        EXPECT_NEAR(curve.pieces[k + 1][0] + h * curve.pieces[k + 1][1], curve.pieces[k + 2][0],
                    1e-9);
        EXPECT_EQ(curve.pieces[k + 1][2], 0);
        EXPECT_EQ(curve.pieces[k + 1][3], 0);
    }
}

TEST(Chrono, SaysWhatIsWrongAndWhere) {
    expect_refusals("double_wishbone", sample("generic__DoubleWishbone.json"), "model.json",
                    [](const std::string& text) { return refusal_of(text, "model.json"); });
}

// ---- Property files

const std::string block_on = R"(
elastocheck: 1
name: block
units: {length: m, angle: rad, force: N}
points: {o: [0, 0, 0], top: [0, 0, 0.5]}
bodies: {block: {origin: o}}
)";

const std::string push_on_block =
    "loads: {push: {on: block, at: o, force: [0, 0, 1]}}\n"
    "branches: {push: {load: push, to: 1, steps: 1}}\nprobes: {o: {on: block, at: o}}\n";

Scene beside_fixtures(const std::string& elements) {
    support::Folder here;
    for (const auto& entry : fs::directory_iterator(folder / "fixtures"))
        fs::copy(entry.path(), here.path);
    return read_scene(here.write("scene.yaml", block_on + elements + push_on_block));
}

TEST(PropertyFile, ABushingTakesAllSixCurvesInTheUnitsOfTheFile) {
    const Scene scene =
        beside_fixtures("bushings: {mount: {bodies: [ground, block], at: o, rates: mount.bus}}\n");
    const auto& law = std::get<PerAxis>(std::get<Bushing>(scene.elastics.at(0).kind).law);
    const auto& x = std::get<Curve>(law.axis[0]);
    ASSERT_EQ(x.knots.size(), 5u);
    EXPECT_NEAR(x.knots[4], 0.002, 1e-15);
    EXPECT_NEAR(x.pieces[5][0], 9000, 1e-9);
    const auto& rx = std::get<Curve>(law.axis[3]);  // 20 N·m over 10°
    EXPECT_NEAR(rx.pieces[1][1], 20 / (10 * M_PI / 180), 1e-9);
    EXPECT_EQ(std::get<Curve>(law.axis[5]).pieces[1][1], 0);
}

TEST(PropertyFile, LinesMayEndInCarriageReturnsAlone) {
    std::string sub = support::text_of(folder / "fixtures" / "front.sub");
    const std::string expected = importer::import_text(sub, "front.sub", {}).yaml;
    std::ranges::replace(sub, '\n', '\r');
    EXPECT_EQ(importer::import_text(sub, "front.sub", {}).yaml, expected);
}

TEST(PropertyFile, SpringsAndStopsTakeTheirCurves) {
    const Scene scene = beside_fixtures(
        "springs: {coil: {bodies: [block, ground], from: o, to: top, curve: {file: coil.spr}, "
        "free_length: "
        "0.6,\n"
        "  bump_stop: {clearance: 0.05, curve: {file: rubber.bum}}}}\n");
    const auto& coil = std::get<Curve>(std::get<AxialSpring>(scene.elastics.at(0).kind).law);
    EXPECT_NEAR(coil.pieces[1][1], 200 * 0.45359237 * 9.80665 / 0.0254, 1e-6);
    const auto& stop = std::get<Curve>(std::get<AxialSpring>(scene.elastics.at(1).kind).law);
    EXPECT_NEAR(stop.knots.front(), -0.07, 1e-15);
    EXPECT_NEAR(stop.pieces[1][0], -2500, 1e-9);
}

TEST(PropertyFile, ASpringHasTheFreeLengthOfItsFileUnlessTheSceneGivesOne) {
    for (const auto& [given, length] : {std::pair{"", 10 * 0.0254}, {", free_length: 0.6", 0.6}}) {
        const Scene scene = beside_fixtures(
            fmt::format("springs: {{coil: {{bodies: [block, ground], from: o, to: top, curve: "
                        "{{file: coil.spr}}{}}}}}\n",
                        given));
        EXPECT_NEAR(std::get<AxialSpring>(scene.elastics.at(0).kind).free_length, length, 1e-15);
    }
}

// In a spring file compression and pushing force are positive: 3000 N at 100 mm of jounce.
TEST(PropertyFile, PositiveDeflectionInASpringFileIsCompression) {
    const Scene scene = beside_fixtures(
        "springs: {coil: {bodies: [block, ground], from: o, to: top, curve: {file: push.spr}}}\n");
    const auto& law = std::get<Curve>(std::get<AxialSpring>(scene.elastics.at(0).kind).law);
    ASSERT_EQ(law.knots.size(), 3u);
    EXPECT_NEAR(law.knots.front(), -0.1, 1e-15);  // 100 mm shorter ...
    EXPECT_NEAR(law.pieces[1][0], -3000, 1e-9);   // ... where tension is positive
    EXPECT_NEAR(law.pieces.back()[0], 1000, 1e-9);
}

TEST(PropertyFile, SaysWhatIsWrongAndWhere) {
    const std::string sound = support::text_of(folder / "fixtures" / "mount.bus");
    const auto said = [](const std::string& text,
                         const std::string& element = "rates: mount.bus") -> std::string {
        support::Folder here;
        here.write("mount.bus", text);
        const auto scene = here.write(
            "scene.yaml", block_on + "bushings: {mount: {bodies: [ground, block], at: o, " +
                              element + "}}\n" + push_on_block);
        return refusal_of([&] { read_scene(scene); });
    };
    expect_refusals("mount", sound, "mount.bus",
                    [&](const std::string& text) { return said(text); });
    EXPECT_TRUE(says(said(sound, "rates: mount.txt"), "or the name of a property file"));
    EXPECT_TRUE(says(said(sound, "rates: mount.bus, rotational_rates: [1, 1, 1]"),
                     "the file has all six curves"));
    EXPECT_TRUE(says(said(sound, "rates: ../mount.bus"), "is outside the scene's folder"));
}

// ---- A second frame of a bushing, for markers that are not parallel as drawn.

TEST(Bushing, AFrameOfTheSecondBodyIsItsOwn) {
    const auto bushing = [](const std::string& more) {
        return std::get<Bushing>(
            beside_fixtures(
                "bushings: {mount: {bodies: [ground, block], at: o, frame: {x: x, y: y}, " + more +
                "rates: [1, 2, 3], rotational_rates: [4, 5, 6]}}\n")
                .elastics.at(0)
                .kind);
    };
    const Bushing plain = bushing(""), turned = bushing("frame_j: {x: y, y: -x}, ");
    EXPECT_LE(plain.j.A_local.angularDistance(plain.i.A_local), 1e-12);
    EXPECT_NEAR(turned.j.A_local.angularDistance(turned.i.A_local), M_PI / 2, 1e-9);
    EXPECT_LE(turned.i.A_local.angularDistance(plain.i.A_local), 1e-12);
    EXPECT_THROW(bushing("frame_j: {x: y}, "), SceneError);
}

// ---- Export and re-import.

// The Chrono export of any imported scene can be re-imported and gives the same motion.
TEST(Chrono, ExportedAndImportedAgainHasTheSameMotion) {
    for (const char* name : {"generic__MultiLink.json", "generic__DoubleWishbone.json",
                             "generic__SemiTrailingArm.json", "generic__ThreeLinkIRS.json",
                             "hmmwv__HMMWV_DoubleWishboneFront_bushings.json",
                             "generic__HendricksonPRIMAXX.json", "generic__DeDionAxle.json"}) {
        SCOPED_TRACE(name);
        const auto imported = [](std::string_view text) {
            return parse_scene(importer::import_text(text, "model.json", {}).yaml, "scene");
        };
        std::string text = sample(name);
        for (const auto& [key, angle] :
             {std::pair{"\"Toe Angle (deg)\":", " 0.5"}, {"\"Camber Angle (deg)\":", " -1.5"}})
            if (const auto at = text.find(key); at != text.npos) {
                const auto value = text.find_first_not_of(' ', at + std::strlen(key));
                text.replace(value, text.find(',', value) - value, angle);
            }
        const Scene first = imported(text);
        const Scene second = imported(importer::export_chrono(first, false).text);
        const auto end_of = [](const Scene& scene) {
            const Model model = compile(scene);
            const auto path =
                compare::solve_branch(compare::sides_of(model, model.branches.front(), 4),
                                      {.leg = compare::Leg::equilibrium});
            std::vector<Vector3d> centres;
            for (const auto& point : path.points)
                for (const Wheel& wheel : model.wheels) {
                    const auto& pose = point.poses.at(static_cast<std::size_t>(wheel.body));
                    centres.push_back(pose.r + pose.p * wheel.centre_local);
                    centres.push_back(pose.p * wheel.spin_axis_local);
                }
            return centres;
        };
        const auto a = end_of(first), b = end_of(second);
        ASSERT_EQ(a.size(), b.size());
        ASSERT_GT(a.size(), 8u);
        for (std::size_t k = 0; k < a.size(); ++k) EXPECT_LE((a[k] - b[k]).norm(), 1e-9) << k;
        EXPECT_GT((a.front() - a.back()).norm(), 0.01);
    }
}

// Stops with Chrono's curve are exported as Chrono's own, both or one of the two; stops with other
// curves are errors.
TEST(Chrono, StopsOfItsOwnCurveAreExportedAndOthersAreNot) {
    const Scene first = chrono(sample("hmmwv__HMMWV_DoubleWishboneFront_bushings.json"));
    const auto stops = [](const Scene& scene) {
        std::vector<const AxialSpring*> list;
        for (const Elastic& elastic : scene.elastics)
            if (elastic.written_as == WrittenAs::stop)
                list.push_back(&std::get<AxialSpring>(elastic.kind));
        return list;
    };
    ASSERT_EQ(stops(first).size(), 4u);
    for (const bool both : {true, false}) {
        Scene some = first;
        if (!both)
            std::erase_if(some.elastics,
                          [](const Elastic& e) { return e.name.ends_with(".rebound_stop"); });
        const Scene second = chrono(importer::export_chrono(some, false).text);
        const auto force_of_stops = [&](const Scene& scene, double length) {
            double sum = 0;
            for (const AxialSpring* stop : stops(scene))
                sum += force(stop->law, length - stop->free_length);
            return sum;
        };
        for (double length = 0.2; length < 0.8; length += 0.01)
            EXPECT_NEAR(force_of_stops(second, length), force_of_stops(some, length), 1e-3)
                << length;
    }
    Scene other = first;
    for (Elastic& elastic : other.elastics)  // changes the force at one row
        if (elastic.name.ends_with(".bump_stop"))
            std::get<Curve>(std::get<AxialSpring>(elastic.kind).law).pieces.at(4)[0] *= 1.01;
    EXPECT_TRUE(says(refusal_of([&] { importer::export_chrono(other, false); }),
                     "stops in Chrono have one hard-coded curve"));
    Scene alone = first;
    std::erase_if(alone.elastics, [](const Elastic& e) {
        return e.written_as == WrittenAs::itself && std::holds_alternative<AxialSpring>(e.kind);
    });
    EXPECT_TRUE(says(refusal_of([&] { importer::export_chrono(alone, false); }),
                     "belong to a spring between the same points"));
}

TEST(Chrono, SceneElementWithoutAChronoFieldIsRefusedOnExport) {
    const Scene strut = read_scene(fs::path(ELASTOCHECK_SCENES) / "mcpherson_strut.yaml");
    EXPECT_THROW(importer::export_chrono(strut, false), SceneError);
    EXPECT_TRUE(says(importer::export_chrono(strut, true).text, "// MISSING: element"));
    const Scene arch = read_scene(fs::path(ELASTOCHECK_SCENES) / "two_spring_arch.yaml");
    EXPECT_THROW(importer::export_chrono(arch, true), SceneError);  // no wheel
}

// ---- Samples

TEST(Import, PipeIsRefused) {
    const support::Folder place;
    for (const char* ending : {".adm", ".json", ".sub"}) {
        const fs::path pipe = place.path / (std::string("model") + ending);
        const support::Pipe nobody(pipe);
        ASSERT_TRUE(nobody.is_there());
        EXPECT_EQ(refusal_of([&] { importer::import_file(pipe, {}); }),
                  pipe.string() + ": a pipe or a device; a regular file is needed");
    }
}

// A row that differs is printed as it should be recorded.
TEST(Import, EverySampleIsImportedOrRefusedAsRecorded) {
    std::istringstream recorded(support::text_of(folder / "outcomes.md"));
    int rows = 0;
    for (std::string line; std::getline(recorded, line);) {
        if (!line.starts_with("| ") || line.starts_with("| file")) continue;
        const std::string name = line.substr(2, line.find(" |") - 2);
        std::string row;
        try {
            const auto result = importer::import_file(folder / "samples" / name, {});
            std::string outcome = "imported";
            if (const auto n = result.notes.warnings.size())
                outcome += fmt::format(", {} warning{}", n, n == 1 ? "" : "s");
            row = fmt::format("| {} | {} | {} | {} | {} |", name, result.bodies, result.joints,
                              result.elements, outcome);
        } catch (const SceneError& error) {
            const std::string said = error.what(), file = (folder / "samples" / name).string();
            row = fmt::format("| {} | - | - | - | refused: {}{} |", name, name,
                              said.substr(file.size(), said.find('\n') - file.size()));
        }
        EXPECT_EQ(row, line);
        ++rows;
    }
    int files = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / "samples")) ++files;
    EXPECT_EQ(rows, files);
}

}  // namespace
}  // namespace elastocheck
