// Measured curves in CSV, beside the calculated ones.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/candidate/measured.hpp"
#include "compare/result/result.hpp"
#include "elastocheck/compare.hpp"
#include "elastocheck/model.hpp"
#include "reports/files/csv_table.hpp"
#include "reports/given/candidate_file.hpp"

namespace elastocheck::reports {

struct Measurement {
    std::string file, hash;  // name, and hash of the text
    PointTable table;        // its columns refer to `channels`
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
// that are not among `only` (empty: all), are left out and listed. Throws SheetError.
Measurement read_measurement(std::string_view csv, const std::string& file, const Model& model,
                             const ColumnMap& map = {}, const std::vector<std::string>& only = {});

// A measurement beside the solutions; its channels are those of the comparison.
struct Measured {
    Measurement measurement;
    compare::MeasuredComparison found;
    std::vector<std::string> left_out;  // columns and rows that are not compared
};

// A point is compared only with the branch on which it was measured. Columns that deviate are tried by
// the other definitions `defined` too. Throws SheetError.
Measured compare_measurement(const Model& model, const compare::Comparison& comparison,
                             const compare::DefinedCurves& defined, Measurement measurement);

// Its tables: deviations, loops, and the points; notes: what makes a column right that deviates.
compare::Result result_of(const Measured& measured, const compare::Comparison& comparison);

// Deviation of every leg from the points at equal parameter or travel; a row per test and output.
compare::Table deviation_table(const Measured& measured, const compare::MeasuredReading& reading,
                               const compare::Comparison& comparison);
// Hysteresis: outputs whose ways out and back differ, a branch and output a row.
compare::Table loop_table(const Measured& measured, const compare::Comparison& comparison);

}  // namespace elastocheck::reports
