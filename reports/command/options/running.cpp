#include "reports/command/options/running.hpp"

#include <algorithm>
#include <thread>

#include "reports/files/terminal.hpp"

namespace elastocheck::reports {

int threads_of(const Running& running) {
    if (running.quiet) hide_progress();
    if (running.jobs > 0) return running.jobs;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace elastocheck::reports
