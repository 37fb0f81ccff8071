// What becomes of every leg and method at the extremes: right to so many digits, an honest outcome, or wrong.
//
// A trial is a scene, varied; a cell is what one leg or method makes of one way of it. Whoever says "converged" claims
// something, and is held to it:
//
//   the account it gives       Equilibrium::bound, where it is finite
//   what it was told           the tolerance of `adaptive`, of `series`
//   else, of a reference       exact but for rounding: 1e-9 of the scene's size, 1e-6 deg
//   else                       nothing: its digits are told
//
// The true error of a state lies between |x - x_T| - e and |x - x_T| + e, x_T a state that is known to within e. A claim is
// broken where the lower end is above it. What is known, and how: Knowledge. Wrong is as well who converges where both
// references say that the branch ends, who answers otherwise when the same mechanism is told otherwise, and a reference that
// says that the branch ends where another's states are proved and stable at every point, or where it goes on when told otherwise.
//
// A body that an idle mode moves is anywhere along it, so such bodies are not looked at.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/arithmetic.hpp"
#include "compare/legs.hpp"
#include "models/equilibrium_path.hpp"
#include "models/scene.hpp"

namespace elastocheck::compare {

// ---- What is asked.

// How the same mechanism is told: what was at p is at  length · M p + t.
struct Retelling {
    Eigen::Matrix3d M = Eigen::Matrix3d::Identity();  // a rotation or a mirror image
    Eigen::Vector3d t = Eigen::Vector3d::Zero();      // [m]
    double length = 1;
};

struct Variant {
    std::string label;                     // "as it is", "rates of 'coil' times 1e+06"
    Scene scene;                           // without a trim
    std::optional<Retelling> retold = {};  // of the scene as it is: whatever is found is the same
    // What is known of it by construction, whoever solves it.
    enum class Construction { nothing, no_equilibrium, nothing_moves } known = Construction::nothing;
    std::vector<std::string> asked = {};          // solvers beside the references; none: all
    std::string skipped = {};                     // why nobody is asked
    Arithmetic arithmetic = Arithmetic::nearest;  // that the solvers work with; what is true is known without
};

// A name, and what it makes of a scene. Every branch of the scene as it is; of all else the first.
struct Sweep {
    std::string name;
    std::function<std::vector<Variant>(const Scene&)> variants;
};

struct Trial {
    std::string scene;  // whose row of the map it is in
    std::string sweep;  // ... and column; of the sweep `extreme` each variant has a row of its own
    Variant variant;
};

inline constexpr std::string_view as_it_is = "as it is";  // the sweep that has only the scene itself
inline constexpr std::string_view other_arithmetic =
    "arithmetic";                                       // the sweep that the table of lost digits is of
inline constexpr std::string_view extreme = "extreme";  // scenes that are so by their making
std::vector<Trial> trials(const std::string& name, const Scene& scene, std::span<const Sweep> sweeps);

// The sweeps that any scene stands: sweeps.cpp.
const std::vector<Sweep>& sweeps();

// ---- Who is asked: every method of the recursion, and the references.
struct Solver {
    std::string name;  // "published", "equilibrium"
    Gait gait;
};
std::vector<Solver> solvers();

// ---- What came of it.

enum class Knowledge {
    none,
    construction,  // of the scene: Variant::known
    proved,        // by the certificate, from the state of a reference or of the series
    references,    // two that share no equation are within their claims of each other
    retold,        // the same mechanism as it was drawn, whose state is known
};
const char* name(Knowledge knowledge);

enum class Verdict {
    right,       // converged, within what is claimed
    unpromised,  // converged, and claims nothing: its digits
    honest,      // another outcome, or an account that says that no digit is right
    elsewhere,   // converged, at another equilibrium of the same load that is proved as well
    unjudged,    // converged, and nothing is known
    wrong,
};
const char* name(Verdict verdict);

struct StressCell {
    std::string scene, sweep, variant, way, solver;
    Outcome outcome = Outcome::converged;
    std::string detail;  // what the solver says
    Verdict verdict = Verdict::unjudged;
    std::string why;  // of a verdict that needs a reason
    Knowledge knowledge = Knowledge::none;
    double digits =
        std::numeric_limits<double>::quiet_NaN();  // -log10(error / range); NaN where nothing is known
    double error = std::numeric_limits<double>::quiet_NaN();  // of any place, at most [m]
    double claim = std::numeric_limits<double>::infinity();   // [m]
    // Of a scene told otherwise: how far the answer is from that of the scene as it is, and how many of the digits that
    // are right there are not the same here: max(0, digits there + log10(apart / range)). NaN where one did not converge.
    double apart = std::numeric_limits<double>::quiet_NaN();  // [m], as the scene as it is is drawn
    double lost = std::numeric_limits<double>::quiet_NaN();
    double range =
        0;  // how far the place that goes farthest goes, or the scene's size where nothing moves [m]
};

struct Survival {
    std::vector<std::string> scenes, sweeps, solvers;  // in the order in which they were asked
    std::vector<StressCell> cells;                     // in the order of the trials, whoever came first
    struct Skipped {
        std::string scene, sweep, variant, why;
    };
    std::vector<Skipped> skipped;
    double seconds = 0;  // of processor time, all threads
    struct Dearest {
        std::string scene, variant;
        double seconds = 0;
    } dearest;  // trial
    int count(Verdict verdict) const;
    int judged() const;  // all but the unjudged
};

struct StressOptions {
    int threads = 2;
    std::function<void(std::string_view)> progress = {};
};

Survival stress(std::span<const Trial> trials, const StressOptions& options = {});

// ---- The map: what a solver came to in all trials of a scene and a sweep, one sign.
//
//   0 ... 9  digits of the worst that converged (9: nine or more)     !  every outcome was honest
//   ~  another equilibrium than that of the branch                    .  not asked
//   ?  converged, and nothing is known
//   X  wrong
char sign(const Survival& survival, const std::string& scene, const std::string& sweep,
          const std::string& solver, const std::string& variant = {});  // of one variant alone

}  // namespace elastocheck::compare
