// Stress test of all legs and methods on extreme scenes: correct to a number of digits, a reported
// failure, or wrong.
//
// A trial is a varied scene; a cell is the result of one leg or method on one side of its branch. A
// converged result claims an accuracy and is judged by it:
//
//   its tolerance             of `adaptive`, of `series`
//   for a reference           exact except for rounding: 1e-9 of the scene's size, 1e-6 deg
//   with fixed steps          no claim: its digits are reported
//
// The true error of a state lies between |x - x_T| - e and |x - x_T| + e, where x_T is a state
// known to within e. A claim is broken where the lower end exceeds it. Knowledge lists the sources
// of x_T. Also wrong are: a converged result where both references report the end of the branch; an
// answer that changes under an invariance transform; and a reference that reports the end of the
// branch where the states of another solver are proved and stable at every point, or that continues
// beyond that end in the transformed scene.
//
// Joint reactions are judged too, for the solvers with a tolerance (the references, `adaptive`,
// `series`), where they are determined. The true reactions come with the true state, from the proof
// (its box contains them) or from the references. A claim of a share of the size implies one of a
// thousand times that share of the largest acting force (reactions.hpp).
//
// The position of a body along an idle mode is arbitrary, so such bodies and their joints are not
// compared.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/stress/arithmetic.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

// ---- Input.

// Invariance transform of a scene: a point at p moves to  length · M p + t.
struct Transform {
    Eigen::Matrix3d M = Eigen::Matrix3d::Identity();  // a rotation or a mirror image
    Eigen::Vector3d t = Eigen::Vector3d::Zero();      // [m]
    double length = 1;
};

struct Variant {
    std::string label;  // "as it is", "rates of 'coil' times 1e+06"
    Scene scene;        // without a trim
    std::optional<Transform> transforms =
        {};  // of the unchanged scene: every result must be the same
    // Properties known by construction, independent of any solver.
    enum class Construction {
        nothing,
        no_equilibrium,
        nothing_moves
    } known = Construction::nothing;
    std::vector<std::string> requested = {};  // solvers to run beside the references; empty: all
    std::string skipped = {};                 // reason why no solver runs
    // arithmetic of the solvers; the truth is known from the default arithmetic
    Arithmetic arithmetic = Arithmetic::nearest;
};

// Named family of variants of a scene. The unchanged scene uses every branch, all variants only the
// first.
struct Sweep {
    std::string name;
    std::function<std::vector<Variant>(const Scene&)> variants;
};

struct Trial {
    std::string scene;  // row of the map
    // column of the map; in the sweep `extreme` each variant has a row of its own
    std::string sweep;
    Variant variant;
};

// the sweep that contains only the unchanged scene
inline constexpr std::string_view as_it_is = "as it is";
inline constexpr std::string_view extreme = "extreme";  // scenes that are extreme by construction
std::vector<Trial> trials(const std::string& name, const Scene& scene,
                          std::span<const Sweep> sweeps);

// Sweeps that apply to any scene: sweeps.cpp.
const std::vector<Sweep>& sweeps();

// ---- Solvers: every method of the recursion, and the references.
struct Solver {
    std::string name;  // "published", "equilibrium"
    SolverSettings settings;
};
std::vector<Solver> solvers();

// ---- Results.

enum class Knowledge {
    none,
    construction,  // by construction of the scene: Variant::known
    proved,        // proved by the certificate, from the state of a reference or of the series
    references,    // two solvers without a common equation agree within their claims
    transforms,    // from the same mechanism without the transform, whose state is known
};
const char* name(Knowledge knowledge);

enum class CellVerdict {
    right,             // converged, within its claim
    no_claim,          // converged, without a claim: its digits are reported
    reported_failure,  // another outcome
    elsewhere,         // converged at another equilibrium of the same load, which is proved too
    unjudged,          // converged, but the truth is unknown
    wrong,
};
const char* name(CellVerdict verdict);

struct StressCell {
    std::string scene, sweep, variant, side, solver;
    Outcome outcome = Outcome::converged;
    std::string detail;  // message of the solver
    CellVerdict verdict = CellVerdict::unjudged;
    std::string why;  // reason, for a verdict that needs one
    Knowledge knowledge = Knowledge::none;
    // -log10(error / range); NaN where the truth is unknown
    double digits = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();  // largest of all places [m]
    int reactions = 0;                                        // number of judged joint reactions
    double claim = std::numeric_limits<double>::infinity();   // [m]
    // For a transformed scene: distance of the answer from that of the unchanged scene, in the frame
    // of that [m]; NaN unless both converged.
    double apart = std::numeric_limits<double>::quiet_NaN();
    // largest displacement of any place, or the scene's size if nothing moves [m]
    double range = 0;
};

struct Survival {
    std::vector<std::string> scenes, sweeps, solvers;  // in the order of the run
    std::vector<StressCell> cells;                     // in the order of the trials
    struct Skipped {
        std::string scene, sweep, variant, why;
    };
    std::vector<Skipped> skipped;
    double seconds = 0;  // processor time of all threads
    struct Dearest {
        std::string scene, variant;
        double seconds = 0;
    } dearest;  // most expensive trial
    int count(CellVerdict verdict) const;
    int judged() const;  // all cells except unjudged ones
};

struct StressOptions {
    int threads = 2;
    Progress progress = {};
};

Survival stress(std::span<const Trial> trials, const StressOptions& options = {});

// ---- The map: one sign for the results of a solver in all trials of a scene and a sweep.
//
//   0 ... 9  digits of the worst converged result (9: nine or more)     !  only reported failures
//   ~  another equilibrium than that of the branch                      .  not requested
//   ?  converged, truth unknown
//   X  wrong
char sign(const Survival& survival, const std::string& scene, const std::string& sweep,
          const std::string& solver, const std::string& variant = {});  // for one variant

}  // namespace elastocheck::compare
