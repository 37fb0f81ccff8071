#include "reports/page/sections/inputs/suspension.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/page/common.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

Suspension suspension_of(const SceneAnalyses& scene) {
    Suspension s{scene.drawing};
    const auto sweep = leading_sweep(scene);
    if (!sweep) return s;
    std::vector<double> order;
    for (const auto& station : scene.drawing.stations) {
        if (!station.end || !sweep->has(station.branch)) continue;
        const bool travel = station.unit == "mm" && sweep->lifts();
        Suspension::Moved moved{
            station, fmt::format("{}{} {}", travel ? "travel" : station.branch, travel ? " at" : "",
                                 quantity(station.a, station.unit))};
        // In ascending order of the parameter, over any number of branches.
        const auto before = std::ranges::upper_bound(order, station.a) - order.begin();
        order.insert(order.begin() + before, station.a);
        s.moved.insert(s.moved.begin() + before, std::move(moved));
    }
    return s;
}

Table points_table(const std::vector<Suspension::Point>& points) {
    using P = Suspension::Point;
    const auto along = [](std::size_t axis) { return [=](const P& p) { return p.at[axis]; }; };
    Table table = compare::table<P>({.detail = true},
                                    {{"point", Digits::words, &P::name},
                                     {"on", Digits::words, &P::body},
                                     {"x", Digits::four, along(0), "", "mm"},
                                     {"y", Digits::four, along(1), "", "mm"},
                                     {"z", Digits::four, along(2), "", "mm"}},
                                    points);
    return table;
}

const char* noun_of(const Suspension& suspension) {
    return suspension.wheels.empty() ? "mechanism" : "suspension";
}

bool is_right(const Suspension& suspension) {
    return !suspension.wheels.empty() &&
           std::ranges::all_of(suspension.wheels, [&](const auto& wheel) {
               return suspension.points[wheel.centre].at[1] < 0;
           });
}

}  // namespace elastocheck::reports
