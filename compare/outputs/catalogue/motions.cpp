#include "compare/outputs/catalogue/motions.hpp"

namespace elastocheck::compare {

Motions weighted_sum(const std::vector<std::pair<double, const Motions*>>& terms) {
    Motions total(terms.front().second->size());
    for (const auto& [weight, motions] : terms)
        for (std::size_t b = 0; b < total.size(); ++b) {
            total[b].dr += weight * (*motions)[b].dr;
            total[b].dpi += weight * (*motions)[b].dpi;
        }
    return total;
}
Motions axle_motions(const ResponsesByWheel& responses, const Subject& wheel, int wrench,
                     double other) {
    std::vector<std::pair<double, const Motions*>> terms;
    for (std::size_t w = 0; w < responses.size(); ++w)
        terms.emplace_back(w == wheel.k ? 1 : other,
                           &responses[w][static_cast<std::size_t>(wrench)]);
    return weighted_sum(terms);
}
const Motions& motions_at_fixed_height(const Subject& wheel, int wrench) {
    return wheel.response->jacked[wheel.k][static_cast<std::size_t>(wrench)];
}
const Motions* motions_at_fixed_load(const Subject& wheel, int wrench) {
    return wheel.response->free.empty()
               ? nullptr
               : &wheel.response->free[wheel.k][static_cast<std::size_t>(wrench)];
}
double value_without_free_response(const Subject& wheel) {
    return wheel.response->nothing_resists ? undefined : nan;
}

Motions heave_motions(const Subject& wheel) {
    const auto& travel = wheel.response->travel;
    const double scale =
        wheel.response->tied ? 1 / wheel.displacement(travel.front(), wheel.centre()).z() : 1;
    std::vector<std::pair<double, const Motions*>> terms;
    for (const Motions& motions : travel) terms.emplace_back(scale, &motions);
    return weighted_sum(terms);
}
Motions roll_motions(const Subject& wheel) {
    std::vector<std::pair<double, const Motions*>> terms;
    for (std::size_t w = 0; w < wheel.model.wheels.size(); ++w)
        terms.emplace_back(wheel.other_wheel(w).side(), &wheel.response->travel[w]);
    return weighted_sum(terms);
}
double vertical_rate(const Subject& wheel, int force, const PlacedPoint& point, double other) {
    if (wheel.response->free.empty()) return value_without_free_response(wheel);
    return ratio(
        1, wheel.displacement(axle_motions(wheel.response->free, wheel, force, other), point).z(),
        max_stiffness);
}

}  // namespace elastocheck::compare
