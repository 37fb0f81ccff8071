// Interval proofs (reference/certificate) of the points of a path, and of the path as one curve.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/deviation/proof.hpp"
#include "compare/studies/work_precision.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {

using reference::certificate::LimitPoint;
using reference::certificate::Tube;

// Accuracy that is to be proved by default.
inline constexpr const char* claimed_accuracy = "1e-6mm,1e-6deg";
// Parses "1e-8mm"; a quantity that is not given takes its default. Throws std::invalid_argument as
// parse_tolerance does.
Tolerance claim(std::string_view text);

// Proofs of the points of one solver along one side of a branch.
struct CertifiedSide {
    std::string branch;        // name of the branch side
    Unit unit = Unit::newton;  // unit of its parameter
    double to = 0;             // end of the branch side, in that unit
    std::string solver;        // "equilibrium", "energy", or a method of the recursion
    Outcome outcome = Outcome::converged;
    std::string detail = {};
    Tally tally = {};
    std::optional<Tube> curve = {};        // curve through the points of the equilibrium leg
    std::optional<LimitPoint> limit = {};  // limit point at which the path ends
};

struct Result;

struct CertifyOptions {
    std::vector<SolverSettings> solvers;  // empty: both references and the series
    Tolerance tolerance;
    // Least number of points on a branch side besides the start, if it has as many steps.
    int points = 20;
    bool curves = true;  // prove that the equilibrium leg's points lie on one curve, too
    int threads = 1;
    Progress progress = {};
};

struct CertifyStudy {
    Tolerance tolerance;
    std::vector<CertifiedSide> sides;

    int points() const;
    int proved() const;
    bool excluded() const;  // some point is proved wrong
    // Every solver reached the end or a proved limit point, and every point and every curve that is
    // tried is proved.
    bool conclusive() const;
};

// Certifies every branch side of a model with every solver.
CertifyStudy certify(const Model& model, const CertifyOptions& options);
// Table "sides": a row for each side of a branch and solver. Fails where a point is excluded.
Result result_of(const CertifyStudy& study);

}  // namespace elastocheck::compare
