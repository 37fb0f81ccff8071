// The elastic elements of a model in words: what they are, between which bodies, and what differs from the usual.
#pragma once

#include <string>
#include <vector>

#include "models/model.hpp"
#include "models/scene.hpp"

namespace elastocheck::reports {

struct ElementLine {
    std::string name;     // "coil", "antiroll.1 ... 20"
    std::string between;  // "wheel - ground"
    std::string what;     // "axial spring, 28 N/mm"
};

// A line an element, one for a chain of beams. Words follow from what an element is: a curve without force at one end
// is a stop, a bushing that resists θ_z alone a torsion spring, one that stands only where it is driven a tyre, one
// with its frame in the middle a beam. Formulations are told as the scene has them.
std::vector<ElementLine> elements(const Scene& scene, const Model& model);

}  // namespace elastocheck::reports
