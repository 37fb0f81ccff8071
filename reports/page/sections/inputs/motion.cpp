#include "reports/page/sections/inputs/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reports/page/common.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

constexpr double per_mm = 100;

long hundredths(double mm) { return std::lround(per_mm * mm); }

// Abscissa of the figures in Part 1 over which the branch is drawn.
std::string abscissa_of_figures(const Sweep& sweep) {
    if (sweep.lifts()) return "wheel travel [mm]";
    if (sweep.kind.ends_with("force")) return "force [N]";
    return sweep.kind == "moment" ? "moment [N·m]" : sweep.parameter();
}

// By wheel, or once: the values of this abscissa at the stations.
json marks_of(const JsonCursor& scene, const JsonCursor& branch, const Sweep& sweep,
              const std::vector<double>& a) {
    if (!sweep.lifts()) return json::array({a});
    json marks = json::array();
    const LegCurve curve = curve_of(branch, "equilibrium");
    for (const auto& wheel : wheels_of(scene)) {
        const auto travel = curve.channel(wheel.channel("travel"));
        json mark = json::array();
        for (const double at : a) {
            const auto k =
                static_cast<std::size_t>(std::ranges::find(curve.a, at) - curve.a.begin());
            mark.push_back(k < travel.size() ? json(std::round(1e3 * travel[k]) / 1e3)
                                             : json(nullptr));
        }
        marks.push_back(std::move(mark));
    }
    return marks;
}

std::vector<double> numbers_of(const JsonCursor& field, std::size_t count) {
    auto list = field.numbers();
    if (list.size() != count) field.fail("not as many numbers as the drawing has");
    for (const double v : list)
        if (!std::isfinite(v)) field.fail("expected finite numbers");
    return list;
}

json branch_of(const JsonCursor& scene, const JsonCursor& branch, const JsonCursor& motion,
               const Suspension& s) {
    const auto a = motion["a"].numbers();
    const auto stations = motion["points_mm"].items(), axes = motion["spin_axes"].items();
    if (stations.size() != a.size() || axes.size() != a.size())
        motion["points_mm"].fail("not as many stations as parameters");
    json d = json::array(), e = json::array();
    for (std::size_t k = 0; k < a.size(); ++k) {
        const auto at = numbers_of(stations[k], 3 * s.points.size());
        json moved = json::array();
        for (std::size_t i = 0; i < at.size(); ++i)
            moved.push_back(hundredths(at[i]) - hundredths(s.points[i / 3].at[i % 3]));
        d.push_back(std::move(moved));
        json spin = json::array();
        for (const double x : numbers_of(axes[k], 3 * s.wheels.size()))
            spin.push_back(std::round(1e4 * x) / 1e4);
        e.push_back(std::move(spin));
    }
    const Sweep sweep = sweep_of(scene, branch);
    const auto start = std::ranges::min_element(a, {}, [](double v) { return std::abs(v); });
    return {{"name", as_words(branch["name"].text())},
            {"unit", motion["unit"].text()},
            {"a", a},
            {"start", start - a.begin()},
            {"d", std::move(d)},
            {"e", std::move(e)},
            {"x", abscissa_of_figures(sweep)},
            {"marks", marks_of(scene, branch, sweep, a)}};
}

}  // namespace

json motion_of(const JsonCursor& scene, const Suspension& s, const View& first) {
    const auto motions = scene["drawing"].find("motion");
    if (!motions) return nullptr;
    json points = json::array(), list = json::object();
    for (const auto& p : s.points)
        for (const double x : p.at) points.push_back(hundredths(x));
    for (const char* part : {"points", "links", "faces", "symbols", "wheels"})
        list[part] = scene["drawing"].value->value(part, json::array());
    for (json& point : list["points"]) point.erase("design_mm");
    for (json& symbol : list["symbols"]) symbol.erase("at_mm"), symbol.erase("axis");
    const auto leading = leading_sweep(scene);
    json branches = json::array();
    for (const bool of_leading : {true, false})
        for (const auto& branch : scene["branches"].items()) {
            const std::string name = branch["name"].text();
            if ((leading && leading->has(name)) != of_leading) continue;
            for (const auto& motion : motions->items())
                if (motion["branch"].text() == name && motion["a"].items().size() > 1)
                    branches.push_back(branch_of(scene, branch, motion, s));
        }
    constexpr double degree = std::numbers::pi / 180;
    const Position& to = first.towards_viewer;
    return {{"points", points},
            {"list", list},
            {"view",
             {std::round(std::atan2(to[1], to[0]) / degree),
              std::round(std::atan2(to[2], std::hypot(to[0], to[1])) / degree)}},
            {"branches", branches}};
}

}  // namespace elastocheck::reports
