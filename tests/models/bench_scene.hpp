// Fixture: a scene with all kinds of parts, for tests that modify it.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace elastocheck {

inline const std::string bench_scene = R"(elastocheck: 1
name: Bench
units: {length: mm, angle: deg, force: N}

points:
  middle: [0, 0, 0]
  front: [100, 0, 0]
  side: [0, 100, 0]
  top: [0, 0, 100]
  again: [0, 0, 0]

bodies:
  arm: {origin: middle}
  hub: {origin: front}

joints:
  ball: {type: spherical, bodies: [arm, hub], at: front}
  cross: {type: universal, bodies: [arm, hub], at: front, axis_i: x, axis_j: y}
  rod: {type: distance, bodies: [hub, ground], from: front, to: side}

springs:
  coil: {bodies: [hub, ground], from: front, to: top, rate: 30, preload: 300}

bushings:
  mount: {bodies: [arm, ground], at: middle, frame: {x: [middle, front]}, rates: [1, 2, 2], rotational_rates: [3, 4, 4]}
  block:
    bodies: [arm, ground]
    at: middle
    stiffness:
      - [100, 0, 0, 0, 5, 0]
      - [0, 100, 0, 0, 0, 0]
      - [0, 0, 100, 0, 0, 0]
      - [0, 0, 0, 50, 0, 0]
      - [5, 0, 0, 0, 50, 0]
      - [0, 0, 0, 0, 0, 50]

static_loads:
  weight: {on: hub, at: front, force: [0, 0, -300]}

loads:
  push: {on: hub, at: front, force: [0, 0, 1]}
  twist: {on: hub, moment: [0, 0, 1]}
  nil: {on: hub, at: front, force: [0, 0, 0]}

branches:
  up: {load: [push, twist], to: 1000, steps: 10}

wheel: {body: hub, centre: front, contact_patch: side, spin_axis: y, side: left}
probes:
  tip: {on: hub, at: front}
)";

// `text` with the only occurrence of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from << " is not in the text";
    EXPECT_EQ(text.find(from, at + 1), std::string::npos) << from << " is there twice";
    if (at != std::string::npos) text.replace(at, from.size(), to);
    return text;
}

}  // namespace elastocheck
