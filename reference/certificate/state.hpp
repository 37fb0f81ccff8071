// Maps a state of any leg to the unknowns, and a distance in poses and wrenches to a box.
#pragma once

#include "reference/certificate/certificate.hpp"
#include "reference/certificate/statement/bordered.hpp"

namespace elastocheck::reference::certificate {

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
Eigen::VectorXd radii(const StateAt& at, const Tolerance& near);

// Upper bound of the distance of a box from the state; and whether its whole box is outside `near`
// in some wrench.
Extent distance(const StateAt& at, const std::vector<Interval>& z);
bool wrenches_apart(const StateAt& at, const std::vector<Interval>& z, const Tolerance& near);

bool within(const Extent& far, const Tolerance& tolerance);
std::string as_text(const Extent& far);  // "1 mm, 2 deg, 3 N and 4 N·m"

// Upper bounds of the wrench that holds idle motions and of the gap of redundant rows, from those
// of |μ|; and their statement, with the load sharing and the positions `as_in` a state or states.
struct Held {
    double held = 0, gap = 0;
};
Held held_by(const System& system, const Border& border, const Eigen::VectorXd& mu);
std::string statement(const System& system, const Border& border, const Held& held,
                      const char* as_in);

}  // namespace elastocheck::reference::certificate
