// The ladder of methods: one loop (sweep.hpp) with a few orthogonal choices.
//
// All solve one saddle-point system per step. They differ in what they leave out of it:
//
//   rung        right-hand side                                  matrix          solves  order to the truth
//   published   what (29) carries over; constraints (7)          K of (19)       1       0
//   closed      + -Φ(qⁿ) in the lower row                        K               1       0
//   balanced    + true f_elast(qⁿ), f_ext(qⁿ) instead of sums    K               1       1
//   tangent     the same                                         ∂(forces)/∂q    1       2
//   chord       the same, then once more with the same factors   ∂(forces)/∂q    1 (2)   3
//   midpoint    the same, matrix taken half a step ahead         ∂(forces)/∂q    2       3
//   adaptive    chord, with the step size from its own error estimate
//   series      no steps: the branch as a power series, to any order with one matrix (series/path.hpp)
//
// A method that starts each step from the true residual does not accumulate: its error at a point is the
// error of the last step, so an order p in one step is the order p at the end.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace elastocheck::recursive {

// What of the forces stored by earlier steps turns with the bodies. The published sum turns nothing but the
// load's lever.
struct Follow {
    bool lever =
        false;  // the stored force of an element acts at the present position of its attachment points
    bool axis = false;  // ... and points where the element's law says now, as large as it says
    bool load = true;   // the load already applied acts at the present position of its point

    friend bool operator==(const Follow&, const Follow&) = default;
};
inline constexpr Follow everything{true, true, true};

struct Method {
    std::string_view name = "published";
    Follow follow = {};
    bool closed = false;      // lower row -Φ(qⁿ) instead of 0
    bool consistent = false;  // tangent of all forces instead of K
    bool midpoint = false;    // matrix from half a step ahead, at the price of a second factorisation
    int corrections = 0;      // further solves with the same factors
    bool adaptive = false;    // step size from the embedded error estimate
    bool series = false;      // the branch as a piecewise polynomial
    double formal_order = 0;  // to the truth
};

inline constexpr std::array methods{
    Method{},
    Method{.name = "closed", .closed = true},
    Method{.name = "balanced", .follow = everything, .closed = true, .formal_order = 1},
    Method{.name = "tangent", .follow = everything, .closed = true, .consistent = true, .formal_order = 2},
    Method{.name = "chord",
           .follow = everything,
           .closed = true,
           .consistent = true,
           .corrections = 1,
           .formal_order = 3},
    Method{.name = "midpoint",
           .follow = everything,
           .closed = true,
           .consistent = true,
           .midpoint = true,
           .formal_order = 3},
    Method{.name = "adaptive",
           .follow = everything,
           .closed = true,
           .consistent = true,
           .corrections = 1,
           .adaptive = true,
           .formal_order = 3},
    Method{.name = "series", .follow = everything, .closed = true, .consistent = true, .series = true},
};

// Whether the method takes as many equal steps as it is told.
constexpr bool has_steps(const Method& method) { return !method.adaptive && !method.series; }

constexpr std::optional<Method> find_method(std::string_view name) {
    for (const Method& method : methods)
        if (method.name == name) return method;
    return std::nullopt;
}

}  // namespace elastocheck::recursive
