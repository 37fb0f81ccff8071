#include "reports/page/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace elastocheck::reports {

void run_gnuplot(const std::filesystem::path& folder, const std::vector<std::string>& arguments) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw PlotError(fmt::format("gnuplot: {}", std::strerror(errno)));
    std::string program = "gnuplot";
    std::vector<std::string> words = arguments;
    std::vector<char*> argv{program.data()};
    for (auto& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    constexpr int cannot_be_run = 127;  // as a shell says it
    const pid_t child = ::fork();
    if (child == 0) {
        // It ends with us: a figure that is drawn on after we were killed would write into the folder of the next run.
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        const int nothing = ::open("/dev/null", O_RDONLY);
        const bool ready = nothing >= 0 && ::chdir(folder.c_str()) == 0 &&
                           ::dup2(nothing, STDIN_FILENO) >= 0 && ::dup2(ends[1], STDOUT_FILENO) >= 0 &&
                           ::dup2(ends[1], STDERR_FILENO) >= 0;
        if (ready) ::execvp(program.c_str(), argv.data());
        const char* why = std::strerror(errno);
        (void)!::write(ends[1], why, std::strlen(why));
        ::_exit(cannot_be_run);
    }
    const int failed = child < 0 ? errno : 0;
    ::close(ends[1]);
    std::string said;
    if (failed == 0) {
        char buffer[4096];
        for (ssize_t n; (n = ::read(ends[0], buffer, sizeof buffer)) > 0 || (n < 0 && errno == EINTR);)
            if (n > 0) said.append(buffer, static_cast<std::size_t>(n));
    }
    ::close(ends[0]);
    if (failed != 0) throw PlotError(fmt::format("gnuplot cannot be run ({})", std::strerror(failed)));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    if (WIFEXITED(status) && WEXITSTATUS(status) == cannot_be_run)
        throw PlotError(
            fmt::format("gnuplot cannot be run ({}); figures need it: install gnuplot-nox", said));
    while (!said.empty() && std::isspace(static_cast<unsigned char>(said.back())) != 0) said.pop_back();
    throw PlotError(fmt::format("gnuplot {}: {}", arguments.empty() ? "" : arguments.back(),
                                said.empty() ? "failed" : said));
}

}  // namespace elastocheck::reports
