// Placement of labels in a drawing without overlap.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

// On paper [px], y up.
struct PaperPoint {
    double x = 0, y = 0;
};
struct Box {
    double left = 0, bottom = 0, right = 0, top = 0;
};
bool overlap(const Box& a, const Box& b);

// Convex hull: indices of its corners, counter-clockwise, without points on its edges.
std::vector<std::size_t> convex_hull(const std::vector<PaperPoint>& points);

// Upper estimate of the width [px] of a line of text in usual fonts of this size [px].
double text_width(std::string_view text, double size);

struct Label {
    PaperPoint at;  // of the labelled point
    double width = 0, height = 0;
};

struct Paper {
    double width = 0, height = 0;
    std::vector<std::array<PaperPoint, 2>> lines;  // crossed by a label only as a last resort
    std::vector<Box> taken;  // boxes of other words and symbols, which labels avoid
};

// Box of each label; empty where there is no free place near the point.
std::vector<std::optional<Box>> place_labels(const std::vector<Label>& labels, const Paper& paper);

}  // namespace elastocheck::reports
