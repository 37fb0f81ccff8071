// Report folders: atomic replacement, and protection of foreign files.
#include "reports/page/report/report.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <map>
#include <random>
#include <thread>

#include "reports/files/folder.hpp"
#include "reports/files/templates.hpp"
#include "reports/page/plot.hpp"
#include "tests/reports/command.hpp"
#include "tests/reports/result.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

const std::string command = ELASTOCHECK_COMMAND;

using Contents = std::map<std::string, std::string>;
Contents contents_of(const fs::path& folder) {
    Contents contents;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            contents[entry.path().lexically_relative(folder).generic_string()] =
                text_of(entry.path());
    return contents;
}

std::string refusal(const fs::path& folder) {
    try {
        write_report(report_of({small_scene("new")}), folder);
    } catch (const FileError& error) {
        return error.what();
    }
    return "written";
}

TEST(Report, EqualScenesGiveEqualFilesByteByByte) {
    const Folder folder;
    for (const char* name : {"a", "b"})
        write_report(report_of({sample_scene()}), folder.path / name);
    const Contents a = contents_of(folder.path / "a"), b = contents_of(folder.path / "b");
    ASSERT_EQ(a.size(), b.size());
    for (const auto& [name, text] : a) EXPECT_EQ(text, b.at(name)) << name;
    for (const char* name :
         {"report.html", "report.md", "result.json", "curves.csv", "forces.csv", "files.txt",
          "figures/chrono-mcpherson-toe-travel.svg", "figures/chrono-mcpherson-toe-travel.csv"})
        EXPECT_TRUE(a.contains(name)) << name;
}

TEST(Report, EveryFigureIsWellFormed) {
    const Folder folder;
    write_report(report_of({sample_scene()}), folder.path / "r");
    expect_result(support::read_xml((folder.path / "r" / "figures").string() + "/*.svg"), 0);
}

TEST(Report, NamesWithMarkupAreShownAsText) {
    const Folder folder;
    SceneAnalyses scene = small_scene("<b>&\"'| `x` $(reboot) \\ *bold*");
    const std::string evil = "'; system 'touch hacked'; '<script>";
    for (auto& branch : scene.comparison.branches) branch.branch = evil;
    for (auto& branch : scene.model.branches) branch.name = evil;
    write_report(report_of({scene}), folder.path / "r");
    const std::string html = text_of(folder.path / "r" / "report.html");
    expect_parts(html, {"<h1>&lt;b&gt;&amp;&quot;&apos;| `x` $(reboot) \\ *bold*</h1>"},
                 {"<b>", "'<script"});
    expect_parts(text_of(folder.path / "r" / "report.md"),
                 {"# \\<b\\>\\&\"'\\| \\`x\\` \\$(reboot) \\\\ \\*bold\\*"});
    EXPECT_FALSE(fs::exists(folder.path / "r" / "hacked"));
}

TEST(Report, FigureIsWellFormedForAnyText) {
    const Folder folder;
    for (const std::string evil :
         {"x\ny", "a<b>&\"'", "]]><script>", "x\u2028y", "100 %", "\x01"}) {
        Figure figure{.id = "f", .title = evil, .description = evil, .x = evil, .y = evil};
        figure.series.push_back({evil, Series::Style::line, ink, 0, {{0, 0}, {1, 1}}});
        figure.bands.push_back({0, 1, evil});
        figure.y_ticks = {{0.5, evil}};
        EXPECT_EQ(draw({{&figure, "f"}}, folder.path).size(), 1u) << evil;
        expect_result(support::read_xml((folder.path / "figures" / "f.svg").string()), 0);
        expect_parts(text_of(folder.path / "figures" / "f.svg"), {}, {"<script"});
    }
}

TEST(Report, TwoScenesOfOneNameShareAPage) {
    const Folder folder;
    write_report(report_of({small_scene("twin"), small_scene("twin")}), folder.path / "r");
    const std::string html = text_of(folder.path / "r" / "report.html");
    expect_parts(html, {"<article id=\"pinned-bar\"", "<article id=\"pinned-bar-2\"",
                        "<a href=\"#pinned-bar-2\">twin</a>"});
}

