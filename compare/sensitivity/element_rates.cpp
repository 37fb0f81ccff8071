#include "compare/sensitivity/element_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/outputs/deformation.hpp"
#include "compare/outputs/dual.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

using DualVector = std::array<Dual, 6>;

// Where the rates of a state and of the features of its bodies come together.
struct Moved {
    const Equilibrium& state;
    const StateRate& by;

    Vector3d point(const Point& p, const Vector3d& dp_local) const {
        const Vector3d s = pose(state.poses, p.body).p * p.s_local;
        return along(p.body).dr + along(p.body).dpi.cross(s) +
               pose(state.poses, p.body).p * dp_local;
    }
    // ω of the axes of a marker.
    Vector3d turn(const Marker& m, const Marker& d) const {
        return along(m.body).dpi +
               pose(state.poses, m.body).p * (2 * (d.A_local * m.A_local.conjugate()).vec());
    }

  private:
    Increment along(BodyId body) const {
        return body == ground ? Increment{} : by.increments[static_cast<std::size_t>(body)];
    }
};

Matrix3d cross_matrix(const Vector3d& v) {
    Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

// Left Jacobian of the rotation group at θ, and its inverse: exp(θ + δθ) = exp(J δθ) exp(θ).
Matrix3d left_jacobian(const Vector3d& theta) {
    const double t = theta.norm();
    const double b = t < 1e-2 ? 0.5 - t * t / 24 : (1 - std::cos(t)) / (t * t),
                 c = t < 1e-2 ? 1. / 6 - t * t / 120 : (t - std::sin(t)) / (t * t * t);
    const Matrix3d w = cross_matrix(theta);
    return Matrix3d::Identity() + b * w + c * w * w;
}

// δθ of the three angles of B with δB = φ~ B.
Vector3d angle_rates(const Matrix3d& B, const Vector3d& theta, Formulation::Angles kind,
                     const Vector3d& phi) {
    if (kind == Formulation::Angles::rotation_vector)
        return left_jacobian(theta).partialPivLu().solve(phi);
    const Matrix3d dB = cross_matrix(phi) * B;
    const auto at = [&](int row, int column) { return Dual(B(row, column), dB(row, column)); };
    if (kind == Formulation::Angles::projected)
        return {atan2(-at(1, 2), at(2, 2)).dx, atan2(at(0, 2), at(2, 2)).dx,
                atan2(at(1, 0), at(0, 0)).dx};
    return {atan2(-at(1, 2), at(2, 2)).dx,
            atan2(at(0, 2), sqrt(at(0, 0) * at(0, 0) + at(0, 1) * at(0, 1))).dx,
            atan2(-at(0, 1), at(0, 0)).dx};
}

DualVector deformation_of(const Bushing& bushing, const Bushing& d, const Moved& moved) {
    const Equilibrium& state = moved.state;
    const Quaterniond A_i = pose(state.poses, bushing.i.body).p * bushing.i.A_local,
                      A_j = pose(state.poses, bushing.j.body).p * bushing.j.A_local;
    const Point i{bushing.i.body, bushing.i.s_local}, j{bushing.j.body, bushing.j.s_local};
    const Vector3d D = position(state.poses, j) - position(state.poses, i),
                   dD = moved.point(j, d.j.s_local) - moved.point(i, d.i.s_local),
                   turn_i = moved.turn(bushing.i, d.i),
                   phi = A_i.conjugate() * (moved.turn(bushing.j, d.j) - turn_i);
    const Quaterniond B = A_i.conjugate() * A_j;
    const Eigen::AngleAxisd whole(B);
    const Vector3d theta = whole.angle() * whole.axis();
    Vector3d dd = A_i.conjugate() * (dD - turn_i.cross(D));
    if (bushing.formulation.frame == Formulation::Frame::middle) {
        // A_f = A_i S, S = exp(½ θ~), turns from i by η, δS = η~ S
        const Quaterniond S(Eigen::AngleAxisd(whole.angle() / 2, whole.axis()));
        const Vector3d dtheta =
            angle_rates(B.toRotationMatrix(), theta, Formulation::Angles::rotation_vector, phi);
        const Vector3d eta = left_jacobian(theta / 2) * dtheta / 2;
        dd = S.conjugate() * (dd - eta.cross(A_i.conjugate() * D));
    }
    const Vector3d dangles =
        angle_rates(B.toRotationMatrix(), theta, bushing.formulation.angles, phi);
    const Vector6 e = deformation(bushing, state);
    DualVector all;
    for (int k = 0; k < 3; ++k) {
        all[static_cast<std::size_t>(k)] = {e[k], dd[k] - d.undeformed[k]};
        all[static_cast<std::size_t>(k + 3)] = {e[k + 3], dangles[k] - d.undeformed[k + 3]};
    }
    return all;
}

// ---- Laws whose numbers change.

Dual force_of(const LinearRate& u, const LinearRate& d, const Dual& x) {
    return Dual(u.k, d.k) * x;
}
Dual force_of(const elastocheck::Curve& u, const elastocheck::Curve& d, const Dual& x) {
    const auto piece =
        static_cast<std::size_t>(std::ranges::upper_bound(u.knots, x.x) - u.knots.begin());
    const std::size_t knot = piece > 0 ? piece - 1 : 0;
    const Dual h = x - Dual(u.knots[knot], d.knots[knot]);
    Dual f = 0;
    for (std::size_t n = 4; n-- > 0;) f = f * h + Dual(u.pieces[piece][n], d.pieces[piece][n]);
    return f;
}
Dual force_of(const ScalarLaw& law, const ScalarLaw& d, const Dual& x) {
    return std::visit([&]<class Law>(const Law& u) { return force_of(u, std::get<Law>(d), x); },
                      law);
}
DualVector force_of(const SpatialLaw& law, const SpatialLaw& d, const DualVector& e) {
    DualVector f;
    std::visit(overloaded{[&](const LinearStiffness& u) {
                              const Matrix6& dK = std::get<LinearStiffness>(d).K;
                              for (int row = 0; row < 6; ++row)
                                  for (int k = 0; k < 6; ++k)
                                      f[static_cast<std::size_t>(row)] +=
                                          Dual(u.K(row, k), dK(row, k)) *
                                          e[static_cast<std::size_t>(k)];
                          },
                          [&](const PerAxis& u) {
                              for (std::size_t k = 0; k < 6; ++k)
                                  f[k] = force_of(u.axis[k], std::get<PerAxis>(d).axis[k], e[k]);
                          }},
               law);
    return f;
}

struct StateOfElement {
    DualVector e, s;  // of a spring the first
};

// What the drivers add to an element at the state's parameter: to ℓ₀, or to the preload.
DualVector driven_part(const Branch& branch, const Branch& branch_rate, int element, double a) {
    DualVector all;
    for (std::size_t k = 0; k < branch.drivers.size(); ++k) {
        const Driver &driver = branch.drivers[k], &d = branch_rate.drivers[k];
        if (driven_element(driver.what) != element) continue;
        const Dual by(driver.start + driver.rate * a, d.start + d.rate * a);
        const Vector6 *direction = preload(driver.what), *turned = preload(d.what);
        if (direction == nullptr) {
            all[0] += by;
            continue;
        }
        for (int n = 0; n < 6; ++n)
            all[static_cast<std::size_t>(n)] += by * Dual((*direction)[n], (*turned)[n]);
    }
    return all;
}

StateOfElement state_of(const Model& model, const Branch& branch, const Equilibrium& state,
                        std::size_t at, const Model& rate, const StateRate& state_rate) {
    const Moved moved{state, state_rate};
    const DualVector driven =
        driven_part(branch, rate.branches.front(), static_cast<int>(at), state.load);
    StateOfElement now;
    const auto of_spring = [&](const AxialSpring& spring) {
        const auto& d = std::get<AxialSpring>(rate.elastics[at].kind);
        const Vector3d D = position(state.poses, spring.j) - position(state.poses, spring.i),
                       dD = moved.point(spring.j, d.j.s_local) - moved.point(spring.i, d.i.s_local);
        const Dual length(D.norm(), D.dot(dD) / D.norm());
        now.e[0] = length - Dual(spring.free_length, d.free_length) - driven[0];
        now.s[0] = force_of(spring.law, d.law, now.e[0]);
    };
    const auto of_bushing = [&](const Bushing& bushing) {
        const auto& d = std::get<Bushing>(rate.elastics[at].kind);
        now.e = deformation_of(bushing, d, moved);
        now.s = force_of(bushing.law, d.law, now.e);
        for (std::size_t k = 0; k < 6; ++k) {
            const auto n = static_cast<Eigen::Index>(k);
            now.s[k] += Dual(bushing.preload[n], d.preload[n]) + driven[k];
        }
    };
    std::visit(overloaded{of_spring, of_bushing}, model.elastics[at].kind);
    return now;
}

}  // namespace

