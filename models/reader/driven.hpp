// What a branch may drive or hold, and the joints that this needs.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "models/reader/cursor.hpp"
#include "models/reader/definitions.hpp"
#include "models/scene.hpp"

namespace elastocheck::reader {

// One quantity, counted from what the file says it is at the design position.
struct Drivable {
    ParameterUnit kind;
    Unit unit;                   // in which values of it are written
    Driven what;                 // a Motion of no joint yet where the joint has still to be made
    double factor = 1;           // of `what` per SI unit of the quantity
    std::optional<Joint> joint;  // to make when it is first driven
};

// All of them under their names in the file, and why other joints and elements are not among them.
struct Drivables {
    std::map<std::string, Drivable> table;
    std::map<std::string, std::string> not_driven;
};

// The constraint that holds the free coordinate of a joint, for those that have one that can be held, called
// "NAME.drive":
//   translational           displacement of i relative to j along the axis: InPlane across the axis, i and j the
//                           joint's own points
//   revolute, cylindrical   angle of i relative to j about the axis, right-handed: Angle, with x_j any direction
//                           across the axis, y_j = axis × x_j, and x_j's design direction on body i
std::optional<Joint> drive_of(const Joint& joint);

// The elements that the file has names for, by their position in Scene::elastics.
struct NamedElement {
    std::string path;      // "springs.coil"
    bool is_twin = false;  // made by the mirror: its preload is driven along the mirror images of its axes
};
using NamedElements = std::map<int, NamedElement>;

// `drives` are the positions of the drives that stand already, of held joints.
Drivables drivables(const Scene& scene, const Units& units, const std::map<int, int>& drives,
                    const NamedElements& elements);

// The quantity called `name`, its joint made if need be. `at` is where the file names it.
const Drivable& drivable(const Cursor& at, const std::string& name, Drivables& drivables, Scene& scene);

// Whether two drivers move the same number. Loads, and preloads along different axes, add up.
bool is_same(const Driven& a, const Driven& b);

// Adds a joint whose name must be free.
int add_joint(const Cursor& at, const Joint& joint, Scene& scene);

}  // namespace elastocheck::reader
