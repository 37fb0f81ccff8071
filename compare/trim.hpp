// Trim: the free lengths, preloads and offsets with which a scene, under what is held on every branch, settles where
// its conditions ask for.
//
// x(p): the state that the equilibrium leg settles, the adjustments p held by the drivers of a branch on which
// nothing moves. c(x) are the conditions, lengths and angles side by side. Newton's method on c(x(p)) = 0,
//
//   J Δp = -c,     J e_k h_k = ½ (c(x(p + h_k e_k)) - c(x(p - h_k e_k))),
//
// h_k a step that moves the elements by a tenth of a millimetre or their stress by ten newtons; Δp is halved until c
// gets smaller. Whether J answers every condition by one Δp alone is judged on J with columns per step h and then
// rows of length one: differences are known to some six digits, so a singular value below 1e-6 of the largest is
// none.
//
// The energy leg, which knows nothing of p, then settles the trimmed scene, and its conditions are read as well.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/channels.hpp"
#include "compare/legs.hpp"
#include "models/scene.hpp"

namespace elastocheck::compare {

struct TrimRecord {
    struct Adjusted {
        std::string name;  // "springs.coil.preload"
        Unit unit = Unit::newton;
        double by = 0;      // found, counted from what the scene said
        std::string makes;  // "force 3521.4 N in compression, free length 412.3 mm": what it is now
    };
    struct Met {
        std::string name;  // "left.travel"
        Unit unit = Unit::mm;
        double asked = 0;
        double missed = 0;     // by the equilibrium leg's state
        double confirmed = 0;  // missed by that of the second reference
    };
    std::vector<Adjusted> adjusted;
    std::vector<Met> conditions;
    int iterations = 0;              // of Newton's method
    Leg confirmed_by = Leg::energy;  // or the series, where that one is not asked
    Outcome outcome = Outcome::converged;
    std::string detail;  // why there is no trim: nothing was reached, or not confirmed; empty when there is
    bool reached() const { return outcome == Outcome::converged && detail.empty(); }
};

struct Trimmed {
    Scene scene;                       // with what was found as plain data, and no trim any more
    std::optional<TrimRecord> record;  // none where the scene asks for no trim, and is as it was
};

// Throws std::invalid_argument where the trim is no well-posed question: conditions and adjustments that are not as
// many, an adjustment that moves no condition, conditions that no adjustment moves or that move only together. It
// names them. Where no answer is reached, or the second reference does not confirm it, the record says why and the
// scene is the one given.
Trimmed trim(const Scene& scene);

}  // namespace elastocheck::compare
