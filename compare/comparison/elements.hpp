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
// large rotations s is conjugate to θ and differs from the components of the moment. For a
// Formulation that is not `conjugate`, s are the components along the axes.
//
// These outputs are not part of channels(model): a thousand beams would have twelve thousand curves.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/compare.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/legs.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::compare {

// Outputs of the elements in their order, then of the links. Where two elements share a name and an
// output, the second is named "NAME#2". No name equals one of channels(model): bushings and
// joints may share theirs.
std::vector<Channel> element_channels(const Model& model);
// Name of the element or link of such a channel: "lower_front".
std::string element_of(const Channel& channel);

// Largest |value| that is rounding [mm, deg, N, N·m].
inline constexpr double zero_value = 1e-6;

// Values of element channels and any others, in their units; NaN for an element that is inactive on
// the branch.
std::vector<double> evaluate(const Model& model, const Branch& branch,
                             std::span<const Channel> channels, const Equilibrium& state);
struct Analyses;  // compliance.hpp
// The same values on a branch side; `undefined` for reactions that the loads do not determine, since redundant
// joints share them: those that are not zero in a self-stress of the joints
// (recursive/diagnosis/self_stress.hpp).
std::vector<double> evaluate(const Model& model, const BranchSide& side,
                             std::span<const Channel> channels, const Equilibrium& state,
                             Analyses& analyses);

// Whether a channel is `undefined` at a point of the curve.
bool is_undefined_somewhere(std::size_t channel, const Curve& curve);
// Reason why a channel can be `undefined`.
std::string why_undefined(const Channel& channel);

// Sums of the reactions of redundant joints (totals()), on any branch of the model.
std::vector<Channel> sums(const Model& model);

// For each channel, whether the joints that it reads have constraints in `side_model`, the model of a branch
// side.
std::vector<bool> active_channels(std::span<const Channel> channels, const Model& side_model);

// ---- Largest values over the points of a branch.

// Collects the largest force and the largest moment of each element and link, in the order of the
// elements, then the links.
struct LargestForces {
    LargestForces(const Model& of_model, const BranchSide& on_side);
    void add(const Equilibrium& state);
    std::vector<LargestForce> list() const;  // those that are not always zero

    const Model* model;
    const BranchSide* side;
    std::shared_ptr<Analyses> analyses;
    std::vector<Channel> channels = {};   // forces and moments
    std::vector<std::size_t> entry = {};  // position in `largest` of each channel
    std::vector<LargestForce> largest = {};
};

}  // namespace elastocheck::compare
