#include "models/import/curves.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "models/reader/tables/interpolant.hpp"

namespace elastocheck::importer {
namespace {

constexpr int samples = 16;  // per piece

using Theirs = std::function<double(std::size_t piece, double x)>;

Apart off(const Rows& rows, const Theirs& theirs, Between between = Between::monotone) {
    if (rows.size() < 2) return {};
    std::vector<reader::TablePoint> points;
    double largest = 0;
    for (const auto& [x, f] : rows) {
        if (!points.empty() && !(x > points.back().x && f >= points.back().f)) return {};
        points.push_back({x, f});
        largest = std::max(largest, std::abs(f));
    }
    const Curve ours =
        between == Between::straight ? reader::polygon(points) : reader::interpolant(points);
    Apart worst{.of = largest};
    for (std::size_t k = 0; k + 1 < rows.size(); ++k)
        for (int n = 1; n < samples; ++n) {
            const double t = (rows[k + 1].first - rows[k].first) * n / samples,
                         x = rows[k].first + t;
            const auto& c = ours.pieces[k + 1];
            const double force = std::abs(c[0] + t * (c[1] + t * (c[2] + t * c[3])) - theirs(k, x));
            if (force > worst.force) {
                worst.force = force;
                worst.at = x;
            }
        }
    return worst;
}

double hermite(const Rows& rows, const std::vector<double>& slope, std::size_t k, double x) {
    const double h = rows[k + 1].first - rows[k].first, t = (x - rows[k].first) / h;
    const double f0 = rows[k].second, f1 = rows[k + 1].second;
    return f0 * (1 + 2 * t) * (1 - t) * (1 - t) + f1 * t * t * (3 - 2 * t) +
           h * slope[k] * t * (1 - t) * (1 - t) - h * slope[k + 1] * t * t * (1 - t);
}

double secant(const Rows& rows, std::size_t k) {
    return (rows[k + 1].second - rows[k].second) / (rows[k + 1].first - rows[k].first);
}

}  // namespace

// Akima's slope at a point is a weighted mean of the two adjacent secants. The weight of
// each is the difference of the two secants on the other side. Beyond the ends the secants
// are extrapolated linearly.
Apart off_akima(const Rows& rows, Between ours) {
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
    return off(
        rows, [&](std::size_t k, double x) { return hermite(rows, slope, k, x); }, ours);
}

// Second derivatives M by the tridiagonal equations, zero at the ends.
Apart off_natural(const Rows& rows) {
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
    return off(rows, [&](std::size_t k, double x) {
        const double H = h(k), a = rows[k + 1].first - x, b = x - rows[k].first;
        return M[k] * a * a * a / (6 * H) + M[k + 1] * b * b * b / (6 * H) +
               (rows[k].second / H - M[k] * H / 6) * a +
               (rows[k + 1].second / H - M[k + 1] * H / 6) * b;
    });
}

Apart off_straight(const Rows& rows) {
    return off(rows, [&](std::size_t k, double x) {
        return rows[k].second + secant(rows, k) * (x - rows[k].first);
    });
}

bool is_straight(const Curve& law) {
    return std::ranges::all_of(law.pieces, [](const auto& c) { return c[2] == 0 && c[3] == 0; });
}

Apart off_power(const Rows& rows, double factor, double exponent) {
    return off(rows, [&](std::size_t, double x) { return factor * std::pow(x, exponent); });
}

}  // namespace elastocheck::importer
