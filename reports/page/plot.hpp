// Draws figures (line plots, bar charts, drawings) as SVG files with their data.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/page/page.hpp"
#include "reports/page/svg.hpp"

namespace elastocheck::reports {

struct Plot {
    const Figure* figure = nullptr;
    std::string name;  // of its files, without extension
};

// The figure as SVG: axes with round ticks, a legend above, series; or the sheet of a drawing.
Svg draw(const Figure& figure);

// Writes figures/NAME.svg and NAME.csv into `folder`; one picture per plot. The k-th picture's ids
// begin with "fk", counted from 1. The data: the columns series, x, y (bars also x low, x high,
// y low, y high); one block per series, separated by two blank lines, with one blank line at a gap.
// Throws FileError.
std::vector<Illustration> draw(const std::vector<Plot>& plots, const std::filesystem::path& folder);

}  // namespace elastocheck::reports
