// Instantiations of evaluate.hpp for intervals; deformations.
#include "reference/certificate/statement/evaluate.hpp"

namespace elastocheck::reference::certificate {

template Values<Interval> evaluate_without_slopes(const System&, const std::vector<Interval>&,
                                                  const Interval&);
template Values<Interval> evaluate(const System&, const std::vector<Interval>&, const Interval&,
                                   Slopes);
template Values<Interval> residual(const System&, const std::vector<Interval>&, const Interval&);
template std::vector<JointWrench<Interval>> wrenches(const System&, const std::vector<Interval>&,
                                                     const Interval&);
template std::vector<JointWrench<Interval>> unit_wrenches(const System&, int,
                                                          const std::vector<Interval>&,
                                                          const Interval&);

std::vector<std::array<Interval, 6>> deformations(const System& system,
                                                  const std::vector<Interval>& z,
                                                  const Interval& a) {
    const Assembly<Interval> at{system, z, a, {}};
    std::vector<std::array<Interval, 6>> all;
    for (std::size_t e = 0; e < system.elements.size(); ++e)
        all.push_back(std::visit(
            [&](const auto& kind) {
                return at.deformations_at(kind, system.elements[e],
                                          at.frame<Interval>(kind.i.body, 0),
                                          at.frame<Interval>(kind.j.body, 0));
            },
            system.model->elastics[e].kind));
    return all;
}

}  // namespace elastocheck::reference::certificate
