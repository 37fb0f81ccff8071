// Runs the elastocheck command in tests; paths of the built-in scenes, and a reader of its CSV.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "tests/benchmark/families.hpp"
#include "tests/support/command.hpp"

namespace elastocheck {

using support::contains;
using support::expect_parts;
using support::expect_result;
using support::Folder;
using support::Parts;
using support::RunResult;
using support::text_of;

inline const std::string scenes = ELASTOCHECK_SCENES;

// Runs `elastocheck ARGUMENTS` as in an interactive session: CI is unset.
inline support::RunResult run_elastocheck(const std::string& arguments) {
    return support::shell("env -u CI -u GITHUB_STEP_SUMMARY " ELASTOCHECK_COMMAND " " + arguments);
}

// Runs `elastocheck ARGUMENTS` and expects its exit code and parts of its output.
inline RunResult expect_run(const std::string& arguments, int code, const Parts& parts = {},
                            std::source_location at = std::source_location::current()) {
    return expect_result(run_elastocheck(arguments), code, parts, at);
}

// A chain of this many bodies on bushings. With 15, `trade` takes few of its up to a million steps:
// their number is limited by the size of the scene.
inline std::string chain_of(int bodies) { return families::scene({families::Kind::chain, bodies}); }

inline std::vector<std::string> parts_of(const std::string& text, char between) {
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, between);) parts.push_back(part);
    return parts;
}

// Cells by row, the head first. Pre: no cell is quoted.
inline std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& line : parts_of(csv, '\n')) rows.push_back(parts_of(line, ','));
    return rows;
}

}  // namespace elastocheck
