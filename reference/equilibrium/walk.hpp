// Walking along a branch: from the design pose to the settled state at a = 0, then from point to point.
//
// Newton's method knows nothing of branches; past a limit point it is glad to land on whatever equilibrium
// there is. So a step is believed only if it is a short, nearly straight piece of one curve, on which nothing
// becomes singular: the chord between two equilibria and the tangents at both its ends agree within a
// quarter, the Jacobian is oriented alike at both, and the stiffness stays positive over all of it
// (stability.hpp), whatever points lie on it. Otherwise the step is halved, and if that does not help, the
// branch has ended here.
//
// All that is said of one curve without singular points holds as long as every element stays on one piece of its
// law; where a law has a knot, the branch has one too, and the walk begins again there (knots.hpp).
#pragma once

#include <optional>

#include "reference/equilibrium/knots.hpp"
#include "reference/equilibrium/linearisation.hpp"
#include "reference/equilibrium/newton.hpp"
#include "reference/equilibrium/stability.hpp"

namespace elastocheck::reference::equilibrium {

// The way has two legs with a parameter t each: letting go of the design pose (t from 0 to 1), the branch (t
// = a).
enum class Stage { settling, branch };

// An equilibrium on the way.
struct Station {
    double t = 0;
    Eigen::VectorXd x;
    Linearisation linearised;
    Stiffness stiffness;
    Eigen::VectorXd E;        // what is left [n]
    Eigen::VectorXd E_rate;   // dE/dt [n]
    Eigen::VectorXd tangent;  // dx/dt [n]
    Eigen::VectorXd mu;       // what of dE/dt cannot be answered [k]
    std::vector<OnCurve> curves;
};

struct Walk {
    const System& system;
    const Options& options;
    double length = 1;           // of the way in t, by which the smallest step is measured
    double first_stiffness = 1;  // the least where the branch begins, and how fast it sets out [1/t]
    double first_tangent = 0;
    Stage stage = Stage::settling;
    Pieces pieces = {};  // that the walk is on
    Station here = {};
    std::optional<Station> before = std::nullopt;  // on the same pieces
    Counts counts = {};
};

inline Loading loading_at(const Walk& walk, double t) {
    return walk.stage == Stage::settling ? Loading{0, 1 - t, 0, -1, walk.pieces}
                                         : Loading{t, 0, 1, 0, walk.pieces};
}

enum class Verdict {
    accepted,
    out_of_reach,    // the tangent already leads too far away for one step
    past_knot,       // an equilibrium of pieces that end before it
    unsolved,        // the residual stays above the tolerance
    another_branch,  // an equilibrium, but not on this branch
    unsettled,       // on this branch, but a further Newton step would still move it
    uncertain,       // on this branch, but what lies between is not told by its ends and middle
    turned_over,     // on this branch, but past a singular point
};

struct Trial {
    Verdict verdict;
    Attempt attempt = {};
    Station station = {};
    double knot = 0;  // t where the first piece ends, about
};

struct Failure {
    Outcome outcome;
    std::string what;
};

Walk start(const System& system, const Options& options);  // at the design pose, held

// Another way to let go: the joints carry at the design pose what they can, the least reactions with the least
// imbalance. Where somebody holds all, forces that turn with no joint are let go of, and half-way between two stable
// states there may be an unstable one; here the way is short where the joints are what holds.
void let_joints_carry(System& system, Counts& counts);

// After settling: from a = 0 along the branch, whose points reach out to `reach`.
std::optional<Failure> begin_branch(Walk& walk, double reach);

// From here to t = target, by as few steps as it takes.
std::optional<Failure> advance(Walk& walk, double target);

// Why the branch does not go on from here towards t, judged by the most telling trial.
Failure failure(Walk& walk, double t, const Trial& trial);

// What cannot be answered, as a left null vector: a load on an idle mode, or joints against each other.
Failure unanswerable(const System& system, const Eigen::VectorXd& left);

}  // namespace elastocheck::reference::equilibrium
