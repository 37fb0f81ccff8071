// Command-line interface for programs and shells: --json, --version, manual, --open.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/reports/command.hpp"
#include "tests/reports/documents.hpp"

namespace elastocheck {
namespace {

using nlohmann::json;
using reports::objects;
using reports::result_in;

const std::string bushing = scenes + "/single_bushing.yaml";

// ---- --json

// The single document on standard output.
json document(const std::string& arguments, int code = 0) {
    const Said said = expect_says(arguments + " --json", code);
    json parsed = json::parse(said.out, nullptr, false);
    EXPECT_FALSE(parsed.is_discarded()) << arguments << ": " << said.out.substr(0, 300);
    return parsed;
}

TEST(Json, EveryCommandPrintsOneDocumentAndNothingElse) {
    const Folder folder;
    const std::string chain = folder.write("chain.yaml", chain_of(15));
    for (const std::string& command :
         {"inspect " + bushing, "solve --steps=4 " + bushing, "compare --steps=4 " + bushing,
          "converge " + bushing + " --steps=4,8,16,32,64", "trade " + chain}) {
        const json said = document(command);
        EXPECT_EQ(said["schema"], "elastocheck/result/6") << command;
        EXPECT_EQ(said["scenes"].size(), 1u) << command;
        EXPECT_EQ(said["scenes"][0]["name"], command.ends_with(chain)
                                                 ? "chain of 15 bodies on bushings"
                                                 : "Body on one bushing");
        EXPECT_TRUE(said["reproduce"].get<std::string>().starts_with("elastocheck ")) << command;
    }
    EXPECT_EQ(document("gate " + bushing)["verdict"], "passed");
    const json templates = document("new");
    EXPECT_EQ(templates["schema"], "elastocheck/templates/1");
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scenes))
        files += entry.path().extension() == ".yaml";
    EXPECT_EQ(templates["templates"].size(), files);
    EXPECT_EQ(document("new pendulum")["templates"][0]["text"], text_of(scenes + "/pendulum.yaml"));
}

TEST(Json, PrintedDocumentEqualsTheWrittenOne) {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    const Said said = expect_says("compare " + bushing + " --steps 4 --json -o " + out, 0);
    EXPECT_EQ(said.out, text_of(out + "/result.json"));
    expect_parts(said.err, {"Written: "});
    const std::string csv = (folder.path / "c.csv").string();
    EXPECT_EQ(document("solve " + bushing + " --steps 4 -o " + csv)["scenes"][0]["branches"].size(),
              2u);
    EXPECT_EQ(text_of(csv), elastocheck_says("solve " + bushing + " --steps 4").out);
}

TEST(Json, SolveDocumentHasTheNumbersOfTheCsv) {
    const json part = document(
        "solve " + bushing + " --steps 4 --method equilibrium --channels 'centre_*'")["scenes"][0];
    const auto cells =
        cells_of(elastocheck_says("solve " + bushing +
                                  " --steps 4 --method equilibrium --channels 'centre_*'")
                     .out);
    std::size_t row = 1;
    for (const auto& branch : part["branches"]) {
        const auto& leg = branch["legs"][0];
        EXPECT_EQ(leg["leg"], "equilibrium");
        EXPECT_EQ(leg["outcome"], "converged");
        for (std::size_t k = 0; k < leg["curve"]["a"].size(); ++k, ++row) {
            EXPECT_EQ(leg["curve"]["a"][k].get<double>(), std::stod(cells[row][2]));
            EXPECT_EQ(leg["curve"]["values"]["centre_z"][k].get<double>(),
                      std::stod(cells[row].back()));
        }
    }
    EXPECT_EQ(row, cells.size());
    EXPECT_EQ(part["channels"].size(), 3u);
    const json& solved = part["results"][0];
    EXPECT_EQ(solved["verdict"]["reasons"], json::array());
    EXPECT_EQ(solved["tables"]["legs"]["rows"].size(), part["branches"].size());
}

