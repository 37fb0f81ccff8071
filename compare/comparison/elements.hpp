// Deformation and force of bushings, springs, stops, tyres, beams and links in their own axes:
// compare/'s own evaluation, for the states of any leg.
//
//   spring, stop     NAME.deflection = ℓ₀ - ℓ   NAME.force = -f(ℓ - ℓ₀)     positive in compression
//   bushing, beam    NAME.displacement_x, ...   NAME.elastic_force_x, ...   e - e₀ = (d, θ) - e₀,
//                    NAME.rotation_x, ...       NAME.elastic_moment_x, ...  s = ∂u/∂e + preload;
//                                               body j against i, frame axes
//   torsion spring   NAME.angle                 NAME.moment                 the same about its axis
//   tyre             NAME.deflection            NAME.force                 positive when compressed
//   link             NAME.axial_force           joints that fix a distance, positive in tension
//
// ℓ₀ and the preload include the driven part of the branch at state.load. A positive s pulls j
// back, as a preload does. Force and deformation are work-conjugate at any size of deformation: for
// large rotations s is conjugate to θ and differs from the components of the moment. Without
// `conjugate`, s are the components along the axes.
//
// They are not part of channels(model): a scene of a thousand beams would store twelve thousand
// curves.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/compare.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::compare {

// In the order of the elements, then the links. Where two elements share a name and an output, the
// second is named "NAME#2". No name equals one of channels(model): bushings and joints may share
// theirs.
std::vector<Channel> element_channels(const Model& model);

// Values of these and any other channels; NaN for a tyre that is inactive on the branch.
std::vector<double> evaluate(const Model& model, const Branch& branch,
                             std::span<const Channel> channels, const Equilibrium& state);

// ---- Largest values over the points of a branch.

// Collects the largest force and the largest moment of each element and link, in the order of the
// elements, then the links.
struct LargestForces {
    LargestForces(const Model& of_model, const Branch& of_branch);
    void add(const Equilibrium& state);
    std::vector<LargestForce> list() const;  // without those that are always zero

    const Model* model;
    const Branch* branch;
    std::vector<Channel> channels = {};   // forces and moments
    std::vector<std::size_t> entry = {};  // of each channel, in `largest`
    std::vector<LargestForce> largest = {};
};

// ---- Values at the ends of the branches.

// One output of one element at one end of a branch.
struct ElementValue {
    std::string branch;
    double a = 0;  // parameter at that end, in `a_unit`
    Unit a_unit = Unit::newton;
    std::string element, output;  // "lower_front", "lower_front.elastic_force_x"
    Unit unit = Unit::newton;
    double value = 0;  // of the equilibrium leg
    double off = 0;    // recursion minus equilibrium leg
    double share = 0;  // `off` relative to `value`; NaN where `value` is zero to rounding
};

// Both ends of a two-sided branch; no values where a leg did not reach the end.
std::vector<ElementValue> element_values(const Model& model, const Comparison& comparison);

}  // namespace elastocheck::compare