TEST(Report, SeveralScenesBeginWithASummaryOfTheirMethods) {
    const Folder folder;
    SceneAnalyses second = small_scene("second");
    second.reasons = {"nothing was compared"};
    write_report(report_of({sample_scene(), second}), folder.path / "r");
    const std::string md = text_of(folder.path / "r" / "report.md");
    const auto row = [&](const std::string& name) {
        const auto at = md.find("| " + name + " |");
        return at == md.npos ? "" : md.substr(at, md.find('\n', at) - at);
    };
    const std::string first = row("McPherson strut (generic vehicle of Project Chrono)");
    expect_parts(first, {"| series, tolerance "});
    EXPECT_TRUE(contains(first, " too s")) << "its wheel rate: " << first;
    expect_parts(first, {}, {"–"});
    expect_parts(md, {}, {"FAIL"});
    EXPECT_TRUE(contains(row("second"), "| not judged |")) << row("second");
}

TEST(Report, OlderReportIsReplacedCompletely) {
    const Folder folder;
    write_report(report_of({sample_scene()}), folder.path / "r");
    write_report(report_of({small_scene("new")}), folder.path / "r");
    const Contents contents = contents_of(folder.path / "r");
    for (const auto& [name, text] : contents) expect_parts(name, {}, {"mcpherson"});
    expect_parts(contents.at("report.html"), {"<h1>new</h1>"});
    int left = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path)) ++left;
    EXPECT_EQ(left, 1);  // nothing beside it
}

TEST(Report, FolderWithForeignFilesIsNotChanged) {
    const Folder folder;
    folder.write("notes.txt", "mine");
    expect_parts(refusal(folder.path), {"notes.txt: is not a part of a report"});
    write_report(report_of({small_scene("old")}), folder.path / "r");
    std::ofstream(folder.path / "r" / "figures" / "mine.svg") << "mine";
    const Contents before = contents_of(folder.path / "r");
    expect_parts(refusal(folder.path / "r"), {"figures/mine.svg: is not a part of a report"});
    EXPECT_EQ(contents_of(folder.path / "r"), before);
    const auto file = folder.write("file", "mine");
    expect_parts(refusal(file), {"is a file; a folder is written here"});
    expect_parts(refusal("/"), {"choose a folder below it"});
    EXPECT_EQ(text_of(file), "mine");
}

TEST(Report, ReplacesOnlyFilesOfItsManifest) {
    const Folder folder;
    // A list of files made by another program does not count.
    const fs::path theirs = folder.path / "theirs";
    fs::create_directory(theirs);
    std::ofstream(theirs / "files.txt") << "thesis.tex\nfiles.txt\n";
    std::ofstream(theirs / "thesis.tex") << "years of work";
    Contents before = contents_of(theirs);
    expect_parts(refusal(theirs), {"files.txt: is not a part of a report"});
    EXPECT_EQ(contents_of(theirs), before);
    // Nor does a result.json beside it.
    const fs::path result = folder.path / "result";
    fs::create_directory(result);
    std::ofstream(result / "result.json") << "{\n \"schema\": \"elastocheck/result/6\"}";
    std::ofstream(result / "curves.csv") << "measured by hand";
    before = contents_of(result);
    expect_parts(refusal(result), {"curves.csv: is not a part of a report"});
    EXPECT_EQ(contents_of(result), before);
    // A link in the place of a file.
    write_report(report_of({small_scene("old")}), folder.path / "r");
    fs::remove(folder.path / "r" / "report.md");
    fs::create_symlink(theirs / "thesis.tex", folder.path / "r" / "report.md");
    expect_parts(refusal(folder.path / "r"), {"report.md: is not a part of a report"});
    fs::remove(folder.path / "r" / "report.md");
    EXPECT_EQ(refusal(folder.path / "r"), "written");
    // A manifest of older versions, with a hash before each name.
    std::ofstream(folder.path / "r" / "files.txt") << "elastocheck files 1\n"
                                                      "0123456789abcdef  report.html\n";
    expect_parts(refusal(folder.path / "r"), {"curves.csv: is not a part of a report"});
}