double element_rate(const Model& model, const Branch& branch, const Equilibrium& state,
                    const OfElement& which, const Model& rate, const StateRate& state_rate) {
    const auto at = static_cast<std::size_t>(which.element);
    const Elastic& elastic = model.elastics[at];
    const ElasticKind& kind = elastic.kind;
    const bool active = !elastic.active_only_where_driven ||
                        std::ranges::any_of(branch.drivers, [&](const Driver& driver) {
                            return driven_element(driver.what) == which.element;
                        });
    if (!active || state_rate.outcome != Outcome::converged) return nan;
    const StateOfElement now = state_of(model, branch, state, at, rate, state_rate);
    const bool is_force = which.component >= 6;
    if (elastic.written_as == WrittenAs::tyre) {
        const auto* law = member<SpatialLaw>(kind);
        const Matrix6* K = law != nullptr ? matrix_of(*law) : nullptr;
        if (is_force) return -now.s[2].dx;
        if (K == nullptr || !((*K)(2, 2) > 0)) return nan;
        const Matrix6& dK = *matrix_of(*member<SpatialLaw>(rate.elastics[at].kind));
        return -(now.s[2] / Dual((*K)(2, 2), dK(2, 2))).dx;
    }
    // positive in compression
    const bool reversed = elastic.markers_swapped || member<ScalarLaw>(kind) != nullptr;
    const auto component = static_cast<std::size_t>(which.component % 6);
    return (reversed ? -1 : 1) * (is_force ? now.s : now.e)[component].dx;
}

double deformation_rate(const Model& model, const Branch& branch, const Equilibrium& state,
                        std::size_t element, std::size_t axis, const Model& rate,
                        const StateRate& state_rate) {
    if (state_rate.outcome != Outcome::converged) return nan;
    return state_of(model, branch, state, element, rate, state_rate).e[axis].dx;
}

}  // namespace elastocheck::compare
