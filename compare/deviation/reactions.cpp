#include "compare/deviation/reactions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/deviation/deviation.hpp"

namespace elastocheck::compare {

ReactionBound bound_of_reactions(double length, const Scale& acts) {
    constexpr double per_share = 1000, least = 1e-6, rounding = 1e3;
    constexpr double no_force = 1e-12;  // [N]: lower limit where no force acts
    const double force =
        std::max(least, per_share * length / acts.length) * std::max(acts.force, no_force) +
        rounding * acts.round_off;
    return {force, force * acts.length};
}

std::string reaction_off(std::span<const std::string> joints, std::span<const Wrench> found,
                         std::span<const Wrench> known, const ReactionBound& bound,
                         const Scale& acts) {
    std::string why;
    double worst = 1;
    for (std::size_t k = 0; k < known.size() && !std::isnan(worst); ++k) {
        const double force = (found[k].force - known[k].force).norm(),
                     moment = (found[k].moment - known[k].moment).norm(),
                     over = worse(force / bound.force, moment / bound.moment);
        if (over <= worst) continue;
        worst = over;
        why = fmt::format(
            "the reaction of joint '{}' deviates by {:.3g} N and {:.3g} N·m; {:.1e} N and {:.1e} "
            "N·m are allowed for acting forces of {:.3g} N",
            joints[k], force, moment, bound.force, bound.moment, acts.force);
    }
    return why;
}

}  // namespace elastocheck::compare
