#include "reports/tables/csv.hpp"

#include <fmt/format.h>

namespace elastocheck::reports {
namespace {

std::string quoted(std::string_view text) {
    if (text.find_first_of(",\"\n\r") == text.npos) return std::string(text);
    std::string doubled;
    for (const char c : text) {
        doubled.push_back(c);
        if (c == '"') doubled.push_back(c);
    }
    return fmt::format("\"{}\"", doubled);
}

}  // namespace

std::string curves_header(const std::vector<compare::Channel>& channels) {
    std::string line = "branch,leg,load factor,travel [mm]";
    for (const auto& channel : channels)
        line += fmt::format(",{}", quoted(fmt::format("{} [{}]", channel.name, symbol(channel.unit))));
    return line + "\n";
}

std::string curves_rows(const std::string& branch, const compare::LegRun& run) {
    std::string rows;
    for (std::size_t k = 0; k < run.curve.load.size(); ++k) {
        rows += fmt::format("{},{},{:.17g},", quoted(branch), name(run.leg), run.curve.load[k]);
        if (!run.curve.travel.empty()) rows += fmt::format("{:.17g}", run.curve.travel[k]);
        for (const double value : run.curve.values[k]) rows += fmt::format(",{:.17g}", value);
        rows += "\n";
    }
    return rows;
}

std::string curves_csv(const compare::Comparison& comparison) {
    std::string csv = curves_header(comparison.channels);
    for (const auto& branch : comparison.branches)
        for (const auto& run : branch.runs) csv += curves_rows(branch.branch, run);
    return csv;
}

}  // namespace elastocheck::reports
