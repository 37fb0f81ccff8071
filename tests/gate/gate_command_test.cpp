// `elastocheck gate` as a user and as CI run it: exit code for every kind of damage.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>

#include "reports/gate/baseline.hpp"
#include "tests/support/command.hpp"

namespace {

using namespace elastocheck;
using nlohmann::ordered_json;
using support::contains;
using support::Folder;
using support::Said;
using support::text_of;

const std::string scenes = ELASTOCHECK_SCENES;
const std::string scene = scenes + "/single_bushing.yaml";
const std::string committed = text_of(scenes + "/baselines/single_bushing.json");

// Not in CI, whatever the tests themselves run in.
Said gate(const std::string& arguments, const std::string& environment = "CI= GITHUB_ACTIONS=") {
    return support::says("env " + environment + " " + ELASTOCHECK_COMMAND + " gate " + arguments);
}

// The committed baseline against itself as a measurement, either of them edited first. Nothing is solved.
Said crafted(const std::string& baseline, const std::string& measurement) {
    const Folder folder;
    folder.write("single_bushing.json", baseline);
    return gate(scene + " --baseline " + folder.path.string() + " --from " +
                folder.write("m", measurement));
}

using Edit = std::function<void(ordered_json&)>;
std::string edited(const Edit& edit) {
    ordered_json file = ordered_json::parse(committed);
    edit(file);
    return file.dump();
}
ordered_json& first_moving(ordered_json& file) {  // a curve whose end is not where it starts
    for (auto& s : file["series"])
        if (s["values"].back() != s["values"].front()) return s;
    return file["series"][0];
}

TEST(GateCommand, EveryKindOfDamageHasItsExitCode) {
    const std::string& good = committed;
    struct Case {
        const char* what;
        int code;
        std::string baseline, measurement;
    };
    const double atol = ordered_json::parse(good)["tolerances"]["same-build"]["mm"]["atol"];
    const Edit set_to_zero = [](auto& file) {
        for (auto& s : file["series"])
            if (s["unit"] == "mm") return void(s["values"][0] = 0.0);
    };
    const auto set_first = [&](double value) {
        return edited([&](auto& file) {
            for (auto& s : file["series"])
                if (s["unit"] == "mm") return void(s["values"][0] = value);
        });
    };
    const auto truncated = [&](const std::string& text) {
        return text.substr(0, text.size() * 2 / 3);
    };
    const std::string nan = edited([](auto& f) { first_moving(f)["values"].back() = nullptr; });
    const std::string less = edited([](auto& f) { f["series"].erase(f["series"].begin()); });
    const std::string fewer = edited([](auto& f) { first_moving(f)["values"].erase(3); });
    const std::string swapped = edited([](auto& f) {
        auto& moving = first_moving(f);
        for (auto& s : f["series"])
            if (s["unit"] == moving["unit"] && s["of"] == moving["of"] &&
                s["values"] != moving["values"])
                return std::swap(s["values"], moving["values"]);
    });
    const std::string older = edited([](auto& f) { f["schema"] = "elastocheck/baseline/1"; });
    const std::string nothing = edited([](auto& f) { f["series"].clear(), f["branches"].clear(); });
    const std::string other_scene = edited([](auto& f) { f["scene"]["name"] = "another"; });
    const std::string elsewhere = edited([](auto& f) { f["branches"][0]["parameter"][5] = 1.0; });
    const std::vector<Case> cases{
        {"as accepted", 0, good, good},
        {"NaN measured", 3, good, nan},
        {"NaN accepted", 3, nan, good},
        {"NaN in both", 3, nan, nan},
        {"a channel vanished", 3, good, less},
        {"a channel is new", 3, less, good},
        {"fewer points measured", 3, good, fewer},
        {"fewer points accepted", 3, fewer, good},
        {"no numbers measured", 3, good, nothing},
        {"no numbers accepted", 3, nothing, good},
        {"no numbers in both", 3, nothing, nothing},
        {"empty measurement", 3, good, ""},
        {"empty baseline", 3, "", good},
        {"on the tolerance", 0, edited(set_to_zero), set_first(atol)},
        {"one ulp over", 1, edited(set_to_zero), set_first(std::nextafter(atol, 1))},
        {"one ulp under", 1, edited(set_to_zero), set_first(std::nextafter(-atol, -1))},
        {"swapped channels", 1, good, swapped},
        {"older measurement", 3, good, older},
        {"older baseline", 3, older, good},
        {"truncated measurement", 3, good, truncated(good)},
        {"truncated baseline", 3, truncated(good), good},
        {"another scene", 3, good, other_scene},
        {"other parameters", 3, good, elsewhere},
        {"no reason", 3, edited([](auto& f) { f["accepted"]["reason"] = ""; }), good},
        {"a bound that is no number", 3,
         edited([](auto& f) { f["tolerances"]["same-build"]["mm"]["atol"] = nullptr; }), good},
        {"an infinite bound", 3,  // 1e999 is no JSON number that a double holds
         std::string(good).replace(good.find("\"atol\":"), 7, "\"atol\":1e999,\"x\":"), good},
        {"a limit that holds", 0, edited([](auto& f) {
             f["limits"] = {
                 {{"of", "deviation at equal parameter"}, {"channel", "centre_z"}, {"max", 1e6}}};
         }),
         good},
        {"a limit on nothing", 3, edited([](auto& f) {
             f["limits"] = {
                 {{"of", "deviation at equal parameter"}, {"channel", "centre"}, {"max", 1e6}}};
         }),
         good},
        {"a NaN and a broken bound", 1, edited(set_to_zero), edited([](auto& f) {
             f["series"].back()["values"][0] = nullptr;
             for (auto& s : f["series"])
                 if (s["unit"] == "mm") return void(s["values"][0] = 1.0);
         })},
    };
    for (const auto& [what, code, baseline, measurement] : cases) {
        const Said said = crafted(baseline, measurement);
        EXPECT_EQ(said.code, code) << what << "\n" << said.out << said.err;
        EXPECT_EQ(contains(said.out, "passed:"), code == 0) << what << "\n" << said.out;
        EXPECT_TRUE(code != 3 || contains(said.out, "could not judge: ")) << what << "\n"
                                                                          << said.out;
    }
}

TEST(GateCommand, AMissingBaselineCouldNotBeJudgedAndAMissingSceneIsBadInput) {
    const Folder folder;
    const std::string there = " --baseline " + folder.path.string();
    Said said = gate(scene + there);
    EXPECT_EQ(said.code, 3);
    EXPECT_TRUE(contains(said.out, "there is no baseline")) << said.out;
    EXPECT_EQ(gate(there).code, 3);  // a folder without baselines
    EXPECT_EQ(gate("--baseline /nowhere/at/all").code, 3);
    EXPECT_EQ(gate("nowhere.yaml" + there).code, 2);
    EXPECT_EQ(gate(scene + there + " --from /nowhere").code,
              3);  // no baseline, so not even looked for
    folder.write("single_bushing.json", committed);
    EXPECT_EQ(gate(scene + there + " --from /nowhere").code, 2);
    EXPECT_EQ(gate(scene + " --from x " + scene).code, 2);
    EXPECT_EQ(gate(scene + " --class none").code, 2);
    EXPECT_EQ(gate(scene + " --reason why").code, 2);
}

TEST(GateCommand, AcceptNeedsAReasonAndAPerson) {
    const Folder folder;
    const std::string accept = scene + " --baseline " + folder.path.string() + " --accept";
    for (const char* reason : {"", " --reason ''", " --reason ' '"}) {
        const Said said = gate(accept + reason);
        EXPECT_EQ(said.code, 2);
        EXPECT_TRUE(contains(said.err, "--reason")) << said.err;
    }
    for (const char* ci : {"CI=true", "CI=1"}) {
        const Said said = gate(accept + " --reason why", ci);
        EXPECT_EQ(said.code, 2);
        EXPECT_TRUE(contains(said.err, "not in CI")) << said.err;
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

TEST(GateCommand, AcceptsThenPassesThenCatchesAChangedScene) {
    const Folder folder;
    const std::string own = folder.write("own.yaml", text_of(scene)),
                      baseline = folder.path / "baselines/own.json";
    Said said = gate(own + " --accept --reason 'first of all'");
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_EQ(reports::parse_baseline(text_of(baseline), "").baseline.reason, "first of all");
    said = gate(own);
    EXPECT_EQ(said.code, 0) << said.out;
    EXPECT_TRUE(contains(said.out, "same-build")) << said.out;
    EXPECT_EQ(gate("--baseline " + (folder.path / "baselines").string()).code,
              0);  // finds its scene

    // The same again is no reason to touch the file.
    EXPECT_EQ(gate(own + " --accept --reason 'again'").code, 0);
    EXPECT_EQ(reports::parse_baseline(text_of(baseline), "").baseline.reason, "first of all");

    std::string changed = text_of(scene);
    const auto rates = changed.find("rates: [");
    ASSERT_NE(rates, changed.npos);
    changed = changed.substr(0, rates) + "rates: [1" + changed.substr(rates + 8);
    folder.write("own.yaml", changed);
    said = gate(own + " --junit " + (folder.path / "j.xml").string() + " --summary " +
                (folder.path / "s.md").string());
    EXPECT_EQ(said.code, 1) << said.out;
    EXPECT_TRUE(contains(said.out, "FAILED")) << said.out;
    EXPECT_TRUE(contains(said.out, "the scene file differs from the accepted one")) << said.out;
    EXPECT_TRUE(std::regex_search(
        said.out, std::regex("\n  changed: bushings\\.[a-z_]+\\.rates\\.x: 1[0-9]+ .*, was ")))
        << said.out;
    EXPECT_TRUE(contains(text_of(folder.path / "j.xml"), "<failure message="));
    EXPECT_TRUE(contains(text_of(folder.path / "s.md"), "# elastocheck gate: FAILED"));
    EXPECT_FALSE(contains(said.out, "::error"));
    EXPECT_TRUE(contains(gate(own, "GITHUB_ACTIONS=true CI=").out, "\n::error file="));

    // By --set too, where the file is as it was; by a comment alone no number changes.
    folder.write("own.yaml", text_of(scene));
    const std::string path = reports::parse_baseline(text_of(baseline), "").numbers->back().path;
    said = gate(own + " --set " + path + "=7");
    EXPECT_TRUE(contains(said.out, "  changed: " + path + ": 7")) << said.out;
    folder.write("own.yaml", text_of(scene) + "# a comment\n");
    said = gate(own);
    EXPECT_EQ(said.code, 0) << said.out;
    EXPECT_TRUE(contains(said.out, "; none of its numbers changed")) << said.out;

    // A baseline of before numbers were kept judges as ever, and says what it cannot say.
    reports::BaselineFile older = reports::parse_baseline(text_of(baseline), "");
    older.numbers.reset();
    folder.write("baselines/own.json", reports::baseline_text(older));
    said = gate(own);
    EXPECT_EQ(said.code, 0) << said.out;
    EXPECT_TRUE(contains(said.out, "the changed numbers are unknown")) << said.out;
    folder.write("own.yaml", changed);

    // Accepting prints the difference first, and keeps what was set by hand.
    ordered_json file = ordered_json::parse(text_of(baseline));
    file["tolerances"]["physical"]["mm"]["atol"] = 0.5;
    file["limits"] = {
        {{"of", "deviation at equal parameter"}, {"channel", "centre_z"}, {"max", 1e6}}};
    folder.write("baselines/own.json", file.dump());
    said = gate(own + " --accept --reason 'stiffer'");
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_TRUE(
        contains(said.out, "numbers out of tolerance, same-build (every change beyond rounding)"));
    const auto accepted = reports::parse_baseline(text_of(baseline), "").baseline;
    EXPECT_EQ(accepted.reason, "stiffer");
    EXPECT_EQ(accepted.limits.size(), 1u);
    EXPECT_EQ(accepted.tolerances.at(compare::ToleranceClass::physical).at("mm").atol, 0.5);
    EXPECT_EQ(gate(own).code, 0);
}

TEST(GateCommand, AcceptsNeitherWhatBreaksALimitNorWhatProvesNothing) {
    const Folder folder;
    const std::string own = folder.write("own.yaml", text_of(scenes + "/pinned_bar.yaml")),
                      baseline = folder.path / "baselines/own.json";
    ASSERT_EQ(gate(own + " --accept --reason first").code, 0);
    ordered_json file = ordered_json::parse(text_of(baseline));
    file["limits"] = {
        {{"of", "deviation at equal parameter"}, {"channel", "centre_z"}, {"max", -0.0}}};
    std::string channel;
    for (const auto& s : file["series"])
        if (s["of"] == "deviation at equal parameter" && s["unit"] == "mm" && s["values"][0] > 0)
            channel = s["channel"];
    ASSERT_NE(channel, "");
    file["limits"][0]["channel"] = channel;
    const std::string limited = file.dump();
    folder.write("baselines/own.json", limited);
    EXPECT_EQ(gate(own).code, 1);
    const Said said = gate(own + " --accept --reason second");
    EXPECT_EQ(said.code, 1);
    EXPECT_TRUE(contains(said.out, "an absolute limit is broken")) << said.out;
    EXPECT_EQ(text_of(baseline), limited);

    folder.write("baselines/own.json", "{");
    EXPECT_EQ(gate(own + " --accept --reason third").code, 3);
    EXPECT_EQ(text_of(baseline), "{");

    std::string arch = text_of(scenes + "/two_spring_arch.yaml");
    arch.replace(arch.find("to: -200"), 8, "to: -300");
    const Said lost = gate(folder.write("arch.yaml", arch) + " --accept --reason fourth");
    EXPECT_EQ(lost.code, 3);
    EXPECT_TRUE(contains(lost.err, "not accepted: branch 'down': ")) << lost.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path / "baselines/arch.json"));
}

TEST(GateCommand, InCiABaselineOfTheSameRunJudgesNothing) {
    const Folder folder;
    const std::string own = folder.write("own.yaml", text_of(scene));
    const auto git = [&](const std::string& arguments) {
        return support::says("git -C " + folder.path.string() +
                             " -c user.name=t -c user.email=t@example.org " + arguments);
    };
    ASSERT_EQ(git("init -q").code, 0);
    ASSERT_EQ(gate(own + " --accept --reason copy").code, 0);  // CI unset on purpose
    EXPECT_EQ(gate(own).code, 0);
    Said said = gate(own, "CI=true");
    EXPECT_EQ(said.code, 3) << said.out;
    EXPECT_TRUE(contains(said.out, "is unreviewed")) << said.out;
    git("add .");
    ASSERT_EQ(git("commit -q -m reviewed").code, 0);
    EXPECT_EQ(gate(own, "CI=true").code, 0);
    std::ofstream(folder.path / "baselines/own.json", std::ios::app) << "\n";
    EXPECT_EQ(gate(own, "CI=true").code, 3);
}

TEST(GateCommand, OneBadSceneDoesNotHideTheOthers) {
    const Folder folder;
    folder.write("bad.yaml", "elastocheck: 1\n");
    folder.write("good.yaml", text_of(scene));
    const std::string good = (folder.path / "good.yaml").string(),
                      bad = (folder.path / "bad.yaml").string();
    ASSERT_EQ(gate(good + " --accept --reason first").code, 0);
    const Said said = gate(bad + " " + good);
    EXPECT_EQ(said.code, 2);
    EXPECT_TRUE(contains(said.out, "bad.yaml: BAD INPUT")) << said.out;
    EXPECT_TRUE(contains(said.out, "good.yaml: passed")) << said.out;
}

}  // namespace
