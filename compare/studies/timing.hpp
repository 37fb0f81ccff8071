// Interleaved timing of several jobs on a machine with other load.
//
// The jobs run in turns in one process, round after round, so that a temporary slowdown of the
// machine affects all of them. A ratio is formed within each round, then the median over the rounds
// is taken.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace elastocheck::compare {

// Seconds of each job and round, [job][round].
using Times = std::vector<std::vector<double>>;
Times take_turns(std::span<const std::function<void()>> jobs, int rounds);

double median(std::vector<double> values);  // NaN for an empty vector
// times / base, round by round
std::vector<double> ratios(const std::vector<double>& times, const std::vector<double>& base);

// Noise of a time ratio, from one job timed twice per round: deviation of the median ratio
// from 1, or half the interquartile range if that is larger. Differences up to the noise
// are not significant.
double noise_of(const std::vector<double>& self_ratios);

}  // namespace elastocheck::compare
