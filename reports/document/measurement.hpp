// Measured curves, read from a CSV file.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/compare.hpp"
#include "models/model.hpp"
#include "reports/files/sheet.hpp"

namespace elastocheck::reports {

using MeasurementError = SheetError;

// How the file says which branch a point belongs to: by a column, in the scene's names or in its own.
struct LoadCases {
    std::string column = "branch";
    std::vector<std::pair<std::string, std::string>> names = {};  // theirs, and the branch that is meant
};

// "Lat Force=lateral". Throws std::invalid_argument.
std::pair<std::string, std::string> parse_load_case(std::string_view text);

// Adds "measured" to a scene document: the points, and how far every leg is from them.
//
// The first line names the columns, every further one is a point; an empty cell was not measured. Columns:
//   travel_mm (NAME.travel_mm), load_N, load_Nm, parameter_mm, parameter_deg
//                                       where the point is, by travel from the design position, by the
//                                       parameter of its branch or both; a file of several load cases has a
//                                       column for each unit that its branches go by
//   OUTPUT_UNIT                         toe_deg, camber_deg, wheel_centre_y_mm, ...: as it stands
//   OUTPUT_change_UNIT                  ...: since the design position
//   branch, or the column of `cases`    its branch; needed only where several branches go the same way
// A point is compared with the branch it was measured on, and with no other. Throws MeasurementError.
void add_measurement(nlohmann::ordered_json& scene_document, std::string_view csv, const std::string& file,
                     const Model& model, const compare::Comparison& comparison, const LoadCases& cases = {});

// How many numbers of it could be compared, over all readings and outputs.
int compared_with_measurement(const nlohmann::ordered_json& scene_document);

}  // namespace elastocheck::reports
