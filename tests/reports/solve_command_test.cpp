// `elastocheck solve`: rows written as points are found, only requested outputs, memory independent
// of the steps.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "compare/comparison/legs.hpp"
#include "elastocheck/compile.hpp"
#include "reports/tables/csv.hpp"
#include "tests/reports/command.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck {
namespace {

// All rows at once, from stored paths.
std::string csv_of_kept_points(const Model& model, const compare::SolverSettings& solver,
                               int steps) {
    const auto channels = compare::channels(model);
    std::string csv = reports::curves_header(channels);
    for (const auto& branch : model.branches) {
        const auto ways = compare::sides_of(model, branch, steps);
        for (const auto& point : solve_branch(ways, solver).points)
            csv +=
                reports::curves_row(branch.name, solver.leg, compare::unit_of(branch.unit),
                                    compare::row_of(model, channels, ways.front(), solver, point));
    }
    return csv;
}

TEST(SolveCommand, WritesTheRowsOfThePointsBitByBitOnEveryScene) {
    const Folder folder;
    for (const auto& name : support::small_scene_names()) {
        const Model model = compile(support::scene(name));
        for (const char* method : {"published", "series", "equilibrium"}) {
            compare::SolverSettings solver;
            if (method == std::string("equilibrium"))
                solver.leg = compare::Leg::equilibrium;
            else
                solver.recursion.method = recursive::find_method(method).value();
            const auto file = (folder.path / (name + method + ".csv")).string();
            const auto command =
                fmt::format("solve {}/{}.yaml --steps 10 --method {}", scenes, name, method);
            const Said said = elastocheck_says(command);
            EXPECT_EQ(said.out, csv_of_kept_points(model, solver, 10)) << command;
            EXPECT_EQ(elastocheck_says(command + " -o " + file).code, said.code) << command;
            EXPECT_EQ(text_of(file), said.out) << command;
        }
    }
}

TEST(SolveCommand, IsTheEquilibriumLegUnlessAnotherMethodIsNamed) {
    const std::string command = "solve " + scenes + "/chrono_mcpherson.yaml --steps 4";
    const Said said = elastocheck_says(command);
    EXPECT_EQ(said.out, elastocheck_says(command + " --method equilibrium").out);
    expect_parts(said.out, {"\njounce,equilibrium,3000,"});
    EXPECT_TRUE(said.err.empty()) << said.err;
}

// A scene with these definitions, as `definitions:` writes them.
std::string with_definitions(const Folder& folder, const std::string& definitions) {
    const std::string file = (folder.path / "asked.yaml").string();
    std::ofstream(file) << text_of(scenes + "/double_wishbone_rigid.yaml")
                        << "\ndefinitions: " << definitions << "\n";
    return file;
}

TEST(SolveCommand, WritesTheDefinitionsThatASceneAsksFor) {
    const Folder folder;
    const std::string
        own = elastocheck_says("solve " + scenes + "/double_wishbone_rigid.yaml --steps 4").out,
        head = own.substr(0, own.find('\n'));
    const auto asked = [&](const std::string& definitions) {
        const Said said =
            expect_says("solve " + with_definitions(folder, definitions) + " --steps 4", 0);
        const std::string first = said.out.substr(0, said.out.find('\n'));
        EXPECT_EQ(first.find(head), 0u) << "the own outputs come first";
        return first.substr(std::min(first.size(), head.size()));
    };
    EXPECT_EQ(asked("{roll_centre_height: planes, camber: [kingpin, lateral]}"),
              ",roll_centre_height@planes [mm],camber@kingpin [deg],camber@lateral [deg]");
    EXPECT_EQ(asked("planes"), ",roll_centre_height@planes [mm],anti_dive@planes [%]");
    EXPECT_EQ(asked("[sae]"),
              ",mechanical_trail@ground_axes [mm],scrub_radius@ground_axes [mm],"
              "front_view_swing_arm@patch [mm],roll_centre_height@forces [mm]");
    expect_parts(asked("iso8855"), {"toe@steer [deg]", "scrub_radius@distance [mm]"});
}

TEST(SolveCommand, RefusesADefinitionThatDoesNotExistWithItsLine) {
    const Folder folder;
    const auto refused = [&](const std::string& definitions,
                             const std::vector<std::string>& parts) {
        const std::string file = with_definitions(folder, definitions);
        const Said said = elastocheck_says("solve " + file + " --steps 4");
        EXPECT_EQ(said.code, 2) << definitions;
        EXPECT_TRUE(said.out.empty());
        expect_parts(said.err, parts);
        expect_parts(said.err, {fmt::format("asked.yaml:{}: definitions",
                                            std::ranges::count(text_of(file), '\n'))});
    };
    refused("iso8850", {"there is no set 'iso8850'", "iso8855"});
    refused("{camber: kingpim}",
            {"definitions.camber: there is no definition 'kingpim'", "kingpin"});
    refused("{cambers: kingpin}",
            {"definitions.cambers: no figure with other definitions", "camber"});
    refused("{ackermann: error}", {"the scene has no ackermann by the definition 'error'"});
    refused("{camber: {a: b}}", {"definitions.camber"});
    refused("[]", {"an empty list"});
    refused("{camber: [planes]}", {"there is no definition 'planes'"});
}

// A row of the table is the branch with that value held.
TEST(ExportCommand, TableOverABranchAndAHeldValueEqualsSingleRuns) {
    const std::string command =
        "export " + scenes +
        "/double_wishbone_rigid.yaml --set branches.steering.steps=20 --over "
        "steering --rows travel=-0.02:0.02:5 --channels toe,camber ";
    const auto without_remarks = [](const std::string& csv) {
        std::string text;
        for (const auto& line : parts_of(csv, '\n'))
            if (!line.starts_with("#")) text += line + "\n";
        return text;
    };
    const Said lookup = expect_says(command + "--format lookup", 0);
    expect_parts(lookup.out, {"# Lookup table of elastocheck", "# toe [deg]: ", "positive toe-in"});
    const auto rows = cells_of(without_remarks(lookup.out));
    ASSERT_EQ(rows.size(), 1u + 5 * 21);
    EXPECT_EQ(rows[0][0], "travel [as in the scene]");
    EXPECT_EQ(rows[0][1], "steering [mm]");
    EXPECT_EQ(rows[0][2], "toe [deg]");
    const auto solved = cells_of(
        elastocheck_says("solve " + scenes +
                         "/double_wishbone_rigid.yaml --channels toe,camber --set "
                         "branches.steering.steps=20 --set branches.steering.hold.travel=0.01")
            .out);
    int found = 0;
    for (const auto& row : solved) {
        if (row[0] != "steering") continue;
        for (const auto& mine : rows)
            if (mine[0] == "0.01" &&
                std::abs(std::atof(mine[1].c_str()) - std::atof(row[2].c_str())) < 1e-9) {
                EXPECT_NEAR(std::atof(mine[2].c_str()), std::atof(row[4].c_str()), 1e-8);
                EXPECT_NEAR(std::atof(mine[3].c_str()), std::atof(row[5].c_str()), 1e-8);
                ++found;
            }
    }
    EXPECT_EQ(found, 21);
}

// The blocks of a file by name, "left.toe": rows, columns and values; coefficients by "name wheel".
struct BlocksFile {
    struct Block {
        std::vector<double> rows, columns;  // none: one column without a breakpoint
        std::vector<std::vector<double>> values;
        std::map<std::string, std::string> lines;  // "unit" -> "rad"
    };
    std::map<std::string, Block> blocks;
    std::map<std::string, std::vector<std::string>> coefficients;
};
BlocksFile blocks_of(const std::string& csv) {
    BlocksFile file;
    BlocksFile::Block* block = nullptr;
    bool in_data = false, in_coefficients = false;
    for (const auto& line : parts_of(csv, '\n')) {
        const auto cells = parts_of(line, ',');
        if (line.empty() || line.starts_with("#")) {
            in_data = false;
        } else if (cells[0] == "coefficient") {
            in_coefficients = true;
        } else if (in_coefficients) {
            file.coefficients[cells[0] + " " + cells[1]] = cells;
        } else if (cells[0] == "block") {
            block = &file.blocks[cells[1]];
        } else if (cells[0] == "data") {
            in_data = true;
            for (std::size_t k = 1; k < cells.size(); ++k)
                if (cells[k] != "value") block->columns.push_back(std::stod(cells[k]));
        } else if (in_data) {
            block->rows.push_back(std::stod(cells[0]));
            auto& row = block->values.emplace_back();
            for (std::size_t k = 1; k < cells.size(); ++k) row.push_back(std::stod(cells[k]));
        } else {
            block->lines[cells[0]] = line.substr(cells[0].size() + 1);
        }
    }
    return file;
}

// Every node of every block, in both axes, is what `solve` finds there, turned by hand: x is the same
// in both, y and z and angles about z change their sign; the parameter in m, angles in rad.
TEST(ExportCommand, BlocksOverTravelAndRackEqualSolve) {
    const std::string scene = scenes + "/front_axle.yaml ",
                      few = "--set branches.steering.steps=4 ",
                      command = "export " + scene + few +
                                "--format blocks --over steering --rows "
                                "left.travel,right.travel=-0.04:0.04:3 ";
    constexpr double degree = 3.14159265358979323846 / 180;
    const BlocksFile iso = blocks_of(expect_says(command, 0).out),
                     sae = blocks_of(expect_says(command + "--axes sae", 0).out);
    ASSERT_EQ(iso.blocks.size(), 18u);
    ASSERT_EQ(sae.blocks.size(), 18u);
    // column of solve, factor to ISO, sign in SAE against ISO
    struct Case {
        const char *block, *output;
        double factor, sae;
    };
    const Case cases[] = {{"left.toe", "left.toe", degree, 1},
                          {"right.toe", "right.toe", degree, 1},
                          {"left.steer", "left.toe", -degree, -1},
                          {"right.steer", "right.toe", degree, -1},
                          {"left.camber", "left.camber", degree, 1},
                          {"right.camber", "right.camber", degree, 1},
                          {"left.inclination", "left.camber", -degree, 1},
                          {"right.inclination", "right.camber", degree, 1},
                          {"right.caster", "right.caster", degree, 1},
                          {"right.kingpin_inclination", "right.kingpin_inclination", degree, 1},
                          {"left.lateral", "left.wheel_centre_y", 1e-3, -1},
                          {"right.lateral", "right.wheel_centre_y", 1e-3, -1},
                          {"right.longitudinal", "right.wheel_centre_x", 1e-3, 1},
                          {"left.wheel_rate", "left.wheel_rate", 1e3, 1}};
    std::string channels;
    for (const auto& one : cases)
        channels += (channels.empty() ? "" : ",") + std::string(one.output);
    const std::map<std::string, double> drawn{{"left.wheel_centre_y", 1.1},
                                              {"right.wheel_centre_y", -1.1},
                                              {"right.wheel_centre_x", -0.04}};
    int compared = 0;
    for (const double travel : {-0.04, 0.0, 0.04}) {
        const std::string held = fmt::format("{:g}", travel);
        const auto solved =
            cells_of(elastocheck_says("solve " + scene + few + "--channels " + channels +
                                      " --set branches.steering.hold.left.travel=" + held +
                                      " --set branches.steering.hold.right.travel=" + held)
                         .out);
        for (const auto& row : solved) {
            if (row[0] != "steering") continue;
            const double rack = std::stod(row[2]) / 1e3;
            for (const Case& one : cases) {
                const auto column = std::ranges::find_if(
                                        solved[0],
                                        [&](const std::string& head) {
                                            return head.starts_with(std::string(one.output) + " [");
                                        }) -
                                    solved[0].begin();
                ASSERT_LT(column, std::ssize(solved[0])) << one.output;
                const auto at = drawn.find(one.output);
                const double expected =
                    one.factor * std::stod(row[static_cast<std::size_t>(column)]) -
                    (at == drawn.end() ? 0 : at->second);
                for (const bool is_sae : {false, true}) {
                    const auto& block = (is_sae ? sae : iso).blocks.at(one.block);
                    const double down = is_sae ? -1 : 1, sign = is_sae ? one.sae : 1;
                    ASSERT_TRUE(std::ranges::is_sorted(block.rows));
                    ASSERT_TRUE(std::ranges::is_sorted(block.columns));
                    for (std::size_t r = 0; r < block.rows.size(); ++r)
                        for (std::size_t c = 0; c < block.columns.size(); ++c)
                            if (std::abs(block.rows[r] - down * travel) < 1e-12 &&
                                std::abs(block.columns[c] - rack) < 1e-12) {
                                EXPECT_NEAR(block.values[r][c], sign * expected,
                                            1e-9 * std::max(1., std::abs(expected)))
                                    << one.block << (is_sae ? " sae " : " iso ") << travel << " "
                                    << rack;
                                ++compared;
                            }
                }
            }
        }
    }
    EXPECT_EQ(compared, 3 * 5 * 14 * 2);
    EXPECT_EQ(iso.blocks.at("left.toe").lines.at("unit"), "rad");
    EXPECT_EQ(iso.blocks.at("left.wheel_rate").lines.at("unit"), "N/m");
    EXPECT_EQ(iso.blocks.at("left.toe").lines.at("columns"),
              "\"steering\",m,\"as the scene counts it\"");
    expect_parts(iso.blocks.at("left.toe").lines.at("rows"), {"upwards: jounce is positive"});
    expect_parts(sae.blocks.at("left.toe").lines.at("rows"), {"downwards: jounce is negative"});

    // coefficients: solve's, in deg/kN and deg/(100 N·m)
    const auto solved = cells_of(
        elastocheck_says(
            "solve " + scene + few +
            "--channels left.lateral_force_steer@parallel,left.aligning_torque_steer@opposed")
            .out);
    for (const auto& row : solved)
        if (row[0] == "steering" && std::stod(row[2]) == 0) {
            const double lateral = std::stod(row[4]), aligning = std::stod(row[5]);
            const auto& steer = iso.coefficients.at("lateral_force_steer@parallel left");
            EXPECT_NEAR(std::stod(steer[2]), lateral * degree / 1e3,
                        1e-6 * std::abs(lateral) / 1e3);
            EXPECT_EQ(steer[3], "rad/N");
            EXPECT_NEAR(std::stod(steer[4]), lateral / 1e3, 1e-6 * std::abs(lateral) / 1e3);
            EXPECT_EQ(steer[5], "deg/N");
            const auto& torque = iso.coefficients.at("aligning_torque_steer@opposed left");
            EXPECT_NEAR(std::stod(torque[4]), aligning / 100, 1e-6 * std::abs(aligning) / 100);
            EXPECT_EQ(torque[5], "deg/(N·m)");
            EXPECT_EQ(sae.coefficients.at("lateral_force_steer@parallel left"), steer);
            ++compared;
        }
    EXPECT_EQ(compared, 3 * 5 * 14 * 2 + 1);
}

// Without a second variable the rows are the branch; its parameter is a travel only if it lifts wheel
// centres alike.
TEST(ExportCommand, WritesBlocksOverOneVariable) {
    const std::string command = "export " + scenes + "/front_axle.yaml --format blocks --axes sae ";
    const BlocksFile parallel =
        blocks_of(expect_says(command + "--over parallel --set branches.parallel.steps=4", 0).out);
    const auto& toe = parallel.blocks.at("right.toe");
    EXPECT_EQ(toe.rows, (std::vector<double>{-0.08, -0.04, 0, 0.04, 0.08}));
    EXPECT_TRUE(toe.columns.empty());
    EXPECT_GT(std::abs(toe.values.front()[0]), 1e-3);
    expect_parts(toe.lines.at("rows"), {"downwards"});
    const BlocksFile opposite =
        blocks_of(expect_says(command + "--over opposite --set branches.opposite.steps=2", 0).out);
    expect_parts(opposite.blocks.at("right.toe").lines.at("rows"), {"as the scene counts it"});
    expect_says(command + "--over parallel --channels toe", 2, {.err = {"have their own outputs"}});
    expect_says("export " + scenes + "/pendulum.yaml --format blocks --over up", 2,
                {.err = {"the scene has no wheel"}});
    expect_says("export " + scenes + "/front_axle.yaml --format lookup --over parallel --axes sae",
                2, {.err = {"--axes: only with --format blocks"}});
}

// The line says what the two solutions differ by at the end, in the output that differs most.
TEST(SolveCommand, FastMethodReportsItsErrorAtEveryEnd) {
    const std::string command = "solve " + scenes + "/chrono_mcpherson.yaml --steps 20 ";
    const auto right = cells_of(elastocheck_says(command).out);
    for (const char* method : {"published", "tangent"}) {
        const Said said = expect_says(command + "--method " + method, 0);
        const auto rows = cells_of(said.out);
        ASSERT_EQ(rows.size(), right.size());
        for (const std::size_t end : {21u, 42u}) {
            double off = 0;
            std::string channel;
            for (std::size_t c = 4; c < 7; ++c)  // wheel_centre_x, _y, _z
                if (const double by = std::abs(std::stod(rows[end][c]) - std::stod(right[end][c]));
                    by > off)
                    off = by, channel = rows[0][c].substr(0, rows[0][c].find(' '));
            expect_parts(said.err, {fmt::format("{}: {}: off by {:.2g} mm ({}) and ", method,
                                                rows[end][0], off, channel),
                                    fmt::format(" at {} N, the end, from the equilibrium "
                                                "leg there\n",
                                                rows[end][2])});
        }
    }
    const Said two_sided = elastocheck_says("solve " + scenes +
                                            "/double_wishbone_rigid.yaml --steps 20 --method "
                                            "published --channels toe");
    expect_parts(two_sided.err, {" at -80 mm, the end,", " at 80 mm, the end,"});
    for (const char* method : {"equilibrium", "energy", "series"})
        expect_parts(elastocheck_says(command + "--method " + method).err, {}, {"off by"});
}

// -0.06 m in 30 steps and -60 deg in rad: neither is a sum of increments or a product of factors.
TEST(SolveCommand, ParametersAreExactAtTheEndsOfABranch) {
    int ends = 0;
    for (const char* scene : {"front_axle", "double_wishbone_rigid", "slider_crank", "four_bar"}) {
        const std::string file = scenes + "/" + scene + ".yaml";
        const auto part =
            nlohmann::json::parse(elastocheck_says("inspect " + file + " --json").out);
        for (const char* method : {"equilibrium", "published", "adaptive", "series"}) {
            if (scene == std::string("front_axle") && method == std::string("adaptive")) continue;
            const auto rows = cells_of(
                elastocheck_says("solve " + file + " --method " + method + " --channels '*'").out);
            std::map<std::string, std::pair<std::string, std::string>> reached;
            for (std::size_t r = 1; r < rows.size(); ++r) {
                EXPECT_LE(rows[r][2].size(), 17u) << rows[r][2];
                reached.try_emplace(rows[r][0], rows[r][2], "").first->second.second = rows[r][2];
            }
            for (const auto& branch :
                 part["scenes"][0]["results"][0]["tables"]["branches"]["rows"]) {
                const auto& [from, to] = reached.at(branch[0]);
                EXPECT_EQ(std::stod(from), std::round(std::stod(from))) << scene << method << from;
                EXPECT_EQ(std::stod(to), std::round(std::stod(to))) << scene << method << to;
                ++ends;
            }
        }
    }
    EXPECT_GT(ends, 30);
}

TEST(SolveCommand, RequestedChannelsAreColumnsInTheirOrder) {
    const std::string command = "solve " + scenes + "/chrono_mcpherson.yaml --steps 3";
    const auto all = cells_of(elastocheck_says(command).out);
    const auto expect = [&](const std::string& asked, const std::vector<std::string>& heads) {
        const Said said = expect_says(command + " --channels " + asked, 0);
        const auto some = cells_of(said.out);
        ASSERT_EQ(some.size(), all.size());
        ASSERT_EQ(some[0].size(), 4 + heads.size()) << said.out;
        for (std::size_t c = 0; c < some[0].size(); ++c) {
            if (c >= 4) {
                EXPECT_EQ(some[0][c], heads[c - 4]);
            }
            const auto at =
                static_cast<std::size_t>(std::ranges::find(all[0], some[0][c]) - all[0].begin());
            for (std::size_t row = 0; row < all.size(); ++row)
                EXPECT_EQ(some[row][c], all[row][at]);
        }
    };
    expect("toe", {"toe [deg]"});
    expect("camber,wheel_centre_x", {"camber [deg]", "wheel_centre_x [mm]"});
    expect("camber --channels toe,camber", {"camber [deg]", "toe [deg]"});
    expect("'wheel_centre_*'",
           {"wheel_centre_x [mm]", "wheel_centre_y [mm]", "wheel_centre_z [mm]"});
    expect("travel,'ball_joint.force_?','*_joint.force_z'",
           {"travel [mm]", "ball_joint.force_x [N]", "ball_joint.force_y [N]",
            "ball_joint.force_z [N]"});
}

// Element forces are columns only if requested; checked against the closed form of the scene.
TEST(SolveCommand, RequestedElementForcesAreColumns) {
    const std::string command =
        "solve " + scenes + "/tyre_on_road.yaml --steps 10 --method equilibrium";
    expect_parts(elastocheck_says(command).out, {}, {"suspension.force"});
    const auto rows = cells_of(
        elastocheck_says(command + " --channels 'suspension.*','tyre.force',wheel_centre_z").out);
    ASSERT_GT(rows.size(), 20u);
    EXPECT_EQ(rows[0], (std::vector<std::string>{
                           "branch", "leg", "parameter", "unit", "suspension.compression [mm]",
                           "suspension.motion_ratio [-]", "suspension.deflection [mm]",
                           "suspension.force [N]", "tyre.force [N]", "wheel_centre_z [mm]"}));
    for (std::size_t r = 1; r < rows.size(); ++r) {
        const double z = std::stod(rows[r][9]), h = std::stod(rows[r][2]);
        EXPECT_NEAR(std::stod(rows[r][4]), z, 1e-6);
        EXPECT_NEAR(std::stod(rows[r][5]), 1, 1e-9);
        EXPECT_NEAR(std::stod(rows[r][7]), 3500 + 30 * z, 1e-5);
        if (rows[r][0] == "road") {
            EXPECT_NEAR(std::stod(rows[r][8]), 3892.4 + 200 * (h - z), 1e-5);
        }
        if (rows[r][0] == "wheel") {
            EXPECT_EQ(rows[r][8], "") << "no tyre stands there";
        }
    }
}

TEST(SolveCommand, EveryNthStepIsOneOfTheSameRows) {
    // Two branches of 20 steps, from a = 0 each.
    for (const char* method : {"published", "adaptive", "series"}) {
        const auto command =
            fmt::format("solve {}/bushing_pair.yaml --steps 20 --method {}", scenes, method);
        const auto all = parts_of(elastocheck_says(command).out, '\n');
        ASSERT_EQ(all.size(), 1u + 2 * 21);
        for (const int every : {1, 6, 10, 19, 20}) {
            std::vector<std::string> expected{all[0]};
            for (const int branch : {0, 1})
                for (int k = 0; k <= 20; ++k)
                    if (k % every == 0 || k == 20)
                        expected.push_back(all[static_cast<std::size_t>(1 + 21 * branch + k)]);
            const auto some =
                parts_of(elastocheck_says(fmt::format("{} --every {}", command, every)).out, '\n');
            EXPECT_EQ(some, expected) << method << " " << every;
        }
    }
    for (const char* method : {"equilibrium", "energy"}) {
        const auto rows =
            parts_of(elastocheck_says(fmt::format("solve {}/bushing_pair.yaml --steps 20 --every 8 "
                                                  "--method {}",
                                                  scenes, method))
                         .out,
                     '\n');
        EXPECT_EQ(rows.size(), 1u + 2 * 4) << method;
    }
}

TEST(CompareCommand, EveryNthStepIsCompared) {
    const Folder folder;
    const std::string scene = scenes + "/bushing_pair.yaml", out = (folder.path / "out").string();
    expect_says("compare " + scene + " --steps 40 --every 15 -o " + out, 0);
    // scene, branch, leg, parameter, its unit, output, unit, value: those of the recursion equal
    // the output of `solve`.
    const auto all = cells_of(text_of(out + "/curves.csv"));
    std::vector<std::vector<std::string>> written, expected;
    std::set<std::string> visited;
    for (const auto& row : all) {
        if (row[5] != "nose_z") continue;
        if (row[2] == "recursive") written.push_back({row[1], row[3], row[7]});
        if (row[2] == "energy") visited.insert(row[1] + row[3]);
    }
    const auto solved =
        cells_of(elastocheck_says("solve " + scene +
                                  " --method published --steps 40 --every 15 --channels nose_z")
                     .out);
    for (const auto& row : solved)
        if (row[1] == "recursive") expected.push_back({row[0], row[2], row[4]});
    EXPECT_EQ(written, expected);
    EXPECT_EQ(written.size(), 2u * 4);  // 0, 15, 30, 40
    EXPECT_EQ(visited.size(), 2u * 4) << "the references are asked for no more";
}

// One side of the arch passes its limit point, at -211.5 N.
TEST(SolveCommand, RowsBeforeAFailureAreWrittenAndTheCodeIs3) {
    const Folder folder;
    const std::string arch = text_of(scenes + "/two_spring_arch.yaml");
    const auto branches = arch.find("branches:"), probes = arch.find("probes:");
    for (const bool first : {true, false}) {
        const auto scene = fmt::format(
            "{}branches: {{push: {{load: vertical, from: {}, to: {}, steps: 60}}}}\n{}",
            arch.substr(0, branches), first ? -300 : 300, first ? 300 : -300, arch.substr(probes));
        const std::string command =
            "solve " + folder.write("arch.yaml", scene) + " --method equilibrium --channels apex_z";
        const Said said =
            expect_says(command, 3, {.err = {"equilibrium: limit point: push to -300 N: "}});
        const auto rows = cells_of(said.out);
        ASSERT_EQ(rows.size(), 1u + 52) << said.out;  // -210 to 300 N
        EXPECT_EQ(std::stod(rows[1][2]), first ? -210 : 300);
        EXPECT_EQ(std::stod(rows[52][2]), first ? 300 : -210);
        for (std::size_t k = 2; k < rows.size(); ++k)
            EXPECT_NEAR(std::stod(rows[k][2]) - std::stod(rows[k - 1][2]), first ? 10 : -10, 1e-9);
        const auto file = (folder.path / "rows.csv").string();
        expect_says(command + " -o " + file, 3);
        EXPECT_EQ(text_of(file), said.out) << "what was reached is written";
    }
}

TEST(SolveCommand, RatesAreOfTheSamePointsAndChannels) {
    const Folder folder;
    const auto file = (folder.path / "rates.csv").string();
    const std::string command =
        "solve " + scenes + "/chrono_mcpherson.yaml --method series --steps 20 --every 8 --rates " +
        file;
    const Said said = expect_says(command + " --channels toe,ball_joint.force_x", 0);
    const auto rows = cells_of(said.out), rates = cells_of(text_of(file));
    ASSERT_EQ(rates.size(), rows.size());
    for (std::size_t k = 1; k < rows.size(); ++k) EXPECT_EQ(rates[k][1], rows[k][2]);
    EXPECT_EQ(rates[0], (std::vector<std::string>{"branch", "parameter", "parameter unit",
                                                  "toe [deg per parameter unit]"}));
    expect_says(command + " --channels '*force_x'", 2);
}

TEST(SolveCommand, ClosedOutputPipeEndsItWithoutAMessage) {
    const std::string command =
        std::string(ELASTOCHECK_COMMAND) + " solve " + scenes + "/pinned_bar.yaml --steps 20000";
    // Exit code of a shell for a filter ended by SIGPIPE, also where the signal is ignored.
    for (const char* shell : {"bash -o pipefail -c '", "bash -o pipefail -c 'trap \"\" PIPE; "}) {
        const Said said = expect_said(support::says(shell + command + " | head -1'"), 141);
        EXPECT_TRUE(said.out.starts_with("branch,leg,parameter,unit,")) << said.out;
        EXPECT_TRUE(said.err.empty()) << said.err;
    }
}

// Maximum resident memory of a command [kB].
long memory_of(const std::vector<std::string>& words) {
    std::vector<char*> argv;
    for (const auto& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    int status = -1;
    struct rusage used {};
    EXPECT_EQ(::wait4(child, &status, 0, &used), child);
    EXPECT_EQ(status, 0);
    return used.ru_maxrss;
}

TEST(SolveCommand, MemoryDoesNotGrowWithTheStepsItTakes) {
    // The least of three runs: it counts the program's pages that happen to be mapped too, 1 MB now
    // and then.
    const auto memory = [](const std::string& method, const std::string& steps) {
        long least = std::numeric_limits<long>::max();
        for (int run = 0; run < 3; ++run)
            least = std::min(
                least, memory_of({ELASTOCHECK_COMMAND, "solve", scenes + "/pinned_bar.yaml",
                                  "--method", method, "--channels", "tip_z", "--steps", steps}));
        return least;
    };
    for (const char* method : {"published", "series"}) {
        const long few = memory(method, "5000"), many = memory(method, "55000");
        EXPECT_GT(few, 1000);
        EXPECT_LE(many, few + 1000) << method;  // storing a point per step would take 10 MB
    }
}

// 40 kg on the hub and 4000 N under the wheel: the road exerts what is applied to the tyre.
TEST(SolveCommand, PrintsTheForceOfTheRoad) {
    const Folder folder;
    const std::string file = folder.write("wheel_load.yaml", R"(elastocheck: 1
name: Semi-trailing arm
units: {length: mm, angle: deg, force: N}
points: {outer: [500, 900, 0], inner: [420, 600, -50], seat: [150, 800, 0], top: [150, 800, 300],
         centre: [0, 1100, 0], patch: [0, 1100, -320]}
bodies: {arm: {origin: seat}, hub: {origin: centre, mass: 40}}
gravity: [0, 0, -9.81]
joints:
  axis: {type: revolute, bodies: [arm, ground], at: outer, axis: [inner, outer]}
  hub: {type: fixed, bodies: [arm, hub], at: centre}
springs: {coil: {bodies: [arm, ground], from: seat, to: top, rate: 90, preload: 3000}}
loads: {vertical: {on: hub, at: patch, force: [0, 0, 1]}}
trim: {adjust: [springs.coil.preload], until: {travel: 0}, under: {vertical: 4000}}
branches: {travel: {drive: travel, from: -60, to: 60, steps: 2}}
wheel: {body: hub, centre: centre, contact_patch: patch, spin_axis: y, side: left}
)");
    for (const char* method : {"series", "equilibrium", "energy"}) {
        const std::string out =
            expect_says(fmt::format("solve --channels wheel_load --method {} {}", method, file), 0)
                .out;
        const std::string at_rest = ",0,mm,";
        ASSERT_TRUE(contains(out, at_rest)) << out;
        EXPECT_NEAR(std::stod(out.substr(out.find(at_rest) + at_rest.size())), 4000, 1e-6)
            << method;
    }
}

}  // namespace
}  // namespace elastocheck
