// Branch sides of a model with the model active on each, the distance of two states, and the scenes
// of tests/recursive/found.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "recursive/diagnosis/diagnosis.hpp"

namespace elastocheck::recursive {

struct OneWay {
    Model model;  // active on the branch
    Branch branch;
};

inline std::vector<OneWay> one_ways(const Model& model) {
    std::vector<OneWay> all;
    for (const auto& branch : model.branches)
        for (const auto& way : ways(branch)) all.push_back({on_branch(model, way), way});
    return all;
}

// The scene with this branch alone.
inline OneWay walked(const Scene& scene, const Branch& branch) {
    Scene with = scene;
    with.branches = {branch};
    const Model model = compile(with);
    return {on_branch(model, model.branches[0]), model.branches[0]};
}

inline Model found(const std::string& name) {
    const std::filesystem::path scenes = ELASTOCHECK_SCENES;
    return compile(read_scene(scenes / "../../tests/recursive/found" / (name + ".yaml")));
}

// Largest distance of origins, and of points 0.1 m beside them [m]; for bodies with idle rotation
// origins only.
inline double apart(const Model& model, const Equilibrium& a, const Equilibrium& b) {
    std::vector<bool> idle(model.bodies.size(), false);
    for (const auto& mode : diagnose(model).idle) idle[static_cast<std::size_t>(mode.body)] = true;
    double worst = 0;
    for (std::size_t body = 0; body < idle.size(); ++body)
        worst = std::max({worst, (a.poses[body].r - b.poses[body].r).norm(),
                          idle[body] ? 0 : 0.1 * a.poses[body].p.angularDistance(b.poses[body].p)});
    return worst;
}

}  // namespace elastocheck::recursive
