// A candidate: what somebody else's solver says of a scene, held against the references as the recursion is.
//
// Nothing is interpolated. The equilibrium leg is asked for the candidate's own points: at equal load at its loads, at
// equal travel where the leg's travel is the candidate's. With t(a) the travel of the leg and t* that of a point, a is
// found from the branch as it was compared, and made better by secants:  a ← a + (t* - t(a)) Δa/Δt.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/findings.hpp"
#include "compare/judgement.hpp"
#include "compare/points.hpp"

namespace elastocheck::compare {

// What a state of the candidate leaves in the legs' own equations, one entry per point that has one, on one branch.
struct Leftover {
    std::string branch;
    Unit unit = Unit::newton;  // of the parameter
    std::vector<double> a;     // [unit]
    Leg second = Leg::energy;  // who judges beside the equilibrium leg
    std::vector<Residuals> truth,
        by_second;             // per point; forces are NaN by the energy leg's where there is no energy
    std::string why_not = {};  // it is not judged
};

struct Candidate {
    std::string name;  // "mysolver"
    Points points;
    bool every_output =
        false;              // the columns are what its states come to: the main ones are judged, and forces
    bool complete = false;  // it was asked for whole branches: what it leaves out is a failure
    std::vector<Leftover> leftovers;  // of its states
    std::vector<std::string> notes;   // what is to be said of how it was read
};

// ---- What a column would be right in, were it read otherwise (candidate_faults.cpp).
struct Explanation {
    enum class Kind {
        sign,    // v = -r
        offset,  // v = r + c
        factor,  // v = f r, or from where the branch begins on: v = r_0 + f (r - r_0)
        sign_and_offset,
        factor_and_offset,
        other_output,   // v = the reference's other output
        other_turned,   // ... with its sign turned
        from_there_on,  // right up to a point of a branch
        still,          // does not move where the reference does
    } kind = Kind::offset;
    std::size_t column = 0;         // position in Points::columns
    double factor = 1, offset = 0;  // offset in the channel's unit
    std::string unit_word = {};     // what such a factor is: "radians for degrees"
    std::size_t other = 0;          // channel
    std::string branch = {};        // from_there_on
    double at = 0;                  // there, in the branch's unit: the last point that is right
    double left = 0;                // largest deviation that is left then, in the channel's unit
    bool mutual = false;            // other_output: the other's column has this one's
};
// "toe agrees to 1e-6 deg with its sign turned"
std::string describe(const Explanation& explanation, const Comparison& comparison, const Points& points);

// One column beside its reference, all branches one after the other; `tolerance` in the channel's unit.
struct Beside {
    std::size_t column = 0;
    std::size_t channel = 0;
    double tolerance = std::numeric_limits<double>::infinity();
    std::vector<double> candidate, reference;
    std::vector<double> begin;  // of the reference, at a = 0 of the branch
    std::vector<double> at;     // parameter or travel
    std::vector<std::string> branch;
    std::vector<std::vector<double>> others;  // per channel of the same unit: its reference
    std::vector<std::size_t> other_channels;
};
std::optional<Explanation> explain(const Beside& beside);

// ---- The judgement.

struct CandidateReading {
    std::string not_compared;        // why there is none, empty when there is
    int outside = 0;                 // points that the reference does not reach
    std::vector<Deviation> columns;  // candidate less reference, per Points::columns; 0 compared: none
    std::vector<double> at;          // per compared point: parameter or travel
    std::vector<std::vector<double>> candidate, truth;  // [column][point]; NaN where nothing is said
};

struct CandidateBranch {
    std::string branch;
    Unit unit = Unit::newton;
    int points = 0;
    double from = 0, to = 0;  // that it reaches, of what the branch does [unit]; NaN without a parameter
    int abscissa = -1;        // channel
    CandidateReading equal_parameter, equal_abscissa;
    const CandidateReading& reading(ReadingKind kind) const {
        return kind == ReadingKind::equal_parameter ? equal_parameter : equal_abscissa;
    }
};

struct CandidateWorst : Worst {
    ReadingKind kind = ReadingKind::equal_parameter;
    double at = 0, tolerance = 0;
};

struct CandidateJudgement {
    std::string name;
    Grade verdict = Grade::not_judged;
    Tolerance tolerance = default_tolerance;
    bool asked = false;                     // the tolerance was given, not the default
    std::vector<std::string> reasons;       // why not judged
    std::vector<std::string> not_given;     // branches, and parts of them, or of a column
    std::vector<PointColumn> columns;       // as they stand
    std::vector<bool> judged;               // per column: it counts for the verdict
    std::vector<CandidateBranch> branches;  // those that it has points on
    std::vector<CandidateWorst> worst;  // by unit, of what is judged: mm, deg, N, N·m, as far as there are
    std::vector<Explanation> explanations;
    std::vector<std::string> said;  // the explanations in words
    std::vector<Leftover> leftovers;
    std::vector<std::string> notes;
    int compared = 0;  // numbers
    int outside = 0;   // points where the reference does not come
};

// Throws std::invalid_argument for points that cannot be placed (points.hpp).
CandidateJudgement judge_candidate(const Model& model, const Comparison& comparison,
                                   const Candidate& candidate, const Tolerance& tolerance = default_tolerance,
                                   bool asked = true);

// The channels and branches of a comparison that nobody has made yet: what a candidate is read by where it alone is
// studied.
Comparison outline(const Model& model);

// ---- States (candidate_states.cpp).

struct CandidateState {
    std::string branch;
    double load = 0;          // as in Equilibrium
    std::vector<Pose> poses;  // one per Model::bodies; NaN of a body that is not said
};

// Its points with every output that its poses tell, and what they leave in the legs' equations.
Candidate candidate_of(const Model& model, const Comparison& comparison, std::string name,
                       const std::vector<CandidateState>& states);

// Somebody's solver as a function of a model as it stands on one way of a branch, that way, and the values of its
// parameter that are asked for, from a = 0 on: a leg.
using CandidateSolver = std::function<EquilibriumPath(const Model&, const Branch&, std::span<const double>)>;
Candidate candidate_of(const Model& model, const Comparison& comparison, std::string name,
                       const CandidateSolver& solver);

// ---- Convergence (candidate_study.cpp): order, own limit, step error against formulation gap, as of a method of the
// recursion (study.hpp).

struct CandidateLevel {
    int steps = 0;
    Points points;  // read by the outline; with a parameter
};
// At least three levels, of increasing steps; what is wrong with them is a reason for being inconclusive. Of the main outputs
// those that every level gives.
Study study_candidate(const Model& model, const std::string& name, const std::vector<CandidateLevel>& levels,
                      const std::function<void(std::string_view)>& progress = {});

}  // namespace elastocheck::compare
