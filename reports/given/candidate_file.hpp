// Reader of candidate files and measurements: a table of outputs, or states.
// Formats in reports/README.md.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/candidate/candidate.hpp"
#include "elastocheck/scene.hpp"
#include "reports/files/csv_table.hpp"
#include "reports/given/headings.hpp"

namespace elastocheck::reports {

// A table of outputs over load or travel, from a solver or a measurement.
struct PointTable {
    compare::Points points;
    std::vector<std::string> parameters;  // names of the columns with a branch parameter
    std::vector<std::string> left_out;    // columns and rows that are not compared
    std::vector<int> lines;               // lines of the file, one per point
};
// Reads headings as in headings.hpp. For a candidate, `also_known` lists channels that its table
// may have and that are not compared; an unknown column is an error unless `names.map` is that of a file. For a
// measurement (`also_known` null) unknown columns are left out, and a cell that is not a finite
// number is an error. Throws SheetError "file:line: ...".
PointTable read_points(std::string_view csv, const std::string& file, const Names& names,
                       const std::vector<compare::Channel>* also_known);
// Removes the points for which `why_left_out` returns a reason (not ""), and adds a line for each reason to
// left_out: "3 rows beyond the range of branch 'travel' (lines 5, 6, 9)".
void drop_points(PointTable& table,
                 const std::function<std::string(std::size_t point)>& why_left_out);

// Whether a channel is the travel of a wheel, by which a point is located on its branch.
bool is_travel(const compare::Channel& channel);

struct CandidateFile {
    std::string name;  // of the candidate
    std::string file;  // for messages
    std::string_view content;
};
// States are recognised by a JSON object, or a column `body`. Throws SheetError "file:line: ...".
compare::Candidate read_candidate(const CandidateFile& given, const Scene& scene,
                                  const Model& model, const compare::Comparison& comparison,
                                  const ColumnMap& map = {});

}  // namespace elastocheck::reports
