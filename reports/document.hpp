// result.json: everything a comparison found, for machines and for later reports.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/compare.hpp"
#include "models/scene.hpp"
#include "recursive/diagnosis.hpp"
#include "reports/provenance.hpp"

namespace elastocheck::reports {

// Raised when a field changes its meaning or vanishes; new fields may appear without.
inline constexpr const char* result_schema = "elastocheck/result/1";

// Lengths in mm, angles in deg, forces in N, moments in N·m, as every key or neighbouring "unit" says. A
// number that is not finite is null.

// What every result.json begins with: schema, scene, provenance, model as compiled.
nlohmann::ordered_json document_head(const Scene& scene, std::string_view input, const Model& model,
                                     const recursive::Diagnosis& diagnosis, const Provenance& provenance);

// The head and a comparison.
nlohmann::ordered_json document(const Scene& scene, std::string_view input, const Model& model,
                                const recursive::Diagnosis& diagnosis, const compare::Comparison& comparison,
                                const Provenance& provenance);

}  // namespace elastocheck::reports
