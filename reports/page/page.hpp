// What a report is made of, before it is HTML, Markdown or a plot: sections with sentences, figures, tables.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace elastocheck::reports {

struct Column {
    std::string name;    // with its unit
    bool words = false;  // text, set flush left
};

struct Table {
    std::string caption{};
    std::vector<Column> columns{};
    std::vector<std::vector<std::string>> rows{};
    bool folded = false;  // shown on demand
};

// Position in the palette (svg.hpp): 0 is ink.
enum Colour { ink, vermilion, blue, green, purple, ochre, slate, pink, sky, faint };

struct Series {
    enum class Style { line, wide, dashed, thin, points, rings, line_points, bars, heavy, hair, face };
    std::string title{};  // empty: not in the key
    Style style = Style::line;
    Colour colour = ink;
    int mark = 0;                             // which symbol, for points
    std::vector<std::vector<double>> rows{};  // x, y; bars: x, y, x low, x high, y low, y high. Empty: a gap
                                              // face: the corners of one area
};

struct Band {
    double low = 0, high = 0;  // of y
    std::string label;
    Colour colour = green;
};

// A word in a drawing, centred in height.
struct Word {
    double x = 0, y = 0;
    std::string text{};
    Colour colour = ink;
};

// What a drawing without axes shows of the plane: from x, y on, to scale.
struct Sheet {
    double x = 0, y = 0;
    double scale = 1;           // [px] per unit
    int width = 0, height = 0;  // [px]
};

struct Figure {
    std::string id{};           // within its scene
    std::string title{};        // short, above the plot
    std::string description{};  // what is seen, for those who do not see it
    std::string x{}, y{};       // axes with units
    bool log_x = false, log_y = false, equal_axes = false, reversed_x = false, reversed_y = false;
    bool key = true;
    double y_low = std::numeric_limits<double>::quiet_NaN(), y_high = y_low;  // NaN: as the data ask
    double x_tick = 0, y_tick = 0;  // distance of ticks; 0: as the data ask
    double width = 1, height = 1;   // shares of the usual ones
    std::vector<Series> series{};
    std::vector<Band> bands{};
    std::vector<std::pair<double, std::string>> y_ticks{};  // instead of numbers
    std::optional<Sheet> sheet{};  // a drawing; `width` and the like say nothing then
    std::vector<Word> words{};
};

// Figures that are read together, with what they say and their numbers.
struct FigureGroup {
    std::string caption{};
    std::vector<Figure> figures{};
    Table table{};
};

enum class Mark { none, pass, fail, open };  // what a sentence of judgement says

struct Section {
    std::string id;  // also the name of its text template
    std::string title;
    std::string part{};  // of the page, a heading above the first section of each
    Mark mark = Mark::none;
    nlohmann::ordered_json words = nlohmann::ordered_json::object();  // what the template says it with
    std::vector<FigureGroup> figures{};
    std::vector<Table> tables{};
};

}  // namespace elastocheck::reports
