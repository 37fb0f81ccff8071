#include "reports/files/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <thread>

#include "reports/files/files.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using Clock = std::chrono::steady_clock;

std::string safe_lines(std::string_view lines) {
    std::string safe;
    safe.reserve(lines.size());
    while (!lines.empty()) {
        const auto end = lines.find('\n');
        safe += for_terminal(lines.substr(0, end));
        if (end == lines.npos) break;
        safe += '\n';
        lines.remove_prefix(end + 1);
    }
    return safe;
}

bool write(std::FILE* stream, std::string_view lines) {
    const std::string safe = safe_lines(lines);
    return std::fwrite(safe.data(), 1, safe.size(), stream) == safe.size();
}

Collected* collected = nullptr;

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
    std::mutex lock;  // of the members below, and of both streams
    const bool terminal = is_terminal(STDERR_FILENO);
    bool hidden = false, working = false, begun = false, on_screen = false;
    std::string task;
    double done = 0;
    Clock::time_point began;
    std::condition_variable_any changed;  // `begun` has been set
    std::jthread repeats;                 // ended before all above are destroyed

    void clear() {
        if (on_screen) std::fputs("\r\033[K", stderr);
        on_screen = false;
    }
    void show() {
        const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
        if (!terminal) {
            (void)write(stderr, progress_line(task, done, seconds, 0) + "\n");
            return;
        }
        winsize size{};
        const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
        clear();
        (void)write(stderr, progress_line(task, done, seconds, known ? size.ws_col : 80));
        on_screen = true;
    }
    void repeat(const std::stop_token& end) {
        const auto pause = std::chrono::seconds(terminal ? 1 : 10);
        std::unique_lock guard(lock);
        while (!end.stop_requested()) {
            const bool begins = changed.wait_for(guard, end, pause, [&] { return begun; });
            begun = false;
            if (!begins && working && !end.stop_requested()) show();
        }
    }
    void begin() {
        working = begun = true;
        began = Clock::now();
        if (!repeats.joinable())
            repeats = std::jthread([this](const std::stop_token& end) { repeat(end); });
        changed.notify_one();
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

Collecting::Collecting(Collected& into) { collected = &into; }
Collecting::~Collecting() { collected = nullptr; }

void print_beside_document(std::string_view text) {
    if (collected != nullptr) collected->text += safe_lines(text);
}

void print(std::string_view lines) {
    const std::lock_guard guard(display().lock);
    if (collected != nullptr) {
        collected->printed += safe_lines(lines);
        return;
    }
    display().clear();
    if (!write(stdout, lines)) fail();
}

void print_error(std::string_view lines) {
    const std::lock_guard guard(display().lock);
    if (collected != nullptr) {
        collected->errors += safe_lines(lines);
        return;
    }
    display().clear();
    (void)write(stderr, lines);
}

std::string progress_line(std::string_view task, double done, double seconds, int width) {
    constexpr int bar = 20;
    // The remaining time is estimated from this share and these seconds on.
    constexpr double min_done = 0.02, min_seconds = 1;
    std::string line;
    if (std::isfinite(done)) {
        const double share = std::clamp(done, 0.0, 1.0);
        const auto full = static_cast<std::size_t>(std::floor(bar * share));
        if (width > 0)
            line = fmt::format("[{}{}] ", std::string(full, '#'), std::string(bar - full, '-'));
        line += fmt::format("{:3.0f} %", std::floor(100 * share));
        if (share >= min_done && seconds >= min_seconds)
            line += fmt::format(", {:.0f} s left", std::ceil(seconds * (1 - share) / share));
    } else {
        line = fmt::format("{:.0f} s", seconds);
    }
    line += fmt::format(": {}", task);
    return std::string(width > 0 ? cut(line, width - 1) : line);
}

void progress(std::string_view task, double done) {
    if (collected != nullptr) {
        if (collected->progress && !task.empty()) collected->progress(task, done);
        return;
    }
    Display& shown = display();
    const std::lock_guard guard(shown.lock);
    if (shown.hidden) return;
    if (task.empty()) {
        shown.clear();
        shown.working = false;
        return;
    }
    if (!shown.working) shown.begin();
    shown.task = task;
    shown.done = done;
    if (shown.terminal) shown.show();
}

void hide_progress() {
    if (collected != nullptr) {
        collected->progress = {};
        return;
    }
    progress("");
    const std::lock_guard guard(display().lock);
    display().hidden = true;
}

void finish_printing() {
    progress("");
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) fail();
}

}  // namespace elastocheck::reports
