// Where the words of a drawing go, so that none lies on another.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

// On paper [px], y up.
struct Spot {
    double x = 0, y = 0;
};
struct Box {
    double left = 0, bottom = 0, right = 0, top = 0;
};
bool overlap(const Box& a, const Box& b);

// Room for a line of text, more rather than less: what its letters take in the widest of the usual fonts.
double text_width(std::string_view text, double size);

struct Label {
    Spot at;  // of what it names
    double width = 0, height = 0;
};

struct Paper {
    double width = 0, height = 0;
    std::vector<std::array<Spot, 2>> lines;  // which a label crosses only where there is nowhere else
    std::vector<Box> taken;                  // by other words and by symbols, where no label goes
};

// The box of each label, or nothing where there is no room for it near enough.
std::vector<std::optional<Box>> place_labels(const std::vector<Label>& labels, const Paper& paper);

}  // namespace elastocheck::reports
