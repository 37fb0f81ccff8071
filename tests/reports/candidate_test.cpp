// External candidates as files and as commands: read, run and judged; missing or unreadable results
// never pass.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "reports/files/subprocess.hpp"
#include "tests/reports/command.hpp"
#include "tests/reports/documents.hpp"

namespace elastocheck {
namespace {

using reports::objects;
using reports::result_in;
using json = nlohmann::ordered_json;

const std::string strut = scenes + "/mcpherson.yaml";

// Output of `solve` for the strut, as a file of that name.
std::string solved(const Folder& folder, const std::string& name, const std::string& how) {
    const std::string file = (folder.path / name).string();
    expect_run(fmt::format("solve {} {} {}", strut, how, file), 0);
    return file;
}

RunResult judge(const std::string& how) { return run_elastocheck("judge " + strut + " " + how); }

// A bar rotated about its own axis has the correct outputs, but its bushing is twisted.
TEST(CandidateCommand, UnbalancedStateIsReportedEvenIfNoForceIsRequested) {
    const Folder folder;
    const std::string states = (folder.path / "states.jsonl").string();
    ASSERT_EQ(run_elastocheck("solve " + scenes +
                              "/pendulum.yaml --method equilibrium --steps 8 --states " + states)
                  .code,
              0);
    const auto judged = [&] {
        return run_elastocheck("judge " + scenes + "/pendulum.yaml --steps 8 --candidate " +
                               states);
    };
    expect_parts(judged().out, {"equals the full solution"});
    std::istringstream lines(text_of(states));
    std::string turned;
    for (std::string line; std::getline(lines, line);) {
        auto state = json::parse(line);
        for (auto& body : state["bodies"]) {
            // (w, x, y, z), rotated by 0.3 rad about the body's (0.8, 0.6, 0), the axis of the bar
            const auto q = body["orientation"].get<std::vector<double>>();
            const double c = std::cos(0.15), a = 0.8 * std::sin(0.15), b = 0.6 * std::sin(0.15);
            body["orientation"] = {q[0] * c - q[1] * a - q[2] * b, q[0] * a + q[1] * c - q[3] * b,
                                   q[0] * b + q[2] * c + q[3] * a, q[3] * c + q[1] * b - q[2] * a};
        }
        turned += state.dump() + "\n";
    }
    std::ofstream(states) << turned;
    const RunResult said = judged();
    expect_parts(said.out, {"Its states are out of balance by up to "}, {"is the full solution,"});
}

TEST(CandidateCommand, PublishedRecursionAsAnExternalCommandGetsTheNumbersOfTheBuiltInOne) {
    const RunResult said =
        expect_result(judge("--steps 20 --json --candidate-command '" ELASTOCHECK_COMMAND
                            " solve {scene} --method published --steps {steps} -o {output}'"),
                      1);
    const json scene = json::parse(said.out)["scenes"][0];
    int same = 0;
    for (const auto& row : objects(result_in(scene, "judge")["tables"]["deviations"]))
        for (const auto& branch : scene["branches"]) {
            const auto& ours = branch["deviation"]["at_equal_parameter"]["channels"];
            const std::string name = row["output"];
            if (branch["name"] != row["branch"] || !ours.contains(name)) continue;
            EXPECT_EQ(row["deviation at equal parameter"], ours[name]["signed_max"]) << name;
            EXPECT_EQ(row["rms at equal parameter"], ours[name]["rms"]) << name;
            EXPECT_EQ(row["place at equal parameter"], ours[name]["at"]) << name;
            ++same;
        }
    EXPECT_GT(same, 40);
}

TEST(CandidateCommand, CommandLineIsSplitIntoWordsAsByAShell) {
    using reports::words_of;
    using Words = std::vector<std::string>;
    EXPECT_EQ(words_of("  ./a  b\tc "), (Words{"./a", "b", "c"}));
    EXPECT_EQ(words_of(R"('a b' "c d" e\ f "g\"h" 'i\j' '' k'l'm)"),
              (Words{"a b", "c d", "e f", "g\"h", "i\\j", "", "klm"}));
    EXPECT_THROW((void)words_of("'a"), std::invalid_argument);
    EXPECT_THROW((void)words_of("a\\"), std::invalid_argument);
}

TEST(CandidateCommand, ChildrenOfATimedOutProgramAreKilled) {
    const Folder folder;
    const std::string mark = (folder.path / "mark").string();
    const auto ended = reports::run({"sh", "-c", "(sleep 2; touch " + mark + ") & sleep 30"}, 0.3);
    EXPECT_EQ(ended.how, reports::ProcessResult::How::too_long);
    const auto begin = std::chrono::steady_clock::now();
    const auto leaves = reports::run({"sh", "-c", "(sleep 2; touch " + mark + ") & exit 0"}, 30);
    EXPECT_TRUE(leaves.succeeded());
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
    expect_result(support::shell("sleep 3"), 0);
    EXPECT_FALSE(std::filesystem::exists(mark));
}

// Whether the process exists and has not ended.
bool is_running(pid_t process) {
    const std::string state = text_of(fmt::format("/proc/{}/stat", process));
    const auto at = state.rfind(") ");
    return at != state.npos && state[at + 2] != 'Z';
}

// Runs `elastocheck WORDS` with default signal actions and $TMPDIR in the folder, and sends the
// signal when `file` has content. Returns the signal that ended it, or minus its exit code.
int ended_by(const Folder& folder, const std::string& file, int signal,
             const std::vector<std::string>& words) {
    const std::string temporary = folder.path / "tmp";
    std::filesystem::create_directories(temporary);
    const pid_t child = ::fork();
    if (child == 0) {
        for (const int one : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) std::signal(one, SIG_DFL);
        ::setenv("TMPDIR", temporary.c_str(), 1);
        const int nothing = ::open("/dev/null", O_RDWR);
        for (const int stream : {0, 1, 2}) ::dup2(nothing, stream);
        std::vector<char*> arguments{const_cast<char*>(ELASTOCHECK_COMMAND)};
        for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        ::execv(arguments[0], arguments.data());
        ::_exit(127);
    }
    for (int k = 0; k < 3000 && text_of(file).empty(); ++k) ::usleep(10'000);
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? WTERMSIG(status) : -WEXITSTATUS(status);
}

TEST(CandidateCommand, SignalEndsAllChildrenAndTheNextRunRemovesTheirFiles) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        const Folder folder;
        const std::string numbers = (folder.path / "numbers").string(),
                          wrapper = folder.write(
                              "wrapper",
                              "#!/bin/sh\nsleep 600 & a=$!\nsleep 600 & echo $$ $a $! > " +
                                  numbers + "\nwait\n");
        std::filesystem::permissions(wrapper, std::filesystem::perms(0755));
        EXPECT_EQ(ended_by(folder, numbers, signal,
                           {"judge", scenes + "/pinned_bar.yaml", "--candidate-command",
                            wrapper + " {output}"}),
                  signal);
        std::istringstream list(text_of(numbers));
        int processes = 0;
        for (pid_t process; list >> process; ++processes) {
            for (int k = 0; k < 200 && is_running(process); ++k) ::usleep(10'000);
            EXPECT_FALSE(is_running(process)) << "signal " << signal;
        }
        EXPECT_EQ(processes, 3);
        const std::string temporary = (folder.path / "tmp").string();
        EXPECT_FALSE(std::filesystem::is_empty(temporary)) << "signal " << signal;
        (void)support::shell("env -u CI TMPDIR=" + temporary + " " ELASTOCHECK_COMMAND " judge " +
                             scenes + "/pinned_bar.yaml --candidate-command 'false {output}'");
        EXPECT_TRUE(std::filesystem::is_empty(temporary)) << "signal " << signal;
    }
}

TEST(CandidateCommand, StatesAsATableEqualThoseAsJsonLines) {
    const Folder folder;
    const std::string lines =
        solved(folder, "states.jsonl", "--steps 4 --method equilibrium --states");
    std::vector<std::string> rows;
    for (const auto& line : parts_of(text_of(lines), '\n')) {
        const json state = json::parse(line);
        for (const auto& [body, pose] : state["bodies"].items()) {
            std::string row = fmt::format("{},{:.17g},{}", state["branch"].get<std::string>(),
                                          state["load"].get<double>(), body);
            for (const auto& x : pose["position"]) row += fmt::format(",{:.17g}", x.get<double>());
            for (const auto& x : pose["orientation"])
                row += fmt::format(",{:.17g}", x.get<double>());
            rows.push_back(row);
        }
    }
    std::string csv = "branch,load,body,x,y,z,qw,qx,qy,qz\n";
    for (auto row = rows.rbegin(); row != rows.rend(); ++row) csv += *row + "\n";
    const std::string table = folder.write("states.csv", csv);
    const auto of = [&](const std::string& file) {
        const RunResult said = expect_result(judge("--steps 4 --json --candidate " + file), 0);
        return result_in(json::parse(said.out)["scenes"][0], "judge");
    };
    const json a = of(lines), b = of(table);
    const json ours = objects(a["tables"]["deviations"]),
               theirs = objects(b["tables"]["deviations"]);
    ASSERT_EQ(ours.size(), theirs.size());
    for (std::size_t k = 0; k < ours.size(); ++k)
        for (const char* numbers : {"numbers at equal parameter", "numbers at equal abscissa"})
            EXPECT_EQ(ours[k][numbers], theirs[k][numbers]) << ours[k];
    EXPECT_EQ(a["verdict"]["compared"], b["verdict"]["compared"]);
    EXPECT_EQ(
        std::ranges::count_if(objects(a["tables"]["residuals"]),
                              [](const json& row) { return row["equations of"] == "equilibrium"; }),
        2 * 5);  // of both branches
}

}  // namespace
}  // namespace elastocheck
