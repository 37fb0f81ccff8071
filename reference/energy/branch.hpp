// Following a branch from one accepted minimum to the next.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "models/equilibrium_path.hpp"
#include "reference/energy/balance.hpp"
#include "reference/energy/solve.hpp"

namespace elastocheck::reference::energy {

// Why a branch ends, half a sentence.
inline constexpr const char* turned_over = "a bushing has turned by half a turn, where its law ends";

struct Failure {
    Outcome outcome;
    std::string what;  // half a sentence
};

// A pose and what is known about it.
struct State {
    double a = 0;  // load factor
    std::vector<Pose> poses;
    Balance at;
    Eigen::MatrixXd H;
    Modes modes;
};

// What a branch is made of: everything but the load factor.
struct Path {
    const Model& model;
    const Options& options;
    Scales scales;
    std::function<Loading(double)> loading;  // at a load factor
    Counts& counts;
    Modes first = {};  // modes where the branch starts
};

// Pose, balance, Hessian and modes at load factor a, whether an equilibrium or not.
State state_at(const Path& path, double a, const std::vector<Pose>& poses);

// Whether the state satisfies the constrained minimum's first-order conditions, to options.tolerance.
bool is_stationary(const Path& path, const State& state);

// Minimises at load factor a from `start`, chart after chart, until stationary. `idle` motions [6nb × their
// number] are not made use of (minimise.hpp).
struct Attempt {
    State state;
    std::optional<Failure> failure;
};
Attempt minimum_from(const Path& path, double a, const std::vector<Pose>& start, const Eigen::MatrixXd& idle);

// Takes `state` to load factor `to`, halving the step where it must. On failure `state` is the last
// equilibrium reached.
std::optional<Failure> advance(const Path& path, State& state, double to);

}  // namespace elastocheck::reference::energy
