// What the parameter of a branch prescribes: loads, offsets of joints, free lengths, preloads.
//
// All of it is p(a) = start + rate · a, so that ∂p/∂a = rate is a set of prescribed values like any other.
// The two functions of (x, a) that this leg owns are V and Φ; their ∂/∂a follow from `rate` by the chain rule
// (gradient_rate in potential.hpp, constraint_rates in constraints.hpp).
#pragma once

#include <vector>

#include "models/model.hpp"

namespace elastocheck::reference::energy {

struct Prescribed {
    std::vector<DeadForce> forces;    // on bodies only: a force on ground does no work
    std::vector<DeadMoment> moments;  // likewise
    Eigen::VectorXd offset;           // added to the length, offset [m] or angle [rad] of each constraint
    Eigen::VectorXd free_length;      // added to the free length of each element [m]
    Eigen::Matrix<double, 6, Eigen::Dynamic>
        preload;          // added to that of each element [N, N·m]; row 0 of springs
    Eigen::VectorXd gap;  // Φ = gap instead of Φ = 0, row by row [m]
};

// No loads, and everything else as the model has it.
Prescribed nothing_prescribed(const Model& model);

struct Course {
    Prescribed start, rate;
};

// Static loads and what the drivers hold and move.
Course course_of(const Model& model, const Branch& branch);

Prescribed at(const Course& course, double a);  // start + rate · a

// f + factor · g, their dead loads side by side.
Prescribed sum(const Prescribed& f, double factor, const Prescribed& g);

}  // namespace elastocheck::reference::energy
