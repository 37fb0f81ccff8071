// Measured curves in CSV, beside the calculated ones.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/candidate/measured.hpp"
#include "elastocheck/compare.hpp"
#include "elastocheck/model.hpp"
#include "reports/files/csv_table.hpp"
#include "reports/given/candidate_file.hpp"

namespace elastocheck::reports {

using MeasurementError = SheetError;

struct Measurement {
    std::string file, hash;  // of its text
    PointTable table;        // its channels are positions in `channels`
    std::vector<compare::Channel> channels;
};

// Reads a measurement; the first line names the columns, every further line is a point, an empty
// cell was not measured. Columns:
//   travel_mm (NAME.travel_mm), load_N, load_Nm, parameter_mm, parameter_deg
//                                  place of the point: travel from the design position, parameter
//                                  of its branch, or both; with several load cases one column for
//                                  each unit of their parameters
//   OUTPUT_UNIT                    toe_deg, camber_deg, wheel_centre_y_mm, ...: absolute values
//   OUTPUT_change_UNIT             ...: relative to the design position
//   branch                         its branch; needed only where several branches have the same parameter
// or as a rig names them (headings.hpp), or as the map says. Unknown columns, and the points of branches
// that are not among `only` (empty: all), are left out and listed. Throws MeasurementError.
Measurement read_measurement(std::string_view csv, const std::string& file, const Model& model,
                             const ColumnMap& map = {}, const std::vector<std::string>& only = {});

// A measurement beside the solutions; its channels are those of the comparison.
struct Measured {
    Measurement measurement;
    compare::MeasuredComparison found;
    std::vector<std::string> left_out;  // columns and rows that are not compared
};

// A point is compared only with the branch on which it was measured. Columns that deviate are tried by
// the other definitions `defined` too. Throws MeasurementError.
Measured compare_measurement(const Model& model, const compare::Comparison& comparison,
                             const compare::DefinedCurves& defined, Measurement measurement);

// "measured" in result.json: the points, and the deviation of every leg from them.
nlohmann::ordered_json measured_json(const Measured& measured,
                                     const compare::Comparison& comparison);

// "at equal load", "at equal travel"
std::string word_of(const Measured& measured, const compare::MeasuredReading& reading,
                    const compare::Comparison& comparison);
// Unit of the parameter of a branch, or of the abscissa.
compare::Unit unit_of_place(const Measured& measured, bool by_parameter, const std::string& branch,
                            const compare::Comparison& comparison);
// "deg/kN", and the factor to it: large numbers of newtons stand for one.
std::pair<std::string, double> gradient_unit(const Measured& measured,
                                             const compare::MeasuredReading& reading,
                                             const compare::MeasuredRow& row,
                                             const compare::Comparison& comparison);

}  // namespace elastocheck::reports
