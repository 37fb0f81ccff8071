// Quantities that a branch may drive or hold, and the joints that this requires.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "elastocheck/scene.hpp"
#include "models/reader/definitions/definitions.hpp"
#include "models/reader/document/cursor.hpp"

namespace elastocheck::reader {

// One quantity, relative to its value in the file at the design position.
struct Drivable {
    ParameterUnit kind;
    Unit unit;                   // unit of its values in the file
    Driven what;                 // a Motion of joint -1 until the joint is created
    double factor = 1;           // change of `what` per SI unit of the quantity
    std::optional<Joint> joint;  // to be created when the quantity is first driven
    std::string drives = {};     // of the hand wheel: name of the quantity that it drives
};

// All such quantities by their names in the file, and why other joints and elements cannot be driven.
struct Drivables {
    std::map<std::string, Drivable> table;
    std::map<std::string, std::string> not_driven;
};

// The constraint that holds the free coordinate of a joint, named "NAME.drive"; none for joints without
// exactly one coordinate that can be driven:
//   translational           displacement of i relative to j along the axis: InPlane across the
//                           axis, i and j the joint's own points
//   revolute, cylindrical   angle of i relative to j about the axis, right-handed: Angle, with x_j
//                           any direction across the axis, y_j = axis × x_j, and x_j's design
//                           direction on body i
std::optional<Joint> drive_of(const Joint& joint);

// Elements with a name in the file, by their position in Scene::elastics.
struct NamedElement {
    std::string path;      // "springs.coil"
    bool is_twin = false;  // created by the mirror: its preload is driven along the mirrored axes
};
using NamedElements = std::map<int, NamedElement>;

// All drivable quantities of the scene. `drives`: the drives that exist already, of held joints, as
// joint -> drive (positions in Scene::joints).
Drivables drivables(const Scene& scene, const Units& units, const std::map<int, int>& drives,
                    const NamedElements& elements);

// The quantity called `name`; creates its joint if needed. Throws SceneError at `field` for a name that
// cannot be driven.
const Drivable& drivable(const Cursor& field, const std::string& name, Drivables& drivables,
                         Scene& scene);

// Whether two drivers change the same number. Loads, and preloads along different axes, add up.
bool is_same(const Driven& a, const Driven& b);

// Adds a joint and returns its position. Throws SceneError at `field` if its name is in use.
int add_joint(const Cursor& field, const Joint& joint, Scene& scene);

}  // namespace elastocheck::reader
