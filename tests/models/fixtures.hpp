// The scenes in tests/models/fixtures as text, and scenes made of them.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <variant>

#include "elastocheck/read_scene.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/mistakes.hpp"

namespace elastocheck {

using support::replaced;

inline std::string fixture(const std::string& name) {
    return support::text_of(std::filesystem::path(ELASTOCHECK_FIXTURES) / (name + ".yaml"));
}

// All kinds of parts; a mirrored axle with every kind of joint, drives and named wheels, its shared
// body `rack` with its origin off the mirror plane.
inline const std::string bench_scene = fixture("bench"), axle_scene = fixture("axle");

template <class T>
T element(const Scene& scene, const std::string& name) {
    for (const auto& elastic : scene.elastics)
        if (elastic.name == name) return std::get<T>(elastic.kind);
    throw std::out_of_range(name);
}

// A scene around `elements`, which are whole sections. The body `arm` has its origin at o; p is 50
// mm from o along x, t 400 mm above.
inline std::string laws_scene(const std::string& elements,
                              const std::string& units = "length: mm, angle: deg, force: N",
                              const std::string& branch = "load: push, to: 10, steps: 1") {
    const std::string text = replaced(fixture("laws"), "length: mm, angle: deg, force: N", units);
    return replaced(replaced(text, "load: push, to: 10, steps: 1", branch), "# elements", elements);
}

inline Scene laws(const std::string& elements) {
    return parse_scene(laws_scene(elements), "laws.yaml");
}

// A spring between p and t, 400 mm apart.
inline std::string spring_with(const std::string& fields) {
    return "springs:\n  coil: {bodies: [arm, ground], from: p, to: t, " + fields + "}";
}

}  // namespace elastocheck
