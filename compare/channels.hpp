// Outputs: what is read off a configuration, the same for every leg and independent of all of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::compare {

// Engineering units from here on: mm, deg, N, N·m.
enum class Unit { mm, deg, newton, newton_metre };
const char* symbol(Unit unit);

struct Channel {
    std::string name;  // "toe", "wheel_centre_y", "tip_z", "tie_rod.force_x"
    Unit unit = Unit::mm;
    bool main = true;  // false: joint reactions, kept out of the short tables
    int joint = -1;    // of a reaction: position in Model::joints
};

// The channels of a model, in order:
//   wheel_centre_x, _y, _z   position of the wheel centre, ground axes
//   toe      = atan2(e_x, side·e_y), positive toe-in            e = unit spin axis pointing outboard
//   camber   = -asin(e_z), positive when the top leans out      side = +1 left, -1 right; per wheel, never the
//                                                               axle total
//   PROBE_x, _y, _z                position of a probe
//   JOINT.force_x ... moment_z     wrench of a joint on its first body, about the joint's point, ground axes
std::vector<Channel> channels(const Model& model);

// Their values at one equilibrium, same order.
std::vector<double> evaluate(const Model& model, const Equilibrium& state);

// One leg's outputs along one branch.
struct Curve {
    std::vector<double> load;                 // load factor, as asked
    std::vector<double> travel;               // [mm]; empty where a branch has no travel
    std::vector<std::vector<double>> values;  // [point][channel]
};

// Travel: displacement of the wheel centre (or the first probe) since load factor 0, along the resultant
// force of the branch. For a vertical load that is wheel travel. A branch of moments alone has none.
Curve curve(const Model& model, const Branch& branch, const std::vector<Equilibrium>& points);

// Unit vector of the resultant force of a branch; none for moments alone.
std::optional<Eigen::Vector3d> travel_direction(const Branch& branch);

}  // namespace elastocheck::compare
