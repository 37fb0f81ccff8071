// Timoshenko beams as chains of bushings between bodies at their nodes.
//
// ---- One segment.
//
// A straight beam of length L along x, its ends fixed to bodies i and j: small displacements u, rotations θ of
// the ends. In the plane xy a Timoshenko beam without loads between its ends has two deformation modes:
//
//   constant moment   κ = θ_jz - θ_iz, pure bending                     ½ (EI_z/L) κ²
//   constant shear    δ = u_jy - u_iy - ½ L (θ_iz + θ_jz), the rise     ½ 12EI_z/(L³(1 + φ_y)) δ²
//                     of the chord minus the mean of the end slopes     φ_y = 12EI_z/(G A_y L²)
//
// (the shear force V bends both halves like cantilevers of L/2, δ = V (2 (L/2)³/(3EI_z) + L/(G A_y)), and the
// two modes are orthogonal: in the second the moment is odd about the middle, in the first it is even.) Extend
// both ends by rigid arms to the middle of the length: there i is at u_iy + ½ L θ_iz and j at u_jy - ½ L θ_jz,
// so that their distance is d_y = δ, and their angle is κ. The same holds in the plane xz, with θ_y of opposite
// sign, and for stretch and twist. A bushing in the middle, with
//
//   K = diag( EA/L,  12EI_z/(L³(1 + φ_y)),  12EI_y/(L³(1 + φ_z)),  GJ/L,  EI_y/L,  EI_z/L )
//
// is therefore the beam's 12×12 matrix: for example
// ∂²U/∂θ_iz² = EI_z/L + (L/2)² 12EI_z/(L³(1 + φ_y)) = (4 + φ_y) EI_z/((1 + φ_y) L).
//
// For finite motions its frame is halfway between both ends (Formulation::Frame::middle), which treats both
// ends alike. It has an energy, and a rigid motion costs none. The error is of higher order in κ and δ and
// falls as 1/n² with n segments. Under an end moment M each segment rotates by κ = M L/(EI), exactly, and the
// nodes lie on a circle of radius ½ L / tan(½ κ), too small by κ²/12.
//
// An axial force N pulls the ends of the arms towards each other's line. To second order in the
// ends' angles in the plane xy, with φ = ½ (θ_iz + θ_jz) their mean and without the stretch energy
// of N, a straight segment under N stores
//
//   ½ k_y δ² + N φ δ + ½ N L φ² + (½ k_r + ⅛ N L) κ²,     k_y = 12EI_z/(L³(1 + φ_y)), k_r = EI_z/L
//
// A beam has no term N φ δ. The term gives δ = -N φ/k_y, which reduces the tension stiffness ½ N L φ² by the
// fraction N/(k_y L) (and increases the loss under compression likewise). So a segment is a valid beam while
//
//   |N| << k_y L = 12EI_z/(L²(1 + φ_y)),
//
// the error of its geometric stiffness is that quotient, again 1/n², and no straight chain is
// unstable under tension below that force. Above it a chain may be: one cantilever of a single
// segment is unstable at N = (12 + √192) EI_z/L² = 25.9 EI_z/L².
#pragma once

#include "models/reader/definitions/definitions.hpp"
#include "models/reader/document/cursor.hpp"

namespace elastocheck::reader {

// Adds the bodies at the inner nodes of each beam: "NAME.1", "NAME.2", ... from its first end on. A node at a
// hardpoint of the beam is also named "NAME.HARDPOINT". With a mirror these bodies have twins like others; if
// both sides share the beam and it is its own mirror image, its bodies are twins of each other.
void add_beam_bodies(const Cursor& scene, Definitions& defs);

// Adds the segments: "NAME.1" from the first end to the first node, and so on.
void read_beams(const Cursor& scene, const Definitions& defs, std::vector<Elastic>& elastics);

}  // namespace elastocheck::reader
