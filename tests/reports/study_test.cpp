// `elastocheck study`: bad input, known variances, interruption, shards, extension.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "reports/study/database.hpp"
#include "tests/reports/study_command.hpp"

namespace elastocheck::reports {
namespace {

// ---- Bad input, each before the first variant, with file and line.

TEST_F(StudyCommand, RefusesBadInputBeforeTheFirstVariant) {
    const struct {
        std::string what, by, says;
    } mistakes[]{
        {"first.preload", "frist.preload",
         "study.yaml:4: variables.springs.frist.preload: the scene has no such number, did you "
         "mean "
         "'springs.first.preload'?"},
        {"{sd: 20}", "{sd: -20}", "study.yaml:4: variables.springs.first.preload.normal.sd: -20"},
        {"{normal: {sd: 20}}", "{normal: {sd: 20}, uniform: {half_width: 1}}",
         "study.yaml:4: variables.springs.first.preload.uniform: a second distribution"},
        {"{normal: {sd: 20}}", "{}",
         "study.yaml:4: variables.springs.first.preload: no "
         "distribution"},
        {"{normal: {sd: 20}}", "{triangular: {low: 1, high: 2}}",
         "study.yaml:4: variables.springs.first.preload.triangular: mode 600 is not between"},
        {"springs.first.preload", "branches.up.steps", "branches are the same for all variants"},
        {"kind: sobol", "kind: sobl",
         "study.yaml:6: design.kind: 'sobl' is not a design, did you "
         "mean 'sobol'?"},
        {"kind: sobol", "kind: grid", "a grid needs a list of values for each variable"},
        {", seed: 3", "", "study.yaml:6: design.seed: missing"},
        {"centre_z@up:1500", "center_z@up:1500",
         "study.yaml:8: figures.height: the scene has no output 'center_z', did you mean "
         "'centre_z'?"},
        {"centre_z@up:1500", "centre_z@upp:1500",
         "study.yaml:8: figures.height: the scene has no "
         "branch 'upp', did you mean 'up'?"},
        {"@up:1500", "@up:3001", "branch 'up' goes from 0 to 3000 N"},
        {"@up:1500", "@up:954.929658551372", "study.yaml:7: figures: the stations are not among"},
        {"centre_z@up:1500", "min centre_z@up:1500", "an extreme is that of the whole branch"},
        {"height: {max", "hight: {max",
         "study.yaml:10: limits.hight: the study has no such figure, did you mean 'height'?"},
        {"{max: 420.8}", "{max: 1, min: 2}", "study.yaml:10: limits.height: min is above max"},
        {"parallel_springs.yaml", "parallel.yaml", "study.yaml:2: scene: "},
        {"witness: 1024", "witnes: 1024", "unknown field 'witnes', did you mean 'witness'?"},
        {"design:",
         "groups: [{variables: [springs.first.preload, static_loads.weight.force.z], correlation: "
         "[[1, 1], [1, 1]]}]\ndesign:",
         "study.yaml:6: groups.correlation: is not positive definite"},
        {"design:",
         "groups: [{variables: [springs.first.preload, nobody], correlation: []}]\ndesign:",
         "'nobody' is not a variable"},
        {"seed: 3}",
         "seed: 3, indices: true}\ngroups: [{variables: [springs.first.preload, "
         "static_loads.weight.force.z], correlation: [[1, 0.5], [0.5, 1]]}]",
         "Sobol indices need independent variables"},
        {"variables:\n", "variables:\n  both: {scale: 'springs.*.preload', normal: {sd: 0.1}}\n",
         "springs.first.preload is varied by 'both' too"},
        {"variables:\n", "variables:\n  springs.second.rate: {uniform: {half_width: 50}}\n",
         "study.yaml:4: variables.springs.second.rate: -5 can be drawn, and with it the scene is "
         "invalid: "},
        {"variables:\n", "variables:\n  springs.second.rate: {list: [30, -1]}\n",
         "study.yaml:4: variables.springs.second.rate: -1 can be drawn"},
        {"variables:\n", "variables:\n  none: {scale: 'bushings.*', normal: {sd: 0.1}}\n",
         "study.yaml:4: variables.none.scale: the scene has no number 'bushings.*'"},
    };
    for (const auto& [what, by, says] : mistakes) {
        expect_said(study(replaced(linear, what, by)), 2, {.err = {says}});
        EXPECT_FALSE(fs::exists(path / "out")) << says;
    }
    write("study.yaml", linear);
    expect_said(run("-o out --shard 3/2"), 2, {.err = {"--shard '3/2': allowed: K/N"}});
    expect_said(run("-o out --show"), 2, {.err = {"no such ledger; nothing has been computed"}});
}

TEST_F(StudyCommand, RefusesATableWithItsLine) {
    const std::string list = R"(elastocheck_study: 1
scene: parallel_springs.yaml
variables: {springs.first.rate: {}, springs.second.rate: {}}
design: {kind: list, file: list.csv}
figures: {height: centre_z@up:3000}
)";
    write("list.csv", "springs.first.rate,springs.secnd.rate\n1,2\n");
    expect_said(study(list), 2,
                {.err = {"list.csv:1: the study has no variable 'springs.secnd.rate', did you mean "
                         "'springs.second.rate'?"}});
    write("list.csv", "springs.first.rate\n1\n");
    expect_said(study(list), 2, {.err = {"list.csv:1: 1 columns, but the study has 2 variables"}});
    write("list.csv", "springs.second.rate,springs.first.rate\n45,30\n,30\n");
    expect_said(study(list), 2, {.err = {"list.csv:3: springs.second.rate: no value"}});
    write("list.csv", "springs.second.rate,springs.first.rate\n45,30\n20,30\n");
    expect_said(study(list, "-o out --csv rows.csv"), 0, {.out = {"2 of 2 variants: 2 solved"}});
    const auto rows = cells_of(text_of(path / "rows.csv"));
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0][3], "springs.first.rate [N/mm]");
    EXPECT_EQ(rows[2][4], "20");
    EXPECT_NEAR(std::stod(rows[1][5]), 400 + 3000.0 / 75, 1e-9);
    EXPECT_NEAR(std::stod(rows[2][5]), 400 + 3000.0 / 50, 1e-9);
}

