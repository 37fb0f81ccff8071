// The same scene told otherwise: what must not matter to any solver. And a scene made larger, stiffer, or driven farther,
// by data alone.
#pragma once

#include <functional>
#include <vector>

#include "models/scene.hpp"

namespace elastocheck::compare {

// Everything turned by R and moved by t: ground frame, bodies, loads.
Scene moved(const Scene& scene, const Eigen::Quaterniond& R, const Eigen::Vector3d& t);

// The same bodies described in other body axes: body b's axes are turned by turns[b % size].
Scene with_body_axes(const Scene& scene, const std::vector<Eigen::Quaterniond>& turns);

// y → -y: the other side of the vehicle.
Scene mirrored(const Scene& scene);

// Bodies, joints and elements in reverse order.
Scene reversed(const Scene& scene);

// Every length times `length`, every force times `force`, and with them moments times both, rates times force / length,
// rotational rates times force · length, the parameters of the branches by their unit: the same numbers in other units.
Scene scaled(const Scene& scene, double length, double force);

// Every number that a scene is made of, one after the other, always in the same order; of what is symmetric each once.
void for_each_number(Scene& scene, const std::function<void(double&)>& visit);

// Every number that is not zero the next double above or below, the same way each time.
Scene an_ulp_off(const Scene& scene);

// The forces and moments that the law of an element gives, times `factor`. Not its preload.
Elastic stiffened(Elastic element, double factor);

// What resists rotation alone, times `factor`: of every bushing; of a full matrix also what couples, by the square root.
Scene with_rotational_rates(const Scene& scene, double factor);

}  // namespace elastocheck::compare
