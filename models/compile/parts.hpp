// Helpers of the reduction passes: traverse, inspect and remove the parts of a scene.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "elastocheck/scene.hpp"
#include "models/kinds.hpp"

namespace elastocheck::reduce {

// Calls f(BodyId&) (const Scene: f(const BodyId&)) for every body that an output reads, ground included.
template <class S, class F>
void each_output_body(S& scene, F f) {
    for (auto& wheel : scene.wheels) {
        f(wheel.body), f(wheel.contact.body);
        if (wheel.steering_axis)
            f(wheel.steering_axis->lower.body), f(wheel.steering_axis->upper.body);
    }
    for (auto& probe : scene.probes) f(probe.at.body);
    for (auto& damper : scene.dampers) f(damper.i.body), f(damper.j.body);
}

// Calls f for every input that a branch drives or the trim adjusts.
template <class F>
void each_driven(const Scene& scene, F f) {
    for (const Branch& branch : scene.branches)
        for (const Driver& driver : branch.drivers) f(driver.what);
    if (!scene.trim) return;
    for (const Trim::Adjustment& adjustment : scene.trim->adjust) f(adjustment.what);
}
struct DrivenParts {
    std::vector<bool> joints, elastics;  // by position in the scene
};
DrivenParts driven_parts(const Scene& scene);

// ---- At the design position.

// Tolerance for equality at the design position: of positions [m] and of components of unit vectors.
inline constexpr double design_tolerance = 1e-12;

Pose design(const Scene& scene, BodyId body);
Vector3 position(const Scene& scene, const Point& p);
Vector3 direction(const Scene& scene, const Direction& u);

// Whether the joint's length, offset or angle differs from the design position, so that bodies move
// without load.
bool is_strained_at_design(const JointKind& joint, const Scene& scene);
// Whether the element has a force. A bushing whose markers do not coincide counts as loaded.
bool is_loaded_at_design(const ElasticKind& elastic, const Scene& scene);

bool is_zero(const LoadKind& load);
bool is_zero(const ElasticKind& elastic);  // no law and no preload

// ---- Removal.

std::string named(const char* kind, const std::string& name);  // "body 'arm'"
std::string named(const Scene& scene, BodyId body);            // the same, or "ground"
// Adds an entry to Scene::omitted.
void leave_out(Scene& scene, const std::string& what, const std::string& why);

// Flags of the parts that stay, initially all true.
struct Kept {
    explicit Kept(const Scene& scene)
        : bodies(scene.bodies.size(), true),
          joints(scene.joints.size(), true),
          elastics(scene.elastics.size(), true) {}
    std::vector<bool> bodies, joints, elastics;
};

// Removes the joints and elements, by position, for which a reason is returned (empty: it stays).
void drop_parts(Scene& scene, const std::function<std::string(std::size_t)>& why_joint,
                const std::function<std::string(std::size_t)>& why_elastic);

// Removes the parts that are not kept, which the caller has listed in Scene::omitted, and the joints,
// elements and loads attached to a removed body, which this function lists. Drivers of removed parts
// are removed, other references renumbered. Pre: no output reads a removed body.
void keep_only(Scene& scene, Kept kept);

}  // namespace elastocheck::reduce
