// Continuation of a branch of constrained minima.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "reference/energy/constraints/balance.hpp"
#include "reference/energy/constraints/quadratic.hpp"
#include "reference/energy/minimise/stability.hpp"

namespace elastocheck::reference::energy {

// Reasons for the end of a branch, as half a sentence.
inline constexpr const char* law_ended =
    "the rotation of a bushing has reached the end of its law, half a turn or the range of its "
    "angles";

struct Failure {
    Outcome outcome;
    std::string what;  // half a sentence
};

// Poses at a parameter value with balance, Hessian and modes.
struct State {
    double a = 0;  // parameter of the branch
    std::vector<Pose> poses;
    Balance balance;
    Eigen::MatrixXd H;
    Modes modes;
    // of a large model (cost.hpp), instead of H and of all modes but the softest
    std::shared_ptr<const Quadratic> quadratic = {};
};

// Constant data of a branch: everything but the parameter.
struct Path {
    const Model& model;
    const Options& options;
    Scales scales;
    Course course;
    std::vector<int> turning;  // bushings with rotational stiffness
    double span;               // the largest requested |a|
    Counts& counts;
    Modes start_modes = {};  // modes where the branch starts
};

// State of the continuation.
struct Continuation {
    State state;               // the last accepted equilibrium
    double next_step;          // |step| to try next
    StiffnessRecord record;    // stiffnesses of the equilibria so far
    double first_tangent = 0;  // largest entry of the tangent at the start
    State previous = {};  // the equilibrium before the last, and its tangent; empty at the start
    Eigen::VectorXd previous_tangent = {};
};

Continuation start_continuation(const Path& path, const State& state);

// Poses, balance, Hessian and modes at parameter a; the poses need not be an equilibrium.
State state_at(const Path& path, double a, const std::vector<Pose>& poses);

// Whether the state satisfies the first-order conditions of the constrained
// minimum, to options.tolerance.
bool is_stationary(const Path& path, const State& state);

// Minimises at parameter a from `start`, chart after chart, until stationary. Idle motions of
// `near`, the last equilibrium, are held (minimise.hpp).
struct Attempt {
    State state;
    std::optional<Failure> failure;
};
Attempt minimum_from(const Path& path, double a, const std::vector<Pose>& start, const State& near);

// Poses after the increment ξ from `from`.
std::vector<Pose> moved(const Path& path, const std::vector<Pose>& from, const Eigen::VectorXd& xi);

State dense_state_at(const Path& path, double a, const std::vector<Pose>& poses);
// The same without modes, for a large model. Multipliers as of sparse_balance().
State sparse_state_at(const Path& path, double a, const std::vector<Pose>& poses,
                      const Eigen::VectorXd& lambda = {});

// Newton correction ξ [6nb] for a projected gradient [6nb] and a constraint residual Φ [m], without
// idle motion.
Eigen::VectorXd correction(const Path& path, const State& state, const Eigen::VectorXd& gradient,
                           const Eigen::VectorXd& Phi);

// Tangent dξ/da of the branch at the equilibrium `state` [6nb].
Eigen::VectorXd tangent(const Path& path, const State& state);

// Continues the branch to parameter `to` with its own step-size control. On failure it stays at the
// last equilibrium reached.
std::optional<Failure> advance(const Path& path, Continuation& continuation, double to);

}  // namespace elastocheck::reference::energy
