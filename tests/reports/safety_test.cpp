// Safety of commands for any input: no overwriting of foreign files, no injected output, no useless
// work, no hidden failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;

const std::string scene = scenes + "/pinned_bar.yaml";

Said in(const Folder& folder, const std::string& arguments) {
    return support::says("cd " + folder.path.string() + " && env -u GITHUB_STEP_SUMMARY CI= " +
                         ELASTOCHECK_COMMAND + " " + arguments);
}

TEST(Harm, OutputNeverOverwritesSceneDeviceLinkOrBaseline) {
    const Folder folder;
    folder.write("a.yaml", text_of(scene));
    folder.write("b.json", text_of(scenes + "/baselines/pinned_bar.json"));
    folder.write("kept", "mine");
    fs::create_symlink("kept", folder.path / "link");
    fs::create_symlink("nowhere", folder.path / "dangling");
    for (const std::string target :
         {"a.yaml", "b.json", "kept", "link", "dangling", "/dev/null", "."}) {
        const std::string before =
            target[0] == '/' || target == "." ? "" : text_of(folder.path / target);
        for (const std::string& arguments :
             {"solve a.yaml --steps 2 -o " + target,
              "solve a.yaml --steps 2 --method series --rates " + target,
              "gate a.yaml --junit " + target, "gate a.yaml --summary " + target}) {
            const Said said = expect_said(in(folder, arguments), 2, {.err = {target + ": "}});
            EXPECT_TRUE(said.out.empty()) << "refused before the work: " << arguments;
        }
        for (const char* command : {"compare", "report", "trade", "converge"}) {
            const Said said =
                expect_said(in(folder, std::string(command) + " a.yaml -o " + target), 2);
            EXPECT_TRUE(said.out.empty())
                << "refused before the work: " << command << " " << target;
        }
        if (!before.empty()) {
            EXPECT_EQ(text_of(folder.path / target), before) << target;
        }
    }
    EXPECT_FALSE(fs::exists(folder.path / "nowhere"));
    // Files of this program are replaced.
    for (int again = 0; again < 2; ++again) {
        expect_said(in(folder, "solve a.yaml --steps 2 -o curves.csv"), 0);
        expect_said(in(folder, "gate a.yaml --junit j.xml --summary s.md"), 3);
    }
}

TEST(Harm, SummaryIsAppendedToThatOfTheWorkflowStep) {
    const Folder folder;
    const std::string summary = folder.write("summary", "# another step\n"),
                      baselines = scenes + "/baselines";
    expect_said(support::says("env CI= GITHUB_STEP_SUMMARY=" + summary + " " + ELASTOCHECK_COMMAND +
                              " gate " + scene + " --summary " + summary),
                0);
    EXPECT_TRUE(text_of(summary).starts_with("# another step\n# elastocheck gate: passed"))
        << text_of(summary);
}

TEST(Harm, NameOfSeveralLinesIsRejectedBeforeTheWork) {
    const Folder folder;
    const std::string plain = text_of(scene);
    const auto named = [&](const std::string& name) {
        std::string text = plain;
        const auto at = text.find("name: ");
        return text.replace(at, text.find('\n', at) - at, "name: \"" + name + "\"");
    };
    for (const char* escape :
         {"a\\Nb", "a\\_b", "a\\nb", "a\\eb", "a\\x9bb", "a\\u202eb", "a\\Lb"}) {
        folder.write("s.yaml", named(escape));
        for (const char* command :
             {"compare s.yaml -o out", "solve s.yaml", "gate s.yaml", "report s.yaml -o out"}) {
            const Said said = expect_said(in(folder, command), 2);
            expect_parts(said.err + said.out, {"s.yaml:"});
        }
        EXPECT_FALSE(fs::exists(folder.path / "out"));
    }
    folder.write("s.yaml", named("Gr\\xf6\\u00dfe, 轮"));
    expect_said(in(folder, "compare s.yaml --steps 2 -o out"), 0);
    EXPECT_EQ(nlohmann::json::parse(text_of(folder.path / "out/result.json"))["scenes"][0]["name"],
              "Größe, 轮");
}

