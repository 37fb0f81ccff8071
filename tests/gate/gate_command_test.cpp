// `elastocheck gate` as a user and as CI run it: exit code for every kind of damage.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>

#include "reports/gate/baseline.hpp"
#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

using nlohmann::ordered_json;

const std::string scene = scenes + "/single_bushing.yaml";
using compare::Quantity;
using reports::BaselineFile;
using reports::BaselineText;

const std::filesystem::path baselines = scenes + "/baselines";
const BaselineFile as_committed = reports::read_baseline(baselines / "single_bushing.json");

// Not in CI, whatever the tests themselves run in.
Said gate(const std::string& arguments, const std::string& environment = "CI= GITHUB_ACTIONS=") {
    return support::says("env " + environment + " " + ELASTOCHECK_COMMAND + " gate " + arguments);
}

// The scene against the committed baseline, edited first.
Said crafted(const BaselineText& baseline, const std::string& how = "") {
    const Folder folder;
    std::filesystem::create_directory(folder.path / "curves");
    folder.write("single_bushing.json", baseline.review);
    folder.write("curves/single_bushing.json", baseline.curves);
    return gate(scene + how + " --quiet --baseline " + folder.path.string());
}

using Edit = std::function<void(BaselineFile&)>;
BaselineText edited(const Edit& edit) {
    BaselineFile file = as_committed;
    edit(file);
    return reports::baseline_text(file);
}
std::vector<compare::Series>& series(BaselineFile& file) { return file.baseline.accepted.series; }
compare::Series& first_moving(BaselineFile& file) {  // a curve whose end is not where it starts
    for (auto& s : series(file))
        if (s.values.back() != s.values.front()) return s;
    return series(file)[0];
}

// Of the judgement itself: tests/gate/judge_test.cpp.
TEST(GateCommand, EachDamageOfABaselineHasItsExitCode) {
    const BaselineText good = reports::baseline_text(as_committed);
    struct Case {
        const char* what;
        int code;
        BaselineText baseline;
    };
    const auto set_first = [&](double value) {
        return edited([&](auto& file) {
            for (auto& s : series(file))
                if (s.unit == "mm") return void(s.values[0] = value);
        });
    };
    const auto truncated = [](const std::string& text) {
        return text.substr(0, text.size() * 2 / 3);
    };
    const auto replaced = [&](const std::string& what, const std::string& by) {
        BaselineText text = good;
        const auto at = text.review.find(what);
        EXPECT_NE(at, std::string::npos) << what;
        text.review.replace(at, what.size(), by);
        return text;
    };
    const auto limited = [&](const compare::Limit& limit) {
        return edited([&](auto& f) { f.baseline.limits = {limit}; });
    };
    const auto nan = edited([&](auto&f) { first_moving(f).values.back() = std::nan(""); }),
               nothing =
                   edited([](auto&f) { series(f).clear(), f.baseline.accepted.branches.clear(); });
    constexpr auto at_load = Quantity::deviation_at_equal_parameter, figure = Quantity::equilibrium;
    const std::vector<Case> cases{
        {"as accepted", 0, good},
        {"NaN accepted", 3, nan},
        {"no numbers accepted", 3, nothing},
        {"empty", 3, {}},
        {"a number off", 1, set_first(1)},
        {"older", 3, replaced("baseline/4", "baseline/3")},
        {"truncated", 3, {truncated(good.review), good.curves}},
        {"truncated curves", 3, {good.review, truncated(good.curves)}},
        {"curves of another acceptance", 3, {good.review, set_first(0).curves}},
        {"figures of another acceptance", 3, {set_first(0).review, good.curves}},
        {"a bound that is not a number", 3,
         replaced("\"mm\":{\"atol\":2e-09", "\"mm\":{\"atol\":null")},
        {"an infinite bound", 3,  // 1e999 is no JSON number that a double holds
         replaced("\"atol\":2e-09", "\"atol\":1e999")},
        {"a limit that holds", 0, limited({at_load, "centre_z", 1e6})},
        {"a limit on nothing", 3, limited({at_load, "centre", 1e6})},
        {"a limit on a figure that holds", 0,
         limited({.of = figure, .channel = "centre_z", .max = 1e6, .unit = "mm"})},
        {"a limit on a figure that is broken", 1,
         limited({.of = figure, .channel = "centre_z", .max = -1e6, .unit = "mm"})},
        {"a limit over a branch that is not there", 3,
         limited({.of = figure, .channel = "centre_z", .max = 1e6, .unit = "mm", .over = "x"})},
    };
    for (const auto& [what, code, baseline] : cases) {
        const Said said = crafted(baseline, " --class same-build");
        EXPECT_EQ(said.code, code) << what << "\n" << said.out << said.err;
        EXPECT_EQ(contains(said.out, "passed:"), code == 0) << what << "\n" << said.out;
        EXPECT_TRUE(code != 3 || contains(said.out, "could not judge: ")) << what << "\n"
                                                                          << said.out;
    }
}

