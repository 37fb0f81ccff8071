// Extrapolates the remaining stiffness along a path to the next singular point, and checks the
// points' error bounds against the tolerance of the method.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/recursive_method.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

// Parameter value at which the stiffness, extrapolated from the last three points, vanishes. The
// extrapolation is a straight line towards a bifurcation, and the root of a line towards a limit
// point a*, where the stiffness falls as √(a* - a); the law that fits the three points better is
// used. Empty where the stiffness does not fall, or the points have no estimate of it.
std::optional<double> stiffness_gone_near(std::span<const Equilibrium> points);

// "at this rate the stiffness is gone near -211.5 N"; empty without a singular point ahead, or if
// it is farther away than the path is long.
std::string stiffness_message(std::span<const Equilibrium> points, ParameterUnit unit);

// Tolerance of a method at every point: `adaptive` has its tolerances; the series has its own
// tolerance plus rounding, 1e-9 of the length of the scene [m] and 1e-9 rad. Empty for the other
// methods.
std::optional<ErrorBound> tolerance_of_method(const recursive::Method& method, double length);

// Running summary of the error bounds for a sequence of points of any length, with the last three
// points.
struct ErrorBoundSummary {
    int points = 0, beyond = 0, unbounded = 0;
    double share = 1;  // largest ratio of a bound to the tolerance
    ErrorBound worst_bound = {};
    double worst_load = 0;
    std::vector<Equilibrium> last = {};  // without poses
    // load of the first point from which on every point predicts the singular point
    std::optional<double> announced_from = {};
};
void add(ErrorBoundSummary& error_bounds, const Equilibrium& point,
         const std::optional<ErrorBound>& tolerance);
// Message about the points whose error bound exceeds the tolerance; empty if none does.
std::string exceeded_bounds(const ErrorBoundSummary& error_bounds, const ErrorBound& tolerance,
                            ParameterUnit unit);

// Summaries of the sides of a branch, one after the other, each from a = 0 on.
struct BranchErrorBounds {
    std::optional<ErrorBound> tolerance = {};
    std::vector<ErrorBoundSummary> sides = {};
};
void add(BranchErrorBounds& error_bound, const Equilibrium& point);

// Messages, one line each: exceeded tolerances, predicted singular points and since when they are
// predicted.
std::vector<std::string> messages(const BranchErrorBounds& error_bound, ParameterUnit unit);

}  // namespace elastocheck::compare
