#include "reports/files/terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <thread>

#include "reports/files/files.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using Clock = std::chrono::steady_clock;

bool write(std::FILE* stream, std::string_view lines) {
    std::string safe;
    safe.reserve(lines.size());
    while (!lines.empty()) {
        const auto end = lines.find('\n');
        safe += for_terminal(lines.substr(0, end));
        if (end == lines.npos) break;
        safe += '\n';
        lines.remove_prefix(end + 1);
    }
    return std::fwrite(safe.data(), 1, safe.size(), stream) == safe.size();
}

[[noreturn]] void fail() {
    if (errno == EPIPE) throw OutputClosed();
    throw FileError(fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
}

// isatty() sets errno, which has to keep the reason of a failed write.
bool is_terminal(int file) {
    const int before = errno;
    const bool is = ::isatty(file) == 1;
    errno = before;
    return is;
}

// The displayed progress. A thread repeats it while the work reports nothing new.
struct Display {
    std::mutex lock;  // of all below, and of both streams
    const bool terminal = is_terminal(STDERR_FILENO);
    bool hidden = false, works = false, on_screen = false;
    std::string what;
    double done = 0;
    Clock::time_point began;
    int read_end = -1, write_end = -1;  // of a pipe to the thread
    std::thread repeats;

    Display() = default;
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;
    ~Display() {
        if (!repeats.joinable()) return;
        wake('q');
        repeats.join();
    }

    void clear() {
        if (on_screen) std::fputs("\r\033[K", stderr);
        on_screen = false;
    }
    void show() {
        const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
        if (!terminal) {
            (void)write(stderr, progress_line(what, done, seconds, 0) + "\n");
            return;
        }
        winsize size{};
        const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
        clear();
        (void)write(stderr, progress_line(what, done, seconds, known ? size.ws_col : 80));
        on_screen = true;
    }
    // Begins the pause again, or ends the thread by 'q'.
    void wake(char message) const {
        [[maybe_unused]] const auto ignored = ::write(write_end, &message, 1);
    }
    void repeat() {
        const int pause = terminal ? 1000 : 10'000;  // [ms]
        for (char message = 0; message != 'q';) {
            pollfd in{read_end, POLLIN, 0};
            const int ready = ::poll(&in, 1, pause);
            if (ready > 0 && ::read(read_end, &message, 1) != 1) return;
            if (ready != 0) continue;
            const std::lock_guard guard(lock);
            if (works) show();
        }
    }
    void begin() {
        works = true;
        began = Clock::now();
        int ends[2];
        if (!repeats.joinable() && ::pipe2(ends, O_CLOEXEC) == 0) {
            read_end = ends[0], write_end = ends[1];
            repeats = std::thread([this] { repeat(); });
        } else if (repeats.joinable()) {
            wake('b');
        }
    }
};

Display& display() {
    static Display one;
    return one;
}

// The start of a text, of at most so many characters.
std::string_view cut(std::string_view text, int characters) {
    for (std::size_t k = 0; k < text.size(); ++k)
        if ((text[k] & 0xC0) != 0x80 && characters-- <= 0) return text.substr(0, k);
    return text;
}

}  // namespace

void print(std::string_view lines) {
    const std::lock_guard guard(display().lock);
    display().clear();
    if (!write(stdout, lines)) fail();
}

void print_error(std::string_view lines) {
    const std::lock_guard guard(display().lock);
    display().clear();
    (void)write(stderr, lines);
}

std::string progress_line(std::string_view what, double done, double seconds, int width) {
    constexpr int bar = 20;
    // Before that little is known of the time.
    constexpr double least_done = 0.02, least_seconds = 1;
    std::string line;
    if (std::isfinite(done)) {
        const double share = std::clamp(done, 0.0, 1.0);
        const auto full = static_cast<std::size_t>(std::floor(bar * share));
        if (width > 0)
            line = fmt::format("[{}{}] ", std::string(full, '#'), std::string(bar - full, '-'));
        line += fmt::format("{:3.0f} %", std::floor(100 * share));
        if (share >= least_done && seconds >= least_seconds)
            line += fmt::format(", {:.0f} s left", std::ceil(seconds * (1 - share) / share));
    } else {
        line = fmt::format("{:.0f} s", seconds);
    }
    line += fmt::format(": {}", what);
    return std::string(width > 0 ? cut(line, width - 1) : line);
}

void progress(std::string_view what, double done) {
    Display& shown = display();
    const std::lock_guard guard(shown.lock);
    if (shown.hidden) return;
    if (what.empty()) {
        shown.clear();
        shown.works = false;
        return;
    }
    if (!shown.works) shown.begin();
    shown.what = what, shown.done = done;
    if (shown.terminal) shown.show();
}

void hide_progress() {
    progress("");
    const std::lock_guard guard(display().lock);
    display().hidden = true;
}

void finish_printing() {
    progress("");
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) fail();
}

}  // namespace elastocheck::reports
