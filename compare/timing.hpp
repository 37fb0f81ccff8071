// Times of several jobs that can be compared with each other on a machine that does other things as well.
//
// The jobs take turns in one process, round after round, so that whatever slows the machine down for a while
// slows all of them. A ratio is formed within each round, where both of its times saw the same machine, and
// then the median is taken.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace elastocheck::compare {

// [job][round], seconds.
using Times = std::vector<std::vector<double>>;
Times take_turns(std::span<const std::function<void()>> jobs, int rounds);

double median(std::vector<double> values);                                                      // NaN of none
std::vector<double> ratios(const std::vector<double>& times, const std::vector<double>& base);  // by round

// How far the ratio of a job to itself, timed twice, is off 1: its median, or half its interquartile range if
// that is more. Differences up to this are none.
double noise_of(const std::vector<double>& self_ratios);

}  // namespace elastocheck::compare
