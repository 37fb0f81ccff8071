// Continuation along a branch: from the design pose to the settled state at a = 0, then from point
// to point.
//
// Past a limit point Newton's method may converge to an equilibrium of another branch. So a step is
// accepted only if it is a short, nearly straight piece of one curve without a singular point: the
// chord between two equilibria and the tangents at both ends agree within a quarter, the Jacobian
// has the same orientation at both, and the stiffness stays positive over the whole step
// (stability.hpp). Otherwise the step is halved; if that does not help, the branch ends here. The
// requested points do not affect these decisions.
//
// These criteria assume that every element stays on one piece of its law. At a knot of a law the
// branch has a kink, and the continuation restarts there (knots.hpp).
#pragma once

#include <optional>

#include "reference/equilibrium/continuation/knots.hpp"
#include "reference/equilibrium/continuation/newton.hpp"
#include "reference/equilibrium/continuation/stability.hpp"
#include "reference/equilibrium/linear_algebra/linearisation.hpp"

namespace elastocheck::reference::equilibrium {

// The continuation has two stages with a parameter t each: the homotopy from the design pose (t
// from 0 to 1), and the branch (t = a).
enum class Stage { settling, branch };

// An accepted equilibrium.
struct Station {
    double t = 0;
    Eigen::VectorXd x;
    Linearisation linearised;
    Stiffness stiffness;
    Eigen::VectorXd E;        // remaining residual [n]
    Eigen::VectorXd E_rate;   // dE/dt [n]
    Eigen::VectorXd tangent;  // dx/dt [n]
    Eigen::VectorXd mu;       // part of dE/dt outside the range of J [k]
    std::vector<CurveDeformation> curves;
};

struct Continuation {
    const System& system;
    const Options& options;
    double length = 1;  // of the stage in t, the unit of the smallest step
    // least stiffness and size of the tangent [1/t] at the start of the branch
    double first_stiffness = 1;
    double first_tangent = 0;
    Stage stage = Stage::settling;
    Pieces pieces = {};                              // current pieces of the curves
    Station current = {};                            // the last accepted equilibrium
    std::optional<Station> previous = std::nullopt;  // before it, on the same pieces
    Counts counts = {};
};

inline Loading loading_at(const Continuation& continuation, double t) {
    return continuation.stage == Stage::settling ? Loading{0, 1 - t, 0, -1, continuation.pieces}
                                                 : Loading{t, 0, 1, 0, continuation.pieces};
}

// Result of a step, the first condition that holds in this order (accepted: none does). E is the scaled
// residual, dx the predicted step, δ the last Newton correction.
enum class Verdict {
    accepted,
    out_of_reach,    // |dx| above the longest step, or a direction turned between two states of it
    past_knot,       // E(x) = 0, but a deformation x has left its piece of a curve
    unsolved,        // |E| above the tolerance after the last Newton step
    another_branch,  // E(x) = 0, but x is not on the tangent's side of the last state
    unsettled,       // on this branch, but |δ| of one more Newton step is above its tolerance
    // on this branch, but rounding moves x by more than the tolerance, or Stability::uncertain
    uncertain,
    // on this branch, but more idle motions, another sign of det J or of the constraints' determinant
    // (stability.hpp), or Stability::lost
    past_singular_point,
};

struct Trial {
    Verdict verdict;
    Attempt attempt = {};
    Station station = {};
    double knot = 0;  // approximate t at which the first piece ends
};

struct Failure {
    Outcome outcome;
    std::string what;
};

// At the design pose, where the homotopy of `system` starts.
Continuation start(const System& system, const Options& options);
void restart(Continuation& continuation);  // the same, with the present terms of its system

// After settling: starts the branch at a = 0; its points extend to `reach`.
std::optional<Failure> begin_branch(Continuation& continuation, double reach);

// Continues from the current station to t = target with as few steps as possible.
std::optional<Failure> advance(Continuation& continuation, double target);

// Reason why the branch does not continue from the current station towards t, from the most
// informative trial.
Failure failure(Continuation& continuation, double t, const Trial& trial);

// Reason of an unsolvable right-hand side, from its left null vector: a load on an idle mode, or
// inconsistent joints.
Failure unsolvable_load(const System& system, const Eigen::VectorXd& left);

// The bodies that move in the free motion of least stiffness, in words: the motion in which an
// equilibrium is unstable.
std::string softest_motion(const System& system, const Linearisation& at);

// Failure where a mode is resisted by elements but too softly for the precision of J.
Failure too_soft(const System& system, const Eigen::VectorXd& left);

}  // namespace elastocheck::reference::equilibrium
