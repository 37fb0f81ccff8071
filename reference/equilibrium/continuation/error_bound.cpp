#include "reference/equilibrium/continuation/error_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Real = long double;
using VectorXr = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

constexpr int refinements = 12;
constexpr double contraction = 0.25;
// relative remainder of E, scaled, that counts as solved; a larger one belongs to the border
constexpr double answered = 1e-9;

// The unknowns in extended precision.
struct ExtendedValues {
    const System& system;
    const VectorXr& x;
    Frame<Real> frame(const Part& part, int which) const {
        const BodyId body = which == 0 ? part.i : part.j;
        if (body == ground)
            return {-system.centre.cast<Real>(), Eigen::Quaternion<Real>::Identity()};
        return {system.length * x.segment<3>(7 * body),
                Eigen::Quaternion<Real>(x.segment<4>(7 * body + 3))};
    }
    Real reaction(const Part& part, int k) const { return x[7 * system.bodies + part.row + k]; }
};
struct ExtendedSum {
    const System& system;
    VectorXr E;
    void balance(const Part&, BodyId body, const Vec3<Real>& force, const Vec3<Real>& moment) {
        E.segment<3>(6 * body) += force;
        E.segment<3>(6 * body + 3) += moment;
    }
    void constraint(const Part& part, int k, Real Phi) {
        E[6 * system.bodies + part.row + k] += Phi;
    }
};
VectorXr extended_residual(const System& system, double a, const VectorXr& x) {
    ExtendedSum sum{system, VectorXr::Zero(system.equations())};
    assemble<Real>(system, Real(a), Real(0), {}, ExtendedValues{system, x}, sum);
    return std::move(sum.E);
}

VectorXr moved(const System& system, const VectorXr& x, const VectorXd& dx) {
    VectorXr to = x;
    for (int body = 0; body < system.bodies; ++body) {
        to.segment<3>(7 * body) += dx.segment<3>(6 * body).cast<Real>();
        const Vec3<Real> half = dx.segment<3>(6 * body + 3).cast<Real>() / 2;
        const Real angle = half.norm(), by_angle = angle > 0 ? std::sin(angle) / angle : Real(1);
        const Eigen::Quaternion<Real> turn(std::cos(angle), by_angle * half[0], by_angle * half[1],
                                           by_angle * half[2]);
        const Eigen::Quaternion<Real> p(x.segment<4>(7 * body + 3));
        to.segment<4>(7 * body + 3) = product(turn, p).normalized().coeffs();
    }
    to.tail(system.constraint_rows) += dx.tail(system.constraint_rows).cast<Real>();
    return to;
}

// Largest part of a step over the bodies.
struct Size {
    double length = 0, angle = 0;  // over L, [rad]
    double largest() const { return std::max(length, angle); }
};
Size size_of(const System& system, const VectorXd& dx) {
    Size size;
    for (int body = 0; body < system.bodies; ++body) {
        size.length = std::max(size.length, dx.segment<3>(6 * body).norm());
        size.angle = std::max(size.angle, dx.segment<3>(6 * body + 3).norm());
    }
    return size;
}

// R_0. The signs come from fractions of multiples of the golden ratio, which are independent of the
// system.
Size rounding(const System& system, const Linearisation& at, const VectorXr& x) {
    constexpr int probes = 3;
    VectorXd c(system.equations()), e = VectorXd::Zero(system.equations());
    for (int body = 0; body < system.bodies; ++body) {
        c.segment<3>(6 * body).setConstant(static_cast<double>(x.segment<3>(7 * body).norm()) + 1);
        c.segment<3>(6 * body + 3).setOnes();
    }
    c.tail(system.constraint_rows) = x.tail(system.constraint_rows).cwiseAbs().cast<double>();
    for (Index j = 0; j < at.J.cols(); ++j)
        for (Sparse::InnerIterator entry(at.J, j); entry; ++entry)
            e[entry.row()] += std::abs(entry.value()) * c[j];
    e *= 4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    Size worst;
    for (int probe = 0; probe < probes; ++probe) {
        VectorXd signed_e = e;
        for (Index k = 0; k < e.size(); ++k)
            if (std::fmod(0.6180339887498949 * static_cast<double>(k + probe * e.size() + 1), 1.) <
                0.5)
                signed_e[k] = -e[k];
        const Size size = size_of(system, answer(at.bordered, signed_e).dx);
        worst = {std::max(worst.length, size.length), std::max(worst.angle, size.angle)};
    }
    return worst;
}

ErrorBound bound(const Continuation& continuation, double a) {
    const System& system = continuation.system;
    const Linearisation& at = continuation.here.linearised;
    VectorXr x = continuation.here.x.cast<Real>();
    for (int body = 0; body < system.bodies; ++body) x.segment<4>(7 * body + 3).normalize();
    const Size rounded = rounding(system, at, x);
    Size way, last;
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0;; ++k) {
        const VectorXd dx = answer(at.bordered, extended_residual(system, a, x).cast<double>()).dx;
        if (k == refinements || !dx.allFinite()) return {};
        last = size_of(system, dx);
        x = moved(system, x, dx);
        way = {way.length + last.length, way.angle + last.angle};
        if (last.largest() <= rounded.largest()) break;
        if (!(last.largest() <= contraction * before)) return {};
        before = last.largest();
    }
    const VectorXr left = extended_residual(system, a, x);
    const auto open = static_cast<double>(left.tail(system.constraint_rows).norm());
    if (!(static_cast<double>(left.norm()) <= answered)) return {};
    // Poses are stored with the digits of a double.
    constexpr double digits = std::numeric_limits<double>::epsilon();
    double reach = 0;
    for (int body = 0; body < system.bodies; ++body)
        reach = std::max(reach, continuation.here.x.segment<3>(7 * body).norm());
    return {system.length * (way.length + last.length + 3 * rounded.length + open) +
                2 * digits * (system.length * reach + system.centre.norm()),
            way.angle + last.angle + 3 * rounded.angle + open + 4 * digits};
}

}  // namespace

void add_error_bound(const Continuation& continuation, Equilibrium& point) {
    point.bound =
        continuation.system.equations() == 0 ? ErrorBound{0, 0} : bound(continuation, point.load);
    point.stiffness_left = continuation.here.stiffness.least / continuation.first_stiffness;
}

}  // namespace elastocheck::reference::equilibrium
