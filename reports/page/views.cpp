#include "reports/page/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reports/text/labels.hpp"
#include "reports/text/symbols.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {
namespace {

constexpr double letter = 10, line_height = 13;  // [px]
constexpr double margin = 46;                    // [px] about the suspension, for names
constexpr double strip = 17;                     // [px] a line of the legend

double dot(const Position& a, const Position& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Position cross(const Position& a, const Position& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Position along(const Position& p, double t, const Position& u) {
    return {p[0] + t * u[0], p[1] + t * u[1], p[2] + t * u[2]};
}
Position unit(const Position& v) {
    const double length = std::sqrt(dot(v, v));
    return length > 0 ? Position{v[0] / length, v[1] / length, v[2] / length} : v;
}

// Projection plane of a view: up is up; in the top view forward points down the page, as below a
// front view in a technical drawing.
struct Plane {
    Position right, up;

    explicit Plane(const Position& towards) {
        const bool above = std::abs(towards[0]) + std::abs(towards[1]) < 1e-9;
        right = above ? Position{0, 1, 0} : unit(cross({0, 0, 1}, towards));
        up = cross(unit(towards), right);
    }
    PaperPoint operator()(const Position& p) const { return {dot(right, p), dot(up, p)}; }
};

// Both edges of a tyre, from the wheel's centre to its patch; its width is unknown and drawn as 0.6
// of the radius.
std::vector<std::vector<Position>> tyre(const Suspension& s, const Suspension::Wheel& wheel) {
    const Position centre = s.points[wheel.centre].at, patch = s.points[wheel.patch].at,
                   e = unit(wheel.spin_axis);
    Position arm = along(patch, -1, centre);
    arm = along(arm, -dot(arm, e), e);
    const double radius = std::sqrt(dot(arm, arm));
    if (radius < 1) return {};
    const Position other = cross(e, arm);
    std::vector<std::vector<Position>> edges;
    for (const double side : {-0.3, 0.3}) {
        std::vector<Position> edge;
        constexpr int corners = 60;
        for (int k = 0; k <= corners; ++k) {
            const double angle = 2 * std::numbers::pi * k / corners;
            edge.push_back(along(along(along(centre, side * radius, e), std::cos(angle), arm),
                                 std::sin(angle), other));
        }
        edges.push_back(edge);
    }
    return edges;
}

// Closed outline of the convex hull of points on paper.
Stroke hull(const Stroke& points) {
    Stroke round;
    for (const auto k : convex_hull(points)) round.push_back(points[k]);
    if (!round.empty()) round.push_back(round.front());
    return round;
}

// Strokes on paper by style, in drawing order.
struct Canvas {
    Plane plane;
    double x = 0, y = 0;  // plane coordinates of the paper's corner [mm]
    double scale = 1;     // [px/mm]
    std::vector<Series> series{};
    std::vector<Word> words{};
    Paper paper{};

    PaperPoint on(const Position& p) const {
        const PaperPoint s = plane(p);
        return {(s.x - x) * scale, (s.y - y) * scale};
    }
    void stroke(const Stroke& stroke, Series::Style style, Colour colour, bool in_the_way = true) {
        if (stroke.size() < 2) return;
        if (series.empty() || series.back().style != style || series.back().colour != colour ||
            style == Series::Style::face)
            series.push_back({.style = style, .colour = colour});
        auto& rows = series.back().rows;
        if (!rows.empty()) rows.emplace_back();
        for (const auto& p : stroke) rows.push_back({x + p.x / scale, y + p.y / scale});
        if (in_the_way)
            for (std::size_t k = 1; k < stroke.size(); ++k)
                paper.lines.push_back({stroke[k - 1], stroke[k]});
    }
    void strokes(const Strokes& all, Series::Style style, Colour colour, bool in_the_way = true) {
        for (const auto& one : all) stroke(one, style, colour, in_the_way);
    }
    // Text from its left end, vertically centred.
    Box word(PaperPoint at, const std::string& text, Colour colour) {
        words.push_back({x + at.x / scale, y + at.y / scale, text, colour});
        const Box box{at.x, at.y - line_height / 2, at.x + text_width(text, letter),
                      at.y + line_height / 2};
        paper.taken.push_back(box);
        return box;
    }
};

constexpr Colour moved_colours[] = {sky, pink};

// ---- Signs of links and symbols. `along` is the direction of a symbol's axis
// on paper, foreshortened.

using Place = PaperPoint;
struct Sign {
    std::string_view kind, legend;  // no legend: none is needed
    Colour colour;
    Strokes (*link)(Place a, Place b);
    Strokes (*symbol)(Place at, Place along) = nullptr;
    Series::Style style = Series::Style::line;
    double raised = 0;  // [px] in the legend
};

Strokes straight(Place a, Place b) { return {{a, b}}; }
Strokes drive(Place at, Place u) {
    if (std::hypot(u.x, u.y) <= 0.15) return {};
    return arrow({at.x - 20 * u.x, at.y - 20 * u.y}, {at.x + 20 * u.x, at.y + 20 * u.y}, true);
}
Strokes ball(Place at, Place) { return {ring(at, 3.2), ring(at, 1.2)}; }
Strokes bushing(Place at, Place) { return {ring(at, 5.5), ring(at, 2)}; }
Strokes hinge(Place at, Place along) { return barrel(at, along, 8); }
Strokes sleeve(Place at, Place along) { return barrel(at, along, 13); }

// In the order of the legend.
constexpr Sign signs[]{
    {"spherical", "ball joint", ink, nullptr, ball},
    {"bushing", "bushing", green, nullptr, bushing},
    {"revolute", "revolute joint", blue, nullptr, hinge},
    {"sliding", "sliding joint", blue, nullptr, sleeve},
    {"universal", "universal joint", blue, nullptr, [](Place at, Place) { return cross(at, 5); }},
    {"fixed", "fixed joint", blue, nullptr, [](Place at, Place) { return square(at, 4); }},
    {"plane", "", blue, nullptr, [](Place at, Place) { return diamond(at, 5); }},
    {"spring", "spring", vermilion, coil},
    {"damper", "damper", ochre, damper},
    {"body", "", ink, straight, nullptr, Series::Style::heavy},
    {"rod", "", ink, straight, nullptr, Series::Style::heavy},
    {"beam", "elastic beam", purple, straight, nullptr, Series::Style::heavy},
    {"ground", "vehicle body", slate, nullptr, [](Place at, Place) { return hatching(at); },
     Series::Style::hair, 6},
    {"drive", "driven", purple, nullptr, drive},
};

bool is_shown(const Suspension& s, std::string_view kind) {
    return std::ranges::find(s.symbols, kind, &Suspension::Symbol::kind) != s.symbols.end() ||
           std::ranges::find(s.links, kind, &Suspension::Link::kind) != s.links.end() ||
           (kind == "ground" &&
            std::ranges::find(s.points, kind, &Suspension::Point::body) != s.points.end());
}

// Entries of the legend: the signs in use, then the other positions.
std::vector<Sign> entries(const Suspension& s) {
    std::vector<Sign> list;
    for (const Sign& sign : signs)
        if (!sign.legend.empty() && is_shown(s, sign.kind)) list.push_back(sign);
    for (std::size_t m = 0; m < s.moved.size(); ++m)
        list.push_back({"", s.moved[m].title, moved_colours[m % std::size(moved_colours)], straight,
                        nullptr, Series::Style::thin});
    return list;
}

void draw_symbol(Canvas& canvas, const Suspension::Symbol& symbol) {
    PaperPoint at = canvas.on(symbol.at);
    const Position axis = symbol.axis ? unit(*symbol.axis) : Position{0, 0, 1};
    const PaperPoint along{dot(canvas.plane.right, axis), dot(canvas.plane.up, axis)};
    canvas.paper.taken.push_back({at.x - 5, at.y - 5, at.x + 5, at.y + 5});
    if (symbol.kind == "drive") {  // beside the point, so that the arrow does not cover it
        const double off = (along.x < 0 ? -13 : 13) / std::hypot(along.x, along.y);
        at = {at.x - off * along.y, at.y + off * along.x};
    }
    for (const Sign& sign : signs)
        if (sign.kind == symbol.kind && sign.symbol != nullptr)
            canvas.strokes(sign.symbol(at, along), sign.style, sign.colour);
}

// ---- The legend, in lines from the lower edge up.

struct LegendPosition {
    double x;
    int line;
};
// Positions of the entries on lines of this width; the number of lines is the last entry's line
// plus one.
std::vector<LegendPosition> legend_positions(const std::vector<Sign>& list, double width) {
    std::vector<LegendPosition> result;
    double x = 6;
    int line = 0;
    for (const auto& entry : list) {
        const double need = 38 + text_width(entry.legend, letter) + 12;
        if (x > 6 && x + need > width) {
            x = 6;
            ++line;
        }
        result.push_back({x, line});
        x += need;
    }
    return result;
}

void draw_legend(Canvas& canvas, const std::vector<Sign>& list, double width) {
    const auto where = legend_positions(list, width);
    if (where.empty()) return;
    const int lines = where.back().line + 1;
    for (std::size_t k = 0; k < list.size(); ++k) {
        const PaperPoint at{where[k].x + 17, strip * (lines - where[k].line) - strip / 2};
        const Sign& sign = list[k];
        canvas.strokes(sign.link != nullptr ? sign.link({at.x - 12, at.y}, {at.x + 12, at.y})
                                            : sign.symbol({at.x, at.y + sign.raised}, {1, 0}),
                       sign.style, sign.colour, false);
        canvas.word({where[k].x + 38, at.y}, std::string(sign.legend), ink);
    }
    canvas.paper.taken.push_back({0, 0, width, strip * lines + 2});
}

// Vehicle axes and a scale bar, in the lower corners.
void draw_axes(Canvas& canvas, double bottom, double width) {
    using Style = Series::Style;
    constexpr double length = 24;
    const std::pair<const char*, Position> axes[] = {
        {"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}};
    double left = 0, low = 0;
    for (const auto& [name, axis] : axes) {
        left = std::min(left, length * dot(canvas.plane.right, axis));
        low = std::min(low, length * dot(canvas.plane.up, axis));
    }
    const PaperPoint origin{12 - left, bottom + 16 - low};
    for (const auto& [name, axis] : axes) {
        const PaperPoint u{dot(canvas.plane.right, axis), dot(canvas.plane.up, axis)};
        if (std::hypot(u.x, u.y) < 0.15) continue;
        canvas.strokes(arrow(origin, {origin.x + length * u.x, origin.y + length * u.y}),
                       Style::thin, slate);
        const double far = length + 7;
        canvas.word({origin.x + far * u.x - 3, origin.y + far * u.y}, name, slate);
    }
    // [mm]: 1, 2 or 5, at most a third of the width
    double bar = std::pow(10, std::floor(std::log10(0.3 * width / canvas.scale)));
    for (const double longer : {5.0, 2.0})
        if (longer * bar * canvas.scale <= 0.3 * width) {
            bar *= longer;
            break;
        }
    const double px = bar * canvas.scale, y = bottom + 10, end = width - 10;
    canvas.strokes({{{end - px, y}, {end, y}},
                    {{end - px, y - 3}, {end - px, y + 3}},
                    {{end, y - 3}, {end, y + 3}}},
                   Style::thin, slate);
    const std::string text = fmt::format("{:g} mm", bar);
    canvas.word({end - text_width(text, letter), y + 11}, text, slate);
}

void draw_suspension(Canvas& canvas, const Suspension& s) {
    using Style = Series::Style;
    for (const auto& wheel : s.wheels) {
        const auto edges = tyre(s, wheel);
        Stroke both;
        for (const auto& edge : edges)
            for (const auto& p : edge) both.push_back(canvas.on(p));
        if (both.empty()) continue;
        canvas.stroke(hull(both), Style::face, slate, false);
        for (const auto& edge : edges) {
            Stroke rim;
            for (const auto& p : edge) rim.push_back(canvas.on(p));
            canvas.stroke(rim, Style::hair, slate, false);
        }
        canvas.stroke(hull(both), Style::thin, slate);
    }
    for (std::size_t m = 0; m < s.moved.size(); ++m) {
        const Colour colour = moved_colours[m % std::size(moved_colours)];
        for (const auto& rim : s.moved[m].rims) {
            Stroke stroke;
            for (const auto& p : rim) stroke.push_back(canvas.on(p));
            canvas.stroke(stroke, Style::hair, colour, false);
        }
        for (const auto& link : s.links)
            if (link.kind != "spring" && link.kind != "stop" && link.kind != "damper")
                canvas.stroke(
                    {canvas.on(s.moved[m].points[link.i]), canvas.on(s.moved[m].points[link.j])},
                    Style::thin, colour);
    }
    Stroke standing;  // one hatching for coincident points
    for (const auto& p : s.points) {
        const PaperPoint at = canvas.on(p.at);
        if (p.body != "ground" || std::ranges::any_of(standing, [&](const PaperPoint& other) {
                return std::hypot(other.x - at.x, other.y - at.y) < 4;
            }))
            continue;
        standing.push_back(at);
        canvas.strokes(hatching(at), Style::hair, slate);
    }
    for (const auto& face : s.faces) {
        Stroke round;
        for (const auto k : face.points) round.push_back(canvas.on(s.points[k].at));
        round.push_back(round.front());
        canvas.stroke(round, Style::face, blue, false);
    }
    for (const Sign& sign : signs)
        for (const auto& link : s.links)
            if (link.kind == sign.kind && sign.link != nullptr)
                canvas.strokes(
                    sign.link(canvas.on(s.points[link.i].at), canvas.on(s.points[link.j].at)),
                    sign.style, sign.colour);
    for (const auto& symbol : s.symbols) draw_symbol(canvas, symbol);
    for (const auto& wheel : s.wheels)
        canvas.stroke(ring(canvas.on(s.points[wheel.patch].at), 2), Style::line, slate);
    for (const auto& one : s.arrows) {
        const PaperPoint from = canvas.on(one.at), to = canvas.on(one.to);
        if (std::hypot(to.x - from.x, to.y - from.y) >= 4)
            canvas.strokes(arrow(from, to), Style::line, purple);
    }
}

// Names of the arrows or, without any, of the hardpoints, one for a place shared by several bodies.
void draw_names(Canvas& canvas, const Suspension& s) {
    std::vector<std::string> names;
    std::vector<Label> labels;
    const auto add = [&](const std::string& name, const Position& at) {
        if (std::ranges::find(names, name) != names.end()) return;
        names.push_back(name);
        labels.push_back({canvas.on(at), text_width(as_words(name), letter), line_height});
    };
    for (const auto& one : s.arrows) add(one.name, one.to);
    if (s.arrows.empty())
        for (const auto& p : s.points)
            if (p.hardpoint) add(p.name, p.at);
    const auto placed = place_labels(labels, canvas.paper);
    for (std::size_t k = 0; k < labels.size(); ++k) {
        if (!placed[k]) continue;
        const Box& box = *placed[k];
        const PaperPoint near{std::clamp(labels[k].at.x, box.left, box.right),
                              std::clamp(labels[k].at.y, box.bottom, box.top)};
        if (std::hypot(near.x - labels[k].at.x, near.y - labels[k].at.y) > 15)
            canvas.stroke({labels[k].at, near}, Series::Style::hair, slate, false);
        canvas.words.push_back({canvas.x + box.left / canvas.scale,
                                canvas.y + (box.bottom + box.top) / 2 / canvas.scale,
                                as_words(names[k]), ink});
    }
}

struct Extent {
    double left = INFINITY, right = -INFINITY, bottom = INFINITY, top = -INFINITY;
    void take(PaperPoint p) {
        left = std::min(left, p.x);
        right = std::max(right, p.x);
        bottom = std::min(bottom, p.y);
        top = std::max(top, p.y);
    }
    double width() const { return std::max(right - left, 1.0); }
    double height() const { return std::max(top - bottom, 1.0); }
};

Extent extent(const Suspension& s, const Plane& plane) {
    Extent extent;
    for (const auto& p : s.points) extent.take(plane(p.at));
    for (const auto& wheel : s.wheels)
        for (const auto& edge : tyre(s, wheel))
            for (const auto& p : edge) extent.take(plane(p));
    for (const auto& moved : s.moved) {
        for (const auto& p : moved.points) extent.take(plane(p));
        for (const auto& rim : moved.rims)
            for (const auto& p : rim) extent.take(plane(p));
    }
    return extent;
}

}  // namespace

View axonometric_view(bool right) {
    constexpr double turn = 38 * std::numbers::pi / 180, height = 24 * std::numbers::pi / 180;
    return {"view-axonometric",
            "The suspension",
            "from the front, above and the middle of the vehicle",
            {std::cos(height) * std::cos(turn),
             (right ? 1 : -1) * std::cos(height) * std::sin(turn), std::sin(height)}};
}

Frame large_frame(const Suspension& s) {
    return s.wheels.size() > 1 ? Frame{620, 470, true} : Frame{480, 400, true};
}
Frame small_frame(const Suspension& s) { return {s.wheels.size() > 1 ? 480 : 330, 0, false}; }

std::vector<Figure> draw_views(const Suspension& s, const std::vector<View>& views,
                               const Frame& frame) {
    const auto list = frame.legend ? entries(s) : std::vector<Sign>{};
    const auto where = legend_positions(list, frame.width);
    const double legend = where.empty() ? 0 : strip * (where.back().line + 1);
    double scale = INFINITY;
    for (const auto& view : views) {
        const Extent e = extent(s, Plane(view.towards_viewer));
        scale = std::min(scale, (frame.width - 2 * margin) / e.width());
        if (frame.height > 0)
            scale = std::min(scale, (frame.height - legend - 2 * margin) / e.height());
    }
    std::vector<Figure> figures;
    for (const auto& view : views) {
        const Plane plane(view.towards_viewer);
        const Extent e = extent(s, plane);
        const double height =
            frame.height > 0 ? frame.height
                             : std::max(std::ceil(e.height() * scale + 2 * margin + legend), 170.0);
        const double x = (e.left + e.right) / 2 - frame.width / scale / 2,
                     y = (e.bottom + e.top) / 2 - (height + legend) / scale / 2;
        Canvas canvas{plane, x, y, scale};
        canvas.paper.width = frame.width;
        canvas.paper.height = height;
        draw_suspension(canvas, s);
        draw_legend(canvas, list, frame.width);
        draw_axes(canvas, legend, frame.width);
        draw_names(canvas, s);
        Figure figure{.id = view.id, .title = view.title};
        figure.sheet = Sheet{x, y, scale, frame.width, static_cast<int>(height)};
        figure.series = std::move(canvas.series);
        figure.words = std::move(canvas.words);
        figures.push_back(std::move(figure));
    }
    return figures;
}

}  // namespace elastocheck::reports