// "Bump steer at most 2 deg/m", as a person writes it.
TEST(GateCommand, LimitsOnFiguresAreJudgedAndMisspeltNamesCorrected) {
    const BaselineFile axle = reports::read_baseline(baselines / "front_axle.json");
    const Folder folder;
    const auto judged = [&](const std::string& limit) {
        reports::write_baseline(folder.path / "front_axle.json", axle);
        std::string text = text_of(folder.path / "front_axle.json");
        const auto at = text.find("\"limits\": []");
        EXPECT_NE(at, text.npos);
        text.replace(at, 12, "\"limits\": [" + limit + "]");
        folder.write("front_axle.json", text);
        return gate(scenes + "/front_axle.yaml --baseline " + folder.path.string());
    };
    // -2.16 deg/m at the design position, -8.8 to -1.9 deg/m over the branch
    Said said = judged(R"({"figure": "bump_steer", "unit": "deg/m", "min": -3, "max": 3},
        {"figure": "bump_steer", "unit": "deg/m", "min": -9, "over": "parallel"})");
    EXPECT_EQ(said.code, 0) << said.out << said.err;
    said = judged(R"({"figure": "bump_steer", "unit": "deg/m", "min": -2, "max": 2})");
    EXPECT_EQ(said.code, 1) << said.out << said.err;
    expect_parts(said.out, {"left.bump_steer ", "right.bump_steer "});
    said = judged(
        R"({"figure": "left.bump_steer", "unit": "deg/m", "min": -3, "max": 3, "over": "parallel"})");
    EXPECT_EQ(said.code, 1) << said.out << said.err;
    expect_parts(said.out, {}, {"right.bump_steer "});
    said = judged(R"({"figure": "bump_ster", "unit": "deg/m", "max": 2},
        {"figure": "toe", "unit": "deg", "max": 2, "over": "paralel"})");
    EXPECT_EQ(said.code, 3);
    expect_parts(said.out, {"limit on bump_ster: nothing of that name was measured, did "
                            "you mean 'bump_steer'?",
                            "there is no branch 'paralel', did you mean 'parallel'?"});
}

TEST(GateCommand, MissingBaselineIsNotJudgedAndMissingSceneIsBadInput) {
    const Folder folder;
    const std::string there = " --baseline " + folder.path.string();
    expect_said(gate(scene + there), 3, {.out = {"there is no baseline"}});
    expect_said(gate(there), 3);  // a folder without baselines
    expect_said(gate("--baseline /nowhere/at/all"), 3);
    expect_said(gate("nowhere.yaml" + there), 2);
    expect_said(gate(scene + " --class none"), 2);
    expect_said(gate(scene + " --reason why"), 2);
}

