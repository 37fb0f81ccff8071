// The ladder of methods. All solve one saddle-point system per step; they differ in what they leave out of
// it:
//
//   rung        right-hand side                                  matrix          solves  order to the truth
//   published   what (29) carries over; constraints (7)          K of (19)       1       0
//   closed      + -Φ(qⁿ) in the lower row                        K               1       0
//   balanced    + true f_elast(qⁿ), f_ext(qⁿ) instead of sums    K               1       1
//   tangent     the same                                         ∂(forces)/∂q    1       2
//   chord       the same, then once more with the same factors   ∂(forces)/∂q    1 (2)   3
//   midpoint    the same, matrix taken half a step ahead         ∂(forces)/∂q    2       3
//   adaptive    tangents, with the step size from its own error estimate
//   series      no steps: the branch as a power series, to any order with one matrix (series/path.hpp)
//
// A method that starts each step from the true residual does not accumulate: its error at a point is the
// error of the last step, so an order p in one step is the order p at the end.
//
// Curves have knots. A step of equal size that goes over one ends, at that one point, with an error of order
//
//   rung                  slope jumps (a stop closes)    curvature jumps (a table)
//   balanced, tangent     1                              2
//   chord                 1                              3, its second solve knows the piece behind
//   midpoint              1                              2
//
// and two steps later has its own again. In published and closed, which add up what each step stored, the error
// of the step stays: order 1, added to the gap. Adaptive ends a step on every knot (landing.hpp) and loses nothing.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <variant>

#include "recursive/series/options.hpp"

namespace elastocheck::recursive {

// What of the forces stored by earlier steps turns with the bodies. The published sum turns nothing but the
// load's lever.
struct Follow {
    bool lever =
        false;  // the stored force of an element acts at the present position of its attachment points
    bool axis = false;  // ... and points where the element's law says now, as large as it says
    bool load =
        true;  // the load already applied acts at the present position of its point; a follower turns with
               // its body, since f_ext of (28) is that of the present configuration

    friend bool operator==(const Follow&, const Follow&) = default;
};
inline constexpr Follow everything{true, true, true};

// Equal steps with the stiffness matrix K of eq. (19): published, closed, balanced.
struct Linear {
    Follow follow = {};
    bool closed = false;  // lower row -Φ(qⁿ; aⁿ⁺¹) instead of -∂Φ/∂a Δa
};
// Equal steps with the consistent tangent and the true forces: tangent, chord, midpoint.
struct Consistent {
    enum class Solve {
        once,
        corrected,  // once more with the same factors
        midpoint    // once more with the matrix from half a step ahead, at the price of its factorisation
    } solve = Solve::once;
};
// Steps of its own.
struct Adaptive {
    double length_tolerance = 1e-5;     // error of any body's origin [m] ...
    double angle_tolerance = 1.745e-5;  // ... and orientation [rad] at any point of the branch
};
using Series = series::Options;

using MethodKind = std::variant<Linear, Consistent, Adaptive, Series>;
struct Method {
    std::string_view name = "published";
    double formal_order = 0;  // to the truth
    MethodKind kind = Linear{};
};

inline constexpr std::array methods{
    Method{},
    Method{"closed", 0, Linear{.closed = true}},
    Method{"balanced", 1, Linear{.follow = everything, .closed = true}},
    Method{"tangent", 2, Consistent{Consistent::Solve::once}},
    Method{"chord", 3, Consistent{Consistent::Solve::corrected}},
    Method{"midpoint", 3, Consistent{Consistent::Solve::midpoint}},
    Method{"adaptive", 3, Adaptive{}},
    Method{"series", 0, Series{}},
};

// Whether the method takes as many equal steps as it is told.
constexpr bool has_steps(const Method& method) {
    return std::holds_alternative<Linear>(method.kind) || std::holds_alternative<Consistent>(method.kind);
}

constexpr std::optional<Method> find_method(std::string_view name) {
    for (const Method& method : methods)
        if (method.name == name) return method;
    return std::nullopt;
}

}  // namespace elastocheck::recursive
