// Trim: free lengths, preloads and offsets for which a scene settles, under the loads held on every
// branch, at the requested conditions.
//
// x(p): the state settled by the equilibrium leg, the adjustments p held by the drivers of a branch
// without motion. c(x): the residuals of the conditions, lengths and angles together. Newton's
// method on c(x(p)) = 0,
//
//   J Δp = -c,     J e_k h_k = ½ (c(x(p + h_k e_k)) - c(x(p - h_k e_k))),
//
// h_k is a step that moves the element by a tenth of a millimetre or changes its stress by ten
// newtons; Δp is halved until |c| decreases. The rank of J (every condition answered by exactly one
// Δp) is judged on J with columns per step h and rows scaled to length one. Differences have about
// six digits, so a singular value below 1e-6 of the largest counts as zero.
//
// The energy leg, which does not use p, then settles the trimmed scene, and its conditions are
// checked too.
//
// Trim::Bushings::balanced: the drawn position shall be the equilibrium. With preloads P of the
// bushings (none at first) the scene is trimmed and settles at x; what the laws then carry beyond
// what they carry as drawn is added,
//
//   P ← P + u'(e(x)) - u'(e(drawn)),
//
// again until no body is farther than 1e-12 m from where it is drawn. The first state, of bushings
// that are unloaded as drawn, decides what they and the adjusted springs carry. Each correction leaves
// what springs and preloads bear of the motion; corrections are combined (Anderson 1965), since on a
// soft subframe that is most of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/legs.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

struct TrimRecord {
    struct Adjusted {
        std::string name;  // "springs.coil.preload"
        Unit unit = Unit::newton;
        double by = 0;  // found change relative to the value in the scene
        // "force 3521.4 N in compression, free length 412.3 mm": resulting values
        std::string makes;
    };
    struct Met {
        std::string name;  // "left.travel"
        Unit unit = Unit::mm;
        double target = 0;
        double missed = 0;     // residual by the equilibrium leg's state
        double confirmed = 0;  // residual by the state of the second reference
    };
    std::vector<Adjusted> adjusted;  // of Trim::adjust, then of every balanced bushing
    std::vector<Met> conditions;
    Trim::Bushings bushings = Trim::Bushings::unloaded;
    int iterations = 0;              // of Newton's method
    Leg confirmed_by = Leg::energy;  // or the series, where the energy leg does not apply
    Outcome outcome = Outcome::converged;
    // reason why there is no trim: not reached, or not confirmed; empty on success
    std::string detail;
    bool reached() const { return outcome == Outcome::converged && detail.empty(); }
};

const char* name(Trim::Bushings bushings);  // "unloaded", "balanced"

struct Trimmed {
    Scene scene;                       // with the result as plain data, and without a trim section
    std::optional<TrimRecord> record;  // empty where the scene requests no trim and is unchanged
};

// Throws std::invalid_argument for an ill-posed trim, naming the entries: different numbers of
// conditions and adjustments, an adjustment that moves no condition, conditions that no adjustment
// moves or that move only together; a condition of a balanced trim that differs from its value as
// drawn. Where no solution is reached, or the second reference does not
// confirm it, the record has the reason and the scene is the one given.
Trimmed trim(const Scene& scene);

}  // namespace elastocheck::compare
