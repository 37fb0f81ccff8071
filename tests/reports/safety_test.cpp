// Safety of commands for any input: no overwriting of foreign files, no injected output, no useless
// work, no hidden failure.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;

const std::string scene = scenes + "/pinned_bar.yaml";

RunResult in(const Folder& folder, const std::string& arguments) {
    return support::shell("cd " + folder.path.string() + " && env -u GITHUB_STEP_SUMMARY CI= " +
                          ELASTOCHECK_COMMAND + " " + arguments);
}

TEST(HostileNames, ControlCharactersInFileNamesAreEscaped) {
    const Folder folder;
    for (const std::string name :
         {"a\n::error::x.yaml", "a\x1b[2J.yaml", "a\u009b2J.yaml", "a\u202e.yaml", "a\xff.yaml"}) {
        folder.write(name, text_of(scene));
        for (const std::string command : {"solve", "compare", "inspect", "gate", "report -o out"}) {
            const RunResult said = expect_result(
                support::shell("cd " + folder.path.string() + " && GITHUB_ACTIONS=true CI= " +
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
    const RunResult said = expect_result(in(folder, "gate"), 2);
    expect_parts("\n" + said.out + said.err, {}, {"\n::error"});
}

TEST(HostileNames, BaselineOfASceneInAnUnprintableFolderIsRefused) {
    const Folder folder;
    for (const std::string name : {"a\xff", "a\nb", "a\u202e"}) {
        fs::create_directory(folder.path / name);
        std::ofstream(folder.path / name / "s.yaml") << text_of(scene);
        const RunResult said = expect_result(
            support::shell("cd '" + (folder.path / name).string() + "' && env -u CI " +
                           ELASTOCHECK_COMMAND +
                           " gate s.yaml --baseline ../baselines --accept --reason x"),
            2);
        EXPECT_TRUE(contains(said.err, "/s.yaml: ") &&
                    contains(said.err, "names are one line of UTF-8 text"))
            << said.err;
        EXPECT_FALSE(fs::exists(folder.path / "baselines"));
    }
}

TEST(HostileNames, NewlineInABaselineCannotWriteAWorkflowAnnotation) {
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
        const RunResult said = expect_result(
            support::shell(std::string("env CI= GITHUB_ACTIONS=true ") + ELASTOCHECK_COMMAND +
                           " gate " + scene + " --baseline " + folder.path.string()),
            3);
        expect_parts("\n" + said.out + said.err, {}, {"\n::error file=a"});
    }
}

}  // namespace
}  // namespace elastocheck