TEST(GateCommand, AcceptRequiresAReasonAndIsRefusedInCi) {
    const Folder folder;
    const std::string accept = scene + " --baseline " + folder.path.string() + " --accept";
    for (const char* reason : {"", " --reason ''", " --reason ' '"})
        expect_said(gate(accept + reason), 2, {.err = {"--reason"}});
    for (const char* ci : {"CI=true", "CI=1"})
        expect_said(gate(accept + " --reason why", ci), 2, {.err = {"not in CI"}});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

TEST(GateCommand, AcceptedScenePassesAndAChangedOneFails) {
    const Folder folder;
    const std::string own = folder.write("own.yaml", text_of(scene)),
                      baseline = folder.path / "baselines/own.json";
    Said said = expect_said(gate(own + " --accept --reason 'first of all'"), 0);
    EXPECT_EQ(reports::read_baseline(baseline).baseline.reason, "first of all");
    expect_said(gate(own), 0, {.out = {"same-build"}});
    expect_said(gate("--baseline " + (folder.path / "baselines").string()), 0);  // finds its scene

    // The same again is no reason to touch the file.
    expect_said(gate(own + " --accept --reason 'again'"), 0);
    EXPECT_EQ(reports::read_baseline(baseline).baseline.reason, "first of all");

    std::string changed = text_of(scene);
    const auto rates = changed.find("rates: [");
    ASSERT_NE(rates, changed.npos);
    changed = changed.substr(0, rates) + "rates: [1" + changed.substr(rates + 8);
    folder.write("own.yaml", changed);
    said = expect_said(gate(own + " --junit " + (folder.path / "j.xml").string() + " --summary " +
                            (folder.path / "s.md").string()),
                       1, {.out = {"FAILED", "the scene file differs from the accepted one"}});
    EXPECT_TRUE(std::regex_search(
        said.out, std::regex("\n  changed: bushings\\.[a-z_]+\\.rates\\.x: 1[0-9]+ .*, was ")))
        << said.out;
    expect_parts(text_of(folder.path / "j.xml"), {"<failure message="});
    expect_parts(text_of(folder.path / "s.md"), {"# elastocheck gate: FAILED"});
    expect_parts(said.out, {}, {"::error"});
    expect_parts(gate(own, "GITHUB_ACTIONS=true CI=").out, {"\n::error file="});

    // By --set too, where the file is as it was; by a comment alone no number changes.
    folder.write("own.yaml", text_of(scene));
    const std::string path = reports::read_baseline(baseline).numbers.back().path;
    said = gate(own + " --set " + path + "=7");
    expect_parts(said.out, {"  changed: " + path + ": 7"});
    folder.write("own.yaml", text_of(scene) + "# a comment\n");
    expect_said(gate(own), 0, {.out = {"; none of its numbers changed"}});

    folder.write("own.yaml", changed);

    // Accepting prints the difference first, and keeps what was set by hand.
    ordered_json file = ordered_json::parse(text_of(baseline));
    file["tolerances"]["physical"]["mm"]["atol"] = 0.5;
    file["limits"] = {
        {{"of", "deviation at equal parameter"}, {"channel", "centre_z"}, {"max", 1e6}},
        {{"figure", "centre_z"}, {"unit", "mm"}, {"max", 1e6}, {"over", "pull"}}};
    folder.write("baselines/own.json", file.dump());
    expect_said(gate(own + " --accept --reason 'stiffer'"), 0,
                {.out = {"numbers out of tolerance, same-build (every change beyond rounding)"}});
    const auto accepted = reports::read_baseline(baseline).baseline;
    EXPECT_EQ(accepted.reason, "stiffer");
    EXPECT_EQ(accepted.limits.size(), 2u);
    EXPECT_EQ(accepted.tolerances.at(compare::ToleranceClass::physical).at("mm").atol, 0.5);
    expect_said(gate(own), 0);
}

TEST(GateCommand, AcceptIsRefusedBeyondALimitOrIfNotJudged) {
    const Folder folder;
    const std::string own = folder.write("own.yaml", text_of(scenes + "/pinned_bar.yaml")),
                      baseline = folder.path / "baselines/own.json";
    ASSERT_EQ(gate(own + " --accept --reason first").code, 0);
    BaselineFile file = reports::read_baseline(baseline);
    std::string channel;
    for (const auto& s : series(file))
        if (s.quantity == Quantity::deviation_at_equal_parameter && s.unit == "mm" &&
            s.values[0] > 0)
            channel = s.channel;
    ASSERT_NE(channel, "");
    file.baseline.limits = {{Quantity::deviation_at_equal_parameter, channel, -0.0}};
    const std::string limited = reports::baseline_text(file).review;
    folder.write("baselines/own.json", limited);
    expect_said(gate(own), 1);
    expect_said(gate(own + " --accept --reason second"), 1,
                {.out = {"an absolute limit is broken"}});
    EXPECT_EQ(text_of(baseline), limited);

    folder.write("baselines/own.json", "{");
    expect_said(gate(own + " --accept --reason third"), 3);
    EXPECT_EQ(text_of(baseline), "{");

    std::string arch = text_of(scenes + "/two_spring_arch.yaml");
    arch.replace(arch.find("to: -200"), 8, "to: -300");
    expect_said(gate(folder.write("arch.yaml", arch) + " --accept --reason fourth"), 3,
                {.err = {"not accepted: branch 'down': "}});
    EXPECT_FALSE(std::filesystem::exists(folder.path / "baselines/arch.json"));
}

TEST(GateCommand, BaselineOfTheSameRunIsNotJudgedInCi) {
    const Folder folder;
    const std::string own = folder.write("own.yaml", text_of(scene));
    const auto git = [&](const std::string& arguments) {
        return support::says("git -C " + folder.path.string() +
                             " -c user.name=t -c user.email=t@example.org " + arguments);
    };
    ASSERT_EQ(git("init -q").code, 0);
    ASSERT_EQ(gate(own + " --accept --reason copy").code, 0);  // CI unset on purpose
    expect_said(gate(own), 0);
    expect_said(gate(own, "CI=true"), 3, {.out = {"is unreviewed"}});
    git("add .");
    ASSERT_EQ(git("commit -q -m reviewed").code, 0);
    expect_said(gate(own, "CI=true"), 0);
    std::ofstream(folder.path / "baselines/own.json", std::ios::app) << "\n";
    expect_said(gate(own, "CI=true"), 3);
}

TEST(GateCommand, OneBadSceneDoesNotHideTheOthers) {
    const Folder folder;
    folder.write("bad.yaml", "elastocheck: 1\n");
    folder.write("good.yaml", text_of(scene));
    const std::string good = (folder.path / "good.yaml").string(),
                      bad = (folder.path / "bad.yaml").string();
    ASSERT_EQ(gate(good + " --accept --reason first").code, 0);
    expect_said(gate(bad + " " + good), 2, {.out = {"bad.yaml: BAD INPUT", "good.yaml: passed"}});
}

TEST(GateCommand, NamesTolerancesWiderThanThoseOfTheClassInItsFirstLine) {
    expect_parts(crafted(reports::baseline_text(as_committed)).out, {}, {"wider"});
    const Said said = crafted(edited([](BaselineFile& file) {
        for (auto& [kind, tolerances] : file.baseline.tolerances)
            tolerances.at("mm").atol = tolerances.at("mm").rtol = 1e9;
    }));
    expect_said(said, 0);
    EXPECT_TRUE(contains(said.out.substr(0, said.out.find('\n')),
                         ", with tolerances wider than those of the class: mm: atol 1e+09, mm: "
                         "rtol 1e+09"))
        << said.out;
}

TEST(GateCommand, RefusesALimitWithMinAboveMaxWithItsLine) {
    const BaselineText text = edited([](BaselineFile& file) {
        file.baseline.limits = {
            {.of = Quantity::equilibrium, .channel = "a", .max = 1, .unit = "mm"},
            {.of = Quantity::equilibrium, .channel = "b", .max = 1, .min = 2, .unit = "mm"}};
    });
    const std::string before = text.review.substr(0, text.review.find("\"b\""));
    expect_said(
        crafted(text), 2,
        {.out = {"single_bushing.json:" + std::to_string(1 + std::ranges::count(before, '\n')) +
                 ": limits.2: min 2 is above max 1"}});
}

}  // namespace
}  // namespace elastocheck
