#include "reports/tables/csv.hpp"

#include <fmt/format.h>

#include "reports/document/document.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
std::string curves_header(const std::vector<compare::Channel>& channels) {
    std::string line = "branch,leg,parameter,unit";
    for (const auto& channel : channels)
        line += fmt::format(",{}", for_csv(fmt::format("{} [{}]", channel.name, symbol(channel.unit))));
    return line + "\n";
}

std::string curves_rows(const std::string& branch, const compare::LegRun& run) {
    std::string rows;
    for (std::size_t k = 0; k < run.curve.a.size(); ++k) {
        rows += fmt::format("{},{},{:.17g},{}", for_csv(branch), name(run.leg), run.curve.a[k],
                            symbol(run.curve.unit));
        for (const double value : run.curve.values[k]) rows += fmt::format(",{:.17g}", value);
        rows += "\n";
    }
    return rows;
}

}  // namespace elastocheck::reports
