#include "reports/page/plot.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "reports/files/files.hpp"
#include "reports/text/escape.hpp"
#include "reports/text/labels.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

// [px] of a figure. Three beside each other on A4 have letters of 6 pt; on a phone one fills the width.
constexpr int width = 340, height = 200;
constexpr double letter = 12.2, exponent = 0.8 * letter;
constexpr double line_pitch = 17, sample = 12;  // of the legend

// ---- Axes

struct Tick {
    double at;  // coordinate on the axis: the value, or its decimal logarithm
    std::string text, exponent;
};

struct Axis {
    bool logarithmic = false;
    double low = 0, high = 1;    // coordinates at the ends
    double start = 0, stop = 1;  // [px] of the ends
    std::vector<Tick> ticks{};

    // [px] of a value; NaN for a value without a place, such as 0 on a logarithmic axis.
    double operator()(double value) const {
        if (logarithmic) value = value > 0 ? std::log10(value) : NAN;
        return start + (value - low) / (high - low) * (stop - start);
    }
};

std::string signed_text(double value) {
    const std::string text = fmt::format("{:g}", value);
    return text.starts_with('-') ? "−" + text.substr(1) : text;
}

// The smallest of 1, 2, 5 times a power of ten that is at least `least`.
double round_step(double least) {
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= least * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

struct Range {
    double low = INFINITY, high = -INFINITY;
    void take(double value) {
        if (!std::isfinite(value)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

// The axis from `data` (coordinates) with round ticks, at most `max_intervals` intervals; automatic
// ends lie on ticks. NaN: automatic end.
Axis ticked(bool logarithmic, Range data, double low, double high, double max_intervals) {
    if (std::isfinite(low)) data.low = low;
    if (std::isfinite(high)) data.high = high;
    if (!(data.low <= data.high)) data = {0, 1};
    if (data.high - data.low <= 1e-9 * std::max(std::abs(data.low), std::abs(data.high))) {
        const double margin = data.low == 0 || logarithmic ? 1 : 0.1 * std::abs(data.low);
        data.low -= margin;
        data.high += margin;
    }
    double step = round_step((data.high - data.low) / max_intervals);
    if (logarithmic) step = std::max(1.0, std::ceil((data.high - data.low) / max_intervals));
    constexpr double slack = 1e-6;  // of a step
    Axis axis{.logarithmic = logarithmic};
    axis.low = std::isfinite(low) ? low : step * std::floor(data.low / step + slack);
    axis.high = std::isfinite(high) ? high : step * std::ceil(data.high / step - slack);
    for (double k = std::ceil(axis.low / step - slack); k <= axis.high / step + slack; ++k) {
        const double at = k * step + 0.0;  // no negative zero
        axis.ticks.push_back(logarithmic ? Tick{at, "10", signed_text(at)}
                                         : Tick{at, signed_text(at), ""});
    }
    return axis;
}

double widest(const Axis& axis) {
    double most = 0;
    for (const auto& tick : axis.ticks)
        most = std::max(most, text_width(tick.text, letter) + text_width(tick.exponent, exponent));
    return most;
}

Range coordinates(const Figure& figure, std::size_t column, bool logarithmic) {
    Range range;
    for (const auto& series : figure.series)
        for (const auto& row : series.rows)
            if (series.style == Series::Style::bars) {
                range.take(row[2 + 2 * column]);
                range.take(row[3 + 2 * column]);
            } else if (row.size() > column)
                range.take(logarithmic ? std::log10(row[column]) : row[column]);
    return range;
}

// The range of y without outliers that would flatten the curves, as beside a pole or a steep stop: of a
// curve whose range is several times that of its middle half of values, only the values near that half.
Range bulk_of(const Figure& figure, const Range& all) {
    constexpr double fence = 2, flat = 0.05;  // of the middle half; of the median
    Range bulk;
    for (const auto& series : figure.series) {
        std::vector<double> y;
        for (const auto& row : series.rows)
            if (row.size() == 2 && std::isfinite(row[1])) y.push_back(row[1]);
        if (y.empty()) continue;
        std::ranges::sort(y);
        const auto at = [&](double share) {
            return y[static_cast<std::size_t>(share * static_cast<double>(y.size() - 1))];
        };
        const double half = std::max(at(0.75) - at(0.25), flat * std::abs(at(0.5))),
                     low = std::max(y.front(), at(0.25) - fence * half),
                     high = std::min(y.back(), at(0.75) + fence * half);
        const bool cut = y.size() >= 9 && half > 1e-6 * (all.high - all.low) &&
                         y.back() - y.front() > 3 * (high - low);
        bulk.take(cut ? low : y.front());
        bulk.take(cut ? high : y.back());
    }
    return all.high - all.low > 3 * (bulk.high - bulk.low) ? bulk : all;
}

// ---- Series

double line_width(Series::Style style) {
    switch (style) {
        case Series::Style::wide: return 4;
        case Series::Style::heavy: return 3.2;
        case Series::Style::line: return 1.8;
        case Series::Style::dashed: return 1.6;
        case Series::Style::rings: return 1.5;
        case Series::Style::points:
        case Series::Style::line_points: return 1.4;
        case Series::Style::thin: return 1.2;
        case Series::Style::hair: return 0.9;
        case Series::Style::bars:
        case Series::Style::face: return 0;
    }
    return 0;
}

double marker_radius(Series::Style style) {  // [px]; 0: without markers
    return style == Series::Style::points        ? 3.1
           : style == Series::Style::line_points ? 2.9
           : style == Series::Style::rings       ? 5.4
                                                 : 0;
}

// Path data of a marker of this radius.
enum class Shape { circle, square, up, down, diamond };
std::string marker(Shape shape, PaperPoint p, double r) {
    switch (shape) {
        case Shape::circle:
            return fmt::format("M{0},{1}a{2},{2} 0 1 0 {3},0a{2},{2} 0 1 0 -{3},0", px(p.x - r),
                               px(p.y), px(r), px(2 * r));
        case Shape::square:
            return fmt::format("M{0},{1}h{2}v{2}h-{2}Z", px(p.x - r), px(p.y - r), px(2 * r));
        case Shape::up:
        case Shape::down: {
            const double up = shape == Shape::up ? 1 : -1;
            return Svg::polyline({{p.x, p.y - up * 1.3 * r},
                                  {p.x - 1.3 * r, p.y + up * 0.7 * r},
                                  {p.x + 1.3 * r, p.y + up * 0.7 * r}},
                                 true);
        }
        case Shape::diamond:
            return Svg::polyline({{p.x, p.y - 1.4 * r},
                                  {p.x + 1.4 * r, p.y},
                                  {p.x, p.y + 1.4 * r},
                                  {p.x - 1.4 * r, p.y}},
                                 true);
    }
    return {};
}

struct Marker {
    Shape shape;
    bool filled;
};
constexpr Marker markers[] = {{Shape::circle, true}, {Shape::square, true},  {Shape::up, true},
                              {Shape::down, true},   {Shape::diamond, true}, {Shape::circle, false},
                              {Shape::circle, true}, {Shape::square, false}, {Shape::circle, false},
                              {Shape::up, false}};

std::string rectangle(double left, double top, double right, double bottom) {
    return fmt::format("M{},{}H{}V{}H{}Z", px(left), px(top), px(right), px(bottom), px(left));
}

// Path data of the polyline where top <= y <= bottom.
std::string clipped(const std::vector<PaperPoint>& points, double top, double bottom) {
    std::string path;
    std::vector<PaperPoint> piece;
    const auto flush = [&] {
        path += Svg::polyline(piece);
        piece.clear();
    };
    for (std::size_t k = 1; k < points.size(); ++k) {
        const PaperPoint &a = points[k - 1], &b = points[k];
        double from = 0, to = 1;
        if (a.y != b.y) {
            const double enter = (top - a.y) / (b.y - a.y), leave = (bottom - a.y) / (b.y - a.y);
            from = std::max(from, std::min(enter, leave));
            to = std::min(to, std::max(enter, leave));
        } else if (a.y < top || a.y > bottom) {
            to = -1;
        }
        if (from > to || from > 0) flush();
        if (from > to) continue;
        const auto between = [&](double t) {
            return PaperPoint{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        };
        if (piece.empty()) piece.push_back(between(from));
        piece.push_back(between(to));
        if (to < 1) flush();
    }
    flush();
    return path;
}

// A series with `at` from data to pixels, clipped at `top` and `bottom` [px].
template <class At>
void draw_series(Svg& svg, const Series& series, At&& at, double top, double bottom) {
    using Style = Series::Style;
    constexpr double slack = 0.05;  // [px] of rounding
    const double radius = marker_radius(series.style);
    const Marker& mark = markers[static_cast<std::size_t>(series.mark) % std::size(markers)];
    std::string lines, marks;
    std::vector<PaperPoint> piece;
    const auto flush = [&] {
        lines += series.style == Style::face ? Svg::polyline(piece, true)
                                             : clipped(piece, top - slack, bottom + slack);
        piece.clear();
    };
    for (const auto& row : series.rows) {
        const std::optional<PaperPoint> p = row.size() < 2 ? std::nullopt : at(row[0], row[1]);
        if (!p) {
            flush();
        } else if (series.style == Style::bars) {
            const auto low = at(row[2], row[4]), high = at(row[3], row[5]);
            if (low && high)
                marks +=
                    rectangle(low->x, std::max(high->y, top), high->x, std::min(low->y, bottom));
        } else {
            piece.push_back(*p);
            if (radius > 0 && p->y >= top - slack && p->y <= bottom + slack)
                marks += marker(mark.shape, *p, radius);
        }
    }
    flush();
    if (series.style == Style::face)
        svg.area(lines, series.colour, series.opacity);
    else if (series.style != Style::points && series.style != Style::rings)
        svg.stroke(lines, series.colour, line_width(series.style),
                   series.style == Style::dashed ? " stroke-dasharray=\"6,4\"" : "");
    if (series.style == Style::bars || mark.filled)
        svg.area(marks, series.colour);
    else
        svg.stroke(marks, series.colour, line_width(series.style));
}

// ---- Legend

struct Entry {
    const Series* series = nullptr;  // or of a band
    const Band* band = nullptr;
    std::string_view text{};
    std::size_t key = 0;  // position in the legend of the figure, or of the series
    double x = 0;
    int line = 0;
};

// Legend entries on lines of this width.
std::vector<Entry> legend(const Figure& figure, double lines_width) {
    std::vector<Entry> entries;
    const auto& listed = figure.legend.empty() ? figure.series : figure.legend;
    for (std::size_t k = 0; k < listed.size(); ++k)
        if (!listed[k].title.empty())
            entries.push_back({.series = &listed[k], .text = listed[k].title, .key = k});
    for (const auto& band : figure.bands) entries.push_back({.band = &band, .text = band.label});
    double x = 0;
    int line = 0;
    for (auto& entry : entries) {
        const double need = sample + 4 + text_width(entry.text, letter);
        if (x > 0 && x + need > lines_width) {
            x = 0;
            ++line;
        }
        entry.x = x;
        entry.line = line;
        x += need + 6;
    }
    return entries;
}

void draw_entry(Svg& svg, const Entry& entry, PaperPoint at) {
    if (entry.band != nullptr) {
        svg.area(rectangle(at.x, at.y - 5, at.x + sample, at.y + 5), entry.band->colour, 0.25);
    } else if (entry.series->style == Series::Style::bars) {
        svg.area(rectangle(at.x, at.y - 4, at.x + sample, at.y + 4), entry.series->colour);
    } else {
        Series series = *entry.series;
        series.rows = {{0, 0}, {sample, 0}};
        const Series line = series;
        const auto place = [&](double x, double y) {
            return std::optional(PaperPoint{at.x + x, at.y + y});
        };
        if (marker_radius(series.style) > 0) {
            series.rows = {{sample / 2, 0}};
            if (series.style == Series::Style::line_points)
                svg.stroke(Svg::polyline({*place(0, 0), *place(sample, 0)}), series.colour,
                           line_width(series.style));
        }
        draw_series(svg, series, place, at.y - 10, at.y + 10);
    }
    svg.text({at.x + sample + 4, at.y + 3.9}, entry.text, ink, "start");
}

// ---- Figures

Svg draw_plot(const Figure& figure) {
    Svg svg{width, static_cast<int>(std::lround(height * figure.height))};
    svg.letter = letter;
    double right = width - 20;
    const double bottom = svg.height - (figure.log_x ? 47 : 43);
    const auto end = [&](double value) { return figure.log_y ? std::log10(value) : value; };
    const Range whole = coordinates(figure, 1, figure.log_y);
    const bool free = !figure.log_y && std::isnan(figure.y_low) && std::isnan(figure.y_high);
    const Range shown = free ? bulk_of(figure, whole) : whole;
    const auto vertical = [&](double top) {
        Axis axis = ticked(figure.log_y, shown, end(figure.y_low), end(figure.y_high),
                           (bottom - top) / (figure.log_y ? 22 : 15));
        if (!figure.y_ticks.empty()) axis.ticks.clear();
        for (const auto& [at, text] : figure.y_ticks) axis.ticks.push_back({at, text, ""});
        axis.start = bottom;
        axis.stop = top;
        return axis;
    };
    const auto left_of = [&](const Axis& axis) {
        return std::min(width / 2.0, (figure.y.empty() ? 6 : 20) + widest(axis) + 8);
    };
    double left = left_of(vertical(32));
    const auto entries = legend(figure, right - left);
    const int lines = entries.empty() ? 0 : entries.back().line + 1;
    const double top = 13 + line_pitch * lines;
    const Axis y = vertical(top);
    left = left_of(y);
    Axis x;
    for (double most = figure.log_x ? 7 : (right - left) / 34;; --most) {
        x = ticked(figure.log_x, coordinates(figure, 0, figure.log_x), NAN, NAN, most);
        right = width - std::max(20.0, widest(x) / 2 + 1);  // the last label stands below the end
        if (most < 3 || widest(x) + 4 < (right - left) / static_cast<double>(x.ticks.size() - 1))
            break;
    }
    x.start = left;
    x.stop = right;
    const auto on = [](const Axis& axis, double at) {
        return axis.start + (at - axis.low) / (axis.high - axis.low) * (axis.stop - axis.start);
    };

    for (const auto& band : figure.bands)
        svg.area(rectangle(left, std::clamp(y(band.high), top, bottom), right,
                           std::clamp(y(band.low), top, bottom)),
                 band.colour, 0.12);
    std::string grid;
    for (const auto& tick : y.ticks)
        grid += fmt::format("M{},{}H{}", px(left), px(on(y, tick.at)), px(right));
    for (const auto& tick : x.ticks)
        grid += fmt::format("M{},{}V{}", px(on(x, tick.at)), px(bottom), px(top));
    svg.stroke(grid, faint, 0.8);
    for (const auto& tick : y.ticks)
        svg.text({left - 7.7, on(y, tick.at) + 3.6}, tick.text, slate, "end", "", tick.exponent);
    for (const auto& tick : x.ticks)
        svg.text({on(x, tick.at), bottom + (figure.log_x ? 23 : 19)}, tick.text, slate, "middle",
                 "", tick.exponent);
    if (!figure.y.empty())
        svg.text(
            {0, 0}, figure.y, slate, "middle",
            fmt::format(" transform=\"translate(12,{}) rotate(270)\"", px((top + bottom) / 2)));
    svg.text({(left + right) / 2, svg.height - 7.0}, figure.x, slate, "middle");
    for (const auto& entry : entries) {
        if (entry.series != nullptr) svg.elements += fmt::format("<g data-e=\"{}\">", entry.key);
        draw_entry(svg, entry, {left + entry.x, 13.5 + line_pitch * entry.line});
        if (entry.series != nullptr) svg.elements += "</g>";
    }
    for (std::size_t k = 0; k < figure.series.size(); ++k) {
        const Series& series = figure.series[k];
        const auto keys = figure.legend.empty() ? std::vector{k} : series.keys;
        svg.elements += fmt::format("<g data-k=\"{}\">", fmt::join(keys, " "));
        draw_series(
            svg, series,
            [&](double a, double b) {
                const PaperPoint p{x(a), y(b)};
                return std::isfinite(p.x) && std::isfinite(p.y) ? std::optional(p) : std::nullopt;
            },
            top, bottom);
        svg.elements += "</g>";
    }
    if (shown.low != whole.low || shown.high != whole.high)
        svg.text(
            {left + 6, top + 12},
            fmt::format("axis cut: values from {} to {}", number(whole.low), number(whole.high)),
            slate, "start");
    // For the script of the page: pixels and coordinates of the ends of the axes, and their names.
    const auto add_axis = [&](char name, const Axis& axis, const std::string& words) {
        svg.of_image += fmt::format(" data-{0}=\"{1} {2} {3:.8g} {4:.8g} {5:d}\" data-{0}n=\"{6}\"",
                                    name, px(axis.start), px(axis.stop), axis.low, axis.high,
                                    axis.logarithmic, for_xml(words));
    };
    add_axis('x', x, figure.x);
    add_axis('y', y, figure.y);
    svg.stroke(fmt::format("M{},{}V{}H{}", px(left), px(top), px(bottom), px(right)), slate, 0.8);
    return svg;
}

Svg draw_sheet(const Figure& figure) {
    const Sheet& sheet = *figure.sheet;
    Svg svg{sheet.width, sheet.height};
    const auto at = [&](double x, double y) {
        const PaperPoint p{(x - sheet.x) * sheet.scale, sheet.height - (y - sheet.y) * sheet.scale};
        return std::isfinite(p.x) && std::isfinite(p.y) ? std::optional(p) : std::nullopt;
    };
    for (const auto& series : figure.series) draw_series(svg, series, at, 0, sheet.height);
    for (const auto& word : figure.words)
        if (const auto p = at(word.x, word.y))
            svg.text({p->x, p->y + 3.5}, word.text, word.colour, "start", " font-size=\"10\"");
    return svg;
}

// One block per series, separated by two blank lines; one blank line at a gap.
std::string figure_data(const Figure& figure) {
    const bool bars = !figure.series.empty() && figure.series.front().style == Series::Style::bars;
    std::string text = bars ? "series,x,y,x low,x high,y low,y high\n" : "series,x,y\n";
    for (std::size_t k = 0; k < figure.series.size(); ++k) {
        if (k > 0) text += "\n\n";
        const std::string name = for_csv(figure.series[k].title);
        bool broken = true;  // avoids a blank line at the start, and two in a row
        for (const auto& row : figure.series[k].rows) {
            if (row.empty() && broken) continue;
            broken = row.empty();
            if (!row.empty()) text += name;
            for (const double value : row) text += fmt::format(",{:.9g}", value);
            text += "\n";
        }
        while (text.ends_with("\n\n")) text.pop_back();
    }
    return text;
}

}  // namespace

Svg draw(const Figure& figure) { return figure.sheet ? draw_sheet(figure) : draw_plot(figure); }

std::vector<Illustration> draw(const std::vector<Plot>& plots, const fs::path& folder) {
    std::vector<Illustration> pictures;
    for (const auto& plot : plots) {
        pictures.push_back(illustrate(draw(*plot.figure), fmt::format("f{}", pictures.size() + 1),
                                      plot.figure->title, plot.figure->description));
        write_staged(folder / "figures" / (plot.name + ".svg"), pictures.back().alone);
        write_staged(folder / "figures" / (plot.name + ".csv"), figure_data(*plot.figure));
    }
    return pictures;
}

}  // namespace elastocheck::reports