// ---- A linear suspension of known variance.

TEST_F(StudyCommand, FindsTheVarianceOfALinearSuspension) {
    expect_said(study(linear), 0,
                {.out = {"4096 of 4096 variants: 4096 solved",
                         "springs.first.preload        N        600  normal, 600, sd 20"}});
    const json all = statistics(), &figures = all["figures"];
    const double sd = std::hypot(20, 30) / 75;
    EXPECT_NEAR(cell(figures, 0, "design"), 420, 1e-9);
    EXPECT_NEAR(cell(figures, 0, "mean"), 420, 1e-3);
    EXPECT_NEAR(cell(figures, 0, "sd"), sd, 1e-3 * sd);
    // percentiles, and the share above the limit, of the normal distribution
    EXPECT_NEAR(cell(figures, 0, "95 %"), 420 + 1.6448536 * sd, 0.01 * sd);
    EXPECT_LT(cell(figures, 0, "95 % low"), 420 + 1.6448536 * sd);
    EXPECT_GT(cell(figures, 0, "95 % high"), 420 + 1.6448536 * sd);
    const double above = 0.5 * std::erfc(0.8 / sd / std::sqrt(2.0));
    EXPECT_NEAR(cell(figures, 0, "outside"), above, 0.004);
    EXPECT_LT(cell(figures, 0, "outside low"), above);
    EXPECT_GT(cell(figures, 0, "outside high"), above);
    EXPECT_EQ(cell(all["witnesses"], 0, "witnesses"), 4);
    EXPECT_LT(cell(all["witnesses"], 0, "difference"), 1e-9);
}

// Var z = (s₁² + s₂² + 2 ρ s₁ s₂) / k².
TEST_F(StudyCommand, FindsTheVarianceOfCorrelatedNumbers) {
    expect_said(study(replaced(linear, "design:",
                               "groups: [{variables: [springs.first.preload, "
                               "static_loads.weight.force.z], correlation: [[1, -0.8], [-0.8, "
                               "1]]}]\ndesign:")),
                0);
    const double sd = std::sqrt(20 * 20 + 30 * 30 - 2 * 0.8 * 20 * 30) / 75;
    EXPECT_NEAR(cell(statistics()["figures"], 0, "sd"), sd, 2e-3 * sd);
}

