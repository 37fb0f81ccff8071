#include "compare/design/confirm.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elastocheck::compare {

Confirmation confirm(const Scene& scene, const std::vector<Figure>& figures,
                     const std::vector<std::string>& units, const Eigen::VectorXd& values,
                     const Eigen::VectorXd& movement) {
    Confirmation result;
    int judges = 0;
    std::string& why = result.why_not;
    for (const auto leg : {Leg::energy, Leg::series}) {
        const FigureValues found = figure_values(scene, figures, leg);
        (leg == Leg::energy ? result.energy : result.series) = found.value;
        if (found.not_applicable) continue;
        ++judges;
        for (std::size_t k = 0; k < figures.size(); ++k) {
            const auto i = static_cast<Eigen::Index>(k);
            const double apart = std::abs(found.value[i] - values[i]);
            if (why.empty() && std::isfinite(apart) && !(apart <= legs_agree * movement[i]))
                why = fmt::format("{}: the {} differs by {:.2g} {}", figures[k].name,
                                  leg == Leg::energy ? "energy leg" : "series", apart, units[k]);
        }
        if (why.empty()) why = found.why_not;
        if (why.empty() && !found.value.allFinite()) why = "a figure has no value by another leg";
    }
    if (why.empty() && judges == 0) why = "no other leg applies to the scene";
    result.confirmed = why.empty();
    return result;
}

}  // namespace elastocheck::compare
