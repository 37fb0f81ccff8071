// Baseline files: what is written is read again, and nothing misspelt is read as something else.
#include "reports/gate/baseline.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "compare/comparison/changes.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "reports/files/files.hpp"
#include "tests/reports/command.hpp"
#include "tests/support/mistakes.hpp"
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

TEST(Baseline, ReadingAndWritingKeepsTheText) {
    for (const auto& scene : support::scene_names()) {
        const BaselineText was = text_of(committed(scene)),
                           is = baseline_text(read_baseline(committed(scene)));
        EXPECT_EQ(is.review, was.review) << scene;
        EXPECT_EQ(is.curves, was.curves) << scene;
    }
}

// A figure is a line of few digits at five to nine stations.
TEST(Baseline, FilesOfBuiltInScenesAreShortEnoughToReview) {
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

TEST(Baseline, TieRodMovedByTwoMillimetresRewritesTensOfLines) {
    const auto lines = [](const char* height) {
        const Setting moved{"points.tie_rod_inner.z", height};  // [m]
        const Model model = compile(read_scene(
            std::string(ELASTOCHECK_SCENES) + "/double_wishbone.yaml", std::span(&moved, 1)));
        BaselineFile file;
        file.baseline.accepted = compare::measure(model, compare::compare(model));
        return parts_of(baseline_text(file).review, '\n');
    };
    const auto was = lines("0.001"), is = lines("0.003");
    ASSERT_EQ(was.size(), is.size());
    std::size_t changed = 0;
    for (std::size_t k = 0; k < was.size(); ++k) changed += was[k] != is[k];
    EXPECT_GT(changed, 10u);
    EXPECT_LT(changed, 90u);
}

// Both wheels of a symmetric axle are on one line, on two where they differ.
TEST(Baseline, EqualFiguresOfBothWheelsShareALine) {
    BaselineFile file = read_baseline(committed("front_axle"));
    const auto lines_with = [&](const std::string& key) {
        const auto parts = parts_of(baseline_text(file).review, '\n');
        return static_cast<std::size_t>(std::ranges::count_if(parts, [&](const auto& line) {
            return support::contains(line, '"' + key + " [deg]\"");
        }));
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

TEST(Baseline, EveryNumberOfAMeasurementIsWrittenAndReadBack) {
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

TEST(Baseline, NaNIsWrittenAsNullAndReadBack) {
    BaselineFile file = read_baseline(committed("single_bushing"));
    file.baseline.accepted.series[0].values.assign(11, std::nan(""));
    EXPECT_TRUE(std::isnan(
        parse_baseline(baseline_text(file), "b").baseline.accepted.series[0].values.at(10)));
}

// The message with which a baseline is refused.
std::string refusal(const auto& read) {
    try {
        read();
    } catch (const BaselineError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Baseline, InvalidBaselineIsRejectedWithItsPlace) {
    const BaselineText good = text_of(committed("single_bushing"));
    const auto folder = std::filesystem::path(ELASTOCHECK_SCENES) / "../../tests/gate";
    const auto of_review = [&](const std::string& text) {
        return refusal([&] { parse_baseline({text, good.curves}, "b.json"); });
    };
    const auto of_curves = [&](const std::string& text) {
        return refusal([&] { parse_baseline({good.review, text}, "b.json"); });
    };
    support::expect_refusals(folder / "baseline.mistakes", good.review, "b.json", of_review);
    support::expect_refusals(folder / "baseline_curves.mistakes", good.curves, "curves/b.json",
                             of_curves);
    const std::string half = " is not the JSON of a baseline";
    for (const std::size_t cut : {good.review.size() / 2, good.review.size() - 3})
        EXPECT_TRUE(support::contains(of_review(good.review.substr(0, cut)), "b.json:" + half));
    EXPECT_TRUE(support::contains(of_curves(good.curves.substr(0, good.curves.size() / 2)),
                                  "curves/b.json:" + half));
    EXPECT_TRUE(
        support::contains(of_review(std::string(100'000, '[')), "nested more than 64 levels deep"));
}

TEST(Baseline, FiguresAndCurvesOfDifferentAcceptancesAreRejected) {
    const support::Folder folder;
    const auto path = folder.path / "b.json";
    const auto said = [&] { return refusal([&] { (void)read_baseline(path); }); };
    const BaselineFile good = read_baseline(committed("pinned_bar"));
    write_baseline(path, good);
    EXPECT_EQ(said(), "accepted");
    // a figure that a person has edited
    const std::string text = read_whole(path);
    const auto first = text.find(": [", text.find("\"tip_"));
    ASSERT_NE(first, text.npos);
    folder.write("b.json", std::string(text).insert(first + 3, "7,"));
    EXPECT_TRUE(support::contains(said(), "figures: are not those of the accepted curves"));
    // a number of the curves, however small
    folder.write("b.json", text);
    BaselineFile other = good;
    other.baseline.accepted.series.front().values.back() += 1e-9;
    folder.write("curves/b.json", baseline_text(other).curves);
    EXPECT_TRUE(support::contains(said(), "curves.hash: "));
    folder.write("b.json", baseline_text(other).review);
    EXPECT_EQ(said(), "accepted");
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

}  // namespace
}  // namespace elastocheck::reports
