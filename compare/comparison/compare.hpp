// Comparison of the three legs on one scene.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/deviation/proof.hpp"
#include "compare/deviation/tolerance.hpp"
#include "compare/outputs/channels.hpp"
#include "compare/outputs/curve.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/recursive.hpp"

namespace elastocheck::compare {

// States that are kept after a run: first point, a = 0, middle of the requested points, last point;
// as far as the run came.
struct Landmarks {
    std::optional<Equilibrium> front, start, middle, back;
};

// Compliance matrices at one point of a branch (characteristics.hpp) about the wheel centres and
// the contact patches, SI; empty where a wheel moves without resistance.
struct Compliance {
    double a = 0;  // parameter of the branch, in its unit
    Eigen::MatrixXd centre, patch;
    double reciprocity = 0;    // of `centre`
    std::string why_not = {};  // reason why there is none
};

// Run of one leg along one branch: outputs of its points, not the states.
struct LegRun : Walked {
    Leg leg = Leg::recursive;
    std::string method = {};  // of the recursion, else empty
    // largest residual over the points, by the equations of each leg; forces are NaN for the energy
    // leg where a force has no energy
    std::array<Residuals, legs.size()> judged = {};
    Scale scale = {};  // of the acting forces over the points
    Landmarks landmarks = {};
    // Messages from the error bounds and the remaining stiffness of its points (extrapolation.hpp):
    // broken tolerance of a method that has one, and for the equilibrium leg the expected next
    // singular point.
    std::vector<std::string> told = {};
    Tally proved = {};  // proofs of the landmarks; empty unless requested
    std::vector<Compliance> compliance =
        {};  // at front, start and back, as far as they differ; for scenes with wheels
};

// Runs one leg. The recursion uses `recursion` (default: the published method) and records every
// step (0 steps: the branch's own number). The references visit the parameters of those steps. The
// curve has channels(model).
LegRun run(const Model& model, const Branch& branch, Leg leg,
           const recursive::Options& recursion = {});

// Deviation of b from a.
struct Pair {
    Leg a = Leg::equilibrium, b = Leg::recursive;
    Reading equal_parameter, equal_abscissa;
};

// A reason why a branch cannot be judged.
struct Objection {
    std::string what;
    // ratio to its bound; infinite if unknown
    double share = std::numeric_limits<double>::infinity();
};
struct Objections {
    std::vector<Objection> worst;  // three at most, worst first
    int count = 0;                 // of all objections

    void add(std::string what, double share = std::numeric_limits<double>::infinity());
    bool empty() const { return count == 0; }
    std::vector<std::string> texts() const;  // the worst, and the number of the others
};

struct BranchComparison {
    std::string branch;
    Unit unit = Unit::newton;  // of its parameter
    // of the recursion: steps taken, of which every `every`-th is compared (SolverSettings)
    int steps = 0, every = 1;
    int abscissa = -1;         // channel of the readings at equal abscissa; -1: none
    std::vector<LegRun> runs;  // in the order of `legs`, then the series if it is a reference
    // second reference: the energy leg, or the series where the energy leg is not used
    Leg second = Leg::energy;
    // reason why the energy leg is not used: a force without energy, or the size of the scene
    std::string not_asked;
    // per channel; undetermined channels are never compared: reactions that redundant joints share,
    // joints that are inactive on this branch, outputs undefined somewhere on it
    std::vector<bool> determined;
    Pair deviation;    // the recursion against the equilibrium leg
    Pair cross_check;  // the recursion against the second reference
    Pair uncertainty;  // the second reference against the equilibrium leg
    Bounds bounds;     // within which the references have to agree
    // Per channel, from the equilibrium leg (tolerance.hpp). A rate has the largest extent over all
    // branches: on a branch where it is nearly zero, a share of its own extent would be too strict.
    std::vector<double> extents;
    Objections inconclusive;  // why this branch cannot be judged; empty when it can
};

// Whether the energy leg judges the states of the equilibrium leg although the scene is too large
// for states of its own.
bool energy_bears_witness(const BranchComparison& branch);

// Reasons why the references do not agree on a branch whose runs and readings are complete; `asked`
// is the branch of the model. all_legs: a failed recursion is an objection too, since it prevents a
// verdict on the recursion; references: it is not, since it does not affect a verdict on a
// candidate.
enum class Of { all_legs, references };
Objections disagreements(const Model& model, const std::vector<Channel>& channels,
                         const Branch& asked, const BranchComparison& branch, Of of = Of::all_legs);

struct Comparison {
    std::vector<Channel> channels;  // of the model, then the totals of what redundant joints share
    std::vector<BranchComparison> branches;
    int compared = 0;  // numbers compared in all

    // every leg converged, the references agree, every branch moves some output, and something was
    // compared
    bool conclusive() const;
};

struct Options {
    recursive::Options recursion = {};  // method, steps (0: as each branch says) and the like
    int every = 1;                      // compares every `every`-th step (SolverSettings)
    Agreement agreement;
    std::string abscissa = {};  // name of a channel; empty: default_abscissa
    // prove that the landmarks are equilibria, to 1e-6 mm and 1e-6 deg; a disproved landmark is an
    // objection
    bool prove = true;
    // called with a text about the current solve
    std::function<void(std::string_view)> progress = {};
};

// Throws std::invalid_argument for an abscissa that is no channel of the model.
Comparison compare(const Model& model, const Options& options = {});

}  // namespace elastocheck::compare
