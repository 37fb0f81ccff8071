// Elements with six components, shared by bushings.cpp and forces.cpp.
#pragma once

#include <array>

#include "models/import/adm/conversion.hpp"
#include "models/import/curves.hpp"

namespace elastocheck::importer::adm {

// Law of the six components of an element, in units of the scene (bushings.cpp).
struct SixLaws {
    Matrix6 K = Matrix6::Zero();
    Vector6 x_0 = Vector6::Zero();      // three lengths, three angles
    Vector6 preload = Vector6::Zero();  // wrench on I at x_0
    std::array<Rows, 6> curves = {};    // restoring force over the component of x; empty: K applies
    std::array<bool, 6> extrapolates = {true, true, true, true, true, true};  // of the curves

    bool is_coupled() const { return !(K - Matrix6(K.diagonal().asDiagonal())).isZero(0); }
};

// Adds the element to the draft. δ is measured from the origin of J, in its axes.
void put_bushing(Conversion& c, const Statement& s, const Marker& I, int part_j, const Frame& J,
                 const SixLaws& laws);

// Converts a stiffness matrix to units of the scene, by blocks: force/length, force, force · length.
Matrix6 in_scene_units(Matrix6 K, const Units& units);
Vector6 wrench_in_scene_units(Vector6 F, const Units& units);

// Replaces K by the mean with its transpose. False if a scene cannot represent it, which is noted.
bool make_symmetric(Conversion& c, const Statement& s, Matrix6& K);

void convert_bushing(Conversion& c, const Statement& s);
void convert_field(Conversion& c, const Statement& s);
void convert_beam(Conversion& c, const Statement& s);

}  // namespace elastocheck::importer::adm
