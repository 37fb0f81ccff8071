#include "reports/files/subprocess.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

constexpr std::size_t largest_output = 4096;  // kept end of the program's output [bytes]

// Adds what can be read, and keeps the last part; false at the end of the output.
bool keep_output(int pipe, std::string& output_text) {
    char buffer[4096];
    const auto count = ::read(pipe, buffer, sizeof buffer);
    if (count <= 0) return count < 0 && errno == EINTR;
    output_text.append(buffer, static_cast<std::size_t>(count));
    if (output_text.size() > 2 * largest_output)
        output_text.erase(0, output_text.size() - largest_output);
    return true;
}

// Runs in the child between fork and exec: only async-signal-safe functions are allowed.
[[noreturn]] void execute_child(char* const* arguments, int output_pipe, int error_pipe) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int empty_input = ::open("/dev/null", O_RDONLY);
    ::dup2(empty_input, STDIN_FILENO);
    ::dup2(output_pipe, STDOUT_FILENO);
    ::dup2(output_pipe, STDERR_FILENO);
    std::signal(SIGXFSZ, SIG_DFL);
    ::execvp(arguments[0], arguments);
    const int why = errno;
    [[maybe_unused]] const auto ignored = ::write(error_pipe, &why, sizeof why);
    ::_exit(127);
}

// Whether the child has ended. It is not reaped, so that its process id is not reused.
bool has_exited(pid_t child) {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == child;
}

// Process group of the running program; 0: none.
std::atomic<pid_t> running_group = 0;

void end_with_child(int signal) {
    if (const pid_t group = running_group; group > 0) ::kill(-group, SIGKILL);
    std::signal(signal, SIG_DFL);
    ::raise(signal);  // acts when this handler returns
}

}  // namespace

void end_child_on_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT})
        if (std::signal(signal, end_with_child) == SIG_IGN) std::signal(signal, SIG_IGN);
}

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
        if (!std::exchange(open, true)) words.emplace_back();
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

std::string describe(const ProcessResult& result, double limit) {
    switch (result.how) {
        case ProcessResult::How::by_itself:
            return fmt::format("ended with exit code {}", result.code);
        case ProcessResult::How::by_signal:
            return fmt::format("was killed by signal {} ({})", result.code,
                               ::strsignal(result.code));
        case ProcessResult::How::too_long:
            return fmt::format("took longer than {:g} s and was killed", limit);
        case ProcessResult::How::not_started:
            return fmt::format("could not be run: {}", std::strerror(result.code));
    }
    return {};
}

ProcessResult run(const std::vector<std::string>& words, double limit) {
    using clock = std::chrono::steady_clock;
    std::vector<char*> arguments;
    for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    int output_pipe[2], error_pipe[2];  // the second has errno where the program cannot be run
    for (int* pipe : {output_pipe, error_pipe})
        if (::pipe2(pipe, O_CLOEXEC) != 0)
            throw FileError(fmt::format("pipe: {}", std::strerror(errno)));
    const auto start = clock::now();
    const pid_t child = ::fork();
    if (child < 0) throw FileError(fmt::format("fork: {}", std::strerror(errno)));
    if (child == 0) execute_child(arguments.data(), output_pipe[1], error_pipe[1]);
    ::setpgid(child, child);  // here and in the child, as either may run first
    running_group = child;
    ::close(output_pipe[1]);
    ::close(error_pipe[1]);

    ProcessResult result;
    pollfd output{output_pipe[0], POLLIN, 0};
    bool exited = false;
    do {
        // After the end of the output (fd < 0) poll() only waits.
        if (::poll(&output, 1, output.fd < 0 ? 1 : 20) > 0 &&
            !keep_output(output.fd, result.output_text))
            output.fd = -1;
        exited = has_exited(child);
    } while (!exited && std::chrono::duration<double>(clock::now() - start).count() <= limit);
    ::kill(-child, SIGKILL);  // the rest of the process group
    running_group = 0;        // before the process id can be reused
    int status = 0, why = 0;
    ::waitpid(child, &status, 0);
    ::fcntl(output_pipe[0], F_SETFL, O_NONBLOCK);
    while (keep_output(output_pipe[0], result.output_text)) continue;
    const bool started = ::read(error_pipe[0], &why, sizeof why) != sizeof why;
    ::close(output_pipe[0]);
    ::close(error_pipe[0]);
    if (result.output_text.size() > largest_output)
        result.output_text.erase(0, result.output_text.size() - largest_output);
    using enum ProcessResult::How;
    result.how = !started              ? not_started
                 : !exited             ? too_long
                 : WIFSIGNALED(status) ? by_signal
                                       : by_itself;
    result.code = !started                  ? why
                  : result.how == by_signal ? WTERMSIG(status)
                  : result.how == by_itself ? WEXITSTATUS(status)
                                            : 0;
    return result;
}

TemporaryFolder::TemporaryFolder() {
    const char* const given = std::getenv("TMPDIR");
    const std::string parent = given != nullptr && *given != '\0' ? given : "/tmp";
    path_ = temporary_beside(std::filesystem::path(parent) / "candidate").string();
    if (::mkdir(path_.c_str(), 0700) != 0)
        throw FileError(
            fmt::format("TMPDIR: no temporary folder can be made in {} ({}); set TMPDIR to a "
                        "folder that can be written",
                        parent, std::strerror(errno)));
}
TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace elastocheck::reports
