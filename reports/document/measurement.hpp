// Reader of measured curves in CSV.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "elastocheck/compare.hpp"
#include "elastocheck/model.hpp"
#include "reports/document/candidate_file.hpp"
#include "reports/files/csv_table.hpp"

namespace elastocheck::reports {

using MeasurementError = SheetError;

// Adds "measured" to the document of a solved scene: the points, and the deviation of every leg from
// them.
//
// The first line names the columns, every further line is a point; an empty cell was not measured.
// Columns:
//   travel_mm (NAME.travel_mm), load_N, load_Nm, parameter_mm, parameter_deg
//                                  place of the point: travel from the design position, parameter
//                                  of its branch, or both; with several load cases one column for
//                                  each unit of their parameters
//   OUTPUT_UNIT                    toe_deg, camber_deg, wheel_centre_y_mm, ...: absolute values
//   OUTPUT_change_UNIT             ...: relative to the design position
//   branch                         its branch; needed only where several branches have the same parameter
// The map gives the names of columns and branches in the file. Unknown columns, and outputs
// that are neither positions nor angles, are left out and listed. A point is compared only with
// the branch on which it was measured. Throws MeasurementError, and ResultError for a document
// without curves.
void add_measurement(nlohmann::ordered_json& scene_document, std::string_view csv,
                     const std::string& file, const ColumnMap& map = {});

// Adds "defined" to the document of a solved scene: curves of its figures by other definitions, which
// add_measurement() tries on columns that deviate.
void add_defined_curves(nlohmann::ordered_json& scene_document, const Model& model,
                        const compare::Comparison& comparison);

// Number of compared values over all readings and outputs.
int compared_with_measurement(const nlohmann::ordered_json& scene_document);

}  // namespace elastocheck::reports
