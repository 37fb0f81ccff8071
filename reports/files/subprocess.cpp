#include "reports/files/subprocess.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

constexpr std::size_t most_said = 4096;  // kept end of the program's output [bytes]

void keep_the_end(std::string& said) {
    if (said.size() > 2 * most_said) said.erase(0, said.size() - most_said);
}

// Runs in the child between fork and exec: only async-signal-safe functions are allowed.
[[noreturn]] void become(char* const* arguments, const char* folder, int said, int failed) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(said, STDOUT_FILENO);
    ::dup2(said, STDERR_FILENO);
    std::signal(SIGXFSZ, SIG_DFL);
    if (::chdir(folder) == 0) ::execvp(arguments[0], arguments);
    const int why = errno;
    [[maybe_unused]] const auto told = ::write(failed, &why, sizeof why);
    ::_exit(127);
}

// Whether the child has ended. It is not reaped, so that its process id is not reused.
bool has_ended(pid_t child) {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == child;
}

void end_group(pid_t leader, int signal) {
    ::kill(-leader, signal);
    for (int k = 0; k < 100 && !has_ended(leader); ++k) ::usleep(10'000);
    ::kill(-leader, SIGKILL);
}

}  // namespace

std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    bool open = false;
    char quote = 0;
    for (std::size_t k = 0; k < line.size(); ++k) {
        const char c = line[k];
        const bool blank = c == ' ' || c == '\t' || c == '\n';
        if (quote == 0 && blank) {
            open = false;
            continue;
        }
        if (!open) words.emplace_back(), open = true;
        if (c == '\\' && quote != '\'') {
            if (++k == line.size()) throw std::invalid_argument("it ends in a backslash");
            words.back() += line[k];
        } else if (quote != 0 ? c == quote : c == '\'' || c == '"') {
            quote = quote != 0 ? 0 : c;
        } else {
            words.back() += c;
        }
    }
    if (quote != 0) throw std::invalid_argument(fmt::format("a quote {} does not close", quote));
    return words;
}

std::string describe(const Ended& ended, double limit) {
    switch (ended.how) {
        case Ended::How::by_itself: return fmt::format("ended with exit code {}", ended.code);
        case Ended::How::by_signal:
            return fmt::format("was killed by signal {} ({})", ended.code, ::strsignal(ended.code));
        case Ended::How::too_long:
            return fmt::format("took longer than {:g} s and was killed", limit);
        case Ended::How::not_started:
            return fmt::format("could not be run: {}", std::strerror(ended.code));
    }
    return {};
}

Ended run(const std::vector<std::string>& words, double limit, const std::string& folder) {
    using clock = std::chrono::steady_clock;
    std::vector<char*> arguments;
    for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    int said[2], failed[2];
    if (::pipe2(said, O_CLOEXEC) != 0)
        throw FileError(fmt::format("pipe: {}", std::strerror(errno)));
    if (::pipe2(failed, O_CLOEXEC) != 0)
        throw FileError(fmt::format("pipe: {}", std::strerror(errno)));
    const auto start = clock::now();
    auto lock = no_cleanup_now();
    const pid_t child = ::fork();
    if (child < 0) throw FileError(fmt::format("fork: {}", std::strerror(errno)));
    if (child == 0) become(arguments.data(), folder.c_str(), said[1], failed[1]);
    ::setpgid(child, child);  // here and in the child, as either may run first
    std::optional<CleanupOnSignal> cleanup(std::in_place,
                                           [child](int signal) { end_group(child, signal); });
    lock.unlock();
    ::close(said[1]), ::close(failed[1]);

    Ended ended;
    const auto since = [&] { return std::chrono::duration<double>(clock::now() - start).count(); };
    int status = 0;
    struct rusage used {};
    bool reaped = false, listening = true;
    while (!reaped) {
        if (listening) {
            struct pollfd wait {
                said[0], POLLIN, 0
            };
            if (::poll(&wait, 1, 20) > 0) {
                char buffer[4096];
                const auto n = ::read(said[0], buffer, sizeof buffer);
                if (n > 0)
                    ended.said.append(buffer, static_cast<std::size_t>(n)),
                        keep_the_end(ended.said);
                else
                    listening = n < 0 && errno == EINTR;
            }
        } else {
            ::usleep(1000);
        }
        const bool over = has_ended(child);
        if (!over && since() <= limit) continue;
        if (!over) ended.how = Ended::How::too_long;
        ended.seconds = since();
        ::kill(-child, SIGKILL);  // the rest of the process group
        cleanup.reset();          // before the process id can be reused
        ::wait4(child, &status, 0, &used);
        reaped = true;
    }
    ::fcntl(said[0], F_SETFL, O_NONBLOCK);
    char buffer[4096];
    for (ssize_t n; (n = ::read(said[0], buffer, sizeof buffer)) > 0;)
        ended.said.append(buffer, static_cast<std::size_t>(n)), keep_the_end(ended.said);
    int why = 0;
    const bool not_started =
        ::read(failed[0], &why, sizeof why) == static_cast<ssize_t>(sizeof why);
    ::close(said[0]), ::close(failed[0]);
    if (ended.said.size() > most_said) ended.said.erase(0, ended.said.size() - most_said);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    ended.cpu = seconds(used.ru_utime) + seconds(used.ru_stime);
    if (not_started)
        ended.how = Ended::How::not_started, ended.code = why;
    else if (ended.how != Ended::How::too_long && WIFSIGNALED(status))
        ended.how = Ended::How::by_signal, ended.code = WTERMSIG(status);
    else if (ended.how == Ended::How::by_itself)
        ended.code = WEXITSTATUS(status);
    return ended;
}

TemporaryFolder::TemporaryFolder() {
    const char* const said = std::getenv("TMPDIR");
    const std::string parent = said != nullptr && *said != '\0' ? said : "/tmp";
    path_ = (std::filesystem::path(parent) / "elastocheck-XXXXXX").string();
    const auto lock = no_cleanup_now();
    if (::mkdtemp(path_.data()) == nullptr)
        throw FileError(
            fmt::format("TMPDIR: no temporary folder can be made in {} ({}); set TMPDIR to a "
                        "folder that can be written",
                        parent, std::strerror(errno)));
    cleanup_.emplace([path = path_](int) {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    });
}
TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace elastocheck::reports
