#include "reports/text/symbols.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace elastocheck::reports {
namespace {

constexpr double pi = std::numbers::pi;

// Local frame of a line: its length, and points by coordinates along and across it.
struct LineFrame {
    PaperPoint from;
    double length, ux, uy;

    LineFrame(PaperPoint a, PaperPoint b)
        : from(a), length(std::hypot(b.x - a.x, b.y - a.y)), ux(1), uy(0) {
        if (length > 0) {
            ux = (b.x - a.x) / length;
            uy = (b.y - a.y) / length;
        }
    }
    PaperPoint at(double along, double across) const {
        return {from.x + along * ux - across * uy, from.y + along * uy + across * ux};
    }
};

}  // namespace

Stroke ring(PaperPoint centre, double radius) {
    Stroke stroke;
    constexpr int corners = 24;
    for (int k = 0; k <= corners; ++k) {
        const double angle = 2 * pi * k / corners;
        stroke.push_back(
            {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
    }
    return stroke;
}

Strokes coil(PaperPoint a, PaperPoint b) {
    const LineFrame line(a, b);
    constexpr double radius = 8;
    if (line.length < 3 * radius) return {ring({(a.x + b.x) / 2, (a.y + b.y) / 2}, radius)};
    const double lead = 0.1 * line.length, wound = line.length - 2 * lead;
    const int turns = std::clamp(static_cast<int>(wound / 9), 3, 8);
    Stroke stroke{a, line.at(lead, 0)};
    const int steps = 12 * turns;
    for (int k = 0; k <= steps; ++k) {
        const double angle = 2 * pi * turns * k / steps;
        stroke.push_back(
            line.at(lead + wound * k / steps + 2.2 * (1 - std::cos(angle)) * (k < steps ? 1 : 0),
                    radius * std::sin(angle)));
    }
    stroke.push_back(line.at(line.length - lead, 0));
    stroke.push_back(b);
    return {stroke};
}

Strokes damper(PaperPoint a, PaperPoint b) {
    const LineFrame line(a, b);
    constexpr double half = 4.5;
    if (line.length < 4 * half) return {ring({(a.x + b.x) / 2, (a.y + b.y) / 2}, half)};
    const double foot = 0.08 * line.length, mouth = 0.6 * line.length, piston = 0.45 * line.length;
    return {
        {a, line.at(foot, 0)},
        {line.at(mouth, half), line.at(foot, half), line.at(foot, -half), line.at(mouth, -half)},
        {line.at(piston, half - 1), line.at(piston, 1 - half)},
        {line.at(piston, 0), b}};
}

Strokes barrel(PaperPoint centre, PaperPoint along, double half_length) {
    constexpr double half = 4;
    const double projected = std::hypot(along.x, along.y);  // of a unit length
    if (projected * half_length < half) return {ring(centre, half + 1), ring(centre, 1)};
    const LineFrame line(centre, {centre.x + along.x, centre.y + along.y});
    const double l = projected * half_length;
    return {{line.at(-l, -half), line.at(l, -half), line.at(l, half), line.at(-l, half),
             line.at(-l, -half)},
            {line.at(-l - 4, 0), line.at(l + 4, 0)}};
}

Strokes cross(PaperPoint centre, double radius) {
    return {ring(centre, radius),
            {{centre.x - radius, centre.y}, {centre.x + radius, centre.y}},
            {{centre.x, centre.y - radius}, {centre.x, centre.y + radius}}};
}

Strokes diamond(PaperPoint centre, double r) {
    return {{{centre.x - r, centre.y},
             {centre.x, centre.y + r},
             {centre.x + r, centre.y},
             {centre.x, centre.y - r},
             {centre.x - r, centre.y}}};
}

Strokes square(PaperPoint centre, double h) {
    const double l = centre.x - h, r = centre.x + h, low = centre.y - h, high = centre.y + h;
    return {{{l, low}, {r, low}, {r, high}, {l, high}, {l, low}}};
}

Strokes hatching(PaperPoint centre) {
    constexpr double half = 8, below = 9;
    const double y = centre.y - below;
    Strokes strokes{{centre, {centre.x, y}}, {{centre.x - half, y}, {centre.x + half, y}}};
    for (double x = centre.x - half + 4; x <= centre.x + half; x += 4)
        strokes.push_back({{x, y}, {x - 4, y - 4}});
    return strokes;
}

Strokes arrow(PaperPoint from, PaperPoint to, bool both_ways) {
    const LineFrame line(from, to);
    const double l = line.length;
    Strokes strokes{{from, to}, {line.at(l - 6, 3), to, line.at(l - 6, -3)}};
    if (both_ways) strokes.push_back({line.at(6, 3), from, line.at(6, -3)});
    return strokes;
}

}  // namespace elastocheck::reports
