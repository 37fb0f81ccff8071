// Kinematics and compliance characteristics (K&C test) from a state and its response.
//
// Each is an exact rate at the state by the tangent of the leg that found it, never a difference of
// two points. Each has one definition with its sign, in characteristics.cpp. All have the same
// value for a wheel and for its mirror image.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison/compliance.hpp"
#include "elastocheck/channels.hpp"

namespace elastocheck::compare {

// Characteristics of a model, as outputs beside channels(model), none of them a main output; empty
// without a wheel.
std::vector<Channel> characteristics(const Model& model);
// The same figures by other definitions, "wheel_rate@patch" (compare/definitions/rates.cpp).
std::vector<Channel> characteristics_otherwise(const Model& model);

// Value of one characteristic in SI; `undefined` where it has none (Channel::undefined gives the
// meaning), NaN where the leg failed to compute the response.
double value_of(const Model& model, const Characteristic& what, const Equilibrium& state,
                const WheelResponse& response);

// Whether it reads WheelResponse::free.
bool needs_free(const Characteristic& what);

// A swing arm, endless where two links are parallel: compared by its reciprocal.
bool is_swing_arm(const Characteristic& what);

// ---- Compliance.

// Compliance matrix of the wheels, ground axes [6 × 6 per wheel]: rows are the displacement of the
// point [m] and the rotation [rad], columns the force at the point [N] and the moment [N·m], wheel
// by wheel; jacks and tyres removed. Empty where a wheel moves without resistance.
enum class WheelPoint { centre, patch };
Eigen::MatrixXd compliance(const Model& model, WheelPoint point, const Equilibrium& state,
                           const WheelResponse& response);

// Reciprocity error |C - Cᵀ| / |C|, both the largest entry, lengths divided by the tyre radius (1 m
// where patch and centre coincide). Zero where all forces have a potential and the state is in
// equilibrium, up to the moments that the state carries.
double reciprocity(const Model& model, const Eigen::MatrixXd& C);

// An entry in display units: mm or deg per kN or per 100 N·m. And the name of a row: "contact
// patch, left displacement x".
double in_table_units(const Eigen::MatrixXd& C, Eigen::Index row, Eigen::Index column);
std::string compliance_row_name(const Model& model, const std::string& point, Eigen::Index row);

}  // namespace elastocheck::compare
