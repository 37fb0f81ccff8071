// Beams, as chains of bushings between bodies at their nodes.
//
// ---- One segment.
//
// A straight beam of length L along x, its ends fixed to bodies i and j: small displacements u, rotations θ of the ends.
// In the plane xy a Timoshenko beam without loads between its ends has two ways to store energy:
//
//   constant moment   κ = θ_jz - θ_iz, a pure bend                             ½ (EI_z/L) κ²
//   constant shear    δ = u_jy - u_iy - ½ L (θ_iz + θ_jz), what is left of      ½ 12EI_z/(L³(1 + φ_y)) δ²
//                     the rise of the chord over the mean of the end slopes     φ_y = 12EI_z/(G A_y L²)
//
// (the shear force V bends both halves like cantilevers of L/2, δ = V (2 (L/2)³/(3EI_z) + L/(G A_y)), and the two are
// orthogonal: in the second the moment is odd about the middle, in the first it is even.) Now carry both ends by rigid
// arms to the middle of the length: there i stands at u_iy + ½ L θ_iz and j at u_jy - ½ L θ_jz, so that their
// distance is d_y = δ, and their angle is κ. The same holds in the plane xz, with θ_y the other way round, and for
// stretch and twist. A bushing in the middle, with
//
//   K = diag( EA/L,  12EI_z/(L³(1 + φ_y)),  12EI_y/(L³(1 + φ_z)),  GJ/L,  EI_y/L,  EI_z/L )
//
// is therefore the beam's 12×12: for one, ∂²U/∂θ_iz² = EI_z/L + (L/2)² 12EI_z/(L³(1 + φ_y)) = (4 + φ_y) EI_z/((1 + φ_y) L).
//
// For finite motions its frame is the one in the middle of both (Formulation::Frame::middle), which favours neither
// end; it has an energy, and a rigid motion costs none. What is left out is of higher order in κ and δ and falls as
// 1/n² with n segments. Under an end moment M each turns by κ = M L/(EI), exactly, and the nodes lie on a circle of
// radius ½ L / tan(½ κ), too small by κ²/12.
//
// An axial force N stretches the arms' ends towards each other's line. To second order in the ends' angles in the plane xy,
// with φ = ½ (θ_iz + θ_jz) their mean and without what N does by its stretch, a straight segment under N stores
//
//   ½ k_y δ² + N φ δ + ½ N L φ² + (½ k_r + ⅛ N L) κ²,     k_y = 12EI_z/(L³(1 + φ_y)), k_r = EI_z/L
//
// where a beam has no N φ δ: δ = -N φ/k_y follows, and takes the share N/(k_y L) off the stiffness ½ N L φ² that tension
// gives (and adds as much to what compression takes). So a segment is a beam while
//
//   |N| << k_y L = 12EI_z/(L²(1 + φ_y)),
//
// the error of its geometric stiffness is that quotient, 1/n² again, and no straight chain is unstable under tension
// below it. Above it may be: one cantilever of a single segment is at N = (12 + √192) EI_z/L² = 25.9 EI_z/L².
#pragma once

#include "models/reader/cursor.hpp"
#include "models/reader/definitions.hpp"
#include "models/scene.hpp"

namespace elastocheck::reader {

// Adds the bodies at the nodes inside each beam: "NAME.1", "NAME.2", ... from its first end on. The one at a hardpoint
// that the beam goes through is known as "NAME.HARDPOINT" as well. With a mirror they have twins like other bodies;
// those of a beam that both sides share, and that is its own image, have each other.
void add_beam_bodies(const Cursor& scene, Definitions& defs);

// Adds the segments: "NAME.1" from the first end to the first node, and so on.
void read_beams(const Cursor& scene, const Definitions& defs, std::vector<Elastic>& elastics);

}  // namespace elastocheck::reader
