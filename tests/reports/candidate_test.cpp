// External candidates as files and as commands: read, run and judged; missing or unreadable results
// never pass.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
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
    expect_says(fmt::format("solve {} {} {}", strut, how, file), 0);
    return file;
}

Said judge(const std::string& how) { return elastocheck_says("judge " + strut + " " + how); }

TEST(CandidateCommand, ReferencePassesAsCurvesAndAsStates) {
    const Folder folder;
    const std::string curves = solved(folder, "curves.csv", "--steps 10 --method energy -o"),
                      states =
                          solved(folder, "states.jsonl", "--steps 10 --method energy --states");
    for (const auto& file : {curves, states}) {
        const Said said = expect_said(judge("--steps 10 --candidate " + file), 0,
                                      {.out = {"Pass: the candidate "}});
        EXPECT_EQ(contains(said.out, " states in the equations of the legs"), file == states)
            << said.out;
    }
    // With forces, from the curves and from the states.
    for (const auto& file : {curves, states})
        expect_said(judge("--steps 10 --tolerance 1e-6mm,1e-6deg,1e-4N,1e-4Nm --candidate " + file),
                    0);
}

TEST(CandidateCommand, TableWithoutForcesIsReportedAsComparedWithoutThem) {
    const Folder folder;
    const std::string all = solved(folder, "all.csv", "--steps 10 --method energy -o"),
                      some = solved(folder, "some.csv",
                                    "--steps 10 --method energy --channels toe,camber,travel -o");
    const std::string none = " No force or moment was compared.";
    expect_parts(judge("--steps 10 --candidate " + all).out, {}, {none});
    expect_said(judge("--steps 10 --candidate " + some), 0, {.out = {none}});
}

