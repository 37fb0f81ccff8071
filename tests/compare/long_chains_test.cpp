// Chains of hundreds of bodies against discrete and continuous closed forms (rod, rope). The energy
// leg, which is dense, is tested with short chains in closed_forms_test.cpp and families_test.cpp.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/cantilever.hpp"
#include "tests/support/planar_chain.hpp"

namespace elastocheck::compare {
namespace {

using namespace support;  // the leaf: E, G, L, width, thick, EI
using std::numbers::pi;
using Real = long double;

constexpr double EA = E * width * thick;
constexpr std::array segments{125, 250, 500};
constexpr std::array links{20, 1000};

Model read(const std::string& text, const std::string& name) {
    return compile(parse_scene(
        "elastocheck: 1\nname: " + name + "\nunits: {length: m, angle: rad, force: N}\n" + text,
        name));
}

EquilibriumPath walked(const Model& model, const Branch& branch, Leg leg) {
    return solve_branch(sides_of(model, branch),
                        {.leg = leg, .recursion = {.method = {"series", 0, recursive::Series{}}}});
}

// ---- The elastica.

// Extensible rod, EI φ'' + F·e'(φ) (1 + F·e(φ)/EA) = 0, x' = (1 + F·e/EA) e, φ(0) = 0, φ'(L) = 0,
// under F across its root: shooting by a Runge-Kutta method from the end back, with bisection for
// the slope there.
struct RodEnd {
    Real x = 0, y = 0;
};
RodEnd rod(Real F, Real flexibility) {  // 1/EA
    using State = std::array<Real, 4>;  // φ, φ', x, y
    constexpr int steps = 2000;
    const Real ds = -Real(L) / steps;
    const auto slope = [&](const State& s) {
        const Real along = F * std::sin(s[0]), across = F * std::cos(s[0]),
                   stretch = 1 + along * flexibility;
        return State{s[1], -across * stretch / Real(EI), stretch * std::cos(s[0]),
                     stretch * std::sin(s[0])};
    };
    const auto back = [&](Real end) {
        State s{end, 0, 0, 0};
        for (int i = 0; i < steps; ++i) {
            const auto ahead = [&](const State& k, Real by) {
                State t = s;
                for (std::size_t c = 0; c < 4; ++c) t[c] += by * k[c];
                return t;
            };
            const State a = slope(s), b = slope(ahead(a, ds / 2)), c = slope(ahead(b, ds / 2)),
                        d = slope(ahead(c, ds));
            for (std::size_t j = 0; j < 4; ++j)
                s[j] += ds / 6 * (a[j] + 2 * b[j] + 2 * c[j] + d[j]);
        }
        return s;
    };
    Real low = 0, high = pi / 2;
    for (int i = 0; i < 64; ++i) {
        const Real middle = (low + high) / 2;
        (back(middle)[0] < 0 ? low : high) = middle;
    }
    const State root = back(low);
    return {-root[2], -root[3]};
}

TEST(LongCantilever, EqualsItsDiscreteFormAndConvergesToTheElasticaAtOrderTwo) {
    for (const double alpha : {2., 10.})
        EXPECT_NEAR(static_cast<double>(rod(alpha * EI / (L * L), 0).y), elastica(alpha).y, 1e-12)
            << alpha;
    std::vector<double> errors;
    for (const int n : segments) {
        const Model model =
            read(leaf(n) + fmt::format(R"(loads: {{push: {{on: tip, at: tip, force: [0, 1, 0]}}}}
branches: {{push: {{load: push, to: {}, steps: 5}}}}
)",
                                       10 * EI / (L * L)),
                 fmt::format("leaf of {} segments", n));
        const PlanarChain chain = PlanarChain::beam(n, L, EI, EA);
        const auto tip = static_cast<std::size_t>(model.probes[0].at.body);
        double error = 0;
        for (const Leg leg : {Leg::equilibrium, Leg::series}) {
            const auto path = walked(model, model.branches[0], leg);
            ASSERT_EQ(path.outcome, Outcome::converged)
                << n << " " << name(leg) << ": " << path.detail;
            ASSERT_EQ(path.points.size(), 6u);
            for (std::size_t k = 1; k < path.points.size(); ++k) {
                const auto& point = path.points[k];
                const auto known = chain.under(0, point.load);
                double off = 0;
                for (std::size_t i = 0; i < point.poses.size(); ++i) {
                    // The inner nodes, and the tip, in any order.
                    const auto& r = point.poses[i].r;
                    const auto node = static_cast<std::size_t>(
                                          std::lround(model.bodies[i].design.r.x() * n / L)) -
                                      1;
                    const double apart =
                        std::hypot(static_cast<double>(r.x() - known.x.at(node)),
                                   static_cast<double>(r.y() - known.z.at(node)), r.z());
                    if (!(apart <= off) && !std::isnan(off)) off = apart;  // NaN propagates
                }
                EXPECT_LE(1e3 * off, 1e-8) << n << " " << name(leg) << " at " << point.load << " N";
                if (leg != Leg::equilibrium) continue;  // the other leg has the same states
                const RodEnd exact = rod(point.load, 1 / Real(EA));
                const auto& r = point.poses[tip].r;
                error = std::max(error, std::hypot(static_cast<double>(r.x() - exact.x),
                                                   static_cast<double>(r.y() - exact.y)));
            }
        }
        errors.push_back(error);
    }
    for (std::size_t k = 1; k < errors.size(); ++k)
        EXPECT_NEAR(order(errors[k - 1], errors[k]), 2, 0.02)
            << errors[k - 1] << " to " << errors[k];
    EXPECT_LE(1e3 * errors.back(), 500. / segments.back() / segments.back())
        << "mm, of a tip that comes 810 mm across";
}

// ---- Euler's column.

// A rod that shortens under P buckles where P (1 - P/EA) = π² EI/(4L²): length and lever decrease.
TEST(LongColumn, BucklingLoadEqualsItsDiscreteFormAndConvergesToEulersAtOrderTwo) {
    const double euler = pi * pi * EI / (4 * L * L),
                 limit = 2 * euler / (1 + std::sqrt(1 - 4 * euler / EA));
    std::vector<double> errors;
    for (const int n : segments) {
        const Model model = read(leaf(n) +
                                     R"(loads: {press: {on: tip, at: tip, force: [-1, 0, 0]}}
branches: {press: {load: press, to: 1, steps: 1}}
)",
                                 fmt::format("column of {}", n));
        const double P = critical_load(n);
        for (const Leg leg : {Leg::equilibrium, Leg::series})
            for (const double share : {1 - 1e-6, 1 + 1e-6, 1.5}) {
                Branch branch = model.branches[0];
                branch.to = share * P;
                const auto path = walked(model, branch, leg);
                // Within its smallest step the equilibrium leg does not distinguish a bifurcation
                // from a limit point.
                const bool ends = path.outcome == Outcome::bifurcation_point ||
                                  (leg == Leg::equilibrium && path.outcome == Outcome::singular);
                EXPECT_TRUE(share < 1 ? path.outcome == Outcome::converged : ends)
                    << elastocheck::name(path.outcome) << " " << n << " " << name(leg) << " at "
                    << share << ": " << path.detail;
            }
        errors.push_back(1 - P / limit);
    }
    for (std::size_t k = 1; k < errors.size(); ++k)
        EXPECT_NEAR(order(errors[k - 1], errors[k]), 2, 0.01)
            << errors[k - 1] << " to " << errors[k];
}

