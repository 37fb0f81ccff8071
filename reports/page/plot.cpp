#include "reports/page/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/files/files.hpp"
#include "reports/files/templates.hpp"
#include "reports/page/gnuplot.hpp"
#include "reports/text/escape.hpp"
#include "reports/text/labels.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

// [px] of a figure, such that text stays readable on a phone
constexpr int width = 440, height = 290;

const char* style_of(Series::Style style) {
    switch (style) {
        case Series::Style::line: return "lines linewidth 1.8";
        case Series::Style::wide: return "lines linewidth 4";
        case Series::Style::dashed: return "lines linewidth 1.6 dashtype (6,4)";
        case Series::Style::thin: return "lines linewidth 1.2";
        case Series::Style::points: return "points linewidth 1.4 pointsize 0.75";
        case Series::Style::line_points: return "linespoints linewidth 1.4 pointsize 0.7";
        case Series::Style::rings: return "points linewidth 1.5 pointsize 1.3";
        case Series::Style::bars: return "boxxyerror fillstyle solid 1 noborder";
        case Series::Style::heavy: return "lines linewidth 3.2";
        case Series::Style::hair: return "lines linewidth 0.9";
        case Series::Style::face:
            return "filledcurves closed fillstyle transparent solid 0.18 noborder";
    }
    return "lines";
}

json range_of(double low, double high) {
    const auto end = [](double value) {
        return std::isfinite(value) ? fmt::format("{:.9g}", value) : "*";
    };
    return fmt::format("{}:{}", end(low), end(high));
}

// Tick distance of a logarithmic axis in decades, for at most about seven ticks without overlap.
std::string decades(const Figure& figure, std::size_t axis, double low, double high) {
    double least = std::isfinite(low) ? low : INFINITY, most = std::isfinite(high) ? high : 0;
    for (const auto& series : figure.series)
        for (const auto& row : series.rows)
            if (row.size() > axis && row[axis] > 0 && std::isfinite(row[axis]))
                least = std::min(least, row[axis]), most = std::max(most, row[axis]);
    const double span =
        most > least ? std::ceil(std::log10(most)) - std::floor(std::log10(least)) : 1;
    return fmt::format("{:g}", std::pow(10, std::clamp(std::ceil(span / 7), 1.0, 6.0)));
}

json script_data(const Figure& figure, const std::string& name) {
    json series = json::array(), bands = json::array(), ticks = json::array();
    const bool labelled = !figure.bands.empty();
    for (std::size_t k = 0; k < figure.series.size(); ++k) {
        const Series& s = figure.series[k];
        const bool points = s.style == Series::Style::points || s.style == Series::Style::rings ||
                            s.style == Series::Style::line_points;
        constexpr int symbols[] = {7, 5, 9, 11, 13, 6, 7, 4, 6, 8};
        series.push_back({{"index", k},
                          {"title", s.title},
                          {"style", style_of(s.style)},
                          {"symbol", points ? json(symbols[s.mark % 10]) : json(nullptr)},
                          {"colour", palette[s.colour].light},
                          {"bars", s.style == Series::Style::bars},
                          {"last", k + 1 == figure.series.size() && !labelled}});
    }
    // The legend under an equal-axes plot has one line per entry.
    const auto entries =
        std::ranges::count_if(figure.series, [](const Series& s) { return !s.title.empty(); });
    for (const auto& band : figure.bands)
        bands.push_back({{"low", fmt::format("{:.9g}", band.low)},
                         {"high", fmt::format("{:.9g}", band.high)},
                         {"label", band.label},
                         {"last", &band == &figure.bands.back()},
                         {"colour", palette[band.colour].light}});
    json words = json::array(), sheet = nullptr;
    for (const auto& word : figure.words)
        words.push_back({{"x", fmt::format("{:.9g}", word.x)},
                         {"y", fmt::format("{:.9g}", word.y)},
                         {"text", word.text},
                         {"colour", palette[word.colour].light}});
    if (const auto& s = figure.sheet)
        sheet = {{"x", range_of(s->x, s->x + s->width / s->scale)},
                 {"y", range_of(s->y, s->y + s->height / s->scale)}};
    const double wide = figure.sheet ? figure.sheet->width : width * figure.width,
                 high = figure.sheet ? figure.sheet->height : height * figure.height;
    double widest = 0;  // width of the words beside the axis [px], which gnuplot underestimates
    for (const auto& [at, text] : figure.y_ticks) {
        std::string plain;  // gnuplot interprets a tick label as a format
        for (const char c : text) plain += c == '%' ? "%%" : std::string(1, c);
        ticks.push_back({{"at", fmt::format("{:g}", at)}, {"text", plain}});
        widest = std::max(widest, text_width(text, 11));
    }
    return {
        {"name", name},
        {"title", figure.title},
        {"width", std::lround(wide)},
        {"height", std::lround(high)},
        {"width_in", fmt::format("{:.2f}", wide / 96)},
        {"height_in", fmt::format("{:.2f}", high / 96)},
        {"sheet", sheet},
        {"words", words},
        {"x", figure.x},
        {"y", figure.y},
        {"log_x", figure.log_x},
        {"log_y", figure.log_y},
        {"x_decades", decades(figure, 0, NAN, NAN)},
        {"y_decades", decades(figure, 1, figure.y_low, figure.y_high)},
        {"equal_axes", figure.equal_axes},
        {"key_lines", std::max(6L, static_cast<long>(entries) + 1)},
        {"reversed_x", figure.reversed_x},
        {"reversed_y", figure.reversed_y},
        {"y_range", range_of(figure.y_low, figure.y_high)},
        {"x_tick", figure.x_tick > 0 ? json(fmt::format("{:g}", figure.x_tick)) : json(nullptr)},
        {"y_tick", figure.y_tick > 0 ? json(fmt::format("{:g}", figure.y_tick)) : json(nullptr)},
        {"ticks", ticks},
        {"left", ticks.empty() ? json(nullptr)
                               : json(fmt::format("{:.4f}", std::min(0.5, (widest + 16) / wide)))},
        {"series", series},
        {"bands", bands},
        {"ink", palette[ink].light},
        {"slate", palette[slate].light},
        {"faint", palette[faint].light}};
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

std::vector<NamedContent> sources(const Plot& plot) {
    return {{plot.name + ".csv", figure_data(*plot.figure)},
            {plot.name + ".gp",
             render("figure.gp", script_data(*plot.figure, plot.name), Escape::gnuplot)}};
}

std::vector<Illustration> draw(const std::vector<Plot>& plots, const fs::path& folder,
                               const PlotOptions& options) {
    const fs::path figures = folder / "figures";
    std::vector<std::string> scripts;
    for (const auto& plot : plots) {
        for (const auto& [file, content] : sources(plot)) fill(figures / file, content);
        scripts.push_back("figures/" + plot.name + ".gp");
    }
    if (scripts.empty()) return {};
    run_gnuplot(folder, scripts);  // one process: each script resets all settings first
    if (options.pdf) {
        scripts.insert(scripts.begin(), {"-e", "pdf=1"});
        run_gnuplot(folder, scripts);
    }
    std::vector<Illustration> pictures;
    for (const auto& [figure, name] : plots) {
        const fs::path svg = figures / (name + ".svg");
        pictures.push_back(illustrate(read_whole(svg), fmt::format("f{}", pictures.size() + 1),
                                      figure->title, figure->description));
        fill(svg, pictures.back().alone);
        if (!options.keep_source)
            for (const char* other : {".csv", ".gp"}) fs::remove(figures / (name + other));
    }
    return pictures;
}

}  // namespace elastocheck::reports
