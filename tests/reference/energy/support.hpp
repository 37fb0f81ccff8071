// Shared by the tests of the energy leg: scenes from files, random curves, worst residuals.
#pragma once

#include <algorithm>
#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "tests/support/builders.hpp"

namespace elastocheck::reference::energy {

using support::every_point, support::load_branch, support::stop;

inline Scene scene_named(const std::string& name) {
    return read_scene(fmt::format("{}/{}.yaml", ELASTOCHECK_SCENES, name));
}

inline EquilibriumPath solve(const Scene& scene, std::size_t branch,
                             std::span<const double> loads) {
    const Model model = compile(scene);
    const Branch& walked = model.branches.at(branch);
    return solve(on_branch(model, walked), walked, loads);
}

inline double largest(const Residuals& r) {
    const double all[] = {r.length, r.direction, r.force, r.moment};
    double worst = 0;
    for (const double x : all) worst = std::isfinite(x) ? std::max(worst, x) : INFINITY;
    return worst;
}

struct Random : support::Random {
    // Random curve, not monotonic, with `knots` knots over about [-1,
    // 1], continuously differentiable.
    Curve smooth_curve(int knots) {
        std::vector<double> x, f, slope;
        for (int k = 0; k < knots; ++k) {
            x.push_back(-1 + 2.0 * k / std::max(1, knots - 1) + 0.3 / knots * (*this)());
            f.push_back((*this)(-3, 3));
            slope.push_back((*this)(-3, 3));
        }
        return support::hermite(x, f, slope);
    }
    // The same with slopes that jump at the knots.
    Curve kinked_curve(int knots) {
        Curve curve = smooth_curve(knots);
        for (int k = 0; k + 1 < knots; ++k) {
            const auto i = static_cast<std::size_t>(k);
            const double h = curve.knots[i + 1] - curve.knots[i], bend = 5 * (*this)();
            curve.pieces[i + 1][1] += bend * h;  // bend · t (h - t), zero at both ends
            curve.pieces[i + 1][2] -= bend;
        }
        curve.pieces.front()[1] = (*this)(-3, 3);
        curve.pieces.back()[1] = (*this)(-3, 3);
        return curve;
    }
};

}  // namespace elastocheck::reference::energy
