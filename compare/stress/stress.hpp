// Stress test of all legs and methods on transformed and extreme scenes: right within a claimed
// accuracy, a reported failure, or wrong.
//
// A trial is a varied scene; a cell is the result of one leg or method on one side of its branch,
// run as `compare` runs it. A converged result claims an accuracy and is judged by it:
//
//   its tolerance             of `adaptive`, of `series`
//   for a reference           exact except for rounding: 1e-9 of the scene's size, 1e-6 deg
//   with fixed steps          no claim: its digits are reported
//
// Compared are the positions of bodies, probes and wheel centres, the spin axes of wheels, and the
// joint reactions, these where the claim is less than 1e-4 of the size: a claim of a share of the
// size implies one of a thousand times that share of the largest acting force. The true outputs are
// known to within e (StressCell::known_by); a claim is broken where |x - x_T| - e exceeds it. Outputs of a
// scene under an invariance transform are mapped back and judged by the truth of the unchanged
// scene, without a claim by the same method's result there, within 1e-7 of the movement.
//
// Also wrong are: a converged result where both references report the end of the branch, and a
// reference that reports that end where the states of another solver are proved and stable at every
// point, or known in the unchanged scene.
//
// The position of a body along an idle mode is arbitrary, so outputs of such bodies
// are not compared.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/stress/transforms.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

struct Variant {
    std::string label;                         // "as it is", "rates of 'coil' times 1e+06"
    Scene scene;                               // without a trim
    std::optional<Transform> transforms = {};  // of the unchanged scene
    // Properties known by construction, independent of any solver.
    enum class Construction {
        unknown,         // no such property
        no_equilibrium,  // of the branch: the case is right only if no solver converges
        nothing_moves    // the true outputs are those of the design position
    } known = Construction::unknown;
    // methods to run beside `published` and the references; empty: all
    std::vector<std::string> requested = {};
};

struct Trial {
    std::string scene, sweep;  // a row of the map; in `extreme` each variant has a row of its own
    Variant variant;
};

inline constexpr std::string_view as_it_is = "as it is";  // sweep of the unchanged scene alone
inline constexpr std::string_view extreme = "extreme";    // scenes that are extreme by construction
// All sweeps of a scene (sweeps.cpp): the unchanged scene with every branch, its variants
// with the first.
std::vector<Trial> trials(const std::string& name, const Scene& scene);

struct Solver {
    std::string name;  // "published", "equilibrium"
    SolverSettings settings;
};
std::vector<Solver> solvers();  // every method of the recursion, then the references

// With x the outputs of a cell, x_T the true ones, known to within e, at every point; in the order of
// the tests: wrong first.
enum class CellVerdict {
    right,             // converged, and |x - x_T| - e ≤ claim < ∞
    no_claim,          // converged, claim = ∞: its digits -log10(|x - x_T| / range) are reported
    reported_failure,  // outcome ≠ converged, and nothing shows that the branch continues
    // converged, |x - x_T| - e > claim, and the certificate of x is `proved`: another equilibrium of
    // the same load
    elsewhere,
    unjudged,  // converged, and x_T is unknown at a point
    // |x - x_T| - e > claim without such a proof; a value that is not finite; a point missing; converged
    // where no equilibrium exists, or ended where the branch is proved to continue
    wrong,
};
const char* name(CellVerdict verdict);

struct StressCell {
    std::string scene, sweep, variant, side, solver;
    Outcome outcome = Outcome::converged;
    std::string detail;  // message of the solver
    CellVerdict verdict = CellVerdict::unjudged;
    std::string why = {};  // reason, for a verdict that needs one
    // source of the true outputs: "construction"; "proof" of a state of a reference or of the series;
    // "references", or one and the series, that agree within their claims; "the unchanged scene"
    // without the transform; empty: unknown
    std::string known_by = {};
    // -log10(error / range); NaN where the truth is unknown
    double digits = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();  // largest of all positions [m]
    double claim = std::numeric_limits<double>::infinity();   // [m]
    // largest displacement of any position, or the scene's size if nothing moves [m]
    double range = 0;
};

struct Survival {
    std::vector<std::string> solvers;  // in the order of the run
    std::vector<StressCell> cells;     // in the order of the trials
    int count(CellVerdict verdict) const;
    int judged() const;  // all cells except unjudged ones
};

Survival stress(std::span<const Trial> trials, int threads = 2, const Progress& progress = {});

struct Result;
Result result_of(const Survival& survival);

//   0 ... 9  digits of a converged result (9: nine or more)     !  reported failure
//   ~  another equilibrium than that of the branch              ?  converged, truth unknown
//   X  wrong
char sign(const StressCell& cell);

}  // namespace elastocheck::compare
