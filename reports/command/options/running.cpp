#include "reports/command/options/running.hpp"

#include <algorithm>
#include <thread>

#include "reports/files/terminal.hpp"

namespace elastocheck::reports {

Option jobs_option(Running& running) {
    constexpr int most_threads = 1024;
    return {"--jobs", Integer{&running.jobs, 1, most_threads},
            "threads (default: one for each core); the results are the same"};
}

Option quiet_option(Running& running) {
    return {"--quiet", Flag{&running.quiet}, "no progress on standard error"};
}

int threads_of(const Running& running) {
    if (running.quiet) hide_progress();
    if (running.jobs > 0) return running.jobs;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace elastocheck::reports
