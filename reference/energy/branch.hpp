// Following a branch from one accepted minimum to the next.
#pragma once

#include <optional>
#include <string>

#include "models/equilibrium_path.hpp"
#include "reference/energy/balance.hpp"
#include "reference/energy/solve.hpp"
#include "reference/energy/stability.hpp"

namespace elastocheck::reference::energy {

// Why a branch ends, half a sentence.
inline constexpr const char* turned_over =
    "a bushing has turned to where its law ends, half a turn or what its angles allow";

struct Failure {
    Outcome outcome;
    std::string what;  // half a sentence
};

// A pose and what is known about it.
struct State {
    double a = 0;  // parameter of the branch
    std::vector<Pose> poses;
    Balance at;
    Eigen::MatrixXd H;
    Modes modes;
};

// What a branch is made of: everything but the parameter.
struct Path {
    const Model& model;
    const Options& options;
    Scales scales;
    Course course;
    std::vector<int> turning;  // bushings that resist rotation
    double span;               // the largest |a| asked for
    Counts& counts;
    Modes first = {};  // modes where the branch starts
};

// How far a branch has come.
struct Walk {
    State state;               // the last equilibrium
    double stride;             // |step| to try next
    StiffnessRecord record;    // of the equilibria so far
    double first_tangent = 0;  // the largest entry where it began
};

Walk walk_from(const Path& path, const State& state);

// Pose, balance, Hessian and modes at parameter a, whether an equilibrium or not.
State state_at(const Path& path, double a, const std::vector<Pose>& poses);

// Whether the state satisfies the constrained minimum's first-order conditions, to options.tolerance.
bool is_stationary(const Path& path, const State& state);

// Minimises at parameter a from `start`, chart after chart, until stationary. `idle` motions [6nb × their
// number] are not made use of (minimise.hpp).
struct Attempt {
    State state;
    std::optional<Failure> failure;
};
Attempt minimum_from(const Path& path, double a, const std::vector<Pose>& start, const Eigen::MatrixXd& idle);

// Where bodies that stand at `from` come to by ξ.
std::vector<Pose> moved(const Path& path, const std::vector<Pose>& from, const Eigen::VectorXd& xi);

// The ξ that answers, to first order, a gradient `left` over and constraints Φ that are not met (Newton's) [6nb]. Nothing
// of it is idle.
Eigen::VectorXd correction(const Path& path, const State& state, const Eigen::VectorXd& left,
                           const Eigen::VectorXd& Phi);

// dξ/da along the branch, as the equilibrium `state` and the constraints have it [6nb].
Eigen::VectorXd tangent(const Path& path, const State& state);

// Takes the walk to parameter `to`, in steps of its own. On failure it stands at the last equilibrium
// reached.
std::optional<Failure> advance(const Path& path, Walk& walk, double to);

}  // namespace elastocheck::reference::energy
