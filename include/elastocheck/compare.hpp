// Comparison of the three legs on one scene: the outputs of every leg along every branch, and the
// deviations between the legs.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/legs.hpp"

namespace elastocheck::compare {

// ---- Output curves of one leg along one branch.

struct Curve {
    Unit unit = Unit::newton;                 // of the parameter
    std::vector<double> a;                    // [unit], in the order of the points
    std::size_t start = 0;                    // point at a = 0
    std::vector<std::vector<double>> values;  // [point][channel]

    std::vector<double> channel(std::size_t c) const;
};

struct PathCurve {
    Outcome outcome = Outcome::converged;
    std::string detail = {};
    Counts counts = {};
    Curve curve = {};
    std::vector<double> constraint_error = {};  // per point, as in Equilibrium
    double seconds = 0;                         // processor time of the leg alone
};

// ---- Deviation between two curves a and b, at equal parameter and at equal abscissa (for a suspension:
// equal load and equal travel).

// Of one channel.
struct Deviation {
    double max = 0;         // largest |b - a|, in the channel's unit
    double signed_max = 0;  // b - a where it is largest
    double at = 0;          // parameter or abscissa of the maximum, in its unit
    double end = 0;         // b - a at the last compared point, signed
    double rms = 0;
    double range = 0;          // of the channel over curve a
    double interpolation = 0;  // equal abscissa: interpolation error of b, largest over the points
    int compared = 0;          // numbers compared; 0 means no comparison
};

// Of all channels, at equal parameter or at equal abscissa.
struct Reading {
    std::vector<Deviation> channels;  // one per channel
    std::string not_compared;         // reason why there is no comparison, else empty
    int outside = 0;                  // points of a that b does not reach (equal abscissa)
};

// Deviation of b from a.
struct Pair {
    Leg a = Leg::equilibrium, b = Leg::recursive;
    Reading equal_parameter, equal_abscissa;
};

enum class ReadingKind { equal_parameter, equal_abscissa };

// Largest deviation of a main channel in this unit over all branches; NaN counts as largest. Empty
// without a comparison.
struct Worst {
    std::string branch, channel;
    Unit unit = Unit::mm;
    double max = 0, end = 0, range = 0;
    double limit = std::numeric_limits<double>::infinity();  // in `unit`, where it is judged
    double extent = 0;  // `max` is shown as a share of this; 0: not shown as a share
};

// ---- Tolerances of outputs: the limits of their deviations, and the judgement by them.

// Infinite: not judged.
struct Tolerance {
    double mm = std::numeric_limits<double>::infinity();   // of positions
    double deg = std::numeric_limits<double>::infinity();  // of angles
    double newton = std::numeric_limits<double>::infinity();
    double newton_metre = std::numeric_limits<double>::infinity();
    // Of every output that is neither a position nor an angle (joint forces and moments, drive
    // forces, rates), as a share of its extent (extents_of): 0.01 is 1 %. Applies to forces and
    // moments only where `newton` or `newton_metre` is infinite.
    double share = std::numeric_limits<double>::infinity();
};
inline constexpr double default_share = 0.01;
inline constexpr Tolerance default_tolerance{.mm = 0.01, .deg = 0.001, .share = default_share};

enum class Grade {
    pass,       // isfinite(d) && d ≤ limit for every deviation d that is compared, at least one
    fail,       // some d > limit or not finite
    not_judged  // nothing compared, or a reference or its proof is missing: reasons are given
};
const char* name(Grade verdict);  // "pass", "fail", "not judged"

// ---- Scale of a branch, and bounds within which the references have to agree.

// Within which the references have to agree, in shares of the scale of the branch
// (compare/deviation/agreement.hpp).
struct Agreement {
    double length = 1e-9;  // of L: distance between the positions of the references
    double angle = 1e-6;   // [deg]
    double wrench = 1e-7;  // of F: difference of the reactions
    // of F: residual of one reference's states in the other's balance equations
    double residual_force = 2e-9;
    double residual_length = 1e-11;  // of L: likewise, residual of the constraints
};

struct Scale {
    double force = 0;      // F [N]
    double length = 0;     // L [m], never zero
    double round_off = 0;  // ε k X, rounding of a position X times the largest stiffness k [N]
};

// The shares of Agreement times the scale.
struct Bounds {
    double length = 0;                               // [mm]
    double angle = 0;                                // [deg]
    double force = 0, moment = 0;                    // [N], [N·m]
    double residual_force = 0, residual_moment = 0;  // [N], [N·m]
    double residual_length = 0;                      // [mm]
    Scale scale;
};

// ---- Proofs that computed points are near equilibria.

// Largest distances over all bodies and joints: of origins [m], orientations [rad], reaction forces [N] and
// moments [N·m].
struct ProvedBound {
    double length = std::numeric_limits<double>::infinity();
    double angle = std::numeric_limits<double>::infinity();
    double force = std::numeric_limits<double>::infinity();
    double moment = std::numeric_limits<double>::infinity();
};

// Proofs of some points of a path: counts, and the largest error bounds.
struct Tally {
    // proved: an equilibrium is within the bounds; excluded: none is; open: neither could be shown
    int points = 0, proved = 0, excluded = 0, open = 0;
    int stable = 0;  // of the proved points
    // Of the proved points: largest distance to the true equilibrium, and smallest radius within
    // which it is unique. [m, rad, N, N·m]
    ProvedBound error{0, 0, 0, 0}, unique;
    // largest wrench that holds an idle motion [N, N·m], and largest gap of redundant constraints [m, rad]
    double held = 0, gap = 0;
    // additional statement of the certificate at the last point; empty: none
    std::string theorem = {};
    std::string not_proved = {};  // of the first point without a proof: place and reason
};

// ---- Runs and comparisons.

// States that are kept after a run, as far as it came: first point, a = 0, middle of the requested points,
// last point.
struct Landmarks {
    std::optional<Equilibrium> front, start, middle, back;
};

// Compliance matrices at one point of a branch (compliance.hpp) about the wheel centres and
// the contact patches, SI; empty where a wheel moves without resistance.
struct Compliance {
    double a = 0;  // parameter of the branch, in its unit
    Eigen::MatrixXd centre, patch;
    double reciprocity = 0;    // of `centre`
    std::string why_not = {};  // reason why there is none
};

// Largest force or moment of an element over the points of a branch.
struct LargestForce {
    std::string element, output;  // "lower_front", "lower_front.elastic_force_x"
    Unit unit = Unit::newton;
    double value = 0;  // the component of the largest absolute value
    double a = 0;      // parameter there, in the unit of the branch
    // deformation conjugate to it, at the same point; NaN of a link
    double deformation = 0;
    Unit deformation_unit = Unit::mm;
};

// Run of one leg along one branch: outputs of its points, not the states.
struct LegRun : PathCurve {
    Leg leg = Leg::recursive;
    std::string method = {};  // of the recursion, else empty
    // largest residual over the points, by the equations of each leg; forces are NaN for the energy
    // leg where a force has no energy
    std::array<Residuals, legs.size()> judged = {};
    Scale scale = {};  // of the acting forces over the points
    Landmarks landmarks = {};
    Tally proved = {};  // proofs of the landmarks; empty unless requested
    // for scenes with wheels: at front, start and back, as far as they differ
    std::vector<Compliance> compliance = {};
    // Of the equilibrium leg: states at evenly spaced points, in ascending order of the load, and
    // the largest forces over all points.
    std::vector<Equilibrium> stations = {};
    std::vector<LargestForce> largest = {};
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
    const LegRun& run(Leg leg) const { return runs[static_cast<std::size_t>(leg)]; }
    LegRun& run(Leg leg) { return runs[static_cast<std::size_t>(leg)]; }
    // second reference: the energy leg, or the series where the energy leg is not used
    Leg second = Leg::energy;
    // reason why the energy leg is not used: a force without energy, or the size of the scene
    std::string why_not_energy;
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

struct Comparison {
    std::vector<Channel> channels;  // of the model, then totals() of redundant joints
    std::vector<BranchComparison> branches;
    int compared = 0;  // numbers compared in all

    // every leg converged, the references agree, every branch moves some output, and something was compared
    bool conclusive() const;
    // The branch of this name. Pre: there is one.
    const BranchComparison& branch(std::string_view name) const;
};

// Receives what runs now, and the share of the computation that is done, 0 to 1. Calls do not overlap.
using Progress = std::function<void(std::string_view what, double done)>;

struct Options {
    recursive::Options recursion = {};  // method, steps (0: as each branch says) and the like
    int every = 1;                      // compares every `every`-th step (SolverSettings)
    reference::energy::Options energy = {};
    Agreement agreement = {};
    std::string abscissa = {};  // name of a channel; empty: default_abscissa
    // prove that the landmarks are equilibria, to 1e-6 mm and 1e-6 deg; a disproved landmark is an objection
    bool prove = true;
    // of these, only the last point of the equilibrium leg on each side of a branch
    bool prove_ends_only = false;
    bool times = true;  // measure LegRun::seconds, else NaN
    int threads = 1;    // legs and branches are solved at once; the results are the same
    Progress progress = {};
};

// Throws std::invalid_argument for an abscissa that is no channel of the model.
Comparison compare(const Model& model, const Options& options = {});

}  // namespace elastocheck::compare
