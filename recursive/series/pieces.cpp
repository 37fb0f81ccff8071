#include "recursive/series/pieces.hpp"

#include <algorithm>
#include <cmath>

#include "recursive/series/polynomial.hpp"

namespace elastocheck::recursive::series {
namespace {

using Polynomial = Eigen::VectorXd;  // c_0 + c_1 τ + ...

// Coefficients of the polynomial in the Bernstein basis of [0, h]; its values lie between the
// smallest and the largest of them.
Polynomial bernstein(const Polynomial& c, double h) {
    const Eigen::Index p = c.size() - 1;
    Polynomial b = Polynomial::Zero(p + 1);
    for (Eigen::Index i = 0; i <= p; ++i) {
        double weight = 1;  // (i over k) / (p over k) hᵏ
        for (Eigen::Index k = 0; k <= i; ++k) {
            b[i] += weight * c[k];
            weight *= h * static_cast<double>(i - k) / static_cast<double>(p - k == 0 ? 1 : p - k);
        }
    }
    return b;
}

// First τ in [from, to] at which the polynomial is below `level`, to round-off of `to`: bisection,
// left half first, skipping halves that are above `level` throughout.
std::optional<double> first_below(Polynomial b, double level, double from, double to,
                                  int halvings) {
    if (!(b.minCoeff() < level)) return std::nullopt;
    if (b[0] < level || halvings == 0) return b[0] < level ? from : to;
    const Eigen::Index p = b.size() - 1;
    Polynomial left(p + 1);
    for (Eigen::Index k = 0; k <= p; ++k) {  // de Casteljau
        left[k] = b[0];
        for (Eigen::Index i = 0; i + k < p; ++i) b[i] = (b[i] + b[i + 1]) / 2;
    }
    // b now holds the right half.
    const double middle = (from + to) / 2;
    if (const auto first = first_below(left, level, from, middle, halvings - 1)) return first;
    return first_below(b, level, middle, to, halvings - 1);
}

bool has_knot(const CurvePiece& f, int direction) {
    return direction > 0 ? f.piece < static_cast<Piece>(f.curve->knots.size()) : f.piece > 0;
}
double knot(const CurvePiece& f, int direction) {
    return f.curve->knots[static_cast<std::size_t>(direction > 0 ? f.piece : f.piece - 1)];
}
// Distance of the deformation x from that knot, positive inside the piece.
Polynomial distance_inside(const Polynomial& x, const CurvePiece& f, int direction) {
    Polynomial c = -direction * x;
    c[0] += direction * knot(f, direction);
    return c;
}
// First exit at one knot. f: distance from it, positive inside the piece; overshoot, start: those of
// KnotTolerance in units of f.
std::optional<PieceExit> exit_at_knot(const Polynomial& f, int direction, double reach,
                                      double overshoot, double start) {
    if (f[0] < -start) return PieceExit{0, direction, true};
    // A start slightly beyond the knot, within its tolerance, counts as on the knot.
    Polynomial g = f;
    g[0] = std::max(g[0], 0.0);
    constexpr int halvings = 50;
    const auto tau_outside = first_below(bernstein(g, reach), -overshoot, 0, reach, halvings);
    if (!tau_outside) return std::nullopt;
    // The zero before tau_outside: step back until g is positive, then bisect.
    double low = *tau_outside, high = *tau_outside;
    for (double back = std::ldexp(reach, -halvings); low > 0 && !(polynomial(g, low) > 0);
         back *= 2)
        low = std::max(0.0, *tau_outside - back);
    if (!(polynomial(g, low) > 0)) low = high = 0;
    while (low != high) {
        const double middle = low + (high - low) / 2;
        if (middle == low || middle == high) break;
        (polynomial(g, middle) > 0 ? low : high) = middle;
    }
    return PieceExit{high, direction, bernstein(g, high).maxCoeff() <= overshoot};
}

double slope(const Curve& curve, Piece piece, double x) {
    return piece_of<double>(curve, x, piece).slope();
}

}  // namespace

std::vector<CurvePiece> curves_of(const Model& model) {
    std::vector<CurvePiece> curves;
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        each_curve(model.elastics[k].kind, [&](std::size_t axis, const Curve& curve) {
            curves.push_back({k, static_cast<int>(axis), &curve, 0});
        });
    }
    return curves;
}

void find_piece(const Equations<double>& e, CurvePiece& f) {
    f.piece = piece_at<double>(*f.curve, deformation(e, f.elastic, f.axis, 0));
}

void set_piece(const CurvePiece& f, Equations<double>& e) {
    const auto piece = static_cast<std::size_t>(f.piece);
    CubicSeries<double>& cubic = cubic_of(e, f.elastic, f.axis);
    cubic.c = f.curve->pieces[piece];
    cubic.about = f.curve->knots[piece == 0 ? 0 : piece - 1];
}
void set_piece(const CurvePiece& f, Inputs<double>& inputs) {
    inputs.rest[f.elastic].piece[static_cast<std::size_t>(f.axis)] = f.piece;
}

std::optional<double> distance_to_knot(const Equations<double>& e, const CurvePiece& f,
                                       int direction) {
    if (!has_knot(f, direction)) return std::nullopt;
    return direction * (knot(f, direction) - deformation(e, f.elastic, f.axis, 0));
}

bool cross_knot(CurvePiece& f, int direction) {
    const double x = knot(f, direction);
    constexpr double rounding = 1e-12;
    const double slope_before = slope(*f.curve, f.piece, x);
    f.piece += direction;
    const double slope_after = slope(*f.curve, f.piece, x);
    return std::abs(slope_after - slope_before) >
           rounding * std::max(std::abs(slope_before), std::abs(slope_after));
}

Eigen::VectorXd deformation_series(const Equations<double>& e, const CurvePiece& f, int order) {
    Eigen::VectorXd x(order + 1);
    for (int k = 0; k <= order; ++k) x[k] = deformation(e, f.elastic, f.axis, k);
    return x;
}

std::optional<PieceExit> exit_from_piece(const Eigen::VectorXd& x, const CurvePiece& f,
                                         double reach, const KnotTolerance& tolerance) {
    const double unit = f.is_angle() ? tolerance.length : 1;
    std::optional<PieceExit> first;
    for (const int direction : {+1, -1}) {
        if (!has_knot(f, direction)) continue;
        const auto exit = exit_at_knot(distance_inside(x, f, direction), direction, reach,
                                       tolerance.overshoot / unit, tolerance.start / unit);
        if (exit && (!first || exit->tau < first->tau)) first = exit;
    }
    return first;
}

bool is_at_knot(const Eigen::VectorXd& x, const CurvePiece& f, int direction, double tau,
                const KnotTolerance& tolerance) {
    return std::abs(polynomial(distance_inside(x, f, direction), tau)) <=
           tolerance.overshoot / (f.is_angle() ? tolerance.length : 1);
}

}  // namespace elastocheck::recursive::series
