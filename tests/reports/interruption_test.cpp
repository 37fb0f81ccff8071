// Interrupted runs: kill, full disk, read-only folder, concurrent runs. The output is the complete
// old or the complete new one.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <regex>
#include <set>
#include <vector>

#include "reports/files/files.hpp"
#include "reports/files/folder.hpp"
#include "tests/reports/command.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;
using support::shell;

const std::string pinned_bar = scenes + "/pinned_bar.yaml";
const std::string command = "env -u CI -u GITHUB_STEP_SUMMARY " ELASTOCHECK_COMMAND " ";

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        names.insert(entry.path().filename().string());
    return names;
}

// Runs `work` with its number in each of `count` processes; returns the number of failures.
template <class Work>
int failures(int count, Work work) {
    std::vector<pid_t> children;
    for (int k = 0; k < count; ++k) {
        children.push_back(::fork());
        if (children.back() != 0) continue;
        try {
            work(k);
            ::_exit(0);
        } catch (const std::exception& error) {
            std::fprintf(stderr, "writer %d: %s\n", k, error.what());
            ::_exit(1);
        }
    }
    int failed = 0, status = 0;
    for (const pid_t child : children) {
        ::waitpid(child, &status, 0);
        failed += status != 0;
    }
    return failed;
}

TEST(FileWriters, ConcurrentWritersLeaveOneCompleteFile) {
    const Folder folder;
    const fs::path file = folder.path / "curves.csv";
    const auto content = [](int writer) {
        return std::string(curves_file.beginning) +
               std::string(200'000, static_cast<char>('a' + writer));
    };
    EXPECT_EQ(failures(4,
                       [&](int writer) {
                           for (int k = 0; k < 40; ++k)
                               write_whole(file, content(writer), curves_file);
                       }),
              0);
    const std::string left = text_of(file);
    EXPECT_EQ(left, content(left.back() - 'a'));
    EXPECT_EQ(names_in(folder.path), std::set<std::string>{"curves.csv"});
}

TEST(FileWriters, RemoveTemporaryFilesOfEndedProcessesOnly) {
    const Folder folder;
    const pid_t ended = ::fork();
    if (ended == 0) ::_exit(0);
    ::waitpid(ended, nullptr, 0);
    folder.write(".curves.csv.elastocheck-" + std::to_string(ended), "half");
    const std::set<std::string> others{
        ".curves.csv.notes", ".curves.csv.1", ".curves.csv.elastocheck-notes",
        ".curves.csv.elastocheck-1x", ".curves.csv.elastocheck-" + std::to_string(::getppid())};
    for (const auto& name : others) folder.write(name, "mine");
    write_whole(folder.path / "curves.csv", curves_file.beginning, curves_file);
    auto expected = others;
    expected.insert("curves.csv");
    EXPECT_EQ(names_in(folder.path), expected);
}

// ---- Killed. Of folders: ReportCommand.KilledAtAnyMoment...

TEST(KilledProcess, GateLeavesTheOldOrTheNewBaseline) {
    const Folder folder;
    const std::string plain = text_of(pinned_bar);
    const std::string versions[] = {plain,
                                    std::regex_replace(plain, std::regex("to: [0-9.]+"), "to: 10")};
    ASSERT_NE(versions[0], versions[1]);
    const std::string accept =
        "cd " + folder.path.string() + " && exec " + command + "gate s.yaml --accept --reason r";
    const fs::path baseline = folder.path / "baselines/s.json",
                   curves = folder.path / "baselines/curves/s.json";
    std::string expected[2], dense[2];
    double whole = 0;
    for (const int which : {0, 1}) {
        folder.write("s.yaml", versions[which]);
        const auto start = std::chrono::steady_clock::now();
        ASSERT_EQ(shell(accept).code, 0);
        whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        expected[which] = text_of(baseline), dense[which] = text_of(curves);
        EXPECT_TRUE(contains(expected[which], R"("file":"../s.yaml")"))
            << "also in a folder that was not there";
    }
    ASSERT_NE(expected[0], expected[1]);
    int killed = 0;
    for (int round = 0; round < 20; ++round) {
        folder.write("s.yaml", versions[round % 2]);
        const std::string delay = std::to_string(whole * (0.5 + 0.03 * round));
        killed += shell("sh -c '" + accept + " >/dev/null' & sleep " + delay + "; kill -" +
                        (round % 4 < 2 ? "KILL" : "TERM") + " $! 2>/dev/null; wait $!")
                      .code != 0;
        const std::string now = text_of(baseline);
        EXPECT_TRUE(now == expected[0] || now == expected[1])
            << "half a baseline in round " << round;
        const int which = now == expected[0] ? 0 : 1;
        if (text_of(curves) == dense[which]) continue;
        // killed between its two files: it judges nothing until both are put back
        EXPECT_EQ(text_of(curves), dense[1 - which]) << "half a file in round " << round;
        const RunResult said =
            shell("cd " + folder.path.string() + " && " + command + "gate s.yaml");
        EXPECT_TRUE(said.code == 3 && contains(said.out, "is of another acceptance")) << said.out;
        folder.write("baselines/curves/s.json", dense[which]);
    }
    EXPECT_GT(killed, 0);
    folder.write("s.yaml", versions[0]);
    ASSERT_EQ(shell(accept).code, 0);
    EXPECT_EQ(text_of(baseline), expected[0]);
    EXPECT_EQ(names_in(baseline.parent_path()), (std::set<std::string>{"curves", "s.json"}));
    EXPECT_EQ(names_in(curves.parent_path()), std::set<std::string>{"s.json"})
        << "what the killed runs left behind is removed by the next one";
}

// ---- Full disk, read-only folder.

// A command, and its first output file.
struct Writing {
    std::string command, target;
};
const std::vector<Writing> writings{
    {"compare s.yaml -o out", "out/result.json"},
    {"converge s.yaml --steps 10,20,40,80,160 -o out", "out/result.json"},
    {"report --quick s.yaml -o out", "out/result.json"},
    {"solve s.yaml -o out.csv", "out.csv"},
    {"gate s.yaml --accept --reason r", "baselines/s.json"},
    {"gate s.yaml --junit out.xml", "out.xml"}};

// A folder with a scene and the output of an earlier run.
struct Place : Folder {
    Place() {
        write("s.yaml", text_of(pinned_bar));
        for (const auto& w : writings) EXPECT_EQ(in(w.command).code & ~3, 0) << w.command;
        // The scene changes, so that the next output differs.
        write("s.yaml",
              std::regex_replace(text_of(pinned_bar), std::regex("to: [0-9.]+"), "to: 10"));
    }
    // `before` is a shell command run first.
    RunResult in(const std::string& what, const std::string& before = "true") const {
        return shell("cd " + path.string() + " && " + before + " && " + command + what);
    }
};

TEST(FullDisk, FullDeviceKeepsTheOldOutputAndIsReported) {
    const Place place;
    const auto entries = names_in(place.path), baselines = names_in(place.path / "baselines");
    for (const auto& [what, target] : writings) {
        const std::string before = text_of(place.path / target);
        ASSERT_FALSE(before.empty()) << target;
        // A limit of one block acts like a full disk: every writer fails.
        expect_result(place.in(what, "ulimit -f 1"), 2,
                      {.err = {"cannot be written: File too large"}});
        EXPECT_EQ(text_of(place.path / target), before) << what;
        EXPECT_EQ(names_in(place.path), entries) << what << " leaves something behind";
        EXPECT_EQ(names_in(place.path / "baselines"), baselines)
            << what << " leaves something behind";
    }
}

// As above on a full file system, if the user may mount one.
TEST(FullDisk, FullFileSystemKeepsTheOldOutputAndIsReported) {
    const Folder folder;
    const std::string mount = "mount -t tmpfs -o size=64k none " + folder.path.string();
    if (shell("unshare -rm sh -c '" + mount + "'").code != 0)
        GTEST_SKIP() << "this user may not mount a file system of his own";
    for (const std::string& what :
         std::vector<std::string>{"compare " + pinned_bar + " -o out",
                                  "solve " + pinned_bar + " --steps 2000 -o out.csv"}) {
        const RunResult said =
            shell("unshare -rm sh -c '" + mount + " && cd " + folder.path.string() + " && " +
                  command + what + "; echo code $?; ls -A'");
        EXPECT_TRUE(said.out.ends_with("code 2\n")) << what << ": " << said.out << said.err;
        expect_parts(said.err, {"cannot be written: No space left on device"});
    }
}

TEST(UnwritableFolder, IsReportedAndStaysEmpty) {
    const Place place;
    // Root gives up the capability to bypass file permissions.
    const std::string as_others =
        ::geteuid() == 0 ? "setpriv --bounding-set -dac_override,-dac_read_search " : "";
    if (!as_others.empty() && shell(as_others + "true").code != 0)
        GTEST_SKIP() << "this user is root, and may not give up the right to write everywhere";
    for (const auto& [what, target] : writings) {
        const std::string before = text_of(place.path / target);
        const auto entries = names_in(place.path);
        fs::permissions(place.path, fs::perms(0555));
        fs::permissions(place.path / "baselines", fs::perms(0555));
        const RunResult said =
            shell("cd " + place.path.string() + " && " + as_others + command + what);
        fs::permissions(place.path, fs::perms(0755));
        fs::permissions(place.path / "baselines", fs::perms(0755));
        EXPECT_EQ(said.code, 2) << what << said.err;
        expect_parts(said.err, {"cannot be written: Permission denied"});
        EXPECT_EQ(text_of(place.path / target), before) << what;
        EXPECT_EQ(names_in(place.path), entries) << what;
    }
}

}  // namespace
}  // namespace elastocheck::reports
