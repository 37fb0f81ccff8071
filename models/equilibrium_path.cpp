#include "elastocheck/equilibrium_path.hpp"

namespace elastocheck {

const char* name(Outcome outcome) {
    switch (outcome) {
        case Outcome::converged: return "converged";
        case Outcome::singular: return "singular";
        case Outcome::loaded_idle_mode: return "loaded idle mode";
        case Outcome::inconsistent_constraints: return "inconsistent constraints";
        case Outcome::not_finite: return "not finite";
        case Outcome::iteration_limit: return "iteration limit";
        case Outcome::diverged: return "diverged";
        case Outcome::limit_point: return "limit point";
        case Outcome::bifurcation_point: return "bifurcation point";
        case Outcome::branch_lost: return "branch lost";
        case Outcome::not_conservative: return "not conservative";
        case Outcome::too_large: return "too large";
        case Outcome::outside_table: return "outside its table";
    }
    return "unknown";
}

}  // namespace elastocheck
