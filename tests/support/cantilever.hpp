// A leaf of spring steel as a cantilever: its scene in any number of segments, its elastica and its critical load.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace elastocheck::support {

// A leaf of spring steel, 1 m long, 60 mm wide, 12 mm thick, clamped at the root; it bends in the plane xy.
inline constexpr double E = 206e9, G = 79e9, L = 1, width = 0.060, thick = 0.012;
inline constexpr double EI = E * width * thick * thick * thick / 12;  // 1780 N·m²
inline std::string leaf(int segments) {
    return fmt::format(
        "points: {{root: [0, 0, 0], tip: [{}, 0, 0]}}\nbodies: {{tip: {{origin: tip}}}}\n"
        "beams: {{leaf: {{bodies: [ground, tip], through: [root, tip], segments: {}, E: {}, G: {}, "
        "up: z,\n"
        "  A: {}, I_y: {}, I_z: {}, J: {}}}}}\nprobes: {{tip: {{on: tip, at: tip}}}}\n",
        L, segments, E, G, width * thick, width * width * width * thick / 12,
        width * thick * thick * thick / 12, width * thick * thick * thick / 3);
}

// The elastica EI φ'' = -P cos φ under a dead force P across its root, in Legendre's integrals: with φ_L the slope of
// the tip, k² = (1 + sin φ_L)/2 and sin ψ = 1/(k√2)
//
//   √(P/EI) L = F(k, π/2) - F(k, ψ)     x = √(EI/P) 2 k cos ψ     y = L - 2 √(EI/P) (E(k, π/2) - E(k, ψ))
struct Tip {
    double x, y;  // of L
};
inline Tip elastica(double alpha) {  // P L²/EI
    const double root = std::sqrt(alpha), quarter = std::numbers::pi / 2;
    const auto psi = [](double k) {
        return std::asin(std::min(1.0, 1 / (k * std::numbers::sqrt2)));
    };
    double low = 1 / std::numbers::sqrt2, high = 1 - 1e-12;
    for (int i = 0; i < 100; ++i) {
        const double k = (low + high) / 2;
        (std::ellint_1(k, quarter) - std::ellint_1(k, psi(k)) < root ? low : high) = k;
    }
    const double k = low;
    return {2 * k * std::cos(psi(k)) / root,
            1 - 2 / root * (std::ellint_2(k, quarter) - std::ellint_2(k, psi(k)))};
}

// Critical load P [N] of the leaf with n segments under a compressive axial force.
//
// Node k has the rotation φ_k and, from the tip, the deflection u_k = w_n - w_k. A segment of length h bends under the
// moment of P about its middle, shears under the part of P across it, with β = P h²/(12EI), and shortens by
// ε = P/EA = β ρ, ρ = 12EI/(EA h²):
//
//   w_k+1 - w_k = h (1 + β - ε) ½ (φ_k + φ_k+1)   EI/h (φ_k+1 - φ_k) = P (½ (u_k + u_k+1) + ¼ h (φ_k+1 - φ_k))
//
// φ_k ~ sin kμ, u_k ~ cos kμ satisfy both if T = tan²(μ/2) = 3β(1 + β - ε)/(1 - 3β), and the free tip requires
// μ n = π/2:  3(1 - ρ)β² + 3(1 + T)β = T. P/P_E is then 1 + O(μ²), P_E = π² EI/(4 L²).
inline double critical_load(int n) {
    const double T = std::pow(std::tan(std::numbers::pi / (4 * n)), 2), h = L / n,
                 EA = E * width * thick;
    const double rho = 12 * EI / (EA * h * h), b = 3 * (1 + T);
    const double beta = 2 * T / (std::sqrt(b * b + 12 * T * (1 - rho)) + b);
    return 12 * EI * beta / (h * h);
}

// Order of convergence from the errors at n and 2n segments.
inline double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace elastocheck::support
