#include "reference/certificate/interval/laws.hpp"

namespace elastocheck::reference::certificate {
namespace {

std::size_t piece_at(const Curve& curve, double x) {
    return static_cast<std::size_t>(std::ranges::upper_bound(curve.knots, x) - curve.knots.begin());
}

// f⁽ʲ⁾/j! of the cubic of piece p, j = 0 ... 3
template <class B>
std::array<B, 4> expand_piece(const Curve& curve, std::size_t p, const B& x) {
    const auto& c = curve.pieces[p];
    const B t = x - B(curve.knots[p == 0 ? 0 : p - 1]), c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
    return {c0 + t * (c1 + t * (c2 + t * c3)), c1 + t * (B(2.) * c2 + t * (B(3.) * c3)),
            c2 + t * (B(3.) * c3), c3};
}

bool reaches_outside(const Curve& curve, const Interval& x) {
    return !curve.known_outside && (x.lo < curve.knots.front() || x.hi > curve.knots.back());
}

}  // namespace

bool spans_knot(const Curve& curve, const Interval& x) {
    return piece_at(curve, x.lo) != piece_at(curve, x.hi);
}

void expand(const Curve& curve, double x, int count, double* f) {
    const auto coefficients = expand_piece(curve, piece_at(curve, x), x);
    for (int j = 0; j < count; ++j) f[j] = j < 4 ? coefficients[static_cast<std::size_t>(j)] : 0;
}

void expand(const Curve& curve, const Interval& x, int count, Interval* f) {
    std::fill(f, f + count, everything);
    if (!is_bounded(x) || reaches_outside(curve, x)) return;
    const std::size_t first = piece_at(curve, x.lo), last = piece_at(curve, x.hi);
    for (std::size_t p = first; p <= last; ++p) {
        const Interval on{p == first ? x.lo : curve.knots[p - 1],
                          p == last ? x.hi : curve.knots[p]};
        const auto coefficients = expand_piece(curve, p, on);
        for (int j = 0; j < count; ++j) {
            const Interval here = j < 4 ? coefficients[static_cast<std::size_t>(j)] : Interval(0);
            if (p == first)
                f[j] = here;
            else
                f[j] = j < 2 ? hull(f[j], here) : everything;
        }
    }
}

}  // namespace elastocheck::reference::certificate
