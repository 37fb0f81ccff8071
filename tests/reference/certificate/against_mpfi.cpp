// Interval arithmetic, series, angles and logarithm against MPFI and MPFR at 400 bits: the
// enclosure contains the exact result, for any compiler and flags. A separate program, so that it
// can be built with several of them:
//
//   against_mpfi [PAIRS]      exit code 1 at any violation; default 100000 pairs of operands
#include <mpfi.h>
#include <mpfr.h>

#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "reference/certificate/interval/rotations.hpp"

namespace {

using namespace elastocheck::reference::certificate;

constexpr mpfr_prec_t bits = 400;

struct Exact {
    mpfi_t x;
    Exact() { mpfi_init2(x, bits); }
    explicit Exact(const Interval& a) : Exact() { mpfi_interv_d(x, a.lo, a.hi); }
    ~Exact() { mpfi_clear(x); }
    Exact(const Exact&) = delete;
    Exact& operator=(const Exact&) = delete;
};
struct Real {
    mpfr_t x;
    Real() { mpfr_init2(x, bits); }
    explicit Real(double a) : Real() { mpfr_set_d(x, a, MPFR_RNDN); }
    ~Real() { mpfr_clear(x); }
    Real(const Real&) = delete;
    Real& operator=(const Real&) = delete;
};

long checked = 0, violations = 0, said = 0;

void note(bool fine, const char* what, const Interval& a, const Interval& b, const Interval& got) {
    ++checked;
    if (fine) return;
    ++violations;
    if (++said <= 20)
        std::printf("%s of [%a, %a] [%a, %a] is not in [%a, %a]\n", what, a.lo, a.hi, b.lo, b.hi,
                    got.lo, got.hi);
}

// The enclosure contains the whole exact result. A NaN in the exact result means undefined: then
// the enclosure must be unbounded.
void holds(const char* what, const Interval& a, const Interval& b, const Interval& got,
           const Exact& exact) {
    if (mpfi_nan_p(exact.x)) return note(!is_bounded(got), what, a, b, got);
    note(mpfr_cmp_d(&exact.x->left, got.lo) >= 0 && mpfr_cmp_d(&exact.x->right, got.hi) <= 0, what,
         a, b, got);
}
// The rounding of MPFR at 400 bits is far below that of a double.
void holds(const char* what, const Interval& a, const Interval& b, const Interval& got,
           const Real& exact) {
    note(mpfr_nan_p(exact.x) == 0 && mpfr_cmp_d(exact.x, got.lo) >= 0 &&
             mpfr_cmp_d(exact.x, got.hi) <= 0,
         what, a, b, got);
}

void operators(const Interval& a, const Interval& b) {
    const Exact x(a), y(b);
    Exact exact;
    mpfi_add(exact.x, x.x, y.x);
    holds("sum", a, b, a + b, exact);
    mpfi_sub(exact.x, x.x, y.x);
    holds("difference", a, b, a - b, exact);
    mpfi_mul(exact.x, x.x, y.x);
    holds("product", a, b, a * b, exact);
    mpfi_div(exact.x, x.x, y.x);
    if (contains(b, 0))
        note(!is_bounded(a / b), "quotient by zero", a, b, a / b);
    else
        holds("quotient", a, b, a / b, exact);
    mpfi_sqr(exact.x, x.x);
    holds("square", a, b, sqr(a), exact);
    if (a.lo >= 0) {
        mpfi_sqrt(exact.x, x.x);
        holds("root", a, b, sqrt(a), exact);
    } else {
        note(!is_bounded(sqrt(a)), "root below zero", a, b, sqrt(a));
    }
    const Interval both = hull(a, b);
    note(is_inside(a, both) && is_inside(b, both), "hull", a, b, both);
    if (is_bounded(a)) {
        const Interval ball = around(mid(a), rad(a));
        note(is_inside(a, ball), "middle and radius", a, b, ball);
    }
    const Interval common{std::max(a.lo, b.lo), std::min(a.hi, b.hi)}, cut = intersection(a, b);
    if (!are_disjoint(a, b)) note(is_inside(common, cut), "intersection", a, b, cut);
}

// ---- y = asin √x / √(x (1-x)) and (1 - (1-x) y) / x with two derivatives, from
//
//   y' = (1 - (1-2x) y) / (2x (1-x))     and its own derivative
void series(double x) {
    Interval turn[3], bend[3];
    expand(Series::turn, Interval(x), 3, turn);
    expand(Series::bend, Interval(x), 3, bend);
    const Real X(x);
    Real root, one_x, y, y1, y2, s, t;
    mpfr_sqrt(root.x, X.x, MPFR_RNDN);
    mpfr_ui_sub(one_x.x, 1, X.x, MPFR_RNDN);
    mpfr_asin(y.x, root.x, MPFR_RNDN);
    mpfr_mul(s.x, X.x, one_x.x, MPFR_RNDN);
    mpfr_sqrt(t.x, s.x, MPFR_RNDN);
    mpfr_div(y.x, y.x, t.x, MPFR_RNDN);
    holds("turn", x, x, turn[0], y);
    // 2x(1-x) y' = 1 - (1-2x) y
    mpfr_mul_ui(s.x, s.x, 2, MPFR_RNDN);
    mpfr_sub(t.x, one_x.x, X.x, MPFR_RNDN);
    Real w;
    mpfr_mul(w.x, t.x, y.x, MPFR_RNDN);
    mpfr_ui_sub(w.x, 1, w.x, MPFR_RNDN);
    mpfr_div(y1.x, w.x, s.x, MPFR_RNDN);
    holds("turn'", x, x, turn[1], y1);
    // differentiated: 2x(1-x) y'' = 2 y - 3 (1-2x) y'
    mpfr_mul(w.x, t.x, y1.x, MPFR_RNDN);
    mpfr_mul_ui(w.x, w.x, 3, MPFR_RNDN);
    mpfr_mul_ui(y2.x, y.x, 2, MPFR_RNDN);
    mpfr_sub(y2.x, y2.x, w.x, MPFR_RNDN);
    mpfr_div(y2.x, y2.x, s.x, MPFR_RNDN);
    mpfr_div_ui(w.x, y2.x, 2, MPFR_RNDN);
    holds("turn''/2", x, x, turn[2], w);
    // b = (1 - (1-x) y) / x,  b' = (y - (1-x) y' - b) / x,  b'' = (2 y' - (1-x) y'' - 2 b') / x
    Real b, b1, b2;
    mpfr_mul(b.x, one_x.x, y.x, MPFR_RNDN);
    mpfr_ui_sub(b.x, 1, b.x, MPFR_RNDN);
    mpfr_div(b.x, b.x, X.x, MPFR_RNDN);
    holds("bend", x, x, bend[0], b);
    mpfr_mul(w.x, one_x.x, y1.x, MPFR_RNDN);
    mpfr_sub(b1.x, y.x, w.x, MPFR_RNDN);
    mpfr_sub(b1.x, b1.x, b.x, MPFR_RNDN);
    mpfr_div(b1.x, b1.x, X.x, MPFR_RNDN);
    holds("bend'", x, x, bend[1], b1);
    mpfr_mul(w.x, one_x.x, y2.x, MPFR_RNDN);
    mpfr_mul_ui(b2.x, y1.x, 2, MPFR_RNDN);
    mpfr_sub(b2.x, b2.x, w.x, MPFR_RNDN);
    mpfr_mul_ui(w.x, b1.x, 2, MPFR_RNDN);
    mpfr_sub(b2.x, b2.x, w.x, MPFR_RNDN);
    mpfr_div(b2.x, b2.x, X.x, MPFR_RNDN);
    mpfr_div_ui(w.x, b2.x, 2, MPFR_RNDN);
    holds("bend''/2", x, x, bend[2], w);
}

void angles(double y, double x) {
    Real exact;
    const Real Y(y), X(x);
    mpfr_atan2(exact.x, Y.x, X.x, MPFR_RNDN);
    const Interval got = plane_angle(Interval(y), Interval(x));
    if (is_bounded(got)) holds("angle in the plane", y, x, got, exact);
    mpfr_cos(exact.x, Y.x, MPFR_RNDN);
    holds("cosine", y, y, cos_sin(y).cos, exact);
    mpfr_sin(exact.x, Y.x, MPFR_RNDN);
    holds("sine", y, y, cos_sin(y).sin, exact);
}

// θ = 2 atan2(|v|, w) v / |v| of the direction of q, and c = (1 - (θ/2) cot(θ/2)) / θ².
void logarithms(const Eigen::Quaterniond& stored) {
    const auto [theta, c] = logarithm(unit_quaternion<Interval>(stored));
    if (!is_bounded(c)) return;
    const double sign = stored.w() < 0 ? -1 : 1;
    const Real w(sign * stored.w()), x(sign * stored.x()), y(sign * stored.y()),
        z(sign * stored.z());
    Real size, half, s, t;
    mpfr_sqr(size.x, x.x, MPFR_RNDN);
    for (const Real* part : {&y, &z}) {
        mpfr_sqr(s.x, part->x, MPFR_RNDN);
        mpfr_add(size.x, size.x, s.x, MPFR_RNDN);
    }
    mpfr_sqrt(size.x, size.x, MPFR_RNDN);
    mpfr_atan2(half.x, size.x, w.x, MPFR_RNDN);
    if (mpfr_zero_p(size.x)) return;
    mpfr_div(s.x, half.x, size.x, MPFR_RNDN);
    mpfr_mul_ui(s.x, s.x, 2, MPFR_RNDN);
    const Real* parts[] = {&x, &y, &z};
    for (std::size_t k = 0; k < 3; ++k) {
        mpfr_mul(t.x, s.x, parts[k]->x, MPFR_RNDN);
        holds("logarithm", stored.w(), stored.coeffs()[static_cast<int>(k)], theta[k], t);
    }
    mpfr_cot(s.x, half.x, MPFR_RNDN);
    mpfr_mul(s.x, s.x, half.x, MPFR_RNDN);
    mpfr_ui_sub(s.x, 1, s.x, MPFR_RNDN);
    mpfr_sqr(t.x, half.x, MPFR_RNDN);
    mpfr_mul_ui(t.x, t.x, 4, MPFR_RNDN);
    mpfr_div(s.x, s.x, t.x, MPFR_RNDN);
    holds("bend of the logarithm", stored.w(), mpfr_get_d(half.x, MPFR_RNDN), c, s);
}

}  // namespace

