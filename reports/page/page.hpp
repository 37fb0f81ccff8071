// Content of a report independent of HTML, Markdown and plots: sections with
// sentences, figures, tables.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/result/table.hpp"

namespace elastocheck::reports {

using compare::Digits;
using compare::Table;

// Position in the palette (svg.hpp): 0 is ink.
enum Colour { ink, vermilion, blue, green, purple, ochre, slate, pink, sky, faint };

struct Series {
    enum class Style {
        line,
        wide,
        dashed,
        thin,
        points,
        rings,
        line_points,
        bars,
        heavy,
        hair,
        face
    };
    std::string title{};  // empty: not in the legend
    Style style = Style::line;
    Colour colour = ink;
    int mark = 0;  // symbol index, for points
    // x, y; bars: x, y, x low, x high, y low, y high; face: corners of one area. An empty row
    // is a gap
    std::vector<std::vector<double>> rows{};
    double opacity = 0.18;  // of a face
    // entries of the figure's legend that show and hide it; unused without a legend of the figure
    std::vector<std::size_t> keys{};
};

struct Band {
    double low = 0, high = 0;  // of y
    std::string label;
    Colour colour = green;
};

// A word in a drawing, vertically centred.
struct Word {
    double x = 0, y = 0;
    std::string text{};
    Colour colour = ink;
};

// Visible part of the plane in a drawing without axes, from x, y on.
struct Sheet {
    double x = 0, y = 0;
    double scale = 1;           // [px] per unit
    int width = 0, height = 0;  // [px]
};

struct Figure {
    std::string id{};           // unique within its scene
    std::string title{};        // short, above the plot
    std::string description{};  // alternative text
    std::string x{}, y{};       // axes with units
    bool log_x = false, log_y = false;
    // NaN: from the data
    double y_low = std::numeric_limits<double>::quiet_NaN(),
           y_high = std::numeric_limits<double>::quiet_NaN();
    double height = 1;  // relative to the default height
    std::vector<Series> series{};
    std::vector<Series> legend{};  // instead of the titles of the series
    std::vector<Band> bands{};
    std::vector<std::pair<double, std::string>> y_ticks{};  // instead of numbers
    // a drawing without axes; the fields of axes are unused then
    std::optional<Sheet> sheet{};
    std::vector<Word> words{};
};

// Figures that belong together, with a caption and their numbers.
struct FigureGroup {
    std::string caption{};
    std::vector<Figure> figures{};
    Table table{};
};

enum class Mark { none, pass, fail, open };  // verdict mark of a section

enum class Part { first, behaviour, change, evidence };  // of the page

struct Section {
    std::string id;  // also the name of its text template
    std::string title;
    Part part = Part::first;
    Mark mark = Mark::none;
    nlohmann::ordered_json words = nlohmann::ordered_json::object();  // data of the template
    std::vector<FigureGroup> figures{};
    std::vector<Table> tables{};
    nlohmann::ordered_json
        motion{};  // of the first figure, turned by hand; null without (motion.hpp)
};

}  // namespace elastocheck::reports
