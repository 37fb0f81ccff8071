// Mirror symmetry of a scene: entries written for one side are copied to the other side.
//
// The mirror plane is y = 0, S = diag(1, -1, 1). Positions, forces and translations are polar vectors, v' = S
// v; moments and rotations are axial ones, m' = -S m. A right-handed frame A has the right-handed image A' = S
// A S, in whose axes a deformation (d, θ) becomes P (d, θ) with P = diag(S, -S), so that K' = P K P.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "elastocheck/scene.hpp"
#include "models/reader/document/cursor.hpp"

namespace elastocheck::reader {

// An entry with the word `from` in its name has a twin with `to` in its place; all others are shared by
// both sides.
struct Mirror {
    std::string from, to;  // "left", "right"
};

// Reads `left -> right`; some name of the scene must contain the first word.
Mirror read_mirror(const Cursor& field, const Cursor& scene);

// The name with every word `from` replaced by `to`, the name of its twin; none if it lacks the word.
// "arm_left" becomes "arm_right"; "leftover" has no twin.
std::optional<std::string> mirrored_name(const Mirror& mirror, std::string_view name);

// Whether the name has the word `to`: that of a twin.
bool is_twin(const Mirror& mirror, std::string_view name);

// mirrored_name() of an entry of the section; an error if the section defines the twin itself.
std::optional<std::string> twin_name(const Mirror& mirror, const std::string& name,
                                     const Cursor& section);

// Rejects an entry of the section that both sides share but that is attached to one side only.
struct Definitions;
void require_both_sides(const Cursor& section, const Definitions& defs);

// ---- Twins of parts, attached to the twins of their bodies.
//
// Equal values of a driven quantity on both sides are a symmetric motion: the axis of a revolute or
// cylindrical joint, about which its angle is measured, is mirrored as an axial vector.
Vector3 reflected(const Vector3& v);  // S v
Vector6 reflected(const Vector6& v);  // P v
JointKind twin(const JointKind& joint, const Definitions& defs);
ElasticKind twin(const ElasticKind& elastic, const Definitions& defs);
LoadKind twin(const LoadKind& load, const Definitions& defs);
Wheel twin(const Wheel& wheel, const Definitions& defs);
Point twin(const Point& point, const Definitions& defs);

}  // namespace elastocheck::reader