TEST_F(StudyCommand, FindsTheSharesOfALinearSuspension) {
    expect_said(study(replaced(linear, "seed: 3", "seed: 3, indices: true")), 0,
                {.out = {"Sobol indices"}});
    const json sobol = statistics()["sobol"];
    for (const auto& [row, share] : {std::pair(0u, 4.0 / 13), std::pair(1u, 9.0 / 13)})
        for (const std::string kind : {"first", "total"}) {
            EXPECT_LT(cell(sobol, row, kind + " low"), share);
            EXPECT_GT(cell(sobol, row, kind + " high"), share);
            EXPECT_NEAR(cell(sobol, row, kind), share, 0.04);
        }
}

// A factor multiplies all numbers of its patterns.
TEST_F(StudyCommand, ScalesSeveralNumbersByOneFactor) {
    expect_said(study(R"(elastocheck_study: 1
scene: parallel_springs.yaml
variables:
  rates: {scale: springs.*.rate, list: [0.5, 1, 2]}
design: {kind: grid}
figures: {height: centre_z@up:3000}
)",
                      "-o out --csv rows.csv"),
                0);
    const auto rows = cells_of(text_of(path / "rows.csv"));
    ASSERT_EQ(rows.size(), 4u);
    for (const std::size_t k : {1u, 2u, 3u})
        EXPECT_NEAR(std::stod(rows[k][4]), 400 + 40 / std::stod(rows[k][3]), 1e-9);
}

// ---- Failed variants.

TEST_F(StudyCommand, RecordsVariantsThatFailWithTheirReason) {
    const Said said = study(R"(elastocheck_study: 1
scene: parallel_springs.yaml
variables:
  springs.first.rate: {normal: {mean: 10, sd: 15}}
design: {kind: sobol, count: 64, seed: 1}
figures: {height: centre_z@up:3000}
witness: 1
)",
                            "-o out --csv rows.csv");
    expect_said(said, 0, {.out = {"48 solved, 16 no scene", "springs.first.rate"}});
    const auto rows = cells_of(text_of(path / "rows.csv"));
    ASSERT_EQ(rows.size(), 65u) << "a gap";
    const json figures = statistics()["figures"];
    EXPECT_EQ(cell(figures, 0, "values"), 48);
    EXPECT_EQ(cell(figures, 0, "missing"), 16);
    write("list.csv", "springs.first.rate\n-1\n");
    expect_said(study(R"(elastocheck_study: 1
scene: parallel_springs.yaml
variables: {springs.first.rate: {}}
design: {kind: list, file: list.csv}
figures: {height: centre_z@up:3000}
)",
                      "-o none"),
                3, {.out = {"1 no scene"}});
}

// ---- Threads, shards, interruption, extension: one content.

// The link is 102 mm long as drawn, and from 100 to 110 mm in the variants.
TEST_F(StudyCommand, AVariantThatDrivesALengthThroughZeroIsARowWithItsReason) {
    const std::string rod = R"(elastocheck: 1
name: actuator
units: {length: mm, angle: deg, force: N}
points: {end: [400, 0, 0], base: [400, 20, 100]}
bodies: {block: {origin: end}}
joints: {rod: {type: distance, bodies: [block, ground], from: end, to: base}}
bushings:
  k: {bodies: [ground, block], at: end, rates: [50, 50, 50], rotational_rates: [10, 10, 10]}
branches: {b: {drive: joints.rod, to: -101, steps: 10}}
probes: {end: {on: block, at: end}}
)";
    const std::string file = R"(elastocheck_study: 1
scene: rod.yaml
variables: {points.base.y: {uniform: {half_width: 25}}}
design: {kind: monte_carlo, count: 20, seed: 1}
figures: {z: end_z@b:-80.8}
)";
    write("rod.yaml", rod);
    expect_said(study(file, "-o out --csv rows.csv"), 0, {.out = {"20 of 20 variants: "}});
    int vanishes = 0;
    const auto rows = cells_of(text_of(path / "rows.csv"));
    ASSERT_EQ(rows.size(), 21u);
    for (std::size_t k = 1; k < rows.size(); ++k) {
        const bool solved = rows[k][1] == "solved";  // else a quoted reason and no figure
        const double y = std::stod(solved ? rows[k][3] : rows[k].back());
        EXPECT_EQ(solved, std::hypot(y, 100) > 101) << y << ": " << rows[k][2];
        if (!solved) expect_parts(rows[k][2], {"\"rod.yaml:9: branches.b.to: "});
        vanishes += !solved;
    }
    EXPECT_GT(vanishes, 2);
    EXPECT_LT(vanishes, 18);
    write("rod.yaml", replaced(rod, "to: -101", "to: -150"));
    expect_said(study(file, "-o other"), 2,
                {.err = {"rod.yaml:9: branches.b.to: '-150' would leave"}});
}

