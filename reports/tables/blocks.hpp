// Blocks of kinematics and compliance in SI units, as lookup tables of vehicle models take them
// (`export --format blocks`).
#pragma once

#include <string>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reports {

// Axes of what is written: x forward, y left, z up (ISO 8855), or x forward, y right, z down
// (SAE J670).
enum class BlockAxes { iso, sae };

// A variable of the blocks. Travel of wheel centres counts upwards, as in scenes; the writer turns it.
struct Breakpoints {
    std::string name;  // "travel", "joints.rack"
    std::string unit;  // "m", "rad", "N", "N·m"
    std::vector<double> values;
    bool is_travel = false;  // of wheel centres
};

struct WheelOutput {
    compare::Channel channel;
    std::string output;  // without the name of the wheel
    std::string wheel;   // its name, "left" or "right" where it has none
    int side = +1;       // of the wheel: +1 left
};
// The outputs of the model that become blocks, and its compliance at the design position.
std::vector<WheelOutput> block_outputs(const Model& model);
std::vector<WheelOutput> compliance_outputs(const Model& model);

struct KCBlocks {
    std::string scene;
    Breakpoints x, y;  // of `values`; y without a name: no second variable
    std::vector<WheelOutput> outputs;
    std::vector<std::vector<std::vector<double>>> values;  // [y][x][output], in their units
    std::vector<WheelOutput> compliance;
    std::vector<double> coefficients;  // of `compliance`, in their units
};

inline constexpr const char* blocks_head = "# K&C blocks of elastocheck";

// A block for each output: lines "block", "quantity", "wheel", "unit", "definition", "rows",
// "columns", then the line "data" with the breakpoints of the columns, and a line for each breakpoint
// of the rows. The rows are the travel where one of the variables is. Then the coefficients of
// compliance, a line each.
std::string blocks_csv(const KCBlocks& blocks, BlockAxes axes);

}  // namespace elastocheck::reports