TEST(Report, ReplacesAFolderBehindALinkAndLeavesTheLink) {
    const Folder folder;
    write_folder(folder.path / "r", {{"result.json", "{}"}, {"curves.csv", "old"}});
    fs::create_directory_symlink(folder.path / "r", folder.path / "link");
    EXPECT_EQ(refusal(folder.path / "link"), "written");
    EXPECT_TRUE(fs::is_symlink(folder.path / "link"));
    EXPECT_TRUE(fs::exists(folder.path / "r" / "report.html"));
    fs::create_symlink(folder.path / "loop", folder.path / "loop");
    EXPECT_TRUE(contains(refusal(folder.path / "loop"), "Too many levels of symbolic links"))
        << refusal(folder.path / "loop");
    expect_parts(refusal(""), {"is not a folder name"});
}

TEST(Report, InconclusiveSceneIsMarkedWithItsReason) {
    const Folder folder;
    SceneAnalyses doubtful = small_scene("doubtful");
    doubtful.reasons = {"nothing was compared"};
    EXPECT_FALSE(write_report(report_of({doubtful}), folder.path / "out")[0].conclusive);
    expect_parts(
        text_of(folder.path / "out" / "report.html"),
        {"class=\"badge\">inconclusive", "<p class=\"answer\">Not judged: nothing was compared; "});
}

TEST(ReportCommand, KilledAtAnyMomentItLeavesTheOldReportOrTheNewOne) {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    const auto bar = support::text_of(scenes + "/pinned_bar.yaml");
    const std::string documents[] = {folder.write("a.yaml", bar), folder.write("b.yaml", bar)};
    const auto draw = [&](const std::string& scene) {
        const char* argv[] = {command.c_str(), "report", "--quick", scene.c_str(), "-o",
                              out.c_str(),     nullptr};
        posix_spawn_file_actions_t quiet;
        ::posix_spawn_file_actions_init(&quiet);
        ::posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        pid_t child = 0;
        EXPECT_EQ(
            ::posix_spawn(&child, argv[0], &quiet, nullptr, const_cast<char**>(argv), environ), 0);
        ::posix_spawn_file_actions_destroy(&quiet);
        return child;
    };
    const auto wait = [](pid_t child) {
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFSIGNALED(status);
    };
    using clock = std::chrono::steady_clock;
    Contents expected[2];
    double whole = 0;
    for (int which : {0, 1}) {
        const auto start = clock::now();
        ASSERT_FALSE(wait(draw(documents[which])));
        whole = std::chrono::duration<double>(clock::now() - start).count();
        expected[which] = contents_of(out);
    }
    ASSERT_NE(expected[0], expected[1]);
    std::mt19937 random(7);
    int killed = 0, changed = 0;
    Contents before = expected[1];
    for (int round = 0; round < 25; ++round) {
        const pid_t child = draw(documents[round % 2]);
        // Half of them late, while files are renamed and removed.
        const double share = round % 2 == 0 ? std::uniform_real_distribution(0.0, 1.05)(random)
                                            : std::uniform_real_distribution(0.8, 1.05)(random);
        std::this_thread::sleep_for(std::chrono::duration<double>(share * whole));
        ::kill(child, SIGKILL);
        killed += wait(child);
        const Contents now = contents_of(out);
        EXPECT_TRUE(now == expected[0] || now == expected[1]) << "half a report in round " << round;
        changed += now != before;
        before = now;
    }
    EXPECT_GT(killed, 5);
    ASSERT_FALSE(wait(draw(documents[0])));
    EXPECT_EQ(contents_of(out), expected[0]);
    int left = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path)) ++left;
    EXPECT_EQ(left, 3) << "what the killed runs left behind is removed by the next one";
    std::printf("killed %d of 25, the report changed in %d\n", killed, changed);
}

}  // namespace
}  // namespace elastocheck::reports
