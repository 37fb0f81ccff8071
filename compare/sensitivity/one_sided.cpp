#include "compare/sensitivity/one_sided.hpp"

#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {

Model one_sided(Model model, const Corner& corner, int side) {
    const auto continue_piece = [&](ScalarLaw& law) {
        auto& curve = std::get<elastocheck::Curve>(law);
        const std::size_t knot = corner.knot;
        auto c = curve.pieces[side < 0 ? knot : knot + 1];
        // Σ c_n tⁿ as Σ c'_n (t - h)ⁿ: a piece is about the knot at which it begins, the first about
        // that at which it ends
        const double width = knot == 0 ? 0 : curve.knots[knot] - curve.knots[knot - 1],
                     h = side < 0 ? width : -width;
        for (std::size_t from = 0; from + 1 < c.size(); ++from)
            for (std::size_t n = c.size() - 1; n-- > from;) c[n] += h * c[n + 1];
        curve.pieces[side < 0 ? knot + 1 : knot] = c;
    };
    each_member(model.elastics[corner.element].kind,
                overloaded{continue_piece, [&](SpatialLaw& law) {
                               continue_piece(std::get<PerAxis>(law).axis[corner.axis]);
                           }});
    return model;
}

double beyond_knot(const Model& model, const Branch& branch, const Equilibrium& state,
                   const Corner& corner) {
    const ElasticKind& kind = model.elastics[corner.element].kind;
    return deformation(kind, corner.element, branch,
                       state)[static_cast<Eigen::Index>(corner.axis)] -
           curve_of(kind, corner.axis)->knots[corner.knot];
}

}  // namespace elastocheck::compare
