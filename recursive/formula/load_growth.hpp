// Second homotopy of settling: forces that grow from zero.
//
// From the design position the first homotopy (settle.hpp) lets go of the imbalance as dead forces and moments. Its path may
// turn back or end at an unstable equilibrium. Here elements store nothing as drawn, no load acts at t = 0, and both grow
// with t, in the elements' own axes: other drivers of the branch, so that every method follows it as it stands. Of several
// equilibria it may reach another than the first homotopy would: points that are reached so carry no error bound.
#pragma once

#include <optional>

#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

struct Grown {
    Model
        model;  // without static loads; linear springs and bushings without force in the design position
    Branch branch;  // what the model lacks, as further drivers with start and without rate
};

// The same equations as (model, branch) at t = 1, whatever a. Nothing where nothing would grow: then the first homotopy is
// this one. Springs with a curve keep their force as drawn.
std::optional<Grown> grown(const Model& model, const Branch& branch);

}  // namespace elastocheck::recursive
