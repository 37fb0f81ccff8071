// Suspensions of Chrono::Vehicle, property files of Adams/Car; and of all formats: what becomes of the samples, and that no
// damage to them ends other than in an answer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "compare/legs.hpp"
#include "models/compile.hpp"
#include "models/import/export_chrono.hpp"
#include "models/import/import.hpp"
#include "models/reader/scene_file.hpp"
#include "tests/models/import/imports.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using importer::Options;
using namespace tests;

const fs::path folder = fs::path(ELASTOCHECK_IMPORT);

std::string chrono_scene(const std::string& text) {
    return importer::import_text(text, "model.json", {}).yaml;
}

std::string refusal(const std::string& text, const std::string& file) {
    try {
        importer::import_text(text, file, {});
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return at == text.npos ? text : text.replace(at, from.size(), to);
}

// ---- Chrono

// The published hardpoints are in a built-in scene as well, written by hand.
TEST(Chrono, TheMacPhersonStrutIsWhereItsHardpointsAre) {
    const Scene scene = parse_scene(chrono_scene(sample("generic__MacPhersonStrut.json")), "scene");
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

// Toe and camber turn the spindle, as toe and camber here say: positive toe-in, top out.
TEST(Chrono, ToeAndCamberAreThoseOfTheWheel) {
    std::string text = sample("generic__DoubleWishbone.json");
    text = replaced(replaced(text, "\"Toe Angle (deg)\":                  0", "\"Toe Angle (deg)\": 0.5"),
                    "\"Camber Angle (deg)\":               0", "\"Camber Angle (deg)\": -1");
    const Scene scene = parse_scene(chrono_scene(text), "scene");
    const Vector3d e = scene.wheels.at(0).spin_axis_local, f = scene.wheels.at(1).spin_axis_local;
    EXPECT_NEAR(std::atan2(e.x(), e.y()) * 180 / M_PI, 0.5, 1e-9);
    EXPECT_NEAR(-std::asin(e.z()) * 180 / M_PI, -1, 1e-4);
    EXPECT_LE((Vector3d(f.x(), -f.y(), f.z()) - e).norm(), 1e-12);
}

// Every leg over ±60 mm of travel, by the references' own measure of agreement; the rest of the samples is for the command.
TEST(Chrono, TheLegsAgreeOverTheTravelOfASample) {
    for (const char* file : {"generic__DoubleWishbone.json", "generic__ThreeLinkIRS.json"}) {
        const Scene scene = parse_scene(chrono_scene(sample(file)), "scene");
        const Model model = compile(scene);
        const auto ways = compare::ways_of(model, model.branches.front(), 6);
        const auto a = compare::walk(ways, {.leg = compare::Leg::equilibrium}),
                   b = compare::walk(ways, {.leg = compare::Leg::series});
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

// In place of a revolute the rotation about its axis is free; elsewhere a bushing has K_rot; and F is the same all round.
TEST(Chrono, BushingsStandWhereChronoPutsThem) {
    const std::string yaml = chrono_scene(sample("hmmwv__HMMWV_DoubleWishboneFront_bushings.json"));
    EXPECT_NE(yaml.find("rates: [70000000, 70000000, 70000000]"), yaml.npos) << yaml;
    EXPECT_NE(yaml.find("rotational_rates: [100000, 100000, 0]"), yaml.npos);
    const Scene scene = parse_scene(yaml, "scene");
    int bushings = 0;
    for (const auto& elastic : scene.elastics)
        if (const auto* bushing = std::get_if<Bushing>(&elastic.kind)) {
            ++bushings;
            EXPECT_FALSE(bushing->formulation.conjugate);
        }
    EXPECT_EQ(bushings, 4);
    // The tie rod has mass, and is a body between a ball and a universal joint.
    EXPECT_NE(yaml.find("tierod_left.inner: {type: universal, bodies: [ground, tierod_left]"), yaml.npos);
    const std::string light = chrono_scene(sample("hmmwv__HMMWV_DoubleWishboneFront.json"));
    EXPECT_NE(light.find("tierod_left: {type: distance, bodies: [ground, upright_left]"), light.npos)
        << light;
}

// The template and the generic suspension of the same numbers are one mechanism.
TEST(Chrono, TheReplicaMovesAsItsTemplate) {
    const Scene a = parse_scene(chrono_scene(sample("hmmwv__HMMWV_DoubleWishboneFront.json")), "scene"),
                b = parse_scene(chrono_scene(sample("hmmwv__HMMWV_DoubleWishboneFront_replica.json")),
                                "scene");
    const auto travelled = [](const Scene& scene) {
        const Model model = compile(scene);
        Branch branch = model.branches.front();
        branch.from = 0;
        return compare::walk(compare::ways_of(model, branch, 2), {.leg = compare::Leg::equilibrium});
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
        // The replica's joints were written with six digits.
        EXPECT_LE((wheel(m, p.points[k]) - wheel(n, q.points[k])).norm(), 1e-6);
    }
}

TEST(Chrono, FaultsOfTheDataAreKeptAndTold) {
    const std::string yaml = chrono_scene(sample("generic__DeDionAxle.json"));
    EXPECT_NE(
        yaml.find("its minimum length 0.28 is above its maximum length 0.12: both stops are always closed"),
        yaml.npos)
        << yaml;
    EXPECT_NE(
        chrono_scene(sample("generic__MacPhersonStrut.json")).find("in tension at the design position: 1.2"),
        std::string::npos);
}

TEST(Chrono, SaysWhatIsWrongAndWhere) {
    const std::string sound = sample("generic__DoubleWishbone.json");
    const std::tuple<const char*, std::string, const char*> cases[] = {
        {"empty", "", "model.json:1: the file ends where a value is expected"},
        {"no object", "[1]", "expected an object"},
        {"binary", std::string("{\0}", 3), "this is no JSON"},
        {"deep", std::string(100, '[') + std::string(100, ']'), "nested deeper than 32"},
        {"twice", "{\"a\": 1, \"a\": 2}", "'a' is given twice"},
        {"open", "{\"a\": 1", "the file ends where a comma or } is expected"},
        {"a comma too many", "{\"a\": [1, ], }", "expected a value"},
        {"an open string", "{\"a\": \"b\n\"}", "a string is left open"},
        {"an escape", "{\"a\": \"\\q\"}", "an unknown escape"},
        {"an open comment", "{ /* \"a\": 1}", "a comment /* is left open"},
        {"more", sound + "{}", "more behind the end"},
        {"NaN", replaced(sound, "14.705", "NaN"), "expected a value"},
        {"a vehicle", sample("generic__Vehicle_MacPhersonStruts.json"), "'Vehicle' is no suspension"},
        {"a template", replaced(sound, "\"DoubleWishbone\"", "\"DoubleWishbon\""),
         "did you mean 'DoubleWishbone'"},
        {"no spring", sample("generic__RigidPinnedAxle.json"), "no spring at all"},
        {"a point", replaced(sound, "[-0.040, 1.100, -0.026]", "[-0.040, 1.100]"),
         "model.json:12: Spindle.COM: expected a list of 3"},
        {"a key", replaced(sound, "\"Location Arm\"", "\"Location Am\""), "Spring.Location Arm: missing"},
        {"no such part", replaced(sound, "\"Axle\"", "\"Wing\""), "Wing: not known of this template"},
    };
    for (const auto& [what, text, message] : cases) {
        const std::string said = refusal(text, "model.json");
        EXPECT_TRUE(said.starts_with("model.json:")) << what << ": " << said;
        EXPECT_NE(said.find(message), said.npos) << what << ": " << said;
    }
    EXPECT_EQ(refusal(replaced(sound, "\"Axle\"", "/* here */ // and here\n\"Axle\""), "model.json"), "");
}

// ---- Property files

const std::string block_on = R"(
elastocheck: 1
name: block
units: {length: m, angle: rad, force: N}
points: {o: [0, 0, 0], top: [0, 0, 0.5]}
bodies: {block: {origin: o}}
)";

Scene beside_fixtures(const std::string& elements) {
    support::Folder here;
    for (const auto& entry : fs::directory_iterator(folder / "fixtures")) fs::copy(entry.path(), here.path);
    return read_scene(
        here.write("scene.yaml",
                   block_on + elements +
                       "loads: {push: {on: block, at: o, force: [0, 0, 1]}}\n"
                       "branches: {push: {load: push, to: 1, steps: 1}}\nprobes: {o: {on: block, at: o}}\n"));
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

TEST(PropertyFile, SpringsAndStopsTakeTheirCurves) {
    const Scene scene = beside_fixtures(
        "springs: {coil: {bodies: [block, ground], from: o, to: top, curve: {file: coil.spr}, free_length: "
        "0.6,\n"
        "  bump_stop: {clearance: 0.05, curve: {file: rubber.bum}}}}\n");
    const auto& coil = std::get<Curve>(std::get<AxialSpring>(scene.elastics.at(0).kind).law);
    EXPECT_NEAR(coil.pieces[1][1], 200 * 0.45359237 * 9.80665 / 0.0254, 1e-6);
    const auto& stop = std::get<Curve>(std::get<AxialSpring>(scene.elastics.at(1).kind).law);
    EXPECT_NEAR(stop.knots.front(), -0.07, 1e-15);
    EXPECT_NEAR(stop.pieces[1][0], -2500, 1e-9);
}

// In a spring's file what it is shorter by is positive, and so is what pushes its ends apart: 3000 N at 100 mm of jounce.
TEST(PropertyFile, ASpringPushesBackByTheSideOfItsCurveThatIsCompression) {
    const support::Folder here;
    here.write("p.spr",
               "[MDI_HEADER]\nFILE_TYPE = 'spr'\n[UNITS]\nLENGTH = 'mm'\nANGLE = 'deg'\nFORCE = 'newton'\n"
               "[SPRING_DATA]\nFREE_LENGTH = 500\n[CURVE]\n{disp force}\n-100 -1000\n0 0\n100 3000\n");
    const Scene scene = read_scene(here.write(
        "scene.yaml",
        block_on + "springs: {coil: {bodies: [block, ground], from: o, to: top, curve: {file: p.spr}}}\n"
                   "loads: {push: {on: block, at: o, force: [0, 0, 1]}}\n"
                   "branches: {push: {load: push, to: 1, steps: 1}}\nprobes: {o: {on: block, at: o}}\n"));
    const auto& law = std::get<Curve>(std::get<AxialSpring>(scene.elastics.at(0).kind).law);
    ASSERT_EQ(law.knots.size(), 3u);
    EXPECT_NEAR(law.knots.front(), -0.1, 1e-15);  // 100 mm shorter ...
    EXPECT_NEAR(law.pieces[1][0], -3000, 1e-9);   // ... where tension is positive
    EXPECT_NEAR(law.pieces.back()[0], 1000, 1e-9);
}

TEST(PropertyFile, SaysWhatIsWrongAndWhere) {
    const std::string sound = support::text_of(folder / "fixtures" / "mount.bus");
    const auto said = [&](const std::string& text,
                          const std::string& element = "rates: mount.bus") -> std::string {
        support::Folder here;
        here.write("mount.bus", text);
        try {
            read_scene(here.write(
                "scene.yaml",
                block_on + "bushings: {mount: {bodies: [ground, block], at: o, " + element + "}}\n"));
        } catch (const SceneError& error) {
            return error.what();
        }
        return "";
    };
    for (const auto& [what, text, message] : {
             std::tuple{"nothing", std::string(), "no block"},
             {"no units", replaced(sound, "[UNITS]", "[UNIT]"), "UNITS: missing"},
             {"a unit", replaced(sound, "'mm'", "'ell'"), "'ell' is no unit"},
             {"no length", replaced(sound, "LENGTH", "WIDTH"), "UNITS.LENGTH: missing"},
             {"no curve", replaced(sound, "[TY_CURVE]", "[T_CURVE]"), "TY_CURVE: missing"},
             {"open", replaced(sound, "[TY_CURVE]", "[TY_CURVE"), "is left open"},
             {"three in a row", replaced(sound, "1   4000\n", "1 4000 3\n"),
              ":24: 3 values in a table of 2 columns"},
             {"a word", replaced(sound, "1   4000\n", "1 much\n"), "'much' is no number"},
             {"falling", replaced(sound, "1   4000\n", "1 -5000\n"), "it may stay, but not fall"},
             {"back", replaced(sound, "1   4000\n", "-2 4000\n"), "is not above the one before"},
             {"alone", replaced(sound, "-1  -4000\n1   4000\n", "1 4000\n"), "fewer than two rows"},
             {"no columns", replaced(sound, "{ y  fy }\n", ""), "expected NAME = value, or columns"},
         }) {
        const std::string error = said(text);
        EXPECT_NE(error.find("mount.bus"), error.npos) << what << ": " << error;
        EXPECT_NE(error.find(message), error.npos) << what << ": " << error;
    }
    EXPECT_NE(said(sound, "rates: mount.txt").find("or the name of a property file"), std::string::npos);
    EXPECT_NE(
        said(sound, "rates: mount.bus, rotational_rates: [1, 1, 1]").find("the file has all six curves"),
        std::string::npos);
    EXPECT_NE(said(sound, "rates: ../mount.bus").find("leads out of the scene's folder"), std::string::npos);
}

TEST(PropertyFile, HardpointsOfASubsystemAreHalfATurnAway) {
    const std::string yaml =
        importer::import_text(support::text_of(folder / "fixtures" / "front.sub"), "front.sub", {}).yaml;
    EXPECT_NE(yaml.find("lca_front_left: [200, 400, 150]"), yaml.npos) << yaml;
    EXPECT_NE(yaml.find("rack_mount: [-180, 0, 210]"), yaml.npos);
    EXPECT_NE(yaml.find("mirror: left -> right"), yaml.npos);
    EXPECT_NE(yaml.find("BUSHING_ASSEMBLY lca_front"), yaml.npos);
}

// ---- A second frame of a bushing, for markers that are not parallel as drawn.

TEST(Bushing, AFrameOfTheSecondBodyIsItsOwn) {
    const auto bushing = [](const std::string& more) {
        return std::get<Bushing>(
            beside_fixtures("bushings: {mount: {bodies: [ground, block], at: o, frame: {x: x, y: y}, " +
                            more + "rates: [1, 2, 3], rotational_rates: [4, 5, 6]}}\n")
                .elastics.at(0)
                .kind);
    };
    const Bushing plain = bushing(""), turned = bushing("frame_j: {x: y, y: -x}, ");
    EXPECT_LE(plain.j.A_local.angularDistance(plain.i.A_local), 1e-12);
    EXPECT_NEAR(turned.j.A_local.angularDistance(turned.i.A_local), M_PI / 2, 1e-9);
    EXPECT_LE(turned.i.A_local.angularDistance(plain.i.A_local), 1e-12);
    EXPECT_THROW(bushing("frame_j: {x: y}, "), SceneError);
}

// ---- There and back.

// Wherever the scene was imported from, the deck of it that export writes is imported as a scene that goes the same way.
TEST(Chrono, ExportedAndImportedAgainGoesTheSameWay) {
    for (const char* name :
         {"generic__MultiLink.json", "generic__DoubleWishbone.json", "generic__SemiTrailingArm.json",
          "generic__ThreeLinkIRS.json", "hmmwv__HMMWV_DoubleWishboneFront_bushings.json",
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
        Scene first = imported(text);
        // Chrono's are of one hard-coded curve, which no entry says.
        std::erase_if(first.elastics, [](const Elastic& e) { return e.written_as == WrittenAs::stop; });
        const Scene second = imported(importer::export_chrono(first, false).text);
        const auto end_of = [](const Scene& scene) {
            const Model model = compile(scene);
            const auto path = compare::walk(compare::ways_of(model, model.branches.front(), 4),
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

TEST(Chrono, WhatASuspensionHasNoPlaceForIsRefusedOnExport) {
    const Scene strut = read_scene(fs::path(ELASTOCHECK_SCENES) / "mcpherson_strut.yaml");
    EXPECT_THROW(importer::export_chrono(strut, false), SceneError);
    EXPECT_NE(importer::export_chrono(strut, true).text.find("// MISSING: element"), std::string::npos);
    const Scene arch = read_scene(fs::path(ELASTOCHECK_SCENES) / "two_spring_arch.yaml");
    EXPECT_THROW(importer::export_chrono(arch, true), SceneError);  // no wheel
}

// ---- Samples

// models/import/README.md shows this table, made by: elastocheck import --table tests/models/import/samples/*
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
