#include "reports/page/sections/kinematics/cases.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "reports/given/wheels.hpp"
#include "reports/page/sections/inputs/candidate.hpp"
#include "reports/page/sections/inputs/measured.hpp"

namespace elastocheck::reports {

std::vector<Case> cases_of(const SceneAnalyses& scene,
                           const std::function<bool(const Sweep&)>& includes) {
    std::vector<Case> cases;
    for (const auto& sweep : sweeps_of(scene))
        if (includes(sweep)) {
            cases.push_back({sweep, SweepCurve(scene, sweep)});
            if (cases.back().curve.a.size() < 2) cases.pop_back();
        }
    return cases;
}

bool is_force_test(const Sweep& sweep) {
    return sweep.kind == "lateral force" || sweep.kind == "longitudinal force" ||
           sweep.kind == "moment";
}

std::string Family::abscissa(const Wheel& wheel) const {
    return by == By::travel ? output_of(wheel, compare::figure::travel)
           : by == By::roll ? std::string(compare::figure::roll_angle)
                            : "";
}

Scale scale_of(const Quantity& quantity, int side, const std::vector<double>& values,
               std::size_t start) {
    const double first = start < values.size() ? values[start] : 0;
    switch (quantity.presentation) {
        case compare::Presentation::as_is:
        case compare::Presentation::off_centre: return {};
        case compare::Presentation::change: return {1, first};
        case compare::Presentation::outward_change: return {1.0 * side, first};
        case compare::Presentation::to_the_left: return {-1.0 * side, 0};
    }
    return {};
}

std::string label_of(const Quantity& quantity) {
    if (quantity.presentation != compare::Presentation::to_the_left) return as_words(quantity.name);
    std::string title = quantity.title;
    title[0] = static_cast<char>(std::tolower(title[0]));
    return title;
}

double without_rounding(double value) {
    constexpr double rest = 1e-9;  // mm, deg, N: less is rounding
    return std::abs(value) < rest ? 0 : value;
}

Push push_of(const SceneAnalyses& scene, const Case& c, const Wheel& wheel) {
    const auto pushes = pushes_of(scene.model, *c.sweep.branches.front().requested);
    if (!pushes) return {};
    Push push{0, pushes->positive};
    for (std::size_t w = 0; w < pushes->per_unit.size(); ++w)
        if (const double factor = pushes->per_unit[w];
            factor != 0 && (push.factor == 0 || scene.model.wheels[w].name == wheel.name))
            push.factor = factor;
    return push;
}

std::vector<double> abscissa_of(const SceneAnalyses& scene, const Family& family, const Case& c,
                                const Wheel& wheel) {
    const std::string by = family.abscissa(wheel);
    auto x = by.empty() ? c.curve.a : c.curve.channel(by);
    if (family.by == By::push)
        for (double& value : x) value *= push_of(scene, c, wheel).factor;
    return x;
}

std::vector<DrawnCurve> given_of(const SceneAnalyses& scene, const Family& family, const Case& c,
                                 const FoundOutput& output, Scale scale) {
    const std::string by = family.abscissa(output.wheel);
    auto given = measured_curves(scene, c.sweep, by, output.channel);
    std::ranges::move(candidate_curves(scene, c.sweep, by, output.channel),
                      std::back_inserter(given));
    const double push = family.by == By::push ? push_of(scene, c, output.wheel).factor : 1;
    for (auto& points : given) {
        points.wheel = output.of_all ? "" : output.wheel.name;
        for (auto& row : points.rows) row = {push * row[0], scale(row[1])};
    }
    return given;
}

std::string direction_of(const SceneAnalyses& scene, const Family& family, const Case& c) {
    if (family.by != By::push) return "";
    const Push push = push_of(scene, c, scene.model.wheels[0]);
    return push.positive.empty() ? "" : ", " + push.positive;
}

}  // namespace elastocheck::reports
