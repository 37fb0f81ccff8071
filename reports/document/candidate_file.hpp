// What a candidate wrote, read: a table of its outputs, or the states that it found. reports/README.md has both formats.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/candidate.hpp"
#include "models/scene.hpp"
#include "reports/files/sheet.hpp"

namespace elastocheck::reports {

// How the file names its columns and branches, where it does not do it as we do.
struct ColumnMap {
    struct Entry {
        std::string theirs;
        std::string output;  // an output of the scene, "parameter" or "branch"
        std::string unit;    // empty: the output's own
        double sign = 1,
               offset = 0;    // output = sign · number · unit + offset, the offset in the output's own unit
        bool change = false;  // counted from the design position
        int line = 0;
    };
    std::vector<Entry> columns;
    std::vector<std::pair<std::string, std::string>> branches;  // theirs and ours
    std::string file;                                           // empty: there is none
};
// Throws SceneError "file:line: field: ...".
ColumnMap read_column_map(std::string_view yaml, const std::string& file);

// Whether the text is states: JSON lines, or a table with a column `body`.
bool holds_states(std::string_view content);

// Throws SheetError "file:line: ...".
compare::Candidate read_candidate(std::string_view content, const std::string& file, std::string name,
                                  const Scene& scene, const Model& model,
                                  const compare::Comparison& comparison, const ColumnMap& map = {});

// The states of a path in that format, one line each; `load` in SI.
std::string state_line(const Model& model, const std::string& branch, const Equilibrium& state);

}  // namespace elastocheck::reports
