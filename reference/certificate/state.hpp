// A state, from any leg, among the unknowns: where it lies, and which box holds all that is as near to it as is said.
#pragma once

#include "reference/certificate/bordered.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::reference::certificate {

// What is near a state: every origin, orientation and wrench within these.
struct Near {
    double length = 0, angle = 0, force = 0, moment = 0;
};

struct StateAt {
    const System& system;
    const Equilibrium& state;
    Eigen::VectorXd z;                         // [n], the nearest doubles; reactions by least squares
    std::vector<Eigen::MatrixXd> from_wrench;  // per joint, P: reactions of its wrench [rows × 6]
};

// Throws std::invalid_argument where the state has not one pose a body and one wrench a joint.
StateAt state_at(const System& system, const Equilibrium& state);

// Radii about `state.z` of a box that holds every z whose poses and joint wrenches are near the state: infinite for
// reactions that the wrench of their joint does not determine.
Eigen::VectorXd radii(const StateAt& at, const Near& near);

// How far the states of a box are from the state, at most; and whether all of them are farther than `near` in a wrench.
Extent distance(const StateAt& at, const std::vector<Interval>& z);
bool wrenches_apart(const StateAt& at, const std::vector<Interval>& z, const Near& near);

}  // namespace elastocheck::reference::certificate
