// Quantities prescribed by the parameter of a branch: loads, joint offsets, free lengths, preloads;
// and by the settling homotopy: gaps of constraints and strengths of laws.
//
// All of them are p(a) = start + rate · a, so ∂p/∂a = rate is a set of prescribed values too. The
// two functions of (x, a) of this leg are V and Φ; their ∂/∂a follow from `rate` by the chain rule
// (gradient_rate in potential.hpp, constraint_rates in constraints.hpp).
#pragma once

#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck::reference::energy {

struct Prescribed {
    std::vector<DeadForce> forces;    // on bodies only: a force on ground does no work
    std::vector<DeadMoment> moments;  // likewise
    std::vector<BrakeForce> brakes;   // likewise, on their carriers
    Eigen::VectorXd offset;           // added to length, offset, angle of each constraint [m, rad]
    // added to the free length of each spring, to the undeformed d_z of each bushing [m]
    Eigen::VectorXd free_length;
    Eigen::Matrix<double, 6, Eigen::Dynamic>
        preload;               // added to that of each element [N, N·m]; row 0 of springs
    Eigen::VectorXd gap;       // Φ = gap instead of Φ = 0, row by row [m]
    Eigen::VectorXd strength;  // s - 1, s the factor of each element's law

    // Whether loads act that have a potential only at the centre of a chart (chart.hpp), and an
    // unsymmetric stiffness.
    bool has_unsymmetric_stiffness() const { return !moments.empty() || !brakes.empty(); }
};

// No loads, all other quantities as in the model.
Prescribed nothing_prescribed(const Model& model);

struct Course {  // of a branch: p(a) = start + rate · a
    Prescribed start, rate;
};

// Static loads and the driven quantities.
Course course_of(const Model& model, const Branch& branch);

Prescribed at(const Course& course, double a);  // start + rate · a

// f + factor · g, their dead loads concatenated.
Prescribed sum(const Prescribed& f, double factor, const Prescribed& g);

}  // namespace elastocheck::reference::energy