TEST_F(StudyCommand, HasOneContentOnAnyThreadsAndInShards) {
    const std::string one = content(study(mcpherson, "-o one --jobs 1"));
    ASSERT_EQ(one.size(), 16u) << one;
    EXPECT_EQ(content(run("-o two --jobs 2")), one);
    EXPECT_EQ(content(run("-o two --show")), one);

    for (const char* k : {"1", "2"})
        expect_said(run("-o parts --shard " + std::string(k) + "/3"), 0,
                    {.out = {std::string("Shard ") + k + "/3"}});
    expect_said(run("-o parts --merge parts"), 3,
                {.err = {"256 variants are missing: 256 of 512 to 767\n"}});
    expect_said(run("-o elsewhere --shard 3/3"), 0);
    EXPECT_EQ(content(run("-o whole --merge parts elsewhere")), one);
}

// Killed when it has recorded some variants and computes others, then finished by the same command.
TEST_F(StudyCommand, KilledAtAnyMomentGoesOnToTheSameContent) {
    const std::string whole = content(study(linear, "-o whole --count 6000"));
    ASSERT_EQ(whole.size(), 16u) << whole;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> moment(0, 0.1);
    static const std::regex rows("^([0-9]+) of 6000");
    int killed = 0, part = 0;
    for (int round = 0; round < 8; ++round) {
        const std::string kill = round % 3 == 2 ? "TERM" : "KILL",
                          jobs = round % 2 == 0 ? "1" : "2";
        killed +=
            support::says("cd " + path.string() +
                          " && size() { stat -c %s out/ledger.sqlite 2>/dev/null || echo 0; }; "
                          "before=$(size); { exec env --default-signal " ELASTOCHECK_COMMAND
                          " study study.yaml --quiet -o out --count 6000 --jobs " +
                          jobs +
                          " >/dev/null & }; for k in $(seq 1000); do [ $(size) -gt $((before + "
                          "8192)) ] && break; sleep 0.01; done; sleep " +
                          std::to_string(moment(random)) + "; kill -" + kill + " $!; wait $!")
                .code > 128;
        const Said shown = run("-o out --count 6000 --show");
        std::smatch match;
        if (std::regex_search(shown.out, match, rows))
            part += std::stoi(match[1]) > 0 && std::stoi(match[1]) < 6000;
    }
    EXPECT_GT(killed, 1);
    EXPECT_GT(part, 0) << "never killed in the middle";
    EXPECT_EQ(content(run("-o out --count 6000")), whole);
}

TEST_F(StudyCommand, ExtendsWithoutRepeating) {
    write("study.yaml", mcpherson);
    EXPECT_NE(run("-o grown --count 300").err.find("300 variants computed"), std::string::npos);
    EXPECT_NE(run("-o grown --count 700").err.find("400 variants computed"), std::string::npos);
    const Said again = run("-o grown --count 700");
    EXPECT_EQ(again.err.find("variants computed"), std::string::npos) << again.err;
    EXPECT_EQ(content(again), content(run("-o whole --count 700")));
    // Limits are no part of what was computed.
    study(mcpherson + "limits: {toe: {max: 0}}\n", "-o grown --count 700");
    EXPECT_NE(statistics("grown")["figures"].dump().find("outside"), std::string::npos);
    expect_said(study(replaced(mcpherson, "kind: sobol", "kind: latin_hypercube"),
                      "-o hypercube --count 3000"),
                2, {.err = {"a Latin hypercube cannot be extended"}});
}

