#include "reports/files/cleanup.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <ranges>
#include <thread>
#include <vector>

namespace elastocheck::reports {
namespace {

struct Registry {
    std::recursive_mutex mutex;
    std::list<std::function<void(int)>> cleanups;
};
Registry& registry() {
    static auto* const one = new Registry;  // never destroyed: the thread below may outlive main()
    return *one;
}

int signal_pipe = -1;  // write end of the pipe from the signal handler to the thread

void forward_signal(int signal) {
    const int error = errno;
    [[maybe_unused]] const auto ignored = ::write(signal_pipe, &signal, sizeof signal);
    errno = error;
}

void clean_up_after_signal(int pipe_end, const std::vector<int>& handled) {
    int signal = 0;
    while (::read(pipe_end, &signal, sizeof signal) != static_cast<ssize_t>(sizeof signal))
        continue;
    for (const int one : handled) std::signal(one, SIG_DFL);
    registry().mutex.lock();  // never unlocked
    for (const auto& work : registry().cleanups | std::views::reverse) try {
            work(signal);
        } catch (...) {  // a failed cleanup does not prevent the others
        }
    ::kill(::getpid(), signal);
}

}  // namespace

void clean_up_on_signals() {
    std::vector<int> handled;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        struct sigaction now {};
        if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_DFL)
            handled.push_back(signal);
    }
    int ends[2];
    // without a pipe, signals end the process immediately
    if (handled.empty() || ::pipe2(ends, O_CLOEXEC) != 0) return;
    signal_pipe = ends[1];
    std::thread(clean_up_after_signal, ends[0], handled).detach();
    for (const int signal : handled) {
        struct sigaction action {};
        action.sa_handler = forward_signal;
        action.sa_flags = SA_RESTART;
        ::sigaction(signal, &action, nullptr);
    }
}

CleanupOnSignal::CleanupOnSignal(std::function<void(int)> work) {
    const auto lock = block_cleanup();
    at_ = registry().cleanups.insert(registry().cleanups.end(), std::move(work));
}
CleanupOnSignal::~CleanupOnSignal() {
    const auto lock = block_cleanup();
    registry().cleanups.erase(at_);
}

std::unique_lock<std::recursive_mutex> block_cleanup() {
    return std::unique_lock(registry().mutex);
}

}  // namespace elastocheck::reports
