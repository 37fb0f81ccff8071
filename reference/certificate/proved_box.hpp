// Boxes that are proved once and serve the states of several legs.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/certificate/certificate.hpp"

namespace elastocheck::reference::certificate {

// A box that contains one equilibrium, of equations that do not depend on the state: without idle
// motion and redundant joint.
struct ProvedBox {
    double a = 0;
    bool separated = false;      // of the equations with separated curves
    Eigen::VectorXd y, r;        // ỹ and r
    double uniqueness_size = 0;  // t of the large box without another equilibrium (certify.cpp)
    Certificate certificate;  // `error` and `unique` are those of the state that it was proved for
};

// certify(), with known boxes of the same model and branch, to which a new one is added. A known
// box at the load of the state proves the state if it is within the tolerance; else it is reported
// as the nearest equilibrium where the state is excluded.
Certificate certify(const Model& model, const Branch& branch, const Equilibrium& state,
                    const Tolerance& tolerance, std::vector<ProvedBox>& known);

}  // namespace elastocheck::reference::certificate
