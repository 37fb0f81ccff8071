// Kinks of the force curves in a model, and on which side of each kink a configuration lies.
//
// A curve is smooth between two knots. At a knot either the rate (slope of the force) jumps, which
// is a kink and happens where a stop closes, or the slope of the rate jumps, as in an interpolated
// table. Methods with equal steps step across knots. They must not compare two steps with a kink
// between them, because the second step has another tangent.
#pragma once

#include <cmath>

#include "recursive/formula/elastic.hpp"

namespace elastocheck::recursive {

struct CurvePlace {
    std::size_t element = 0;  // position in Model::elastics
    std::size_t axis = 0;     // of its law
    const Curve* curve = nullptr;
    bool angle = false;         // whether the deflection is an angle [rad], else a length [m]
    std::vector<double> kinks;  // the knots where the slope jumps
};

// Knots at which the slopes of the adjacent pieces differ by more than rounding.
inline std::vector<double> kinks_of(const Curve& f) {
    std::vector<double> kinks;
    for (std::size_t k = 0; k < f.knots.size(); ++k) {
        const double before = piece_of<double>(f, f.knots[k], static_cast<Piece>(k)).slope(),
                     behind = piece_of<double>(f, f.knots[k], static_cast<Piece>(k + 1)).slope();
        if (!(std::abs(behind - before) <= 1e-6 * std::max(std::abs(before), std::abs(behind))))
            kinks.push_back(f.knots[k]);
    }
    return kinks;
}

inline std::vector<CurvePlace> curves_of(const Model& model) {
    std::vector<CurvePlace> all;
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        each_curve(model.elastics[k].kind, [&](std::size_t axis, const Curve& curve) {
            all.push_back({k, axis, &curve, axis >= 3, kinks_of(curve)});
        });
    return all;
}

// The argument of the curve at q and these inputs, [m] or [rad].
inline double deflection(const Model& model, const Inputs<double>& inputs, const State<double>& q,
                         const CurvePlace& at) {
    return deflections<double>(model.elastics[at.element].kind, inputs.rest[at.element],
                               q)[static_cast<int>(at.axis)];
}

// Side of every kink: per curve, the number of kinks at or below its deflection. Fills `sides` and
// returns whether any changed. Allocates nothing.
bool find_sides(const Model& model, const Inputs<double>& inputs, const State<double>& q,
                const std::vector<CurvePlace>& curves, std::vector<int>& sides);

}  // namespace elastocheck::recursive