TEST(Json, InspectDocumentHasTheNumbersOfTheText) {
    const json part = document("inspect " + scenes +
                               "/mcpherson.yaml --set points.strut_top.z=0.58")["scenes"][0];
    EXPECT_EQ(part["model"]["unknowns"], 27);
    EXPECT_EQ(part["model"]["idle_modes"].size(), 1u);
    const json& tables = part["results"][0]["tables"];
    EXPECT_EQ(tables["bodies"]["rows"].size(), part["model"]["bodies"].size());
    EXPECT_EQ(tables["branches"]["rows"][0].back(), "converged");
    const json expected = {"points.strut_top.z", 0.58, "m", ""};
    EXPECT_EQ(std::ranges::count(tables["numbers"]["rows"], expected), 1);
    for (const auto& output : tables["outputs"]["rows"]) EXPECT_NE(output[2], "");
}

TEST(Json, InconclusiveDocumentKeepsItsExitCode) {
    const std::string lost = scenes + "/two_spring_arch.yaml --set branches.down.to=-300";
    const json compared = document("compare " + lost, 3)["scenes"][0]["results"][0]["verdict"];
    EXPECT_EQ(compared["grade"], "not judged");
    EXPECT_FALSE(compared["reasons"].empty());
    const json solved =
        document("solve --method series " + lost, 3)["scenes"][0]["results"][0]["verdict"];
    EXPECT_EQ(solved["grade"], "not judged");
    EXPECT_FALSE(solved["reasons"].empty());
}

TEST(Json, GateDocumentHasEveryOffenceAndChangedNumber) {
    const Folder folder;
    const std::string own = folder.write("own.yaml", text_of(bushing));
    ASSERT_EQ(elastocheck_says("gate " + own + " --accept --reason first").code, 0);
    const Said text = elastocheck_says("gate " + own + " --set bushings.mount.rates.x=3e5");
    const json said = document("gate " + own + " --set bushings.mount.rates.x=3e5", 1);
    EXPECT_EQ(said["schema"], "elastocheck/gate/2");
    EXPECT_EQ(said["verdict"], "FAILED");
    EXPECT_EQ(said["exit_code"], 1);
    const json& judged = said["scenes"][0];
    expect_parts(text.out, {std::to_string(judged["offences"]["rows"].size()) + " of " +
                            std::to_string(judged["compared"].get<int>()) + " numbers"});
    EXPECT_EQ(judged["changed"]["rows"],
              json::parse(R"([["bushings.mount.rates.x", 2e5, 3e5, "N/m"]])"));
    const auto cell = [&](const char* name) {
        const json& columns = judged["offences"]["columns"];
        const auto column =
            std::ranges::find(columns, name, [](const json& c) { return c["name"]; });
        EXPECT_NE(column, columns.end()) << name;
        return judged["offences"]["rows"][0][static_cast<std::size_t>(column - columns.begin())];
    };
    EXPECT_EQ(cell("channel"), "centre_x");
    EXPECT_EQ(cell("unit of at"), "N");
    EXPECT_EQ(cell("difference").get<double>(),
              cell("measured").get<double>() - cell("accepted").get<double>());
    EXPECT_GT(cell("noticeable").get<double>(), 1);  // times what is noticed
    expect_says("gate " + own + " --accept --reason x --json", 2);
    // Its annotations are not part of the document.
    const Said hub = support::says("env -u CI GITHUB_ACTIONS=true " ELASTOCHECK_COMMAND " gate " +
                                   own + " --set bushings.mount.rates.x=3e5 --json");
    EXPECT_FALSE(json::parse(hub.out, nullptr, false).is_discarded());
    expect_parts(hub.err, {"::error file="});
}

// ---- --version, --help

TEST(Version, NamesTheCommitAndEveryLibrary) {
    const std::string said = elastocheck_says("--version").out;
    EXPECT_TRUE(std::regex_search(
        said, std::regex("^elastocheck [0-9]+\\.[0-9]+\\.[0-9]+\ncommit (unknown|[0-9a-f]{40})")))
        << said;
    for (const char* library :
         {"Eigen", "Ceres", "NLopt", "yaml-cpp", "fmt", "CLI11", "nlohmann-json"})
        EXPECT_TRUE(std::regex_search(said, std::regex(std::string(library) + " [0-9]+\\.[0-9]")))
            << library << said;
}