// A bar rotated about its own axis has the correct outputs, but its bushing is twisted.
TEST(CandidateCommand, UnbalancedStateIsReportedWithoutARequestedForce) {
    const Folder folder;
    const std::string states = (folder.path / "states.jsonl").string();
    ASSERT_EQ(elastocheck_says("solve " + scenes +
                               "/pendulum.yaml --method equilibrium --steps 8 --states " + states)
                  .code,
              0);
    const auto judged = [&] {
        return elastocheck_says("judge " + scenes + "/pendulum.yaml --steps 8 --candidate " +
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
    const Said said = judged();
    expect_parts(said.out, {"Its states are out of balance by up to "}, {"is the full solution,"});
}

TEST(CandidateCommand,
     ThePublishedRecursionRunFromOutsideGetsTheNumbersOfTheBuiltInOneDigitForDigit) {
    const Said said =
        expect_said(judge("--steps 20 --json --candidate-command '" ELASTOCHECK_COMMAND
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

TEST(CandidateCommand, FailingCandidateCommandIsNotJudged) {
    const struct {
        const char *command, *said;
    } cases[] = {{"sh -c \"echo no licence >&2; exit 7\" {output}", "ended with exit code 7"},
                 {"sh -c \"kill -SEGV $$\" {output}", "was killed by signal 11"},
                 {"sleep 30 {output}", "could"},
                 {"true {output}", "wrote no output file"},
                 {"touch {output}", "wrote nothing"},
                 {"cp /proc/self/environ {output}", ""},
                 {"sh -c \"echo 1,2,3 > $0\" {output}", "unknown column '1'"},
                 {"sh -c \"printf 'branch,load_N,toe_deg\\\\njounce,10,0\\\\n' > $0\" {output}",
                  "it does not give"},
                 {"no-such-program-anywhere {output}", "could not be run"}};
    for (const auto& [command, expected] : cases) {
        const std::string line = command;
        const Said said = expect_said(
            judge(fmt::format("--steps 5 --candidate-timeout 0.5 --candidate-command '{}'",
                              [&] {
                                  std::string quoted;
                                  for (const char c : line)
                                      quoted += c == '\'' ? "'\\''" : std::string(1, c);
                                  return quoted;
                              }())),
            3, {.out = {"Not judged: "}});
        if (line.starts_with("sleep"))
            EXPECT_TRUE(contains(said.out, "took longer than 0.5 s and was killed") ||
                        contains(said.out, "ended with exit code"))
                << said.out;
        else
            expect_parts(said.out, {expected});
        if (line.find("licence") != line.npos) {
            expect_parts(said.err, {"no licence"});
        }
    }
}

TEST(CandidateCommand, InvalidOptionsAreRejectedBeforeTheWork) {
    const struct {
        const char *how, *what;
    } cases[] = {
        {"", "no candidate; give"},
        {"--candidate-command 'true {scene}'", "{output} is missing"},
        {"--candidate-command 'true \"{output}'", "a quote \" does not close"},
        {"--candidate-command 'true {output}' --set springs.K1_coil.rate=28e3", "not with --set"},
        {"--candidate-command 'true {output}' --tolerance 1kg", "is not a unit"},
        {"--candidate nowhere.csv", "nowhere.csv"}};
    for (const auto& [how, what] : cases) expect_said(judge(how), 2, {.err = {what}});
}

// A pipe that nobody writes to would be waited for.
TEST(CandidateCommand, PipeAsCandidateIsRejected) {
    const Folder folder;
    const std::string pipe = (folder.path / "pipe").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    expect_said(judge("--candidate " + pipe), 2,
                {.err = {pipe + ": is a pipe; a candidate is a regular file"}});
}

TEST(CandidateCommand, CommandIsSplitIntoWords) {
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
    expect_said(support::says("sleep 3"), 0);
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
        (void)support::says("env -u CI TMPDIR=" + temporary + " " ELASTOCHECK_COMMAND " judge " +
                            scenes + "/pinned_bar.yaml --candidate-command 'false {output}'");
        EXPECT_TRUE(std::filesystem::is_empty(temporary)) << "signal " << signal;
    }
}

TEST(CandidateCommand, AnUnusableTemporaryFolderIsNamedWithItsVariable) {
    expect_said(support::says("env -u CI TMPDIR=/nowhere " ELASTOCHECK_COMMAND " judge " + scenes +
                              "/pinned_bar.yaml --candidate-command 'true {output}'"),
                2,
                {.err = {"TMPDIR: no temporary folder can be made in /nowhere (No such file or "
                         "directory); set TMPDIR to a folder that can be written"}});
}

// ---- Tables in other layouts.

std::string rows(const std::string& csv, const std::vector<std::string>& columns,
                 const std::string& head,
                 const std::function<std::string(const std::string&, double)>& written) {
    const auto cells = cells_of(csv);
    std::vector<std::size_t> at;
    for (const auto& column : columns)
        at.push_back(
            static_cast<std::size_t>(std::ranges::find(cells[0], column) - cells[0].begin()));
    std::string text = head + "\n";
    for (std::size_t r = 1; r < cells.size(); ++r) {
        for (std::size_t c = 0; c < at.size(); ++c) {
            const std::string& cell = cells[r].at(at[c]);
            text += (c == 0 ? "" : ",") +
                    (columns[c] == "branch" ? cell : written(columns[c], std::stod(cell)));
        }
        text += "\n";
    }
    return text;
}

TEST(CandidateCommand, MapTranslatesNamesUnitsAndSignsOfATable) {
    const Folder folder;
    const std::string csv =
        text_of(solved(folder, "curves.csv", "--steps 10 --method equilibrium -o"));
    const std::string theirs =
        folder.write("theirs.csv", rows(csv,
                                        {"branch", "parameter", "toe [deg]", "camber [deg]",
                                         "wheel_centre_z [mm]", "wheel_centre_y [mm]"},
                                        "case,Fz [kN],TOE,CAMBER,HEIGHT,WHATEVER",
                                        [](const std::string& column, double v) {
                                            if (column == "parameter") v *= 1e-3;
                                            if (column == "toe [deg]") v *= -std::acos(-1.) / 180;
                                            if (column == "wheel_centre_z [mm]") v = (v + 26) / 1e3;
                                            return fmt::format("{:.17g}", v);
                                        }));
    const std::string map = folder.write("map.yaml", R"(columns:
  case: {output: branch}
  Fz [kN]: {output: parameter, unit: kN}
  TOE: {output: toe, unit: rad, sign: -1}
  CAMBER: {output: camber}
  HEIGHT: {output: wheel_centre_z, unit: m, offset: -26}
)");
    expect_said(judge("--steps 10 --candidate " + theirs + " --map " + map), 0,
                {.out = {"columns that are not compared: WHATEVER"}});
    // Without the sign, the error is diagnosed.
    std::string wrong = text_of(map);
    wrong.replace(wrong.find(", sign: -1"), 10, "");
    expect_said(
        judge("--steps 10 --candidate " + theirs + " --map " + folder.write("wrong.yaml", wrong)),
        1, {.out = {"with its sign turned"}});
    const struct {
        const char *text, *what;
    } cases[] = {{"columns:\n  TOE: {output: toes}\n",
                  "map.yaml:2: columns.TOE.output: there is no output 'toes', did you mean 'toe'?"},
                 {"columns:\n  TOE: {output: toe, unit: mm}\n",
                  "columns.TOE.unit: 'mm' is not a unit of toe"},
                 {"columns:\n  TOE: {output: toe, sign: 2}\n", "expected 1 or -1"},
                 {"columns:\n  GONE: {output: toe}\n", "there is no column 'GONE'"},
                 {"rows: {}\n", "rows"}};
    for (const auto& [text, what] : cases)
        expect_said(
            judge("--steps 10 --candidate " + theirs + " --map " + folder.write("map.yaml", text)),
            2, {.err = {what}});
}

TEST(CandidateCommand, UnreadableFileIsRejectedWithItsLine) {
    const Folder folder;
    const std::string state =
        R"("bodies": {"arm": {"position": [0, 0, 0], "orientation": [1, 0, 0, 0]}}})";
    const struct {
        const char* name;
        std::string text, what;
    } cases[] = {
        {"a.csv", "load_N,toes_deg\n1,2\n", "a.csv:1: unknown column 'toes_deg', did you mean"},
        {"a.csv", "toe_deg\n1\n", "a.csv:1: no column gives the parameter or travel of a point"},
        {"a.csv", "branch,load_N,toe_deg\njounce,1,2\nbrake,1,2\n",
         "a.csv:3: branch: the scene has no branch 'brake'"},
        {"a.csv", "branch,load_N,toe_deg\njounce,1,x\n", "a.csv:2: toe_deg: 'x' is not a number"},
        {"a.csv", "branch,load_mm,toe_deg\njounce,1,1\n",
         "a.csv:2: load_mm: 'mm' is not a unit of the parameter of branch 'jounce'"},
        {"a.csv", "branch,load_N,toe_deg,toe [deg]\njounce,1,1,1\n", "two columns for toe"},
        {"a.csv", "", "a.csv: empty"},
        {"a.jsonl", R"({"branch": "jounce", "load": 1, )" + state + "\n",
         "a.jsonl:1: bodies: body 'wheel' is missing"},
        {"a.jsonl", R"({"branch": "jounce", "load": 1)", "a.jsonl:1: "},
        {"a.jsonl", R"({"branch": "jounce", "bodies": {}})", "a.jsonl:1: load: missing"},
        {"a.jsonl",
         R"({"branch": "jounce", "load": 1, "bodies": {"amr": {"position": [0, 0, 0], "orientation": [1, 0, 0, 0]}}})",
         "the scene has no body 'amr', did you mean 'arm'"},
        {"a.jsonl",
         R"({"branch": "jounce", "load": 1, "bodies": {"arm": {"position": [0, 0, 0], "orientation": [1, 0, 0, 0.01]}}})",
         "a.jsonl:1: bodies.arm.orientation: its length is 1.00005"},
        {"a.csv", "branch,load,body,x,y,z,qw,qx,qy,qz\njounce,1,arm,0,0,0,1,0,0,0.01\n",
         "a.csv:2: orientation: its length"},
        {"a.csv",
         "branch,load,body,x,y,z,qw,qx,qy,qz\njounce,1,arm,0,0,0,1,0,0,0\njounce,1,arm,0,0,0,1,0,0,"
         "0\n",
         "a.csv:3: body 'arm' is there already"}};
    for (const auto& [name, text, what] : cases)
        expect_said(judge("--steps 5 --candidate " + folder.write(name, text)), 2, {.err = {what}});
}

TEST(CandidateCommand, NonNumericOrMissingValueNeverPasses) {
    const Folder folder;
    std::string csv = text_of(
        solved(folder, "curves.csv", "--steps 10 --method equilibrium --channels toe,camber -o"));
    expect_said(judge("--steps 10 --candidate " + folder.write("whole.csv", csv)), 0);
    const auto line = csv.find("\njounce", csv.size() / 3);
    const std::string part = csv.substr(0, line + 1);
    expect_said(judge("--steps 10 --partial --candidate " + folder.write("part.csv", part)), 0,
                {.out = {"It does not give branch 'jounce' from ", "branch 'rebound'"}});
    auto nan = part;
    nan.replace(nan.rfind(',') + 1, nan.size(), "nan\n");
    expect_said(judge("--steps 10 --partial --candidate " + folder.write("nan.csv", nan)), 3,
                {.out = {"is not a number at"}});
}

// The same results as a file and from a command have the same verdict, with --partial and without.
TEST(CandidateCommand, MissingBranchIsNamedAndPassesOnlyWithPartial) {
    const Folder folder;
    std::string csv =
        text_of(solved(folder, "all.csv", "--steps 10 --method energy --channels toe,camber -o"));
    const std::string file = folder.write("jounce.csv", csv.substr(0, csv.find("\nrebound") + 1)),
                      command = "--candidate-command 'cp " + file + " {output}'";
    for (const auto& how : {"--candidate " + file, command}) {
        expect_said(judge("--steps 10 " + how), 3,
                    {.out = {"Not judged: it does not give branch 'rebound'; with --partial it is "
                             "judged on what it gives."}});
        expect_said(judge("--steps 10 --partial " + how), 0,
                    {.out = {"It does not give branch 'rebound'."}});
    }
    expect_said(judge("--partial"), 2);
}

// States as a table, with another order of rows, give the same result as JSON lines.
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
        const Said said = expect_said(judge("--steps 4 --json --candidate " + file), 0);
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

// ---- Other commands.

TEST(CandidateCommand, ConvergeFindsOrderAndLimitOfAnExternalRecursion) {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    const Said said = expect_says(
        fmt::format(
            "converge {} --steps 40,80,160,320,640 -o {} --candidate-command '" ELASTOCHECK_COMMAND
            " solve {{scene}} --method published --steps {{steps}} -o {{output}}'",
            strut, out),
        0);
    const auto own = said.out.find("the candidate, branch ");
    ASSERT_NE(own, said.out.npos) << said.out;
    expect_parts(said.out.substr(0, own), {"|Φ| at its end"});
    expect_parts(said.out.substr(own), {"order at which the largest step error"}, {"|Φ|"});
    const auto ours = cells_of(text_of(out + "/convergence.csv")),
               theirs = cells_of(text_of(out + "/candidate_convergence.csv"));
    const auto column = [&](const char* name) {
        return static_cast<std::size_t>(
            std::ranges::find_if(ours[0], [&](const auto& c) { return c.starts_with(name); }) -
            ours[0].begin());
    };
    const auto output = column("output"), order = column("order"), gap = column("gap");
    ASSERT_EQ(ours.size(), theirs.size());
    int converging = 0;
    for (std::size_t r = 1; r < ours.size(); ++r) {
        EXPECT_EQ(ours[r][output], theirs[r][output]);
        if (ours[r][order].empty()) continue;
        EXPECT_NEAR(std::stod(theirs[r][order]), std::stod(ours[r][order]), 0.02);
        EXPECT_NEAR(std::stod(theirs[r][gap]), std::stod(ours[r][gap]),
                    1e-3 * std::abs(std::stod(ours[r][gap])) + 1e-7);
        ++converging;
    }
    EXPECT_GT(converging, 5);
    expect_says("converge " + strut + " --candidate 75=" +
                    solved(folder, "a.csv", "--method published --steps 75 -o"),
                3, {.out = {"at least three numbers of steps"}});
}

TEST(CandidateCommand, PageBeginsWithTheVerdictOnTheCandidate) {
    const Folder folder;
    const std::string out = (folder.path / "page").string();
    expect_says(
        fmt::format("report {}/pinned_bar.yaml -o {} --candidate-command '" ELASTOCHECK_COMMAND
                    " solve {{scene}} --method published --steps {{steps}} -o {{output}}'",
                    scenes, out),
        1);
    const std::string page = text_of(out + "/report.md");
    const auto verdict = page.find("Fail: the candidate ‘elastocheck’"),
               suspension = page.find("two independent solutions agree");
    ASSERT_NE(verdict, page.npos) << page.substr(0, 2000);
    EXPECT_LT(verdict, suspension);
    const json result = json::parse(text_of(out + "/result.json"));
    EXPECT_EQ(result_in(result["scenes"][0], "judge")["verdict"]["grade"], "fail");
}

}  // namespace
}  // namespace elastocheck
