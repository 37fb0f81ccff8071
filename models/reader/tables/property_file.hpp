// Reads property files of Adams/Car in TeimOrbit format.
// Springs (.spr), bushings (.bus), bump and rebound stops (.bum, .reb), and the tables of
// hardpoints in subsystems (.sub).
//
//   $ a comment              to the end of the line
//   [BLOCK]                  a block; repeated ones are a list
//   (SUBBLOCK)               a table within it
//   {name name ...}          its columns, then rows of numbers or of words in single quotes
//   NAME = value             a number, a word, or text in single quotes, optionally with blanks
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/reader/tables/interpolant.hpp"

namespace elastocheck::reader {

struct PropertyTable {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
    std::vector<int> lines;  // of each row
};

struct PropertyBlock {
    std::string name, subblock = {};  // "FX_CURVE"; the name in brackets, of a subblock
    int line = 0;
    std::vector<std::pair<std::string, std::string>> values = {};  // in capitals, without quotes
    std::vector<int> lines = {};                                   // of each value
    PropertyTable table = {};
};

struct PropertyFile {
    std::string file;
    std::vector<PropertyBlock> blocks;
    double length = 1, angle = 1, force = 1;  // to m, rad, N

    const PropertyBlock* find(std::string_view block) const;
};

// Throws SceneError "file:line: ..." for text in another format.
PropertyFile parse_property_file(std::string_view text, const std::string& file);

// `text` as a finite number, up to `largest` in size. Throws SceneError with line and block.
double real(const PropertyFile& file, int line, const std::string& block, std::string_view text,
            double largest = std::numeric_limits<double>::max());

// The rows of a table with two columns of numbers as points of a law: first ascending, second non-decreasing.
std::vector<TablePoint> curve_rows(const PropertyFile& file, const PropertyBlock& block,
                                   double x_unit, double f_unit);

}  // namespace elastocheck::reader
