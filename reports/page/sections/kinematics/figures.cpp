#include "reports/page/sections/kinematics/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using Rows = std::vector<std::vector<double>>;
using compare::Shown;

// Range of all curves of a figure, and the largest extent of one of them.
struct CurveRange {
    double low = INFINITY, high = -INFINITY, moved = 0;
};

// The curve of a wheel in one case; a gap where the quantity is undefined or passes through infinity.
Rows rows_of(const std::vector<double>& x, const std::vector<double>& values, Scale scale,
             const Quantity& quantity, CurveRange& extent) {
    Rows rows;
    double low = INFINITY, high = -INFINITY, farthest = 0;
    for (const double at : x) farthest = std::max(farthest, std::abs(at));
    const double middle = quantity.shown == Shown::off_centre ? 0.2 * farthest : -1;
    const compare::Entry* entry = compare::find_entry(quantity.name);
    const bool has_poles = entry != nullptr && entry->properties.swing_arm;
    for (const auto j : thinned(values.size(), 41)) {
        const double y = scale(values[j]);
        const bool shown = std::isfinite(y) && std::isfinite(x[j]) && std::abs(x[j]) > middle;
        const bool turned =
            shown && has_poles && !rows.empty() && !rows.back().empty() && rows.back()[1] * y < 0;
        if ((!shown || turned) && !rows.empty() && !rows.back().empty()) rows.emplace_back();
        if (!shown) continue;
        rows.push_back({at_rest(x[j]), at_rest(y)});
        low = std::min(low, y);
        high = std::max(high, y);
    }
    extent.low = std::min(extent.low, low);
    extent.high = std::max(extent.high, high);
    if (high > low) extent.moved = std::max(extent.moved, high - low);
    return rows;
}

// A bundle for each load case; of outputs of springs and dampers one for each element.
std::vector<Bundle> bundles_of(const SceneAnalyses& scene, const Family& family,
                               const Quantity& quantity, CurveRange& extent) {
    std::vector<Bundle> bundles;
    for (const Case& c : family.cases) {
        const std::string legend = c.legend() + direction_of(scene, family, c);
        for (const auto& of : outputs_of(scene, quantity.name)) {
            const std::string title = of.element.empty() ? legend : of.element;
            const auto values = c.curve.channel(of.channel),
                       x = abscissa_of(scene, family, c, of.wheel);
            if (values.empty() || values.size() != x.size()) continue;
            const Scale scale = scale_of(quantity, of.wheel.side, values, c.curve.start);
            auto bundle = std::ranges::find(bundles, title, &Bundle::title);
            if (bundle == bundles.end()) bundle = bundles.insert(bundle, Bundle{title});
            bundle->add(of.of_all ? "" : of.wheel.name,
                        rows_of(x, values, scale, quantity, extent));
            for (auto& series : given_of(scene, family, c, of, scale))
                bundle->others.push_back(std::move(series));
        }
    }
    return bundles;
}

}  // namespace

void add_figures(Section& section, const SceneAnalyses& scene, const Family& family) {
    if (family.cases.empty()) return;
    auto quantities = family.quantities;
    if (family.if_given)
        std::ranges::copy(compare::drawn_over(compare::Over::if_given),
                          std::back_inserter(quantities));
    for (const auto& quantity : quantities) {
        const bool if_given = &quantity - quantities.data() >= std::ssize(family.quantities);
        CurveRange extent;
        auto bundles = bundles_of(scene, family, quantity, extent);
        const bool given =
            std::ranges::any_of(bundles, [](const Bundle& b) { return !b.others.empty(); });
        const bool empty =
            std::ranges::all_of(bundles, [](const Bundle& b) { return b.lines.empty(); });
        // A quantity that does not move is left out, unless there are measured or candidate values.
        const double size = std::max(1e-3, std::max(std::abs(extent.low), extent.high));
        if (empty || (!given && (if_given || !(extent.moved > 1e-6 * size)))) continue;
        const std::string unit = outputs_of(scene, quantity.name).front().unit;
        const bool change =
            quantity.shown == Shown::change || quantity.shown == Shown::outward_change;
        std::vector<std::string> names;
        for (const auto& c : family.cases) names.push_back(c.sweep.name);
        Figure figure{
            .id = fmt::format("{}-{}", slug(quantity.name), family.id),
            .title = quantity.title,
            .description = fmt::format("{} over {} by the full solution, {}: from {} to {} {}.",
                                       quantity.title, family.x, enumerated(names),
                                       number(extent.low), number(extent.high), unit),
            .x = family.x,
            .y = fmt::format("{} [{}]", change ? "change" : label_of(quantity), unit)};
        if (family.cases.size() == 1) figure.x += direction_of(scene, family, family.cases[0]);
        section.figures.push_back(drawn(std::move(figure), std::move(bundles), scene.model.wheels,
                                        quantity.sign.empty() ? quantity.title : quantity.sign));
    }
}

}  // namespace elastocheck::reports
