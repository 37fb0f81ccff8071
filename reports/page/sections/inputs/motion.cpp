#include "reports/page/sections/inputs/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compare/outputs/catalogue/catalogue.hpp"
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
    return sweep.kind == "moment" ? "moment [N·m]" : sweep.parameter;
}

// Values of that abscissa at the stations `a`: the travel of each wheel, else the parameter once.
json marks_of(const SceneAnalyses& scene, const Sweep& sweep, const std::vector<double>& a) {
    if (!sweep.lifts()) return json::array({a});
    json marks = json::array();
    const SweepCurve curve(scene, sweep);
    for (const auto& wheel : scene.model.wheels) {
        const auto travel = curve.channel(output_of(wheel, compare::figure::travel));
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

json branch_of(const SceneAnalyses& scene, const Sweep& sweep, const Drawing::Motion& motion) {
    json d = json::array(), e = json::array();
    for (std::size_t k = 0; k < motion.a.size(); ++k) {
        json moved = json::array(), spin = json::array();
        for (std::size_t i = 0; i < motion.points[k].size(); ++i)
            moved.push_back(hundredths(motion.points[k][i]) -
                            hundredths(scene.drawing.points[i / 3].at[i % 3]));
        for (const double x : motion.axes[k]) spin.push_back(std::round(1e4 * x) / 1e4);
        d.push_back(std::move(moved));
        e.push_back(std::move(spin));
    }
    const auto start = std::ranges::min_element(motion.a, {}, [](double v) { return std::abs(v); });
    return {{"name", as_words(motion.branch)},
            {"unit", motion.unit},
            {"a", motion.a},
            {"start", start - motion.a.begin()},
            {"d", std::move(d)},
            {"e", std::move(e)},
            {"x", abscissa_of_figures(sweep)},
            {"marks", marks_of(scene, sweep, motion.a)}};
}

}  // namespace

json motion_of(const SceneAnalyses& scene, const View& first) {
    const json drawing = drawing_json(scene.drawing);
    json points = json::array(), list = json::object(), branches = json::array();
    for (const auto& p : scene.drawing.points)
        for (const double x : p.at) points.push_back(hundredths(x));
    for (const char* part : {"points", "links", "faces", "symbols", "wheels"})
        list[part] = drawing[part];
    for (json& point : list["points"]) point.erase("design_mm");
    for (json& symbol : list["symbols"])
        for (const char* member : {"at_mm", "axis"}) symbol.erase(member);
    const auto leading = leading_sweep(scene);
    for (const bool of_leading : {true, false})
        for (const auto& branch : branches_of(scene)) {
            if ((leading && leading->has(branch.name())) != of_leading) continue;
            for (const auto& motion : scene.drawing.motion)
                if (motion.branch == branch.name() && motion.a.size() > 1)
                    branches.push_back(branch_of(scene, sweep_of(scene, branch), motion));
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
