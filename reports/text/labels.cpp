#include "reports/text/labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace elastocheck::reports {
namespace {

// Lengths [px].
constexpr double gap = 2;                // between boxes
constexpr double crowd = 60;             // points within it compete for places
constexpr double without_leader = 15;    // a label farther from its point has a leader
constexpr double cost_of_crossing = 22;  // farther by up to this to cover no line

// Whether the segment a b intersects the box (Liang & Barsky 1984): the part of 0 ... 1 within each
// pair of sides in turn.
bool crosses(const PaperPoint& a, const PaperPoint& b, const Box& box) {
    if (std::max(a.x, b.x) < box.left || std::min(a.x, b.x) > box.right ||
        std::max(a.y, b.y) < box.bottom || std::min(a.y, b.y) > box.top)
        return false;  // the usual case
    double from = 0, to = 1;
    const auto clip = [&](double start, double step, double low, double high) {
        if (step == 0) return start >= low && start <= high;
        double enter = (low - start) / step, leave = (high - start) / step;
        if (enter > leave) std::swap(enter, leave);
        from = std::max(from, enter);
        to = std::min(to, leave);
        return from <= to;
    };
    return clip(a.x, b.x - a.x, box.left, box.right) && clip(a.y, b.y - a.y, box.bottom, box.top);
}

Box wider(const Box& box, double margin) {
    return {box.left - margin, box.bottom - margin, box.right + margin, box.top + margin};
}

}  // namespace

bool overlap(const Box& a, const Box& b) {
    return a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;
}

// Andrew's monotone chain (1979): sorted along x, the lower side and the upper one back.
std::vector<std::size_t> convex_hull(const std::vector<PaperPoint>& points) {
    std::vector<std::size_t> sorted(points.size()), hull;
    std::iota(sorted.begin(), sorted.end(), 0);
    std::ranges::sort(sorted, {}, [&](std::size_t k) {
        return std::pair{points[k].x, points[k].y};
    });
    const auto left_turn = [&](std::size_t i, std::size_t j, std::size_t k) {
        const PaperPoint &a = points[i], &b = points[j], &c = points[k];
        return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) > 0;
    };
    for (int side = 0; side < 2; ++side) {
        const std::size_t first = hull.size();
        for (const auto k : sorted) {
            while (hull.size() >= first + 2 && !left_turn(hull[hull.size() - 2], hull.back(), k))
                hull.pop_back();
            hull.push_back(k);
        }
        if (!hull.empty()) hull.pop_back();  // the other side starts with the same point
        std::ranges::reverse(sorted);
    }
    return hull;
}

double text_width(std::string_view text, double size) {
    double letters = 0;  // in em
    for (const char c : text) {
        // continuation byte of a character
        if ((static_cast<unsigned char>(c) & 0xC0) == 0x80) continue;
        letters += std::string_view("ijlI.,:;'|!()[] ").find(c) != std::string_view::npos ? 0.4
                   : std::string_view("mwMW%@").find(c) != std::string_view::npos         ? 1.0
                   : c >= 'A' && c <= 'Z'                                                 ? 0.72
                                                                                          : 0.63;
    }
    return letters * size;
}

std::vector<std::optional<Box>> place_labels(const std::vector<Label>& labels, const Paper& paper) {
    // Points in crowded places first. Each label goes to the free place of least cost, its
    // distance from the point and a penalty for each line that it covers, among 16 directions
    // at 9 distances.
    std::vector<std::size_t> order(labels.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    const auto neighbours = [&](std::size_t k) {
        return std::ranges::count_if(labels, [&](const Label& other) {
            return std::hypot(other.at.x - labels[k].at.x, other.at.y - labels[k].at.y) < crowd;
        });
    };
    std::ranges::stable_sort(order, std::ranges::greater{}, neighbours);

    std::vector<Box> taken = paper.taken;
    std::vector<std::array<PaperPoint, 2>> leaders;
    std::vector<std::optional<Box>> placed(labels.size());
    for (const auto k : order) {
        const Label& label = labels[k];
        double best_cost = std::numeric_limits<double>::infinity();
        std::optional<Box> best_box;
        std::array<PaperPoint, 2> best_leader{};
        for (const double reach : {9.0, 15.0, 24.0, 36.0, 52.0, 72.0, 95.0, 125.0, 160.0})
            for (int direction = 0; direction < 16; ++direction) {
                const double angle = 2 * std::numbers::pi * direction / 16;
                // The side or corner of the box that faces the point touches this circle.
                const double x = label.at.x + reach * std::cos(angle),
                             y = label.at.y + reach * std::sin(angle);
                const double across = 0.5 * (std::cos(angle) - 1), up = 0.5 * (std::sin(angle) - 1);
                const Box box{x + across * label.width, y + up * label.height,
                              x + (across + 1) * label.width, y + (up + 1) * label.height};
                if (box.left < 0 || box.bottom < 0 || box.right > paper.width ||
                    box.top > paper.height)
                    continue;
                const Box box_with_gap = wider(box, gap);
                if (std::ranges::any_of(
                        taken, [&](const Box& other) { return overlap(box_with_gap, other); }))
                    continue;
                const PaperPoint nearest{std::clamp(label.at.x, box.left, box.right),
                                         std::clamp(label.at.y, box.bottom, box.top)};
                // A leader crosses no words but those about its point; words cover no leader.
                if (reach > without_leader && std::ranges::any_of(taken, [&](const Box& other) {
                        return crosses(label.at, nearest, other) &&
                               !crosses(label.at, label.at, wider(other, gap));
                    }))
                    continue;
                if (std::ranges::any_of(
                        leaders, [&](const auto& l) { return crosses(l[0], l[1], box_with_gap); }))
                    continue;
                double cost = reach;
                for (const auto& line : paper.lines)
                    if (crosses(line[0], line[1], box_with_gap)) cost += cost_of_crossing;
                if (cost < best_cost) {
                    best_cost = cost;
                    best_box = box;
                    best_leader = {label.at, nearest};
                }
            }
        placed[k] = best_box;
        if (!best_box) continue;
        taken.push_back(*best_box);
        if (std::hypot(best_leader[1].x - best_leader[0].x, best_leader[1].y - best_leader[0].y) >
            without_leader)
            leaders.push_back(best_leader);
    }
    return placed;
}

}  // namespace elastocheck::reports
