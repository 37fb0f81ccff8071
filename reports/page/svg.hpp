// Converts gnuplot's SVG for light and dark pages, stand-alone or inline, with alternative text.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace elastocheck::reports {

// Colour-blind-safe palette with variants for dark background, in the order of Colour in page.hpp.
// Scripts use the light variants.
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
    std::string alone;    // a file with its own style sheet and background
    std::string inlined;  // for a page that styles .e-s0 ... .e-k9 and .e-paper
};

// Removes unused parts, turns palette colours into classes (e-s stroke, e-f fill, e-k both through
// currentColor), prefixes every id with `id`, and adds title and description. Throws PlotError when
// `svg` is not a complete SVG.
Illustration illustrate(const std::string& svg, const std::string& id, const std::string& title,
                        const std::string& description);

}  // namespace elastocheck::reports
