// Sides of the branches of a model, the distance of two states, and the scenes of tests/recursive/found (regressions) and
// tests/recursive/scenes.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "models/branch.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "tests/support/scene_text.hpp"

namespace elastocheck::recursive {

struct SideModel {
    Model model;  // active on the branch
    Branch branch;
};

inline std::vector<SideModel> all_sides(const Model& model) {
    std::vector<SideModel> all;
    for (const auto& branch : model.branches)
        for (const auto& way : branch_sides(branch)) all.push_back({on_branch(model, way), way});
    return all;
}

// The scene with this branch alone.
inline SideModel walked(const Scene& scene, const Branch& branch) {
    Scene with = scene;
    with.branches = {branch};
    const Model model = compile(with);
    return {on_branch(model, model.branches[0]), model.branches[0]};
}

inline Model found(const std::string& name, const std::vector<Setting>& settings = {}) {
    return compile(support::scene_of("recursive/found/" + name, settings));
}
inline Model model_of(const std::string& name, const std::vector<Setting>& settings = {},
                      Detail detail = Detail::required) {
    return compile(support::scene_of("recursive/scenes/" + name, settings), detail);
}

// Bodies that an idle mode moves: their position along it is arbitrary.
inline std::vector<bool> idle_bodies(const Model& model, const Diagnosis& diagnosis) {
    std::vector<bool> idle(model.bodies.size(), false);
    for (const auto& mode : diagnosis.idle)
        for (std::size_t b = 0; b < idle.size(); ++b)
            if (mode.dq.segment<6>(6 * static_cast<Eigen::Index>(b)).norm() > 1e-6) idle[b] = true;
    return idle;
}

// Largest distance of origins, and of points 0.1 m beside them [m]; for bodies with idle rotation
// origins only.
inline double distance(const Model& model, const Equilibrium& a, const Equilibrium& b) {
    const auto idle = idle_bodies(model, diagnose(model));
    double worst = 0;
    for (std::size_t body = 0; body < idle.size(); ++body)
        worst = std::max({worst, (a.poses[body].r - b.poses[body].r).norm(),
                          idle[body] ? 0 : 0.1 * a.poses[body].p.angularDistance(b.poses[body].p)});
    return worst;
}

}  // namespace elastocheck::recursive
