// One scene, three legs, side by side.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/agreement.hpp"
#include "compare/channels.hpp"
#include "compare/curve.hpp"
#include "compare/deviation.hpp"
#include "compare/legs.hpp"
#include "compare/proof.hpp"
#include "models/equilibrium_path.hpp"
#include "models/model.hpp"
#include "recursive/solve.hpp"

namespace elastocheck::compare {

// The states that outlive the walk: where it begins, at a = 0, in the middle of what was asked for, and where it ends;
// as far as it came.
struct Landmarks {
    std::optional<Equilibrium> front, start, middle, back;
};

// How far the wheels give at one point of a branch (characteristics.hpp): matrices about the wheel centres and the contact
// patches, SI; empty where nothing resists the wheels.
struct Compliance {
    double a = 0;  // of the branch's parameter, in its unit
    Eigen::MatrixXd centre, patch;
    double reciprocity = 0;    // of `centre`
    std::string why_not = {};  // there is none
};

// One leg along one branch. Of its points the outputs are kept, not the states.
struct LegRun : Walked {
    Leg leg = Leg::recursive;
    std::string method = {};                         // of the recursion, else empty
    std::array<Residuals, legs.size()> judged = {};  // worst over the points, by the equations of each leg;
        // forces are NaN by the energy leg's where there is no energy
    Scale scale = {};  // of what acts over the points
    Landmarks landmarks = {};
    // What its points, where they give account of themselves, come to (outlook.hpp), in words: of a method that promises a
    // tolerance what it does not keep, of the equilibrium leg where the stiffness will be gone.
    std::vector<std::string> told = {};
    Tally proved = {};  // of the landmarks; none where nobody asked
    std::vector<Compliance> compliance =
        {};  // at front, start and back, as far as they are apart; of a scene with wheels
};

// The recursion goes as `recursion` says, the published one unless it says otherwise, and every one of its
// steps is recorded (0 steps: as many as the branch says); the references visit the parameters of its steps.
// The curve has channels(model).
LegRun run(const Model& model, const Branch& branch, Leg leg, const recursive::Options& recursion = {});

// Deviation of b from a.
struct Pair {
    Leg a = Leg::equilibrium, b = Leg::recursive;
    Reading equal_parameter, equal_abscissa;
};

// Why something cannot be judged.
struct Objection {
    std::string what;
    double share =
        std::numeric_limits<double>::infinity();  // of its bound; infinite where there is no number
};
struct Objections {
    std::vector<Objection> worst;  // three at most, worst first
    int count = 0;                 // of all

    void add(std::string what, double share = std::numeric_limits<double>::infinity());
    bool empty() const { return count == 0; }
    std::vector<std::string> texts() const;  // the worst, and how many more
};

struct BranchComparison {
    std::string branch;
    Unit unit = Unit::newton;  // of its parameter
    int steps = 0, every = 1;  // of the recursion, and which of them are compared (Gait)
    int abscissa = -1;         // channel of the readings at equal abscissa; -1: none
    std::vector<LegRun> runs;  // in the order of `legs`, then the series where it is the second reference
    Leg second =
        Leg::energy;  // the second reference: the energy leg, or the series where that one is not asked
    std::string
        not_asked;  // why the energy leg was not, in words: what has no energy, or how large the scene is
    std::vector<bool> determined;  // per channel; what is not is never compared: reactions that redundant
                                   // joints share as they like, joints that do not stand on this branch,
                                   // what is undefined somewhere on it
    Pair deviation;                // the recursion against the equilibrium leg
    Pair cross_check;              // the recursion against the second reference
    Pair uncertainty;              // the second reference against the equilibrium leg
    Bounds bounds;                 // within which the references have to agree
    Objections inconclusive;       // why this branch cannot be judged; empty when it can
};

// Whether the energy leg, not asked for states of its own because the scene is too large, judges those of the
// equilibrium leg: it bears witness.
bool energy_bears_witness(const BranchComparison& branch);

// Why the references do not count as one truth on a branch whose runs and readings are there; `asked` is the
// branch of the model. Of all legs: or the recursion did not get through, which objects to a verdict on it, and to none
// on somebody else.
enum class Of { all_legs, references };
Objections disagreements(const Model& model, const std::vector<Channel>& channels, const Branch& asked,
                         const BranchComparison& branch, Of of = Of::all_legs);

struct Comparison {
    std::vector<Channel> channels;  // of the model, then the totals of what redundant joints share
    std::vector<BranchComparison> branches;
    int compared = 0;  // numbers compared in all

    bool conclusive() const;  // every leg converged, the references agree, every branch moves something,
                              // something was compared
};

struct Options {
    recursive::Options recursion = {};  // method, steps (0: as each branch says) and the like
    int every = 1;                      // of its steps, each of which is compared (Gait)
    Agreement agreement;
    std::string abscissa = {};  // name of a channel; empty: default_abscissa
    bool prove =
        true;  // that the landmarks are equilibria, to 1e-6 mm and 1e-6 deg; one that provably is none objects
    std::function<void(std::string_view)> progress = {};  // told what is being solved
};

// Throws std::invalid_argument for an abscissa that is no channel of the model.
Comparison compare(const Model& model, const Options& options = {});

}  // namespace elastocheck::compare
