#include "reports/page/report/picture.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "reports/page/plot.hpp"
#include "reports/page/sections/inputs/suspension.hpp"
#include "reports/page/views.hpp"

namespace elastocheck::reports {

std::string picture(const Drawing& drawing, const std::string& view) {
    if (drawing.points.empty()) throw std::invalid_argument("the scene has no point to draw");
    const Suspension suspension{drawing};
    const bool right = is_right(suspension);
    const View chosen = [&] {
        if (view == "axonometric") return axonometric_view(right);
        for (const View& fixed : {front_view, side_view, top_view})
            if (fixed.id == "view-" + view) return fixed;
        throw std::invalid_argument(
            fmt::format("view '{}'; allowed: axonometric, front, side, top", view));
    }();
    const std::string noun = noun_of(suspension);
    const auto figures = draw_views(suspension, {chosen}, large_frame(suspension));
    return illustrate(draw(figures.front()), "drawing", fmt::format("The {}", noun),
                      fmt::format("The {} seen {}, to scale.", noun, chosen.from))
        .alone;
}

}  // namespace elastocheck::reports
