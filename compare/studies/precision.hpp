// Floating-point precision study: errors in float, double and long double over the step count.
//
// More steps reduce the step error until round-off dominates. A method that adds up increments then
// gets worse again; one that starts each step from the true residual keeps its error. Evaluated at
// the end of the first branch (of its last side, if it has two):
//
//   constraint  |Φ| of eq. (31), the constraint error, computed in the arithmetic itself. It needs
//               no reference, so only the arithmetic bounds it; for the published method it is the
//               paper's own norm
//   error       from the equilibrium leg, bounded by the reference uncertainty; for the published
//               method by its formulation gap
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/studies/solves.hpp"
#include "compare/studies/work_precision.hpp"
#include "elastocheck/recursive.hpp"

namespace elastocheck::compare {

const char* name(recursive::Precision precision);  // "float", "double", "long double"

struct PrecisionLevel {
    int steps = 0;
    Outcome outcome = Outcome::converged;
    double constraint = 0;  // [m, rad]
    Accuracy error;         // NaN unless converged
};

// Step count beyond which more steps do not reduce the value.
struct Floor {
    double least = 0;  // smallest value over the steps; NaN without values
    // Smallest step count after which no finer one brings the value below a third and keeps it
    // there. 0: none.
    int useful_steps = 0;
    bool reached = false;  // finer step counts were run
    // the value there lies within the reference uncertainty, which explains the floor
    bool reference = false;
};

struct PrecisionSeries {
    std::string method;
    recursive::Precision precision = recursive::Precision::double_precision;
    std::vector<PrecisionLevel> levels;
    Floor constraint, mm;  // of |Φ|, and of the position error [mm]
};

struct PrecisionOptions {
    std::vector<std::string> methods{"published", "tangent", "chord"};
    int fewest_steps = 10;
    int most_steps = 1'000'000;  // increased by factors of four
    double work_budget = 1e9;    // of one level: steps · (unknowns)³
    int threads = 1;
    Progress progress = {};
};

struct PrecisionStudy {
    std::string branch;  // or one side of it
    bool angles = false;
    Accuracy uncertainty;  // of the reference at the end; NaN when one leg failed
    std::vector<PrecisionSeries> series;
    std::vector<std::string> inconclusive;
};

// Throws std::invalid_argument for an unknown method or one that chooses its own steps.
PrecisionStudy precision_study(const Model& model, const PrecisionOptions& options = {});
PrecisionStudy precision_study(Solves& solves, const PrecisionOptions& options);

// Floor of values over increasing steps. Values that are not finite are skipped; those below the
// uncertainty count as equal.
Floor floor_of(const std::vector<int>& steps, const std::vector<double>& values,
               double uncertainty = 0);

}  // namespace elastocheck::compare