// Commit recorded by the build for the sources in a folder.
std::string commit_of(const std::string& folder) {
    expect_said(support::says("cmake -D SOURCE=" + folder + " -D OUTPUT=" + folder + "/out -P " +
                              folder + "/reports/files/build_info.cmake"),
                0);
    std::smatch found;
    const std::string text = text_of(folder + "/out");
    return std::regex_search(text, found, std::regex("commit = \"([^\"]*)\"")) ? found[1].str()
                                                                               : "";
}

TEST(Version, IsThatOfTheArchiveWhereThereIsNoCheckoutAndNeverOfOneAround) {
    const std::string root = scenes + "/../..", git = "git -c safe.directory='*' -C " + root + " ";
    const Said head = support::says(git + "rev-parse --show-prefix HEAD");
    if (!head.out.starts_with("\n")) GTEST_SKIP() << "not a checkout of its own";
    const std::string commit = head.out.substr(1, 40);
    const Folder around;
    const std::string archive = (around.path / "archive").string(),
                      copy = (around.path / "copy").string();
    ASSERT_EQ(
        support::says(
            "cd " + around.path.string() +
            " && mkdir -p archive copy/reports/files && git init -q && " + git +
            "archive HEAD .gitattributes reports/files/build_info.cmake | tar x -C archive && cp " +
            root +
            "/reports/files/build_info.cmake copy/reports/files/ && git add copy && git -c "
            "user.name=t -c user.email=t@example.org commit -q -m x")
            .code,
        0);
    EXPECT_EQ(commit_of(archive), commit);
    EXPECT_EQ(commit_of(copy), "unknown") << "the checkout around it is somebody else's";
}

TEST(Help, InstalledHelpNamesTheInstalledDocuments) {
    const Folder folder;
    namespace fs = std::filesystem;
    const fs::path prefix = fs::canonical(folder.path) / "prefix",
                   documents = prefix / "share/doc/elastocheck";
    for (const fs::path& made :
         {prefix / "bin", documents / "models/scenes", documents / "reports"})
        fs::create_directories(made);
    fs::copy_file(ELASTOCHECK_COMMAND, prefix / "bin/elastocheck");
    const auto help = [&] {
        return support::says((prefix / "bin/elastocheck").string() + " --help").out;
    };
    EXPECT_TRUE(contains(help(), "Scene files: models/scenes/README.md\n"))
        << "copied away from all of them";
    for (const char* name : {"models/scenes/README.md", "reports/README.md"}) {
        folder.write("prefix/share/doc/elastocheck/" + std::string(name), "");
        expect_parts(help(), {": " + (documents / name).string() + "\n"});
    }
}

// ---- the manual

TEST(Manual, ManualHasTheHelpTextsAndIsValidRoff) {
    const std::string page = elastocheck_says("man").out;
    EXPECT_TRUE(page.starts_with(".TH ELASTOCHECK 1 ")) << page.substr(0, 80);
    expect_parts(page,
                 {"\\fB\\-o\\fR, \\fB\\-\\-output\\fR \\fIFOLDER\\fR\n", ".SS elastocheck gate\n",
                  "\\fB\\-\\-set\\fR \\fIPATH=VALUE\\fR\n", "Exit codes: 0 success",
                  "PREFIX/share/doc/elastocheck/models/scenes/README.md"},
                 {std::filesystem::current_path().string()});
    for (const auto& line : parts_of(page, '\n'))
        if (line.starts_with(".")) {
            EXPECT_TRUE(std::regex_search(line, std::regex("^\\.(TH|SH|SS|TP|B|br)( |$)"))) << line;
        }
    if (support::says("man --version").code != 0) GTEST_SKIP() << "man is not installed";
    const Folder folder;
    const Said said = support::says("env LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -l " +
                                    folder.write("e.1", page));
    EXPECT_EQ(said.err, "");
    expect_parts(said.out, {"verification of suspension solvers by independent solu"});
}

// ---- report

struct Report {
    Folder folder;
    Said draws(const std::string& options, const std::string& environment = "") const {
        return support::says("env -u CI -u BROWSER " + environment +
                             " " ELASTOCHECK_COMMAND " report --quick " + bushing + " -o " +
                             (folder.path / "out").string() + " " + options);
    }
};

