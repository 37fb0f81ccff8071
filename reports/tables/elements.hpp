// Description of the elastic elements of a model: kind, connected bodies, non-default properties.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "elastocheck/compare.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::reports {

struct ElementLine {
    std::string name;     // "coil", "antiroll.1 ... 20"
    std::string between;  // "wheel - ground"
    std::string what;     // "axial spring, 28 N/mm"
};

// One line per element, one for a chain of beams. The kind follows from the properties: a curve
// without force at one end is a stop, a bushing with stiffness in θ_z only a torsion spring, one
// that is active only where driven a tyre, one with its frame in the middle a beam. Formulations
// are those of the scene.
std::vector<ElementLine> elements(const Scene& scene, const Model& model);

// Clearance [m] of a stop, of which the law has no force on one side; none of another law.
std::optional<double> clearance_of(const ScalarLaw& law);

// Travel of a wheel [mm], force [N] and deflection [mm] of a spring or stop at the stations of the
// equilibrium leg on a branch; empty for an element that has no force along one axis.
std::vector<std::vector<double>> force_over_travel(const Model& model, const Branch& branch,
                                                   const compare::BranchComparison& solved,
                                                   const std::string& element, std::size_t wheel);

}  // namespace elastocheck::reports
