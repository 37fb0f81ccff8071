// The arithmetic as a part of the price: float, double, long double over the step count.
//
// More steps shrink the step error until round-off is all that is left; a method that adds up increments then
// gets worse again, one that starts each step from the true residual stays where it is. Read at the end of
// the first branch (of its last way, where it has two):
//
//   constraint  |Φ| of eq. (31), the constraint error, formed in the arithmetic itself. It needs no reference,
//               so nothing but the arithmetic bounds it; for the published method it is the paper's own norm
//   error       from the equilibrium leg, bounded by its uncertainty; for the published method by its gap
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/trade.hpp"
#include "recursive/solve.hpp"

namespace elastocheck::compare {

const char* name(recursive::Precision precision);  // "float", "double", "long double"

struct PrecisionLevel {
    int steps = 0;
    Outcome outcome = Outcome::converged;
    double constraint = 0;  // [m, rad]
    Accuracy error;         // NaN unless converged
};

// Where more steps stop helping.
struct Floor {
    double least = 0;  // smallest value over the steps; NaN of none
    // No finer step count brings the value below a third of that here and keeps it there. 0: no number.
    int useful_steps = 0;
    bool reached = false;    // there were finer ones
    bool reference = false;  // the value there lies within the reference uncertainty, which explains it
};

struct PrecisionSeries {
    std::string method;
    recursive::Precision precision = recursive::Precision::twofold;
    std::vector<PrecisionLevel> levels;
    Floor constraint, mm;  // of |Φ|, and of the position error [mm]
};

struct PrecisionOptions {
    std::vector<std::string> methods{"published", "tangent", "chord"};
    int fewest_steps = 10;
    int most_steps = 1'000'000;  // in factors of four
    double work_budget = 1e9;    // of one level: steps · (unknowns)³
    std::function<void(std::string_view)> progress = {};
};

struct PrecisionStudy {
    std::string branch;  // or its way
    bool angles = false;
    Accuracy uncertainty;  // of the reference there; NaN when one failed
    std::vector<PrecisionSeries> series;
    std::vector<std::string> inconclusive;
};

// Throws std::invalid_argument for a method that is unknown or chooses its own steps.
PrecisionStudy precision_study(const Model& model, const PrecisionOptions& options = {});

// Of values over steps, fewest first; those that are not finite
// are passed over, those below the uncertainty are equal.
Floor floor_of(const std::vector<int>& steps, const std::vector<double>& values, double uncertainty = 0);

}  // namespace elastocheck::compare
