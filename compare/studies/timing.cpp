#include "compare/studies/timing.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace elastocheck::compare {

Times take_turns(std::span<const std::function<void()>> jobs, int rounds) {
    Times times(jobs.size());
    for (int round = 0; round < rounds; ++round)
        for (std::size_t k = 0; k < jobs.size(); ++k) {
            const auto start = std::chrono::steady_clock::now();
            jobs[k]();
            times[k].push_back(
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
    return times;
}

double median(std::vector<double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::ranges::sort(values);
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::vector<double> ratios(const std::vector<double>& times, const std::vector<double>& base) {
    std::vector<double> result;
    for (std::size_t k = 0; k < std::min(times.size(), base.size()); ++k)
        result.push_back(times[k] / base[k]);
    return result;
}

double noise_of(const std::vector<double>& self_ratios) {
    if (self_ratios.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> sorted = self_ratios;
    std::ranges::sort(sorted);
    const std::size_t quarter = sorted.size() / 4;
    return std::max(std::abs(median(sorted) - 1),
                    (sorted[sorted.size() - 1 - quarter] - sorted[quarter]) / 2);
}

}  // namespace elastocheck::compare
