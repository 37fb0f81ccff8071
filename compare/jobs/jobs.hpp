// Independent jobs on several threads. Each job writes a result of its own, so that the results do
// not depend on the number of threads.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

struct Job {
    std::string what;  // name, reported when the job begins
    std::function<void()> run;
};

// Runs the jobs in their order, up to `threads` at a time. `progress` is called by one thread at a
// time. When a job throws, no other begins; once all have ended, the exception of the first of
// those that threw, in their order, is thrown again.
void run_jobs(const std::vector<Job>& jobs, int threads, const Progress& progress);

// Progress of a part of a computation, that from the share `from` to the share `to` of the whole.
Progress part(const Progress& whole, double from, double to);

// Processor time of the calling thread [s], without that of other threads and processes.
double processor_time();

}  // namespace elastocheck::compare