TEST(ReportCommand, EndsWithTheVerdictAndThePage) {
    const Report report;
    const Said said = expect_said(report.draws(""), 0);
    const auto lines = parts_of(said.out, '\n');
    ASSERT_GE(lines.size(), 2u);
    EXPECT_TRUE(
        std::regex_search(lines[lines.size() - 2], std::regex("single_bushing\\.yaml: judged$")))
        << said.out;
    EXPECT_TRUE(
        lines.back().starts_with("The page: " + (report.folder.path / "out/report.html").string()))
        << said.out;

    const json answer = json::parse(report.draws("--json").out);
    EXPECT_EQ(answer["schema"], "elastocheck/report/1");
    EXPECT_EQ(answer["page"], (report.folder.path / "out/report.html").string());
    EXPECT_EQ(answer["scenes"][0]["verdict"]["conclusive"], true);
    expect_parts(said.out, {answer["scenes"][0]["answer"].get<std::string>()});
}

TEST(ReportCommand, LaysMeasuredPointsOverTheCurves) {
    const Report report;
    const std::string command = "report " + scenes + "/single_bushing.yaml --quick -o " +
                                (report.folder.path / "out").string() + " ";
    report.folder.write("rig.csv", "Fz [kN],X,time\n1,-99.5,0\n-2,-101,1\n");
    report.folder.write("map.yaml",
                        "columns:\n  \"Fz [kN]\": {output: parameter, unit: kN}\n"
                        "  X: {output: centre_x, sign: -1, offset: 0.5}\n");
    const std::string measured = "--measured " + (report.folder.path / "rig.csv").string(),
                      map = " --map " + (report.folder.path / "map.yaml").string();
    expect_says(command + measured + map, 0, {.err = {"rig.csv: left out: time"}});
    const json result = json::parse(text_of(report.folder.path / "out/result.json"));
    const json tables = result_in(result["scenes"][0], "measured")["tables"];
    const json points = objects(tables["points"]), tests = objects(tables["measured"]);
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0]["value"], 100.0);
    EXPECT_EQ(points[1]["value"], 101.5);
    EXPECT_EQ(points[0]["branch"], "pull");
    EXPECT_EQ(points[1]["branch"], "push");
    EXPECT_EQ(tests.size(), 2u);
    for (const auto& test : tests) EXPECT_EQ(test["points"], 1);
    expect_parts(text_of(report.folder.path / "out/report.html"),
                 {"Comparison with the measurement"});
    // nothing within range: could not be judged
    report.folder.write("rig.csv", "Fz [kN],X\n1e6,0\n");
    expect_says(command + measured + map, 3, {.err = {"is within the range of the legs"}});
    expect_says(command + map, 2);                                    // a map of nothing
    expect_says(command + measured + map + " --candidate x.csv", 2);  // a map of two
    EXPECT_EQ(report.draws(measured).code, 2) << "of a result that is not solved";
}

TEST(ReportCommand, PageIsOpenedByTheBrowserVariable) {
    const Report report;
    const std::string seen = (report.folder.path / "seen").string();
    const std::string program =
        report.folder.write("look", "#!/bin/sh\nprintf '%s|' \"$@\" > " + seen + "\necho noise\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    Said said = expect_said(
        report.draws("--open --json", "BROWSER='/nowhere/firefox:" + program + " -x'"), 0);
    EXPECT_EQ(text_of(seen), "-x|" + (report.folder.path / "out/report.html").string() + "|");
    EXPECT_FALSE(json::parse(said.out, nullptr, false).is_discarded())
        << "what a browser says is no part of it";
    said = report.draws("--open", "BROWSER='" + program + " %s y'");
    EXPECT_EQ(text_of(seen), (report.folder.path / "out/report.html").string() + "|y|");
    expect_said(report.draws("--open", "BROWSER=false"), 2);
}

TEST(ReportCommand, OpenWithoutABrowserIsRejectedBeforeTheWork) {
    const Report report;
    const std::string nothing = (report.folder.path / "empty").string();
    std::filesystem::create_directory(nothing);
    expect_said(report.draws("--open", "PATH=" + nothing + " BROWSER=firefox"), 2,
                {.err = {"there is nothing to open a page with"}});
    expect_said(report.draws("--open", "CI=true BROWSER=true"), 2, {.err = {"--open: not in CI"}});
    EXPECT_FALSE(std::filesystem::exists(report.folder.path / "out"));
}

}  // namespace
}  // namespace elastocheck
