// Maps a state of any leg to the unknowns z of the certificate, and distances in poses and wrenches
// to a box around z.
#pragma once

#include "reference/certificate/certificate.hpp"
#include "reference/certificate/statement/bordered.hpp"

namespace elastocheck::reference::certificate {

struct StateAt {
    const System& system;
    const Equilibrium& state;
    // [n]: poses as given, and the reactions R by least squares from the wrenches; as doubles, so
    // near the state and not exactly the state
    Eigen::VectorXd z;
    // P per joint, R = P w: from its wrench w to its reactions [rows × 6]
    std::vector<Eigen::MatrixXd> from_wrench;
};

// Throws std::invalid_argument unless the state has one pose per body and one wrench per joint.
StateAt state_at(const System& system, const Equilibrium& state);

// Radii δ [n] of a box z ± δ that contains every z whose poses and joint wrenches are within `near`
// of the state; infinite for reactions that the wrench of their joint does not determine.
Eigen::VectorXd radii(const StateAt& mapped, const Tolerance& near);

// Upper bound of the distance of any point of the box z from the state.
Extent distance(const StateAt& mapped, const std::vector<Interval>& z);
// Whether some joint wrench is farther from that of the state than `near` at every point of the
// box.
bool has_wrench_apart(const StateAt& mapped, const std::vector<Interval>& z, const Tolerance& near);

bool is_within(const Extent& extent, const Tolerance& tolerance);
std::string as_text(const Extent& extent);  // "1 mm, 2 deg, 3 N and 4 N·m"

// Upper bounds of U μ (bordered.hpp), given those of |μ|: of the wrench that holds idle motions and
// of the gap of redundant rows.
struct Held {
    double held = 0;  // [N, N·m]
    double gap = 0;   // [m, rad]
};
Held held_by(const System& system, const Border& border, const Eigen::VectorXd& mu);
// Both bounds in words, with `as_in` for the gauge: "idle motion of 'strut' as in the state, held
// by at most 1e-9 N or N·m"; empty without idle motions and redundant rows.
std::string statement(const System& system, const Border& border, const Held& held,
                      const char* as_in);

}  // namespace elastocheck::reference::certificate
