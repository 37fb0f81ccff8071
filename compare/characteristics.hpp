// Kinematics and compliance: what a K&C test tells of a suspension, read from a state and how it answers.
//
// Each is a rate at the state, exact by the tangent of whoever found it, never a difference between points; each has its
// definition, with its sign, in one place (characteristics.cpp). All of them are the same for a wheel and its mirror image.
#pragma once

#include <string>
#include <vector>

#include "compare/answers.hpp"
#include "compare/channels.hpp"

namespace elastocheck::compare {

// The characteristics of a model, as outputs beside channels(model), none of them a main one; empty without a wheel.
std::vector<Channel> characteristics(const Model& model);

// The value of one, SI; `undefined` where it has none (Channel::undefined says what that means), NaN where the leg that was
// asked had no answer.
double value_of(const Model& model, const Characteristic& what, const Equilibrium& state,
                const Answers& answers);

// ---- Compliance.

// How far the wheels give per unit of what acts on them, ground axes [6 × 6 a wheel]: rows displacement of the point
// [m] and rotation [rad], columns force at the point [N] and moment [N·m], wheel by wheel; jacks and tyres gone.
// Empty where nothing resists.
enum class WheelPoint { centre, patch };
Eigen::MatrixXd compliance(const Model& model, WheelPoint point, const Equilibrium& state,
                           const Answers& answers);

// |C - Cᵀ| over |C|, both the largest entry, lengths counted by the tyre's radius (1 m where patch and centre are one):
// zero where what acts has an energy and the state is in equilibrium, up to the moments that it holds.
double reciprocity(const Model& model, const Eigen::MatrixXd& C);

// An entry as it is shown: mm or deg per kN or per 100 N·m; and what a row is: "contact patch, left displacement x".
double in_table_units(const Eigen::MatrixXd& C, Eigen::Index row, Eigen::Index column);
std::string answer_name(const Model& model, const std::string& point, Eigen::Index row);

}  // namespace elastocheck::compare
