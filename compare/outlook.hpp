// What a path whose points give account of themselves comes to: where the stiffness that is left will be gone, and whether
// what its method promises is kept.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/equilibrium_path.hpp"
#include "models/scene.hpp"
#include "recursive/method.hpp"

namespace elastocheck::compare {

// The value of the parameter near which the stiffness is gone if it goes on falling as over the last three points: as a
// straight line where the branch will divide, as the root of one where it will turn back (towards a limit point a* it is
// √(a* - a)); whichever of both the three points fit. None where it does not fall, or nobody has given account.
std::optional<double> stiffness_gone_near(std::span<const Equilibrium> points);

// "at this rate the stiffness is gone near -211.5 N"; empty where there is nothing to announce: no such value, or one
// farther ahead than the way behind.
std::string outlook(std::span<const Equilibrium> points, ParameterUnit unit);

// Since when the last points have announced it: the load of the first of those from which on each has.
std::optional<double> announced_from(std::span<const Equilibrium> points);

// What a method promises of every point on its own: `adaptive` its tolerances; the series to be exact but for its own
// tolerance and rounding, 1e-9 of the length of the scene [m] and 1e-9 rad. Of the others none.
std::optional<ErrorBound> promised(const recursive::Method& method, double length);

// Where the bounds of the points do not hold what is promised, in words; empty where all do.
std::string unkept(std::span<const Equilibrium> points, const ErrorBound& promise, ParameterUnit unit);

// The same of points that come one after the other, however many: what is said of them, and the last three.
struct Accounts {
    int points = 0, beyond = 0, unbounded = 0;
    double share = 1;  // of the promise, the most that one has
    ErrorBound worst_bound = {};
    double worst_load = 0;
    std::vector<Equilibrium> last = {};  // without poses
    std::optional<double> announced_from = {};
};
void add(Accounts& accounts, const Equilibrium& point, const std::optional<ErrorBound>& promise);
std::string unkept(const Accounts& accounts, const ErrorBound& promise, ParameterUnit unit);

// Those of the ways of a branch, one way after the other, each from a = 0 on.
struct BranchAccount {
    std::optional<ErrorBound> promise = {};
    std::vector<Accounts> ways = {};
};
void add(BranchAccount& account, const Equilibrium& point);

// One line each: what is promised and not kept, where the stiffness will be gone and since when that is announced.
std::vector<std::string> told(const BranchAccount& account, ParameterUnit unit);

}  // namespace elastocheck::compare
