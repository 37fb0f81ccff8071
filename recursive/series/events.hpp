// Events inside an expansion, which its polynomial passes smoothly: bifurcations and losses of
// stability by the determinant and the least stiffness, reversed elements, turns of the parameter.
#pragma once

#include <optional>

#include "recursive/series/continuation.hpp"

namespace elastocheck::recursive::series {

// Sign of the determinant at the present point. With arc length it is multiplied by the sign of
// the rate of the parameter along the path: at limit points both signs change.
int determinant_sign(const Continuation& run, double parameter_rate);

// Sign of the parameter's rate at the end of the last expansion, from the factors there. The sign
// of the polynomial's a' is not used: near a limit point it changes slightly before or after that
// of the determinant, by rounding or by the tolerance.
double parameter_rate_ahead(const Continuation& run);

// Whether the equilibrium whose factors are in run.s.system is past a singular point of the path: the
// determinant has changed its sign, or the least stiffness is negative (two modes that become
// unstable at once leave the determinant's sign unchanged).
bool is_past(Continuation& run, double parameter_rate);

// |determinant| at the present point over that at the start of the expansion; negative if its sign
// differs from that at the start of the path.
double determinant(const Continuation& run);

// Appends the limit points of a(τ) in the last range to run.path.limits. A limit point at the seam of
// two expansions may appear at the end of one and the start of the next, or in neither. The test is
// therefore whether the sign of a' differs from that at the last point tested, that of
// run.parameter_rate.
void record_limit_points(Continuation& run, double reach);

// Locates a bifurcation point in 0 ≤ τ ≤ reach by bisection and moves the state to it. The
// polynomial continues smoothly past such a point. Returns the τ up to which it represents the
// stable path; with arc length 0, since there is no bisection.
double locate_bifurcation(Continuation& run, const State<double>& from, double reach);

// A τ inside the expansion at which the path is unstable although its end is stable; none if no
// such τ is found. The state is then that at the end.
std::optional<double> find_instability(Continuation& run, const State<double>& from, double reach);

// The first τ at which an element reverses: a spring passes through zero length, or a bushing
// through half a turn. The polynomial continues smoothly where the force jumps. The state is then
// that at τ.
std::optional<double> find_reversal(Continuation& run, const State<double>& from, double reach);

}  // namespace elastocheck::recursive::series
