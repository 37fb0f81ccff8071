// Baseline files: what is written is read again, and nothing misspelt is read as something else.
#include "reports/gate/baseline.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <cstdlib>

#include "compare/comparison/changes.hpp"
#include "elastocheck/compile.hpp"
#include "reports/files/files.hpp"
#include "tests/support/command.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

using compare::Quantity;
using compare::ToleranceClass;

std::string committed(const std::string& scene) {
    return read_whole(std::string(ELASTOCHECK_SCENES) + "/baselines/" + scene + ".json");
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

TEST(Baseline, IsReadAndWrittenWithoutChangingALetter) {
    for (const auto& scene : support::scene_names()) {
        const std::string text = committed(scene);
        EXPECT_EQ(baseline_text(parse_baseline(text, scene)), text) << scene;
    }
}

TEST(Baseline, IsSmallEnoughToReview) {
    for (const auto& scene : support::scene_names()) {
        const std::string text = committed(scene);
        const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n'));
        EXPECT_LT(text.size(), 200 * lines) << scene;  // one line a curve, eleven numbers
        EXPECT_NE(parse_baseline(text, scene).baseline.reason, "") << scene;
    }
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
    file.baseline.limits = {{Quantity::deviation_at_equal_parameter, "bob_x", 0.1}};
    EXPECT_FALSE(parse_baseline(baseline_text(file), "of before numbers were kept").numbers);
    file.numbers = support::scene("pendulum").numbers;
    const BaselineFile again = parse_baseline(baseline_text(file), "s");
    EXPECT_EQ(baseline_text(again), baseline_text(file));
    ASSERT_EQ(again.baseline.accepted.series.size(), measurement.series.size());
    for (std::size_t k = 0; k < measurement.series.size(); ++k)
        EXPECT_EQ(again.baseline.accepted.series[k].values, measurement.series[k].values);
    for (std::size_t k = 0; k < measurement.branches.size(); ++k) {
        EXPECT_EQ(again.baseline.accepted.branches[k].unit, measurement.branches[k].unit);
        EXPECT_EQ(again.baseline.accepted.branches[k].a, measurement.branches[k].a);
    }
    EXPECT_EQ(again.baseline.reason, file.baseline.reason);
    EXPECT_EQ(again.baseline.limits.size(), 1u);
    ASSERT_TRUE(again.numbers && !again.numbers->empty());
    EXPECT_TRUE(compare::changes(*file.numbers, *again.numbers).empty());
}

TEST(Baseline, WhatIsNotOneIsRefusedWithItsPlace) {
    const std::string good = committed("single_bushing");
    BaselineFile without = parse_baseline(good, "");
    without.numbers.reset();
    const std::string older = baseline_text(without);
    struct Damage {
        std::string text, answer;
    };
    for (const auto& [text, answer] : std::vector<Damage>{
             {"", "the file is empty"},
             {" \n", "is not the JSON of a baseline"},
             {std::string(100'000, '['), "nested more than 64 deep"},
             {replaced(good, "\"branch\":\"", "\"branch\":\"x\\n::error::"),
              "control character U+000A"},
             {replaced(good, "\"branch\":\"", "\"branch\":\"\xE2\x80\xAE"),
              "turns the direction of writing"},
             {"{}", "has no schema"},
             {"[]", "has no schema"},
             {"null", "has no schema"},
             {good.substr(0, good.size() / 2), "is not the JSON of a baseline"},
             {good.substr(0, good.size() - 3), "is not the JSON of a baseline"},
             {good + "x", "is not the JSON of a baseline"},
             {replaced(good, "baseline/2", "baseline/1"),
              "'elastocheck/baseline/1' cannot be read by this version"},
             {replaced(good, "\"limits\"", "\"limit\""), "limits: missing"},
             {replaced(older, "\"limits\"", "\"numbers\": {}, \"limits\""),
              "numbers: expected a list, found object"},
             {replaced(older, "\"limits\"", R"("numbers": [["a", 1]], "limits")"),
              "numbers[0]: is not [path, value, unit]"},
             {replaced(older, "\"limits\"", R"("numbers": [["a", "1", "m"]], "limits")"),
              "numbers[0][1]: expected a number, found string"},
             {replaced(older, "\"limits\"", R"("numbers": [["a", 1, 2]], "limits")"),
              "numbers[0][2]: expected text, found number"},
             {replaced(good, "\"limits\": []", "\"limits\": [], \"more\": 1"),
              "'more' is not known"},
             {replaced(good, "\"limits\": []",
                       R"("limits": [{"of":"recursive","channel":"x","max":1}])"),
              "limits[0].of: 'recursive' is not known"},
             {replaced(good, "\"limits\": []",
                       R"("limits": [{"of":"deviation at equal parameter","channel":"x"}])"),
              "limits[0].max: missing"},
             {replaced(good, "\"atol\"", "\"atoll\""), ".atol: missing"},
             {replaced(good, "\"physical\"", "\"physic\""), "tolerances.physical: missing"},
             {replaced(good, "\"values\":[100.0", "\"values\":[\"0\""),
              ".values[0]: expected a number, found string"},
             {replaced(good, "\"unit\":\"mm\"", "\"unit\":\"inch\""), "'inch' is not known"},
             {replaced(good, "\"of\":\"recursive\"", "\"of\":\"recursiv\""),
              "'recursiv' is not known"},
             {replaced(good, "\"of\":\"equilibrium\"", "\"of\":\"recursive\""), "is given twice"},
         }) {
        try {
            parse_baseline(text, "b.json");
            ADD_FAILURE() << "was read: " << answer;
        } catch (const BaselineError& error) {
            EXPECT_TRUE(support::contains(error.what(), "b.json: ")) << error.what();
            EXPECT_TRUE(support::contains(error.what(), answer)) << answer << ": " << error.what();
        }
    }
}

TEST(Baseline, ANullIsNoNumber) {
    const auto file = parse_baseline(
        replaced(committed("single_bushing"), "\"values\":[100.0", "\"values\":[null"), "b");
    EXPECT_TRUE(std::isnan(file.baseline.accepted.series[0].values[0]));
}

TEST(Baseline, BuildsAreTheSameOnlyWhenNothingThatRoundsDiffers) {
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

TEST(Baseline, OnlyWhatIsCommittedCanHaveBeenReviewed) {
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
