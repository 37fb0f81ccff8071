// Gradients of a scene file: its numbers' rates, its trim, and the legs' sensitivities.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compare/sensitivity/sensitivity.hpp"
#include "reports/command/options/load_scene.hpp"

namespace elastocheck::reports {

// Derivatives of the outputs by the numbers of `rates`, which are those of the file with these
// settings (all_model_rates); the trim of a trimmed scene is part of the function.
compare::Gradients gradients_of(const std::string& file, const Settings& settings,
                                const LoadedScene& loaded,
                                std::span<const compare::Channel> outputs,
                                std::vector<ModelRate> rates, compare::GradientOptions options);

}  // namespace elastocheck::reports
