// A chain of bodies in a plane under a dead force at its end, solved link by link: what large scenes are held against.
//
// Bodies 1 ... n stand on elastic joints s = 1 ... n, each on the one before, the first on ground, which does not turn.
// Body s turns by φ_s, e(φ) = (cos φ, sin φ) is along it, ℓ_s is from joint s to joint s+1 or to the end. Under F a
// joint bends and gives way, in the axes half way between its bodies, φ_s-½ = ½ (φ_s-1 + φ_s), by a along them and by b
// across:
//
//   U_s = ½ c (φ_s - φ_s-1)² + ½ Δ_sᵀ C(φ_s-½)⁻¹ Δ_s     C(φ) = a e eᵀ + b e' e'ᵀ
//
// The end is where the Δ_s and ℓ_s e(φ_s) lead, so that F does the work F · Σ (Δ_s + ℓ_s e(φ_s)), the joints give way by
// Δ_s = C F, and what is left for the angles is to make stationary
//
//   Σ ½ c (φ_s - φ_s-1)² - ½ Fᵀ C(φ_s-½) F - ℓ_s F·e(φ_s)
//
// With M_s = c (φ_s - φ_s-1) and g(φ) = Fᵀ C' F = 2 (a - b)(F·e)(F·e'), from the end back:
//
//   M_s = M_s+1 + ℓ_s F·e'(φ_s) + ¼ (g(φ_s-½) + g(φ_s+½)),  M_n+1 = 0, and no g behind the end
//
// An angle φ_n of the end gives all others, and is the right one if φ_0 = 0. As stiff along as across, g is zero.
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
         b = 0;  // a joint: stiffness in bending, what it gives along and across per force

    struct Shape {
        std::vector<Real> phi, x, z;  // of the bodies' origins, 1 ... n
        Real end_x = 0, end_z = 0;
    };

    // Links of this length on bushings as stiff in all directions, or on joints that do not give (1/k_T = 0).
    static PlanarChain links(int n, Real length, Real k_R, Real compliance) {
        return {n, 0, length, length, 0, k_R, compliance, compliance};
    }
    // A beam of EI and EA cut into n segments, which bend in their middles (models/reader/definitions/beams.hpp); bodies at the nodes.
    static PlanarChain beam(int n, Real length, Real bending, Real stretching) {
        const Real h = length / n;
        return {n, h / 2, h, h / 2, h / 2, bending / h, h / stretching, h * h * h / (12 * bending)};
    }

    // Under a force that bends it to the side of φ > 0 and no further than its own direction: φ_0 rises with φ_n there.
    Shape under(Real F_x, Real F_z) const {
        Shape shape;
        shape.phi.assign(static_cast<std::size_t>(n) + 1, 0);
        Real low = 0, high = std::atan2(F_z, F_x);
        for (int i = 0; i < 70; ++i) {
            const Real middle = (low + high) / 2;
            (back(middle, F_x, F_z, shape.phi) < 0 ? low : high) = middle;
        }
        place(F_x, F_z, shape);
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

    // φ_0, from φ_n.
    Real back(Real end, Real F_x, Real F_z, std::vector<Real>& phi) const {
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

    void place(Real F_x, Real F_z, Shape& shape) const {
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
