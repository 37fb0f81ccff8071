#include "reports/tables/csv.hpp"

#include <fmt/format.h>

#include <cmath>

#include "compare/outputs/curve.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

std::string numbers(const std::vector<double>& values) {
    std::string cells;
    for (const double value : values)  // an undefined value is an empty cell
        cells += std::isfinite(value) ? fmt::format(",{:.17g}", value) : ",";
    return cells;
}

}  // namespace

std::string curves_header(const std::vector<compare::Channel>& channels) {
    std::string line = "branch,leg,parameter,unit";
    for (const auto& channel : channels)
        line +=
            fmt::format(",{}", for_csv(fmt::format("{} [{}]", channel.name, symbol(channel.unit))));
    return line + "\n";
}

std::string curves_row(const std::string& branch, compare::Leg leg, compare::Unit unit,
                       const compare::Row& row) {
    return fmt::format("{},{},{},{}{}\n", for_csv(branch), name(leg), parameter_in(unit, row.load),
                       symbol(unit), numbers(row.values));
}

std::string rates_header(const std::vector<compare::Channel>& channels) {
    std::string line = "branch,parameter,parameter unit";
    for (const auto& channel : channels)
        line += fmt::format(",{}", for_csv(fmt::format("{} [{} per parameter unit]", channel.name,
                                                       symbol(channel.unit))));
    return line + "\n";
}

std::string rates_row(const std::string& side, compare::Unit unit, double a,
                      const std::vector<double>& slopes) {
    return fmt::format("{},{},{}{}\n", for_csv(side), parameter_in(unit, a), symbol(unit),
                       numbers(slopes));
}

}  // namespace elastocheck::reports
