// `elastocheck study` by several processes that mpirun starts.
#include <gtest/gtest.h>

#include <random>

#include "tests/reports/study_command.hpp"

namespace elastocheck::reports {
namespace {

struct StudyRanks : StudyCommand {
    void SetUp() override {
        StudyCommand::SetUp();
        if (mpirun.empty()) GTEST_SKIP() << "libopenmpi-dev is not installed";
    }
    static inline const std::string mpirun = ELASTOCHECK_MPIRUN;
    // On a machine with fewer cores, too, and as root, as in a container.
    static std::string ranks(int count) {
        return mpirun + " --allow-run-as-root --oversubscribe -n " + std::to_string(count) +
               " " ELASTOCHECK_COMMAND " study study.yaml --quiet ";
    }
    Said by_ranks(int count, const std::string& options) const {
        return support::says("cd " + path.string() + " && " + ranks(count) + options);
    }
    std::string rank_ledgers(const std::string& folder) const {
        std::string names;
        for (const auto& entry : fs::directory_iterator(path / folder))
            if (const std::string name = entry.path().filename(); name.starts_with("ledger-rank-"))
                names += name + " ";
        return names;
    }

    // Kills mpirun or one of its processes, in turn, at a random moment after the first rows; each
    // next run has other numbers of ranks and threads. In the end the same content.
    void kill_again_and_again(int times, const std::string& count) {
        write("study.yaml", linear);
        const std::string whole = content(run("-o whole --count " + count));
        ASSERT_EQ(whole.size(), 16u) << whole;
        std::mt19937 random(7);
        std::uniform_real_distribution<double> moment(0, 0.2);
        int killed = 0, part = 0;
        for (int round = 0; round < times; ++round) {
            const int n = 2 + round % 3;
            const std::string victim = round % 2 == 0
                                           ? "$!"
                                           : "$(cut -d' ' -f" + std::to_string(1 + round % n) +
                                                 " /proc/$!/task/$!/children)";
            const Said said = support::says(
                "cd " + path.string() +
                " && size() { cat out/*.sqlite 2>/dev/null | wc -c; }; before=$(size); { exec " +
                ranks(n) + "-o out --jobs " + std::to_string(1 + round % 2) + " --count " + count +
                " >said.txt 2>&1 & }; for k in $(seq 1000); do [ $(size) -gt $((before + 8192)) ] "
                "&& "
                "break; kill -0 $! || break; sleep 0.01; done; sleep " +
                std::to_string(moment(random)) + "; kill -KILL " + victim +
                "; wait $!; code=$?; "
                // The others end by themselves, some after the next command would have begun.
                "alive() { for p in /proc/[0-9]*; do [ \"$(readlink $p/cwd)\" = \"$PWD\" ] && [ "
                "\"$(readlink $p/exe)\" = " ELASTOCHECK_COMMAND
                " ] && return 0; done; return 1; }; for k in $(seq 300); do alive || break; sleep "
                "0.1; done; exit $code");
            killed += said.code != 0;
            std::smatch match;
            static const std::regex rows("^([0-9]+) of ");
            const Said shown = run("-o out --show --count " + count);
            if (std::regex_search(shown.out, match, rows))
                part += std::stoi(match[1]) > 0 && match[1] != count;
        }
        EXPECT_GT(killed, times / 4);
        EXPECT_GT(part, 0) << "never killed in the middle";
        const Said last = by_ranks(2, "-o out --count " + count);
        EXPECT_EQ(content(last), whole) << last.err;
        EXPECT_EQ(rank_ledgers("out"), "") << last.err;
    }
};
using NightlyStudyRanks = StudyRanks;

TEST_F(StudyRanks, HaveTheContentOfOneProcess) {
    const std::string one = content(study(mcpherson, "-o one"));
    ASSERT_EQ(one.size(), 16u) << one;
    for (const int n : {1, 2, 4}) {
        const std::string folder = "ranks" + std::to_string(n);
        const Said said = by_ranks(n, "-o " + folder);
        EXPECT_EQ(content(said), one) << said.err;
        EXPECT_EQ(said.code, 0) << said.err;
        EXPECT_NE(said.err.find("780 variants computed"), std::string::npos) << said.err;
        EXPECT_EQ(said.err.find(" by " + std::to_string(n) + " ranks") != std::string::npos, n > 1);
        EXPECT_EQ(rank_ledgers(folder), "");
    }
    // extended: no variant twice
    const Said more = by_ranks(3, "-o ranks2 --count 1000");
    EXPECT_NE(more.err.find("220 variants computed by 3 ranks"), std::string::npos) << more.err;
}

TEST_F(StudyRanks, RefuseBadInputOnce) {
    write("study.yaml", replaced(linear, "kind: sobol", "kind: sobl"));
    const Said said = by_ranks(4, "-o out");
    EXPECT_EQ(said.code, 2);
    const std::string message = "study.yaml:6: design.kind: 'sobl' is not a design";
    const auto at = said.err.find(message);
    ASSERT_NE(at, std::string::npos) << said.err;
    EXPECT_EQ(said.err.find(message, at + 1), std::string::npos) << said.err;
    write("study.yaml", linear);
    expect_said(by_ranks(2, "-o out --shard 1/2"), 2, {.err = {"not with mpirun"}});
}

TEST_F(StudyRanks, KilledGoOnToTheSameContent) { kill_again_and_again(4, "20000"); }

TEST_F(NightlyStudyRanks, KilledTwentyTimesGoOnToTheSameContent) {
    kill_again_and_again(20, "100000");
}

// ---- An array of jobs

// Each job computes a shard, one is killed and goes on as a job of its own number.
TEST_F(StudyCommand, HasOneContentAsAnArrayOfJobs) {
    write("study.yaml", mcpherson);
    const std::string one = content(run("-o one"));
    const std::string array = "cd " + path.string() +
                              " && PATH=" + fs::path(ELASTOCHECK_COMMAND).parent_path().string() +
                              ":$PATH sh " ELASTOCHECK_STUDIES "/study.sbatch study.yaml parts 3";
    for (const char* k : {"1", "3"})
        expect_said(support::says("export SLURM_ARRAY_TASK_ID=" + std::string(k) + "; " + array),
                    0);
    expect_said(run("-o parts --merge parts"), 3, {.err = {"256 variants are missing"}});
    expect_said(support::says("export SLURM_ARRAY_TASK_ID=2 SLURM_CPUS_PER_TASK=2; " + array), 0);
    EXPECT_EQ(content(run("-o parts --merge parts")), one);
    fs::create_directories(path / "empty");
    expect_said(run("-o parts --merge empty"), 2,
                {.err = {"empty: no ledger of a shard, ledger-K-of-N.sqlite, in it"}});
}

using NightlyStudySlurm = StudyCommand;
TEST_F(NightlyStudySlurm, HasOneContentAsAnArrayOfJobs) {
    if (support::says("command -v slurmctld slurmd munged sbatch").code != 0)
        GTEST_SKIP() << "slurm-wlm or munge is not installed";
    write("study.yaml", mcpherson);
    const std::string one = content(run("-o one --count 3000"));
    write("study.yaml", replaced(mcpherson, "count: 780", "count: 3000"));
    write("submit.sh",
          "cd " + path.string() +
              "\n"
              "job() { sbatch --parsable \"$@\" " ELASTOCHECK_STUDIES
              "/study.sbatch study.yaml parts 3; }\n"
              "first=$(job --array=1-3)\n"
              "for k in $(seq 600); do [ -s parts/ledger-1-of-3.sqlite ] && break; sleep "
              "0.05; done\n"
              "scancel ${first}_1\n"
              "sbatch --wait --dependency=afterany:$first --wrap true >/dev/null\n"
              "sbatch --parsable --wait --array=1-3 " ELASTOCHECK_STUDIES
              "/study.sbatch study.yaml parts 3\n"
              "cat study-*.log >&2\n");
    const Said said =
        support::says("PATH=" + fs::path(ELASTOCHECK_COMMAND).parent_path().string() + ":$PATH " +
                      ELASTOCHECK_ONE_NODE_SLURM + " " + (path / "slurm").string() + " sh " +
                      (path / "submit.sh").string());
    if (said.code == 77) GTEST_SKIP() << "Slurm does not start here: " << said.err;
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_NE(said.err.find("variants computed"), std::string::npos) << said.err;
    EXPECT_EQ(content(run("-o parts --merge parts")), one) << said.err;
}

}  // namespace
}  // namespace elastocheck::reports
