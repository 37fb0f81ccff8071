// Readings, diagnosis and convergence study of a candidate, the results of another solver.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/candidate/judgement.hpp"
#include "compare/comparison/points.hpp"
#include "compare/studies/study.hpp"
#include "elastocheck/candidate.hpp"

namespace elastocheck::compare {

// Channels and branches of a comparison without runs, for a candidate that is studied alone.
Comparison outline(const Model& model);

// The curve of the equilibrium leg.
inline const Curve& truth_of(const BranchComparison& branch) {
    return branch.run(Leg::equilibrium).curve;
}

// ---- Readings of a branch (candidate_readings.cpp).

// Points of a candidate on one branch.
struct PointsOnBranch {
    std::vector<std::size_t> on_branch;  // positions of these points in `points`
    const Points& points;
    const std::vector<PointColumn>& columns;
    // figures by other definitions, which are read from the reference too
    const std::vector<Channel>& defined;
};
// Sets the two readings of a branch, which compare the candidate's points with the equilibrium leg: at equal
// parameter, and at equal abscissa.
void add_readings(const Model& model, const Branch& branch, const BranchComparison& compared,
                  const std::vector<Channel>& channels, const PointsOnBranch& points,
                  CandidateBranch& given);

// ---- Diagnosis of a wrong column (candidate_faults.cpp).

// "toe agrees to 1e-6 deg with its sign turned"
std::string describe(const Explanation& explanation, const Comparison& comparison,
                     const Points& points);

// One column and its reference values, the branches concatenated; `tolerance` in the channel's unit.
struct ColumnWithReference {
    std::size_t column = 0;
    std::size_t channel = 0;
    double tolerance = std::numeric_limits<double>::infinity();
    std::vector<double> candidate, reference;
    std::vector<double> begin;  // reference value at a = 0 of the branch
    std::vector<double> at;     // parameter or travel
    std::vector<std::string> branch;
    // reference values of each other channel of the same unit
    std::vector<std::vector<double>> others;
    std::vector<std::size_t> other_channels;
    // reference values of the column's figure by other definitions, and their names
    std::vector<std::vector<double>> definitions;
    std::vector<std::string> definition_names;
};
// One reading of a branch.
struct BranchReading {
    const BranchComparison* branch = nullptr;
    const CandidateReading* reading = nullptr;
};
// Joins column `c` of the readings of all branches; `defined` are the figures by other definitions in the readings.
ColumnWithReference column_with_reference(const Comparison& comparison,
                                          std::span<const PointColumn> columns,
                                          std::span<const Channel> defined,
                                          std::span<const BranchReading> branches, std::size_t c);
// First transformation that makes the column right (candidate_faults.cpp); empty if none does.
std::optional<Explanation> explain(const ColumnWithReference& column);
// Sentence on a sign, unit or offset that brings a column much nearer (measured.hpp); empty: none.
std::string nearer_with(const ColumnWithReference& column, const Channel& channel);

// ---- Convergence study (candidate_study.cpp): order, own limit, step error and formulation gap,
// as for a method of the recursion (study.hpp).

struct CandidateLevel {
    int steps = 0;
    Points points;  // channels numbered as in outline(); placed by the parameter
};
// Pre: at least three levels, steps increasing; a violation is reported as a reason for
// inconclusive. Studies the main outputs that every level gives.
Study study_candidate(const Model& model, const std::string& name,
                      const std::vector<CandidateLevel>& levels, const Progress& progress = {});

}  // namespace elastocheck::compare