TEST_F(StudyCommand, RefusesLedgersOfOtherStudies) {
    study(linear, "-o first --count 300");
    for (const auto& [what, by] : {std::pair("sd: 20", "sd: 21"), std::pair("seed: 3", "seed: 4"),
                                   std::pair("@up:1500", "@up:3000")})
        expect_said(study(replaced(linear, what, by), "-o first --count 300"), 2,
                    {.err = {"is of another study file"}});
    write("study.yaml", linear);
    const std::string scene = text_of(path / "parallel_springs.yaml");
    write("parallel_springs.yaml", replaced(scene, "rate: 45", "rate: 46"));
    fs::rename(path / "first" / "ledger.sqlite", path / "first" / "ledger-1-of-1.sqlite");
    expect_said(run("-o second --count 300 --merge first"), 2,
                {.err = {"first/ledger-1-of-1.sqlite: is of another scene"}});
    write("parallel_springs.yaml", scene);
    write("first/ledger-1-of-1.sqlite", "no ledger");
    expect_said(run("-o third --count 300 --merge first"), 2, {.err = {"ledger-1-of-1.sqlite: "}});
    expect_said(run("-o third --count 300 --merge nowhere"), 2, {.err = {"nowhere: "}});
}

TEST_F(StudyCommand, TwoProcessesDoNotWriteOneLedger) {
    write("study.yaml", linear);
    expect_said(support::says("cd " + path.string() +
                              " && mkdir out && flock out/ledger.sqlite.lock " ELASTOCHECK_COMMAND
                              " study study.yaml -o out --quiet --count 10"),
                2, {.err = {"another process is computing this study here"}});
}

// ---- A damaged ledger

TEST_F(StudyCommand, RefusesADamagedRowByItsNumber) {
    study(linear, "-o out --count 40");
    const fs::path ledger = path / "out" / "ledger.sqlite";
    const std::string good = text_of(ledger);
    for (const auto& [change, says] : {
             std::pair("variants SET f1 = f1 + 1e-12 WHERE k = 17", "row 17: its content is not"),
             std::pair("variants SET reason = 'x' WHERE k = 17", "row 17: its content is not"),
             std::pair("variants SET outcome = 99 WHERE k = 17", "row 17: its content is not"),
             std::pair("variants SET method = 1 WHERE k = 17", "row 17: its content is not"),
             std::pair("variants SET k = 99 WHERE k = 17", "row 99: its content is not"),
             std::pair("witnesses SET f1 = 1 WHERE k = 0", "row 0: its content is not"),
             std::pair("variants SET f1 = 'abc' WHERE k = 17",
                       "row 17: f1 is 'abc'; expected a "
                       "number"),
         }) {
        write("out/ledger.sqlite", good);
        Database(ledger, Database::Access::existing).run(std::string("UPDATE ") + change);
        for (const char* options : {"-o out --count 40 --show", "-o out --count 50"})
            expect_said(run(options), 2, {.err = {std::string("out/ledger.sqlite: ") + says}});
    }
    // As the message says.
    write("out/ledger.sqlite", good);
    Database(ledger, Database::Access::existing).run("DELETE FROM variants WHERE k = 17");
    expect_said(run("-o out --count 40"), 0, {.err = {"1 variants computed"}});
    EXPECT_EQ(content(run("-o out --count 40")), content(run("-o whole --count 40")));
}

TEST_F(StudyCommand, FollowsNoLinkToALedger) {
    study(linear, "-o out --count 40");
    fs::create_directories(path / "linked");
    fs::create_symlink(path / "out" / "ledger.sqlite", path / "linked" / "ledger.sqlite");
    for (const char* options : {"-o linked --count 40 --show", "-o linked --count 50"})
        expect_said(run(options), 2, {.err = {"linked/ledger.sqlite: is a symbolic link"}});
}

// Its rows are shown, and no rows are added to them.
TEST_F(StudyCommand, RefusesToWriteTheLedgerOfAnotherVersion) {
    study(mcpherson, "-o out --count 300");
    Database(path / "out" / "ledger.sqlite", Database::Access::existing)
        .run("UPDATE meta SET value = '0.0.1 abc' WHERE key = 'version'");
    expect_said(run("-o out --count 300 --show"), 0, {.out = {"300 of 300 variants"}});
    expect_said(
        run("-o out --count 400"), 2,
        {.err = {"out/ledger.sqlite: is of another version of the program: 0.0.1 abc there, "}});
    fs::rename(path / "out" / "ledger.sqlite", path / "out" / "ledger-1-of-1.sqlite");
    expect_said(run("-o other --count 400 --merge out"), 2,
                {.err = {"out/ledger-1-of-1.sqlite: is of another version of the program"}});
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
