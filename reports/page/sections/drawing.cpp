// The suspension in three views, drawn from its hardpoints, with the positions it takes over them.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "reports/page/numbers.hpp"
#include "reports/page/sections/common.hpp"
#include "reports/page/sections/sections.hpp"

namespace elastocheck::reports {
namespace {

using Points = std::vector<std::array<double, 3>>;

Points points_of(const Field& list) {
    Points points;
    for (const auto& item : list.items()) {
        const auto xyz = item.numbers();
        if (xyz.size() != 3) item.fail("expected three numbers");
        points.push_back({xyz[0], xyz[1], xyz[2]});
    }
    return points;
}

struct View {
    const char *id, *title, *x, *y;
    int horizontal, vertical;
    bool reversed_x, reversed_y;
};
// As on a drawing board: seen from the front, from the left, and from above with forward down the page.
constexpr View views[] = {
    {"front", "Front view", "y, left [mm]", "z, up [mm]", 1, 2, false, false},
    {"side", "Side view, from the left", "x, forward [mm]", "z, up [mm]", 0, 2, true, false},
    {"top", "Top view", "y, left [mm]", "x, forward [mm]", 1, 0, false, true}};

struct Line {
    std::string kind;
    std::size_t i, j;
};

void add(Series& series, const Points& points, const Line& line, const View& view) {
    for (const auto k : {line.i, line.j})
        series.rows.push_back({points[k][static_cast<std::size_t>(view.horizontal)],
                               points[k][static_cast<std::size_t>(view.vertical)]});
    series.rows.emplace_back();
}

void add_circle(Series& series, const Points& points, const View& view) {
    for (const auto& p : points)
        series.rows.push_back(
            {p[static_cast<std::size_t>(view.horizontal)], p[static_cast<std::size_t>(view.vertical)]});
    if (!points.empty()) series.rows.emplace_back();
}

// The same on both axes, so that squares look square: 1,
// 2 or 5 times a power of ten, four or so on the longer.
double tick(const Figure& figure) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (const auto& series : figure.series)
        for (const auto& row : series.rows)
            for (std::size_t axis = 0; axis < row.size(); ++axis) {
                low[axis] = std::min(low[axis], row[axis]);
                high[axis] = std::max(high[axis], row[axis]);
            }
    const double span = std::max(high[0] - low[0], high[1] - low[1]);
    if (!(span > 0) || !std::isfinite(span)) return 0;
    const double power = std::pow(10, std::floor(std::log10(span / 4)));
    for (const double step : {1.0, 2.0, 5.0})
        if (step * power >= span / 5) return step * power;
    return 10 * power;
}

}  // namespace

std::optional<Section> drawing_section(const Field& scene) {
    const auto drawing = scene.find("drawing");
    if (!drawing) return std::nullopt;
    Section section{.id = "drawing", .title = "The mechanism"};
    for (const auto& channel : main_channels_of(scene))
        if (channel.angle()) section.title = "The suspension";
    const Field named = (*drawing)["points"];
    const std::size_t count = named.items().size();
    std::vector<Line> lines;
    for (const auto& link : (*drawing)["links"].items()) {
        const auto ends = link["points"].items();
        if (ends.size() != 2) link["points"].fail("expected two points");
        const int i = ends[0].whole(), j = ends[1].whole();
        for (const auto& [end, at] : {std::pair{i, ends[0]}, std::pair{j, ends[1]}})
            if (end < 0 || static_cast<std::size_t>(end) >= count) at.fail("no such point");
        lines.push_back({link["kind"].text(), static_cast<std::size_t>(i), static_cast<std::size_t>(j)});
    }
    struct Snapshot {
        std::string branch;
        Points points;
        std::vector<Points> wheels;
    };
    const auto circles_of = [](const Field& at) {
        std::vector<Points> circles;
        if (const auto wheels = at.find("wheels_mm"))
            for (const auto& wheel : wheels->items()) circles.push_back(points_of(wheel));
        return circles;
    };
    const auto checked = [&](const Field& at) {
        Points points = points_of(at["points_mm"]);
        if (points.size() != count) at["points_mm"].fail("not as many points as in the drawing");
        return points;
    };
    const Points design = checked((*drawing)["design"]);
    const auto design_wheels = circles_of((*drawing)["design"]);
    std::vector<Snapshot> ends;
    for (const auto& at : (*drawing)["positions"].items())
        if (at["where"].text() == "end") ends.push_back({at["branch"].text(), checked(at), circles_of(at)});

    FigureGroup group;
    constexpr Colour moved[] = {vermilion, blue, purple, ochre};
    for (const auto& view : views) {
        Figure figure{.id = fmt::format("view-{}", view.id),
                      .title = view.title,
                      .description = {},
                      .x = view.x,
                      .y = view.y,
                      .equal_axes = true,
                      .reversed_x = view.reversed_x,
                      .reversed_y = view.reversed_y,
                      .width = 0.75,
                      .height = 1.3};
        for (std::size_t e = 0; e < ends.size() && e < std::size(moved); ++e) {
            Series series{fmt::format("end of {}", ends[e].branch), Series::Style::thin, moved[e]};
            for (const auto& line : lines) add(series, ends[e].points, line, view);
            for (const auto& wheel : ends[e].wheels) add_circle(series, wheel, view);
            figure.series.push_back(std::move(series));
        }
        Series bodies{"design position", Series::Style::line, ink};
        Series rods{"rods and springs", Series::Style::dashed, slate}, wheel{"", Series::Style::thin, slate};
        for (const auto& line : lines) add(line.kind == "body" ? bodies : rods, design, line, view);
        for (const auto& circle : design_wheels) add_circle(wheel, circle, view);
        Series joints{"", Series::Style::points, ink, 6};
        for (const auto& p : design)
            joints.rows.push_back(
                {p[static_cast<std::size_t>(view.horizontal)], p[static_cast<std::size_t>(view.vertical)]});
        for (auto* series : {&wheel, &rods, &bodies, &joints})
            if (!series->rows.empty()) figure.series.push_back(std::move(*series));
        figure.x_tick = figure.y_tick = tick(figure);
        std::vector<std::string> names;
        names.reserve(ends.size());
        for (const auto& end : ends) names.push_back(end.branch);
        figure.description = fmt::format(
            "{} at the design position, with the positions at the end of {} drawn over "
            "it. "
            "The coordinates are in the table.",
            view.title, enumerated(names));
        group.figures.push_back(std::move(figure));
    }
    group.caption = "Design position in full lines, positions at the ends of the branches over it, to scale.";
    Table& table = group.table;
    table.caption =
        "Points at the design position, and how far the equilibrium leg moves them to the end of the branch";
    table.columns = {{"point", true}, {"on", true}, {"x [mm]"}, {"y [mm]"}, {"z [mm]"}};
    for (const auto& end : ends)
        for (const char* axis : {"Δx", "Δy", "Δz"})
            table.columns.push_back({fmt::format("{} {} [mm]", end.branch, axis)});
    table.folded = true;
    const auto points = named.items();
    for (std::size_t k = 0; k < count; ++k) {
        const std::string body = points[k]["body"].text();
        std::vector<std::string> row{points[k]["name"].text(), body};
        for (const double v : design[k]) row.push_back(number(v, 4));
        for (const auto& end : ends)
            for (std::size_t axis = 0; axis < 3; ++axis)
                row.push_back(body == "ground" ? "–"
                                               : deviation_number(end.points[k][axis] - design[k][axis]));
        table.rows.push_back(row);
    }
    section.figures.push_back(std::move(group));
    return section;
}

}  // namespace elastocheck::reports
