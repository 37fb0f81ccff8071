// Import of Chrono::Vehicle suspensions and Adams/Car property files.
// For all formats also the recorded outcomes of the samples, and fuzz tests with damaged samples.
#include <fmt/format.h>
#include <gtest/gtest.h>

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

namespace elastocheck {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using namespace tests;

Scene chrono(const std::string& text) {
    return parse_scene(importer::import_text(text, "model.json", {}).yaml, "scene");
}

// The centre and the axis of each wheel at each point of the travel.
std::vector<Vector3d> wheels_in_travel(const Scene& scene, int steps,
                                       compare::Leg leg = compare::Leg::equilibrium) {
    std::vector<Vector3d> all;
    const Model model = compile(scene);
    for (const auto& point : solved(model, "", steps, leg).points)
        for (const Wheel& wheel : model.wheels) {
            const Pose& pose = point.poses.at(static_cast<std::size_t>(wheel.body));
            all.push_back(pose.r + pose.p * wheel.centre_local);
            all.push_back(pose.p * wheel.spin_axis_local);
        }
    return all;
}

void expect_same(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b, double limit) {
    ASSERT_EQ(a.size(), b.size());
    ASSERT_GT(a.size(), 8u);
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_LE((a[k] - b[k]).norm(), limit) << k;
    EXPECT_GT((a.front() - a[a.size() - 4]).norm(), 0.01);  // two wheels: both ends of the travel
}

// ---- Chrono

// Over ±60 mm of travel; the command covers the other samples.
TEST(Chrono, LegsAgreeOverTheTravelOfASample) {
    for (const char* file : {"generic__DoubleWishbone.json", "generic__ThreeLinkIRS.json"}) {
        SCOPED_TRACE(file);
        const Scene scene = chrono(sample(file));
        EXPECT_EQ(scene.branches.front().from, -0.06);
        EXPECT_EQ(scene.branches.front().to, 0.06);
        expect_same(wheels_in_travel(scene, 6), wheels_in_travel(scene, 6, compare::Leg::series),
                    1e-9);
    }
}

// A template and the generic suspension with the same numbers, which has six digits, are the same mechanism.
TEST(Chrono, GenericSuspensionWithTheNumbersOfATemplateMovesAsIt) {
    expect_same(
        wheels_in_travel(chrono(sample("hmmwv__HMMWV_DoubleWishboneFront.json")), 4),
        wheels_in_travel(chrono(sample("hmmwv__HMMWV_DoubleWishboneFront_replica.json")), 4), 1e-6);
}

// Each key of every sample, misspelt in its last letter, is an error. Comments and "Visualization",
// which is left out as a whole, have no keys.
TEST(Chrono, MisspeltKeyIsReported) {
    const std::regex pattern(
        "//[^\n]*|\"Visualization\"\\s*:\\s*\\{[^{}]*(\\{[^{}]*\\}[^{}]*)*\\}|\"([^\"\n]+)\"[ "
        "\t]*:");
    int changed = 0;
    for (const auto& entry : fs::directory_iterator(import_folder / "samples")) {
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

TEST(Chrono, RefusalOfAnInvalidFileHasPlaceAndReason) {
    expect_refusals("double_wishbone", sample("generic__DoubleWishbone.json"), "model.json",
                    [](const std::string& text) { return refusal_of(text, "model.json"); });
}

// ---- Property files

TEST(PropertyFile, RefusalOfAnInvalidFileHasLineAndReason) {
    const std::string scene =
        replaced(support::text_of(import_folder / "fixtures/beside_files.yaml"), "# elements",
                 "bushings: {mount: {bodies: [ground, block], at: o, rates: mount.bus}}");
    expect_refusals("mount", support::text_of(import_folder / "fixtures/mount.bus"), "mount.bus",
                    [&](const std::string& text) {
                        const support::Folder here;
                        here.write("mount.bus", text);
                        return refusal_of([&] { read_scene(here.write("scene.yaml", scene)); });
                    });
}

// ---- Export and re-import.

// The Chrono export of any imported scene can be re-imported and gives the same motion.
TEST(Chrono, SceneExportedAndImportedAgainHasTheSameMotion) {
    for (const char* name : {"generic__MultiLink.json", "generic__DoubleWishbone.json",
                             "generic__SemiTrailingArm.json", "generic__ThreeLinkIRS.json",
                             "hmmwv__HMMWV_DoubleWishboneFront_bushings.json",
                             "generic__HendricksonPRIMAXX.json", "generic__DeDionAxle.json"}) {
        SCOPED_TRACE(name);
        std::string text = sample(name);
        for (const auto& [key, angle] :
             {std::pair{"\"Toe Angle (deg)\":", " 0.5"}, {"\"Camber Angle (deg)\":", " -1.5"}})
            if (const auto at = text.find(key); at != text.npos) {
                const auto value = text.find_first_not_of(' ', at + std::strlen(key));
                text.replace(value, text.find(',', value) - value, angle);
            }
        const Scene first = chrono(text);
        const Scene second = chrono(importer::export_chrono(first, false).text);
        expect_same(wheels_in_travel(first, 4), wheels_in_travel(second, 4), 1e-9);
    }
}

// Stops with Chrono's curve are exported as Chrono's own, both or one of the two; stops with other
// curves are errors.
TEST(Chrono, StopsWithTheCurveOfChronoAreExportedAndOthersAreRefused) {
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
    EXPECT_TRUE(has_text(refusal_of([&] { importer::export_chrono(other, false); }),
                         "stops in Chrono have one hard-coded curve"));
    Scene alone = first;
    std::erase_if(alone.elastics, [](const Elastic& e) {
        return e.written_as == WrittenAs::itself && std::holds_alternative<AxialSpring>(e.kind);
    });
    EXPECT_TRUE(has_text(refusal_of([&] { importer::export_chrono(alone, false); }),
                         "belong to a spring between the same points"));
}

TEST(Chrono, SceneElementWithoutAChronoFieldIsRefusedOnExport) {
    const Scene strut = read_scene(fs::path(ELASTOCHECK_SCENES) / "mcpherson_strut.yaml");
    EXPECT_THROW(importer::export_chrono(strut, false), SceneError);
    EXPECT_TRUE(has_text(importer::export_chrono(strut, true).text, "// MISSING: element"));
    const Scene arch = read_scene(fs::path(ELASTOCHECK_SCENES) / "two_spring_arch.yaml");
    EXPECT_THROW(importer::export_chrono(arch, true), SceneError);  // no wheel
}

// ---- Samples

// A row that differs is printed as it should be recorded.
TEST(Import, EverySampleIsImportedOrRefusedAsRecorded) {
    std::istringstream recorded(support::text_of(import_folder / "outcomes.md"));
    int rows = 0;
    for (std::string line; std::getline(recorded, line);) {
        if (!line.starts_with("| ") || line.starts_with("| file")) continue;
        const std::string name = line.substr(2, line.find(" |") - 2);
        std::string row;
        try {
            const auto result = importer::import_file(import_folder / "samples" / name, {});
            std::string outcome = "imported";
            if (const auto n = result.notes.warnings.size())
                outcome += fmt::format(", {} warning{}", n, n == 1 ? "" : "s");
            row = fmt::format("| {} | {} | {} | {} | {} |", name, result.bodies, result.joints,
                              result.elements, outcome);
        } catch (const SceneError& error) {
            const std::string said = error.what(),
                              file = (import_folder / "samples" / name).string();
            row = fmt::format("| {} | - | - | - | refused: {}{} |", name, name,
                              said.substr(file.size(), said.find('\n') - file.size()));
        }
        EXPECT_EQ(row, line);
        ++rows;
    }
    int files = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(import_folder / "samples"))
        ++files;
    EXPECT_EQ(rows, files);
}

}  // namespace
}  // namespace elastocheck
