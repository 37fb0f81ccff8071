// Gauss-Legendre quadrature over an interval, and the root of an increasing function in one.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace elastocheck::support {

struct Node {
    double x = 0, weight = 0;
};

// ∫ f dx over from ... to is Σ weight · f(x), exactly for polynomials up to degree 2n - 1. The points are the zeros of
// the Legendre polynomial P_n, by Newton's method from Tricomi's estimate; the weights 2 / ((1 - x²) P_n'²).
inline std::vector<Node> gauss(double from, double to, int n) {
    std::vector<Node> nodes;
    for (int k = n; k >= 1; --k) {
        double x = std::cos(std::numbers::pi * (k - 0.25) / (n + 0.5)), slope = 0;
        for (int i = 0; i < 8; ++i) {
            double p = 1, before = 0;
            for (int m = 1; m <= n; ++m) {
                const double next = ((2 * m - 1) * x * p - (m - 1) * before) / m;
                before = p;
                p = next;
            }
            slope = n * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        const double half = (to - from) / 2;
        nodes.push_back({from + half * (1 + x), half * 2 / ((1 - x * x) * slope * slope)});
    }
    return nodes;
}

// Solution x of increasing f(x) = 0 in [low, high].
template <class F>
double root(F&& f, double low, double high) {
    for (int k = 0; k < 200; ++k) {
        const double middle = (low + high) / 2;
        (f(middle) < 0 ? low : high) = middle;
    }
    return low;
}

}  // namespace elastocheck::support
