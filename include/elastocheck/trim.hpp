// Trim: free lengths, preloads and offsets (adjustments p) for which the equilibrium under the loads that
// act on every branch meets the requested conditions.
//
// x(p) is the equilibrium of the equilibrium leg with the adjustments p held, c(x) the residuals of the
// conditions, lengths and angles together. Newton's method solves c(x(p)) = 0 with central differences,
//
//   J Δp = -c,     J e_k h_k = ½ (c(x(p + h_k e_k)) - c(x(p - h_k e_k))),
//
// where h_k moves the element by a tenth of a millimetre or changes its force by ten newtons. Δp is halved
// until |c| decreases. The problem is well posed if J, with columns per step h_k and rows of length one, is
// regular: since differences have about six digits, a singular value below 1e-6 of the largest counts as zero.
//
// The energy leg, which does not use p, then settles the trimmed scene, and its conditions are
// checked too.
//
// Trim::Bushings::balanced: the drawn position shall be the equilibrium. With preloads P of the bushings
// (zero at first) the scene is trimmed, with the equilibrium x, and the change of the bushings' forces from
// the drawn position to x is added to P,
//
//   P ← P + u'(e(x)) - u'(e(drawn)),
//
// until no body is farther than 1e-12 m from its drawn position. The first x, with bushings that are
// unloaded as drawn, determines how bushings and adjusted springs share the load. A correction removes
// only the part of the motion that the bushings' stiffness resists, on a soft subframe little of it;
// hence successive corrections are combined by Anderson acceleration (Anderson 1965).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/legs.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

struct TrimRecord {
    struct Adjustment {
        std::string name;  // "springs.coil.preload"
        Unit unit = Unit::newton;
        double change = 0;  // of the value in the scene
        // the values with it: "force 3521.4 N in compression, free length 412.3 mm"
        std::string resulting;
    };
    struct Condition {
        std::string name;  // "left.travel"
        Unit unit = Unit::mm;
        double target = 0;
        double residual = 0;             // by the equilibrium leg's state
        double confirming_residual = 0;  // by the state of the second reference
    };
    std::vector<Adjustment> adjusted;  // of Trim::adjust, then of every balanced bushing
    std::vector<Condition> conditions;
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

// Throws std::invalid_argument for an ill-posed trim, naming the entries: different numbers of conditions and
// adjustments, an adjustment that moves no condition, conditions that no adjustment moves or that move only
// together, a condition of a balanced trim that differs from its drawn value. If no solution is reached, or
// the second reference does not confirm it, the record has the reason and the scene is the one given.
Trimmed trim(const Scene& scene);

}  // namespace elastocheck::compare
