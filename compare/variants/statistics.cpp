#include "compare/variants/statistics.hpp"

#include <algorithm>
#include <cmath>

#include "compare/variants/sampler.hpp"

namespace elastocheck::compare::variants {
namespace {

using Eigen::Index;

constexpr double normal_quantile = 1.959963984540054;  // of 1 - (1 - confidence) / 2
constexpr std::uint64_t least_blocks = 10;             // of Sobol indices

void sobol(const Study& study, const std::vector<double>& values, FigureStatistics& result) {
    const auto size = static_cast<Index>(block_size(study));
    const auto blocks = static_cast<Index>(values.size()) / size;
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>
        all(values.data(), blocks, size);
    std::vector<Index> complete;
    for (Index i = 0; i < blocks; ++i)
        if (all.row(i).allFinite()) complete.push_back(i);
    result.blocks = complete.size();
    result.blocks_left_out = static_cast<std::uint64_t>(blocks) - complete.size();
    if (result.blocks < least_blocks || !(result.sd > 0)) return;
    result.sobol =
        openturns::sobol_indices(all(complete, Eigen::all), confidence, study.design.seed);
}

}  // namespace

FigureStatistics statistics(const Study& study, std::size_t figure,
                            const std::vector<double>& values) {
    FigureStatistics result;
    const std::uint64_t block = block_size(study);
    std::vector<double> x;
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (study.design.indices && k % block > 1) continue;
        if (std::isnan(values[k]))
            ++result.missing;
        else if (std::isinf(values[k]))
            ++result.undefined;
        else
            x.push_back(values[k]);
    }
    result.count = x.size();
    if (!x.empty()) {
        const auto n = static_cast<double>(x.size());
        std::ranges::sort(x);
        result.least = x.front(), result.largest = x.back();
        // About the median, so that no digits cancel.
        const double about = x[x.size() / 2];
        double sum = 0, squares = 0;
        for (const double value : x) sum += value - about;
        const double mean = sum / n;
        for (const double value : x) squares += (value - about - mean) * (value - about - mean);
        result.mean.value = about + mean;
        if (x.size() > 1) {
            result.sd = std::sqrt(squares / (n - 1));
            const double half = normal_quantile * result.sd / std::sqrt(n);
            result.mean.low = result.mean.value - half, result.mean.high = result.mean.value + half;
        }
        for (std::size_t p = 0; p < percentiles.size(); ++p) {
            const auto [low, high] =
                openturns::percentile_ranks(x.size(), percentiles[p], confidence);
            const auto rank =
                static_cast<std::size_t>(std::clamp(std::ceil(percentiles[p] * n) - 1, 0.0, n - 1));
            constexpr double none = std::numeric_limits<double>::infinity();
            result.percentile[p] = {x[rank], low < 0 ? -none : x[static_cast<std::size_t>(low)],
                                    high >= static_cast<std::int64_t>(x.size())
                                        ? none
                                        : x[static_cast<std::size_t>(high)]};
        }
        const StudyFigure& of = study.figures[figure];
        if (of.has_limits()) {
            result.outside_count = static_cast<std::uint64_t>(std::ranges::count_if(
                x, [&](double value) { return !(value >= of.low && value <= of.high); }));
            const auto [low, high] =
                openturns::clopper_pearson(result.outside_count, x.size(), confidence);
            result.outside = {static_cast<double>(result.outside_count) / n, low, high};
        }
    }
    if (study.design.indices) sobol(study, values, result);
    return result;
}

}  // namespace elastocheck::compare::variants
