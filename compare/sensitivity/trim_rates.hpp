// Derivative of a trim by the numbers of the scene.
//
// The adjustments x(p) solve c(q(x, p), x, p) = t(p), the conditions read from the settled state q.
// So dx/dp = -J⁻¹ (∂c/∂p - ∂t/∂p), J = dc/dx, both with the derivative of the settled state, by any
// leg; and an output y of any later state has dy/dp = ∂y/∂p + ∂y/∂x dx/dp.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "elastocheck/legs.hpp"
#include "elastocheck/trim.hpp"
#include "models/rates/model_rates.hpp"
#include "models/state_rate.hpp"

namespace elastocheck::compare {

struct TrimRates {
    Trim trim;                           // as requested
    std::vector<ModelRate> numbers;      // of the trimmed model, at constant adjustments
    std::vector<ModelRate> adjustments;  // by one SI unit of each adjusted quantity
    std::vector<Scene> scenes;           // per number: rate of the scene before the trim
};

// `rates`: of the scene as read, by its numbers; `trimmed`: the result of trim() for it.
TrimRates trim_rates(const Scene& as_read, const Trimmed& trimmed, std::span<const ModelRate> rates,
                     Detail detail = Detail::required);

// The sensitivity of a state of the model on the branch to a list of rates, by some leg.
using SensitivityOf = std::function<std::vector<StateRate>(
    const BranchSide& side, const Equilibrium& state, std::span<const Model> rates)>;

// dx/dp [adjustments × numbers], in SI units of the adjusted quantities; NaN where there is none.
// `model`: of the trimmed scene.
Eigen::MatrixXd adjustment_rates(const Model& model, const TrimRates& rates, Leg leg,
                                 const SensitivityOf& sensitivity);

}  // namespace elastocheck::compare
