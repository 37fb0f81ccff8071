#include "reference/energy/minimise/error_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elastocheck::reference::energy {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int most_corrections = 8;
constexpr double contraction = 0.25;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Largest over the bodies.
struct Size {
    double length = 0, angle = 0;  // over L, [rad]
    double largest() const { return std::max(length, angle); }
};
Size size_of(const VectorXd& xi) {
    Size size;
    for (Index b = 0; b < xi.size() / 6; ++b) {
        size.length = std::max(size.length, xi.segment<3>(6 * b).norm());
        size.angle = std::max(size.angle, xi.segment<3>(6 * b + 3).norm());
    }
    return size;
}

// Signs from fractions of multiples of the golden ratio, which are independent of the model.
VectorXd with_signs(VectorXd e, Index from) {
    for (Index k = 0; k < e.size(); ++k)
        if (std::fmod(0.6180339887498949 * static_cast<double>(from + k + 1), 1.) < 0.5)
            e[k] = -e[k];
    return e;
}

Size rounding_of(const Path& path, const State& state) {
    constexpr int probes = 3;
    const double L = path.scales.length;
    VectorXd c(state.H.rows());
    for (std::size_t b = 0; b < state.poses.size(); ++b) {
        const auto at = static_cast<Index>(6 * b);
        c.segment<3>(at).setConstant(state.poses[b].r.norm() / L + 1);
        c.segment<3>(at + 3).setOnes();
    }
    const VectorXd e =
        4 * epsilon *
        (state.H.cwiseAbs() * c + state.at.J_t.cwiseAbs() * state.at.lambda.cwiseAbs());
    const VectorXd e_Phi = 4 * epsilon * (state.at.J_t.cwiseAbs().transpose() * c);
    Size worst;
    for (Index probe = 0; probe < probes; ++probe) {
        const Index from = probe * (e.size() + e_Phi.size());
        const Size size = size_of(
            correction(path, state, with_signs(e, from), with_signs(e_Phi, from + e.size())));
        worst = {std::max(worst.length, size.length), std::max(worst.angle, size.angle)};
    }
    return worst;
}

ErrorBound bound(const Path& path, State state) {
    const Size rounded = rounding_of(path, state);
    Size way, last;
    double before = std::numeric_limits<double>::infinity(), reach = 0;
    for (const Pose& pose : state.poses) reach = std::max(reach, pose.r.norm());
    for (int k = 0;; ++k) {
        const VectorXd dxi = correction(path, state, state.at.left, state.at.Phi);
        if (k == most_corrections || !dxi.allFinite()) return {};
        last = size_of(dxi);
        way = {way.length + last.length, way.angle + last.angle};
        if (last.largest() <= rounded.largest()) break;
        if (!(last.largest() <= contraction * before)) return {};
        before = last.largest();
        state = state_at(path, state.a, moved(path, state.poses, dxi));
    }
    return {
        path.scales.length * (way.length + last.length + 3 * rounded.length) + 2 * epsilon * reach,
        way.angle + last.angle + 3 * rounded.angle + 4 * epsilon};
}

double stiffness_left(const Modes& first, const Modes& now) {
    const auto softest = first.idle_motions().cols();
    if (softest >= std::min(first.count(), now.count())) return 1;
    return (now.unstable() ? now.stiffness[0] : now.stiffness[softest]) / first.stiffness[softest];
}

}  // namespace

void add_error_bound(const Path& path, const State& state, Equilibrium& point) {
    point.bound = state.poses.empty() ? ErrorBound{0, 0} : bound(path, state);
    point.stiffness_left = stiffness_left(path.first, state.modes);
}

}  // namespace elastocheck::reference::energy
