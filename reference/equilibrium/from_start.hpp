// Equilibria off the branch: what Newton's method comes to from a start that is none, and where to start from.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck::reference::equilibrium {

struct FromStart {
    Outcome outcome = Outcome::
        converged;  // else iteration_limit, singular, not_finite; branch_lost: it leads to one that is known
    Equilibrium state = {};  // where it converged
    double stiffness =
        std::numeric_limits<double>::quiet_NaN();  // the least of what is free and resisted, scaled
    bool stable =
        false;  // it is above zero by more than its round-off; against divergence alone where there is
                // no energy (stability.hpp)
};

// The equilibrium at a that the poses lead to, and none of those that are `known` at this a. Bodies go anywhere on the way:
// what comes out is an equilibrium of the stored model, not one of the branch.
//
// Throws as `solve` does, and std::invalid_argument where `start` or what is known has not one pose a body.
FromStart solve_from(const Model& model, const Branch& branch, double a, const std::vector<Pose>& start,
                     std::span<const Equilibrium> known = {}, const Options& options = {});

// Poses beside an equilibrium: to both sides along each of its softest free motions, as far as `lengths` say, which are
// shares of the model's size [or of a radian]. Idle motions are left out, and so are models of more than a hundred bodies.
std::vector<std::vector<Pose>> beside(const Model& model, const Branch& branch, const Equilibrium& state,
                                      int motions, std::span<const double> lengths);

// How far two states are apart, as pose_size measures it: shares of the model's size, radians; what is idle at `a` left
// out.
double apart(const Model& model, const Branch& branch, const Equilibrium& a, const Equilibrium& b);

}  // namespace elastocheck::reference::equilibrium