// ---- The hanging chain.
//
// n links of length h and weight w each, from (0, 0) to an end held at the same height, hinged to
// each other by torsion springs k that are relaxed in the design position. With φ_i the angles of
// the links, e(φ) as above, H and V the reactions at the end,
//
//   Σ ½ k (φ_i - φ_i-1 - κ_i)² + Σ w z_i - H (x_end - span) - V z_end,   x_end, z_end = Σ h e(φ_i)
//
// is stationary. The weight W_i = w (n - i + ½) hangs on link i, half of it its own:
//
//   k (..)_i - k (..)_i+1 + h (W_i - V) cos φ_i + h H sin φ_i = 0
//   Σ h cos φ_i = span     Σ h sin φ_i = 0
//
// Without springs tan φ_i = (V - W_i)/H: the discrete catenary, which is the design position.
// Newton's method, with a matrix that is tridiagonal except for two columns and rows.
struct Rope {
    int n = 1000;
    Real h = 1.2L / 1000, w = 0.01L, k = 0;
    std::vector<Real> kappa;  // of joint i between i-1 and i; the first and the last link are free

    struct Hung {
        std::vector<Real> phi;
        Real H = 0, V = 0;
        std::vector<Real> x, z;  // start points of the links; the last entry is the end
    };

    Real hanging(int i) const { return w * (n - i - Real(0.5)); }  // W of link i, counted from 0

