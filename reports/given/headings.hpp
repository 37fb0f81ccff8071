// What the columns and rows of a table from another program or a rig mean in a scene: by a map, by
// the names of this program, and by those of K&C rigs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "elastocheck/compare.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reports {

// Mapping from the file's column and branch names to those of the scene.
struct ColumnMap {
    struct Entry {
        std::string theirs{};  // name of the column in the file
        std::string output{};  // an output of the scene, "parameter" or "branch"
        std::string unit{};    // empty: the output's own
        // output = sign · number · unit + offset, the offset in the output's own unit
        double sign = 1, offset = 0;
        bool change = false;  // relative to the design position
        int line = 0;         // in the map
    };
    std::vector<Entry> columns;
    // names in the file and in the scene
    std::vector<std::pair<std::string, std::string>> branches;
    std::string file;  // empty: there is none
};
// Throws SceneError "file:line: field: ...".
ColumnMap read_column_map(std::string_view yaml, const std::string& file);

// A branch and what its parameter moves (load_case() in wheels.hpp).
struct TestBranch {
    std::string branch, moves;
    bool by_travel = false;  // its parameter is a length
    compare::Unit unit = compare::Unit::newton;
};

// A heading and its unit, which is in brackets or after the last _: "toe [deg]", "toe_deg".
struct Heading {
    std::string name, unit;
};
Heading split_heading(std::string_view text);

// The scene in whose names a file is read.
struct Names {
    const std::vector<compare::Channel>& channels;
    const ColumnMap& map;
    std::vector<TestBranch> tests;  // one per branch

    std::vector<std::string> branches() const;
};
Names names_of(const Model& model, const std::vector<compare::Channel>& channels,
               const ColumnMap& map);

// What a column of the file gives: value = number · factor + offset.
struct Meaning {
    enum class Kind {
        output,
        parameter,
        parameter_unit,
        branch,
        leg,
        nothing
    } kind = Kind::nothing;
    std::string name{};  // in the file
    std::size_t channel = 0;
    bool change = false;  // relative to the design position
    double factor = 1, offset = 0;
    // unit of a parameter, as written; empty: that of the branch, or given by a column
    std::string unit{};
    // "lateral force": the column is the parameter of tests with this load case and of no others,
    // since a rig records every force in every test
    std::string moves{};
};
// "toe [deg]", "toe_deg", "toe_change_deg", "toe", "load_kN", "branch"; of a rig in any case, with the
// unit in brackets and the side as a word: "Left Toe Angle (arcmin)" is left.toe, "Lateral Force [kN]"
// the parameter of the test with that force, "Vertical Force LH [N]" left.wheel_load where no branch
// has that parameter; of a scene with one wheel without a name the left one. Throws SceneError for an
// entry of the map that does not fit the scene.
Meaning meaning_of(const std::string& heading, const Names& names);
std::vector<std::string> known_headings(const Names& names);
// The heading, with the nearest one of this program: "tow_deg (did you mean 'toe_deg'?)".
std::string left_out_heading(const std::string& heading, const Names& names);

// The branches that the name of a rig test may mean, in any case and with - or _ for blanks:
//   bounce, ride, heave, parallel travel | roll | steer, steering | lateral (force), also opposed or
//   parallel | aligning torque, also opposed or parallel | braking | traction
// Of several branches with that load case: those whose name contains the word of the test
// ("braking"), else those whose parameter is a travel. Empty if the name is not that of a test.
std::vector<std::string> branches_of_test(std::string_view test,
                                          const std::vector<TestBranch>& branches);
// The branch that a cell means: by the map, its name, or a rig's test. Throws SheetError.
std::string branch_of_cell(std::string_view cell, const Names& names, const std::string& file,
                           int line, const std::string& column);
// "the scene has no branch 'jonce', did you mean 'jounce'?"
std::string no_branch(const std::string& name, const std::vector<std::string>& branches);

// Factor from a written unit to the base unit; empty where it is not a unit of that kind. An empty text
// is the base unit.
std::optional<double> factor_of(std::string_view written, compare::Unit unit);
std::string allowed_units(compare::Unit unit);

}  // namespace elastocheck::reports
