// A scene: what the user asked. One YAML file (scene_file.hpp), or built in code.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/mechanism.hpp"

namespace elastocheck {

// A named way out from the design position: f_ext(a) = static loads + a · (sum of `loads`), a from 0 to `to`
// in `steps` equal increments. The paper's example is two branches, to +3000 and to -3000, 300 steps each.
struct Branch {
    std::string name;
    std::vector<Load> loads;  // per unit of the load factor a
    double to = 0;            // final load factor [N] (or [N·m] for a pure moment)
    int steps = 0;            // the step count of the published sweep; each step is to / steps
};

struct Wheel {
    BodyId body = ground;
    Eigen::Vector3d centre_local = Eigen::Vector3d::Zero();  // [m]
    Eigen::Vector3d contact_local =
        Eigen::Vector3d::Zero();  // contact patch at the design pose, a point of the body [m]
    Eigen::Vector3d spin_axis_local = Eigen::Vector3d::UnitY();  // unit, pointing outboard
    int side = +1;                                               // +1 left, -1 right
};

// A body point whose position is an output, for scenes that are not suspensions.
struct Probe {
    std::string name;
    Point at;
};

// A named position of the design, ground axes [m]. For drawings; no leg sees it.
struct Hardpoint {
    std::string name;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

struct Scene {
    std::string name;
    std::string source;  // file it was read from, empty when built in code
    std::vector<Hardpoint> hardpoints;
    std::vector<Body> bodies;
    std::vector<Joint> joints;
    std::vector<Elastic> elastics;
    std::vector<Load> static_loads;  // present at every load factor, zero included
    std::vector<Branch> branches;
    std::optional<Wheel> wheel;
    std::vector<Probe> probes;
};

}  // namespace elastocheck
