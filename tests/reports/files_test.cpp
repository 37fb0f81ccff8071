// Atomic writing of files.
#include "reports/files/files.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "models/reader/document/limits.hpp"
#include "reports/files/limits.hpp"
#include "tests/support/folder.hpp"

namespace elastocheck::reports {
namespace {

using support::Folder;
using support::text_of;

int entries(const std::filesystem::path& folder) {
    return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(WriteWhole, CreatesTheFolderAndReplacesAnOlderFile) {
    const Folder folder;
    const auto file = folder.path / "new" / "deep" / "result.json";
    const std::string one = std::string(summary_file.beginning) + "passed\n";
    write_whole(file, one + std::string(3'000'000, 'x'), summary_file);
    EXPECT_EQ(text_of(file).size(), one.size() + 3'000'000u);
    write_whole(file, one, summary_file);
    EXPECT_EQ(text_of(file), one);
    EXPECT_EQ(entries(file.parent_path()), 1);
}

// Contents that must not change; returns the error message.
TEST(WriteWhole, NeverOverwritesAForeignFile) {
    namespace fs = std::filesystem;
    const Folder folder;
    const auto refusal = [](const fs::path& file, const FileKind& kind) {
        std::string why;
        try {
            write_whole(file, std::string(kind.beginning), kind);
        } catch (const FileError& error) {
            why = error.what();
        }
        return why;
    };
    const auto expect = [&](const fs::path& file, const FileKind& kind, const std::string& why) {
        const std::string said = refusal(file, kind);
        EXPECT_NE(said.find(why), said.npos) << kind.name << ": " << said;
    };
    const std::string scene = folder.write("scene.yaml", "elastocheck: 1\nname: x\n"),
                      empty = folder.write("empty", ""),
                      baseline = folder.write("b.json", "{\"schema\":\"elastocheck/baseline/1\"}");
    for (const auto& kind : {curves_file, rates_file, junit_file, summary_file}) {
        for (const auto& file : {scene, empty, baseline}) {
            const std::string before = text_of(file);
            expect(file, kind,
                   "exists and was not written by elastocheck as " + std::string(kind.name));
            EXPECT_EQ(text_of(file), before);
        }
        expect(folder.path, kind, "is a folder");
        expect("/dev/null", kind, "is a character device");
    }
    EXPECT_EQ(refusal(baseline, baseline_file), "");
    expect(scene, baseline_file, "was not written by elastocheck as baseline");

    // A link to a file of this program, to nothing, or to itself.
    const auto ours = folder.path / "s.md";
    EXPECT_EQ(refusal(ours, summary_file), "");
    fs::create_symlink(ours, folder.path / "link");
    fs::create_symlink(folder.path / "nowhere", folder.path / "dangling");
    fs::create_symlink(folder.path / "loop", folder.path / "loop");
    for (const char* link : {"link", "dangling", "loop"}) {
        expect(folder.path / link, summary_file, "is a symbolic link");
        EXPECT_TRUE(fs::is_symlink(folder.path / link));
    }
    EXPECT_FALSE(fs::exists(folder.path / "nowhere"));
}

TEST(Append, AppendsToRegularFilesOnly) {
    const Folder folder;
    const auto file = folder.write("summary", "another step's\n");
    append(file, "ours\n");
    EXPECT_EQ(text_of(file), "another step's\nours\n");
    std::filesystem::create_symlink(file, folder.path / "link");
    EXPECT_THROW(append(folder.path / "link", "x"), FileError);
    EXPECT_THROW(append("/dev/null", "x"), FileError);
    EXPECT_THROW(append(folder.path / "none", "x"), FileError);
    EXPECT_EQ(text_of(file), "another step's\nours\n");
}

TEST(ReadWhole, ReadsFilesAndNoDevices) {
    const Folder folder;
    EXPECT_EQ(read_whole(folder.write("f", "x")), "x");
    for (const auto& strange :
         {std::filesystem::path("/dev/zero"), folder.path, folder.path / "none"})
        EXPECT_THROW(read_whole(strange), FileError) << strange;
}

TEST(ReadWhole, TooLargeFileOrPipeIsRejectedEarly) {
    const Folder folder;
    const std::string file = folder.write("f", std::string((1 << 20) + 1, 'x'));
    EXPECT_EQ(read_whole(file, (1 << 20) + 1).size(), (1u << 20) + 1);
    const std::string pipe = (folder.path / "pipe").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::thread endless([&] {
        ::signal(SIGPIPE, SIG_IGN);
        const int out = ::open(pipe.c_str(), O_WRONLY | O_CLOEXEC);
        const std::string much(1 << 16, 'x');
        while (::write(out, much.data(), much.size()) > 0) continue;
        ::close(out);
    });
    for (const std::string& one : {file, pipe}) try {
            (void)read_whole(one, 1 << 20);
            ADD_FAILURE() << one << " was read";
        } catch (const FileError& error) {
            EXPECT_EQ(std::string(error.what()),
                      one + ": cannot be read: it is larger than 1 MiB; no file of its kind is");
        }
    endless.join();
}

TEST(WriteWhole, FailedWriteLeavesNoFile) {
    const Folder folder;
    folder.write("file", "old");
    EXPECT_THROW(write_whole(folder.path / "file" / "result.json", "x", curves_file), FileError);
    std::filesystem::create_directory(folder.path / "taken");
    std::filesystem::create_directory(folder.path / "taken" / "inside");
    try {
        write_whole(folder.path / "taken", "x", curves_file);
        ADD_FAILURE() << "a folder was overwritten";
    } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find("taken: is a folder"), std::string::npos)
            << error.what();
    }
    EXPECT_EQ(entries(folder.path), 2);
    EXPECT_THROW(write_whole("/dev/full/result.json", "x", curves_file), FileError);
}

// "10 000 000"
std::string grouped(double number) {
    std::string digits = std::to_string(static_cast<long long>(number));
    for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, " ");
    return digits;
}

TEST(Limits, ReadmeHasTheLimitsOfTheCode) {
    const std::string readme = text_of(ELASTOCHECK_VALIDATION "/../README.md");
    const std::size_t begin = readme.find("## Limits");
    ASSERT_NE(begin, readme.npos);
    const std::string limits = readme.substr(begin, readme.find("\n## ", begin + 1) - begin);
    for (const std::string& said :
         {grouped(reader::largest_text >> 20U) + " MiB; " + grouped(reader::deepest_nesting) +
              " levels of nesting",
          "names of " + grouped(reader::longest_name) + " bytes",
          grouped(reader::max_bodies) + " bodies", grouped(reader::max_segments) + " segments",
          grouped(reader::max_rows) + " rows",
          "of a branch " + grouped(reader::max_steps) + " steps",
          grouped(reader::max_poses) + " steps times bodies",
          grouped(largest_file >> 20U) + " MiB; " + grouped(deepest_json) + " levels of nesting; " +
              grouped(1e-9 * largest_json) + " GB in memory",
          "| a baseline | " + grouped(largest_baseline >> 20U) + " MiB",
          "| measured curves | " + grouped(largest_measurement >> 20U) + " MiB, " +
              grouped(max_measured_points) + " points"})
        EXPECT_TRUE(limits.find(said) != limits.npos) << said;
}

}  // namespace
}  // namespace elastocheck::reports
