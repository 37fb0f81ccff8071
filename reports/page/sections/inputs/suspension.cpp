#include "reports/page/sections/inputs/suspension.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/common.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

Position place_of(const JsonCursor& field) {
    const auto xyz = field.numbers();
    if (xyz.size() != 3) field.fail("expected three numbers");
    for (const double v : xyz)
        if (!std::isfinite(v)) field.fail("expected three finite numbers");
    return {xyz[0], xyz[1], xyz[2]};
}

std::vector<Position> places_of(const JsonCursor& list) {
    std::vector<Position> places;
    for (const auto& item : list.items()) places.push_back(place_of(item));
    return places;
}

std::size_t index_of(const JsonCursor& field, std::size_t count) {
    const int k = field.whole();
    if (k < 0 || static_cast<std::size_t>(k) >= count) field.fail("no such point");
    return static_cast<std::size_t>(k);
}

}  // namespace

std::optional<Suspension> suspension_of(const JsonCursor& scene) {
    const auto drawing = scene.find("drawing");
    if (!drawing) return std::nullopt;
    Suspension s;
    const auto places = places_of((*drawing)["design"]["points_mm"]);
    const auto named = (*drawing)["points"].items();
    const std::size_t count = named.size();
    if (places.size() != count)
        (*drawing)["design"]["points_mm"].fail("not as many points as in the drawing");
    for (std::size_t k = 0; k < count; ++k) {
        const auto hard = named[k].find("hardpoint");
        s.points.push_back(
            {named[k]["name"].text(), named[k]["body"].text(), !hard || hard->truth(), places[k]});
    }
    for (const auto& link : (*drawing)["links"].items()) {
        const auto ends = link["points"].items();
        if (ends.size() != 2) link["points"].fail("expected two points");
        s.links.push_back(
            {link["kind"].text(), index_of(ends[0], count), index_of(ends[1], count)});
    }
    if (const auto faces = drawing->find("faces"))
        for (const auto& face : faces->items()) {
            std::vector<std::size_t> corners;
            for (const auto& corner : face["points"].items())
                corners.push_back(index_of(corner, count));
            if (corners.size() < 3) face["points"].fail("expected three points or more");
            s.faces.push_back(corners);
        }
    if (const auto symbols = drawing->find("symbols"))
        for (const auto& symbol : symbols->items()) {
            const auto axis = symbol.find("axis");
            s.symbols.push_back({symbol["kind"].text(), place_of(symbol["at_mm"]),
                                 axis ? std::optional(place_of(*axis)) : std::nullopt});
        }
    if (const auto wheels = drawing->find("wheels"))
        for (const auto& wheel : wheels->items())
            s.wheels.push_back({index_of(wheel["centre"], count), index_of(wheel["patch"], count),
                                place_of(wheel["spin_axis"])});
    const auto sweep = leading_sweep(scene);
    if (!sweep) return s;
    std::vector<double> order;
    for (const auto& at : (*drawing)["positions"].items()) {
        const auto of = at.find("of");
        if (!of || at["where"].text() != "end" || !sweep->has(of->text())) continue;
        Suspension::Moved moved;
        moved.title = fmt::format("{} at {}", sweep->lifts() ? "travel" : of->text(),
                                  quantity(at["a"].number(), at["unit"].text()));
        if (at["unit"].text() != "mm" || !sweep->lifts())
            moved.title =
                fmt::format("{} {}", of->text(), quantity(at["a"].number(), at["unit"].text()));
        moved.points = places_of(at["points_mm"]);
        if (moved.points.size() != count)
            at["points_mm"].fail("not as many points as in the drawing");
        if (const auto wheels = at.find("wheels_mm"))
            for (const auto& wheel : wheels->items()) moved.wheels.push_back(places_of(wheel));
        // in ascending order of the parameter, over any number of branches
        const auto before = std::ranges::upper_bound(order, at["a"].number()) - order.begin();
        order.insert(order.begin() + before, at["a"].number());
        s.moved.insert(s.moved.begin() + before, std::move(moved));
    }
    return s;
}

const char* noun_of(const Suspension& suspension) {
    return suspension.wheels.empty() ? "mechanism" : "suspension";
}

}  // namespace elastocheck::reports
