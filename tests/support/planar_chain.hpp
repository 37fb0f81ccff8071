// A chain of bodies in a plane under a dead force at its end, solved link by link: the reference for large scenes.
//
// Elastic joint s = 1 ... n connects body s to body s-1, the first to ground. Body s is rotated by φ_s, φ_0 = 0;
// e(φ) = (cos φ, sin φ) is along it, ℓ_s is its length from joint s to joint s+1 or to the end. Joint s has the bending
// stiffness c and deflects by Δ_s, with the compliances a along and b across the middle axes φ_s-½ = ½ (φ_s-1 + φ_s):
//
//   U_s = ½ c (φ_s - φ_s-1)² + ½ Δ_sᵀ C(φ_s-½)⁻¹ Δ_s     C(φ) = a e eᵀ + b e' e'ᵀ
//
// The end is at Σ (Δ_s + ℓ_s e(φ_s)). The energy less the work of F is stationary in Δ_s at Δ_s = C F, so that the
// angles make stationary
//
//   Σ ½ c (φ_s - φ_s-1)² - ½ Fᵀ C(φ_s-½) F - ℓ_s F·e(φ_s)
//
// With the bending moment M_s = c (φ_s - φ_s-1) and g(φ) = Fᵀ C' F = 2 (a - b)(F·e)(F·e'), from the end backwards:
//
//   M_s = M_s+1 + ℓ_s F·e'(φ_s) + ¼ (g(φ_s-½) + g(φ_s+½)),  M_n+1 = 0, and without g(φ_n+½)
//
// φ_n determines all other angles; bisection finds the φ_n with φ_0 = 0. For a = b, g is zero.
#pragma once

#include <cmath>
#include <vector>

namespace elastocheck::support {

struct PlanarChain {
    using Real = long double;
    int n = 1;
    Real ground = 0;            // from the origin to the first joint
    Real length = 1, last = 1;  // ℓ of all bodies, of the last
    Real origin = 0;            // of a body, from its joint
    Real c = 1, a = 0,
         b = 0;  // bending stiffness and compliances of a joint along and across

    struct Shape {
        std::vector<Real> phi, x, z;  // of the bodies' origins, 1 ... n
        Real end_x = 0, end_z = 0;
    };

    // Links of this length on bushings of equal compliance in all directions; 0 for rigid joints.
    static PlanarChain links(int n, Real length, Real k_R, Real compliance) {
        return {n, 0, length, length, 0, k_R, compliance, compliance};
    }
    // A beam of EI and EA of n segments with elastic middles (models/reader/definitions/beams.hpp); bodies are at the nodes.
    static PlanarChain beam(int n, Real length, Real bending, Real stretching) {
        const Real h = length / n;
        return {n, h / 2, h, h / 2, h / 2, bending / h, h / stretching, h * h * h / (12 * bending)};
    }

    // Shape under a force that bends it to φ > 0, up to the direction of the force, where φ_0 increases with φ_n.
    Shape under(Real F_x, Real F_z) const {
        Shape shape;
        shape.phi.assign(static_cast<std::size_t>(n) + 1, 0);
        Real low = 0, high = std::atan2(F_z, F_x);
        for (int i = 0; i < 70; ++i) {
            const Real middle = (low + high) / 2;
            (first_angle(middle, F_x, F_z, shape.phi) < 0 ? low : high) = middle;
        }
        place_bodies(F_x, F_z, shape);
        return shape;
    }

  private:
    static Real along(Real F_x, Real F_z, Real phi) {
        return F_x * std::cos(phi) + F_z * std::sin(phi);
    }
    static Real across(Real F_x, Real F_z, Real phi) {
        return F_z * std::cos(phi) - F_x * std::sin(phi);
    }
    Real g(Real F_x, Real F_z, Real phi) const {
        return 2 * (a - b) * along(F_x, F_z, phi) * across(F_x, F_z, phi);
    }

    // Angles from φ_n backwards; returns φ_0.
    Real first_angle(Real end, Real F_x, Real F_z, std::vector<Real>& phi) const {
        Real M = 0, g_before = 0;
        phi[static_cast<std::size_t>(n)] = end;
        for (int s = n; s >= 1; --s) {
            const Real here = phi[static_cast<std::size_t>(s)];
            M += (s == n ? last : length) * across(F_x, F_z, here) + g_before / 4;
            Real before = here - M / c, now = 0;
            for (int i = 0; a != b && i < 50; ++i) {  // g depends on the angle it leads to, weakly
                now = g(F_x, F_z, (before + here) / 2);
                const Real next = here - (M + now / 4) / c;
                if (next == before) break;
                before = next;
            }
            M += now / 4;
            g_before = now;
            phi[static_cast<std::size_t>(s) - 1] = before;
        }
        return phi[0];
    }

    void place_bodies(Real F_x, Real F_z, Shape& shape) const {
        Real x = ground, z = 0;
        for (int s = 1; s <= n; ++s) {
            const Real phi = shape.phi[static_cast<std::size_t>(s)];
            const Real half = (phi + shape.phi[static_cast<std::size_t>(s) - 1]) / 2;
            const Real u = a * along(F_x, F_z, half), v = b * across(F_x, F_z, half);
            x += u * std::cos(half) - v * std::sin(half);
            z += u * std::sin(half) + v * std::cos(half);
            shape.x.push_back(x + origin * std::cos(phi));
            shape.z.push_back(z + origin * std::sin(phi));
            const Real l = s == n ? last : length;
            x += l * std::cos(phi);
            z += l * std::sin(phi);
        }
        shape.phi.erase(shape.phi.begin());
        shape.end_x = x;
        shape.end_z = z;
    }
};

}  // namespace elastocheck::support
