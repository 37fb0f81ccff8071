#include "reports/files/terminal.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "reports/files/files.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

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

}  // namespace

void print(std::string_view lines) {
    if (!write(stdout, lines)) fail();
}

void print_error(std::string_view lines) { (void)write(stderr, lines); }

void progress(std::string_view what) {
    if (::isatty(STDERR_FILENO) != 1) return;
    std::fputs("\r\033[K", stderr);
    print_error(what);
}

void finish_printing() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) fail();
}

}  // namespace elastocheck::reports