int main(int count, char** arguments) {
    const long pairs = count > 1 ? std::atol(arguments[1]) : 100000;
    if (!arithmetic_is_as_proved()) {
        std::puts("doubles are not rounded to nearest here, or small ones are dropped");
        return 1;
    }
    const double least = std::numeric_limits<double>::denorm_min(),
                 normal = std::numeric_limits<double>::min(),
                 most = std::numeric_limits<double>::max(),
                 infinite = std::numeric_limits<double>::infinity();
    std::vector<double> special{
        0.,       1.,       3.,     0.1,   least, normal, normal - least, 1.5 * normal, most,
        most / 2, infinite, 1e-160, 1e160, 2.,    0.5,    next_up(1.),    next_down(1.)};
    for (std::size_t k = special.size(); k-- > 0;) special.push_back(-special[k]);
    for (const double a : special)
        for (const double b : special) {
            if (!(a <= b)) continue;
            for (const double c : special)
                for (const double d : special)
                    if (c <= d) operators({a, b}, {c, d});
        }

    std::mt19937_64 random(20240607);
    std::uniform_real_distribution<double> unit(-1, 1), exponent(-300, 300), small(-20, 20),
        depth(-30, 0);
    const auto number = [&](auto& range) { return unit(random) * std::pow(10., range(random)); };
    for (long n = 0; n < pairs; ++n) {
        const auto interval = [&]() -> Interval {
            const double a = n % 3 == 0   ? std::bit_cast<double>(random())
                             : n % 3 == 1 ? number(exponent)
                                          : number(small);
            if (!std::isfinite(a)) return 1.;
            switch (random() % 4) {
                case 0: return a;
                case 1: return {a, next_up(a)};
                case 2: return {a, a + std::abs(a) * std::pow(10., depth(random) / 2)};
                default: {
                    const double b = number(small);
                    return {std::min(a, b), std::max(a, b)};
                }
            }
        };
        operators(interval(), interval());
        if (n % 10 != 0) continue;
        series(std::abs(unit(random)) * (n % 20 == 0 ? 0.9 : std::pow(10., depth(random))));
        angles(7 * unit(random), unit(random));
        const double turn = n % 20 == 0 ? 1 : std::pow(10., depth(random) / 2);
        logarithms(Eigen::Quaterniond(unit(random), turn * unit(random), turn * unit(random),
                                      turn * unit(random))
                       .normalized());
    }
    std::printf("%ld results, %ld violations\n", checked, violations);
    return violations == 0 ? 0 : 1;
}
