// `elastocheck solve`: rows written as points are found, only requested outputs, memory independent
// of the steps.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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
            const RunResult said = run_elastocheck(command);
            EXPECT_EQ(said.out, csv_of_kept_points(model, solver, 10)) << command;
            EXPECT_EQ(run_elastocheck(command + " -o " + file).code, said.code) << command;
            EXPECT_EQ(text_of(file), said.out) << command;
        }
    }
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
    const BlocksFile iso = blocks_of(expect_run(command, 0).out),
                     sae = blocks_of(expect_run(command + "--axes sae", 0).out);
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
            cells_of(run_elastocheck("solve " + scene + few + "--channels " + channels +
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
        run_elastocheck(
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
        blocks_of(expect_run(command + "--over parallel --set branches.parallel.steps=4", 0).out);
    const auto& toe = parallel.blocks.at("right.toe");
    EXPECT_EQ(toe.rows, (std::vector<double>{-0.08, -0.04, 0, 0.04, 0.08}));
    EXPECT_TRUE(toe.columns.empty());
    EXPECT_GT(std::abs(toe.values.front()[0]), 1e-3);
    expect_parts(toe.lines.at("rows"), {"downwards"});
    const BlocksFile opposite =
        blocks_of(expect_run(command + "--over opposite --set branches.opposite.steps=2", 0).out);
    expect_parts(opposite.blocks.at("right.toe").lines.at("rows"), {"as the scene counts it"});
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

}  // namespace
}  // namespace elastocheck
