// Result of an analysis, as data for readers. Each analysis has in NAME_result.cpp a function that makes
// one from its typed result; only reports/render/ knows how terminals, files and pages show it.
#pragma once

#include <string>
#include <vector>

#include "compare/result/table.hpp"
#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// Verdict on what the user requested. A side result that is not confirmed is a note, never the verdict.
struct Verdict {
    Grade grade = Grade::not_judged;
    std::string sentence{};              // "Proved: all 12 points are equilibria to 1e-06 mm."
    std::vector<std::string> reasons{};  // of `not_judged`
    int compared = 0;                    // numbers that the verdict rests on
    bool requested = true;               // false: the user requested only deviations
};

// A chart of columns of a table.
struct Chart {
    enum class Kind {
        curves,  // with a mark at each point
        lines,   // a colour for each value of by[0]; dashed of the second value of by[1]
        points,  // y over x
        bars,    // y[1] over the interval from x to y[0]
        ranked   // of words x the values y[0], largest first, with the interval from y[1] to y[2]
    };
    std::string id{}, title{};
    std::string table{};            // its id
    std::string x{};                // name of the column of the abscissa
    std::vector<std::string> y{};   // of the ordinates, in one unit
    std::vector<std::string> by{};  // a curve for each combination of values of these columns
    bool log_x = false, log_y = false;
    Kind kind = Kind::curves;
    std::string only{};           // of rows that begin with a word those with this one; empty: all
    std::string axis{};           // heading of the values' axis, instead of the column's
    std::vector<double> marks{};  // limits on that axis; not finite: none
    std::vector<std::string> rings{};  // of lines: values of by[0] that are drawn as points
};

inline constexpr const char* chart_kinds[] = {"curves", "lines", "points", "bars", "ranked"};

struct Result {
    std::string analysis{};  // "certify", as the command
    Verdict verdict{};
    std::vector<std::string> about{};  // paragraphs that a reader needs before the tables
    std::vector<Table> tables{};
    std::vector<Chart> charts{};
    std::vector<std::string> notes{};  // each with its place: "branch 'jounce': ..."
};

// The tables of one id as one: its columns, all rows, all notes, the first caption. Throws std::out_of_range where there
// is none.
Table whole_table(const Result& result, const std::string& id);
std::vector<std::string> table_ids(const Result& result);  // in their order, each once

}  // namespace elastocheck::compare
