// Fixture: a mirrored axle scene with every kind of joint, drives, and named wheels.
#pragma once

#include <string>

namespace elastocheck {

inline const std::string axle_head =
    "elastocheck: 1\nname: axle\nunits: {length: mm, angle: deg, force: N}\n";

// All kinds of parts, with general directions. The shared body `rack` has its origin off the mirror
// plane.
inline const std::string axle_scene = axle_head + R"(mirror: left -> right
points:
  arm_front_left: [220, 520, -156]
  arm_rear_left: [-300, 507, -137]
  ball_left: [-21, 940, -174]
  top_left: [-115, 785, 579]
  lower_left: [-74, 853, 248]
  tie_inner_left: [-300, 520, -59]
  tie_outer_left: [-237, 895, -16]
  wheel_left: [-40, 1100, -26]
  contact_left: [-40, 1100, -346]
  rack: [-300, 10, -59]
bodies:
  arm_left: {origin: ball_left}
  hub_left: {origin: wheel_left}
  rack: {origin: rack}
joints:
  ball_left: {type: spherical, bodies: [arm_left, hub_left], at: ball_left}
  arm_left: {type: revolute, bodies: [arm_left, ground], at: arm_front_left, axis: [arm_rear_left, arm_front_left]}
  tube_left: {type: cylindrical, bodies: [hub_left, ground], at: lower_left, axis: [1, 2, 3]}
  slot_left: {type: translational, bodies: [hub_left, arm_left], at: top_left, axis: [1, 2, 3]}
  cross_left: {type: universal, bodies: [hub_left, rack], at: tie_outer_left, axis_i: [0, 3, 4], axis_j: x}
  flat_left: {type: planar, bodies: [hub_left, rack], at: tie_outer_left, normal: [1, 1, 5]}
  weld_left: {type: fixed, bodies: [hub_left, arm_left], at: wheel_left}
  tie_left: {type: distance, bodies: [hub_left, rack], from: tie_outer_left, to: tie_inner_left, length: 377}
  pad_left: {type: in_plane, bodies: [hub_left, ground], at: contact_left, normal: [1, 1, 0]}
  line_left: {type: in_line, bodies: [hub_left, rack], at: contact_left, axis: [1, 1, 0]}
  square_left: {type: perpendicular, bodies: [hub_left, arm_left], axis_i: [0, 3, 4], axis_j: x}
  same_left: {type: parallel, bodies: [hub_left, arm_left], axis: [3, 2, 1]}
  guide: {type: translational, bodies: [rack, ground], at: rack, axis: y, held: true}
springs:
  coil_left: {bodies: [hub_left, ground], from: lower_left, to: top_left, rate: 28, preload: 3500}
bushings:
  mount_left: {bodies: [arm_left, ground], at: arm_rear_left, frame: {x: [1, 2, 3], z: [0, -1, 5]},
    rates: [1, 2, 3], rotational_rates: [4, 5, 6], preload: [7, 8, 9], preload_moment: [10, 11, 12]}
  block_left:
    bodies: [arm_left, rack]
    at: arm_front_left
    stiffness:
      - [100, 1, 2, 3, 4, 5]
      - [1, 100, 6, 7, 8, 9]
      - [2, 6, 100, 1, 2, 3]
      - [3, 7, 1, 9000, 4, 5]
      - [4, 8, 2, 4, 9000, 6]
      - [5, 9, 3, 5, 6, 9000]
static_loads:
  weight_left: {on: hub_left, at: wheel_left, force: [1, 2, -400]}
  torque_left: {on: hub_left, moment: [1, 2, 3]}
loads:
  push_left: {on: hub_left, at: contact_left, force: [-1, 2, 3]}
  twist_left: {on: hub_left, moment: [1, 2, 3]}
branches:
  roll: {load: {push_left: 1, push_right: -1, twist_right: 2}, to: 1000, steps: 10}
  steer: {drive: joints.guide, to: 60, steps: 6, hold: {left.travel: 30, right.travel: -10}}
  lift: {drive: [joints.arm_left, joints.arm_right], to: 9, steps: 6}
  trim: {drive: {bushings.mount_left.preload.y: 1, bushings.mount_right.preload.y: 1}, to: 9, steps: 6}
wheels:
  left: {body: hub_left, centre: wheel_left, contact_patch: contact_left, spin_axis: [0.1, 1, 0.02], side: left, steering_axis: [ball_left, {on: arm_left, at: top_left}]}
probes:
  tip_left: {on: arm_left, at: ball_left}
dampers:
  damper_left: {bodies: [hub_left, rack], from: lower_left, to: top_left}
vehicle: {wheelbase: 2700, cg_height: 550, axle: front, brake_share: 0.7, drive_share: 0.25}
)";

}  // namespace elastocheck
