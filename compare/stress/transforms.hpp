// Invariance transforms of a scene (rotation, mirror image, translation, units),
// and changed stiffness.
#pragma once

#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

// A point at p moves to  length · M p + t; every force is multiplied by `force`, hence moments by
// both, rates by force / length, rotational rates by force · length, branch parameters
// by their unit.
struct Transform {
    Eigen::Matrix3d M = Eigen::Matrix3d::Identity();  // a rotation or a mirror image
    Eigen::Vector3d t = Eigen::Vector3d::Zero();      // [m]
    double length = 1, force = 1;
};
Scene transformed(const Scene& scene, const Transform& how);

// Forces and moments of the law of an element times `factor`, without its preload.
Elastic stiffened(Elastic element, double factor);

// Rotational rates of every bushing times `factor`; in a full matrix the coupling terms by its
// square root.
Scene with_rotational_rates(const Scene& scene, double factor);

}  // namespace elastocheck::compare
