// Scenes of models/scenes for the tests of the equilibrium leg, and a load of 1 N or 1 N·m.
#pragma once

#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "tests/support/builders.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using namespace support;

inline Branch pull(const Point& at, const Vector3d& f) { return load_branch(DeadForce{at, f}, 1); }
inline Branch twist(BodyId body, const Vector3d& m) { return load_branch(DeadMoment{body, m}, 1); }

}  // namespace elastocheck::reference::equilibrium::test
