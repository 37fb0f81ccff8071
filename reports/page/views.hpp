// Views of a suspension: front, side, top and axonometric.
#pragma once

#include <string>
#include <vector>

#include "reports/document/drawing.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// A drawing with what its views show besides.
struct Suspension : Drawing {
    struct Moved : Placed {  // another position of the suspension
        std::string title{};
    };
    struct Arrow {  // at a point, with a name at its end
        Position at{}, to{};
        std::string name{};
    };
    std::vector<Moved> moved{};
    std::vector<Arrow> arrows{};  // where there are any, the points have no names
};

struct View {
    const char *id, *title, *from;  // "from the front"
    Position towards_viewer;
};
inline constexpr View front_view{"view-front", "Front view", "from the front", {1, 0, 0}};
inline constexpr View side_view{"view-side", "Side view", "from the left", {0, 1, 0}};
inline constexpr View top_view{"view-top", "Top view", "from above", {0, 0, 1}};
// View from the front, above, and the vehicle centre, so that the wheel does not hide its
// suspension; `right` for a suspension of the right side only.
View axonometric_view(bool right);

// Without a size, the height follows from the views at one width and one scale. Words without a
// free place are omitted.
struct Frame {
    int width = 0, height = 0;  // [px]
    bool legend = false;
};
Frame large_frame(const Suspension& suspension);  // one view; an axle is wider
Frame small_frame(const Suspension& suspension);  // for three views side by side
std::vector<Figure> draw_views(const Suspension& suspension, const std::vector<View>& views,
                               const Frame& frame);

}  // namespace elastocheck::reports
