#include "compare/sensitivity/one_sided.hpp"

#include <array>

#include "compare/outputs/dual.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

elastocheck::Curve& curve_at(Model& model, const Corner& corner) {
    elastocheck::Curve* found = nullptr;
    const auto take = [&](ScalarLaw& law) { found = &std::get<elastocheck::Curve>(law); };
    each_member(
        model.elastics[corner.element].kind,
        overloaded{take, [&](SpatialLaw& law) { take(std::get<PerAxis>(law).axis[corner.axis]); }});
    return *found;
}

using Coefficients = std::array<Dual, 4>;

// Σ c_n tⁿ as Σ c'_n (t - h)ⁿ.
Coefficients shifted(Coefficients c, const Dual& h) {
    for (std::size_t from = 0; from + 1 < c.size(); ++from)
        for (std::size_t n = c.size() - 1; n-- > from;) c[n] += h * c[n + 1];
    return c;
}

// The continued piece, with its derivatives by those of the curve.
Coefficients continued(const elastocheck::Curve& u, const elastocheck::Curve& d, std::size_t knot,
                       int side) {
    const auto at = [&](std::size_t k) { return Dual(u.knots[k], d.knots[k]); };
    const std::size_t from = side < 0 ? knot : knot + 1;
    Coefficients c;
    for (std::size_t n = 0; n < c.size(); ++n) c[n] = {u.pieces[from][n], d.pieces[from][n]};
    // a piece is about the knot at which it begins, the first about that at which it ends
    const Dual width = knot == 0 ? Dual(0) : at(knot) - at(knot - 1);
    return shifted(c, side < 0 ? width : -width);
}

}  // namespace

Model one_sided(Model model, const Corner& corner, int side) {
    elastocheck::Curve& curve = curve_at(model, corner);
    const Coefficients c = continued(curve, curve, corner.knot, side);
    auto& piece = curve.pieces[side < 0 ? corner.knot + 1 : corner.knot];
    for (std::size_t n = 0; n < c.size(); ++n) piece[n] = c[n].x;
    return model;
}

Model one_sided_rate(Model rate, const Model& model, const Corner& corner, int side) {
    Model of = model;
    elastocheck::Curve& curve = curve_at(rate, corner);
    const Coefficients c = continued(curve_at(of, corner), curve, corner.knot, side);
    auto& piece = curve.pieces[side < 0 ? corner.knot + 1 : corner.knot];
    for (std::size_t n = 0; n < c.size(); ++n) piece[n] = c[n].dx;
    return rate;
}

}  // namespace elastocheck::compare
