// Motions and bodies by name: the body that moves most, the bodies that cannot move.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "recursive/diagnosis/diagnosis.hpp"

namespace elastocheck::recursive {

// The motion dq [6nb] of the bodies at these poses, named by the body that it moves most.
IdleMode motion_of(const Model& model, const std::vector<Pose>& poses, const Eigen::VectorXd& dq,
                   double length);

// Bodies that redundant joints leave no motion: "body 'arm' cannot move: the joints 'arm_front' and
// 'arm_rear' lock it". A held rack does not move either, and its joints are not redundant.
std::vector<std::string> locked_bodies(const Model& model, const Diagnosis& diagnosis);

}  // namespace elastocheck::recursive
