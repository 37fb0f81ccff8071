// Random configurations of the recursion.
#pragma once

#include <vector>

#include "elastocheck/mechanism.hpp"
#include "recursive/formula/state.hpp"
#include "tests/support/builders.hpp"

namespace elastocheck::recursive {

struct Random : support::Random {
    State<double> state(int bodies, double angle = 3) {
        std::vector<Pose> poses;
        poses.reserve(static_cast<std::size_t>(bodies));
        for (int b = 0; b < bodies; ++b) poses.push_back(pose(angle));
        return state_of<double>(poses);
    }
};

}  // namespace elastocheck::recursive
