// How a branch is walked: the only place where a leg is called, a branch is split into its ways, and the ways
// are joined into one path again.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/agreement.hpp"
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
// `recursion.steps` and `.record` follow from that. Of the recorded points every so-many-th is asked for, counted from
// a = 0, and the last: the recursion passes the others on its way, the references do not visit them.
struct Gait {
    Leg leg = Leg::recursive;
    recursive::Options recursion = {};
    int refine = 1;
    int every = 1;
    bool account = false;  // every point carries its bound and the stiffness left, by the leg's own account
};

// The values of the parameter that are asked for, in the order of the points: of one way from a = 0, of two from `from`
// to `to`.
std::vector<double> asked_for(const std::vector<Way>& ways, int every);

// Ends, whatever the leg, before the first point at which an element is deformed beyond the end of a curve that says
// nothing there: Outcome::outside_table. Where somebody visits the points, they are not kept.
EquilibriumPath walk(const Way& way, const Gait& gait, const Visit& visit = {});

// Whether the energy leg says that it is not to be asked here, not that it failed.
bool is_not_asked(Outcome outcome);

// Both ways in one path, a going from `from` to `to`; one way as it was walked. It ends with the outcome of
// the first way that failed, and its points are those reached on either side of a = 0.
EquilibriumPath walk(const std::vector<Way>& ways, const Gait& gait);

// What is asked of a point, in place of all its poses and wrenches.
struct Row {
    double load = 0;              // as in Equilibrium
    double constraint_error = 0;  // likewise
    std::vector<double> values;   // per channel, in its unit
};
// What the recursion tells once of the models that answer on a way (answers.hpp), whatever the state.
struct Analyses {
    std::optional<recursive::Analysis> free, jacked, tied;  // made when they are first asked for
};
// By whoever walks as `gait` says: a characteristic is asked of the leg that found the state.
Row row_of(const Model& model, std::span<const Channel> channels, const Way& way, const Gait& gait,
           const Equilibrium& state, Analyses& analyses);
inline Row row_of(const Model& model, std::span<const Channel> channels, const Way& way, const Gait& gait,
                  const Equilibrium& state) {  // of one state alone
    Analyses analyses;
    return row_of(model, channels, way, gait, state, analyses);
}

// The same path, no point of which is kept: each is read once, as it is found, and its row handed over in the order of
// the path. What comes reversed, the first of two ways, is kept as rows until it ends.
EquilibriumPath walk(const std::vector<Way>& ways, const Gait& gait,
                     const std::function<Row(const Equilibrium&)>& read,
                     const std::function<void(Row)>& hand_over);

// The same path as a curve.
struct Walked {
    Outcome outcome = Outcome::converged;
    std::string detail = {};
    Counts counts = {};
    Curve curve = {};
    std::vector<double> constraint_error = {};  // per point, as in Equilibrium
    double seconds = 0;                         // of the leg alone
};
// `also` sees every point, as it is found.
Walked walk(const Model& model, std::span<const Channel> channels, const Branch& branch,
            const std::vector<Way>& ways, const Gait& gait, const Visit& also = {});

// Where the way begins by this leg: one point, the state at a = 0, settled under what is held; none where it does not
// settle.
EquilibriumPath rest(const Way& way, Leg leg);

// What the state leaves in the equations of a leg.
Residuals judge(Leg by, const Way& way, const Equilibrium& state);

// ---- The references along a branch.

// The equilibrium leg, and the energy leg; or series, where the energy leg is not asked.
struct References {
    Curve truth, other;  // of the equilibrium leg and of the second, on the channels asked for
    Outcome truth_ended = Outcome::converged;
    Leg second_leg = Leg::energy;
    std::string not_asked;  // why the energy leg was not, where second_leg is the series
    Scale scale;            // of what acts on the branch, by the equilibrium leg
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
