// Elements with six components, shared by bushings.cpp and forces.cpp.
#pragma once

#include <array>

#include "models/import/adm/conversion.hpp"
#include "models/import/curves.hpp"

namespace elastocheck::importer::adm {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Laws of one element, in units of the scene.
struct SixLaws {
    Matrix6 K = Matrix6::Zero();
    Vector6 x_0 = Vector6::Zero();      // length, angles
    Vector6 preload = Vector6::Zero();  // on I at x_0
    std::array<Rows, 6> curves = {};    // restoring force over x; empty: use K
    std::array<bool, 6> goes_on = {true, true, true, true, true, true};

    bool is_coupled() const { return !(K - Matrix6(K.diagonal().asDiagonal())).isZero(0); }
};

// δ is measured from the origin of J, in its axes.
void put_bushing(Conversion& c, const Statement& s, const Marker& I, int part_j, const Frame& J,
                 const SixLaws& laws);

// Converts a stiffness matrix to units of the scene, by blocks: force/length, force,
// force · length.
Matrix6 in_scene_units(Matrix6 K, const Units& units);
Vector6 wrench_in_scene_units(Vector6 F, const Units& units);

// Replaces K by the mean with its transpose. False if a scene cannot represent it, which is noted.
bool make_symmetric(Conversion& c, const Statement& s, Matrix6& K);

void convert_bushing(Conversion& c, const Statement& s);
void convert_field(Conversion& c, const Statement& s);
void convert_beam(Conversion& c, const Statement& s);

}  // namespace elastocheck::importer::adm
