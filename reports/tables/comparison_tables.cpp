#include "reports/tables/comparison_tables.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elastocheck::reports {
namespace {

// Share of the channel's range; "-" for a constant channel.
std::string share(double value, double range) {
    if (!(range > 1e-9)) return "-";
    if (value < 1e-9) return "0";
    const double percent = 100 * value / range;
    if (percent < 0.001) return "<0.001 %";
    if (percent > 1000) return ">1000 %";
    return percent < 10 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

// A deviation with its sign; 0 below 1e-9 of a mm, deg, N or N·m, which is rounding.
std::string signed_value(double value) {
    return std::abs(value) < 1e-9 ? "0" : fmt::format("{:+.3g}", value);
}
std::string value_or_zero(double value) {
    return std::abs(value) < 1e-9 ? "0"
           : value < 10           ? fmt::format("{:.2g}", value)
                                  : fmt::format("{:.0f}", value);
}

}  // namespace

std::string deviation_cells(const compare::Deviation& d) {
    return fmt::format("{:>9}{:>9.4g}{:>9}{:>9}", signed_value(d.signed_max), d.at,
                       value_or_zero(d.rms), share(d.max, d.range));
}

}  // namespace elastocheck::reports
