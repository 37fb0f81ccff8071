#include "reports/command/options/recursion_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "compare/studies/work_precision.hpp"

namespace elastocheck::reports {

recursive::Options recursion(const RecursionRequest& request) {
    recursive::Options options;
    options.method = recursive::find_method(request.method).value();
    options.steps = request.steps;
    auto* adaptive = std::get_if<recursive::Adaptive>(&options.method.kind);
    auto* series = std::get_if<recursive::Series>(&options.method.kind);
    const auto belongs = [&](bool given, bool has, std::string_view option, std::string_view to) {
        if (given && !has)
            throw std::invalid_argument(fmt::format("{}: only with --method {}", option, to));
    };
    belongs(!request.tolerance.empty(), adaptive || series, "--tolerance", "adaptive or series");
    belongs(request.order > 0, series, "--order", "series");
    belongs(request.expansions > 0, series, "--expansions", "series");
    belongs(request.arc_length, series, "--arc-length", "series");
    if (series) {
        if (request.order > 0) series->order = series->last_order = request.order;
        if (request.expansions > 0) series->expansions = request.expansions;
        series->arc_length = request.arc_length;
    }
    if (request.tolerance.empty()) return options;
    const compare::Tolerance tolerance = compare::parse_tolerance(request.tolerance);
    if (series && std::isfinite(tolerance.deg))
        throw std::invalid_argument(
            "--tolerance: the series takes one length, such as 1e-9mm, which bounds positions and, "
            "divided by the model's size, angles");
    if (series) series->tolerance = 1e-3 * tolerance.mm;
    if (adaptive && std::isfinite(tolerance.mm)) adaptive->length_tolerance = 1e-3 * tolerance.mm;
    if (adaptive)
        adaptive->angle_tolerance = std::isfinite(tolerance.deg)
                                        ? tolerance.deg * std::numbers::pi / 180
                                        : adaptive->length_tolerance;
    return options;
}

}  // namespace elastocheck::reports
