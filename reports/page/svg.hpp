// gnuplot's SVG -> one that reads in dark and light, alone or in a page, with or without eyes.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace elastocheck::reports {

// Safe for the colour-blind, each with a twin for dark paper.
// Order: page.hpp, Colour. Scripts use the light ones.
struct Tint {
    std::string_view light, dark;  // "#rrggbb"
};
inline constexpr std::array<Tint, 10> palette{{
    {"#22272e", "#e4e8ee"},  // ink
    {"#c4420f", "#f58b62"},  // vermilion
    {"#1b62a5", "#74b3ec"},  // blue
    {"#0a8468", "#45c9a6"},  // green
    {"#85479e", "#cb9ae0"},  // purple
    {"#a87600", "#e3b544"},  // ochre
    {"#6b7480", "#98a2b0"},  // slate
    {"#c94f83", "#f291bb"},  // pink
    {"#2a93c0", "#79d0f0"},  // sky
    {"#d9dee4", "#38404a"},  // faint
}};

struct Illustration {
    std::string alone;    // a file of its own, with a style sheet and paper of its own
    std::string inlined;  // to stand in a page that styles .e-s0 ... .e-k9 and .e-paper
};

// Removes what gnuplot leaves unused, turns palette colours into classes (e-s stroke, e-f fill, e-k both
// through currentColor), prefixes every id with `id`, and gives it a name and a description. Throws
// PlotError when `svg` is no whole SVG.
Illustration illustrate(const std::string& svg, const std::string& id, const std::string& title,
                        const std::string& description);

}  // namespace elastocheck::reports
