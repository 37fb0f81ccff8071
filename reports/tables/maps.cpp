#include "reports/tables/maps.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elastocheck::reports {
namespace {

std::string cell_of(double value) {
    return std::isfinite(value) ? fmt::format("{:.10g}", value) : std::string();
}

}  // namespace

std::string lookup_csv(const MapTable& table, const MapAxes& axes) {
    std::string text =
        fmt::format("{}: {}\n# over {}{}, in equilibrium; ground axes x forward, y left, z up\n",
                    lookup_head, axes.scene, axes.x, axes.y.empty() ? "" : " and " + axes.y);
    for (const auto& channel : table.channels)
        text +=
            fmt::format("# {} [{}]: {}\n", channel.name, symbol(channel.unit), channel.definition);
    if (!axes.y.empty()) text += axes.y + ",";
    text += axes.x;
    for (const auto& channel : table.channels)
        text += fmt::format(",{} [{}]", channel.name, symbol(channel.unit));
    text += "\n";
    for (std::size_t j = 0; j < table.y.size(); ++j)
        for (std::size_t i = 0; i < table.x.size(); ++i) {
            if (!axes.y.empty()) text += cell_of(table.y[j]) + ",";
            text += cell_of(table.x[i]);
            for (const double value : table.values[j][i]) text += "," + cell_of(value);
            text += "\n";
        }
    return text;
}

}  // namespace elastocheck::reports
