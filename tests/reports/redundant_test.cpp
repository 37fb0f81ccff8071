// Scenes whose joints share loads in a way that the loads do not determine, and scenes on which
// little or nothing moves: the verdict is on the numbers that were asked for.
#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

const std::string own = ELASTOCHECK_REDUNDANT_SCENES "/";

// Values at the last point of the branch; NaN: an empty cell.
std::map<std::string, double> end_of(const std::string& scene, const std::string& method) {
    const Said said = expect_says("solve " + own + scene + ".yaml --method " + method, 0);
    const auto rows = cells_of(said.out);
    std::map<std::string, double> values;
    for (std::size_t c = 5; c < rows.front().size(); ++c) {
        const std::string& name = rows.front()[c];
        const bool empty = c >= rows.back().size() || rows.back()[c].empty();
        if (!empty || contains(name, "."))
            values[name] = empty ? std::nan("") : std::stod(rows.back()[c]);
    }
    return values;
}

std::set<std::string> of(const std::vector<std::string>& joints,
                         const std::vector<std::string>& components) {
    std::set<std::string> names;
    for (const auto& joint : joints)
        for (const auto& component : components)
            names.insert(joint + "." + component +
                         (contains(component, "force") ? " [N]" : " [N·m]"));
    return names;
}

TEST(Redundant, AReactionThatTheLoadsDoNotDetermineIsEmptyByEveryMethodAndTheOthersAgree) {
    const std::map<std::string, std::set<std::string>> undetermined{
        {"two_hinges",
         of({"front", "rear"}, {"force_x", "force_y", "force_z", "moment_y", "moment_z"})},
        {"two_balls", of({"front", "rear"}, {"force_x"})},
        {"ball_and_slide", {}},
        {"four_bar", of({"a", "b", "c", "d"}, {"force_y", "moment_x", "moment_z"})},
        // under load the axis of the hinges tilts
        {"hinges_on_a_frame", of({"one", "two"}, {"force_x", "force_y", "force_z", "moment_x",
                                                  "moment_y", "moment_z"})}};
    for (const auto& [scene, expected] : undetermined) {
        const auto truth = end_of(scene, "equilibrium");
        for (const char* method :
             {"equilibrium", "energy", "series", "adaptive", "published", "tangent"}) {
            const auto values = end_of(scene, method);
            std::set<std::string> empty;
            for (const auto& [name, value] : values)
                if (std::isnan(value)) empty.insert(name);
            // The constraint error of a fast method can leave more empty.
            if (method == std::string("published") || method == std::string("tangent")) {
                EXPECT_TRUE(std::ranges::includes(empty, expected)) << scene << ", " << method;
                continue;
            }
            EXPECT_EQ(empty, expected) << scene << ", " << method;
            for (const auto& [name, value] : values)
                if (!std::isnan(value)) {
                    EXPECT_NEAR(value, truth.at(name), 1e-5 + 1e-7 * std::abs(value))
                        << scene << ", " << method << ": " << name;
                }
        }
    }
}

TEST(Redundant, TheSumOfTheJointsIsAnOutputOfEveryCommand) {
    const std::string scene = own + "two_hinges.yaml", sum = "front+rear.force_y";
    std::set<std::string> values;
    for (const char* method : {"equilibrium", "energy", "series"}) {
        const Said said = expect_says(
            "solve " + scene + " --channels " + sum + ",front.force_y --method " + method, 0,
            {.err = {"no value of front.force_y: redundant joints share it"}});
        const auto row = cells_of(said.out).back();
        values.insert(row.at(4).substr(0, 9));
    }
    EXPECT_EQ(values, std::set<std::string>{"114.30469"});
    expect_says("solve " + scene + " --channels front+top.force_y", 2, {.err = {"front+rear"}});
    expect_says("sensitivity " + scene + " --of " + sum + " --to springs.coil.rate", 0,
                {.out = {sum}});
    expect_says("sensitivity " + scene + " --of front.force_y --to springs.coil.rate", 3,
                {.out = {"front.force_y: redundant joints share it"}});
    expect_says(
        "solve-for " + scene + " --want " + sum + "@b:3000=100 --vary springs.coil.rate=50:150", 0,
        {.out = {sum}});
    expect_says(
        "solve-for " + scene + " --want front.force_y@b:3000=1000 --vary springs.coil.rate=50:150",
        3, {.err = {"front.force_y: redundant joints share it"}});
    const Folder folder;
    folder.write("t.yaml", "springs.coil.rate: {normal: {sd: 2}}\n");
    const std::string scatter = "tolerances " + scene + " " + (folder.path / "t.yaml").string();
    expect_says(scatter + " --of " + sum + "@b:3000", 0, {.out = {sum}});
    expect_says(scatter + " --of front.force_y@b:3000", 3, {.out = {"redundant joints share it"}});
    const std::string table = (folder.path / "c.csv").string();
    expect_says("solve " + scene + " -o " + table, 0);
    folder.write("c.csv", std::regex_replace(text_of(table), std::regex(",,"), ",0,"));
    expect_says("judge " + scene + " --candidate " + table, 0,
                {.out = {"not compared: front.force_x, front.force_y, "}});
}

// ---- Verdicts.

TEST(Verdict, RigidAndRedundantSuspensionsAreJudged) {
    const Folder folder;
    for (const char* scene : {"rigid_link_forces", "arm_two_revolutes", "wishbone_two_revolutes"}) {
        const std::string file = own + scene + ".yaml",
                          out = " -o " + (folder.path / scene).string();
        expect_says("compare " + file, 0, {.out = {"conclusive: "}, .not_out = {"nan", "inf"}});
        for (const char* how : {" --only kc", " --quick", ""})
            expect_says("report " + file + how + out, 0, {.out = {": judged"}});
    }
}

}  // namespace
}  // namespace elastocheck
