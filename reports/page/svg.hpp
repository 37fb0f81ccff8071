// Writes SVG figures for light and dark pages, stand-alone or inline, with alternative text.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "reports/page/page.hpp"
#include "reports/text/labels.hpp"

namespace elastocheck::reports {

// Colour-blind-safe palette with variants for dark background, in the order of Colour in page.hpp.
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

nlohmann::ordered_json tints();  // of the palette, for the style sheet of pages

// Elements of an SVG image in drawing order. Coordinates are pixels from the upper left corner, y
// down, written with one decimal in every locale. Colours are classes of the style sheet: e-s0 ...
// e-s9 stroke, e-f0 ... e-f9 fill.
struct Svg {
    int width = 0, height = 0;  // [px]
    double letter = 11;         // [px] of texts without a size of their own
    std::string elements{};
    std::string of_image{};  // attributes of the image, with a leading space

    // Path data of a polyline, without repeated points; "" for fewer than two points.
    static std::string polyline(const std::vector<PaperPoint>& points, bool closed = false);

    // `path`: SVG path data; `attributes`: more attributes of the element, with a leading space.
    void stroke(const std::string& path, Colour colour, double line_width,
                std::string_view attributes = "");
    void area(const std::string& path, Colour colour, double opacity = 1);
    // `anchor`: start, middle or end; `at` is on the baseline; `exponent` is set as a superscript.
    void text(PaperPoint at, std::string_view text, Colour colour, std::string_view anchor,
              std::string_view attributes = "", std::string_view exponent = "");
};

struct Illustration {
    std::string alone;    // a file with its own style sheet and background
    std::string inlined;  // for a page that styles .e-s0 ... .e-f9 and .e-paper
};

// The image with a title and a description (SVG title and desc, referenced by aria-labelledby),
// whose ids begin with `id`.
Illustration illustrate(const Svg& svg, const std::string& id, const std::string& title,
                        const std::string& description);

// A coordinate [px] with at most one decimal.
std::string px(double value);

}  // namespace elastocheck::reports
