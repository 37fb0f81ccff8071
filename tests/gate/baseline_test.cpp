// Baseline files: what is written is read again, and nothing misspelt is read as something else.
#include "reports/gate/baseline.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "compare/comparison/changes.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "reports/files/files.hpp"
#include "tests/support/command.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

using compare::Quantity;
using compare::ToleranceClass;

std::filesystem::path committed(const std::string& scene) {
    return std::string(ELASTOCHECK_SCENES) + "/baselines/" + scene + ".json";
}
BaselineText text_of(const std::filesystem::path& baseline) {
    return {read_whole(baseline), read_whole(curves_of(baseline))};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

TEST(Baseline, ReadingAndWritingKeepsTheText) {
    for (const auto& scene : support::scene_names()) {
        const BaselineText was = text_of(committed(scene)),
                           is = baseline_text(read_baseline(committed(scene)));
        EXPECT_EQ(is.review, was.review) << scene;
        EXPECT_EQ(is.curves, was.curves) << scene;
    }
}

// A line a figure, of few digits, at five to nine stations.
TEST(Baseline, IsSmallEnoughToReview) {
    for (const auto& scene : support::scene_names()) {
        const std::string text = read_whole(committed(scene));
        EXPECT_LT(std::ranges::count(text, '\n'), 250) << scene;
        EXPECT_LT(text.size(), 25'000u) << scene;
        const auto figures = nlohmann::json::parse(text)["figures"];
        EXPECT_FALSE(figures.empty()) << scene;
        for (const auto& branch : figures) {
            EXPECT_GE(branch["at"].size(), 5u) << scene;
            EXPECT_LE(branch["at"].size(), 9u) << scene;
            EXPECT_EQ(std::ranges::count(branch["at"].get<std::vector<double>>(), 0), 1)
                << scene << ": the design position";
            for (const auto& values : branch["figures"])
                EXPECT_EQ(values.size(), branch["at"].size()) << scene;
        }
        EXPECT_NE(read_baseline(committed(scene)).baseline.reason, "") << scene;
    }
}

// A tie rod 2 mm elsewhere: the reviewer sees the lines whose figures an engineer notices.
TEST(Baseline, ASmallChangeOfTheSceneRewritesTensOfLines) {
    const auto lines = [](const char* height) {
        const Setting moved{"points.tie_rod_inner.z", height};  // [m]
        const Model model = compile(read_scene(
            std::string(ELASTOCHECK_SCENES) + "/double_wishbone.yaml", std::span(&moved, 1)));
        BaselineFile file;
        file.baseline.accepted = compare::measure(model, compare::compare(model));
        std::istringstream text(baseline_text(file).review);
        std::vector<std::string> all;
        for (std::string line; std::getline(text, line);) all.push_back(line);
        return all;
    };
    const auto was = lines("0.001"), is = lines("0.003");
    ASSERT_EQ(was.size(), is.size());
    std::size_t changed = 0;
    for (std::size_t k = 0; k < was.size(); ++k) changed += was[k] != is[k];
    EXPECT_GT(changed, 10u);
    EXPECT_LT(changed, 90u);
}

// Both wheels of a symmetric axle are on one line, on two where they differ.
TEST(Baseline, EqualFiguresShareALine) {
    BaselineFile file = read_baseline(committed("front_axle"));
    const auto lines_with = [&](const std::string& key) {
        const std::string text = baseline_text(file).review;
        std::size_t count = 0;
        for (auto at = text.find('"' + key + " [deg]\""); at != text.npos;
             at = text.find('"' + key + " [deg]\"", at + 1))
            ++count;
        return count;
    };
    const std::size_t branches = file.baseline.accepted.branches.size();
    const std::size_t shared = lines_with("left, right: toe");
    EXPECT_GT(shared, 0u);
    EXPECT_EQ(lines_with("left.toe"), branches - shared);
    EXPECT_EQ(lines_with("right.toe"), branches - shared);
    for (auto& s : file.baseline.accepted.series)
        if (s.channel == "right.toe" && s.main)
            for (auto& value : s.values) value += 0.01;
    EXPECT_EQ(lines_with("left, right: toe"), 0u);
    EXPECT_EQ(lines_with("left.toe"), branches);
    EXPECT_EQ(lines_with("right.toe"), branches);
}

TEST(Baseline, HoldsEveryNumberOfAMeasurement) {
    const Model model = compile(support::scene("pendulum"));
    const auto measurement = compare::measure(model, compare::compare(model));
    for (const auto& branch : measurement.branches) {
        EXPECT_EQ(branch.unit, "N");
        ASSERT_EQ(branch.a.size(), 11u);
        EXPECT_EQ(branch.a.front(), 0);
        EXPECT_EQ(std::abs(branch.a.back()), 1500);
    }
    BaselineFile file;
    file.baseline.accepted = measurement;
    file.baseline.reason = "a \"test\"\n";
    file.scene_file = "../s.yaml";
    for (const auto kind : compare::tolerance_classes)
        file.baseline.tolerances[kind] = compare::default_tolerances(kind);
    file.baseline.limits = {
        {.of = Quantity::deviation_at_equal_parameter, .channel = "bob_x", .max = 0.1},
        {.of = Quantity::equilibrium, .channel = "bob_x", .max = 1, .unit = "mm"},
        {.of = Quantity::equilibrium, .channel = "bob_z", .min = -3, .unit = "mm", .over = "up"}};
    file.numbers = support::scene("pendulum").numbers;
    const support::Folder folder;
    const auto path = folder.path / "new" / "b.json";
    write_baseline(path, file);
    const BaselineFile again = read_baseline(path);
    EXPECT_EQ(baseline_text(again).review, baseline_text(file).review);
    EXPECT_EQ(baseline_text(again).curves, baseline_text(file).curves);
    ASSERT_EQ(again.baseline.accepted.series.size(), measurement.series.size());
    std::size_t main = 0;
    for (std::size_t k = 0; k < measurement.series.size(); ++k) {
        EXPECT_EQ(again.baseline.accepted.series[k].values, measurement.series[k].values);
        EXPECT_EQ(again.baseline.accepted.series[k].main, measurement.series[k].main);
        main += measurement.series[k].main;
    }
    EXPECT_GT(main, 0u);
    for (std::size_t k = 0; k < measurement.branches.size(); ++k) {
        EXPECT_EQ(again.baseline.accepted.branches[k].unit, measurement.branches[k].unit);
        EXPECT_EQ(again.baseline.accepted.branches[k].a, measurement.branches[k].a);
    }
    EXPECT_EQ(again.baseline.reason, file.baseline.reason);
    ASSERT_EQ(again.baseline.limits.size(), 3u);
    EXPECT_EQ(again.baseline.limits[1].max, 1);
    EXPECT_TRUE(std::isinf(again.baseline.limits[1].min));
    EXPECT_EQ(again.baseline.limits[2].min, -3);
    EXPECT_EQ(again.baseline.limits[2].over, "up");
    EXPECT_FALSE(again.numbers.empty());
    EXPECT_TRUE(compare::changes(file.numbers, again.numbers).empty());
}

TEST(Baseline, InvalidBaselineIsRejectedWithItsPlaceAndNullIsNaN) {
    BaselineFile file = read_baseline(committed("single_bushing"));
    file.baseline.accepted.series[0].values.assign(11, std::nan(""));
    EXPECT_TRUE(std::isnan(
        parse_baseline(baseline_text(file), "b").baseline.accepted.series[0].values.at(10)));
    const BaselineText good = text_of(committed("single_bushing"));
    struct Damage {
        std::string text, answer;
    };
    const auto refused = [](const BaselineText& text, const std::string& answer) {
        try {
            parse_baseline(text, "b.json");
            ADD_FAILURE() << "was read: " << answer;
        } catch (const BaselineError& error) {
            EXPECT_TRUE(std::string_view(error.what()).starts_with("b.json: ") ||
                        std::string_view(error.what()).starts_with("curves/b.json: "))
                << error.what();
            EXPECT_TRUE(support::contains(error.what(), answer)) << answer << ": " << error.what();
        }
    };
    const std::string& review = good.review;
    const auto limits = [&](const std::string& by) {
        return replaced(review, "\"limits\": []", "\"limits\": [" + by + "]");
    };
    for (const auto& [text, answer] : std::vector<Damage>{
             {"", "the file is empty"},
             {" \n", "is not the JSON of a baseline"},
             {std::string(100'000, '['), "nested more than 64 levels deep"},
             {"{}", "has no schema"},
             {"[]", "has no schema"},
             {"null", "has no schema"},
             {review.substr(0, review.size() / 2), "is not the JSON of a baseline"},
             {review.substr(0, review.size() - 3), "is not the JSON of a baseline"},
             {review + "x", "is not the JSON of a baseline"},
             {replaced(review, "baseline/4", "baseline/3"),
              "'elastocheck/baseline/3' cannot be read by this version"},
             {replaced(review, "\"limits\"", "\"limit\""), "limits: missing"},
             {replaced(review, "\"limits\": []", "\"limits\": [], \"more\": 1"),
              "'more' is not known"},
             {limits(R"({"of":"recursive","channel":"x","max":1})"),
              "limits[0].of: 'recursive' is not a deviation"},
             {limits(R"({"of":"deviation at equal parameter","channel":"x"})"),
              "limits[0].max: missing"},
             {limits(R"({"figure":"toe","max":1})"), "limits[0].unit: missing"},
             {limits(R"({"figure":"toe","unit":"deg"})"), "limits[0]: needs min or max"},
             {limits(R"({"figure":"toe","unit":"degree","max":1})"), "'degree' is not known"},
             {limits(R"({"figure":"toe","unit":"deg","maximum":1,"max":1})"),
              "limits[0]: 'maximum' is not known"},
             {limits(R"({"figure":"toe","unit":"deg","max":"1"})"),
              "limits[0].max: expected a number, found string"},
             {replaced(review, "\"atol\"", "\"atoll\""), ".atol: missing"},
             {replaced(review, "\"physical\"", "\"physic\""), "tolerances.physical: missing"},
         })
        refused({text, good.curves}, answer);
    const std::string& curves = good.curves;
    for (const auto& [text, answer] : std::vector<Damage>{
             {"", "the file is empty"},
             {curves.substr(0, curves.size() / 2), "is not the JSON of a baseline"},
             {review, "'elastocheck/baseline/4' cannot be read by this version"},
             {replaced(curves, "\"numbers\": [", "\"numbers\": [[\"a\", 1],"),
              "numbers[0]: is not [path, value, unit]"},
             {replaced(curves, "\"numbers\": [", R"("numbers": [["a", "1", "m"],)"),
              "numbers[0][1]: expected a number, found string"},
             {replaced(curves, "\"numbers\": [", R"("numbers": [["a", 1, 2],)"),
              "numbers[0][2]: expected text, found number"},
             {replaced(curves, " [mm]\": [", " [mm]\": [\"0\","),
              "[0]: expected a number, found string"},
             {replaced(curves, " [mm]", " [inch]"), "the unit 'inch' is not known"},
             {replaced(curves, " [mm]", ""), "is not a name with its [unit]"},
             {replaced(curves, "\"main\"", "\"mains\""), "main: missing"},
             {replaced(curves, "\"recursive\"", "\"recursiv\""), "'recursiv' is not known"},
             {replaced(curves, "centre_", "x\\n::error::"), "control character U+000A"},
             {replaced(curves, "centre_", "\xE2\x80\xAE"), "changes the direction of writing"},
         })
        refused({review, text}, answer);
}

TEST(Baseline, FiguresAndCurvesOfDifferentAcceptancesAreRejected) {
    const support::Folder folder;
    const auto path = folder.path / "b.json";
    const BaselineFile good = read_baseline(committed("pinned_bar"));
    const auto refused = [&](const std::string& answer) {
        try {
            read_baseline(path);
            ADD_FAILURE() << "was read: " << answer;
        } catch (const BaselineError& error) {
            EXPECT_TRUE(support::contains(error.what(), answer)) << answer << ": " << error.what();
        }
    };
    write_baseline(path, good);
    (void)read_baseline(path);
    // a figure that a person has edited
    const std::string text = read_whole(path);
    const auto first = text.find("\"tip_");
    ASSERT_NE(first, text.npos);
    folder.write("b.json", text.substr(0, first) + replaced(text.substr(first), ": [", ": [7,"));
    refused("figures: are not those of the accepted curves");
    // a number of the curves, however small
    folder.write("b.json", text);
    BaselineFile other = good;
    other.baseline.accepted.series.front().values.back() += 1e-9;
    folder.write("curves/b.json", baseline_text(other).curves);
    refused("curves.hash: ");
    folder.write("b.json", baseline_text(other).review);
    (void)read_baseline(path);
    std::filesystem::remove(folder.path / "curves/b.json");
    EXPECT_THROW(read_baseline(path), FileError);
}

TEST(Baseline, BuildsWithEqualCompilerFlagsAndCpuAreTheSame) {
    const Provenance here = provenance();
    EXPECT_EQ(distance(here, here).kind, ToleranceClass::same_build);
    Provenance other = here;
    other.commit = "another", other.dirty = !here.dirty, other.version = "9";
    EXPECT_EQ(distance(here, other).kind, ToleranceClass::same_build);
    for (std::string Provenance::*field :
         {&Provenance::compiler, &Provenance::flags, &Provenance::cpu}) {
        other = here;
        other.*field += "!";
        EXPECT_EQ(distance(here, other).kind, ToleranceClass::cross_build);
        EXPECT_TRUE(support::contains(distance(here, other).differs, "!"));
    }
    other = here;
    other.libraries[0].version = "0";
    EXPECT_EQ(distance(here, other).kind, ToleranceClass::cross_build);
}

TEST(Baseline, UncommittedBaselineIsNotReviewed) {
    const support::Folder folder;
    const auto git = [&](const std::string& arguments) {
        return support::says(
                   "git -C " + folder.path.string() +
                   " -c user.name=t -c user.email=t@example.org -c init.defaultBranch=main " +
                   arguments)
            .code;
    };
    const std::string file = folder.write("it's.json", "1");
    EXPECT_EQ(not_committed(file), "it is not committed to a git repository");
    ASSERT_EQ(git("init -q"), 0);
    EXPECT_EQ(not_committed(file), "it is not committed to a git repository");
    ASSERT_EQ(git("add ."), 0);
    EXPECT_EQ(not_committed(file), "it is not committed to a git repository");
    ASSERT_EQ(git("commit -q -m x"), 0);
    EXPECT_EQ(not_committed(file), "");
    folder.write("it's.json", "2");
    EXPECT_EQ(not_committed(file), "it differs from what is committed");
    ASSERT_EQ(git("add ."), 0);
    EXPECT_EQ(not_committed(file), "it differs from what is committed");
}

}  // namespace
}  // namespace elastocheck::reports
