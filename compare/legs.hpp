// How a branch is walked: the only place where a leg is called, a branch is split into its ways, and the ways
// are joined into one path again.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "compare/deviation.hpp"
#include "models/equilibrium_path.hpp"
#include "models/model.hpp"
#include "recursive/solve.hpp"

namespace elastocheck::compare {

// The three legs, and what stands in for the energy leg where it is not asked, because a load or a formulation has no
// energy or the scene is too large for it: the branch as a power series, told the tightest tolerance.
enum class Leg { recursive, equilibrium, energy, series };
inline constexpr std::array legs{Leg::recursive, Leg::equilibrium, Leg::energy};
const char* name(Leg leg);

// One way of a branch, from a = 0, and the model as it stands there: what a leg is given.
struct Way {
    std::string name;  // "jounce"; "bounce to -80 mm" where a branch has two ways
    Model model;
    Branch branch;  // `steps`: how many equal increments of a are recorded
};

// `points` equal increments of a over the whole branch are recorded, shared by its ways; 0: as many as it has
// steps.
std::vector<Way> ways_of(const Model& model, Branch branch, int points = 0);

// How a leg walks. The recursion takes `refine` equal steps from one recorded point to the next, and
// `recursion.steps` and `.record` follow from that; the references visit the recorded points.
struct Gait {
    Leg leg = Leg::recursive;
    recursive::Options recursion = {};
    int refine = 1;
};

// Ends, whatever the leg, before the first point at which an element is deformed beyond the end of a curve that says
// nothing there: Outcome::outside_table.
EquilibriumPath walk(const Way& way, const Gait& gait);

// Whether the energy leg says that it is not to be asked here, not that it failed.
bool is_not_asked(Outcome outcome);

// Both ways in one path, a going from `from` to `to`; one way as it was walked. It ends with the outcome of
// the first way that failed, and its points are those reached on either side of a = 0.
EquilibriumPath walk(const std::vector<Way>& ways, const Gait& gait);

// Where the way begins by this leg: one point, the state at a = 0, settled under what is held; none where it does not
// settle.
EquilibriumPath rest(const Way& way, Leg leg);

// What the state leaves in the equations of a leg.
Residuals judge(Leg by, const Way& way, const Equilibrium& state);

// ---- The references along a branch.

// The equilibrium leg, and the energy leg; or series, where the energy leg is not asked.
struct References {
    EquilibriumPath equilibrium, second;
    Leg second_leg = Leg::energy;
    std::string not_asked;  // why the energy leg was not, where second_leg is the series
    Curve truth, other;     // of the first and of the second, on the channels asked for
    Accuracy
        uncertainty;  // how far they are apart on the main channels, at least their rounding; NaN on failure
    std::vector<std::string> failures;  // why they are no reference: a leg failed, nothing drives the branch,
                                        // no output moves
};

References references(const Model& model, const std::vector<Channel>& channels, const Branch& branch,
                      const std::vector<Way>& ways);

// Why nothing is learned from a branch: it has no driver left, or no main channel of the curve moves by more
// than its rounding. Empty where one does.
std::string nothing_moves(const Model& model, const std::vector<Channel>& channels, const Branch& branch,
                          const Curve& truth);

// ---- Where a branch begins: the state at a = 0, settled under what is held.

struct Settled {
    std::string branch;
    Outcome outcome = Outcome::converged;
    std::string detail;
    std::vector<double> displacement;  // per channel: value at a = 0 less its value as drawn, in its unit;
                                       // NaN unless converged
};
Settled settled(const Model& model, const std::vector<Channel>& channels, const Branch& branch);

}  // namespace elastocheck::compare
