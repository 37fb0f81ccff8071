// Monotone piecewise cubic Hermite interpolation (PCHIP).
//
// With h_k = x_k+1 - x_k and the secants d_k = (f_k+1 - f_k) / h_k, the slopes m at the points are
//
//   inside      1/m_k = α/d_k-1 + (1 - α)/d_k,  α = (h_k-1 + 2 h_k) / (3 (h_k-1 + h_k)); 0 if d = 0
//   at the end  m_0 = ((2 h_0 + h_1) d_0 - h_0 d_1) / (h_0 + h_1), not below 0
//
// (F. N. Fritsch, J. Butland: A method for constructing local monotone piecewise cubic
// interpolants, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304; the ends as in PCHIP.) So 0 ≤ m ≤ 3 d
// on both sides of each point, and the cubic
//
//   f = f_k + m_k t + (3 d_k - 2 m_k - m_k+1)/h_k t² + (m_k + m_k+1 - 2 d_k)/h_k² t³,  t = x - x_k
//
// does not fall between them (F. N. Fritsch, R. E. Carlson: Monotone piecewise cubic interpolation,
// SIAM J. Numer. Anal. 17 (1980) 238-246).
#include "models/reader/tables/interpolant.hpp"

#include <algorithm>

namespace elastocheck::reader {
namespace {

double inner_slope(double h_0, double d_0, double h_1, double d_1) {
    if (d_0 == 0 || d_1 == 0) return 0;
    const double a = (h_0 + 2 * h_1) / (3 * (h_0 + h_1));
    return 1 / (a / d_0 + (1 - a) / d_1);
}

double end_slope(double h_0, double d_0, double h_1, double d_1) {
    return std::max(0., ((2 * h_0 + h_1) * d_0 - h_0 * d_1) / (h_0 + h_1));
}

}  // namespace

Curve interpolant(const std::vector<TablePoint>& points) {
    const std::size_t n = points.size();
    std::vector<double> h(n - 1), d(n - 1), m(n);
    for (std::size_t k = 0; k + 1 < n; ++k) {
        h[k] = points[k + 1].x - points[k].x;
        d[k] = (points[k + 1].f - points[k].f) / h[k];
    }
    m.front() = n == 2 ? d[0] : end_slope(h[0], d[0], h[1], d[1]);
    for (std::size_t k = 1; k + 1 < n; ++k) m[k] = inner_slope(h[k - 1], d[k - 1], h[k], d[k]);
    m.back() = n == 2 ? d[0] : end_slope(h[n - 2], d[n - 2], h[n - 3], d[n - 3]);

    Curve curve;
    curve.pieces.push_back({points.front().f, m.front(), 0, 0});
    for (std::size_t k = 0; k + 1 < n; ++k)
        curve.pieces.push_back({points[k].f, m[k], (3 * d[k] - 2 * m[k] - m[k + 1]) / h[k],
                                (m[k] + m[k + 1] - 2 * d[k]) / (h[k] * h[k])});
    curve.pieces.push_back({points.back().f, m.back(), 0, 0});
    for (const TablePoint& point : points) curve.knots.push_back(point.x);
    return curve;
}

Curve piecewise_linear(const std::vector<TablePoint>& points) {
    Curve curve;
    for (std::size_t k = 0; k < points.size(); ++k) {
        // the last piece continues the one before it
        const std::size_t next = std::min(k + 1, points.size() - 1);
        const double slope =
            (points[next].f - points[next - 1].f) / (points[next].x - points[next - 1].x);
        if (k == 0) curve.pieces.push_back({points[0].f, slope, 0, 0});
        curve.pieces.push_back({points[k].f, slope, 0, 0});
        curve.knots.push_back(points[k].x);
    }
    return curve;
}

}  // namespace elastocheck::reader
