#include "compare/outputs/catalogue/motions.hpp"

namespace elastocheck::compare {

Motions sum(const std::vector<std::pair<double, const Motions*>>& weighted) {
    Motions total(weighted.front().second->size());
    for (const auto& [weight, motions] : weighted)
        for (std::size_t b = 0; b < total.size(); ++b) {
            total[b].dr += weight * (*motions)[b].dr;
            total[b].dpi += weight * (*motions)[b].dpi;
        }
    return total;
}
Motions of_axle(const Causes& by, const Subject& x, int cause, double other) {
    std::vector<std::pair<double, const Motions*>> weighted;
    for (std::size_t w = 0; w < by.size(); ++w)
        weighted.emplace_back(w == x.k ? 1 : other, &by[w][static_cast<std::size_t>(cause)]);
    return sum(weighted);
}
const Motions& held(const Subject& x, int cause) {
    return x.response->held[x.k][static_cast<std::size_t>(cause)];
}
const Motions* unheld(const Subject& x, int cause) {
    return x.response->free.empty() ? nullptr
                                    : &x.response->free[x.k][static_cast<std::size_t>(cause)];
}
double without_free(const Subject& x) { return x.response->nothing_resists ? undefined : nan; }

Motions raised(const Subject& x) {
    const auto& travel = x.response->travel;
    const double scale = x.response->tied ? 1 / x.moved_by(travel.front(), x.centre()).z() : 1;
    std::vector<std::pair<double, const Motions*>> weighted;
    for (const Motions& motions : travel) weighted.emplace_back(scale, &motions);
    return sum(weighted);
}
Motions rolled(const Subject& x) {
    std::vector<std::pair<double, const Motions*>> weighted;
    for (std::size_t w = 0; w < x.model.wheels.size(); ++w)
        weighted.emplace_back(x.of(w).side(), &x.response->travel[w]);
    return sum(weighted);
}
double vertical_rate(const Subject& x, int force, const Placed& at, double other) {
    if (x.response->free.empty()) return without_free(x);
    return ratio(1, x.moved_by(of_axle(x.response->free, x, force, other), at).z(), max_stiffness);
}

}  // namespace elastocheck::compare
