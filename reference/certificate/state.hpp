// Maps a state of any leg to the unknowns, and a distance in poses and wrenches to a box.
#pragma once

#include "reference/certificate/certificate.hpp"
#include "reference/certificate/statement/bordered.hpp"

namespace elastocheck::reference::certificate {

// Neighbourhood of a state: bounds for every origin, orientation and wrench.
struct Near {
    double length = 0, angle = 0, force = 0, moment = 0;
};

struct StateAt {
    const System& system;
    const Equilibrium& state;
    Eigen::VectorXd z;  // [n], the nearest doubles; reactions by least squares
    // per joint, P: from its wrench to its reactions [rows × 6]
    std::vector<Eigen::MatrixXd> from_wrench;
};

// Throws std::invalid_argument unless the state has one pose per body and one wrench per joint.
StateAt state_at(const System& system, const Equilibrium& state);

// Radii about `state.z` of a box that contains every z whose poses and joint wrenches are near the
// state; infinite for reactions that the wrench of their joint does not determine.
Eigen::VectorXd radii(const StateAt& at, const Near& near);

// Upper bound of the distance of a box from the state; and whether its whole box is outside `near`
// in some wrench.
Extent distance(const StateAt& at, const std::vector<Interval>& z);
bool wrenches_apart(const StateAt& at, const std::vector<Interval>& z, const Near& near);

}  // namespace elastocheck::reference::certificate
