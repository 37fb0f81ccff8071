// The stepping methods and their settings. Each method solves saddle-point systems of the form (24); they
// differ in the terms that they leave out.
//
//   method      right-hand side                                  matrix         solves  order
//   published   what (29) carries over; constraints (7)          K of (19)      1       0
//   closed      + -Φ(qⁿ) in the lower row                        K              1       0
//   balanced    + true f_elast(qⁿ), f_ext(qⁿ) instead of sums    K              1       1
//   tangent     the same                                         ∂(forces)/∂q   1       2
//   chord       the same, then once more with the same factors   ∂(forces)/∂q   1 (2)   3
//   midpoint    the same, matrix taken half a step ahead         ∂(forces)/∂q   2       3
//   adaptive    tangent steps with step-size control by an error estimate
//   series      the branch as a power series (asymptotic numerical method, Cochelin 1994), to any
//               order with one matrix (recursive/series/path.hpp)
//
// The order is that of convergence to the true equilibrium; 0: the limit is another configuration.
//
// A method that starts each step from the true residual does not accumulate errors: the error at a point is
// that of the last step, so that its order in one step is its order at the end.
//
// Force curves have knots. An equal step across a knot has, at that one point, an error of order
//
//   method                slope jumps (a stop closes)    curvature jumps (a table)
//   balanced, tangent     1                              2
//   chord                 1                              3, the second solve uses the next piece
//   midpoint              1                              2
//
// and two steps later the method has its own order again. In published and closed, which sum stored
// increments, the error of the step remains: order 1, added to the gap. Adaptive ends a step on
// every knot (event_location.hpp) and keeps its order.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <variant>

namespace elastocheck::recursive {

// Which forces stored by earlier steps rotate with the bodies. In the published sum only the lever
// of the load follows.
struct StoredForces {
    // the force of an element acts at the current attachment points
    bool lever_follows = false;
    // it has the current direction and size of the element's law
    bool axis_follows = false;
    // The applied load acts at the current position of its point; a follower rotates with its body,
    // since f_ext of (28) is that of the current configuration.
    bool load_follows = true;

    friend bool operator==(const StoredForces&, const StoredForces&) = default;
};
inline constexpr StoredForces all_follow{true, true, true};

// Equal steps with the stiffness matrix K of eq. (19): published, closed, balanced.
struct Linear {
    StoredForces stored = {};
    bool closed = false;  // lower row -Φ(qⁿ; aⁿ⁺¹) instead of -∂Φ/∂a Δa
};
// Equal steps with the consistent tangent and the true forces: tangent, chord, midpoint.
struct Consistent {
    enum class Solve {
        once,
        corrected,  // once more with the same factors
        // a second solve with the matrix half a step ahead, at the cost of its factorisation
        midpoint
    } solve = Solve::once;
};
struct Adaptive {
    double length_tolerance = 1e-5;     // error of any body's origin [m] ...
    double angle_tolerance = 1.745e-5;  // ... and orientation [rad] at any point of the branch
};
struct Series {
    int order = 16;  // p
    // The end of the branch is reached by the lowest order that does, up to this one.
    int last_order = 24;
    // truncation error of any body's position [m], and of its orientation times the model's size [m]
    double tolerance = 1e-12;
    // maximum number; as many again for each knot of a curve that the branch crosses
    int expansions = 200;
    bool arc_length = false;  // as parameter instead of the branch's own
};

using MethodKind = std::variant<Linear, Consistent, Adaptive, Series>;
struct Method {
    std::string_view name = "published";
    double formal_order = 0;  // of convergence to the true equilibrium
    MethodKind kind = Linear{};
};

inline constexpr std::array methods{
    Method{},
    Method{"closed", 0, Linear{.closed = true}},
    Method{"balanced", 1, Linear{.stored = all_follow, .closed = true}},
    Method{"tangent", 2, Consistent{Consistent::Solve::once}},
    Method{"chord", 3, Consistent{Consistent::Solve::corrected}},
    Method{"midpoint", 3, Consistent{Consistent::Solve::midpoint}},
    Method{"adaptive", 3, Adaptive{}},
    Method{"series", 0, Series{}},
};

// Whether the method takes the requested number of equal steps.
constexpr bool has_steps(const Method& method) {
    return std::holds_alternative<Linear>(method.kind) ||
           std::holds_alternative<Consistent>(method.kind);
}

constexpr std::optional<Method> find_method(std::string_view name) {
    for (const Method& method : methods)
        if (method.name == name) return method;
    return std::nullopt;
}

}  // namespace elastocheck::recursive
