// Reader of measured curves in CSV.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/comparison/compare.hpp"
#include "elastocheck/model.hpp"
#include "reports/files/csv_table.hpp"

namespace elastocheck::reports {

using MeasurementError = SheetError;

// Mapping from the file's load cases to branches: the column, and the names in the file.
struct LoadCases {
    std::string column = "branch";
    // names in the file and in the scene
    std::vector<std::pair<std::string, std::string>> names = {};
};

// "Lat Force=lateral". Throws std::invalid_argument.
std::pair<std::string, std::string> parse_load_case(std::string_view text);

// Adds "measured" to a scene document: the points, and the deviation of every leg from them.
//
// The first line names the columns, every further line is a point; an empty cell was not measured.
// Columns:
//   travel_mm (NAME.travel_mm), load_N, load_Nm, parameter_mm, parameter_deg
//                                  place of the point: travel from the design position, parameter
//                                  of its branch, or both; with several load cases one column for
//                                  each unit of their parameters
//   OUTPUT_UNIT                    toe_deg, camber_deg, wheel_centre_y_mm, ...: absolute values
//   OUTPUT_change_UNIT             ...: relative to the design position
//   branch, or column of `cases`   its branch; needed only where several branches go the same way
// A point is compared only with the branch on which it was measured. Throws MeasurementError.
void add_measurement(nlohmann::ordered_json& scene_document, std::string_view csv,
                     const std::string& file, const Model& model,
                     const compare::Comparison& comparison, const LoadCases& cases = {});

// Number of compared values over all readings and outputs.
int compared_with_measurement(const nlohmann::ordered_json& scene_document);

}  // namespace elastocheck::reports
