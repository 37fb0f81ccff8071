#include "compare/outputs/deformation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "compare/outputs/positions.hpp"
#include "elastocheck/channels.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d rotation_vector(const Eigen::Quaterniond& B) {
    const Eigen::AngleAxisd turn(B);  // the shorter rotation
    return turn.angle() * turn.axis();
}

// The three angles θ of B. With B = R_x R_y R_z its last column is
// (sin θ_y, -sin θ_x cos θ_y, cos θ_x cos θ_y), its first row
// (cos θ_y cos θ_z, -cos θ_y sin θ_z, sin θ_y).
Vector3d angles(const Eigen::Quaterniond& B, Formulation::Angles kind) {
    const Matrix3d R = B.toRotationMatrix();
    switch (kind) {
        case Formulation::Angles::rotation_vector: return rotation_vector(B);
        case Formulation::Angles::cardan:
            return {std::atan2(-R(1, 2), R(2, 2)),
                    std::atan2(R(0, 2), std::hypot(R(0, 0), R(0, 1))),
                    std::atan2(-R(0, 1), R(0, 0))};
        case Formulation::Angles::projected:
            return {std::atan2(-R(1, 2), R(2, 2)), std::atan2(R(0, 2), R(2, 2)),
                    std::atan2(R(1, 0), R(0, 0))};
    }
    return Vector3d::Constant(std::nan(""));
}

// Piece of the curve that contains x, and x relative to its knot.
std::pair<const std::array<double, 4>*, double> piece_at(const elastocheck::Curve& curve,
                                                         double x) {
    const auto piece =
        static_cast<std::size_t>(std::ranges::upper_bound(curve.knots, x) - curve.knots.begin());
    return {&curve.pieces[piece], x - curve.knots[piece > 0 ? piece - 1 : 0]};
}

double slope(const std::array<double, 4>& c, double h) {
    return c[1] + h * (2 * c[2] + h * 3 * c[3]);
}

// Deformation at the end of the table that x exceeds; NaN if x is inside or the curve is extrapolated.
double end_passed(const elastocheck::Curve& curve, double x) {
    if (curve.known_outside) return std::nan("");
    if (x < curve.knots.front()) return curve.knots.front();
    if (x > curve.knots.back()) return curve.knots.back();
    return std::nan("");
}

constexpr double knot_tolerance = 1e-9;  // [m, rad], larger than the error of a state
constexpr double min_slope_jump = 1e-6;  // share of the steeper slope, larger than rounding

// Index of the knot within knot_tolerance of x if the slope jumps there.
std::optional<std::size_t> corner_at(const elastocheck::Curve& curve, double x) {
    const auto& knots = curve.knots;
    const auto near = static_cast<std::size_t>(std::ranges::lower_bound(knots, x - knot_tolerance) -
                                               knots.begin());
    if (near == knots.size() || knots[near] > x + knot_tolerance) return std::nullopt;
    const double h = near == 0 ? 0 : knots[near] - knots[near - 1];
    const double slope_before = slope(curve.pieces[near], h),
                 slope_after = slope(curve.pieces[near + 1], 0);
    if (!(std::abs(slope_after - slope_before) >
          min_slope_jump * std::max(std::abs(slope_before), std::abs(slope_after))))
        return std::nullopt;
    return near;
}

std::string beyond_end(const std::string& what, double x, double end, Unit unit) {
    return fmt::format("{} is deformed by {:.6g} {}, and its curve ends at {:.6g} {}", what,
                       in_unit(unit) * x, symbol(unit), in_unit(unit) * end, symbol(unit));
}

}  // namespace

Vector6 deformation(const Bushing& bushing, const Equilibrium& state) {
    const Eigen::Quaterniond A_i = pose(state.poses, bushing.i.body).p * bushing.i.A_local,
                             A_j = pose(state.poses, bushing.j.body).p * bushing.j.A_local;
    const Eigen::Quaterniond B = A_i.conjugate() * A_j;
    Vector3d d = A_i.conjugate() * (position(state.poses, bushing.j.body, bushing.j.s_local) -
                                    position(state.poses, bushing.i.body, bushing.i.s_local));
    if (bushing.formulation.frame == Formulation::Frame::middle) {
        const Vector3d theta = rotation_vector(B);  // A_f = A_i B^½
        d = Eigen::AngleAxisd(-theta.norm() / 2, theta.stableNormalized()) * d;
    }
    Vector6 e;
    e << d, angles(B, bushing.formulation.angles);
    return e - bushing.undeformed;
}

