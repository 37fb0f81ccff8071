#include "compare/jobs/jobs.hpp"

#include <algorithm>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>

#include "compare/jobs/allocation.hpp"

namespace elastocheck::compare {

void run_jobs(const std::vector<Job>& jobs, int threads, const Progress& progress) {
    align_suitesparse();
    std::mutex lock;
    std::size_t next = 0, ended = 0;  // guarded by `lock`, as the failure
    std::size_t failed = jobs.size();
    std::exception_ptr failure;
    const auto work = [&] {
        std::unique_lock guard(lock);
        while (next < jobs.size() && !failure) {
            const std::size_t k = next++;
            try {
                if (progress)
                    progress(jobs[k].what,
                             static_cast<double>(ended) / static_cast<double>(jobs.size()));
                guard.unlock();
                jobs[k].run();
                guard.lock();
            } catch (...) {
                if (!guard.owns_lock()) guard.lock();
                if (k < failed) {
                    failed = k;
                    failure = std::current_exception();
                }
            }
            ++ended;
        }
    };
    std::vector<std::jthread> workers;
    for (std::size_t k = 1; k < std::min(static_cast<std::size_t>(threads), jobs.size()); ++k)
        workers.emplace_back(work);
    work();
    workers.clear();  // joins
    if (failure) std::rethrow_exception(failure);
}

Progress part(const Progress& whole, double from, double to) {
    if (!whole) return {};
    return [=](std::string_view what, double done) { whole(what, from + done * (to - from)); };
}

double processor_time() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace elastocheck::compare
