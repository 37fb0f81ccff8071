// `elastocheck gate` as a user and as CI run it: exit code for every kind of damage.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "reports/gate/baseline.hpp"
#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

const std::string scene = scenes + "/single_bushing.yaml";
using compare::Quantity;
using reports::BaselineFile;
using reports::BaselineText;

const std::filesystem::path baselines = scenes + "/baselines";
const BaselineFile as_committed = reports::read_baseline(baselines / "single_bushing.json");

// Not in CI, whatever the tests themselves run in.
RunResult gate(const std::string& arguments,
               const std::string& environment = "CI= GITHUB_ACTIONS=") {
    return support::shell("env " + environment + " " + ELASTOCHECK_COMMAND + " gate " + arguments);
}

// The scene against the committed baseline, edited first.
RunResult crafted(const BaselineText& baseline, const std::string& how = "") {
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

// The judgement itself is tested in tests/gate/judge_test.cpp.
TEST(GateCommand, EveryKindOfDamageToABaselineHasItsExitCode) {
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
        const RunResult said = crafted(baseline, " --class same-build");
        EXPECT_EQ(said.code, code) << what << "\n" << said.out << said.err;
        EXPECT_EQ(contains(said.out, "passed:"), code == 0) << what << "\n" << said.out;
        EXPECT_TRUE(code != 3 || contains(said.out, "could not judge: ")) << what << "\n"
                                                                          << said.out;
    }
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
    expect_result(gate(own), 1);
    expect_result(gate(own + " --accept --reason second"), 1,
                  {.out = {"an absolute limit is broken"}});
    EXPECT_EQ(text_of(baseline), limited);

    folder.write("baselines/own.json", "{");
    expect_result(gate(own + " --accept --reason third"), 3);
    EXPECT_EQ(text_of(baseline), "{");

    std::string arch = text_of(scenes + "/two_spring_arch.yaml");
    arch.replace(arch.find("to: -200"), 8, "to: -300");
    expect_result(gate(folder.write("arch.yaml", arch) + " --accept --reason fourth"), 3,
                  {.err = {"not accepted: branch 'down': "}});
    EXPECT_FALSE(std::filesystem::exists(folder.path / "baselines/arch.json"));
}

TEST(GateCommand, NamesTolerancesWiderThanThoseOfTheClassInItsFirstLine) {
    expect_parts(crafted(reports::baseline_text(as_committed)).out, {}, {"wider"});
    const RunResult said = crafted(edited([](BaselineFile& file) {
        for (auto& [kind, tolerances] : file.baseline.tolerances)
            tolerances.at("mm").atol = tolerances.at("mm").rtol = 1e9;
    }));
    expect_result(said, 0);
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
    expect_result(
        crafted(text), 2,
        {.out = {"single_bushing.json:" + std::to_string(1 + std::ranges::count(before, '\n')) +
                 ": limits.2: min 2 is above max 1"}});
}

}  // namespace
}  // namespace elastocheck
