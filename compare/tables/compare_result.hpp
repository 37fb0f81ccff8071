// The deviations of a scene for readers.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "compare/candidate/judgement.hpp"
#include "compare/result/result.hpp"
#include "compare/studies/formulations.hpp"

namespace elastocheck::compare {

// `assessment` is of the comparison. The verdict has no sentence.
Result result_of(const Model& model, const Comparison& comparison, const Assessment& assessment);

// The figures by other definitions; solves the branches again.
void add_definitions(Result& result, const Model& model, const Comparison& comparison);

// The spread of the outputs over the bushing formulations; `comparison` is of the same scene.
void add_formulations(Result& result, const FormulationStudy& study, const Comparison& comparison);

// Outputs of elements and links that have no value, and why: "no value of A, B: ...". Empty where
// all have one.
std::string not_determined(std::span<const Channel> channels,
                           const std::function<bool(std::size_t)>& is_undefined);

}  // namespace elastocheck::compare
