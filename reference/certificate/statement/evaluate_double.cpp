// Instantiations of evaluate.hpp for doubles; geometry and slopes of deformations.
#include "reference/certificate/statement/evaluate.hpp"

namespace elastocheck::reference::certificate {

template Values<double> evaluate_without_slopes(const System&, const std::vector<double>&,
                                                const double&);
template Values<double> evaluate(const System&, const std::vector<double>&, const double&, Slopes);
template std::vector<JointWrench<double>> wrenches(const System&, const std::vector<double>&,
                                                   const double&);
template std::vector<JointWrench<double>> unit_wrenches(const System&, int,
                                                        const std::vector<double>&, const double&);

Geometry geometry(const System& system, const std::vector<double>& z, double a) {
    Assembly<double> sum{system, z, a, {}};
    sum.fixed_forces = true;
    sum.force_sizes.assign(static_cast<std::size_t>(system.bodies), 0);
    assemble<double, Dual<double, 8>, Dual<double, 15>>(sum, Slopes::yes);
    return {std::move(sum.out.J), std::move(sum.force_sizes)};
}

Eigen::MatrixXd deformation_slopes(const System& system, std::size_t element,
                                   const std::vector<double>& z, double a) {
    using T = Dual<double, 15>;
    const Assembly<double> assembly{system, z, a, {}};
    const ElementPath& path = system.elements[element];
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(6, 7 * system.bodies);
    std::visit(
        [&](const auto& kind) {
            const Slots slots{kind.i.body, kind.j.body};
            const auto i = assembly.template frame<T>(slots.i, slots.at_i()),
                       j = assembly.template frame<T>(slots.j, slots.at_j());
            const std::array<T, 6> e = assembly.deformations_at(kind, path, i, j, true);
            for (std::size_t k = 0; k < 6; ++k)
                for (std::size_t q = 0; q < 7; ++q) {
                    const auto row = static_cast<Eigen::Index>(k),
                               column = static_cast<Eigen::Index>(q);
                    if (slots.i != ground)
                        slopes(row, system.pose(slots.i) + column) =
                            e[k].d.at(static_cast<std::size_t>(slots.at_i()) + q);
                    if (slots.j != ground)
                        slopes(row, system.pose(slots.j) + column) =
                            e[k].d.at(static_cast<std::size_t>(slots.at_j()) + q);
                }
        },
        system.model->elastics[element].kind);
    return slopes;
}

}  // namespace elastocheck::reference::certificate
