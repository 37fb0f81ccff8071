#include "recursive/series/pieces.hpp"

#include <algorithm>
#include <cmath>

namespace elastocheck::recursive::series {
namespace {

using Polynomial = Eigen::VectorXd;  // c_0 + c_1 τ + ...

double value(const Polynomial& c, double tau) {
    double sum = 0;
    for (Eigen::Index k = c.size(); k-- > 0;) sum = sum * tau + c[k];
    return sum;
}

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

bool has_knot(const Followed& f, int direction) {
    return direction > 0 ? f.piece < static_cast<Piece>(f.curve->knots.size()) : f.piece > 0;
}
double knot(const Followed& f, int direction) {
    return f.curve->knots[static_cast<std::size_t>(direction > 0 ? f.piece : f.piece - 1)];
}
// Distance of the deformation x from that knot, positive inside the piece.
Polynomial inside(const Polynomial& x, const Followed& f, int direction) {
    Polynomial c = -direction * x;
    c[0] += direction * knot(f, direction);
    return c;
}
Polynomial series_of(const Equations<double>& e, const Followed& f) {
    Polynomial x(e.order() + 1);
    for (int k = 0; k <= e.order(); ++k) x[k] = deformation(e, f.elastic, f.axis, k);
    return x;
}

std::optional<Leaving> leaving(const Polynomial& f, int direction, double reach, double touch,
                               double arrived) {
    if (f[0] < -arrived) return Leaving{0, direction, true};
    // A start slightly beyond the knot, within its tolerance, counts as on the knot.
    Polynomial g = f;
    g[0] = std::max(g[0], 0.0);
    constexpr int halvings = 50;
    const auto out = first_below(bernstein(g, reach), -touch, 0, reach, halvings);
    if (!out) return std::nullopt;
    // The zero before `out`: step back until g is positive, then bisect.
    double from = *out, to = *out;
    for (double back = std::ldexp(reach, -halvings); from > 0 && !(value(g, from) > 0); back *= 2)
        from = std::max(0.0, *out - back);
    if (!(value(g, from) > 0)) from = to = 0;
    while (from != to) {
        const double middle = from + (to - from) / 2;
        if (middle == from || middle == to) break;
        (value(g, middle) > 0 ? from : to) = middle;
    }
    return Leaving{to, direction, bernstein(g, to).maxCoeff() <= touch};
}

double slope(const Curve& curve, Piece piece, double x) {
    return piece_of<double>(curve, x, piece).slope();
}

}  // namespace

std::vector<Followed> curves_of(const Model& model) {
    std::vector<Followed> curves;
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        each_curve(model.elastics[k].kind, [&](std::size_t axis, const Curve& curve) {
            curves.push_back({k, static_cast<int>(axis), &curve, 0});
        });
    }
    return curves;
}

void find_piece(const Equations<double>& e, Followed& f) {
    f.piece = piece_at<double>(*f.curve, deformation(e, f.elastic, f.axis, 0));
}

void follow_on(const Followed& f, Equations<double>& e) {
    const auto piece = static_cast<std::size_t>(f.piece);
    CubicSeries<double>& cubic = cubic_of(e, f.elastic, f.axis);
    cubic.c = f.curve->pieces[piece];
    cubic.about = f.curve->knots[piece == 0 ? 0 : piece - 1];
}
void follow_on(const Followed& f, Inputs<double>& inputs) {
    inputs.rest[f.elastic].piece[static_cast<std::size_t>(f.axis)] = f.piece;
}

std::optional<double> to_knot(const Equations<double>& e, const Followed& f, int direction) {
    if (!has_knot(f, direction)) return std::nullopt;
    return direction * (knot(f, direction) - deformation(e, f.elastic, f.axis, 0));
}

bool step_over(Followed& f, int direction) {
    const double x = knot(f, direction);
    const double before = slope(*f.curve, f.piece, x);
    f.piece += direction;
    const double behind = slope(*f.curve, f.piece, x);
    return std::abs(behind - before) > 1e-12 * std::max(std::abs(before), std::abs(behind));
}

std::optional<Leaving> leaving(const Equations<double>& e, const Followed& f, double reach,
                               const Near& near) {
    return leaving(series_of(e, f), f, reach, near);
}
std::optional<Leaving> leaving(const Eigen::VectorXd& x, const Followed& f, double reach,
                               const Near& near) {
    const double unit = f.turns() ? near.length : 1;
    std::optional<Leaving> first;
    for (const int direction : {+1, -1}) {
        if (!has_knot(f, direction)) continue;
        const auto there = leaving(inside(x, f, direction), direction, reach, near.touch / unit,
                                   near.arrived / unit);
        if (there && (!first || there->tau < first->tau)) first = there;
    }
    return first;
}

bool meets(const Eigen::VectorXd& x, const Followed& f, int direction, double tau,
           const Near& near) {
    return std::abs(value(inside(x, f, direction), tau)) <=
           near.touch / (f.turns() ? near.length : 1);
}
bool meets(const Equations<double>& e, const Followed& f, int direction, double tau,
           const Near& near) {
    return meets(series_of(e, f), f, direction, tau, near);
}

}  // namespace elastocheck::recursive::series
