#include "reports/tables/maps.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elastocheck::reports {
namespace {

std::string headed(const char* head, const compare::MapTable& table, const MapAxes& axes,
                   const std::string& how) {
    std::string text =
        fmt::format("{}: {}\n# over {}{}, in equilibrium; ground axes x forward, y left, z up\n{}",
                    head, axes.scene, axes.x, axes.y.empty() ? "" : " and " + axes.y, how);
    for (const auto& channel : table.channels)
        text +=
            fmt::format("# {} [{}]: {}\n", channel.name, symbol(channel.unit), channel.definition);
    return text;
}

std::string cell_of(double value) {
    return std::isfinite(value) ? fmt::format("{:.10g}", value) : std::string();
}

}  // namespace

std::string lookup_csv(const compare::MapTable& table, const MapAxes& axes) {
    std::string text = headed(lookup_head, table, axes, "");
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

std::string polynomial_csv(const compare::MapTable& table,
                           const std::vector<compare::PolynomialMap>& maps, const MapAxes& axes,
                           int every) {
    const std::string formula =
        axes.y.empty()
            ? fmt::format("sum of c_i0 u^i, u = (x - x_0) / x_1 of x = {}", axes.x)
            : fmt::format(
                  "sum of c_ij u^i v^j, u = (x - x_0) / x_1 of x = {}, v = (y - y_0) / y_1 "
                  "of y = {}",
                  axes.x, axes.y);
    std::string text = headed(
        polynomial_head, table, axes,
        fmt::format("# output = {}\n# error: largest difference found at {} points, of which every "
                    "{}th over x and every second one over y was fitted; no proved bound\n",
                    formula, table.x.size() * table.y.size(), every));
    text += "output,unit,i,j,c_ij,x_0,x_1,y_0,y_1,error\n";
    for (const auto& map : maps) {
        const auto& channel = table.channels[map.channel];
        std::size_t k = 0;
        for (int i = 0; i <= map.degree_x; ++i)
            for (int j = 0; j <= map.degree_y; ++j)
                text += fmt::format("{},{},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.3g}\n",
                                    channel.name, symbol(channel.unit), i, j, map.c[k++], map.x_0,
                                    map.x_1, map.y_0, map.y_1, map.error);
    }
    return text;
}

}  // namespace elastocheck::reports
