// `elastocheck live` and `report --live`: what stands in the page, and what is said where the page is not built. A
// program is copied to a folder of its own, with a page of one line or with none.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/command.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;
using support::contains;
using support::expect_parts;
using support::expect_said;
using support::Folder;
using support::says;
using support::text_of;

const std::string bar = std::string(ELASTOCHECK_SCENES) + "/pinned_bar.yaml";

// A program of its own.
struct Program {
    Folder folder;
    std::string call = (folder.path / "bin/elastocheck").string() + " ";
    Program() {
        fs::create_directory(folder.path / "bin");
        fs::copy_file(ELASTOCHECK_COMMAND, folder.path / "bin/elastocheck");
    }
    void with_page() const {
        fs::create_directories(folder.path / "share/elastocheck");
        folder.write("share/elastocheck/live.html",
                     "<!doctype html>\n<!-- elastocheck live -->\n@SCENE@\n");
    }
    std::string at(const std::string& name) const { return (folder.path / name).string(); }
};

// The scene in a page of one line.
nlohmann::json scene_in(const std::string& page) {
    const auto begin = page.find("live -->\n") + 9;
    return nlohmann::json::parse(page.substr(begin));
}

TEST(LiveCommand, SaysThatThePageIsNotBuilt) {
    const Program program;
    const std::string missing = "this program was built without the component 'live'";
    expect_said(says(program.call + "live " + bar + " -o " + program.at("live.html")), 2,
                {.err = {missing, "./dev live"}});
    expect_said(says(program.call + "report " + bar + " --quick --live -o " + program.at("report")),
                2, {.err = {missing}});
    EXPECT_FALSE(fs::exists(program.at("live.html")));
    EXPECT_FALSE(fs::exists(program.at("report")));
}

TEST(LiveCommand, PutsThePageBesideTheReport) {
    const Program program;
    program.with_page();
    expect_said(says(program.call + "report " + bar + " --quick --live -o " + program.at("with")),
                0);
    expect_said(says(program.call + "report " + bar + " --quick -o " + program.at("without")), 0);
    EXPECT_EQ(scene_in(text_of(program.at("with/live.html")))["text"], text_of(bar));
    expect_parts(text_of(program.at("with/report.html")), {"<a href=\"live.html\">"});
    expect_parts(text_of(program.at("without/report.html")), {}, {"live.html"});
    EXPECT_FALSE(fs::exists(program.at("without/live.html")));
}

TEST(LiveCommand, EmbedsTheSceneItsSettingsAndItsTables) {
    const Program program;
    program.with_page();
    std::string text = text_of(std::string(ELASTOCHECK_SCENES) + "/double_wishbone.yaml");
    const std::string rate = "bump_stop: {clearance: 0.025, rate: 400e3}";
    ASSERT_TRUE(contains(text, rate));
    text.replace(text.find(rate), rate.size(),
                 "bump_stop: {clearance: 0.025, curve: {file: tables/stop.csv}}");
    text.insert(0, "# </script> in a comment\n");
    const std::string scene = program.folder.write("scene.yaml", text);
    const std::string live = program.call + "live " + scene + " -o " + program.at("live.html");
    // A scene that is not valid leaves no page.
    expect_said(says(live), 2,
                {.err = {"scene.yaml:53: springs.coil.bump_stop.curve.file: 'tables/stop.csv': no "
                         "such file"}});
    EXPECT_FALSE(fs::exists(program.at("live.html")));

    fs::create_directory(program.folder.path / "tables");
    const std::string table = "deflection,force\n0,0\n0.015,9000\n";
    program.folder.write("tables/stop.csv", table);
    expect_said(says(live + " --set springs.coil.rate=90e3"), 0);
    const std::string page = text_of(program.at("live.html"));
    expect_parts(page, {}, {"</script>"});
    const auto data = scene_in(page);
    EXPECT_EQ(data["name"], "scene.yaml");
    EXPECT_EQ(data["files"], nlohmann::json({{"tables/stop.csv", table}}));
    expect_parts(data["text"], {"rate: 90e3", "# </script> in a comment"}, {"rate: 95e3"});
}

}  // namespace
}  // namespace elastocheck
