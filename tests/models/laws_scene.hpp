// Fixture: a scene around given elements.
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "elastocheck/read_scene.hpp"

namespace elastocheck {

// `elements` are whole sections. The body `arm` has its origin at o; p is 50 mm from o along x, t
// 400 mm above.
inline std::string laws_scene(const std::string& elements,
                              const std::string& units = "length: mm, angle: deg, force: N",
                              const std::string& branch = "load: push, to: 10, steps: 1") {
    return "elastocheck: 1\nname: laws\nunits: {" + units + "}\n" + R"(points:
  o: [0, 0, 0]
  p: [50, 0, 0]
  t: [50, 0, 400]
bodies: {arm: {origin: o}}
joints: {ball: {type: spherical, bodies: [arm, ground], at: o}}
)" + elements +
           R"(
loads: {push: {on: arm, at: p, force: [0, 0, 1]}}
branches: {up: {)" +
           branch + R"(}}
probes: {tip: {on: arm, at: p}}
)";
}

inline Scene laws(const std::string& elements) {
    return parse_scene(laws_scene(elements), "laws.yaml");
}

// A spring between p and t, 400 mm apart.
inline std::string spring_with(const std::string& fields) {
    return "springs:\n  coil: {bodies: [arm, ground], from: p, to: t, " + fields + "}";
}

// A section of every kind that may contain a curve.
inline const std::string every_law =
    spring_with(
        "curve: {table: [[-50, -900], [0, 0], [50, 1400]], scale: 1.1, offset: 2}, preload: 300, "
        "bump_stop: {clearance: 9, rate: 70}") +
    R"(
stops:
  end: {bodies: [arm, ground], from: p, to: t, rebound: {clearance: 9, curve: {table: [[0, 0], [5, 70]], outside: unknown}}}
torsion_springs:
  bar: {bodies: [arm, ground], at: p, axis: [p, t], curve: {table: [[0, 0], [9, 40]], symmetric: true}, preload_moment: 6}
bushings:
  mount: {bodies: [arm, ground], at: p, rates: [1, 2, 3], curves: {x: {table: [[-1, -2], [0, 0], [1, 7]]}}, undeformed: [1, 2, 3],
          formulation: {frame: j, angles: cardan, conjugate: false, offset_moment: false}}
static_loads:
  drag: {on: arm, at: p, force: [1, 2, 3], follows: true})";

template <class T>
T element(const Scene& scene, const std::string& name) {
    for (const auto& elastic : scene.elastics)
        if (elastic.name == name) return std::get<T>(elastic.kind);
    throw std::out_of_range(name);
}

}  // namespace elastocheck
