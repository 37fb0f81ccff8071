// Statistics of the figures of a study: moments, percentiles, shares out of limits, Sobol indices.
//
// Intervals have 95 % confidence for independent draws of a Monte Carlo design. For other designs,
// whose estimates scatter less, they are shown as they are for independent draws.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "compare/variants/openturns.hpp"
#include "compare/variants/study.hpp"

namespace elastocheck::compare::variants {

inline constexpr double confidence = 0.95;
inline constexpr std::array percentiles{0.01, 0.05, 0.5, 0.95, 0.99};

struct Interval {
    double value = std::numeric_limits<double>::quiet_NaN();
    double low = std::numeric_limits<double>::quiet_NaN(),
           high = std::numeric_limits<double>::quiet_NaN();
};

struct FigureStatistics {
    std::uint64_t count = 0;                               // of finite values
    std::uint64_t missing = 0;                             // no value: failed variants
    std::uint64_t undefined = 0;                           // infinite values
    Interval mean;                                         // by the central limit theorem
    double sd = std::numeric_limits<double>::quiet_NaN();  // with n - 1
    double least = std::numeric_limits<double>::quiet_NaN(),
           largest = std::numeric_limits<double>::quiet_NaN();
    // of the distribution, by order statistics; an end without bound is infinite
    std::array<Interval, percentiles.size()> percentile;
    // share of the finite values that are outside the limits of the figure, Clopper-Pearson
    std::optional<Interval> outside;
    std::uint64_t outside_count = 0;
    // of a design for them, from the blocks in which every variant has a finite value
    std::optional<openturns::SobolIndices> sobol;
    std::uint64_t blocks = 0, blocks_left_out = 0;
};

// Of one figure: `values` in the order of the variants from 0, NaN where there is none yet or none at
// all (`missing` counts both). In a design for Sobol indices moments, percentiles and shares are
// those of the variants a and b of each block, which are independent.
FigureStatistics statistics(const Study& study, std::size_t figure,
                            const std::vector<double>& values);

}  // namespace elastocheck::compare::variants
