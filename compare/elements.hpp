// What bushings, springs, stops, tyres, beams and links are deformed by and bear, each in its own axes: compare/'s own
// evaluation, of the states of any leg.
//
//   spring, stop     NAME.deflection = ℓ₀ - ℓ       NAME.force = -f(ℓ - ℓ₀)        both positive in compression
//   bushing, beam    NAME.displacement_x, ...       NAME.elastic_force_x, ...      e - e₀ = (d, θ) - e₀ of body j against i,
//                    NAME.rotation_x, ...           NAME.elastic_moment_x, ...     frame axes; s = ∂u/∂e + preload
//   torsion spring   NAME.angle                     NAME.moment                    the same about its axis
//   tyre             NAME.deflection                NAME.force                     both positive where it is pressed flat
//   link             NAME.axial_force               of every joint that keeps two points apart, positive in tension
//
// ℓ₀ and the preload are those of the branch at state.load, with what it drives. A positive s pulls j back, as a preload does.
// The force times the change of what stands beside it is the work done on the element, at deformations of any size: of large
// rotations s is therefore what does work on θ, not the moment's components. Without `conjugate` s are the components along
// the axes.
//
// They are no channels(model): a scene of a thousand beams would keep twelve thousand curves.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/channels.hpp"
#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::compare {

// In the order of the elements, then the links. Where two elements share a name and an output, the second's name is
// "NAME#2". No name is that of one of channels(model): bushings and joints may share theirs.
std::vector<Channel> element_channels(const Model& model);

// Their values, and those of any other channels; of a tyre that does not stand on the branch, NaN.
std::vector<double> evaluate(const Model& model, const Branch& branch, std::span<const Channel> channels,
                             const Equilibrium& state);

// ---- At the ends of the branches.

struct Comparison;

// One output of one element at one end of a branch.
struct ElementValue {
    std::string branch;
    double a = 0;  // the parameter there, in `a_unit`
    Unit a_unit = Unit::newton;
    std::string element, output;  // "lower_front", "lower_front.elastic_force_x"
    Unit unit = Unit::newton;
    double value = 0;  // of the equilibrium leg
    double off = 0;    // recursion less that
    double share = 0;  // of it; NaN where it is nothing
};

// Of branches that go both ways both ends; none where a leg did not come as far.
std::vector<ElementValue> element_values(const Model& model, const Comparison& comparison);

}  // namespace elastocheck::compare
