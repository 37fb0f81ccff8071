// Wheels at points, jacks and tyres of a model, and the force of the road on a wheel.
#pragma once

#include <cstddef>
#include <optional>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::compare {

// The wheel on the point's body or one fixed to it; of several, that with centre or patch nearest to it.
std::optional<std::size_t> wheel_near(const Model& model, const Point& point);
// The wheel whose centre or patch is at this point.
std::optional<std::size_t> wheel_at(const Model& model, const Point& point);
// The wheel that a joint lifts or holds, if it is a jack; the wheel on an element, if it is a tyre.
std::optional<std::size_t> wheel_on_jack(const Model& model, int joint);
std::optional<std::size_t> wheel_on_tyre(const Model& model, int elastic);

// Vertical force of the road on a wheel [N], positive up: of its tyre, its jacks, and forces at its
// centre or contact patch, static ones included. Weights are loads of their bodies, not of the road.
// `undefined` where another force on the wheel's body may be the road's.
double wheel_load(const Model& model, const Branch& branch, const Equilibrium& state,
                  std::size_t wheel);

}  // namespace elastocheck::compare
