#include "compare/design/maps.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace elastocheck::compare {
namespace {

using Eigen::Index;

struct Scale {
    double middle = 0, half = 1;
};
Scale scale_of(const std::vector<double>& x) {
    const double half = (x.back() - x.front()) / 2;
    return {(x.back() + x.front()) / 2, half > 0 ? half : 1};
}

// u^i v^j of one point, i-major.
Eigen::RowVectorXd powers(double u, double v, int p, int q) {
    Eigen::RowVectorXd row((p + 1) * (q + 1));
    Index k = 0;
    double of_u = 1;
    for (int i = 0; i <= p; ++i, of_u *= u) {
        double of_v = 1;
        for (int j = 0; j <= q; ++j, of_v *= v) row[k++] = of_u * of_v;
    }
    return row;
}

PolynomialMap fitted(const MapTable& table, std::size_t channel, int p, int q, std::size_t every) {
    const Scale x = scale_of(table.x), y = scale_of(table.y);
    PolynomialMap map{channel, p, q, {}, x.middle, x.half, y.middle, y.half, 0, false};
    const auto used_y = static_cast<Index>((table.y.size() + 1) / 2),
               used_x = static_cast<Index>((table.x.size() - 1) / every + 1);
    Eigen::MatrixXd A(used_y * used_x, (p + 1) * (q + 1));
    Eigen::VectorXd b(A.rows());
    Index row = 0;
    for (std::size_t j = 0; j < table.y.size(); j += 2)
        for (std::size_t i = 0; i < table.x.size(); i += every, ++row) {
            A.row(row) =
                powers((table.x[i] - x.middle) / x.half, (table.y[j] - y.middle) / y.half, p, q);
            b[row] = table.values[j][i][channel];
        }
    const Eigen::VectorXd c = A.colPivHouseholderQr().solve(b);
    map.c.assign(c.begin(), c.end());
    for (std::size_t j = 0; j < table.y.size(); ++j)
        for (std::size_t i = 0; i < table.x.size(); ++i)
            map.error = std::max(
                map.error, std::abs(map.at(table.x[i], table.y[j]) - table.values[j][i][channel]));
    return map;
}

}  // namespace

double PolynomialMap::at(double x, double y) const {
    return powers((x - x_0) / x_1, (y - y_0) / y_1, degree_x, degree_y)
        .dot(Eigen::Map<const Eigen::RowVectorXd>(c.data(), static_cast<Index>(c.size())));
}

std::vector<PolynomialMap> polynomial_maps(const MapTable& table, const Tolerance& tolerance,
                                           std::size_t every) {
    if (table.x.size() < 3 || table.x.size() % every != 1 || table.y.size() % 2 == 0)
        throw std::invalid_argument(
            "a polynomial needs three or more values of the parameter, and an odd number of values "
            "of each variable");
    std::vector<PolynomialMap> maps;
    for (std::size_t c = 0; c < table.channels.size(); ++c) {
        double low = INFINITY, high = -INFINITY;
        for (const auto& row : table.values)
            for (const auto& point : row) {
                if (!std::isfinite(point[c]))
                    throw std::invalid_argument(
                        fmt::format("{} has no value at some points", table.channels[c].name));
                low = std::min(low, point[c]), high = std::max(high, point[c]);
            }
        const double limit = limit_of(table.channels[c], high - low, tolerance);
        // of n fitted points at most a degree of n - 1; below that the others judge it
        const int most_x = std::min(most_map_degree, static_cast<int>(table.x.size() / every) - 1),
                  most_y = table.y.size() == 1
                               ? 0
                               : std::min(most_map_degree, static_cast<int>(table.y.size() / 2));
        std::optional<PolynomialMap> best;
        for (int degree = 0; degree <= std::max(most_x, most_y); ++degree) {
            PolynomialMap map =
                fitted(table, c, std::min(degree, most_x), std::min(degree, most_y), every);
            map.within = map.error <= limit;
            if (!best || map.error < best->error || map.within) best = std::move(map);
            if (best->within) break;
        }
        maps.push_back(std::move(*best));
    }
    return maps;
}

}  // namespace elastocheck::compare
