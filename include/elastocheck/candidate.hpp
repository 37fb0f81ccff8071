// Candidate: results of an external solver, judged against the references as the recursion is.
//
// Nothing is interpolated: the equilibrium leg solves at the candidate's own points. At equal load these
// are the candidate's loads. At equal travel it is the load a at which the travel t(a) of the leg is the
// candidate's t*, found from the compared branch by the secant method, a ← a + (t* - t(a)) Δa/Δt.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// ---- Points of an external solver, or measured points.

struct PointColumn {
    std::size_t channel = 0;  // position in Comparison::channels
    bool change = false;      // values are changes from the design position
    // per point, in the channel's unit; NaN for a missing value, infinite for a value that is not a number
    std::vector<double> values;
};

// All vectors have one entry per point, or none.
struct Points {
    // names of the branches; empty: the branch, of several to different sides of a = 0, that reaches
    // the point
    std::vector<std::string> branch;
    std::vector<double> a;  // parameter, in the branch's unit
    std::optional<std::size_t>
        abscissa;            // in place of a: the channel whose values place the points
    std::vector<double> at;  // these values
    std::vector<PointColumn> columns;
};

// Residuals of the candidate's states on one branch in the equations of two legs, one entry per point
// with a state.
struct StateResiduals {
    std::string branch;
    Unit unit = Unit::newton;  // of the parameter
    std::vector<double> a;     // [unit]
    Leg second = Leg::energy;  // the second judging leg
    // in the equations of the equilibrium leg and of the second leg; forces are NaN for the energy leg
    // if a force has no energy
    std::vector<Residuals> truth, by_second;
    std::string why_not = {};  // reason why the states are not judged; else empty
};

struct Candidate {
    std::string name;  // "mysolver"
    Points points;
    // has all outputs, computed from states: of positions and angles only the main ones are judged
    bool every_output = false;
    bool complete = false;  // it must cover every branch to its ends in order to pass
    std::vector<StateResiduals> state_residuals;  // of its states, per branch
    std::vector<std::string> notes;               // remarks on how the points were read
};

// ---- Diagnosis of a wrong column: the transformation that makes it right.
struct Explanation {
    enum class Kind {
        sign,    // v = -r
        offset,  // v = r + c
        factor,  // v = f r, or relative to the start of the branch: v = r_0 + f (r - r_0)
        sign_and_offset,
        factor_and_offset,
        other_output,   // v = the reference's other output
        other_turned,   // v = - the reference's other output
        definition,     // v = f d + c, d the figure by another definition, f a sign or a unit
        from_there_on,  // right up to a point of a branch, wrong beyond it
        still,          // constant where the reference changes
    } kind = Kind::offset;
    std::size_t column = 0;         // position in Points::columns
    double factor = 1, offset = 0;  // offset in the channel's unit
    std::string unit_word = {};     // unit confusion that gives this factor: "radians for degrees"
    std::size_t other = 0;          // channel of the other output
    // definitions that make it right, the best first, with the transformation: "camber@kingpin",
    // "camber@lateral with its sign turned"
    std::vector<std::string> definitions = {};
    std::string branch = {};  // from_there_on
    double at = 0;            // last right point on that branch, in its unit
    double left = 0;          // largest deviation after the transformation, in the channel's unit
    bool mutual = false;      // other_output: the two columns are exchanged
};

// ---- The judgement.

struct CandidateReading {
    std::string not_compared;  // reason why there is no comparison, else empty
    int outside = 0;           // points that the reference does not reach
    // candidate minus reference, per Points::columns; `compared` is 0 for a column without numbers
    std::vector<Deviation> columns;
    std::vector<std::size_t> points;  // compared points: positions in the candidate's points
    std::vector<double> at;           // their parameter, or travel
    // values of the candidate and of the reference, [column][point]; NaN without a value
    std::vector<std::vector<double>> candidate, truth;
    // values of CandidateJudgement::defined of the reference, [definition][point]
    std::vector<std::vector<double>> defined;
};

struct CandidateBranch {
    std::string branch;
    Unit unit = Unit::newton;
    int points = 0;
    // range of the branch that the points of the candidate span [unit]; NaN without a parameter
    double from = 0, to = 0;
    int abscissa = -1;  // channel
    CandidateReading equal_parameter, equal_abscissa;
    const CandidateReading& reading(ReadingKind kind) const {
        return kind == ReadingKind::equal_parameter ? equal_parameter : equal_abscissa;
    }
};

struct CandidateWorst : Worst {
    ReadingKind kind = ReadingKind::equal_parameter;
    double at = 0;
};

struct CandidateJudgement {
    std::string name;
    Grade verdict = Grade::not_judged;
    Tolerance tolerance = default_tolerance;
    bool tolerance_given = false;           // the tolerance was given, not the default
    std::vector<std::string> reasons;       // why not judged
    std::vector<std::string> not_given;     // missing branches, parts of branches or of columns
    std::vector<PointColumn> columns;       // as absolute values, not changes
    std::vector<bool> judged;               // per column: it counts for the verdict
    std::vector<Channel> defined;           // the columns' figures by other definitions
    std::vector<CandidateBranch> branches;  // with points of the candidate
    // Worst judged deviation, one entry each as far as they exist: mm, deg, N and N·m where these
    // have a limit of their own, and one for all outputs whose limit is a share of their extent.
    std::vector<CandidateWorst> worst;
    int others = 0;           // number of judged columns that are neither positions nor angles
    bool has_forces = false;  // a joint's force or moment is determined on some branch
    std::vector<Explanation> explanations;
    std::vector<std::string> hints;  // the explanations as text
    std::vector<StateResiduals> state_residuals;
    std::vector<std::string> notes;
    int compared = 0;  // numbers
    int outside = 0;   // points beyond the range of the reference
};

// Throws std::invalid_argument for points that cannot be placed.
CandidateJudgement judge_candidate(const Model& model, const Comparison& comparison,
                                   const Candidate& candidate,
                                   const Tolerance& tolerance = default_tolerance,
                                   bool tolerance_given = true);

// ---- States.

struct CandidateState {
    std::string branch;
    double load = 0;          // parameter a of the branch, as in Equilibrium
    std::vector<Pose> poses;  // one per Model::bodies; NaN for a body without a given pose
};

// Points with every output computed from the poses, and the residuals of the states in the legs' equations.
Candidate candidate_of(const Model& model, const Comparison& comparison, std::string name,
                       const std::vector<CandidateState>& states);

// External solver as a function, like a leg: (model of one branch side, that branch side, requested
// parameter values from a = 0 on) -> path.
using CandidateSolver =
    std::function<EquilibriumPath(const Model&, const Branch&, std::span<const double>)>;
Candidate candidate_of(const Model& model, const Comparison& comparison, std::string name,
                       const CandidateSolver& solver);

}  // namespace elastocheck::compare
