#include "models/import/curves.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "models/reader/tables/interpolant.hpp"

namespace elastocheck::importer {
namespace {

constexpr int samples = 16;  // per piece

// The interpolant of the other program on the piece behind a row.
using OtherInterpolant = std::function<double(std::size_t row, double x)>;

InterpolantDeviation deviation(const Rows& rows, const OtherInterpolant& other,
                               Interpolation own = Interpolation::monotone) {
    if (rows.size() < 2) return {};
    std::vector<reader::TablePoint> points;
    double largest = 0;
    for (const auto& [x, f] : rows) {
        if (!points.empty() && !(x > points.back().x && f >= points.back().f)) return {};
        points.push_back({x, f});
        largest = std::max(largest, std::abs(f));
    }
    const Curve curve = own == Interpolation::linear ? reader::piecewise_linear(points)
                                                     : reader::interpolant(points);
    InterpolantDeviation worst{.largest_force = largest};
    for (std::size_t k = 0; k + 1 < rows.size(); ++k)
        for (int n = 1; n < samples; ++n) {
            const double t = (rows[k + 1].first - rows[k].first) * n / samples,
                         x = rows[k].first + t;
            const auto& c = curve.pieces[k + 1];  // pieces[0]: left of the rows
            const double force = std::abs(c[0] + t * (c[1] + t * (c[2] + t * c[3])) - other(k, x));
            if (force > worst.force) {
                worst.force = force;
                worst.at = x;
            }
        }
    return worst;
}

// The cubic with the values and slopes of rows k and k + 1.
double hermite(const Rows& rows, const std::vector<double>& slope, std::size_t k, double x) {
    const double h = rows[k + 1].first - rows[k].first, t = (x - rows[k].first) / h;
    const double f0 = rows[k].second, f1 = rows[k + 1].second;
    return f0 * (1 + 2 * t) * (1 - t) * (1 - t) + f1 * t * t * (3 - 2 * t) +
           h * slope[k] * t * (1 - t) * (1 - t) - h * slope[k + 1] * t * t * (1 - t);
}

// Slope of the line from row k to row k + 1.
double secant(const Rows& rows, std::size_t k) {
    return (rows[k + 1].second - rows[k].second) / (rows[k + 1].first - rows[k].first);
}

}  // namespace

// With secants s_1, s_2 before a row and s_3, s_4 behind it, Akima's slope there is
//   (|s_4 - s_3| s_2 + |s_2 - s_1| s_3) / (|s_4 - s_3| + |s_2 - s_1|).
// Beyond the ends the secants are extrapolated linearly.
InterpolantDeviation deviation_from_akima(const Rows& rows, Interpolation own) {
    const std::size_t n = rows.size();
    if (n < 2) return {};
    std::vector<double> m(n + 3);  // m[k + 2] is the secant behind row k
    for (std::size_t k = 0; k + 1 < n; ++k) m[k + 2] = secant(rows, k);
    const double second = n > 2 ? m[3] : m[2], last_but_one = n > 2 ? m[n - 1] : m[n];
    m[1] = 2 * m[2] - second;
    m[0] = 2 * m[1] - m[2];
    m[n + 1] = 2 * m[n] - last_but_one;
    m[n + 2] = 2 * m[n + 1] - m[n];
    std::vector<double> slope(n);
    for (std::size_t k = 0; k < n; ++k) {
        const double a = std::abs(m[k + 3] - m[k + 2]), b = std::abs(m[k + 1] - m[k]);
        slope[k] =
            a + b > 0 ? (a * m[k + 1] + b * m[k + 2]) / (a + b) : 0.5 * (m[k + 1] + m[k + 2]);
    }
    return deviation(
        rows, [&](std::size_t k, double x) { return hermite(rows, slope, k, x); }, own);
}

// Second derivatives M_k at the rows, zero at the ends, from the tridiagonal equations
//   h_k-1 M_k-1 + 2 (h_k-1 + h_k) M_k + h_k M_k+1 = 6 (s_k - s_k-1),  h widths and s secants of the pieces.
InterpolantDeviation deviation_from_natural_spline(const Rows& rows) {
    const std::size_t n = rows.size();
    if (n < 2) return {};
    const auto h = [&](std::size_t k) { return rows[k + 1].first - rows[k].first; };
    std::vector<double> M(n, 0), diagonal(n, 1), right(n, 0);
    for (std::size_t k = 1; k + 1 < n; ++k) {
        diagonal[k] = 2 * (h(k - 1) + h(k));
        right[k] = 6 * (secant(rows, k) - secant(rows, k - 1));
        if (k > 1) {
            const double factor = h(k - 1) / diagonal[k - 1];
            diagonal[k] -= factor * h(k - 1);
            right[k] -= factor * right[k - 1];
        }
    }
    for (std::size_t k = n - 1; k-- > 1;) M[k] = (right[k] - h(k) * M[k + 1]) / diagonal[k];
    return deviation(rows, [&](std::size_t k, double x) {
        const double H = h(k), a = rows[k + 1].first - x, b = x - rows[k].first;
        return M[k] * a * a * a / (6 * H) + M[k + 1] * b * b * b / (6 * H) +
               (rows[k].second / H - M[k] * H / 6) * a +
               (rows[k + 1].second / H - M[k + 1] * H / 6) * b;
    });
}

InterpolantDeviation deviation_from_lines(const Rows& rows) {
    return deviation(rows, [&](std::size_t k, double x) {
        return rows[k].second + secant(rows, k) * (x - rows[k].first);
    });
}

bool is_straight(const Curve& law) {
    return std::ranges::all_of(law.pieces, [](const auto& c) { return c[2] == 0 && c[3] == 0; });
}

InterpolantDeviation deviation_from_power(const Rows& rows, double factor, double exponent) {
    return deviation(rows, [&](std::size_t, double x) { return factor * std::pow(x, exponent); });
}

}  // namespace elastocheck::importer