    // H from the span by bisection: it decreases with the distance of the ends.
    Hung catenary(Real span) const {
        Hung at;
        at.V = w * n / 2;
        const auto reach = [&](Real H) {
            Real x = 0;
            for (int i = 0; i < n; ++i) x += h * H / std::hypot(H, at.V - hanging(i));
            return x;
        };
        Real low = 0, high = 100 * w * n;
        for (int i = 0; i < 80; ++i)
            (reach((low + high) / 2) < span ? low : high) = (low + high) / 2;
        at.H = low;
        for (int i = 0; i < n; ++i) at.phi.push_back(std::atan2(at.V - hanging(i), at.H));
        return place(at);
    }

    // From a nearby shape, under a downward force P at the end of link `middle`.
    Hung hung(Hung at, Real span, Real P, int middle) const {
        const auto size = static_cast<std::size_t>(n);
        for (int turn = 0; turn < 40; ++turn) {
            std::vector<Real> diagonal(size), f(size), by_H(size), by_V(size);
            Real x = 0, z = 0;
            for (int i = 0; i < n; ++i) {
                const auto s = static_cast<std::size_t>(i);
                const Real sin = std::sin(at.phi[s]), cos = std::cos(at.phi[s]);
                const Real W = hanging(i) + (i <= middle ? P : 0);
                f[s] = h * ((W - at.V) * cos + at.H * sin);
                diagonal[s] = h * ((at.V - W) * sin + at.H * cos);
                if (i > 0) {
                    f[s] += k * (at.phi[s] - at.phi[s - 1] - kappa[s]);
                    diagonal[s] += k;
                }
                if (i + 1 < n) {
                    f[s] -= k * (at.phi[s + 1] - at.phi[s] - kappa[s + 1]);
                    diagonal[s] += k;
                }
                by_H[s] = h * sin;
                by_V[s] = -h * cos;
                x += h * cos;
                z += h * sin;
            }
            solve(diagonal, {&f, &by_H, &by_V});
            // φ = -f - by_H dH - by_V dV, into  Σ -by_H^0 φ = span - x,  Σ -by_V^0 φ = -z
            Real a[2][3]{{0, 0, span - x}, {0, 0, -z}};
            for (std::size_t s = 0; s < size; ++s) {
                const Real row[2]{-h * std::sin(at.phi[s]), h * std::cos(at.phi[s])};
                for (int r = 0; r < 2; ++r) {
                    a[r][0] -= row[r] * by_H[s];
                    a[r][1] -= row[r] * by_V[s];
                    a[r][2] += row[r] * f[s];
                }
            }
            const Real det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
            const Real dH = (a[0][2] * a[1][1] - a[0][1] * a[1][2]) / det,
                       dV = (a[0][0] * a[1][2] - a[0][2] * a[1][0]) / det;
            Real most = 0;
            for (std::size_t s = 0; s < size; ++s) {
                const Real d = -f[s] - by_H[s] * dH - by_V[s] * dV;
                at.phi[s] += d;
                most = std::max(most, std::abs(d));
            }
            at.H += dH;
            at.V += dV;
            if (most < 1e-17L) break;
        }
        return place(at);
    }

  private:
    // The matrix with this diagonal and -k beside it, solved in place.
    void solve(std::vector<Real> diagonal, std::initializer_list<std::vector<Real>*> all) const {
        const std::size_t size = diagonal.size();
        for (std::size_t s = 1; s < size; ++s) {
            const Real factor = -k / diagonal[s - 1];
            diagonal[s] -= factor * -k;
            for (auto* b : all) (*b)[s] -= factor * (*b)[s - 1];
        }
        for (auto* b : all)
            for (std::size_t s = size; s-- > 0;)
                (*b)[s] = ((*b)[s] + (s + 1 < size ? k * (*b)[s + 1] : 0)) / diagonal[s];
    }
    Hung place(Hung at) const {
        at.x.assign(1, 0);
        at.z.assign(1, 0);
        for (const Real phi : at.phi) {
            at.x.push_back(at.x.back() + h * std::cos(phi));
            at.z.push_back(at.z.back() + h * std::sin(phi));
        }
        return at;
    }
};