TEST(Harm, ControlCharactersInFileNamesAreEscaped) {
    const Folder folder;
    for (const std::string name :
         {"a\n::error::x.yaml", "a\x1b[2J.yaml", "a\u009b2J.yaml", "a\u202e.yaml", "a\xff.yaml"}) {
        folder.write(name, text_of(scene));
        for (const std::string command : {"solve", "compare", "inspect", "gate", "report -o out"}) {
            const Said said = expect_said(
                support::says("cd " + folder.path.string() + " && GITHUB_ACTIONS=true CI= " +
                              ELASTOCHECK_COMMAND + " " + command + " '" + name + "'"),
                2);
            expect_parts("\n" + said.out + said.err, {},
                         {"\n::error", "\x1b", "\u009b", "\u202e", "\xff"});
            expect_parts(said.err, {"names are one line of UTF-8 text"});
        }
        EXPECT_FALSE(fs::exists(folder.path / "out"));
        fs::remove(folder.path / name);
    }
    // A baseline in a folder is a name too, and so is the scene that it names.
    fs::create_directory(folder.path / "baselines");
    std::ofstream(folder.path / "baselines" / "x\n::error::y.json") << "{}";
    const Said said = expect_said(in(folder, "gate"), 2);
    expect_parts("\n" + said.out + said.err, {}, {"\n::error"});
}

TEST(Harm, PathWithAnUnprintableFolderIsNotStoredInABaseline) {
    const Folder folder;
    for (const std::string name : {"a\xff", "a\nb", "a\u202e"}) {
        fs::create_directory(folder.path / name);
        std::ofstream(folder.path / name / "s.yaml") << text_of(scene);
        const Said said =
            expect_said(support::says("cd '" + (folder.path / name).string() + "' && env -u CI " +
                                      ELASTOCHECK_COMMAND +
                                      " gate s.yaml --baseline ../baselines --accept --reason x"),
                        2);
        EXPECT_TRUE(contains(said.err, "/s.yaml: ") &&
                    contains(said.err, "names are one line of UTF-8 text"))
            << said.err;
        EXPECT_FALSE(fs::exists(folder.path / "baselines"));
    }
}

TEST(Harm, NewlineInABaselineMakesNoAnnotation) {
    const Folder folder;
    const fs::path accepted = scenes + "/baselines/pinned_bar.json",
                   curves = scenes + "/baselines/curves/pinned_bar.json";
    fs::create_directory(folder.path / "curves");
    for (const char* field :
         {"\"file\":\"", "\"name\":\"", "\"input_hash\":\"", "\"tip_", "\"up"}) {
        std::string texts[2];
        bool found = false;
        for (const int which : {0, 1}) {
            std::string& text = texts[which] = text_of(which == 0 ? accepted : curves);
            const auto at = text.find(field);
            if (at == text.npos) continue;
            found = true;
            text.insert(at + std::string(field).size(), "x\\n::error file=a::b");
        }
        ASSERT_TRUE(found) << field;
        folder.write("pinned_bar.json", texts[0]);
        folder.write("curves/pinned_bar.json", texts[1]);
        const Said said = expect_said(
            support::says(std::string("env CI= GITHUB_ACTIONS=true ") + ELASTOCHECK_COMMAND +
                          " gate " + scene + " --baseline " + folder.path.string()),
            3);
        expect_parts("\n" + said.out + said.err, {}, {"\n::error file=a"});
    }
}

TEST(Harm, OneUnreadableBaselineDoesNotEndTheGate) {
    const Folder folder;
    fs::create_directory(folder.path / "baselines");
    folder.write("good.yaml", text_of(scene));
    ASSERT_EQ(in(folder, "gate good.yaml --accept --reason first").code, 0);
    fs::create_directory(folder.path / "baselines/folder.json");
    fs::create_symlink("loop.json", folder.path / "baselines/loop.json");
    std::ofstream(folder.path / "baselines/broken.json") << "{";
    folder.write("loop.yaml", text_of(scene));
    for (const char* arguments : {"gate --junit j.xml", "gate loop.yaml good.yaml --junit j.xml"}) {
        fs::remove(folder.path / "j.xml");
        expect_said(in(folder, arguments), 3,
                    {.out = {"good.yaml: passed", "loop.json: cannot be read"}});
        expect_parts(text_of(folder.path / "j.xml"), {"good.yaml"});
    }
}

}  // namespace
}  // namespace elastocheck
