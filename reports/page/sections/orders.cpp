// The branch as a power series: how its order, what it is told, its reach and its error go together.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "reports/page/numbers.hpp"
#include "reports/page/sections/common.hpp"
#include "reports/page/sections/sections.hpp"

namespace elastocheck::reports {
namespace {

constexpr Colour colours[] = {vermilion, blue, green, purple};

FigureGroup group(const Field& branch) {
    const std::string name = branch["branch"].text();
    FigureGroup group;
    group.caption = fmt::format("Expansions that branch {} takes over their order.", name);
    group.table = {.caption = fmt::format("Series over branch {}; error to the equilibrium leg", name),
                   .columns = {{"told [m]"},
                               {"order"},
                               {"outcome", true},
                               {"expansions"},
                               {"factorisations"},
                               {"solves"},
                               {"error [mm]"},
                               {"error [deg]"},
                               {"residual [N]"}},
                   .folded = true};
    Figure figure{.id = fmt::format("orders-{}", slug(name)),
                  .title = name,
                  .description = {},
                  .x = "order",
                  .y = "expansions",
                  .log_y = true};
    std::map<double, std::vector<std::vector<double>>, std::greater<>> by_tolerance;
    for (const auto& level : branch["levels"].items()) {
        const double told = level["told_m"].number(), order = level["order"].number(),
                     expansions = level["expansions"].number();
        const bool converged = level["outcome"].text() == "converged";
        if (converged) by_tolerance[told].push_back({order, expansions});
        group.table.rows.push_back(
            {number(told, 1), whole_number(level["order"].whole()), level["outcome"].text(),
             whole_number(level["expansions"].whole()), whole_number(level["factorisations"].whole()),
             whole_number(level["solves"].whole()), number(level["error_mm"].number(), 2),
             number(level["error_deg"].number(), 2), number(level["residual_N"].number(), 2)});
    }
    std::vector<std::string> told;
    for (const auto& [tolerance, rows] : by_tolerance) {
        const std::size_t k = figure.series.size();
        figure.series.push_back({fmt::format("told {} m", number(tolerance, 1)), Series::Style::line_points,
                                 colours[k % std::size(colours)], static_cast<int>(4 + k), rows});
        told.push_back(fmt::format("told {} m, {} expansions at order {} and {} at order {}",
                                   number(tolerance, 1), number(rows.front()[1], 3),
                                   number(rows.front()[0], 2), number(rows.back()[1], 3),
                                   number(rows.back()[0], 2)));
    }
    if (figure.series.empty()) return group;
    figure.description =
        "Logarithmic plot of the expansions a branch takes over their order: " + enumerated(told) + ".";
    group.figures.push_back(std::move(figure));
    return group;
}

}  // namespace

std::optional<Section> orders_section(const Field& scene) {
    const auto orders = scene.find("orders");
    if (!orders) return std::nullopt;
    Section section{.id = "orders", .title = "The branch as a power series"};
    auto& nearest = section.words["nearest"] = nlohmann::ordered_json::array();
    for (const auto& branch : orders->items()) {
        section.figures.push_back(group(branch));
        const auto levels = branch["levels"].items();
        if (levels.empty()) continue;
        const Field singularity = levels.back()["singularity"];
        const double radius = singularity["radius"].number();
        if (std::isfinite(radius))
            nearest.push_back(
                {{"branch", branch["branch"].text()},
                 {"radius", number(radius, 3)},
                 {"degrees", number(singularity["angle_rad"].number() * 180 / std::numbers::pi, 2)}});
    }
    return section;
}

}  // namespace elastocheck::reports