struct HangingChain {
    Rope rope;
    Rope::Hung drawn;
    static constexpr double span = 1;

    HangingChain(int n, double k) {
        rope = {n, Real(1.2L) / n, Real(10) / n, k, {}};
        drawn = rope.catenary(span);
        rope.kappa.push_back(0);
        for (std::size_t i = 1; i < drawn.phi.size(); ++i)
            rope.kappa.push_back(drawn.phi[i] - drawn.phi[i - 1]);
    }
    std::string text() const {
        std::string points = "points:\n", bodies = "bodies:\n", joints = "joints:\n",
                    springs = "torsion_springs:\n";
        const int n = rope.n;
        for (int i = 0; i <= n; ++i)
            points += fmt::format("  p{}: [{}, 0, {}]\n", i,
                                  static_cast<double>(drawn.x[static_cast<std::size_t>(i)]),
                                  static_cast<double>(drawn.z[static_cast<std::size_t>(i)]));
        for (int i = 1; i <= n; ++i) {
            const auto s = static_cast<std::size_t>(i);
            points += fmt::format("  c{}: [{}, 0, {}]\n", i,
                                  static_cast<double>((drawn.x[s - 1] + drawn.x[s]) / 2),
                                  static_cast<double>((drawn.z[s - 1] + drawn.z[s]) / 2));
            bodies += fmt::format("  b{0}: {{origin: p{1}, mass: {2}, centre_of_gravity: c{0}}}\n",
                                  i, i - 1, static_cast<double>(rope.w / 10));
            const std::string on = i == 1 ? "ground" : fmt::format("b{}", i - 1);
            joints +=
                fmt::format("  h{0}: {{type: revolute, bodies: [b{0}, {1}], at: p{2}, axis: y}}\n",
                            i, on, i - 1);
            if (i > 1 && rope.k > 0)
                springs +=
                    fmt::format("  s{0}: {{bodies: [b{0}, {1}], at: p{2}, axis: y, rate: {3}}}\n",
                                i, on, i - 1, static_cast<double>(rope.k));
        }
        joints += fmt::format(
            R"(  height: {{type: in_plane, bodies: [b{0}, ground], at: p{0}, normal: z}}
  span: {{type: in_plane, bodies: [b{0}, ground], at: p{0}, normal: x}}
)",
            n);
        return points + bodies + joints + (rope.k > 0 ? springs : "") +
               fmt::format(
                   R"(gravity: [0, 0, -10]
loads: {{pull: {{on: b{0}, at: p{0}, force: [0, 0, -1]}}}}
probes: {{middle: {{on: b{0}, at: p{0}}}}}
branches:
  pull: {{load: pull, to: 5, steps: 5}}
  closer: {{drive: joints.span, to: -0.2, steps: 5}}
)",
                   n / 2);
    }
};

TEST(HangingChain, EqualsTheDiscreteCatenaryUnderLoadAndDrivenEnd) {
    for (const int n : links) {
        const HangingChain chain(n, 1);
        const Model model = read(chain.text(), fmt::format("chain of {}", n));
        for (const auto& branch : model.branches)
            for (const Leg leg : {Leg::equilibrium, Leg::series}) {
                const auto path = walked(model, branch, leg);
                EXPECT_EQ(path.outcome, Outcome::converged)
                    << n << " " << branch.name << " " << name(leg) << ": " << path.detail;
                EXPECT_EQ(path.points.size(), 6u);
                auto known = chain.drawn;
                for (const auto& point : path.points) {
                    const bool pulled = branch.name == "pull";
                    known = chain.rope.hung(known, chain.span + (pulled ? 0 : point.load),
                                            pulled ? point.load : 0, n / 2 - 1);
                    double off = 0;
                    for (std::size_t i = 0; i < point.poses.size(); ++i) {
                        const auto& r = point.poses[i].r;
                        const double apart =
                            std::hypot(static_cast<double>(r.x() - known.x[i]), r.y(),
                                       static_cast<double>(r.z() - known.z[i]));
                        if (!(apart <= off) && !std::isnan(off)) off = apart;  // NaN propagates
                    }
                    EXPECT_LE(1e3 * off, 1e-8)
                        << n << " " << branch.name << " " << name(leg) << " at " << point.load;
                }
            }
    }
}

}  // namespace
}  // namespace elastocheck::compare
