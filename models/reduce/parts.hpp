// The parts of a scene, for the passes that make it smaller: what they refer to, what they are at the design
// position, and how some are taken out.
#pragma once

#include <string>
#include <vector>

#include "models/overloaded.hpp"
#include "models/scene.hpp"

namespace elastocheck::reduce {

// ---- Every point, direction and marker of a part, each given to f(Point&), f(Direction&), f(Marker&). i comes first,
// then j.

template <class F>
void each_place(JointKind& joint, F f) {
    const auto all = [&](auto&... places) { (f(places), ...); };
    std::visit(
        overloaded{[&](Spherical& s) { all(s.i, s.j); },
                   [&](Revolute& s) { all(s.i, s.j, s.axis_i, s.axis_j); },
                   [&](Universal& s) { all(s.i, s.j, s.axis_i, s.axis_j); },
                   [&](Cylindrical& s) { all(s.i, s.j, s.axis_i, s.axis_j); },
                   [&](Translational& s) { all(s.i, s.j, s.axis_i, s.axis_j); },
                   [&](Planar& s) { all(s.i, s.j, s.normal_i, s.normal_j); },
                   [&](Fixed& s) { all(s.i, s.j, s.x_i, s.y_i, s.x_j, s.y_j); },
                   [&](Distance& s) { all(s.i, s.j); }, [&](InPlane& s) { all(s.i, s.j, s.normal_j); },
                   [&](InLine& s) { all(s.i, s.j, s.axis_j); }, [&](Perpendicular& s) { all(s.i, s.j); },
                   [&](Parallel& s) { all(s.i, s.j); }, [&](Angle& s) { all(s.i, s.j, s.y_j); }},
        joint);
}
template <class F>
void each_place(ElasticKind& elastic, F f) {
    std::visit([&](auto& e) { f(e.i), f(e.j); }, elastic);
}

// Every body that an output reads, ground among them, given to f(BodyId&), of a const Scene f(const BodyId&).
template <class S, class F>
void each_output_body(S& scene, F f) {
    for (auto& wheel : scene.wheels) {
        f(wheel.body);
        if (wheel.steering_axis) f(wheel.steering_axis->lower.body), f(wheel.steering_axis->upper.body);
    }
    for (auto& probe : scene.probes) f(probe.at.body);
    for (auto& damper : scene.dampers) f(damper.i.body), f(damper.j.body);
}

struct Ends {
    BodyId i, j;
};
Ends ends(const JointKind& joint);
Ends ends(const ElasticKind& elastic);
BodyId body_of(const LoadKind& load);

// What some branch drives or holds, or the trim adjusts.
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

inline constexpr double as_drawn = 1e-12;  // [m], or of a unit vector: round-off of what is drawn equal

Pose design(const Scene& scene, BodyId body);
Eigen::Vector3d position(const Scene& scene, const Point& p);
Eigen::Vector3d direction(const Scene& scene, const Direction& u);

// Whether a length, offset or angle of the joint is other than drawn, so that something moves before any load does.
bool is_strained_at_design(const JointKind& joint, const Scene& scene);
// Whether the element has a force. One whose markers are apart, or turned, is taken to have one.
bool is_loaded_at_design(const ElasticKind& elastic, const Scene& scene);

bool is_zero(const LoadKind& load);
bool is_zero(const ElasticKind& elastic);  // no law and no preload

// ---- Taking out.

std::string named(const char* kind, const std::string& name);  // "body 'arm'"
void leave_out(Scene& scene, const std::string& what, const std::string& why);

// What stays; all of it to begin with.
struct Kept {
    explicit Kept(const Scene& scene)
        : bodies(scene.bodies.size(), true),
          joints(scene.joints.size(), true),
          elastics(scene.elastics.size(), true) {}
    std::vector<bool> bodies, joints, elastics;
};

// Takes out the rest, which the caller has named in left_out, and what is attached to a body that goes: joints,
// elements and loads, each named here. Drivers of what goes, go with it; all else keeps to what it spoke of.
// Pre: no output reads a body that goes.
void keep_only(Scene& scene, Kept kept);

}  // namespace elastocheck::reduce
