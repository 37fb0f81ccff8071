// Warnings about a settled state that is valid and far from that of a car: numbers in another unit,
// with the other sign, or missing. What needs no state is in models/reader/plausibility.hpp.
#pragma once

#include <string>
#include <vector>

#include "elastocheck/model.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

struct Implausible {
    std::vector<std::string> place;  // keys in the scene file: {"springs", "coil"}
    std::string what;                // "toe 48.6 deg at rest, plausible: -10 to 10; is ...?"
};

// Of the state that settles on the first branch, by the equilibrium leg; one for each row of the table
// of plausible ranges in plausibility.cpp. Empty without a wheel, and where nothing settles.
std::vector<Implausible> implausible(const Model& model);

// Points that probably belong to another body, from the distances in the design position:
//
//   ends exchanged  the ends of a spring or link, or of a body between two joints, are together more
//                   than twice as far from the other points of their own bodies as from those of the
//                   other end's body
//   wrong body      a joint is more than 1 m and twice their extent away from the other points of a body,
//                   and less than half as far from those of its other body
std::vector<std::string> misplaced_points(const Scene& scene);

}  // namespace elastocheck::compare
