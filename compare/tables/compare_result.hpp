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

// Its tables, also of the page: deviations of the recursion on a branch (main outputs, the largest
// component of each joint, and the worst characteristic of a unit, or each); agreement of the references, a
// row per branch; residuals of the states of each leg in the equations of the others; proofs; outcome and
// work of each leg.
Table deviation_table(const Comparison& comparison, const BranchComparison& branch,
                      bool each_rate = false);
Table agreement_table(const Comparison& comparison);
Table residual_table(const Comparison& comparison);
Table proof_table(const Comparison& comparison);
Table leg_table(std::span<const BranchComparison> branches);

// Tables that are only in files: rates and compliance at the design position, forces at
// the ends of the branches, the largest forces, wheel rates, agreement, residuals, proofs.
void add_tables(Result& result, const Model& model, const Comparison& comparison);

// The figures by other definitions; solves the branches again.
void add_definitions(Result& result, const Model& model, const Comparison& comparison);

// The spread of the outputs over the bushing formulations; `comparison` is of the same scene.
void add_formulations(Result& result, const FormulationStudy& study, const Comparison& comparison);

// Outputs of elements and links that have no value, and why: "no value of A, B: ...". Empty where
// all have one.
std::string not_determined(std::span<const Channel> channels,
                           const std::function<bool(std::size_t)>& is_undefined);

}  // namespace elastocheck::compare
