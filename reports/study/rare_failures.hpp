// Probabilities of figures outside their limits that are too small to be counted.
#pragma once

#include <string>
#include <vector>

#include "compare/variants/openturns.hpp"
#include "elastocheck/compare.hpp"
#include "reports/study/study_file.hpp"

namespace elastocheck::reports {

// Of one limit of a figure.
struct RareFailure {
    std::size_t figure = 0;
    compare::variants::openturns::Threshold limit = {};
    compare::variants::openturns::Rare found = {};
    std::string at = {};       // values of the variables at the most probable failure
    std::string trouble = {};  // why there is no result
};

// By the first-order reliability method and importance sampling about the most probable failure;
// `most` variants a limit. Results depend on the study and its seed alone. Throws
// std::invalid_argument for a study without limits, and for variables that are not continuous.
std::vector<RareFailure> rare_failures(const StudyFile& file, std::uint64_t most,
                                       const compare::Progress& progress);

}  // namespace elastocheck::reports