Vector6 deformation(const ElasticKind& kind, std::size_t element, const Branch& branch,
                    const Equilibrium& state) {
    const auto of_spring = [&](const AxialSpring& spring) {
        double free_length = spring.free_length;
        for (const auto& driver : branch.drivers)
            if (driven_element(driver.what) == static_cast<int>(element))
                free_length += driver.start + driver.rate * state.load;
        Vector6 e = Vector6::Zero();
        e[0] = (position(state.poses, spring.j) - position(state.poses, spring.i)).norm() -
               free_length;
        return e;
    };
    // A driver other than a preload moves the undeformed position of the bushing along z: the rise of the
    // road under a tyre.
    const auto of_bushing = [&](const Bushing& bushing) {
        Vector6 e = deformation(bushing, state);
        for (const auto& driver : branch.drivers)
            if (driven_element(driver.what) == static_cast<int>(element) &&
                preload(driver.what) == nullptr)
                e.z() -= driver.start + driver.rate * state.load;
        return e;
    };
    return std::visit(overloaded{of_spring, of_bushing}, kind);
}

double force(const ScalarLaw& law, double x) {
    return std::visit(overloaded{[&](const LinearRate& u) { return u.k * x; },
                                 [&](const elastocheck::Curve& u) {
                                     const auto [c, h] = piece_at(u, x);
                                     return (*c)[0] + h * ((*c)[1] + h * ((*c)[2] + h * (*c)[3]));
                                 }},
                      law);
}

Vector6 force(const ElasticKind& kind, const Vector6& e) {
    Vector6 f = Vector6::Zero();
    const auto per_axis = [&](const PerAxis& u) {
        for (std::size_t k = 0; k < 6; ++k)
            f[static_cast<Eigen::Index>(k)] = force(u.axis[k], e[static_cast<Eigen::Index>(k)]);
    };
    each_member(kind, overloaded{[&](const ScalarLaw& law) { f[0] = force(law, e[0]); },
                                 [&](const SpatialLaw& law) {
                                     std::visit(
                                         overloaded{[&](const LinearStiffness& u) { f = u.K * e; },
                                                    per_axis},
                                         law);
                                 }});
    return f;
}

Vector6 force_with_preload(const ElasticKind& kind, std::size_t element, const Branch& branch,
                           const Equilibrium& state, const Vector6& e) {
    Vector6 s = force(kind, e);
    if (const Vector6* constant_preload = preload(kind)) s += *constant_preload;
    for (const auto& driver : branch.drivers)
        if (const Vector6* direction = preload(driver.what);
            direction != nullptr && driven_element(driver.what) == static_cast<int>(element))
            s += (driver.start + driver.rate * state.load) * *direction;
    return s;
}

double max_slope(const ScalarLaw& law) {
    return std::visit(
        overloaded{[](const LinearRate& u) { return u.k; },
                   [](const elastocheck::Curve& u) {
                       double k = 0;
                       for (std::size_t n = 0; n < u.pieces.size(); ++n) {
                           const auto& c = u.pieces[n];
                           k = std::max(k,
                                        std::abs(c[1]));  // slope at the knot; constant if linear
                           if (n == 0 || n == u.knots.size()) continue;
                           const double h = u.knots[n] - u.knots[n - 1],
                                        inflection = -c[2] / (3 * c[3]);  // f'' = 0
                           k = std::max(k, std::abs(slope(c, h)));
                           if (inflection > 0 && inflection < h)
                               k = std::max(k, std::abs(slope(c, inflection)));
                       }
                       return k;
                   }},
        law);
}

std::vector<Corner> corners(const Model& model, const Branch& branch, const Equilibrium& state) {
    std::vector<Corner> all;
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        each_curve(model.elastics[k].kind, [&](std::size_t axis, const elastocheck::Curve& curve) {
            const Vector6 x = deformation(model.elastics[k].kind, k, branch, state);
            if (const auto knot = corner_at(curve, x[static_cast<Eigen::Index>(axis)]))
                all.push_back({k, axis, *knot});
        });
    return all;
}

bool at_corner(const Model& model, const Branch& branch, const Equilibrium& state) {
    return !corners(model, branch, state).empty();
}

std::string outside_table(const Model& model, const Branch& branch, const Equilibrium& state) {
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const Elastic& elastic = model.elastics[k];
        const bool is_spring = member<ScalarLaw>(elastic.kind) != nullptr;
        std::string names;
        each_curve(elastic.kind, [&](std::size_t axis, const elastocheck::Curve& curve) {
            const double x = deformation(elastic.kind, k, branch,
                                         state)[static_cast<Eigen::Index>(axis)],
                         end = end_passed(curve, x);
            if (std::isnan(end) || !names.empty()) return;
            names = is_spring
                        ? beyond_end(fmt::format("spring '{}'", elastic.name), x, end, Unit::mm)
                        : beyond_end(fmt::format("bushing '{}' {} {}", elastic.name,
                                                 axis < 3 ? "along" : "about", axes[axis % 3]),
                                     x, end, axis < 3 ? Unit::mm : Unit::deg);
        });
        if (!names.empty()) return names;
    }
    return {};
}

std::string ends_at_table(const Model& model, const Branch& branch, const Equilibrium& state) {
    const std::string where = outside_table(model, branch, state);
    if (where.empty()) return {};
    const Unit unit = unit_of(branch.unit);
    return fmt::format("branch '{}' at {:.6g} {}: {}", branch.name, in_unit(unit) * state.load,
                       symbol(unit), where);
}

}  // namespace elastocheck::compare
