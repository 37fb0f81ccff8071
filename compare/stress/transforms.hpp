// Invariance transforms of a scene (rotation, mirror, body order, body axes, units), and scenes
// made larger, stiffer or driven farther by data alone.
#pragma once

#include <functional>
#include <vector>

#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

// Rigid motion of the whole scene: everything rotated by R and translated by t; ground frame,
// bodies, loads.
Scene moved(const Scene& scene, const Eigen::Quaterniond& R, const Eigen::Vector3d& t);

// The same bodies in other body axes: the axes of body b are rotated by turns[b % size].
Scene with_body_axes(const Scene& scene, const std::vector<Eigen::Quaterniond>& turns);

// Mirror image, y → -y: the other side of the vehicle.
Scene mirrored(const Scene& scene);

// Bodies, joints and elements in reverse order.
Scene reversed(const Scene& scene);

// Change of units: every length times `length`, every force times `force`, hence moments times
// both, rates times force / length, rotational rates times force · length, branch parameters by
// their unit.
Scene scaled(const Scene& scene, double length, double force);

// Visits every number of a scene in a fixed order; of a symmetric matrix the entries above its
// diagonal follow those below.
void for_each_number(Scene& scene, const std::function<void(double&)>& visit);

// Every nonzero number replaced by the next double above or below, in a reproducible way.
Scene an_ulp_off(const Scene& scene);

// Forces and moments of the law of an element times `factor`, without its preload.
Elastic stiffened(Elastic element, double factor);

// Rotational rates of every bushing times `factor`; in a full matrix the coupling terms by its
// square root.
Scene with_rotational_rates(const Scene& scene, double factor);

}  // namespace elastocheck::compare
