#include <fmt/format.h>

#include <cmath>

#include "reports/render/render.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

std::string exact(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace

std::string csv(const compare::Table& table) {
    std::string lines;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        lines += fmt::format("{}{}", c > 0 ? "," : "",
                             for_csv(with_unit(table.columns[c].name, table.columns[c].unit)));
    lines += "\n";
    for (const auto& row : table.rows) {
        for (std::size_t c = 0; c < row.size(); ++c) {
            const auto* value = std::get_if<double>(&row[c]);
            lines += fmt::format(
                "{}{}", c > 0 ? "," : "",
                value != nullptr ? exact(*value) : for_csv(std::get<std::string>(row[c])));
        }
        lines += "\n";
    }
    return lines;
}

}  // namespace elastocheck::reports
